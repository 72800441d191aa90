//! Any number of levels of dense stiffnesses in doubles (nested r-RESPA, or one level): the first stable
//! region, margins, a band.
//!
//! x'' + (K_1 + ... + K_m) x = 0 in mass-weighted coordinates, each K_k on a clock of its own. The theorems
//! of `proofs/REGION.md`, section 1, are about any palindromic schedule, so the action alone decides, without
//! an eigenbasis. With all steps scaled by t
//!
//! ```text
//!     t J[x] = Σ_j |x_j − x_(j−1)|²/τ_j − t² Σ_j x_jᵀ k_j x_j,     k_j the sum of h_k K_k over the clocks at node j, half of it at both ends
//! ```
//!
//! is one matrix over the positions at kick times, block tridiagonal. Cholesky's factorization with its
//! proven bound tells its sign with x held at 0 at one end. Positive for both ends at K_k + e_k I and Σ K_k >
//! 0: stable at this t *and at all smaller ones*, for all stiffnesses within e_k. Positive for one end at the
//! larger of two steps, negative for the other end at the smaller one: unstable at all steps between
//! (section 3). Elsewhere the half period in doubles decides, each kick off by e_k: its forms, or discs about
//! its eigenvalues. Section 10 has the band and all roundings.
//!
//! | file | what is there |
//! |---|---|
//! | `levels` | stiffnesses, and with their steps |
//! | `action` | the action as a matrix, and what its signs and counts prove |
//! | `half` | the half period: discs, at a step and between two, growth, friction |
//!
//! Cost for n degrees of freedom and N kick times in half a period: N n³/2 products for a sign.

mod action;
mod half;
mod levels;

use action::Bounds;
pub use levels::{Nested, Steps};

use faer::Mat;

use super::search::{Decided, EDGE, Search, largest, with_first};
use crate::signs;
use crate::spectrum::discs::Spectrum;
use crate::vary::stretches::Stretch;
use crate::verdict::measured::Holds;
use number::{Result, bisected};

/// Room for the roundings of a factor.
const ROOM: f64 = 1e-12;

impl Steps<'_> {
    /// Whether all stiffnesses within ε of their sizes are proven stable at this outer step, and at every
    /// smaller one.
    pub fn is_in_first_region(&self, step: f64, epsilon: f64) -> bool {
        self.nested.is_definite_within(epsilon) && self.is_positive(step, &self.within(epsilon, 1.0))
    }

    /// The verdict that is proven for all stiffnesses within ε of their sizes.
    pub fn verdict_within(&self, step: f64, epsilon: f64) -> Holds {
        if self.is_in_first_region(step, epsilon) { Holds::Stable } else { self.beyond([step; 2], epsilon) }
    }

    /// The verdict that is proven on all outer steps between two, by the index, too. At one step the index
    /// rarely decides what discs do not, and costs a dozen counts.
    fn verdict_between(&self, ends: [f64; 2], epsilon: f64) -> Holds {
        let is_stable = self.is_in_first_region(ends[1], epsilon) || self.is_stable_by_index(ends, epsilon);
        if is_stable { Holds::Stable } else { self.beyond(ends, epsilon) }
    }

    fn beyond(&self, ends: [f64; 2], epsilon: f64) -> Holds {
        if self.is_unstable_between(ends, epsilon) || self.has_real_unstable_mode(ends, epsilon) {
            return Holds::Unstable;
        }
        if ends[0] < ends[1] {
            return self.by_discs_between(ends, epsilon).into();
        }
        let Some(blocks) = self.half_period(ends[0], epsilon) else { return Holds::Undecided };
        let by_clusters = || Spectrum::new(&blocks)?.certified(&blocks);
        signs::proven(&blocks).or_else(|| self.by_discs_between(ends, epsilon)).or_else(by_clusters).into()
    }

    /// The verdicts that are proven for all stiffnesses within ε of their sizes, as stretches that cover the
    /// outer steps from `lo` to `hi`. No interval wider than `width` times the larger end is missed that
    /// these stiffnesses have in common.
    ///
    /// # Errors
    /// An empty range, a width outside \[10^-9, 1/10\], an interruption.
    pub fn stretches(&self, (lo, hi): (f64, f64), width: f64, epsilon: f64) -> Result<Vec<Stretch>> {
        let holds = |step: f64| self.is_in_first_region(step, epsilon);
        // What is stable at a step of the first region is so at every smaller one.
        let end = match holds(lo) {
            false => lo,
            true if holds(hi) => hi,
            true => bisected((lo, hi), 1e-9, |step| Some(holds(step))).0,
        };
        with_first((lo, hi), end, width, |lo, hi| Ok(self.verdict_between([lo, hi], epsilon)))
    }

    /// The products of doubles that so many cells of a range cost, roughly: of each six counts of chains of
    /// twice as many nodes at both ends, products at each node, and the eigenvalues. Of waters a quarter of
    /// the range is narrow cells, those where nothing is proven.
    pub fn cost_of_cells(&self, cells: f64) -> f64 {
        let each = 40.0 * self.events.len() as f64 + 40.0;
        cells / 4.0 * each * (self.nested.size() as f64).powi(3)
    }

    /// The verdict, and what grows.
    pub fn decide(&self, step: f64, accuracy: f64) -> Decided {
        let is_in_first_region = self.is_in_first_region(step, accuracy);
        let holds = if is_in_first_region { Holds::Stable } else { self.verdict_within(step, accuracy) };
        let given = if holds == Holds::Undecided { self.verdict_within(step, 0.0) } else { holds };
        let found = Decided { holds, is_in_first_region, margin: None, rate: None, growing: None };
        match given {
            Holds::Stable => Decided { margin: self.margin(step), rate: Some(0.0), ..found },
            Holds::Undecided => found,
            Holds::Unstable => {
                let (rate, growing) = self.fastest(step).unzip();
                Decided { rate, growing, ..found }
            }
        }
    }

    /// The largest margin ε, rounded down within a percent in the first region, for which the verdict stands;
    /// `None` where nothing is proven.
    pub fn margin(&self, step: f64) -> Option<f64> {
        if self.is_in_first_region(step, 0.0) {
            return largest(1.01, |epsilon| self.is_in_first_region(step, epsilon));
        }
        let holds = self.verdict_within(step, 0.0);
        (holds != Holds::Undecided)
            .then(|| largest(1.1, |epsilon| self.verdict_within(step, epsilon) == holds))?
    }

    /// Two outer steps, one half the other, at the smaller of which `holds`.
    fn bracket(&self, holds: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
        let at = |k: i32| self.outer * 2f64.powi(k);
        if holds(self.outer) {
            return (1..60).find(|&k| !holds(at(k))).map(|k| (at(k - 1), at(k)));
        }
        (1..40).find(|&k| holds(at(-k))).map(|k| (at(-k), at(1 - k)))
    }
}

impl Search for Steps<'_> {
    fn outer_step(&self) -> f64 {
        self.outer
    }

    fn region_end(&self) -> Option<(f64, f64)> {
        let stable = |step: f64| self.is_in_first_region(step, 0.0);
        Some(bisected(self.bracket(stable)?, EDGE, |step| Some(stable(step))))
    }

    fn is_stable(&self, step: f64) -> bool {
        self.verdict_within(step, 0.0) == Holds::Stable
    }

    fn is_unstable(&self, step: f64) -> bool {
        self.is_unstable_between([step; 2], 0.0)
    }

    fn unstable_end(&self, at: f64, width: f64) -> Result<Option<f64>> {
        let end = at * (1.0 + width);
        Ok(self.is_unstable_between([at, end], 0.0).then_some(end))
    }

    fn rate(&self, step: f64) -> Result<f64> {
        Ok(self.rounded_rate(step))
    }

    /// Whether it is proven stable at this outer step, and at every smaller one, with every K_1' and s_k K_k
    /// in place of the stiffnesses for which K_1' ≤ K_1/(1 − b)², (1 + b)⁻² ≤ s_k ≤ (1 − b)⁻² and the sum is
    /// definite, b = `band` in \[0, 1): the periods of the innermost level may be shorter by b each for
    /// itself, or longer, those of each other level by b together. All are known within ε of their sizes.
    fn covers_band(&self, step: f64, band: f64, epsilon: f64) -> bool {
        let nested = self.nested;
        let [least, most] = [(1.0 + band).powi(-2) * (1.0 - ROOM), (1.0 - band).powi(-2) * (1.0 + ROOM)];
        let error = |k: usize| nested.error_within(k, epsilon);
        let slower = self.kicks.len() - 1;
        let corner = |which: usize| -> Bounds {
            let factor = |k: usize| if which >> k & 1 == 1 { least } else { most };
            // Where the innermost stiffness is below 0, 0 is above it.
            let fast = [most, 1.01 * (error(0) + nested.lack)];
            [fast].into_iter().chain((0..slower).map(|k| [factor(k), error(k + 1)])).collect()
        };
        nested.is_definite_within(0.0) && (0..1 << slower).all(|which| self.is_positive(step, &corner(which)))
    }

    fn band_bracket(&self, holds: &dyn Fn(f64) -> bool) -> Option<(f64, f64)> {
        self.bracket(holds)
    }

    fn damped_period(&self, step: f64, friction: f64) -> Option<(Mat<f64>, f64)> {
        self.whole_damped_period(step, friction)
    }
}
