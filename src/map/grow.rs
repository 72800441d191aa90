//! Labels and growth of a band's pairs in tongues.

use super::band::Band;
use super::enclosure::Enclosure;
use super::growth::ln_multiplier;
use super::products::{Growing, Products};
use super::work::{LANES, Work};
use crate::error::Result;
use crate::orbit::filter::{Ends, Group};
use crate::vector::instructions::Instructions;
use crate::verdict::{Kind, Tier, Verdict, growth, label};

impl Work<'_> {
    /// A second run over the pairs in tongues.
    pub(super) fn grow(&self, band: &mut Band, products: Products) -> Result<()> {
        let verdict = |n: usize| Verdict::ALL[usize::from(band.verdicts[n])];
        let hyperbolic = |&n: &u32| verdict(n as usize).kind() == Kind::Hyperbolic;
        let order: Vec<u32> = self.order().iter().copied().filter(hyperbolic).collect();
        let mut growing = Vec::with_capacity(order.len());
        let mut group = Group::<LANES>::precise(Instructions::best());
        let mut ends = [None; LANES];
        let mut seen = vec![false; band.verdicts.len()];
        let kicks = self.side_by_side(&order, |pairs, positions| {
            group.everything(pairs, &mut ends[..pairs.len()]);
            for (&n, ends) in positions.iter().zip(&ends) {
                let ends = ends.as_ref().filter(|_| band.tiers[n] == Tier::Filter as u8);
                let found = ends.and_then(|ends| quick(n, ends, verdict(n), products));
                seen[n] = found.is_some();
                growing.extend(found);
            }
        })?;
        let rest = order.iter().map(|&n| n as usize).filter(|&n| !seen[n]);
        for n in rest {
            let (i, j) = self.multipliers(n);
            let grown = growth(&self.grid().clocks(i, j)?, verdict(n), self.limits())?;
            let ln = grown.ln_multiplier.filter(|_| products.growth).map(|ln| Enclosure::of(&ln));
            let label = grown.label.filter(|_| products.label);
            growing.push(Growing { position: n as u32, label, ln_multiplier: ln });
        }
        growing.sort_unstable_by_key(|found: &Growing| found.position);
        (band.growing, band.counters.kicks_again) = (growing, kicks);
        Ok(())
    }
}

/// Growth that the filter knows less well than this, relatively, is computed with more bits.
const PRECISION: f64 = 1e-6;

/// What is asked for, as far as the filter tells it.
fn quick(n: usize, ends: &Ends, verdict: Verdict, products: Products) -> Option<Growing> {
    let label = if products.label { Some(label(ends, verdict)?) } else { None };
    let growth = || ln_multiplier(ends, verdict.side()).filter(|ln| ln.within(PRECISION));
    let ln_multiplier = if products.growth { Some(growth()?) } else { None };
    Some(Growing { position: n as u32, label, ln_multiplier })
}
