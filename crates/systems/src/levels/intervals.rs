//! Stable and unstable stretches of outer steps at a fixed ratio, without a gap.

use super::cell::Cells;
use super::kernel::{Kernel, Outer};
use super::search::with_first;
use crate::spectrum::rate::exponent;
use crate::vary::stretches::Stretch;
use crate::verdict::measured::Holds;
use number::{Error, Result};

impl Kernel {
    /// The largest growth rate ln |λ|/H at an outer step H, per unit time, rounded; `None` where the period
    /// is beyond doubles.
    pub fn growth_rate(&self, outer: &Outer) -> Option<f64> {
        let (_, spectrum) = self.spectrum(outer, false)?;
        Some(spectrum.mu.iter().map(|&mu| exponent(mu).re).fold(0.0, f64::max) / outer.step)
    }

    /// The verdicts that are proven for all stiffnesses within `accuracy` of their norms on all outer steps
    /// of `inner_steps` inner ones from `lo` to `hi`, as stretches that cover them. No interval wider than
    /// `width` times the larger end is missed that the accuracy resolves.
    ///
    /// Cost: the first stable region is one bisection; beyond it two factorizations and, where these cannot
    /// decide, the eigenvalues for each cell (file `cell`), more cells where intervals are thin.
    ///
    /// # Errors
    /// A range that is empty or not positive, a width outside \[10^-9, 1/10\].
    pub fn stretches(
        &self,
        inner_steps: u64,
        (lo, hi): (f64, f64),
        width: f64,
        accuracy: f64,
    ) -> Result<Vec<Stretch>> {
        if !(lo > 0.0 && lo < hi && hi.is_finite()) {
            let remedy = "write the smaller step first, both positive";
            return Err(Error::input("range", format!("{lo}..{hi}"), remedy));
        }
        let first = self.first_region_end(inner_steps, accuracy).map_or(lo, |(end, _)| end.clamp(lo, hi));
        let cells = Cells::new(self, accuracy)?;
        with_first((lo, hi), first, width, |lo, hi| cells.verdict(inner_steps, (lo, hi)))
    }

    /// The verdict that is proven for all stiffnesses within `epsilon` of their norms.
    pub fn verdict_within(&self, outer: &Outer, epsilon: f64) -> Holds {
        if self.is_in_first_region(outer, epsilon) {
            return Holds::Stable;
        }
        if self.has_real_unstable_mode(outer, epsilon) {
            return Holds::Unstable;
        }
        if self.is_stable_by_index(outer, epsilon) {
            return Holds::Stable;
        }
        self.beyond(outer, epsilon).into()
    }
}
