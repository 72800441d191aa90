//! One pair of steps: all that there is to say.

use serde_json::{Value, json};

use super::query::{Query, positive};
use super::ray::{self, Ray};
use super::reply::Reply;
use super::session::Session;
use clocks::propagator::Oscillator;
use clocks::verdict::Limits;
use documents::format::Format;
use documents::question::{Decided, Question, Verdict, Work};
use documents::report::certificate::coq;
use number::parse::parse;
use number::rational::simplest;
use number::{Error, Laurent, Rational, Result, ratio};

/// Kicks that one tier may compose.
pub(super) const MOST_KICKS: u64 = 3_000_000;

pub(super) const LIMITS: Limits = Limits { kicks: MOST_KICKS };

/// Kicks of a certificate: checking it takes Coq a minute.
pub(super) const MOST_CERTIFIED: u64 = 5000;

/// The verdict's document and, beside it, `tenfold`, `tongue`, `nearest` and the `command` that gives the
/// same verdict.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let oscillator = oscillator(session, query)?;
    let answer = decided(&oscillator)?;
    let mut body = Verdict::of(&oscillator).document(&answer).value();
    body["tenfold"] = tenfold(&answer);
    let (inside, below, above) = about(&answer)?;
    body["tongue"] = inside;
    body["nearest"] = json!({"below": below, "above": above});
    body["command"] = Verdict::of(&oscillator).command().into();
    Ok(Reply::json(&body))
}

/// The verdict's document, a file to keep.
pub(super) fn document(session: &Session, query: &Query) -> Result<Reply> {
    let oscillator = oscillator(session, query)?;
    let text = Verdict::of(&oscillator).document(&decided(&oscillator)?).render(Format::Json)?;
    Ok(Reply::file("verdict.json", "application/json", text.into_bytes()))
}

/// The verdict as a Coq proof, a file to keep.
pub(super) fn certificate(session: &Session, query: &Query) -> Result<Reply> {
    let oscillator = oscillator(session, query)?;
    let kicks = oscillator.clocks()?.ratio().kicks();
    if kicks > MOST_CERTIFIED {
        let cost = format!("checking a certificate of {kicks} kicks would take minutes");
        return Err(Error::too_much(cost, "choose steps with a simpler ratio"));
    }
    let text = coq(&oscillator, decided(&oscillator)?.decision.verdict, "verdict.v")?;
    Ok(Reply::file("verdict.v", "text/plain; charset=utf-8", text.into_bytes()))
}

/// The pair that is asked about; with `within`, the one with the simplest ratio whose h2 is off by no more
/// than that: deep in the plane no other has a period that can be composed.
fn oscillator(session: &Session, query: &Query) -> Result<Oscillator> {
    let (lambda1, lambda2) = query.stiffnesses(session)?;
    let (h1, h2) = (query.need("h1", parse)?, query.need("h2", parse)?);
    let h2 = match query.read("within", positive)? {
        Some(within) => simplified(&h1, &h2, &within)?,
        None => h2,
    };
    Oscillator::new(lambda1, lambda2, h1, h2)
}

fn simplified(h1: &Laurent, h2: &Laurent, within: &Rational) -> Result<Laurent> {
    let zero = Rational::default();
    let rational = |field, h: &Laurent| {
        let remedy = "must be rational and positive to be moved to a simpler ratio";
        h.as_rational().filter(|h| *h > zero).ok_or_else(|| Error::input(field, h, remedy))
    };
    let (one, two) = (rational("h1", h1)?, rational("h2", h2)?);
    let least = &two * ratio(1, 2);
    let slope = simplest(&((&two - within).max(least) / &one), &((&two + within) / &one));
    Ok(Laurent::from_rational(slope * one))
}

pub(super) fn decided(oscillator: &Oscillator) -> Result<Decided> {
    Verdict::of(oscillator).answer(&Work { budget: Some(MOST_KICKS), ..Work::default() })
}

/// Slow steps and time until the amplitude is tenfold.
fn tenfold(answer: &Decided) -> Value {
    let time = std::f64::consts::LN_10 / answer.growth_rate().0;
    let steps = time / answer.oscillator.h2().to_f64();
    if steps.is_finite() { json!({"steps": steps, "time": time}) } else { Value::Null }
}

/// The tongue that the pair is in or on the edge of, and the nearest others on its ray; null where there are
/// none or they are not known.
fn about(answer: &Decided) -> Result<(Value, Value, Value)> {
    let (oscillator, verdict) = (&answer.oscillator, answer.decision.verdict);
    let rho = Laurent::ratio(oscillator.lambda2(), oscillator.lambda1());
    let Ok(clocks) = oscillator.clocks() else { return Ok(Default::default()) };
    let ray = rho.and_then(|rho| Ray::new(clocks.ratio(), &rho, oscillator.lambda1()));
    let Some(ray) = ray else { return Ok(Default::default()) };
    // On an edge, and where a tongue is closed, the tongue is that one.
    let stable = verdict.kind() == clocks::verdict::Kind::Elliptic;
    let around = ray.around(clocks.fast(), stable)?;
    let value = |tongue: &Option<_>| tongue.as_ref().map_or(Value::Null, ray::value);
    Ok((value(&around.inside), value(&around.below), value(&around.above)))
}
