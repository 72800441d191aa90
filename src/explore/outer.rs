//! A system of many clocks: growth against the outer step, all steps in the proportions of the file, and the
//! modes that grow.

use serde_json::{Value, json};

use super::query::{Query, count, positive, spaced};
use super::reply::Reply;
use super::session::Session;
use documents::input::{Span, SystemScene};
use documents::report::system::{Beside, document};
use number::error::Kind;
use number::parse::parse_rational_range;
use number::{Error, Rational, Result, rational};
use systems::stretches::Stretch;
use systems::{Analysis, Limits, Route};

/// Products that all samples together may cost, some 10 s of a core.
pub(super) const MOST_PRODUCTS: u64 = 20_000_000_000;

/// The relative width of intervals that none is missed of.
const WIDTH: f64 = 1e-3;

/// The verdict's document at the outer step `at`, all steps in the proportions of the file: the modes that
/// grow there.
pub(super) fn modes(session: &Session, query: &Query) -> Result<Reply> {
    let scene = system(session)?;
    let at = query.need("at", positive)?;
    if scene.model().cost() > MOST_PRODUCTS {
        return Err(Error::budget("a verdict on this system", scene.model().cost()));
    }
    let analysis = scene.model().decide_at(&at, &Limits::default())?;
    Ok(Reply::json(&json!({"at": rational::to_f64(&at), "verdict": verdict(scene, &analysis)})))
}

fn system(session: &Session) -> Result<&SystemScene> {
    let remedy = "start the page on a system file, as data/scenes/diatomic-tether.json";
    session.system().ok_or_else(|| Error::missing("system", remedy))
}

fn verdict(scene: &SystemScene, analysis: &Analysis) -> Value {
    let beside = Beside { unit: scene.time_unit(), labels: scene.labels(), ..Beside::default() };
    document(analysis, &beside).value()
}

/// The file's outer step, and the range asked for: from a quarter of it to twice it, where none is.
fn range(scene: &SystemScene, query: &Query) -> Result<(Rational, (Rational, Rational))> {
    let value = scene
        .model()
        .system()
        .clocks()
        .iter()
        .map(|clock| clock.step.clone())
        .max()
        .expect("a system has clocks");
    let (lo, hi) = match query.read("outer", parse_rational_range)? {
        Some(range) => range,
        None => (&value * rational::ratio(1, 4), &value * rational::ratio(2, 1)),
    };
    if lo <= Rational::default() || hi == lo {
        return Err(Error::input("outer", format!("{lo}..{hi}"), "write a range of positive steps"));
    }
    Ok((value, (lo, hi)))
}

/// `stretches` {`lo`, `hi`, `verdict`} that cover the range; null of systems that have none proven. They may
/// cost far more than growth does.
pub(super) fn stretches(session: &Session, query: &Query) -> Result<Reply> {
    let scene = system(session)?;
    let (_, (lo, hi)) = range(scene, query)?;
    let span: Span = format!("outer={lo}..{hi}").parse()?;
    let stretches = match scene.intervals(&span, WIDTH, &Limits::default()) {
        Ok(found) => {
            let one = |stretch: &Stretch| json!({"lo": stretch.lo, "hi": stretch.hi, "verdict": stretch.verdict.name()});
            found.stretches.iter().map(one).collect()
        }
        Err(error) if error.kind() != Kind::Input => return Err(error),
        // Systems with nonlinear bonds, irrational numbers or friction have none.
        Err(_) => Value::Null,
    };
    Ok(Reply::json(&json!({ "stretches": stretches })))
}

/// `outer` and `rate` (null where it is not known) at evenly spaced outer steps, as many as asked for or
/// fewer where these would cost too much; `own` the file's outer step, `verdict` the document of the file's
/// own steps, `unit` of time, `title`.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let scene = system(session)?;
    let (value, (lo, hi)) = range(scene, query)?;
    let affordable = MOST_PRODUCTS / scene.model().cost().max(1);
    if affordable < 2 {
        return Err(Error::budget("two verdicts on this system", 2 * scene.model().cost()));
    }
    let samples = query.read("samples", count(2, 1000))?.unwrap_or(200).min(affordable);
    let span: Span = format!("outer={lo}..{hi}").parse()?;
    let steps: Vec<f64> = spaced(&(lo, hi), samples).iter().map(rational::to_f64).collect();
    let limits = Limits::default();
    let rates = scene.growth_rates(&span, &steps, &limits)?;
    let analysis = scene.model().decide(Route::Cheapest, &limits)?;
    Ok(Reply::json(&json!({
        "outer": steps, "rate": rates, "own": rational::to_f64(&value), "verdict": verdict(scene, &analysis),
        "unit": scene.time_unit(), "title": scene.title(),
    })))
}
