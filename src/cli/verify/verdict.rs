//! A verdict: the full period, kick by kick, in exact arithmetic; for long periods the next tier of the ladder.

use serde_json::Value;

use super::exact::{FullPeriod, affordable, full_period, ln_multiplier, meets};
use super::read::{Checked, Fault, Row, holds};
use super::{Context, Outcome};
use crate::error::{Error, Result};
use crate::number::{Ball, Laurent, Rational, Real};
use crate::propagator::{Oscillator, TwoClocks};
use crate::verdict::{Decidable, Kind, Limits, Tier, decide_from, growth};

const ROUTE: &str =
    "the full period, kick by kick, in exact arithmetic; long periods: the next tier of the ladder";

pub fn check(document: &Value, context: &Context) -> Result<Outcome> {
    let row = [document.clone()];
    context.rows(&row, ROUTE, |row| check_row(row, &context.limits))
}

fn check_row(row: &Row, limits: &Limits) -> Checked<()> {
    let input = row.object("input")?;
    let [lambda1, lambda2, h1, h2] = ["lambda1", "lambda2", "h1", "h2"].map(|key| input.quantity(key));
    let oscillator =
        Oscillator::new(lambda1?, lambda2?, h1?, h2?).map_err(|error| Fault::Wrong(error.to_string()))?;
    let clocks = oscillator.clocks();
    let ratio = (row.whole("p")?, row.whole("q")?);
    holds(ratio == (clocks.p(), clocks.q()), || format!("h2/h1 is {}/{}", clocks.p(), clocks.q()))?;
    let (kind, side) = (row.text("kind")?, row.integer("side")?);
    let stable = ["elliptic", "coexistence"].contains(&kind);
    holds(row.flag("stable")? == stable, || {
        format!("{kind} is {}", if stable { "stable" } else { "unstable" })
    })?;
    let same = |other: Kind, other_side: i8| {
        holds(kind == other.name() && side == i64::from(other_side), || {
            format!("is {}, side {other_side}, not {kind}, side {side}", other.name())
        })
    };
    let decided_by = row.text("decided_by")?;
    holds(Tier::ALL.iter().any(|tier| tier.name() == decided_by), || format!("{decided_by} is no tier"))?;
    if affordable(&clocks) {
        match clocks.as_rational() {
            Some(rational) => {
                let full = full_period(&rational);
                same(full.kind, full.side)?;
                exact_trace(row, || Some(full.trace.clone()))?;
                numbers(row, &full.trace.enclosure(BITS), ln_of(&full), &oscillator)?;
            }
            None => {
                let full = full_period(&clocks);
                same(full.kind, full.side)?;
                exact_trace(row, || None)?;
                numbers(row, &full.trace.enclosure(BITS), ln_of(&full), &oscillator)?;
            }
        }
        return label(row, &clocks, limits);
    }
    let tier = if decided_by == "filter" { Tier::Refine } else { Tier::Exact };
    let verdict = decide_from(tier, &clocks, limits)?.verdict;
    same(verdict.kind(), verdict.side())?;
    let rational = clocks.as_rational();
    let growth = match &rational {
        Some(rational) => growth(rational, verdict, limits)?,
        None => growth(&clocks, verdict, limits)?,
    };
    numbers(row, &growth.trace, growth.ln_multiplier, &oscillator)?;
    exact_trace(row, || rational.as_ref().map(crate::verdict::exact_trace))?;
    label(row, &clocks, limits)
}

const BITS: u32 = 192;

/// ln μ by the trace of the full period; `None` unless hyperbolic.
fn ln_of<S: Real>(full: &FullPeriod<S>) -> Option<Ball> {
    (full.kind == Kind::Hyperbolic).then(|| ln_multiplier(&full.trace, BITS).expect("|Tr| > 2"))
}

/// The exact trace, found out only where it is told.
fn exact_trace(row: &Row, truth: impl FnOnce() -> Option<Rational>) -> Checked<()> {
    let trace = row.object("trace")?;
    if trace.get("exact").is_none() {
        return Ok(());
    }
    let told = trace.rational("exact")?;
    holds(Some(told) == truth(), || "the trace is not what it is told to be exactly".into())
}

/// The trace and the growth rate lie in their enclosures.
fn numbers(row: &Row, trace: &Ball, ln: Option<Ball>, oscillator: &Oscillator) -> Checked<()> {
    holds(meets(row.ends("trace")?, trace), || "the trace lies outside its enclosure".into())?;
    let told = row.ends("growth_rate")?;
    let Some(ln) = ln else {
        return holds(told == (0.0, 0.0), || "grows though it is not hyperbolic".into());
    };
    let rate = ln.div(&oscillator.period().enclosure(BITS), BITS).expect("T > 0");
    holds(meets(told, &rate), || format!("the growth rate is {}", rate.mid_f64()))
}

/// The label m of what grows exponentially, and that m = a p + b q.
fn label(row: &Row, clocks: &TwoClocks<Laurent>, limits: &Limits) -> Checked<()> {
    // Beyond this families are not told.
    let small = clocks.p().max(clocks.q()) < 1 << 31;
    let grows = row.text("kind")? == Kind::Hyperbolic.name();
    let Some(told) = row.get("resonance") else {
        return holds(!(grows && small), || "what grows has a label".into());
    };
    let (m, a, b) = (told.whole("m")?, told.integer("a")?, told.integer("b")?);
    let sum = i128::from(a) * i128::from(clocks.p()) + i128::from(b) * i128::from(clocks.q());
    holds(sum == i128::from(m), || format!("m = {m} is not {a} p + {b} q"))?;
    let turns = match clocks.as_rational() {
        Some(rational) => turns(&rational, limits),
        None => turns(clocks, limits),
    };
    let turns = turns?;
    holds(turns == Some(m), || format!("the growing solution turns {turns:?} times"))
}

fn turns<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> std::result::Result<Option<u64>, Error> {
    let verdict = decide_from(Tier::Refine, clocks, limits)?.verdict;
    growth(clocks, verdict, limits).map(|growth| growth.label)
}
