//! The answer to "is this pair stable?" as a document.

use serde_json::{Map, Value};

use super::decimal;
use super::document::{Document, enclosure};
use super::table::{Cell, Column, Table};
use crate::number::{Ball, Laurent, Rational, Real};
use crate::propagator::{Oscillator, TwoClocks};
use crate::resonance::dominant_family;
use crate::verdict::{Decision, Growth, Kind, exact_trace};

/// A decided pair, with all that the document tells.
#[derive(Clone, Debug)]
pub struct Answer {
    pub oscillator: Oscillator,
    pub decision: Decision,
    pub growth: Growth,
    /// Tr Q, where it is rational and was asked for or is short.
    pub exact_trace: Option<Rational>,
}

/// Periods of at most so many kicks have their rational trace shown unasked ...
const SHORT_PERIOD: u64 = 40;
/// ... if it has at most so many characters.
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
    fn growth_rate(&self) -> (f64, f64) {
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

    /// The document `kickdrift/verdict/1`.
    pub fn document(&self) -> Document {
        let (oscillator, clocks) = (&self.oscillator, self.oscillator.clocks());
        let verdict = self.decision.verdict;
        Document::new("verdict")
            .input("lambda1", oscillator.lambda1())
            .input("lambda2", oscillator.lambda2())
            .input("h1", oscillator.h1())
            .input("h2", oscillator.h2())
            .entry("p", clocks.p())
            .entry("q", clocks.q())
            .entry("kind", verdict.kind().name())
            .entry("stable", verdict.is_stable())
            .entry("side", verdict.side())
            .entry("trace", self.trace())
            .entry("growth_rate", enclosure(self.growth_rate()))
            .entry("resonance", self.resonance_value())
            .entry("decided_by", self.decision.decided_by.name())
            .long_rows(self.table())
            .told(&self.lines())
    }

    fn trace(&self) -> Value {
        let mut trace = enclosure(self.growth.trace.to_f64_enclosure());
        if let (Some(exact), Some(map)) = (&self.exact_trace, trace.as_object_mut()) {
            map.insert("exact".into(), exact.to_string().into());
        }
        trace
    }

    fn resonance_value(&self) -> Value {
        let Some((m, a, b)) = self.resonance() else { return Value::Null };
        let entries = [("m", Value::from(m)), ("a", a.into()), ("b", b.into())];
        Value::Object(entries.into_iter().map(|(key, value)| (key.to_string(), value)).collect::<Map<_, _>>())
    }
}

/// For people and for rows.
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
        lines
    }

    fn headline(&self) -> String {
        let verdict = self.decision.verdict;
        let side = if verdict.side() > 0 { "" } else { "-" };
        match verdict.kind() {
            Kind::Elliptic => "stable: elliptic, |Tr Q| < 2".into(),
            Kind::Coexistence => format!("stable: coexistence, Q = {side}I; a tongue is closed here"),
            Kind::Parabolic => format!("unstable: parabolic, Tr Q = {side}2; linear growth"),
            Kind::Hyperbolic if verdict.side() > 0 => {
                "unstable: hyperbolic, Tr Q > 2; exponential growth".into()
            }
            Kind::Hyperbolic => "unstable: hyperbolic, Tr Q < -2; exponential growth".into(),
        }
    }

    fn table(&self) -> Table {
        let clocks = self.oscillator.clocks();
        let verdict = self.decision.verdict;
        let columns = vec![
            Column::new("h1").titled("h1", "$h_1$"),
            Column::new("h2").titled("h2", "$h_2$"),
            Column::new("p").titled("p", "$p$"),
            Column::new("q").titled("q", "$q$"),
            Column::new("kind").left(),
            Column::new("stable"),
            Column::new("side"),
            Column::new("trace").titled("trace", "$\\operatorname{Tr} Q$").enclosure(),
            Column::new("growth_rate").titled("growth rate", "growth rate").enclosure(),
            Column::new("m").titled("m", "$m$"),
            Column::new("a").titled("a", "$a$"),
            Column::new("b").titled("b", "$b$"),
            Column::new("decided_by").titled("decided by", "decided by").left(),
        ];
        let mut table = Table::new("verdict", "Stability of one pair of steps", columns);
        let interval = |(lo, hi): (f64, f64)| Cell::Enclosure { lo, hi };
        let resonance = self.resonance();
        let integer = |n: Option<i64>| n.map_or(Cell::Missing, Cell::Integer);
        table.push(vec![
            Cell::Exact(self.oscillator.h1().to_string()),
            Cell::Exact(self.oscillator.h2().to_string()),
            Cell::Integer(clocks.p() as i64),
            Cell::Integer(clocks.q() as i64),
            Cell::Text(verdict.kind().name().into()),
            Cell::Flag(verdict.is_stable()),
            Cell::Integer(verdict.side().into()),
            interval(self.growth.trace.to_f64_enclosure()),
            interval(self.growth_rate()),
            integer(resonance.map(|(m, _, _)| m as i64)),
            integer(resonance.map(|(_, a, _)| a)),
            integer(resonance.map(|(_, _, b)| b)),
            Cell::Text(self.decision.decided_by.name().into()),
        ]);
        table
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
