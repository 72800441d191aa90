//! Tongues as a list: none left out, and counted as they are.

use crate::question::{Ratios, StepRange, Tongues as Question};
use crate::verify::context::{Checked, Fault, holds};
use crate::verify::exact::check_ratio;
use clocks::resonance::dominant_family;
use clocks::tongue::{Selection, Tongue, Tongues};
use clocks::verdict::Limits;
use number::{Laurent, Ratio, Rational};

/// The label of the last tongue, which has no upper edge.
pub fn last(ratio: Ratio, rho: &Rational) -> u64 {
    if *rho == Rational::default() { ratio.p() } else { ratio.kicks() - 1 }
}

/// The labels asked for are there, in order: as many edges as an entry has zeros, so each enclosure holds
/// one.
pub fn complete(question: &Question, tongues: &[Tongue], rho: &Rational, limits: &Limits) -> Checked {
    let list = question.ratios()?.list();
    let mut rows = tongues.iter().zip(1..);
    for ratio in list {
        let (p, q) = ratio.terms();
        for m in labels(question, ratio, rho, limits)? {
            let place = format!("p = {p}, q = {q}, m = {m}");
            let missing = || Fault::Wrong(format!("{place} is missing at the end"));
            let (tongue, i): (&Tongue, u64) = rows.next().ok_or_else(missing)?;
            let is_due = (tongue.row.ratio, tongue.row.gap.m) == (ratio, m);
            holds(is_due, || format!("row {i} is not {place}, which belongs here"))?;
        }
    }
    let next = rows.next();
    holds(next.is_none(), || format!("row {} is one tongue too many", next.map_or(0, |(_, i)| i)))
}

/// The labels asked for; those in a window by the string's counts again.
fn labels(question: &Question, ratio: Ratio, rho: &Rational, limits: &Limits) -> Checked<Vec<u64>> {
    check_ratio(ratio.p(), ratio.q(), limits)?;
    let last = last(ratio, rho);
    let is_alone = matches!(question.ratios()?, Ratios::One(_));
    if let Some(list) = question.m.as_ref().filter(|_| is_alone) {
        let labels = list.0.iter().flat_map(|&(from, upto)| [from, upto]);
        holds(labels.into_iter().all(|m| (1..=last).contains(&m)), || {
            format!("{ratio} has the tongues 1 to {last}")
        })?;
    }
    let within = |range: Option<(i64, i64)>, x: i64| range.is_none_or(|(lo, hi)| lo <= x && x <= hi);
    let (a, b) = (question.a, question.b);
    let wanted = |&m: &u64| {
        let listed = question
            .m
            .as_ref()
            .is_none_or(|list| list.0.iter().any(|&(from, upto)| (from..=upto).contains(&m)));
        listed
            && ((a.is_none() && b.is_none()) || {
                let family = dominant_family(ratio, m);
                within(a, family.0) && within(b, family.1)
            })
    };
    let labels: Vec<u64> = (1..=last).filter(wanted).collect();
    let Some(window) = window(question, ratio) else { return Ok(labels) };
    let selection = Selection { s: Some(window), ..Selection::default() };
    let met = Tongues::new(ratio, rho)?.select(&selection)?;
    Ok(met.iter().map(|gap| gap.m).filter(|m| labels.binary_search(m).is_ok()).collect())
}

/// The window of s = h1² L1: h1 = h2 q/p.
fn window(question: &Question, ratio: Ratio) -> Option<StepRange> {
    let lambda1 = question.lambda1.as_ref()?;
    let back = Laurent::from_rational(ratio.inverse().into());
    let of_h1 = question.h1_range.clone();
    let of_h2 = question.h2_range.as_ref().map(|(lo, hi)| (lo * &back, hi * &back));
    let (lo, hi): StepRange = match (of_h1, of_h2) {
        (Some((a, b)), Some((c, d))) => (a.max(c), b.min(d)),
        (one, other) => one.or(other)?,
    };
    let zero = Laurent::from_integer(0);
    if hi < lo || hi < zero {
        return Some((Laurent::from_integer(1), zero)); // empty
    }
    let s = |h1: Laurent| &(&h1 * &h1) * lambda1;
    Some((s(lo.max(zero)), s(hi)))
}
