//! Where on the string a mode lives.
//!
//! Run the recurrence from both ends: the product x→ x← at a node r is (K − κM)⁻¹_rr times a constant, so
//! near an eigenvalue it is the square of the mode there. At the node where it is largest neither half has
//! been followed into the region where rounding errors outgrow it. (Twisted factorization: Parlett and
//! Dhillon.)

use super::batch::Batch;
use crate::tongue::string::lanes::{Aligned, LANES, Lanes, power_of_two};
use crate::tongue::string::{HalfString, KINDS, Step};
use number::vector::Vector;
use number::vector::instructions::Kernel;

/// Among the nodes with more than this part of the largest product, the one nearest to t = 0 is taken: modes
/// that fill the string are then all followed from T/2 through most of it, and little is done twice.
const NEARLY_LARGEST: f64 = 1.0 / 16.0;

/// The recurrence from t = 0 at every node, its exponents by block.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    x: Vec<Aligned<Lanes>>,
    exponents: Vec<[i64; LANES]>,
}

impl Walk {
    /// Finds a node for each lane where the mode near κ is near its largest.
    pub fn locate(&mut self, string: &HalfString, batch: &mut Batch) {
        string.instructions.compute(Locating { string, batch, walk: self });
    }
}

struct Locating<'a> {
    string: &'a HalfString,
    batch: &'a mut Batch,
    walk: &'a mut Walk,
}

impl Kernel for Locating<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Locating { string, batch, walk } = self;
        let kappa = V::load(&batch.kappa);
        let mut kicks = [kappa; KINDS];
        for (kick, &mass) in kicks.iter_mut().zip(&string.masses) {
            *kick = kappa.mul(V::splat(mass));
        }
        walk.fill(string, &kicks, Front::new(&batch.starts_free));
        batch.at = walk.meet(string, &kicks, Front::new(&batch.ends_free));
    }
}

impl Walk {
    /// From t = 0 to T/2.
    #[inline(always)]
    fn fill<V: Vector>(&mut self, string: &HalfString, kicks: &[V; KINDS], mut front: Front<V>) {
        let (n, block) = (string.last(), string.block);
        self.exponents.clear();
        self.x.resize(n + 1, Aligned([0.0; LANES]));
        for (steps, x) in string.forward.chunks(block).zip(self.x.chunks_mut(block)) {
            self.exponents.push(front.rescale());
            for (step, x) in steps.iter().zip(x) {
                front.x.store(&mut x.0);
                front.advance(kicks, step);
            }
        }
        // The last node, in a block of its own if the one before is full.
        if n.is_multiple_of(block) {
            self.exponents.push(front.rescale());
        }
        front.x.store(&mut self.x[n].0);
    }

    /// From T/2 to t = 0 against it: the node of each lane, as a number.
    #[inline(always)]
    fn meet<V: Vector>(&self, string: &HalfString, kicks: &[V; KINDS], mut front: Front<V>) -> Lanes {
        let n = string.last();
        let (mut product, mut at) = (V::splat(0.0), V::splat(0.0));
        // The product is in units of 2^exponents.
        let mut exponents = [0; LANES];
        let mut upto = n + 1;
        for (x, left) in self.x.chunks(string.block).zip(&self.exponents).rev() {
            let right = front.rescale();
            let mut scale = [0.0; LANES];
            for i in 0..LANES {
                let unit = left[i] + right[i];
                scale[i] = power_of_two(exponents[i] - unit);
                exponents[i] = unit;
            }
            product = product.mul(V::load(&scale));
            let from = upto - x.len();
            for (j, x) in (from..upto).zip(x).rev() {
                // No mode lives where there is no mass, as there may be none at T/2.
                if j < n || string.masses[string.nodes[n].kind] > 0.0 {
                    let here = V::load(&x.0).mul(front.x).abs();
                    at = here.if_above(V::splat(NEARLY_LARGEST).mul(product), V::splat(j as f64), at);
                    product = here.larger(product);
                }
                if j > 0 {
                    front.advance(kicks, &string.backward[n - j]);
                }
            }
            upto = from;
        }
        let mut nodes = [0.0; LANES];
        at.store(&mut nodes);
        nodes
    }
}

/// Where a walk has arrived.
struct Front<V> {
    x: V,
    v: V,
    exponents: [i64; LANES],
}

impl<V: Vector> Front<V> {
    #[inline(always)]
    fn new(free: &Lanes) -> Self {
        let x = V::load(free);
        Front { x, v: V::splat(1.0).sub(x), exponents: [0; LANES] }
    }

    #[inline(always)]
    fn advance(&mut self, kicks: &[V; KINDS], step: &Step) {
        self.v = kicks[step.kind].neg_mul_add(self.x, self.v);
        self.x = V::splat(step.length).mul_add(self.v, self.x);
    }

    /// Divides by a power of two that brings the larger of |x| and |v| to [1, 2); all of its exponent so far.
    #[inline(always)]
    fn rescale(&mut self) -> [i64; LANES] {
        let factor = self.x.abs().larger(self.v.abs()).normalizing();
        self.x = self.x.mul(factor);
        self.v = self.v.mul(factor);
        let mut factors = [0.0; LANES];
        factor.store(&mut factors);
        for (exponent, factor) in self.exponents.iter_mut().zip(factors) {
            *exponent += 1023 - (factor.to_bits() >> 52) as i64;
        }
        self.exponents
    }
}
