//! Growth along a line of the plane: one step fixed, or the ratio.

use serde_json::{Value, json};

use super::point::LIMITS;
use super::query::{Query, count};
use super::ray;
use super::reply::Reply;
use super::session::Session;
use super::tile::code;
use clocks::propagator::Oscillator;
use clocks::tongue::{Listing, Request, Selection, StepWindow, Stiffness};
use clocks::verdict::{Decision, Tier, decide_with_growth};
use number::parallel::try_map;
use number::parse::{parse, parse_ratio, parse_rational};
use number::{Error, Laurent, Rational, Result};

/// The quantity that is fixed along the line.
enum Line {
    H1(Laurent),
    H2(Laurent),
    /// h2/h1.
    Ratio(Rational),
}

impl Line {
    fn read(query: &Query) -> Result<Line> {
        match query.need("kind", |_, text| Ok(text.to_string()))?.as_str() {
            "h1" => query.need("value", parse).map(Line::H1),
            "h2" => query.need("value", parse).map(Line::H2),
            "ratio" => Ok(Line::Ratio(query.need("value", parse_ratio)?.into())),
            other => Err(Error::input("kind", other, "choose h1, h2 or ratio: that which is fixed")),
        }
    }

    /// (h1, h2) at x.
    fn at(&self, x: &Rational) -> (Laurent, Laurent) {
        let x = Laurent::from_rational(x.clone());
        match self {
            Line::H1(h1) => (h1.clone(), x),
            Line::H2(h2) => (x, h2.clone()),
            Line::Ratio(slope) => (x.clone(), &x * &Laurent::from_rational(slope.clone())),
        }
    }
}

/// `x`, `kind`, `rate` at the middles of equal parts of lo..hi; for a fixed ratio `intervals`, all of its
/// tongues there.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let ((lambda1, lambda2), line) = (query.stiffnesses(session)?, Line::read(query)?);
    let (lo, hi) = (query.need("lo", parse_rational)?, query.need("hi", parse_rational)?);
    if lo < Rational::default() || hi <= lo {
        return Err(Error::input("lo..hi", format!("{lo}..{hi}"), "write the smaller step first, 0 or more"));
    }
    let samples = query.read("samples", count(1, 4000))?.unwrap_or(400);
    let part = (&hi - &lo) / Rational::from_integer((2 * samples).into());
    let xs =
        (0..samples).map(|k| &lo + &part * Rational::from_integer((2 * k + 1).into())).collect::<Vec<_>>();
    let pair = |x: &Rational| {
        let (h1, h2) = line.at(x);
        Oscillator::new(lambda1.clone(), lambda2.clone(), h1, h2)
    };
    let pairs = xs.iter().map(pair).collect::<Result<Vec<_>>>()?;
    let found = try_map(&pairs, sample)?;
    let intervals = match &line {
        Line::Ratio(_) => intervals(&pairs[0], lambda1, lambda2, (lo, hi))?,
        _ => Value::Null,
    };
    Ok(Reply::json(&json!({
        "x": xs.iter().map(number::rational::to_f64).collect::<Vec<_>>(),
        "axis": if matches!(line, Line::H1(_)) { "h2" } else { "h1" },
        "kind": found.iter().map(|(kind, _)| kind).collect::<Vec<_>>(),
        "rate": found.iter().map(|(_, rate)| rate).collect::<Vec<_>>(),
        "intervals": intervals,
    })))
}

/// The verdict's code, as in tiles, and the growth rate.
fn sample(pair: &Oscillator) -> Result<(u8, f64)> {
    let (Decision { verdict, .. }, growth) = decide_with_growth(pair, Tier::Filter, &LIMITS)?;
    let rate = growth.rate(pair);
    Ok((code(verdict), rate))
}

/// The tongues of the line's ratio, certified.
fn intervals(
    pair: &Oscillator,
    lambda1: Laurent,
    lambda2: Laurent,
    (lo, hi): (Rational, Rational),
) -> Result<Value> {
    // Without a rational ρ ≥ 0 there are samples alone.
    let Ok(stiffness) = Stiffness::new(None, Some(lambda1), Some(lambda2)) else { return Ok(Value::Null) };
    let h1 = Some((Laurent::from_rational(lo), Laurent::from_rational(hi)));
    let window = StepWindow { h1, h2: None };
    let question = Listing::new(
        vec![pair.clocks()?.ratio()],
        stiffness,
        window,
        Selection::default(),
        Request::default(),
    );
    let Ok(question) = question else { return Ok(Value::Null) };
    let mut found = Vec::new();
    question.each(&(), |part| {
        found.extend(part.iter().map(ray::value));
        Ok(())
    })?;
    Ok(found.into())
}
