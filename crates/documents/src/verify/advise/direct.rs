//! Advice on forces that are no gradient: its growth by the dense full period.

use crate::input::SystemScene;
use crate::verify::context::{Checked, Outcome, REMEDY, failure, holds};
use molecules::DirectFindings;
use number::{Error, Rational, Result, to_f64};
use systems::Jacobians;

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

pub fn check(scene: &SystemScene, findings: &DirectFindings) -> Result<Outcome> {
    let refused = || Error::missing("input.system.symmetric", REMEDY);
    let jacobians = scene.model().jacobians().ok_or_else(refused)?;
    let unit = scene.femtoseconds()?;
    let mut outcome = Outcome::holding(ROUTE, findings.schemes.len() as u64);
    for (row, finding) in (1..).zip(&findings.schemes) {
        let Some(rate) = finding.rate else {
            outcome.not_rechecked.push(format!("row {row}: its growth is not bounded"));
            continue;
        };
        let grows = growth(jacobians, &unit, finding.scheme.steps(), rate);
        outcome.failures.extend(failure(row, grows)?);
    }
    outcome.not_rechecked.push("ladder, friction: computed again only".into());
    Ok(outcome)
}
