//! Further results of a map for the pairs that grow.

use crate::resonance::dominant_family;
use number::Interval;
use number::Ratio;

/// The results that are asked for. Verdicts and tiers come always; nothing else is computed unasked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Products {
    /// The label m of the tongue.
    pub label: bool,
    /// The growth of the amplitude.
    pub growth: bool,
}

impl Products {
    pub(super) fn growing(self) -> bool {
        self.label || self.growth
    }
}

/// A pair in a tongue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growing {
    /// The position in the band.
    pub position: u32,
    /// m, where it was asked for.
    pub label: Option<u64>,
    /// ln μ, the growth over one synchronization period, where it was asked for.
    pub ln_multiplier: Option<Interval>,
}

impl Growing {
    /// (a, b), the dominant family of the tongue, where the label was asked for.
    pub fn family(&self, ratio: Ratio) -> Option<(i64, i64)> {
        self.label.map(|m| dominant_family(ratio, m))
    }

    /// The growth rate per unit time: ln μ / T, T = p h1 the synchronization period, within 4u (u = 2^-53)
    /// relatively.
    pub fn rate(&self, period: f64) -> Option<Interval> {
        Some(self.ln_multiplier?.over(period))
    }

    /// Slow steps until the amplitude has grown tenfold: ln 10 / (h2 · rate) = q ln 10 / ln μ.
    pub fn steps_until_tenfold(&self, q: u64) -> Option<Interval> {
        Some(self.ln_multiplier?.under(q as f64 * std::f64::consts::LN_10))
    }
}
