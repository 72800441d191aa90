//! A verdict: the full period, kick by kick, in exact arithmetic; for long periods the next tier of the
//! ladder, for very long ones return maps over the other clock.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, holds, same};
use super::exact::{FullPeriod, affordable, again, full_period, ln_multiplier};
use super::written::{Ends, Whole, Written};
use crate::question;
use clocks::propagator::Oscillator;
use clocks::resonance::dominant_family;
use clocks::verdict::{Growth, Kind, Limits, Tier, Verdict, decide_anew, exact_trace, growth};
use number::error::{Kind as ErrorKind, Result};
use number::{Ball, Rational, Real};

const ROUTE: &str = "the full period, kick by kick, in exact arithmetic; long periods: the next tier of the ladder, or return maps over the other clock";

rows! {
    /// `kickdrift/verdict/1`.
    pub struct Claim [p, q] {
        input: question::Verdict,
        p: Whole,
        q: Whole,
        kind: Written<Kind>,
        stable: bool,
        side: i8,
        trace: Trace,
        growth_rate: Ends,
        resonance: Resonance | null,
        decided_by: Written<Tier>,
    }

    struct Trace {
        lo: f64 | null,
        hi: f64 | null,
        exact: Option<Written<Rational>>,
    }

    struct Resonance {
        m: u64,
        a: i64,
        b: i64,
    }
}

/// The findings of the other route.
struct Truth {
    verdict: Verdict,
    trace: Ball,
    ln_multiplier: Option<Ball>,
    exact: Option<Rational>,
    /// m, where another route finds it; `None` where the kicks have to be followed for it.
    label: Option<Option<u64>>,
}

const BITS: u32 = 192;

impl Recheck for Claim {
    const TABLE: &'static str = "";
    asked!(question::Verdict);

    fn check(&self, answer: question::Decided, context: &Context) -> Result<Outcome> {
        let row = std::slice::from_ref(self);
        let oscillator = &answer.oscillator;
        let is_long =
            oscillator.clocks().map_or(true, |clocks| clocks::verdict::takes_return_maps(clocks.ratio(), 53));
        let truth = match self.truth(oscillator, is_long, &context.limits()) {
            // Kicks that nobody can follow.
            Err(error) if error.kind() == ErrorKind::Budget && is_long => None,
            truth => Some(truth?),
        };
        let holds = |row: &Claim| {
            truth.as_ref().map_or(Ok(()), |truth| row.holds(oscillator, truth, &context.limits()))
        };
        let mut outcome = context.outcome(ROUTE, ("", Ok(())), row, holds)?;
        match truth {
            None => outcome.not_rechecked.push(
                "any value by another route, for none decides so long a period: computed again only".into(),
            ),
            Some(Truth { label: Some(None), .. }) if self.resonance.is_some() => {
                outcome.not_rechecked.push("resonance by another route: computed again only".into());
            }
            Some(_) => {}
        }
        if self.input.friction.is_some() {
            outcome.not_rechecked.push("friction by another route: computed again only".into());
        }
        Ok(outcome)
    }
}

impl Claim {
    fn holds(&self, oscillator: &Oscillator, truth: &Truth, limits: &Limits) -> Checked {
        let ratio = oscillator.ratio();
        holds((&self.p.0, &self.q.0) == (ratio.numer(), ratio.denom()), || format!("h2/h1 is {ratio}"))?;
        self.against(truth)?;
        self.numbers(oscillator, truth)?;
        self.label(oscillator, truth, limits)
    }

    /// The full period where that is affordable, else return maps or a tier that did not decide.
    fn truth(&self, oscillator: &Oscillator, is_long: bool, limits: &Limits) -> Result<Truth> {
        let clocks = oscillator.clocks();
        if let Ok(clocks) = &clocks
            && affordable(clocks)
        {
            let FullPeriod { verdict, trace } = full_period(clocks);
            let grows = verdict.kind() == Kind::Hyperbolic;
            let ln_multiplier = grows.then(|| ln_multiplier(&trace, BITS).expect("|Tr| > 2"));
            return Ok(Truth {
                verdict,
                trace: trace.enclosure(BITS),
                ln_multiplier,
                exact: trace.as_rational(),
                label: None,
            });
        }
        let anew = if is_long { decide_anew(&oscillator.long_clocks())? } else { None };
        if let (Some((verdict, growth)), true) = (&anew, self.trace.exact.is_none()) {
            let Growth { trace, ln_multiplier, label } = growth.clone();
            return Ok(Truth { verdict: *verdict, trace, ln_multiplier, exact: None, label: Some(label) });
        }
        let clocks = clocks?;
        let (verdict, Growth { trace, ln_multiplier, label }, is_long) = match anew {
            Some((verdict, growth)) => (verdict, growth, true),
            None => {
                let tier = if *self.decided_by == Tier::Filter { Tier::Refine } else { Tier::Exact };
                let verdict = again(tier, &clocks, limits)?.verdict;
                (verdict, growth(&clocks, verdict, limits)?, false)
            }
        };
        let rational = clocks.as_rational().filter(|_| self.trace.exact.is_some());
        let exact = rational.map(|clocks| exact_trace(&clocks));
        Ok(Truth { verdict, trace, ln_multiplier, exact, label: is_long.then_some(label) })
    }

    fn against(&self, truth: &Truth) -> Checked {
        let (kind, side, verdict) = (*self.kind, self.side, truth.verdict);
        holds((kind, side) == (verdict.kind(), verdict.side()), || {
            format!("is {}, side {}, not {}, side {side}", verdict.kind().name(), verdict.side(), kind.name())
        })?;
        same("stable", self.stable, verdict.is_stable())
    }

    /// The trace and the growth rate lie in their enclosures.
    fn numbers(&self, oscillator: &Oscillator, truth: &Truth) -> Checked {
        let Trace { lo, hi, exact: written } = &self.trace;
        let ends = Ends::new(*lo, *hi);
        holds(ends.is_some_and(|ends| ends.holds(&truth.trace)), || {
            "the trace lies outside its enclosure".into()
        })?;
        let right = written.is_none() || written.as_deref() == truth.exact.as_ref();
        holds(right, || "the exact trace is another one".into())?;
        let Some(ln) = &truth.ln_multiplier else {
            let Ends { lo, hi } = self.growth_rate;
            return holds((lo, hi) == (0.0, 0.0), || "grows though it is not hyperbolic".into());
        };
        let rate = ln.div(&oscillator.period().enclosure(BITS), BITS).expect("T > 0");
        holds(self.growth_rate.holds(&rate), || format!("the growth rate is {}", rate.mid_f64()))
    }

    /// The label m of what grows exponentially, and its dominant family, m = a p + b q.
    fn label(&self, oscillator: &Oscillator, truth: &Truth, limits: &Limits) -> Checked {
        let clocks = oscillator.clocks();
        // Return maps may find no label, and the families of a longer period are not written.
        let due =
            truth.label.map_or(*self.kind == Kind::Hyperbolic, |label| label.is_some()) && clocks.is_ok();
        let Some(Resonance { m, a, b }) = self.resonance else {
            return holds(!due, || "what grows has a label".into());
        };
        holds(*self.kind == Kind::Hyperbolic && m < 1 << 62, || "has no label".into())?;
        let clocks = clocks?;
        let family = dominant_family(clocks.ratio(), m);
        holds((a, b) == family, || format!("the dominant family of m = {m} is {family:?}"))?;
        let turns = match truth.label {
            Some(None) => return Ok(()),
            Some(turns) => turns,
            None => growth(&clocks, again(Tier::Refine, &clocks, limits)?.verdict, limits)?.label,
        };
        holds(turns == Some(m), || format!("the growing solution turns {turns:?} times"))
    }
}
