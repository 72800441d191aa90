//! The row of a mode at a scheme, checked.

use super::mass::{BITS, Mass, crosses, exact, fastest_growth};
use super::periods::Periods;
use crate::verify::context::{Checked, holds};
use crate::verify::exact::encloses;
use clocks::verdict::Kind;
use molecules::{Answer, Row, Unstable};
use number::rational::simplest;
use number::{Ball, Rational, Sign};
use systems::friction::Masked;

impl Periods<'_> {
    /// Verdict and growth, frictions, ratios and intervals of a row.
    pub fn row(&self, answer: &Answer, row: &Row) -> Checked {
        let mass = self.mass(&answer.scheme, Some(&self.advice.modes[row.mode]));
        verdict(row, &mass)?;
        row.masking.as_ref().map_or(Ok(()), |masked| masks(masked, row.found.kind, &mass))?;
        if let Some((is_damped, friction)) = row.is_damped.zip(self.advice.friction.as_ref()) {
            let truth = mass.is_damped(friction)?;
            holds(truth.is_none_or(|truth| truth == is_damped), || format!("damped is not {is_damped}"))?;
        }
        row.ratios.as_ref().map_or(Ok(()), |range| ratios(range, answer.scheme.outer(), &mass))?;
        intervals(row, answer.scheme.outer(), &mass)
    }
}

fn verdict(row: &Row, mass: &Mass) -> Checked {
    // A clock without stiffness is silent: the period is that of the others.
    let heard = mass.heard();
    let (trace, period) = heard.trace()?;
    let (found, kind) = (&row.found, row.found.kind);
    holds(encloses(found.trace, &trace), || format!("the trace is {}", trace.mid_f64()))?;
    let is_so = match heard.excess()? {
        Some(Sign::Positive) => kind == Kind::Hyperbolic,
        Some(Sign::Negative) => kind == Kind::Elliptic,
        _ => matches!(kind, Kind::Parabolic | Kind::Coexistence),
    };
    holds(is_so, || format!("is not {}", kind.name()))?;
    bias(row, &heard)?;
    if kind != Kind::Hyperbolic {
        let none = row.tenfold_steps.is_none() && found.rate == (0.0, 0.0);
        return holds(none, || "grows though it is not hyperbolic".into());
    }
    // acosh(|Tr|/2) by logarithms.
    let half = trace.abs().scale2(-1);
    let root = half.square(BITS).sub(&Ball::one(), BITS).sqrt_clipped(BITS).unwrap_or_else(Ball::zero);
    let ln = half.add(&root, BITS).ln(BITS).unwrap_or_else(Ball::zero);
    let rate = ln.div(&Ball::from_rational(&period, BITS), BITS).unwrap_or_else(Ball::zero);
    holds(encloses(found.rate, &rate), || format!("the growth rate is {} per fs", rate.mid_f64()))
}

/// Told of what is stable, and of that alone.
fn bias(row: &Row, heard: &Mass) -> Checked {
    let Some(bias) = row.bias else {
        return holds(row.found.kind != Kind::Elliptic, || "the bias is missing".into());
    };
    let truth = heard.bias()?.filter(|_| row.found.kind == Kind::Elliptic);
    let is_so = truth.as_ref().is_some_and(|truth| encloses(bias, truth));
    holds(is_so, || format!("the bias is {}", truth.map_or(f64::NAN, |truth| truth.mid_f64())))
}

/// Damped by the frictions that are said to mask, some larger ones where all are, and not by the one that is
/// said not to.
fn masks(masked: &Masked, kind: Kind, mass: &Mass) -> Checked {
    let is_least = kind == Kind::Hyperbolic
        && (masked.grows <= 0.0 || mass.is_damped(&exact(masked.grows))? != Some(true));
    holds(is_least, || format!("a friction of {} per fs masks it, too", masked.grows))?;
    for &(lo, hi) in &masked.ranges {
        let tried = if hi.is_finite() {
            [1.0, 0.5, 0.0].map(|x| hi - (hi - lo) * x)
        } else {
            [lo, 2.0 * lo, 1e3 * lo]
        };
        for friction in tried {
            let is_masked = mass.is_damped(&exact(friction))? != Some(false);
            holds(is_masked, || format!("a friction of {friction} per fs does not mask it"))?;
        }
    }
    Ok(())
}

/// The simplest ratio of each tenth of the range is unstable, and the scheme's own one lies in it.
fn ratios((lo, hi): &(Rational, Rational), outer: &Rational, mass: &Mass) -> Checked {
    let inner = &mass.steps[0];
    let own = outer / inner;
    holds(mass.steps.len() == 2 && *lo <= own && own <= *hi && lo < hi, || {
        format!("its range of ratios does not hold {own}")
    })?;
    let tenth = (hi - lo) / Rational::from_integer(10.into());
    let at = |k: i64| lo + &tenth * Rational::from_integer(k.into());
    for ratio in (0..10).map(|k| simplest(&at(k), &at(k + 1))) {
        let steps = vec![inner.clone(), &ratio * inner];
        let is_stable = Mass { steps, stiffness: mass.stiffness.clone() }.excess()? == Some(Sign::Negative);
        holds(!is_stable, || format!("the ratio {ratio} is stable"))?;
    }
    Ok(())
}

/// Where the first region ends, and every interval that is named.
fn intervals(row: &Row, outer: &Rational, mass: &Mass) -> Checked {
    let at = |step: f64| mass.scaled(&(exact(step) / outer));
    let Some(first) = &row.first else { return holds(false, || "first is missing".into()) };
    mass.ends_within(outer, first.lower, "the first region")?;
    let beside = [&row.inside, &row.below, &row.above];
    for unstable in beside.into_iter().flatten().filter(|unstable| unstable.upper.is_none()) {
        crosses(&at, unstable.lower, "lower")?;
    }
    let mut all: Vec<&Unstable> =
        row.intervals.iter().chain([first]).chain(beside.into_iter().flatten()).collect();
    all.sort_by(|a, b| a.lower.0.total_cmp(&b.lower.0));
    all.dedup();
    all.into_iter().try_for_each(|unstable| interval(&at, unstable))?;
    let is_below =
        row.below.as_ref().and_then(|below| below.upper).is_none_or(|upper| exact(upper.0) <= *outer);
    let is_above = row.above.as_ref().is_none_or(|above| exact(above.lower.1) >= *outer);
    holds(is_below && is_above, || "below and above lie on the wrong sides".into())
}

/// Both ends are such, and what lies between is unstable.
fn interval(at: &impl Fn(f64) -> Mass, Unstable { label, lower, upper, worst }: &Unstable) -> Checked {
    // One point, or without an end.
    let Some(upper) = *upper else { return Ok(()) };
    holds(lower.1 <= upper.0, || format!("interval {label} ends before it begins"))?;
    crosses(at, *lower, "lower")?;
    crosses(at, upper, "upper")?;
    let inside = at(lower.1 / 2.0 + upper.0 / 2.0);
    holds(inside.excess()? != Some(Sign::Negative), || format!("interval {label} is stable inside"))?;
    // In tongue m the trace has the sign (-1)^m.
    let is_even = inside.trace()?.0.sign() == Some(Sign::Positive);
    holds(is_even == label.is_multiple_of(2), || format!("{label} is not the label of that interval"))?;
    fastest_growth(at, (lower.1, upper.0), worst.map(|worst| worst.steps))
}
