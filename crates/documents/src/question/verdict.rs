//! Is this pair of steps stable?

use num_bigint::BigInt;

use super::asking::{Question, Work, question};
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::friction;
use crate::report::record::Record;
use crate::report::shape::{
    COUNT, ENCLOSURE, EXACT, FLAG, GROUP_OR_NULL, INTEGER, KIND, SIGN, Schema, Shape, WIDE_ENCLOSURE,
};
use crate::report::table::{Cell, Column};
use clocks::propagator::{Bias, Oscillator, enclosed_bias};
use clocks::resonance::dominant_family;
use clocks::verdict::{
    Decision, Growth, Kind, Limits, Tier, decide_from, decide_steps, decide_with_growth, exact_trace,
};
use number::{Ball, Error, Laurent, Ratio, Rational, Real, Result, rational};

question! {
    /// One pair of steps of one oscillator.
    args struct Verdict {
        /// The stiffness of the fast force, as 10 or pi^2.
        lambda1 as "X": Laurent,
        /// The stiffness of the slow force, as 2/5 or pi^2/25; may be negative.
        lambda2 as "Y": Laurent,
        /// The fast step.
        h1 as "A": Laurent,
        /// The slow step; h2/h1 must be rational.
        h2 as "B": Laurent,
        /// Friction per unit time, as BAOAB has it: halfway through a drift over t, v becomes v exp(-G t).
        /// Does it stop the growth?
        friction as "G": Option<Rational>,
        /// Decide in exact arithmetic alone, and show the exact trace where it is rational.
        #[arg(long)]
        exact: bool,
    }
}

/// Seconds a kick of friction.
const DAMPED_KICK: f64 = 5e-5;

impl Verdict {
    /// The question about an oscillator with its steps.
    pub fn of(oscillator: &Oscillator) -> Verdict {
        let values = [oscillator.lambda1(), oscillator.lambda2(), oscillator.h1(), oscillator.h2()];
        let [lambda1, lambda2, h1, h2] = values.map(Clone::clone);
        Verdict { lambda1, lambda2, h1, h2, friction: None, exact: false }
    }

    /// The oscillator with its steps.
    ///
    /// # Errors
    /// As [`Oscillator::new`].
    pub fn oscillator(&self) -> Result<Oscillator> {
        let Verdict { lambda1, lambda2, h1, h2, .. } = self.clone();
        Oscillator::new(lambda1, lambda2, h1, h2)
    }

    /// The tier at which the decision begins.
    fn first_tier(&self) -> Tier {
        if self.exact { Tier::Exact } else { Tier::Filter }
    }

    /// The verdict alone.
    ///
    /// # Errors
    /// As [`Question::answer`].
    pub fn decision(&self, oscillator: &Oscillator, work: &Work) -> Result<Decision> {
        if !self.exact {
            return decide_steps(oscillator, &work.limits());
        }
        decide_from(Tier::Exact, &oscillator.clocks()?, &work.limits()).map(|answer| answer.decision())
    }

    fn damped(&self, oscillator: &Oscillator, work: &Work) -> Result<Option<systems::friction::Friction>> {
        let Some(rate) = &self.friction else { return Ok(None) };
        if *rate <= Rational::default() {
            return Err(Error::input("friction", rate, "a rate of friction must be positive"));
        }
        let kicks = oscillator.clocks()?.ratio().kicks();
        work.announce(&format!("friction over {kicks} kicks"), kicks as f64 * DAMPED_KICK);
        systems::friction::damped_pair(oscillator, rate, &work.limits()).map(Some)
    }
}

impl Question for Verdict {
    const NAME: &'static str = "verdict";
    const EXAMPLES: &'static [&'static str] = &[
        "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98",
        "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3 --exit-code --quiet",
        "verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499 --format latex --digits 6",
    ];
    type Answer = Decided;

    fn schema() -> Option<Schema> {
        let says = "The tongue's label m and its dominant family, m = a p + b q; null unless hyperbolic, and where half turns cannot be counted within the budget.";
        let bias = "By how much the potential energy is off, 1 being right; null unless elliptic, and beyond 1,000 kicks a period.";
        let body = record().keys().key("resonance", GROUP_OR_NULL, says).key("bias", GROUP_OR_NULL, bias);
        Some(Schema::new("Is this pair of steps stable?", body).rules(RULES))
    }

    fn answer(&self, work: &Work) -> Result<Decided> {
        let oscillator = self.oscillator()?;
        if self.friction.is_some() {
            systems::friction::allow_pair(&oscillator, &work.limits())?;
        }
        let (decision, growth) = decide_with_growth(&oscillator, self.first_tier(), &work.limits())?;
        Ok(Decided {
            decision,
            growth,
            exact_trace: Decided::exact_trace(&oscillator, self.exact),
            friction: self.damped(&oscillator, work)?,
            bias: Decided::bias(&oscillator, decision),
            oscillator,
        })
    }

    fn show(&self, answer: &Decided) -> Document {
        let record = record();
        record
            .document(Document::new(Self::NAME), answer)
            .long_rows(record.table("verdict", CAPTION, [answer]).captioned(CAPTION_LATEX))
            .summary_alone(&answer.lines())
    }
}

/// A decided pair, with all that its document holds.
#[derive(Clone, Debug)]
pub struct Decided {
    pub oscillator: Oscillator,
    pub decision: Decision,
    pub growth: Growth,
    /// Tr Q, where it is rational and was asked for or is short.
    pub exact_trace: Option<Rational>,
    /// The verdict with friction, where that was asked for.
    pub friction: Option<systems::friction::Friction>,
    /// By how much the potential energy of a stable pair is off.
    pub bias: Option<Bias<Ball>>,
}

const CAPTION: &str = "Stability of one pair of steps";
const CAPTION_LATEX: &str = "Stability of one pair of steps, $Q$ the propagator over the synchronization period $T = q h_2 = p h_1$, $\\mu$ its larger multiplier";

/// A rational trace is shown unasked where the period has at most so many kicks.
const SHORT_PERIOD: u64 = 40;

/// A ratio is much simpler whose period holds so many times fewer kicks.
const MUCH: u64 = 1000;

/// A ratio is simple whose period holds fewer kicks: that one lies within 10^-9 of another is no chance.
const SIMPLE: u64 = 1000;

/// A rational trace is shown unasked where it has at most so many characters.
const SHORT_TEXT: usize = 60;

impl Decided {
    /// The exact trace: always where `wanted`, otherwise where it is short. `None` where a stiffness or step
    /// makes it irrational.
    pub fn exact_trace(oscillator: &Oscillator, wanted: bool) -> Option<Rational> {
        let clocks = oscillator.clocks().ok()?.as_rational()?;
        if !wanted && clocks.p() + clocks.q() > SHORT_PERIOD {
            return None;
        }
        let trace = exact_trace(&clocks);
        (wanted || trace.to_string().len() <= SHORT_TEXT).then_some(trace)
    }

    /// The bias of an elliptic pair with a period of at most
    /// [`MAX_BIAS_KICKS`](clocks::propagator::MAX_BIAS_KICKS).
    pub fn bias(oscillator: &Oscillator, decision: Decision) -> Option<Bias<Ball>> {
        let is_elliptic = decision.verdict.kind() == Kind::Elliptic;
        oscillator.clocks().ok().filter(|_| is_elliptic).and_then(|clocks| enclosed_bias(&clocks))
    }

    /// ln μ / T as an enclosure, 0 where nothing grows exponentially.
    pub fn growth_rate(&self) -> (f64, f64) {
        const BITS: u32 = 96;
        let period = self.oscillator.period().enclosure(BITS);
        let rate = |ln: &Ball| ln.div(&period, BITS).expect("T > 0").to_f64_enclosure();
        self.growth.ln_multiplier.as_ref().map_or((0.0, 0.0), rate)
    }

    /// m and its dominant family.
    fn resonance(&self) -> Option<(u64, i64, i64)> {
        let m = self.growth.label?;
        let (a, b) = dominant_family(self.oscillator.clocks().ok()?.ratio(), m);
        Some((m, a, b))
    }
}

/// The row of an answer.
fn record() -> Record<'static, Decided> {
    type Of<'a> = &'a Decided;
    Record::new()
        .column(Column::math("h1", "h_1").aside(), |decided: Of| Cell::exact(decided.oscillator.h1()))
        .column(Column::math("h2", "h_2").aside(), |decided| Cell::exact(decided.oscillator.h2()))
        .field(Column::math("p", "p"), |decided| Cell::whole(decided.oscillator.ratio().numer()))
        .says(KICKS, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .field(Column::math("q", "q"), |decided| Cell::whole(decided.oscillator.ratio().denom()))
        .says(KICKS, "Slow kicks a period.")
        .field(Column::new("kind").left(), |decided| decided.decision.verdict.kind().name().into())
        .says(KIND, "")
        .field(Column::new("stable").aside(), |decided| decided.decision.verdict.is_stable().into())
        .says(FLAG, "Whether the powers of Q are bounded: elliptic or coexistence.")
        .field(Column::new("side").aside(), |decided| i64::from(decided.decision.verdict.side()).into())
        .says(SIGN, "1 where Tr Q >= 2, -1 where Tr Q <= -2, else 0.")
        .field(Column::math("trace", "\\operatorname{Tr} Q").enclosure(), |decided| {
            decided.growth.trace.to_f64_enclosure().into()
        })
        .says(WIDE_ENCLOSURE, "Tr Q: an enclosure, and the exact value where it is rational and short, or was asked for.")
        .optional("trace.exact", |decided| Some(decided.exact_trace.as_ref()?.to_string().into()))
        .says(EXACT, "Tr Q, exactly.")
        .field(Column::new("growth_rate").titled("growth rate", "$\\ln\\mu/T$").enclosure(), |decided| {
            decided.growth_rate().into()
        })
        .says(WIDE_ENCLOSURE, "ln(mu)/T per unit time, mu the larger multiplier of Q: an enclosure; 0 where nothing grows exponentially.")
        .at("resonance.m", Column::math("m", "m"), |decided| decided.resonance().map(|(m, ..)| m).into())
        .says(COUNT, "The tongue's label: half turns of the growing solution a period.")
        .at("resonance.a", Column::math("a", "a"), |decided| decided.resonance().map(|(_, a, _)| a).into())
        .says(INTEGER, "a of the dominant family.")
        .at("resonance.b", Column::math("b", "b"), |decided| decided.resonance().map(|(.., b)| b).into())
        .says(INTEGER, "b of the dominant family.")
        .json("bias.at_kicks", |decided| bias_cell(decided, |bias| &bias.at_kicks))
        .says(ENCLOSURE, "(lambda1 + lambda2) <x^2>/kT where both clocks kick, velocities thermal at the kicks (constant energy, OBABO).")
        .json("bias.in_drifts", |decided| bias_cell(decided, |bias| &bias.in_drifts))
        .says(ENCLOSURE, "The same with a weak thermostat in the middle of every drift (BAOAB, LangevinMiddle).")
        .field(Column::new("decided_by").in_words("decided by").left().aside(), |decided| {
            decided.decision.decided_by.name().into()
        })
        .says(Shape::OneOf(&["filter", "refine", "exact"]), "The tier of arithmetic that proved the verdict.")
        .optional("friction", |decided| decided.friction.as_ref().map(friction::value))
        .says(friction::SHAPE, friction::SAYS)
}

fn bias_cell(decided: &Decided, which: fn(&Bias<Ball>) -> &Ball) -> Cell {
    decided.bias.as_ref().map(|bias| which(bias).to_f64_enclosure()).into()
}

/// A number of kicks.
const KICKS: Shape = Shape::Named(
    "kicks",
    r#"{
        "description": "A whole number: beyond 2^63 as a text.",
        "oneOf": [{"type": "integer", "minimum": 1}, {"type": "string", "pattern": "^[1-9][0-9]{18,}$"}]
    }"#,
);

/// What the keys of a verdict say of each other.
const RULES: &str = r#"{"allOf": [
    {
        "if": {"properties": {"kind": {"enum": ["elliptic", "coexistence"]}}},
        "then": {"properties": {"stable": {"const": true}}},
        "else": {"properties": {"stable": {"const": false}}}
    },
    {
        "if": {"properties": {"kind": {"const": "elliptic"}}},
        "then": {"properties": {"side": {"const": 0}}},
        "else": {"properties": {"side": {"enum": [-1, 1]}}}
    },
    {
        "if": {"properties": {"kind": {"const": "hyperbolic"}}},
        "else": {"properties": {
            "resonance": {"const": null},
            "growth_rate": {"properties": {"lo": {"const": 0}, "hi": {"const": 0}}}
        }}
    }
]}"#;

/// For people.
impl Decided {
    /// Five to seven lines; the one row of the table would only repeat them.
    fn lines(&self) -> Vec<String> {
        let (p, q) = (self.oscillator.ratio().numer(), self.oscillator.ratio().denom());
        let verdict = self.decision.verdict;
        let mut lines = vec![
            self.headline(),
            format!(
                "  h2/h1        {p}/{q}: {} in the period T = {}",
                if p < q {
                    format!(
                        "{p} {} every h1 and {q} every h2",
                        if *p == BigInt::from(1) { "kick" } else { "kicks" }
                    )
                } else {
                    format!("{p} fast and {q} slow kicks")
                },
                self.oscillator.period()
            ),
            format!("  trace        {}", shown(self.growth.trace.to_f64_enclosure())),
        ];
        lines.splice(2..2, self.simpler());
        if let Some(exact) = &self.exact_trace {
            lines.push(format!("               = {exact} exactly"));
        }
        if verdict.kind() == Kind::Hyperbolic {
            let rate = self.growth_rate();
            let steps = std::f64::consts::LN_10 / (rate.0 * self.oscillator.h2().to_f64());
            // Where the rate or the steps are beyond doubles, nothing can be said of the steps.
            let steps = Some(steps).filter(|steps| steps.is_finite() && *steps > 0.0).map(significant);
            let tenfold = steps.map_or(String::new(), |steps| {
                // What is called slow is rare, as a rule.
                let unit = if p < q { "steps h2" } else { "slow steps" };
                format!(": tenfold in {steps} {unit}")
            });
            lines.push(format!("  growth rate  {} per unit time{tenfold}", shown(rate)));
        }
        if let Some((m, a, b)) = self.resonance() {
            let turns = if m == 1 { "half turn" } else { "half turns" };
            lines.push(format!(
                "  resonance    m = {m} {turns} a period; dominant family (a, b) = ({a}, {b})"
            ));
        } else if verdict.kind() == Kind::Hyperbolic {
            lines.push(self.not_counted());
        }
        lines.extend(
            self.bias
                .iter()
                .flat_map(|bias| bias_lines([&bias.at_kicks, &bias.in_drifts].map(Ball::mid_f64))),
        );
        lines.push(format!("  decided by   {}", self.decision.decided_by.name()));
        lines.extend(self.friction.iter().flat_map(friction::lines));
        lines
    }

    /// Why a pair that grows has no label.
    fn not_counted(&self) -> String {
        let kicks = self.oscillator.clocks().ok().map(|clocks| clocks::verdict::refine_kicks(clocks.ratio()));
        let remedy = kicks.map_or("no budget allows to count so many".into(), |kicks| {
            format!("to count them kick by kick allow {kicks} kicks (--budget)")
        });
        format!("  resonance    not told: directions alone do not give the half turns a period; {remedy}")
    }

    /// The verdict at a much simpler ratio, where one lies within 10^-9: steps that are doubles stand for it,
    /// as a rule.
    fn simpler(&self) -> Option<String> {
        let ratio = self.oscillator.ratio();
        let off = ratio / Rational::from_integer(1_000_000_000.into());
        let near = rational::simplest(&(ratio - &off), &(ratio + &off));
        let kicks = ratio.numer() + ratio.denom();
        let is_simpler = |near: &Ratio| near.kicks() < SIMPLE && BigInt::from(near.kicks()) * MUCH < kicks;
        let simple = Ratio::try_from(&near).ok().filter(is_simpler)?;
        let [lambda1, lambda2, h1] =
            [self.oscillator.lambda1(), self.oscillator.lambda2(), self.oscillator.h1()];
        let h2 = h1 * &Laurent::from_rational(near.clone());
        let there = Oscillator::new(lambda1.clone(), lambda2.clone(), h1.clone(), h2).ok()?;
        let there = decide_steps(&there, &Limits::default()).ok()?.verdict;
        let difference = rational::to_f64(&(ratio - &near));
        let sign = if difference < 0.0 { '-' } else { '+' };
        let (word, too) =
            (stability(there.is_stable()), there.is_stable() == self.decision.verdict.is_stable());
        let too = if too { ", too" } else { "" };
        Some(format!(
            "               {simple} {sign} {:.1e}; at {simple} itself: {word}{too}",
            difference.abs()
        ))
    }

    fn headline(&self) -> String {
        let verdict = self.decision.verdict;
        match verdict.kind() {
            Kind::Elliptic => format!("stable: {verdict}"),
            Kind::Coexistence => format!("stable: {verdict}; a tongue is closed here"),
            Kind::Parabolic => format!("unstable: {verdict}; linear growth"),
            Kind::Hyperbolic => format!("unstable: {verdict}; exponential growth"),
        }
    }
}

fn stability(is_stable: bool) -> &'static str {
    if is_stable { "stable" } else { "unstable" }
}

/// An enclosure as the digits that are certain; a number beyond doubles has one end alone.
fn shown((lo, hi): (f64, f64)) -> String {
    if lo == f64::NEG_INFINITY && hi < 0.0 {
        return format!("below {hi:?}");
    }
    if hi == f64::INFINITY && lo > 0.0 {
        return format!("above {lo:?}");
    }
    decimal::enclosure(lo, hi).to_string()
}

/// The bias at the kicks and in the drifts in words.
pub(super) fn bias_lines(bias: [f64; 2]) -> [String; 2] {
    let [at_kicks, in_drifts] = bias.map(significant);
    [
        format!("  bias         potential energy over kT/2: {at_kicks} at constant energy or by OBABO,"),
        format!("               {in_drifts} with a weak thermostat in every drift (BAOAB); 1 is right"),
    ]
}

/// Three significant digits.
fn significant(x: f64) -> String {
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    if x >= 1e7 { format!("{x:.2e}") } else { format!("{x:.digits$}") }
}
