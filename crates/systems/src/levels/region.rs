//! The first stable region: verdict, margin, and where it ends.

use std::borrow::Cow;

use faer::Mat;

use super::half::Half;
use super::kernel::{Kernel, Outer, STEP_ERROR};
use super::search::{EDGE, bracket_below, largest};
use crate::half::norm;
use crate::signs::inertia::is_definite;
use number::bisected;

/// The halves of all modes with every stiffness shifted by as much as errors and `epsilon` allow.
pub(super) struct Shifted<'a> {
    /// Fast stiffnesses decreased, increased.
    pub less: Vec<Half>,
    pub more: Vec<Half>,
    /// The slow stiffness, filtered.
    pub slow: Cow<'a, Mat<f64>>,
    /// ‖E₂‖ times half an outer kick, and the rounding of that product's entries.
    pub slow_slack: f64,
}

impl Kernel {
    pub(super) fn shifted(&self, outer: &Outer, epsilon: f64) -> Shifted<'_> {
        let shifts = self.errors_within(epsilon);
        let shift = shifts[0].next_up();
        let ends =
            |x: &f64| (outer.scaled_down((x - shift).next_down()), outer.scaled_up((x + shift).next_up()));
        let around = |x: &f64| self.method.around(ends(x), outer.inner_steps);
        let (less, more) = self.values.iter().map(around).map(|[less, more]: [Half; 2]| (less, more)).unzip();
        let (slow, off) = self.filtered(outer, shifts);
        let rounding = 2.0 * STEP_ERROR * norm::frobenius(slow.as_ref());
        Shifted { less, more, slow, slow_slack: 1.01 * outer.half_kick() * (off + rounding) }
    }

    /// diag(d) + sign (p/2) h² S', S' as it is given.
    pub(super) fn with_slow(&self, outer: &Outer, slow: &Mat<f64>, sign: f64, diagonal: &[f64]) -> Mat<f64> {
        let factor = sign * outer.half_kick();
        let m = self.size();
        let mut form = Mat::from_fn(m, m, |i, j| factor * slow[(i, j)]);
        diagonal.iter().enumerate().for_each(|(i, x)| form[(i, i)] += x);
        form
    }

    /// Whether all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, are proven to be in the first stable
    /// region.
    pub fn is_in_first_region(&self, outer: &Outer, epsilon: f64) -> bool {
        let shifted = self.shifted(outer, epsilon);
        if !shifted.more.iter().all(|half| half.rises()) || !shifted.less.iter().all(|half| half.d.lo > 0.0) {
            return false;
        }
        let stretch: Vec<f64> = shifted.more.iter().map(|half| half.stretch().lo).collect();
        let restoring: Vec<f64> = shifted.less.iter().map(|half| half.restoring().lo).collect();
        let is_definite = |sign: f64, diagonal: &[f64]| {
            is_definite(self.with_slow(outer, &shifted.slow, sign, diagonal), shifted.slow_slack)
        };
        is_definite(-1.0, &stretch) && is_definite(1.0, &restoring)
    }

    /// The largest ε, within a percent (in the first stable region) or a tenth, for which
    /// [`Kernel::is_stable`] holds; `None` where it does not for 0.
    pub fn margin(&self, outer: &Outer) -> Option<f64> {
        let is_in_region = self.is_in_first_region(outer, 0.0);
        let stable = if is_in_region { Kernel::is_in_first_region } else { Kernel::is_stable_by_index };
        let width = if is_in_region { 1.01 } else { 1.1 };
        largest(width, |epsilon| stable(self, outer, epsilon))
    }

    /// Two outer steps, 1e-8 apart, relative: all stiffnesses within `epsilon` of their norms are proven
    /// stable at every step in (0, lo], and not proven to be in the first region at hi. `None` where no such
    /// step is found, or F + S is not proven definite.
    pub(super) fn first_region_end(&self, inner_steps: u64, epsilon: f64) -> Option<(f64, f64)> {
        let outer = |step: f64| Outer::new(step, inner_steps).ok();
        if !self.is_total_definite_within(epsilon) || self.highest_frequency() == 0.0 {
            return None;
        }
        let shift = self.errors_within(epsilon)[0];
        let highest = (self.values.last().copied().unwrap_or(0.0) + shift).next_up().sqrt();
        let is_below = |outer: &Outer| {
            let end = self.method.first_region_ends();
            let inner = end.is_infinite() || self.below(outer, shift) * (inner_steps as f64).powi(2) < 1.0;
            inner && outer.step * highest < end
        };
        let stable = |step: f64| {
            outer(step).is_some_and(|outer| is_below(&outer) && self.is_in_first_region(&outer, epsilon))
        };
        let hi = match self.method.highest_angle(inner_steps) {
            Some(angle) => angle / self.highest_frequency(),
            None => 2.000_002 / self.highest_slow_frequency(),
        };
        Some(bisected(bracket_below(hi, stable)?, EDGE, |step| Some(stable(step))))
    }
}
