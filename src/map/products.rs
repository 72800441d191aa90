//! What a map may tell beside the verdicts, of the pairs that grow.

use super::band::{Band, LANES, Work};
use crate::error::Result;
use crate::number::Ratio;
use crate::orbit::filter::{Ends, Group};
use crate::resonance::dominant_family;
use crate::vector::instructions::Instructions;
use crate::verdict::{Kind, Tier, Verdict, growth, label};

/// What is asked for. Verdicts and tiers come always; nothing else is computed unasked.
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
    /// ln μ, the growth over one synchronization period, where it was asked for: rounded, with a relative error
    /// that its certificate keeps small unless |Tr| − 2 is tiny.
    pub ln_multiplier: Option<f64>,
}

impl Growing {
    /// (a, b), the dominant family of the tongue, where the label was asked for.
    pub fn family(&self, ratio: Ratio) -> Option<(i64, i64)> {
        self.label.map(|m| dominant_family(ratio, m))
    }

    /// The growth rate per unit time: ln μ / T, T = p h1 the synchronization period.
    pub fn rate(&self, period: f64) -> Option<f64> {
        Some(self.ln_multiplier? / period)
    }

    /// Slow steps until the amplitude has grown tenfold: ln 10 / (h2 · rate) = q ln 10 / ln μ.
    pub fn steps_until_tenfold(&self, q: u64) -> Option<f64> {
        Some(q as f64 * std::f64::consts::LN_10 / self.ln_multiplier?)
    }
}

impl Work<'_> {
    /// A second run over the pairs in tongues.
    pub(super) fn grow(&self, band: &mut Band, products: Products) -> Result<()> {
        let verdict = |n: usize| Verdict::ALL[usize::from(band.verdicts[n])];
        let hyperbolic = |&n: &u32| verdict(n as usize).kind() == Kind::Hyperbolic;
        let order: Vec<u32> = self.order().iter().copied().filter(hyperbolic).collect();
        let mut growing = Vec::with_capacity(order.len());
        let mut group = Group::<LANES>::new(Instructions::best());
        let mut ends = [None; LANES];
        let mut seen = vec![false; band.verdicts.len()];
        let kicks = self.side_by_side(&order, |pairs, positions| {
            group.everything(pairs, &mut ends[..pairs.len()]);
            for (&n, ends) in positions.iter().zip(&ends) {
                let ends = ends.as_ref().filter(|_| band.tiers[n] == Tier::Filter as u8);
                let found = ends.map(|ends| quick(n, ends, verdict(n), products));
                let found = found.filter(|found| found.label.is_some() == products.label);
                seen[n] = found.is_some();
                growing.extend(found);
            }
        })?;
        let rest = order.iter().map(|&n| n as usize).filter(|&n| !seen[n]);
        for n in rest {
            let (i, j) = self.multipliers(n);
            let grown = growth(&self.grid().clocks(i, j)?, verdict(n), self.limits())?;
            let ln = grown.ln_multiplier.filter(|_| products.growth).map(|ln| ln.mid_f64());
            let label = grown.label.filter(|_| products.label);
            growing.push(Growing { position: n as u32, label, ln_multiplier: ln });
        }
        growing.sort_unstable_by_key(|found: &Growing| found.position);
        (band.growing, band.counters.kicks_again) = (growing, kicks);
        Ok(())
    }
}

fn quick(n: usize, ends: &Ends, verdict: Verdict, products: Products) -> Growing {
    let label = if products.label { label(ends, verdict) } else { None };
    let ln_multiplier = products.growth.then(|| ln_multiplier(ends, verdict));
    Growing { position: n as u32, label, ln_multiplier }
}

/// ln μ = 2 asinh √(BC) or 2 asinh √(−AD).
fn ln_multiplier(ends: &Ends, verdict: Verdict) -> f64 {
    let (even, odd) = (&ends.even, &ends.odd);
    let product = if verdict.side() > 0 { odd.x * even.v } else { even.x * odd.v };
    let exponent = (even.exponent + odd.exponent) as f64;
    let ln_product = product.abs().ln() + exponent * std::f64::consts::LN_2;
    // 2 asinh √z = ln 4z (1 + O(1/z)).
    if ln_product > 40.0 { ln_product + 4f64.ln() } else { 2.0 * ln_product.exp().sqrt().asinh() }
}
