//! A family as rows and lines.

use super::super::linted::BITS;
use super::super::orders::commutators;
use super::asked::{Family, Goal};
use super::member::Member;
use super::search::{Best, Members};
use crate::question::asking::Question;
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{
    COUNT, FLAG, GROUP_OR_NULL, INTEGER, RATIONAL, RATIONAL_OR_NULL, Schema, Shape, TEXT, WIDE_ENCLOSURE,
};
use crate::report::table::{Cell, Column};
use num_traits::Zero;
use number::{Ball, Rational, Real};

const ENDS_OR_NULL: Shape = Shape::OrNull(&WIDE_ENCLOSURE);

/// Members and the degree at which their errors are compared.
type Row<'a> = (&'a Member, Option<u64>);

impl Member {
    /// The size of its error of one degree.
    pub(super) fn error(&self, degree: Option<u64>) -> Option<(f64, f64)> {
        let square = self.square(degree?)?.enclosure(BITS);
        square.sqrt(BITS).map(|root| root.to_f64_enclosure())
    }
}

/// The row of a member. The columns of values have these names.
fn record<'a>(names: [&str; 2], places: [usize; 2]) -> Record<'static, Row<'a>> {
    let ends = |ball: Option<Ball>| Cell::from(ball.map(|ball| ball.to_f64_enclosure()));
    let [first, second] = places;
    let value = |member: &Member, at: usize| member.values.get(at).map_or(Cell::Missing, Cell::exact);
    let general = |member: &Member| member.linted.general.as_ref().ok().map(|orders| orders.general.order);
    Record::new()
        .field(Column::new("value").in_words(names[0]), move |(member, _): &Row<'a>| value(member, first))
        .says(RATIONAL, "The value of the parameter that has a range.")
        .field(Column::new("second").in_words(names[1]).aside(), move |(member, _)| value(member, second))
        .says(RATIONAL_OR_NULL, "That of the second one with a range; null where there is none.")
        .field(Column::new("consistent").aside(), |(member, _)| member.linted.word.is_consistent().into())
        .says(FLAG, "Whether every sum of coefficients is 1.")
        .field(Column::new("palindrome").aside(), |(member, _)| member.linted.word.asymmetry().is_none().into())
        .says(FLAG, "Whether the word reads the same backwards.")
        .field(Column::new("order"), |(member, _)| member.linted.order.order.into())
        .says(INTEGER, "The order on oscillators.")
        .field(Column::new("general_order").in_words("general"), move |(member, _)| general(member).into())
        .says(Shape::OrNull(&INTEGER), "The order on all problems; null where a letter is no exponential of commutators.")
        .field(Column::new("nystrom_order").in_words("Nystrom"), |(member, _)| member.nystrom_order().into())
        .says(Shape::OrNull(&INTEGER), "The order where the kinetic energy is quadratic.")
        .field(Column::new("error").enclosure(), |(member, degree)| member.error(*degree).into())
        .says(ENDS_OR_NULL, "The root of the sum of the squares of the error's coefficients of that degree, in commutators of Lyndon words, the kinetic energy being quadratic; 0 where the order is higher.")
        .field(Column::new("error_terms").left().in_words("error in commutators").aside(), |(member, degree)| {
            let terms = degree.and_then(|degree| member.terms(degree));
            terms.map_or(Cell::Missing, |terms| Cell::Text(commutators(terms, usize::MAX)))
        })
        .says(Shape::OrNull(&TEXT), "The same in commutators, drifts being A and kicks B, or B1 and B2; coefficients of more than 24 characters with seven digits.")
        .field(Column::new("evaluations").in_words("cost"), |(member, _)| member.linted.cost.total().into())
        .says(COUNT, "Evaluations, gradients, solves and flows a step.")
        .field(Column::new("edge").in_words("omega h below").enclosure(), move |(member, _)| {
            ends(member.linted.edge_omega_h())
        })
        .says(ENDS_OR_NULL, "The end of the stable steps that begin at 0, in sqrt(lambda1) h; null where there is none, or two forces have no stiffness.")
        .field(Column::new("nominal_edge").in_words("nominally").enclosure().aside(), move |(member, _)| {
            ends(member.linted.nominal_edge())
        })
        .says(ENDS_OR_NULL, "The same when unstable intervals below 2^-30 of their size do not count.")
        .field(Column::new("efficiency").enclosure(), |(member, _)| member.linted.efficiency().into())
        .says(ENDS_OR_NULL, "The nominal edge for each evaluation, gradient, solve and flow.")
        .field(Column::new("bias").enclosure(), move |(member, _)| ends(member.bias.clone()))
        .says(ENDS_OR_NULL, "(R + 1/R)/2 - 1 at the worst step up to that length, R the bias: it bounds the mean energy error of a mode in hybrid Monte Carlo. Null where one of these steps is unstable, or A and D differ.")
}

/// What is best, and between which values it lies.
fn best_record(places: [usize; 2]) -> Record<'static, Option<Best>> {
    type Of<'a> = &'a Option<Best>;
    let value = |best: Of, at: usize| {
        best.as_ref().and_then(|best| best.member.values.get(at)).map_or(Cell::Missing, Cell::exact)
    };
    let end = |best: Of, which: fn(&(Rational, Rational)) -> &Rational| {
        let bracket = best.as_ref().and_then(|best| best.bracket.as_ref());
        bracket.map_or(Cell::Missing, |bracket| Cell::exact(which(bracket)))
    };
    let [first, second] = places;
    Record::new()
        .json("best.goal", |best: Of| best.as_ref().map(|best| best.goal.name()).into())
        .says(Shape::OneOf(&["edge", "efficiency", "error", "bias"]), "What is best.")
        .json("best.value", move |best| value(best, first))
        .says(RATIONAL, "The best value that was tried.")
        .json("best.second", move |best| value(best, second))
        .says(RATIONAL_OR_NULL, "That of the second parameter with a range.")
        .json("best.lower", move |best| end(best, |bracket| &bracket.0))
        .says(RATIONAL_OR_NULL, "The nearest smaller value that was tried there, which is not better; the value itself at the end of the range; null where two parameters have a range.")
        .json("best.upper", move |best| end(best, |bracket| &bracket.1))
        .says(RATIONAL_OR_NULL, "The nearest greater one.")
        .json("best.closes", |best| best.as_ref().map(|best| best.closes).into())
        .says(FLAG, "Whether the first unstable interval closes there, so that the stable steps go on beyond it: between lower and upper.")
        .json("best.proven", |best| best.as_ref().map(|best| best.proven).into())
        .says(FLAG, "Whether no value of the range is better but such as lie between lower and upper, which hold the best one: of an error that is a polynomial in the parameter.")
        .json("best.tried", |best| best.as_ref().map(|best| best.tried).into())
        .says(COUNT, "Values that were tried beside those of the rows.")
        .json("best.word", |best| best.as_ref().map_or(Cell::Missing, |best| Cell::exact(&best.member.linted.word)))
        .says(TEXT, "The best word.")
}

impl Family {
    /// Which parameters have a range: the second is beyond all of them where there is none.
    fn places(&self) -> ([&str; 2], [usize; 2]) {
        let ranged: Vec<_> = self.parameter.ranged().collect();
        let first = ranged[0];
        let second = ranged.get(1);
        let names = [first.1.name.as_str(), second.map_or("", |second| second.1.name.as_str())];
        (names, [first.0, second.map_or(usize::MAX, |second| second.0)])
    }
}

pub(super) fn document(family: &Family, members: &Members) -> Document {
    let (names, places) = family.places();
    let rows: Vec<Row> = members.all.iter().map(|member| (member, members.degree)).collect();
    let record = record(names, places);
    let table = record.table("members", "A word at each value of its parameter", &rows);
    let mut people = vec!["value"];
    people.extend((!names[1].is_empty()).then_some("second"));
    // What is sought first: a narrow terminal leaves the last columns out.
    let sought = family.goal().map(Goal::name);
    people.extend(sought);
    let rest = ["order", "nystrom_order", "error", "evaluations", "edge", "efficiency", "bias"];
    people.extend(rest.into_iter().filter(|name| Some(*name) != sought));
    let people = table.only(&people);
    let document = best_record(places).document(Document::new(Family::NAME), &members.best);
    let document = match members.degree {
        Some(degree) => document.entry("degree", degree),
        None => document.entry("degree", serde_json::Value::Null),
    };
    document.rows(table).for_people(people).summary(&lines(family, members))
}

/// For people.
fn lines(family: &Family, members: &Members) -> Vec<String> {
    let mut lines = vec![format!("{} with {}: {} members", family.word, family.parameter, members.all.len())];
    let mut say = |name: &str, text: String| lines.push(format!("  {name:<12} {text}"));
    if let Some(degree) = members.degree {
        say("error", format!("the size of its coefficients of degree {degree}, in commutators"));
    }
    let up_to = match &family.up_to {
        Some(up_to) => format!("omega h = {up_to}"),
        None => "omega h = the evaluations a step".into(),
    };
    say("bias", format!("(R + 1/R)/2 - 1 at the worst step up to {up_to}"));
    match (&members.best, family.goal()) {
        (Some(best), _) => {
            say("best", best.text(family, members.degree));
            let tried = "each value tried is exact; whether one between them is better is not proven";
            say(
                "proven",
                match best.proven {
                    true => "the least error of the whole range is here, to 2^-60 of it: the roots of its derivative are isolated"
                        .into(),
                    false => format!("{tried}, {} more tried than the rows", best.tried),
                },
            );
        }
        (None, Some(goal)) => say("best", none_has(goal)),
        (None, None) => (),
    }
    lines
}

/// Why nothing is best.
fn none_has(goal: Goal) -> String {
    match goal {
        Goal::Bias => "no member is stable at all steps that count, or none reads the same backwards: look at shorter steps by --up-to".into(),
        Goal::Error => "no member has an error in commutators: it has letters other than kicks and drifts".into(),
        Goal::Edge | Goal::Efficiency => format!(
            "no member has an {}: all steps are stable, none is, or two forces want --lambda1 and --lambda2",
            goal.name()
        ),
    }
}

impl Best {
    /// The value in decimals, and how good it is.
    fn text(&self, family: &Family, degree: Option<u64>) -> String {
        let (names, places) = family.places();
        let decimal = |x: &Rational| {
            let (lo, hi) = number::rational::enclose_f64(x);
            decimal::enclosure(lo, hi).to_string()
        };
        let exact = |x: &Rational| {
            const SHORT: usize = 12;
            let text = x.to_string();
            if text.len() <= SHORT { text } else { decimal(x) }
        };
        let values: Vec<String> = (names.iter().zip(places))
            .filter_map(|(name, at)| Some(format!("{name} = {}", exact(self.member.values.get(at)?))))
            .collect();
        let ends = match self.goal {
            Goal::Edge | Goal::Efficiency => {
                self.member.score(self.goal, degree).map(|ball| ball.to_f64_enclosure())
            }
            Goal::Error => self.member.error(degree),
            Goal::Bias => self.member.bias.as_ref().map(Ball::to_f64_enclosure),
        };
        let size = ends.map_or(String::new(), |(lo, hi)| decimal::enclosure(lo, hi).to_string());
        format!("{}: {} {size}{}", values.join(", "), self.goal.name(), self.beside(places[0]))
    }

    /// How far off the values are that were tried on both sides and are not better.
    fn beside(&self, at: usize) -> String {
        let Some((lo, hi)) = self.bracket.as_ref().filter(|_| !self.proven) else { return String::new() };
        let value = &self.member.values[at];
        let sides = [(value - lo, "below"), (hi - value, "above")];
        let tried = sides.iter().filter(|(far, _)| !far.is_zero());
        let tried: Vec<String> =
            tried.map(|(far, side)| format!("{:.0e} {side}", number::rational::to_f64(far))).collect();
        if tried.is_empty() { String::new() } else { format!(", no better {}", tried.join(" and ")) }
    }
}

/// The schema of a family's document.
pub(super) fn schema() -> Schema {
    let body = best_record([0, 1])
        .keys()
        .key("best", GROUP_OR_NULL, "The best value; null where none was asked for, or no member has such a number.")
        .key("degree", Shape::OrNull(&COUNT), "The degree of the errors: one more than the least Nystrom order of the rows; null where none has one.")
        .key(
            "members",
            Shape::List(&Shape::Object(|| record([""; 2], [0, 1]).keys())),
            "The word at each value, in their order.",
        );
    Schema::new(
        "A word with a parameter: order, error, stable steps and cost at each value; the best value",
        body,
    )
}
