//! All tongues of one ratio as ρ changes, and where they close.

use serde_json::{Value, json};

use super::query::{Query, count, spaced};
use super::reply::Reply;
use super::session::Session;
use clocks::resonance::dominant_family;
use clocks::tongue::{Edge, Gap, Search, Tongues, closings};
use number::parallel::try_map;
use number::parse::{parse_ratio, parse_rational_range};
use number::{Error, Ratio, Rational, Result, rational};

/// The longest period, p + q, and that up to which closings are searched too.
pub(super) const MOST_KICKS: u64 = 200;
const SEARCHED: u64 = 40;

/// `rho`; `tongues` {`m`, `a`, `b`, `lower`, `upper`} with edges in s = h1² L1 at each rho; `closings` {`m`,
/// `s`, `rho`, `exact`}, null beyond p + q = 40. All edges are certified to the doubles shown.
pub(super) fn answer(_session: &Session, query: &Query) -> Result<Reply> {
    let ratio = query.need("ratio", parse_ratio)?;
    let (lo, hi) = query.need("rho", parse_rational_range)?;
    if lo <= Rational::default() || hi == lo {
        return Err(Error::input(
            "rho",
            format!("{lo}..{hi}"),
            "write a range of positive numbers, as 1/100..1",
        ));
    }
    if ratio.kicks() > MOST_KICKS {
        let cost = format!("the strip of {ratio} has {} tongues", ratio.kicks() - 1);
        return Err(Error::too_much(cost, format!("choose p + q up to {MOST_KICKS}")));
    }
    let samples = query.read("samples", count(2, 400))?.unwrap_or(120);
    let rhos = spaced(&(lo.clone(), hi.clone()), samples);
    let at = |rho: &Rational| Tongues::new(ratio, rho)?.all();
    let gaps: Vec<Vec<Gap>> = try_map(&rhos, at)?;
    let closings = match ratio.kicks() <= SEARCHED {
        true => Some(closed(ratio, (lo, hi), samples as usize)?),
        false => None,
    };
    Ok(Reply::json(&json!({
        "rho": rhos.iter().map(rational::to_f64).collect::<Vec<_>>(),
        "tongues": (0..gaps[0].len()).map(|n| tongue(ratio, n, &gaps)).collect::<Vec<_>>(),
        "closings": closings,
    })))
}

fn tongue(ratio: Ratio, n: usize, gaps: &[Vec<Gap>]) -> Value {
    let middle = |edge: &Edge| 0.5 * edge.lo + 0.5 * edge.hi;
    let m = gaps[0][n].m;
    let (a, b) = dominant_family(ratio, m);
    json!({
        "m": m, "a": a, "b": b,
        "lower": gaps.iter().map(|gap| middle(&gap[n].lower)).collect::<Vec<_>>(),
        "upper": gaps.iter().map(|gap| gap[n].upper.as_ref().map(middle)).collect::<Vec<_>>(),
    })
}

fn closed(ratio: Ratio, rho: (Rational, Rational), samples: usize) -> Result<Value> {
    let found = closings(ratio, &Search { m: None, rho, samples })?;
    let point = |x: &clocks::tongue::Enclosure| rational::to_f64(&x.middle());
    let one = |closing: &clocks::tongue::Closing| {
        let exact = closing.exact.as_ref().map(|(s, rho)| [s.to_string(), rho.to_string()]);
        json!({"m": closing.m, "s": point(&closing.s), "rho": point(&closing.rho), "exact": exact})
    };
    Ok(found.closings.iter().map(one).collect())
}
