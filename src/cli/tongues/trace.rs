//! Traces through the tongues of one ratio.

use crate::error::{Error, Result};
use crate::number::rational::{from_f64_exact, to_f64};
use crate::number::{Ratio, Rational};
use crate::parallel::map;
use crate::propagator::{HalfPeriod, TwoClocks, half_period};
use crate::report::figure::{Figure, Foot, typeset};
use crate::report::tongues::diagram::LARGEST_S;
use crate::report::tongues::trace::{Near, Trace, figure};
use crate::tongue::{Entry, Gap, Labels, Tongues};

/// Points of the whole, and of one tongue: closer than a third of a millimetre on paper.
const SAMPLES: u32 = 900;
const NEAR: u32 = 600;
/// Beyond this tongues are thinner than lines.
const MOST_SUM: u64 = 40;
/// No thinner tongue, relative to s, is sampled by doubles: a thousand of them between its edges.
const THINNEST: f64 = 2e-13;

/// Tr Q through the tongues of a ratio, and through one of them: that of `labels`, else the widest.
///
/// # Errors
/// A ratio with too many tongues, more than one label, one that is not there, closed, last, or too thin.
pub fn drawn(ratio: Ratio, rho: &Rational, labels: Option<&Labels>) -> Result<Figure> {
    if ratio.kicks() > MOST_SUM {
        return Err(Error::input("ratio", ratio, format!("traces are readable for p + q <= {MOST_SUM}")));
    }
    let tongues = Tongues::new(ratio, rho)?;
    let gaps = tongues.gaps(1, tongues.last())?;
    let near = chosen(&gaps, labels)?;
    let at = |s: f64| {
        let s = from_f64_exact(s).expect("a finite place");
        half_period(&TwoClocks::with_rho(ratio, s, rho.clone()))
    };
    let end = LARGEST_S;
    let places: Vec<f64> = (0..=SAMPLES).map(|n| end * f64::from(n) / f64::from(SAMPLES)).collect();
    let whole = map(&places, |&s| [s, to_f64(&at(s).trace())]);
    let spans = gaps
        .iter()
        .filter(|gap| gap.middles()[0] < end)
        .map(|gap| (gap.m, gap.middles().map(|edge| edge.min(end))));
    let (m, [lower, upper]) = (near.m, near.middles());
    let places: Vec<f64> = (0..=NEAR).map(|n| 3.0 * f64::from(n) / f64::from(NEAR) - 1.0).collect();
    let halves = map(&places, |x| at(lower + x * (upper - lower)));
    let two = Rational::from_integer(2.into());
    let sign = |trace: Rational| if m.is_multiple_of(2) { trace } else { -trace };
    let excess =
        places.iter().zip(&halves).map(|(x, half)| [*x, to_f64(&(sign(half.trace()) - &two))]).collect();
    let entries = [near.lower.entry, near.upper.expect("not the last").entry].map(|entry| {
        let values: Vec<f64> = halves.iter().map(|half| to_f64(value(half, entry))).collect();
        let largest = values.iter().fold(0.0, |a: f64, value| a.max(value.abs()));
        (
            entry.name().to_string(),
            places.iter().zip(values).map(|(x, value)| [*x, value / largest]).collect(),
        )
    });
    let near = Near { m, lower, width: upper - lower, excess, entries };
    let foot = Foot::default().value("*h*_2/*h*_1", ratio).value("*ρ*", rho).value("*m*", m);
    let trace = Trace { ratio, rho: typeset(rho), whole, tongues: spans.collect(), near };
    Ok(figure(&trace).footed(&foot))
}

fn value(half: &HalfPeriod<Rational>, entry: Entry) -> &Rational {
    match entry {
        Entry::A => half.a(),
        Entry::B => half.b(),
        Entry::C => half.c(),
        Entry::D => half.d(),
    }
}

fn chosen<'a>(gaps: &'a [Gap], labels: Option<&Labels>) -> Result<&'a Gap> {
    let width = |gap: &Gap| gap.middles()[1] - gap.middles()[0];
    let Some(labels) = labels else {
        let inner = gaps.iter().filter(|gap| gap.middles()[1] < LARGEST_S && !gap.closed);
        return inner.max_by(|a, b| width(a).total_cmp(&width(b))).ok_or_else(|| {
            Error::input("ratio", "given", "has no tongue below s = 4 to look at: choose another")
        });
    };
    let refused = |remedy: &str| Err(Error::input("m", labels, remedy));
    let &[(m, upto)] = &labels.0[..] else {
        return refused("give one label: the trace goes through one tongue");
    };
    match gaps.iter().find(|gap| gap.m == m && m == upto) {
        Some(gap) if gap.upper.is_none() => {
            refused("is the last tongue, which has no end: choose a smaller label")
        }
        Some(gap) if gap.closed => refused("is closed at this rho: choose another rho"),
        Some(gap) if width(gap) < THINNEST * gap.lower.hi => {
            refused("is too thin to draw: choose a larger rho")
        }
        Some(gap) => Ok(gap),
        None => refused("give one label that there is: the trace goes through one tongue"),
    }
}
