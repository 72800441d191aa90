//! A band of stiffnesses: every fast one up to a factor, the slow ones by a factor, in the first stable region together.
//!
//! Conditions (1) and (2) of proofs/REGION.md at c F and s S hold at every F' ≤ c F and s S; (1) is linear in s, so that both ends of a
//! range of s prove all of it. Condition (3) follows from (1) wherever F' + s S > 0: the system is still at a minimum.

use super::half::Half;
use super::kernel::{Kernel, Outer};
use crate::number::bisected;
use crate::system::signs::inertia::is_definite;

/// Room for the roundings of a factor.
const ROOM: f64 = 1e-12;

impl Kernel {
    /// Whether it is proven stable at this outer step, and at every smaller one of as many inner steps, with every F' and s S in
    /// place of F and S for which F' ≤ F/(1 − b)², (1 + b)⁻² ≤ s ≤ (1 − b)⁻² and F' + s S > 0, b = `band` in [0, 1): fast periods may
    /// be shorter by b each for itself, or longer, the slow ones by b together. All are known within `epsilon` of their norms.
    pub fn covers_band(&self, outer: &Outer, band: f64, epsilon: f64) -> bool {
        let most = (1.0 - band).powi(-2) * (1.0 + ROOM);
        let least = (1.0 + band).powi(-2) * (1.0 - ROOM);
        let [shift, _] = self.errors_within(epsilon);
        // Where errors take an eigenvalue below 0, 0 is above it.
        let highest = |x: &f64| outer.scaled_up((most * (x + shift).max(0.0)).next_up());
        let halves: Vec<Half> =
            self.values.iter().map(|x| Half::new(highest(x), outer.inner_steps)).collect();
        if !self.is_total_definite() || !halves.iter().all(Half::rises) {
            return false;
        }
        let stretch: Vec<f64> = halves.iter().map(|half| half.stretch().lo).collect();
        let slack = self.shifted(outer, epsilon).slow_slack;
        [least, most]
            .into_iter()
            .all(|s| is_definite(self.with_slow(outer, &self.slow, -s, &stretch), 1.01 * s * slack))
    }

    /// The outer step, as many inner ones in it, up to which [`Kernel::covers_band`] provably holds, within 1e-6 of the longest; `None`
    /// where it does for none.
    pub fn band_edge(&self, inner_steps: u64, band: f64, epsilon: f64) -> Option<f64> {
        let holds = |step: f64| {
            Outer::new(step, inner_steps).is_ok_and(|outer| self.covers_band(&outer, band, epsilon))
        };
        // Every inner step is below its own limit, h w < 2.
        let hi = 2.0 * inner_steps as f64 / self.highest_frequency();
        let lo = (1..=40).map(|k| hi * 0.5f64.powi(k)).find(|&step| holds(step))?;
        let hi = hi.min(2.0 * lo);
        Some(bisected((lo, hi), 1e-6, |step| Some(holds(step))).0)
    }
    /// The longest step, within 1e-6, up to which the implicit midpoint rule for F beside kicks of S is proven stable: s h² S < 4, with the
    /// slow periods shorter by `band` together and F' + s S > 0. Then P = 2/h − h S/2 and R = h (F + S)/2 are definite, and that is all there is
    /// to show (theorem `both_definite` in proofs/; of one mode theorem `implicit_explicit` in proofs/). `None` where F + S is not proven
    /// definite or no step is proven.
    pub fn midpoint_edge(&self, band: f64, epsilon: f64) -> Option<f64> {
        let most = (1.0 - band).powi(-2) * (1.0 + ROOM);
        let [_, slow] = self.errors_within(epsilon);
        let two = vec![2.0; self.size()];
        let holds = |step: f64| {
            Outer::new(step, 1).is_ok_and(|outer| {
                // Of h² S/2, and of its rounding.
                let slack = 1.02 * most * outer.half_kick() * (slow + 4.0 * f64::EPSILON * self.norms()[1]);
                is_definite(self.with_slow(&outer, &self.slow, -most, &two), slack)
            })
        };
        let hi = 4.0 / self.highest_slow_frequency();
        let lo = (1..=40).map(|k| hi * 0.5f64.powi(k)).find(|&step| hi.is_finite() && holds(step))?;
        self.is_total_definite().then(|| bisected((lo, 2.0 * lo), 1e-6, |step| Some(holds(step))).0)
    }
}
