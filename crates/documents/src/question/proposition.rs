//! The Proposition, checked exhaustively.

use super::asking::{Question, Work, question};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, FLAG, INTEGER, POSITIVE, Schema, Shape};
use crate::report::table::Column;
use clocks::resonance::proposition::{Check, Witness, check};
use number::{Error, Result};

question! {
    /// The Proposition for all coprime p, q up to a number, with all witnesses.
    args struct Proposition {
        /// All coprime p, q up to this number.
        max as "N": u64 = "60",
    }
}

/// Witnesses beyond this bound alone would fill gigabytes.
const LARGEST_MAX: u64 = 400;

const CAPTION: &str = "Resonant points h2/h1 = p/q, p theta = m pi, and a curve (a, b) through each";

/// The caption in LaTeX.
const CAPTION_LATEX: &str = "Resonant points $h_2/h_1 = p/q$, $p\\theta = m\\pi$, and a curve $(a, b)$ with $m = ap + bq$ through each";

/// Seconds for each of max³ (1 + ln max) points and curves.
const POINT: f64 = 1.5e-6;

impl Question for Proposition {
    const NAME: &'static str = "proposition";
    const USAGE: Option<&'static str> = Some("[--max <N>]");
    const EXAMPLES: &'static [&'static str] = &["proposition --max 12"];
    type Answer = (Check, Vec<Witness>);

    fn schema() -> Option<Schema> {
        let title = "The Proposition (eqs. 9 and 10) checked exactly for all coprime p, q up to a bound";
        Some(Schema::new(title, head().keys()))
    }

    fn answer(&self, work: &Work) -> Result<Self::Answer> {
        let max = self.max;
        if !(1..=LARGEST_MAX).contains(&max) {
            let remedy = format!("choose 1 to {LARGEST_MAX}; the number of witnesses grows like its cube");
            return Err(Error::input("max", max, remedy));
        }
        let name = format!("the Proposition up to {max}");
        if max.pow(3) > work.limits().kicks {
            let cost = format!("{name} has about {} points and curves", max.pow(3));
            return Err(Error::budget(cost, max.pow(3)).or("choose a smaller --max"));
        }
        work.announce(&name, (max as f64).powi(3) * (1.0 + (max as f64).ln()) * POINT);
        let mut witnesses = Vec::new();
        let check = check(max, |witness| witnesses.push(*witness));
        Ok((check, witnesses))
    }

    fn show(&self, answer: &Self::Answer) -> Document {
        let (check, witnesses) = answer;
        let (max, Check { forward, backward, failures }) = (self.max, check);
        let verdict = if failures.is_empty() { "holds" } else { "FAILS" };
        let lines = [
            format!("the Proposition {verdict} for all coprime p, q <= {max}, exactly"),
            format!("  resonant points (p, q, m), each on a curve (a, b) with b != 0   {forward:>9}"),
            format!("  curves (a, b) at a ratio p/q, each resonant with m = a p + b q  {backward:>9}"),
            format!(
                "  failures                                                        {:>9}",
                failures.len()
            ),
        ];
        let witnesses = record().table("witnesses", CAPTION, witnesses).captioned(CAPTION_LATEX);
        head().document(Document::new(Self::NAME), answer).rows(witnesses).summary(&lines)
    }
}

/// The record of the whole.
fn head() -> Record<'static, (Check, Vec<Witness>)> {
    const WITNESSES: Shape = Shape::List(&Shape::Object(|| record().keys()));
    Record::new()
        .json("holds", |(check, _): &(Check, Vec<Witness>)| check.failures.is_empty().into())
        .says(FLAG, "Whether there is no failure.")
        .json("resonant_points", |(check, _)| check.forward.into())
        .says(COUNT, "Points (p, q, m) of eq. (9), each found on a curve (a, b) with b != 0.")
        .json("curves", |(check, _)| check.backward.into())
        .says(COUNT, "Curves (a, b) at a ratio p/q, each found resonant with m = a p + b q.")
        .value("failures", |(check, _)| record().all(&check.failures).into())
        .says(WITNESSES, "Points and curves for which it fails.")
        .value("witnesses", |(_, witnesses)| record().all(witnesses).into())
        .says(WITNESSES, "One for each resonant point.")
}

/// The row of a resonant point.
fn record() -> Record<'static, Witness> {
    Record::new()
        .field(Column::math("p", "p"), |witness: &Witness| witness.ratio.p().into())
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .field(Column::math("q", "q"), |witness| witness.ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .field(Column::math("m", "m"), |witness| witness.m.into())
        .says(POSITIVE, "The point is p theta = m pi.")
        .field(Column::math("a", "a"), |witness| witness.a.into())
        .says(INTEGER, "a of the curve, m = a p + b q.")
        .field(Column::math("b", "b"), |witness| witness.b.into())
        .says(Shape::With(&INTEGER, r#"{"not": {"const": 0}}"#), "b of the curve.")
}
