//! Advice on Hessians: computed again, whole; what it proves, and growth, by another route.

use serde_json::Value;

use crate::advise::{Finding, MOST_PRODUCTS};
use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::question::{Advised, Question, Safe, Work};
use crate::recheck::again::{Left, Recheck};
use crate::recheck::context::{Checked, Context, Outcome, REMEDY, holds, too_costly};
use crate::scene::{Arrays, SystemScene};
use crate::system::Limits;
use crate::system::levels::{Hessians, Near};

/// The action and the full period, in the coordinates of the Hessians.
struct Other {
    hessians: Hessians,
    /// Upper bounds of both norms, times the accuracy.
    off: [f64; 2],
    band: f64,
    /// fs in the file's unit of time.
    unit: f64,
}

/// A route's room at the end of a region, relative: the smallest eigenvalue of the action there is some 10^-6 of its largest.
const ROOM: f64 = 1e-6;

/// By how much growth per period may differ: a multiplier near a double one moves by the square root of the roundings.
const GROWTH: f64 = 1e-5;

impl Other {
    fn new(scene: &SystemScene, band: f64) -> Result<Other> {
        let levels = scene.model().two_levels()?;
        let off = levels.kernel.norms().map(|norm| levels.accuracy * norm);
        let unit = to_f64(&scene.femtoseconds()?);
        Ok(Other { hessians: scene.model().hessians()?, off, band, unit })
    }

    fn inner_steps(own: &Finding) -> u64 {
        to_f64(&(own.scheme.outer() / own.scheme.inner())).round() as u64
    }

    fn has_paths(&self, own: &Finding) -> bool {
        self.hessians.has_paths(Other::inner_steps(own))
    }

    /// The products that a row costs, about.
    fn cost(&self, own: &Finding) -> u64 {
        let p = Other::inner_steps(own);
        let paths = if self.has_paths(own) { self.hessians.cost_of_paths(p) } else { 0 };
        self.hessians.cost_of_period(p).saturating_add(paths)
    }

    fn row(&self, own: &Finding) -> Checked {
        let (p, outer) = (Other::inner_steps(own), to_f64(own.scheme.outer()));
        let growth = self.hessians.growth_of_period(outer / self.unit, p) * outer / self.unit;
        let right = own.rate.is_none_or(|rate| (growth - rate * outer).abs() < GROWTH);
        holds(right, || format!("growth is {growth} in a period"))?;
        if !self.has_paths(own) {
            return Ok(());
        }
        let stable = |step: f64, near: Near| self.hessians.paths_prove_stable(step / self.unit, p, near);
        let unstable = |step: f64| self.hessians.paths_prove_unstable(step / self.unit, p);
        if let Some((lo, hi)) = own.first {
            holds(stable(lo * (1.0 - ROOM), Near::EXACTLY), || format!("is not proven stable up to {lo}"))?;
            holds(unstable(hi * (1.0 + ROOM)), || format!("is not proven unstable from {hi} on"))?;
        }
        if let Some(upper) = own.first_upper {
            holds(unstable(upper * (1.0 - ROOM)), || format!("is not proven unstable up to {upper}"))?;
        }
        if let Some(edge) = own.band_edge {
            let [most, least] = [1.0 - self.band, 1.0 + self.band].map(|part| part.powi(-2));
            for slow in [most, least] {
                let off = [most * self.off[0], slow * self.off[1]];
                let near = Near { factors: [most, slow], off };
                holds(stable(edge * (1.0 - ROOM), near), || {
                    format!("the band is not proven stable up to {edge}")
                })?;
            }
        }
        Ok(())
    }
}

/// `kickdrift/advise-system/1`.
#[derive(Clone, Debug, serde::Deserialize)]
pub struct Claim {
    input: Advised,
}

const ROUTE: &str = "the ends of the first region and of the band by the action as one matrix over the paths, growth by the full \
                     period kick by kick";

impl Recheck for Claim {
    const TABLE: &'static str = "rows";
    const LEFT: &'static [Left] =
        &[("input.file", "a name"), ("engine", "the text that it was read from is not part of the document")];
    type Found = Safe;

    fn again(&self, context: &Context) -> Result<(Value, Safe)> {
        let arrays = Arrays::from(&context.options.folder);
        let safe = self.input.answer(&Work { arrays: Some(&arrays), ..context.work() })?;
        Ok((self.input.document(&safe).value(), safe))
    }

    fn check(&self, safe: Safe, context: &Context) -> Result<Outcome> {
        let Safe::Hessians(own) = safe else { return Err(Error::missing("input.system", REMEDY)) };
        let (scene, findings) = *own;
        let other = Other::new(&scene, to_f64(&self.input.band))?;
        let (mut failures, mut not_rechecked) = (Vec::new(), Vec::new());
        let limits =
            Limits { products: context.options.budget.unwrap_or(MOST_PRODUCTS), ..Limits::default() };
        let mut spent: u64 = 0;
        for (row, own) in (1..).zip(&findings.schemes) {
            let cost = spent.saturating_add(other.cost(own));
            if let Err(error) = limits.allow(cost, || format!("schemes 1 to {row}")) {
                not_rechecked.push(too_costly(&format!("row {row}"), &error));
                continue;
            }
            spent = cost;
            let place = || format!("outer step {} fs", own.scheme.outer());
            failures.extend(context.failure(row, place, other.row(own))?);
        }
        if !findings.schemes.iter().all(|own| other.has_paths(own)) {
            let why = "first, band_edge by the other route: too many steps for the action's matrix, computed again only";
            not_rechecked.push(why.into());
        }
        if findings.levers.is_some() {
            not_rechecked.push("levers: computed again only".into());
        }
        Ok(Outcome {
            rows: findings.schemes.len() as u64,
            route: ROUTE,
            sample: None,
            failures,
            not_rechecked,
        })
    }
}
