//! Where on the string a mode lives.
//!
//! Run the recurrence from both ends: the product x→ x← at a node r is (K − κM)⁻¹_rr times a constant, so near an
//! eigenvalue it is the square of the mode there. At the node where it is largest neither half has been followed into
//! the region where rounding errors outgrow it. (Twisted factorization: Parlett and Dhillon.)

use super::batch::Batch;
use super::lanes::{Aligned, LANES, Lanes, power_of_two};
use super::string::{HalfString, Step};
use crate::verdict::instructions::Kernel;
use crate::verdict::vector::Vector;

/// Of all nodes with more than this part of the largest product the one nearest to t = 0 is taken: modes that fill the
/// string are then all followed from T/2 through most of it, and little is done twice.
const ENOUGH: f64 = 1.0 / 16.0;

/// The two recurrences at every node.
#[derive(Debug, Default)]
pub(super) struct Walks {
    left: Walk,
    right: Walk,
}

/// x at the nodes in the order of the steps, and its exponents by block.
#[derive(Debug, Default)]
struct Walk {
    x: Vec<Aligned<Lanes>>,
    exponents: Vec<[i64; LANES]>,
}

impl HalfString {
    /// Finds a node for each lane where the mode near κ is near its largest.
    pub fn locate(&self, batch: &mut Batch, walks: &mut Walks) {
        self.instructions.compute(Locating { string: self, batch, walks });
    }
}

struct Locating<'a> {
    string: &'a HalfString,
    batch: &'a mut Batch,
    walks: &'a mut Walks,
}

impl Kernel for Locating<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Locating { string, batch, walks: Walks { left, right } } = self;
        let kappa = V::load(&batch.kappa);
        let mut kicks = [kappa; 8];
        for &kind in &string.kinds {
            kicks[kind] = kappa.mul(V::splat(string.masses[kind]));
        }
        let (mut ahead, mut back) = (Front::<V>::new(&batch.starts_free), Front::<V>::new(&batch.ends_free));
        left.begin(string);
        right.begin(string);
        let blocks = string.forward.chunks(string.block).zip(string.backward.chunks(string.block));
        for (b, (forward, backward)) in blocks.enumerate() {
            left.exponents.push(ahead.rescale());
            right.exponents.push(back.rescale());
            let from = b * string.block;
            let nodes = from..from + forward.len();
            let (x, y) = (&mut left.x[nodes.clone()], &mut right.x[nodes]);
            for (((next, last), x), y) in forward.iter().zip(backward).zip(x).zip(y) {
                ahead.x.store(&mut x.0);
                back.x.store(&mut y.0);
                ahead.advance(&kicks, next);
                back.advance(&kicks, last);
            }
        }
        left.end(ahead, string);
        right.end(back, string);
        batch.at = peak::<V>(string, left, right);
    }
}

impl Walk {
    #[inline(always)]
    fn begin(&mut self, string: &HalfString) {
        self.exponents.clear();
        self.x.resize(string.nodes.len(), Aligned([0.0; LANES]));
    }

    /// The last node, in a block of its own if the one before is full.
    #[inline(always)]
    fn end<V: Vector>(&mut self, mut front: Front<V>, string: &HalfString) {
        let n = string.last();
        if n.is_multiple_of(string.block) {
            self.exponents.push(front.rescale());
        }
        front.x.store(&mut self.x[n].0);
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
    fn advance(&mut self, kicks: &[V; 8], step: &Step) {
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

/// The node of each lane, as a number.
#[inline(always)]
fn peak<V: Vector>(string: &HalfString, left: &Walk, right: &Walk) -> Lanes {
    let (n, block) = (string.last(), string.block);
    let (mut product, mut at) = (V::splat(0.0), V::splat(0.0));
    // The product is in units of 2^exponents.
    let mut exponents = [0; LANES];
    // No mode lives where there is no mass, as there may be none at T/2.
    let mut upto = if string.mass(n) > 0.0 { n + 1 } else { n };
    while upto > 0 {
        // The nodes from `from` to `upto` − 1 are in one block of either walk.
        let (ahead, back) = ((upto - 1) / block, (n + 1 - upto) / block);
        let mut scale = [0.0; LANES];
        for i in 0..LANES {
            let unit = left.exponents[ahead][i] + right.exponents[back][i];
            scale[i] = power_of_two(exponents[i] - unit);
            exponents[i] = unit;
        }
        product = product.mul(V::load(&scale));
        let from = (ahead * block).max((n + 1).saturating_sub((back + 1) * block));
        for j in (from..upto).rev() {
            let here = V::load(&left.x[j].0).mul(V::load(&right.x[n - j].0)).abs();
            at = here.if_above(V::splat(ENOUGH).mul(product), V::splat(j as f64), at);
            product = here.larger(product);
        }
        upto = from;
    }
    let mut nodes = [0.0; LANES];
    at.store(&mut nodes);
    nodes
}
