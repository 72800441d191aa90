//! The half period of one pair of clocks in numbers.

use super::asking::{Question, Work, question};
use super::verdict::bias_lines;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{GROUP_OR_NULL, Keys, RATIONAL, SIGN, Schema, Shape, WIDE_ENCLOSURE};
use crate::report::table::{Cell, Column};
use clocks::propagator::{Bias, HalfPeriod, TwoClocks, bias, half_period};
use clocks::schedule::Schedule;
use number::{Error, ExactSign, Ratio, Rational, Result, rational};

question! {
    /// A, B, C, D of one ratio at rational s and ρ, exact and enclosed, in the time unit h1: A and D are
    /// numbers, B is in h1, C in 1/h1.
    args struct Half {
        /// h2/h1 = p/q.
        ratio as "P/Q": Ratio,
        /// h1^2 lambda1, rational.
        s as "S": Rational,
        /// lambda2/lambda1, rational; may be negative.
        rho as "R": Rational,
    }
}

/// The largest p + q unless a budget says otherwise: every kick adds the digits of s, so the entries have
/// thousands there.
const MOST_KICKS: u64 = 2000;

/// One of the four entries.
struct Entry<'a> {
    name: &'static str,
    value: &'a Rational,
}

/// The row of an entry.
fn record<'a>() -> Record<'a, Entry<'a>> {
    Record::new()
        .field(Column::new("entry").left(), |entry: &Entry| entry.name.into())
        .says(Shape::OneOf(&["A", "B", "C", "D"]), "Which of the four entries it is.")
        .field(Column::new("sign"), |entry| i64::from(entry.value.sign().to_i8()).into())
        .says(SIGN, "Its sign.")
        .field(Column::new("value").enclosure(), |entry| rational::enclose_f64(entry.value).into())
        .says(WIDE_ENCLOSURE, "An enclosure in doubles.")
        .field(Column::new("exact"), |entry| Cell::exact(entry.value))
        .says(RATIONAL, "The entry, exactly.")
}

impl Half {
    pub(crate) fn clocks(&self) -> TwoClocks<Rational> {
        TwoClocks::with_rho(self.ratio, self.s.clone(), self.rho.clone())
    }

    /// By how much the potential energy of a stable pair is off.
    pub(crate) fn bias(&self) -> Option<Bias<Rational>> {
        bias(&self.clocks())
    }
}

impl Question for Half {
    const NAME: &'static str = "half";
    const EXAMPLES: &'static [&'static str] = &["half --ratio 5/3 --s 11/4 --rho 1/25"];
    type Answer = HalfPeriod<Rational>;

    fn schema() -> Option<Schema> {
        const ENTRIES: Shape = Shape::With(
            &Shape::List(&Shape::Object(|| record().keys())),
            r#"{"minItems": 4, "maxItems": 4}"#,
        );
        let says = "By how much the potential energy is off, 1 being right; null unless elliptic.";
        let kicks = "(lambda1 + lambda2) <x^2>/kT where both clocks kick, velocities thermal at the kicks (constant energy, OBABO).";
        let drifts = "The same with a weak thermostat in the middle of every drift (BAOAB, LangevinMiddle).";
        let body = Keys::new().key("bias.at_kicks", RATIONAL, kicks).key("bias.in_drifts", RATIONAL, drifts);
        let body = body.key("bias", GROUP_OR_NULL, says);
        let body = body.key("entries", ENTRIES, "A, B, C, D in the time unit h1: B in h1, C in 1/h1.");
        let title = "The half period of two clocks in numbers: A, B, C, D at rational s and rho";
        Some(Schema::new(title, body))
    }

    fn answer(&self, work: &Work) -> Result<HalfPeriod<Rational>> {
        let (kicks, most) = (self.ratio.kicks(), work.budget.unwrap_or(MOST_KICKS));
        if kicks > most {
            let cost = format!("the half period of {} has the digits of {kicks} kicks", self.ratio);
            return Err(Error::budget(cost, kicks).or(format!("choose p + q <= {most}")));
        }
        // That its ticks can be counted.
        Schedule::two_clocks(self.ratio)?;
        Ok(half_period(&self.clocks()))
    }

    fn show(&self, half: &HalfPeriod<Rational>) -> Document {
        let entries = [("A", half.a()), ("B", half.b()), ("C", half.c()), ("D", half.d())];
        let entries = entries.map(|(name, value)| Entry { name, value });
        let summary = format!(
            "half period of h2/h1 = {} at s = {}, rho = {}: Tr Q = {}",
            self.ratio,
            self.s,
            self.rho,
            half.trace()
        );
        let table =
            record().table("entries", "The half period [[A, B], [C, D]] in the time unit h1", &entries);
        let caption = format!("The entries of the half period at $s = {}$ in the time unit $h_1$", self.s);
        let (document, mut lines) = (Document::new(Self::NAME), vec![summary]);
        let document = match self.bias() {
            Some(Bias { at_kicks, in_drifts }) => {
                lines.extend(bias_lines([rational::to_f64(&at_kicks), rational::to_f64(&in_drifts)]));
                document
                    .entry("bias.at_kicks", at_kicks.to_string())
                    .entry("bias.in_drifts", in_drifts.to_string())
            }
            None => document.entry("bias", serde_json::Value::Null),
        };
        document.rows(table.captioned(&caption)).summary(&lines)
    }
}
