//! Where on the string a mode lives.
//!
//! Run the recurrence from both ends: the product x→ x← at a node r is (K − κM)⁻¹_rr times a constant, so near an
//! eigenvalue it is the square of the mode there. At the node where it is largest neither half has been followed into
//! the region where rounding errors outgrow it. (Twisted factorization: Parlett and Dhillon.)

use super::lanes::{Aligned, LANES, Lanes, lanes, normalizing, power_of_two};
use super::string::{HalfString, Step};
use crate::verdict::instructions::Task;

/// The recurrence from t = 0 at every node, its exponents by block.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    forward: Vec<Aligned<Lanes>>,
    exponents: Vec<[i64; LANES]>,
}

/// Of all nodes with more than this part of the largest product the one nearest to t = 0 is taken: modes that fill the
/// string are then all followed from T/2 through most of it, and little is done twice.
const ENOUGH: f64 = 1.0 / 16.0;

/// A problem for each lane: κ, and whether the ends are free.
#[derive(Clone, Copy)]
pub(super) struct Problems {
    pub kappa: Lanes,
    /// 1 where the end is free, else 0.
    pub starts_free: Lanes,
    pub ends_free: Lanes,
}

impl HalfString {
    /// A node for each lane where the mode near κ is near its largest; as numbers.
    pub fn locate(&self, problems: &Problems, space: &mut Workspace) -> Lanes {
        self.instructions.perform(Locating { string: self, problems, space })
    }
}

struct Locating<'a> {
    string: &'a HalfString,
    problems: &'a Problems,
    space: &'a mut Workspace,
}

/// (x, v) on arrival at an end that is free (1) or pinned (0).
#[inline(always)]
pub(super) fn start(free: &Lanes) -> (Lanes, Lanes) {
    (*free, lanes(|i| 1.0 - free[i]))
}

/// Divides x and v by a power of two that brings the larger one to [1, 2), and adds its exponent.
#[inline(always)]
fn rescale(x: &mut Lanes, v: &mut Lanes, exponents: &mut [i64; LANES]) {
    let factor = normalizing(x, v);
    *x = lanes(|i| x[i] * factor[i]);
    *v = lanes(|i| v[i] * factor[i]);
    for i in 0..LANES {
        exponents[i] += 1023 - (factor[i].to_bits() >> 52) as i64;
    }
}

#[inline(always)]
fn advance(x: &mut Lanes, v: &mut Lanes, kick: &Lanes, step: &Step) {
    *v = lanes(|i| (-kick[i]).mul_add(x[i], v[i]));
    *x = lanes(|i| step.length.mul_add(v[i], x[i]));
}

impl Task for Locating<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn run(self) -> Lanes {
        let (kicks, block) = (self.string.kicks(&self.problems.kappa), self.string.block);
        let (mut x, mut v) = start(&self.problems.starts_free);
        let mut exponents = [0; LANES];
        self.space.forward.clear();
        self.space.exponents.clear();
        for steps in self.string.forward.chunks(block) {
            rescale(&mut x, &mut v, &mut exponents);
            self.space.exponents.push(exponents);
            for step in steps {
                self.space.forward.push(Aligned(x));
                advance(&mut x, &mut v, &kicks.0[step.kind], step);
            }
        }
        let n = self.string.last();
        if n.is_multiple_of(block) {
            rescale(&mut x, &mut v, &mut exponents);
            self.space.exponents.push(exponents);
        }
        self.space.forward.push(Aligned(x));
        let (mut x, mut v) = start(&self.problems.ends_free);
        let mut peak = Peak { product: [0.0; LANES], at: [0.0; LANES], exponents: [0; LANES] };
        let mut exponents = [0; LANES];
        // The first node of the block.
        let mut first = n + 1;
        for j in (0..=n).rev() {
            if j < n {
                let step = &self.string.backward[n - 1 - j];
                advance(&mut x, &mut v, &kicks.0[step.kind], step);
            }
            if j < first {
                first = j - j % block;
                rescale(&mut x, &mut v, &mut exponents);
                peak.enter(&exponents, &self.space.exponents[j / block]);
            }
            if self.string.mass(j) > 0.0 {
                peak.look(j, &x, &self.space.forward[j].0);
            }
        }
        peak.at
    }
}

/// The largest product so far, in units of 2^exponents.
struct Peak {
    product: Lanes,
    at: Lanes,
    exponents: [i64; LANES],
}

impl Peak {
    /// Changes the unit to a new block's.
    #[inline(always)]
    fn enter(&mut self, backward: &[i64; LANES], forward: &[i64; LANES]) {
        for i in 0..LANES {
            let unit = backward[i] + forward[i];
            self.product[i] *= power_of_two(self.exponents[i] - unit);
            self.exponents[i] = unit;
        }
    }

    #[inline(always)]
    fn look(&mut self, j: usize, x: &Lanes, y: &Lanes) {
        let product = lanes(|i| (x[i] * y[i]).abs());
        self.at = lanes(|i| if product[i] > ENOUGH * self.product[i] { j as f64 } else { self.at[i] });
        self.product = lanes(|i| if product[i] > self.product[i] { product[i] } else { self.product[i] });
    }
}
