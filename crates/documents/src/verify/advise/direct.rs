//! Advice on forces that are no gradient: computed again, whole; its growth by the dense full period.

use super::LEFT;
use crate::question::{Advised, Safe};
use crate::verify::again::{Left, Recheck, asked};
use crate::verify::context::{Checked, Context, Outcome, REMEDY, holds};
use number::Rational;
use number::error::{Error, Result};
use number::rational::to_f64;
use systems::Jacobians;

/// `kickdrift/advise-direct/1`.
#[derive(Clone, Debug, serde::Deserialize)]
pub struct Claim {
    input: Advised,
}

/// By how much growth over a period may differ: a multiplier near a double one moves by the root of the
/// roundings.
const GROWTH: f64 = 1e-6;

const ROUTE: &str =
    "the growth of each scheme by the eigenvalues of the dense full period, kick by kick in doubles";

fn growth(jacobians: &Jacobians, unit: &Rational, steps: &[Rational], rate: (f64, f64)) -> Checked {
    let at = jacobians.with_steps(&steps.iter().map(|step| step / unit).collect::<Vec<_>>())?;
    let found = at.full_period().complex_eigenvalues().iter().map(|z| z.norm().ln()).fold(0.0, f64::max);
    let [lo, hi] = [rate.0, rate.1].map(|rate| rate * to_f64(&(at.period() * unit)));
    holds(lo - GROWTH <= found && found <= hi + GROWTH, || {
        format!("growth over a period is {found}, not {lo} to {hi}")
    })
}

impl Recheck for Claim {
    const TABLE: &'static str = "rows";
    const LEFT: &'static [Left] = LEFT;
    asked!(Advised);

    fn check(&self, safe: Safe, context: &Context) -> Result<Outcome> {
        let Safe::Direct(pair) = safe else { return Err(Error::missing("input.system", REMEDY)) };
        let (scene, findings) = *pair;
        let refused = || Error::missing("input.system.symmetric", REMEDY);
        let jacobians = scene.model().jacobians().ok_or_else(refused)?;
        let unit = scene.femtoseconds()?;
        let (mut failures, mut not_rechecked) = (Vec::new(), Vec::new());
        for (row, direct_finding) in (1..).zip(&findings.schemes) {
            let place = || format!("outer step {} fs", direct_finding.scheme.outer());
            let Some(rate) = direct_finding.rate else {
                not_rechecked.push(format!("row {row}: its growth is not bounded"));
                continue;
            };
            let checked = growth(jacobians, &unit, direct_finding.scheme.steps(), rate);
            failures.extend(context.failure(row, place, checked)?);
        }
        not_rechecked.push("ladder, friction: computed again only".into());
        Ok(Outcome {
            rows: findings.schemes.len() as u64,
            route: ROUTE,
            sample: None,
            failures,
            not_rechecked,
        })
    }
}
