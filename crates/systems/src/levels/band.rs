//! A band of stiffnesses: every fast one up to a factor, the slow ones by a factor, in the first stable
//! region together.
//!
//! Conditions (1) and (2) of proofs/REGION.md at c F and s S hold at every F' ≤ c F and s S; (1) is linear in
//! s, so that both ends of a range of s prove all of it. Condition (3) follows from (1) wherever F' + s S >
//! 0: the system is still at a minimum. Filters are no monotone functions of matrices: of mollified impulses
//! F' has the modes of F, each of a frequency of its own (proofs/REGION.md, section 8).

use faer::Mat;

use super::half::Half;
use super::kernel::{Kernel, Outer};
use super::method::Method;
use crate::signs::inertia::is_definite;
use number::Interval;

/// Room for the roundings of a factor.
const ROOM: f64 = 1e-12;

/// The factors of the slow stiffness, and the largest one of the fast stiffness.
struct Factors {
    least: f64,
    most: f64,
}

impl Kernel {
    /// Whether it is proven stable at this outer step, and at every smaller one of as many inner steps, with
    /// every F' and s S in place of F and S for which F' ≤ F/(1 − b)², (1 + b)⁻² ≤ s ≤ (1 − b)⁻² and F' + s
    /// S > 0, b = `band` in [0, 1): fast periods may be shorter by b each for itself, or longer, the slow
    /// ones by b together. All are known within `epsilon` of their norms. Of mollified impulses F' has the
    /// modes of F; whatever F' is where the midpoint rule solves for it. No two-step method is proven so.
    pub fn covers_band(&self, outer: &Outer, band: f64, epsilon: f64) -> bool {
        let factors = Factors {
            least: (1.0 + band).powi(-2) * (1.0 - ROOM),
            most: (1.0 - band).powi(-2) * (1.0 + ROOM),
        };
        self.is_total_definite()
            && match self.method {
                Method::Respa => self.covers_kicks(outer, &factors, epsilon),
                Method::ImplicitExplicit => self.covers_midpoint(outer, &factors, epsilon),
                Method::Trigonometric(trigonometric) if trigonometric.is_two_step() => false,
                Method::Trigonometric(_) => self.covers_filtered(outer, &factors, epsilon),
            }
    }

    fn covers_kicks(&self, outer: &Outer, factors: &Factors, epsilon: f64) -> bool {
        let [shift, _] = self.errors_within(epsilon);
        // Where errors take an eigenvalue below 0, 0 is above it.
        let highest = |x: &f64| outer.scaled_up((factors.most * (x + shift).max(0.0)).next_up());
        let halves: Vec<Half> =
            self.values.iter().map(|x| Half::new(highest(x), outer.inner_steps)).collect();
        if !halves.iter().all(Half::rises) {
            return false;
        }
        let stretch: Vec<f64> = halves.iter().map(|half| half.stretch().lo).collect();
        self.are_stretched(outer, &stretch, factors, self.shifted(outer, epsilon).slow_slack)
    }

    /// s h² S < 4: then P = 2/h − h S/2 and R = h (F + S)/2 are definite, and that is all there is to show
    /// (theorem `both_definite` in proofs/; of one mode theorem `implicit_explicit` in proofs/).
    fn covers_midpoint(&self, outer: &Outer, factors: &Factors, epsilon: f64) -> bool {
        let [_, slow] = self.errors_within(epsilon);
        // Of the half period of p inner steps a/b is 2/p, in the time unit h.
        let two = vec![(2.0 / outer.inner_steps as f64).next_down(); self.size()];
        // The error of h² S/2, and its rounding.
        let slack = 1.02 * factors.most * outer.half_kick() * (slow + 4.0 * f64::EPSILON * self.norms()[1]);
        is_definite(self.with_slow(outer, &self.slow, -factors.most, &two), slack)
    }

    /// Of the exact flow filtered by φ: κ = (a/b)/φ² increases with w² up to some place and decreases from
    /// there on, so that both ends of a range of w² bound it; P > 0 iff κ − s h² S/2 > 0.
    fn covers_filtered(&self, outer: &Outer, factors: &Factors, epsilon: f64) -> bool {
        let [fast, slow] = self.errors_within(epsilon);
        let (p, most) = (outer.inner_steps, factors.most);
        let moved = 1.01 * most * self.moved(outer, fast);
        let least = |x: &f64| outer.scaled_down((most * x.min(0.0)).next_down());
        let highest = |x: &f64| (outer.scaled_up((most * x.max(0.0)).next_up()) + moved).next_up();
        let ends: Vec<[f64; 2]> = self.values.iter().map(|x| [least(x), highest(x)]).collect();
        let halves = |s: f64| self.method.half(Interval::point(s), p);
        let filter = |s: f64| self.method.filter(Interval::point(s), p);
        if !ends.iter().all(|[_, high]| halves(*high).rises() && filter(*high).lo > 0.0) {
            return false;
        }
        // φ decreases: the fastest mode has the least, what is below 0 the largest.
        let smallest = ends.iter().map(|[_, high]| filter(*high).lo).fold(1.0, f64::min);
        let below = most * self.below(outer, fast);
        let [.., slope] = self.method.slopes(p, below);
        let off = slope * moved;
        let largest = ends.iter().map(|[low, _]| filter(*low).hi).fold(1.0, f64::max) + off;
        // κ of what is within `moved` of a mode, by the filter of the mode itself.
        let room = (1.0 + 1.01 * off / smallest).powi(2) * (1.0 + ROOM);
        let kappa = |s: f64| {
            let phi = filter(s);
            (halves(s).stretch() / (phi * phi)).lo
        };
        let kappa: Vec<f64> =
            ends.iter().map(|end| end.map(kappa).into_iter().fold(f64::INFINITY, f64::min)).collect();
        let stretch: Vec<f64> = kappa.iter().map(|value| value / room * (1.0 - ROOM)).collect();
        let size = self.norms()[1] + slow;
        // The product's entries have some roundings each, of less than a room in all for thousands of modes.
        let moved = 1.01 * (2.0 * off * largest * size + largest * largest * slow) + ROOM * size;
        let slack = 1.01 * outer.half_kick() * moved / (smallest * smallest);
        stretch.iter().all(|value| *value > 0.0) && self.are_stretched(outer, &stretch, factors, slack)
    }

    /// Whether `stretch` − s h² S/2 > 0 at both ends of s.
    fn are_stretched(&self, outer: &Outer, stretch: &[f64], factors: &Factors, slack: f64) -> bool {
        let form = |s: f64| -> Mat<f64> { self.with_slow(outer, &self.slow, -s, stretch) };
        [factors.least, factors.most].into_iter().all(|s| is_definite(form(s), 1.01 * s * slack))
    }

    /// Beyond this outer step no band is covered.
    pub(super) fn band_end(&self, inner_steps: u64) -> f64 {
        match self.method {
            // Every inner step is below its own limit, h w < 2.
            Method::Respa => 2.0 * inner_steps as f64 / self.highest_frequency(),
            Method::ImplicitExplicit => 4.0 / self.highest_slow_frequency(),
            Method::Trigonometric(_) => 4.0 / self.highest_frequency(),
        }
    }
}
