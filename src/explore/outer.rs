//! A system of many clocks: growth against the outer step, all steps in the proportions of the file, and the modes that grow.

use serde_json::{Value, json};

use super::query::{Query, count};
use super::reply::Reply;
use super::session::Session;
use crate::error::{Error, Result};
use crate::number::parse::parse_rational_range;
use crate::number::{Rational, rational};
use crate::parallel::try_map;
use crate::report::system::{Beside, document};
use crate::scene::SystemScene;
use crate::system::{Limits, Potential, Route, System, decide_by, verdict_cost};

/// Products that all samples together may cost, some 10 s of a core.
pub(super) const MOST_PRODUCTS: u64 = 20_000_000_000;

/// The relative width of intervals that none is missed of, of measured stiffnesses.
const WIDTH: f64 = 1e-3;

/// `outer`, `rate` (null where it is not told) and `kind` at evenly spaced outer steps, `own` the file's outer step, `verdict` the document
/// of the file's own steps, `unit` of time; of measured stiffnesses `stretches` {`lo`, `hi`, `verdict`} that cover the range.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let none =
        || Error::missing("system", "start the page on a system file, as data/scenes/diatomic-tether.json");
    let scene = session.system().ok_or_else(none)?;
    let own =
        scene.system().clocks().iter().map(|clock| clock.step.clone()).max().expect("a system has clocks");
    let (lo, hi) = match query.read("outer", parse_rational_range)? {
        Some(range) => range,
        None => (&own * rational::ratio(1, 4), &own * rational::ratio(2, 1)),
    };
    if lo <= Rational::default() || hi == lo {
        return Err(Error::input("outer", format!("{lo}..{hi}"), "write a range of positive steps"));
    }
    let samples = query.read("samples", count(2, 1000))?.unwrap_or(200);
    let part = (&hi - &lo) / Rational::from_integer((samples - 1).into());
    let steps = (0..samples).map(|k| &lo + &part * Rational::from_integer(k.into())).collect::<Vec<_>>();
    let doubles: Vec<f64> = steps.iter().map(rational::to_f64).collect();
    let mut body = match scene.stretches((doubles[0], doubles[doubles.len() - 1]), WIDTH) {
        Ok((_, stretches)) => {
            let all = stretches
                .iter()
                .map(|own| json!({"lo": own.lo, "hi": own.hi, "verdict": own.verdict.name()}));
            json!({"rate": scene.growth_rates(&doubles)?, "kind": null, "stretches": all.collect::<Vec<_>>()})
        }
        // Stiffnesses that are exact, or not of two levels.
        Err(_) => sampled(scene.system(), &own, &steps)?,
    };
    let analysis = scene.decide(Route::Cheapest, &Limits::default())?;
    let beside = Beside { unit: scene.time_unit(), labels: scene.labels(), ..Beside::default() };
    body["verdict"] = document(&analysis, &beside).value();
    body["outer"] = doubles.into();
    body["own"] = rational::to_f64(&own).into();
    body["unit"] = scene.time_unit().into();
    body["title"] = SystemScene::title(scene).into();
    Ok(Reply::json(&body))
}

/// Every sample a verdict of its own.
fn sampled(system: &System, own: &Rational, steps: &[Rational]) -> Result<Value> {
    let cost = verdict_cost(system).saturating_mul(steps.len() as u64);
    if cost > MOST_PRODUCTS {
        return Err(Error::budget(format!("{} verdicts on this system", steps.len()), cost)
            .or("ask for fewer samples"));
    }
    let found = try_map(steps, |step| {
        let factor = step / own;
        let longer = |of: &Potential| Potential { step: &of.step * &factor, ..of.clone() };
        let scaled = System::new(system.mass().clone(), system.potentials().iter().map(longer).collect())?;
        let analysis = decide_by(Route::Cheapest, &scaled, &Limits::default())?;
        Ok((analysis.kind.name(), analysis.growth_rate()))
    })?;
    let (kinds, rates): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    Ok(json!({"rate": rates, "kind": kinds, "stretches": null}))
}
