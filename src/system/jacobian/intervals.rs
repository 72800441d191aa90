//! The verdicts on all outer steps, all steps in their ratios, by discs that hold for whole cells of them.
//!
//! In the unit of time of the steps x'' = −A x is x'' = −h² A x with steps of 1. So S of the steps h' and the matrices A is S of the steps h and the matrices
//! (1 + η) A, 1 + η = (h'/h)²: a polynomial S₀ + S₁ η + … whose coefficients are no larger than those of the bound E(η) on the error of matrices
//! known to η times their norms, all of which are positive. Hence
//!
//! ```text
//!     |S(η) − S₀ − S₁ η| ≤ R = E(ρ) (η/ρ)²/(1 − |η|/ρ),     |η| < ρ,
//! ```
//!
//! and |S₁| follows from S at both ends of a cell within 2 R over its width: **all S of a cell are within |S₁ η| + R of the one in its middle**, and what discs
//! that wide prove they prove of the cell (proofs/NO_GRADIENT.md).

use num_traits::One;

use super::model::{Clock, Jacobians};
use super::orbit;
use crate::error::{Error, Result};
use crate::number::rational::from_f64_exact;
use crate::number::{Rational, U};
use crate::system::half::norm;
use crate::system::spectrum::discs::Spectrum;
use crate::system::vary::stretches::{Stretch, cover, most_cells};
use crate::system::verdict::measured::Holds;

/// The least ρ: E grows as the exponential of its root, the bound on the rest falls as its square.
const LEAST_RHO: f64 = 0.25;

impl Jacobians {
    /// This system with all steps `factor` > 0 times as long.
    ///
    /// # Errors
    /// A factor that is not positive.
    pub fn slowed(&self, factor: &Rational) -> Result<Jacobians> {
        let symmetric = self.symmetric.with(&Rational::one(), factor)?;
        let clock = |own: &Clock| Clock { step: &own.step * factor, ..own.clone() };
        let clocks = self.clocks.iter().map(clock).collect();
        let (tick, spectrum) = (&self.tick * factor, Default::default());
        Ok(Jacobians { clocks, tick, symmetric, spectrum, ..self.clone() })
    }

    /// The verdicts on all longest steps from `lo` to `hi`, all steps in their ratios, for the matrices given: stretches that cover them.
    /// No interval wider than `width` times the larger end is missed, unless modes lie so close together that discs cannot decide: then the stretch stays open.
    ///
    /// # Errors
    /// A range that is empty or not positive, a width outside \[10^-9, 1/10\].
    pub fn stretches(&self, (lo, hi): (f64, f64), width: f64) -> Result<Vec<Stretch>> {
        if lo <= 0.0 {
            let remedy = "write the smaller step first, both positive";
            return Err(Error::input("range", format!("{lo}..{hi}"), remedy));
        }
        cover((lo, hi), width, |lo, hi| self.cell(lo, hi))
    }

    /// The products of doubles that these cost, roughly: both halves of a period, eigenvalues and discs of each cell.
    pub fn cost_of_stretches(&self, range: (f64, f64), width: f64) -> f64 {
        most_cells(range, width)
            * (self.size() as f64).powi(3)
            * (3.0 * self.schedule.strikes() as f64 + 60.0)
    }

    /// The verdict that discs prove for all longest steps in \[lo, hi\].
    fn cell(&self, lo: f64, hi: f64) -> Result<Holds> {
        let middle = lo + (hi - lo) / 2.0;
        let longest = self.clocks.iter().map(|own| &own.step).max().expect("one clock or more");
        let at = |step: f64| self.slowed(&(from_f64_exact(step).expect("finite") / longest));
        let delta = (hi - middle).max(middle - lo) / middle;
        let eta = 1.01 * delta * (2.0 + delta) + 4.0 * U;
        let rho = LEAST_RHO.max(4.0 * eta);
        let (s, [error, within]) = orbit::half_product(&Jacobians { accuracy: Some(rho), ..at(middle)? });
        let [(left, [below, _]), (right, [above, _])] =
            [at(lo)?, at(hi)?].map(|own| orbit::half_product(&own));
        let rest = within * (eta / rho).powi(2) / (1.0 - eta / rho);
        let change = norm::frobenius(&(right - left)) + below + above + 2.0 * rest;
        // From η of one end to that of the other.
        let width = (hi - lo) * (hi + lo) / middle.powi(2);
        let off = 1.01 * (change * eta / width + rest + error);
        let spectrum = Spectrum::of(s, off.is_finite().then_some(off));
        Ok(spectrum.and_then(|own| own.by_discs()).into())
    }
}
