//! Labels and growth of a band's pairs in tongues.

use super::band::Band;
use super::bases::OnBase;
use super::growth::ln_multiplier;
use super::products::{Growing, Products};
use super::work::{LANES, MOST_TOGETHER, Work};
use crate::orbit::filter::{Ends, Group};
use crate::orbit::floquet::{Floquet, Pair};
use crate::orbit::{plain, returns};
use crate::propagator::TwoClocks;
use crate::schedule::Schedule;
use crate::verdict::{Kind, Tier, Verdict, growth, label};
use number::vector::instructions::Instructions;
use number::{Interval, Laurent, Result};

impl Work<'_> {
    /// A second run over the pairs in tongues, a third over those of which it gives too little, then kick by
    /// kick in doubles and in two doubles, and more bits for the rest.
    pub(super) fn grow(&self, band: &mut Band, products: Products) -> Result<()> {
        let verdict = |n: usize| Verdict::ALL[usize::from(band.verdicts[n])];
        let hyperbolic = |&n: &u32| verdict(n as usize).kind() == Kind::Hyperbolic;
        let mut rest: Vec<u32> = self.order().iter().copied().filter(hyperbolic).collect();
        let (mut growing, mut seen) = (Vec::with_capacity(rest.len()), vec![false; band.verdicts.len()]);
        let mut kicks = 0;
        for most in BLOCKS {
            let (mut group, mut ends) = (Group::<LANES>::watched(Instructions::best(), most), [None; LANES]);
            kicks += self.side_by_side(&rest, MOST_TOGETHER, |pairs, positions| {
                let pairs: Vec<Pair> = pairs.iter().map(OnBase::pair).collect();
                let ends = &mut ends[..pairs.len()];
                if products.label {
                    group.everything(&pairs, ends)
                } else {
                    group.measured(&pairs, ends)
                }
                for (&n, ends) in positions.iter().zip(ends) {
                    let ends = ends.as_ref().filter(|_| band.tiers[n] == Tier::Filter as u8);
                    let found = ends.and_then(|ends| quick(n, ends, verdict(n), products));
                    seen[n] = found.is_some();
                    growing.extend(found);
                }
                group.kicks()
            })?;
            rest.retain(|&n| !seen[n as usize]);
        }
        for n in rest.into_iter().map(|n| n as usize) {
            self.go_on()?;
            let (i, j) = self.multipliers(n);
            let clocks = self.grid().clocks(i, j)?;
            let found = |ends: Ends| quick(n, &ends, verdict(n), products);
            if let Some(found) = kick_by_kick(&clocks, found) {
                growing.push(found);
                continue;
            }
            let grown = growth(&clocks, verdict(n), self.limits())?;
            let ln = grown.ln_multiplier.filter(|_| products.growth).map(|ln| Interval::of(&ln));
            let label = grown.label.filter(|_| products.label);
            growing.push(Growing { position: n as u32, label, ln_multiplier: ln });
        }
        growing.sort_unstable_by_key(|found: &Growing| found.position);
        (band.growing, band.counters.kicks_again) = (growing, kicks);
        Ok(())
    }
}

/// Updates between two looks: few suffice for most pairs, looks at every one cost twice as much and suffice
/// for more.
const BLOCKS: [u64; 2] = [4, 1];

/// Growth that the filter knows less well than this, relatively, is computed with more bits.
const PRECISION: f64 = 1e-6;

/// The ends of a run in doubles, for a pair that has no base, or in two doubles. `None` for long periods,
/// which have return maps.
fn kick_by_kick<T>(clocks: &TwoClocks<Laurent>, mut found: impl FnMut(Ends) -> Option<T>) -> Option<T> {
    if returns::is_worth(clocks.ratio(), 53) {
        return None;
    }
    let schedule = Schedule::two_clocks(clocks.ratio()).ok()?;
    let quick = if Floquet::new(clocks).is_none() { plain::run(clocks, &schedule) } else { None };
    quick.and_then(&mut found).or_else(|| found(plain::sharp(clocks, &schedule)?))
}

/// The products asked for, as far as the filter gives them.
fn quick(n: usize, ends: &Ends, verdict: Verdict, products: Products) -> Option<Growing> {
    let label = if products.label { Some(label(ends, verdict)?) } else { None };
    let growth = || ln_multiplier(ends, verdict.side()).filter(|ln| ln.within(PRECISION));
    let ln_multiplier = if products.growth { Some(growth()?) } else { None };
    Some(Growing { position: n as u32, label, ln_multiplier })
}
