//! A verdict: the full period, kick by kick, in exact arithmetic; for long periods the next tier of the
//! ladder, for very long ones return maps over the other clock.

use super::bias::bias;
use super::context::{Checked, Context, Outcome, failure, holds, same};
use super::exact::{FullPeriod, affordable, again, full_period, ln_multiplier, meets};
use super::kind::Verify;
use crate::question::{self, Decided};
use clocks::propagator::Bias;
use clocks::verdict::{
    Growth, Kind, Limits, Tier, Verdict, decide_anew, exact_trace, growth, takes_return_maps,
};
use number::error::Kind as ErrorKind;
use number::{Ball, Rational, Real, Result};

const ROUTE: &str = "the full period, kick by kick, in exact arithmetic; long periods: the next tier of the ladder, or return maps over the other clock";

/// The findings of the other route.
struct Truth {
    verdict: Verdict,
    trace: Ball,
    ln_multiplier: Option<Ball>,
    exact: Option<Rational>,
    label: Label,
}

/// m, the half turns of what grows.
enum Label {
    Found(Option<u64>),
    /// The kicks have to be followed for it.
    ByKicks,
    Unknown,
}

const BITS: u32 = 192;

impl Verify for question::Verdict {
    fn check(&self, decided: &Decided, context: &Context) -> Result<Outcome> {
        let limits = context.limits();
        let clocks = decided.oscillator.clocks();
        // A ratio beyond machine words has no family, so no label is told.
        let has_label = decided.growth.label.is_some() && clocks.is_ok();
        let is_long = clocks.map_or(true, |clocks| takes_return_maps(clocks.ratio(), 53));
        let mut outcome = Outcome::holding(ROUTE, 1);
        let mut left_out = |what: &str| outcome.not_rechecked.push(format!("{what}: computed again only"));
        match truth(decided, is_long, &limits) {
            // Kicks that nobody can follow.
            Err(error) if error.kind() == ErrorKind::Budget && is_long => {
                left_out("any value by another route, for none decides so long a period");
            }
            truth => {
                let truth = truth?;
                if has_label && matches!(truth.label, Label::Unknown) {
                    left_out("resonance by another route");
                }
                outcome.failures.extend(failure(1, equals(decided, &truth, &limits))?);
            }
        }
        if decided.decision.verdict.kind() == Kind::Elliptic {
            let rational = decided.oscillator.clocks().ok().and_then(|clocks| clocks.as_rational());
            match rational.filter(|clocks| clocks.ratio().kicks() <= MAX_EXACT_BIAS) {
                Some(clocks) => {
                    outcome.failures.extend(failure(1, is_bias(decided.bias.as_ref(), &bias(&clocks)))?);
                }
                None if decided.bias.is_some() => {
                    outcome.not_rechecked.push("bias by another route: computed again only".into());
                }
                None => (),
            }
        }
        if self.friction.is_some() {
            outcome.not_rechecked.push("friction by another route: computed again only".into());
        }
        Ok(outcome)
    }
}

/// Every kick adds the digits of the strengths.
const MAX_EXACT_BIAS: u64 = 200;

/// Where Λ1 + Λ2 is not positive there is none.
fn is_bias(enclosed: Option<&Bias<Ball>>, exact: &Option<Bias<Rational>>) -> Checked {
    let is_told = |(enclosed, exact): (&Bias<Ball>, &Bias<Rational>)| {
        enclosed.at_kicks.contains(&exact.at_kicks) && enclosed.in_drifts.contains(&exact.in_drifts)
    };
    let exact = exact.as_ref().filter(|exact| exact.at_kicks > Rational::default());
    let holds_true = enclosed.is_some() == exact.is_some() && enclosed.zip(exact).is_none_or(is_told);
    holds(holds_true, || format!("its bias is {exact:?}"))
}

/// The full period where that is affordable, else return maps or a tier that did not decide.
fn truth(decided: &Decided, is_long: bool, limits: &Limits) -> Result<Truth> {
    let (clocks, is_exact) = (decided.oscillator.clocks(), decided.exact_trace.is_some());
    if let Ok(clocks) = &clocks
        && affordable(clocks)
    {
        let FullPeriod { verdict, trace } = full_period(clocks);
        let grows = verdict.kind() == Kind::Hyperbolic;
        let ln_multiplier = grows.then(|| ln_multiplier(&trace, BITS).expect("|Tr| > 2"));
        let (exact, trace) = (trace.as_rational(), trace.enclosure(BITS));
        return Ok(Truth { verdict, trace, ln_multiplier, exact, label: Label::ByKicks });
    }
    let anew = if is_long { decide_anew(&decided.oscillator.long_clocks())? } else { None };
    let (verdict, Growth { trace, ln_multiplier, label }, is_anew) = match anew {
        Some((verdict, growth)) => (verdict, growth, true),
        None => {
            let tier = if decided.decision.decided_by == Tier::Filter { Tier::Refine } else { Tier::Exact };
            let clocks = decided.oscillator.clocks()?;
            let verdict = again(tier, &clocks, limits)?.verdict;
            (verdict, growth(&clocks, verdict, limits)?, false)
        }
    };
    let rational = if is_exact { clocks?.as_rational() } else { None };
    let exact = rational.map(|clocks| exact_trace(&clocks));
    let label = match label {
        _ if !is_anew => Label::ByKicks,
        Some(_) => Label::Found(label),
        None => Label::Unknown,
    };
    Ok(Truth { verdict, trace, ln_multiplier, exact, label })
}

fn equals(decided: &Decided, truth: &Truth, limits: &Limits) -> Checked {
    let Decided { oscillator, decision, growth: found, exact_trace, .. } = decided;
    same("the verdict", decision.verdict, truth.verdict)?;
    holds(meets(&found.trace, &truth.trace), || "the trace lies outside its enclosure".into())?;
    let is_exact = exact_trace.is_none() || *exact_trace == truth.exact;
    holds(is_exact, || "the exact trace is another one".into())?;
    let grows_so = match (&found.ln_multiplier, &truth.ln_multiplier) {
        (Some(ln), Some(truth)) => meets(ln, truth),
        (ln, truth) => ln.is_some() == truth.is_some(),
    };
    holds(grows_so, || "its growth rate is another one".into())?;
    let Ok(clocks) = oscillator.clocks() else { return Ok(()) };
    let turns = match truth.label {
        Label::Unknown => return Ok(()),
        Label::Found(label) => label,
        Label::ByKicks if truth.verdict.kind() != Kind::Hyperbolic => None,
        Label::ByKicks => growth(&clocks, again(Tier::Refine, &clocks, limits)?.verdict, limits)?.label,
    };
    holds(found.label == turns, || format!("the growing solution turns {turns:?} times"))
}
