//! The recurrence from one end of the string to the node r, and what rounding took from it.
//!
//! Two operations lead from a node to the next, and their errors f and e are known exactly, being those of a
//! product and a sum each:
//!
//! ```text
//!     v' = v - k x - f,        x' = x + ℓ v' + e,        k = κ m + δ.
//! ```
//!
//! So the force in the spring behind is F = v + e/ℓ (e, ℓ of that spring), and the residual of a node's row
//! is
//!
//! ```text
//!     ρ = F - F' - κ m x = f + δ x + e/ℓ - e'/ℓ'.
//! ```
//!
//! Σ x ρ over the nodes before r is Σ x (f + δ x) + Σ e F − (e/ℓ) x at r (summation by parts); that last term
//! cancels against the row at r. Computed is Σ x (f + δ x) + Σ e v, term by term, so that the roundings'
//! parts need no sums of their own.
//!
//! **Bounds.** To first order |f| ≤ u (|k x| + |v'|), |δ| ≤ 3u κ m, |e'/ℓ'| ≤ u
//! (|v'| + |x'|/ℓ'), |x'|/ℓ' ≤ |x|/ℓ' + |F'|:
//!
//! ```text
//!     |ρ| <= u (4 κ m |x| + (1/ℓ + 1/ℓ') |x| + |F| + 3 |F'|),
//! ```
//!
//! and at r, but for the mismatch there, u ((1/ℓ + 1/ℓ') |x| + |F| + |F'|). See `mode` for what follows.

use super::batch::Batch;
use crate::tongue::string::lanes::{Lanes, lanes, range};
use crate::tongue::string::{HalfString, KINDS, Step};
use number::vector::Vector;

/// A half on its way to r: the node's amplitude, the slope before it, and the sums over the nodes passed, in
/// the scale of x (sums: of x²).
#[derive(Clone, Copy)]
pub struct Half<V> {
    pub x: V,
    pub v: V,
    /// Σ m x².
    pub squares: V,
    /// Σ x (f + δ x) + Σ e v; 0 where nothing is proven.
    pub work: V,
    /// Σ (1/ℓ + 1/ℓ')² x²/m; 0 where nothing is proven.
    pub stretch: V,
}

/// The ways of a batch's modes from either end to the nodes where they live.
pub(crate) struct Ways<'a> {
    string: &'a HalfString,
    left: Way<'a>,
    right: Way<'a>,
}

/// From an end that is free (1) or pinned (0), in each lane its own number of steps.
struct Way<'a> {
    steps: &'a [Step],
    free: &'a Lanes,
    until: Lanes,
    /// Steps that all lanes take.
    together: usize,
}

impl<'a> Ways<'a> {
    #[inline(always)]
    pub fn new(string: &'a HalfString, batch: &'a Batch) -> Self {
        let n = string.last() as f64;
        let left = Way::new(&string.forward, &batch.starts_free, batch.at);
        let right = Way::new(&string.backward, &batch.ends_free, lanes(|i| n - batch.at[i]));
        Ways { string, left, right }
    }

    /// The two halves for the κ of each lane, each on arrival.
    #[inline(always)]
    pub fn halves<V: Vector, const PROVE: bool>(&self, kappa: V) -> [Half<V>; 2] {
        let mut tables = Tables { string: self.string, kicks: [kappa; KINDS], deltas: [kappa; KINDS] };
        tables.fill::<PROVE>(kappa);
        [Half::new::<PROVE>(&tables, &self.left), Half::new::<PROVE>(&tables, &self.right)]
    }
}

impl<'a> Way<'a> {
    #[inline(always)]
    fn new(steps: &'a [Step], free: &'a Lanes, until: Lanes) -> Self {
        let (least, most) = range(&until);
        Way { steps: &steps[..most as usize], free, until, together: least as usize }
    }
}

/// k − κ m for the rounded kick, the mass being m and what rounding took from it: to within 2^-50 of itself
/// and 2^-103 κ m.
#[inline(always)]
pub fn difference<V: Vector>(kappa: V, mass: V, lost: V, kick: V) -> V {
    kappa.neg_mul_add(lost, kappa.neg_mul_add(mass, kick))
}

/// By kind of node: the kick k and, where the mode is proven, δ = k − κ m.
struct Tables<'a, V> {
    string: &'a HalfString,
    kicks: [V; KINDS],
    deltas: [V; KINDS],
}

impl<V: Vector> Tables<'_, V> {
    /// In place: so much is not to be moved.
    #[inline(always)]
    fn fill<const PROVE: bool>(&mut self, kappa: V) {
        for kind in 0..KINDS {
            let (mass, rest) = (V::splat(self.string.masses[kind]), V::splat(self.string.rests[kind]));
            self.kicks[kind] = kappa.mul(mass);
            if PROVE {
                self.deltas[kind] = difference(kappa, mass, rest, self.kicks[kind]);
            }
        }
    }
}

impl<V: Vector> Half<V> {
    #[inline(always)]
    fn new<const PROVE: bool>(tables: &Tables<V>, way: &Way) -> Self {
        let block = tables.string.block;
        let (until, zero, one) = (V::load(&way.until), V::splat(0.0), V::splat(1.0));
        let free = V::load(way.free);
        let mut half = Half { x: free, v: one.sub(free), squares: zero, work: zero, stretch: zero };
        for (b, steps) in way.steps.chunks(block).enumerate() {
            let first = b * block;
            let together = way.together.saturating_sub(first).min(steps.len());
            for step in &steps[..together] {
                half.pass::<PROVE>(tables, step, half.x, V::splat(step.length));
            }
            // Where only some lanes go, nothing moves in the others.
            for (k, step) in steps.iter().enumerate().skip(together) {
                let goes = until.if_above(V::splat((first + k) as f64), one, zero);
                half.pass::<PROVE>(tables, step, goes.mul(half.x), goes.mul(V::splat(step.length)));
            }
            half.rescale::<PROVE>();
        }
        half
    }

    /// The kick at a node, with its amplitude (or 0 for none), and the drift to the next, as long as the
    /// spring (or 0).
    #[inline(always)]
    fn pass<const PROVE: bool>(&mut self, tables: &Tables<V>, step: &Step, amplitude: V, length: V) {
        let kick = tables.kicks[step.kind];
        let square = amplitude.mul(amplitude);
        self.squares = V::splat(step.mass).mul_add(square, self.squares);
        if !PROVE {
            self.v = kick.neg_mul_add(amplitude, self.v);
            self.x = length.mul_add(self.v, self.x);
            return;
        }
        self.stretch = V::splat(step.weight).mul_add(square, self.stretch);
        let (kicked, lost) = kick.two_product(amplitude);
        let (v, rest) = self.v.two_sub(kicked);
        // f = rest - lost.
        let work = tables.deltas[step.kind].mul_add(square, self.work);
        let work = self.x.mul_add(rest, self.x.neg_mul_add(lost, work));
        let (drift, lost) = length.two_product(v);
        let (x, rest) = self.x.two_sum(drift);
        // e = -(rest + lost).
        self.work = v.neg_mul_add(rest, v.neg_mul_add(lost, work));
        (self.x, self.v) = (x, v);
    }

    /// Brings the larger of |x| and |v| to [1, 2), exactly.
    #[inline(always)]
    fn rescale<const PROVE: bool>(&mut self) {
        let factor = self.x.abs().larger(self.v.abs()).normalizing();
        self.x = self.x.mul(factor);
        self.v = self.v.mul(factor);
        self.squares = self.squares.mul(factor).mul(factor);
        if PROVE {
            self.work = self.work.mul(factor).mul(factor);
            self.stretch = self.stretch.mul(factor).mul(factor);
        }
    }
}
