//! The answer to "is this pair stable?" as a document.

use super::decimal;
use super::document::Document;
use super::record::Record;
use super::table::{Cell, Column};
use crate::number::{Ball, Laurent, Rational, Real};
use crate::propagator::{Oscillator, TwoClocks};
use crate::resonance::dominant_family;
use crate::verdict::{Decision, Growth, Kind, exact_trace};

/// A decided pair, with all that its document holds.
#[derive(Clone, Debug)]
pub struct Answer {
    pub oscillator: Oscillator,
    pub decision: Decision,
    pub growth: Growth,
    /// Tr Q, where it is rational and was asked for or is short.
    pub exact_trace: Option<Rational>,
    /// What friction does to it, where that was asked for.
    #[cfg(feature = "system")]
    pub friction: Option<crate::system::friction::Friction>,
}

const CAPTION: &str = "Stability of one pair of steps";
const CAPTION_LATEX: &str =
    "Stability of one pair of steps, $Q$ the propagator over the synchronization period $T = q h_2 = p h_1$";

/// A rational trace is shown unasked where the period has at most so many kicks.
const SHORT_PERIOD: u64 = 40;

/// A rational trace is shown unasked where it has at most so many characters.
const SHORT_TEXT: usize = 60;

impl Answer {
    /// The exact trace: always where `wanted`, otherwise where it is short. `None` where a stiffness or step
    /// makes it irrational.
    pub fn exact_trace(clocks: &TwoClocks<Laurent>, wanted: bool) -> Option<Rational> {
        let clocks = clocks.as_rational()?;
        if !wanted && clocks.p() + clocks.q() > SHORT_PERIOD {
            return None;
        }
        let trace = exact_trace(&clocks);
        (wanted || trace.to_string().len() <= SHORT_TEXT).then_some(trace)
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
        let clocks = self.oscillator.clocks();
        let m = self.growth.label?;
        let (a, b) = dominant_family(clocks.ratio(), m);
        Some((m, a, b))
    }

    /// The document `kickdrift/verdict/1` without its input.
    pub fn document(&self) -> Document {
        let record = record();
        let mut document = record.document(Document::new("verdict"), self);
        if let Some(exact) = &self.exact_trace {
            document = document.entry("trace.exact", exact.to_string());
        }
        #[cfg(feature = "system")]
        if let Some(own) = &self.friction {
            document = document.entry("friction", super::friction::value(own));
        }
        document
            .long_rows(record.table("verdict", CAPTION, [self]).captioned(CAPTION_LATEX))
            .summary_alone(&self.lines())
    }
}

/// What is written of an answer.
fn record() -> Record<'static, Answer> {
    type Of<'a> = &'a Answer;
    Record::new()
        .column(Column::math("h1", "h_1").aside(), |of: Of| Cell::exact(of.oscillator.h1()))
        .column(Column::math("h2", "h_2").aside(), |of| Cell::exact(of.oscillator.h2()))
        .field(Column::math("p", "p"), |of| of.oscillator.clocks().p().into())
        .field(Column::math("q", "q"), |of| of.oscillator.clocks().q().into())
        .field(Column::new("kind").left(), |of| of.decision.verdict.kind().name().into())
        .field(Column::new("stable").aside(), |of| of.decision.verdict.is_stable().into())
        .field(Column::new("side").aside(), |of| i64::from(of.decision.verdict.side()).into())
        .field(Column::math("trace", "\\operatorname{Tr} Q").enclosure(), |of| {
            of.growth.trace.to_f64_enclosure().into()
        })
        .field(Column::new("growth_rate").titled("growth rate", "$\\ln\\mu/T$").enclosure(), |of| {
            of.growth_rate().into()
        })
        .at("resonance.m", Column::math("m", "m"), |of| of.resonance().map(|(m, ..)| m).into())
        .at("resonance.a", Column::math("a", "a"), |of| of.resonance().map(|(_, a, _)| a).into())
        .at("resonance.b", Column::math("b", "b"), |of| of.resonance().map(|(.., b)| b).into())
        .field(Column::new("decided_by").in_words("decided by").left().aside(), |of| {
            of.decision.decided_by.name().into()
        })
}

/// For people.
impl Answer {
    /// Five to seven lines; the one row of the table would only repeat them.
    fn lines(&self) -> Vec<String> {
        let clocks = self.oscillator.clocks();
        let (p, q) = (clocks.p(), clocks.q());
        let verdict = self.decision.verdict;
        let mut lines = vec![
            self.headline(),
            format!(
                "  h2/h1        {p}/{q}: {p} fast and {q} slow kicks in the period T = {}",
                self.oscillator.period()
            ),
            format!("  trace        {}", shown(self.growth.trace.to_f64_enclosure())),
        ];
        if let Some(exact) = &self.exact_trace {
            lines.push(format!("               = {exact} exactly"));
        }
        if verdict.kind() == Kind::Hyperbolic {
            let rate = self.growth_rate();
            let steps = std::f64::consts::LN_10 / (rate.0 * self.oscillator.h2().to_f64());
            // Where the rate or the steps are beyond doubles, nothing can be said of the steps.
            let steps = Some(steps).filter(|steps| steps.is_finite() && *steps > 0.0).map(significant);
            let tenfold = steps.map_or(String::new(), |steps| format!(": tenfold in {steps} slow steps"));
            lines.push(format!("  growth rate  {} per unit time{tenfold}", shown(rate)));
        }
        if let Some((m, a, b)) = self.resonance() {
            lines.push(format!(
                "  resonance    m = {m} half turns a period; dominant family (a, b) = ({a}, {b})"
            ));
        }
        lines.push(format!("  decided by   {}", self.decision.decided_by.name()));
        #[cfg(feature = "system")]
        lines.extend(self.friction.iter().flat_map(super::friction::lines));
        lines
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

/// An enclosure as the digits that are certain.
fn shown((lo, hi): (f64, f64)) -> String {
    decimal::enclosure(lo, hi).to_string()
}

/// Three significant digits.
fn significant(x: f64) -> String {
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    if x >= 1e7 { format!("{x:.2e}") } else { format!("{x:.digits$}") }
}
