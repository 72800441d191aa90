//! A word's answer as entries, rows and lines.

use super::asked::Word;
use super::linted::{BITS, Linted, Span, omega_h};
use super::orders::{Line, shown, with_orders};
use crate::report::decimal;
use crate::report::record::Record;
use crate::report::shape::{FLAG, GROUP, GROUP_OR_NULL, INTEGER, SIGN, Schema, Shape, TEXT, WIDE_ENCLOSURE};
use crate::report::table::{Cell, Column, Table};
use num_traits::Zero;
use number::{Ball, Laurent, Radical, Rational, Real};
use words::{At, Damping, Edge, Letter, MOST_ORDER, Order};

impl Linted {
    /// Every interval with one answer.
    pub(super) fn rows(&self, lambda1: Option<&Laurent>) -> Table {
        let formula =
            if self.word.names_forces() { "$\\sqrt{\\Lambda_1}\\,h$ from" } else { "$\\omega h$ from" };
        let record = spans(&format!("{} from", self.unit()), formula);
        record.table("intervals", "Stable and unstable steps of the word", &self.spans(lambda1))
    }

    /// For people.
    pub(super) fn lines(&self, question: &Word) -> Vec<String> {
        let named = self.identity().into_iter().chain(self.steps(question)).chain(self.costs());
        let named = named.chain(self.at_step(question));
        let lines = named.map(|(name, text)| format!("  {name:<12} {text}"));
        std::iter::once(self.word.to_string()).chain(lines).collect()
    }

    /// What a person wants first: the verdict at the step, which steps are stable, order and cost; beyond
    /// that what is wrong with it.
    pub(super) fn answer(&self, question: &Word) -> Vec<String> {
        let is_first = |(name, text): &Line| match *name {
            "consistent" | "palindrome" => text.starts_with("no"),
            "frequency" | "impedance" | "error" => false,
            _ => true,
        };
        let named = self.at_step(question).into_iter().chain(self.steps(question)).chain(self.identity());
        let lines = named.chain(self.costs()).filter(is_first);
        let lines = lines.map(|(name, text)| format!("  {name:<12} {text}"));
        std::iter::once(self.word.to_string()).chain(lines).collect()
    }

    /// The name of a sum: friction is O unless it has other letters.
    fn named(&self, sum: &'static str) -> &'static str {
        let is_other = |letter: &&Letter| matches!(letter, Letter::Friction { damping, .. } if *damping != Damping::Exact);
        if sum == "O" && self.word.letters().iter().any(is_other) { "friction" } else { sum }
    }

    /// What its letters alone say.
    fn identity(&self) -> Vec<Line> {
        let sums: Vec<String> =
            self.sums.iter().map(|(name, sum)| format!("{} {}", self.named(name), beside_one(sum))).collect();
        let consistent = if self.word.is_consistent() { "yes" } else { "no" };
        let consistent = format!("{consistent}: the coefficients sum to {}", sums.join(", "));
        let palindrome = self.word.asymmetry().map_or("yes".into(), |place| {
            format!("no: letter {} is {}, its mirror image {}", place.letter, place.there, place.mirrored)
        });
        let Order { order, nominal, .. } = self.order;
        let least = if order >= MOST_ORDER && !self.word.is_algebraic() { "at least " } else { "" };
        let friction = if self.word.has_friction() { ", friction aside" } else { "" };
        let rounded = if nominal > order {
            format!(" but for errors below 1e-9, as rounded coefficients have them; {order} exactly")
        } else {
            String::new()
        };
        let order = format!("{least}{nominal} on oscillators{friction}{rounded}");
        let mut lines = vec![("consistent", consistent), ("palindrome", palindrome), ("order", order)];
        lines.extend(self.on_all_problems());
        for (name, term) in [("frequency", &self.order.frequency), ("impedance", &self.order.impedance)] {
            let Some((k, c)) = term else { continue };
            let text = shown(c);
            let term = match text.strip_prefix('-') {
                _ if text.contains(' ') => format!("+ ({text})"),
                Some(rest) => format!("- {rest}"),
                None => format!("+ {text}"),
            };
            lines.push((name, format!("omega (1 {term} (omega h)^{k} + ...)")));
        }
        lines
    }

    /// Which steps are stable.
    fn steps(&self, question: &Word) -> Vec<Line> {
        let unit = self.unit();
        let mut lines = Vec::new();
        if let Some(stability) = &self.stability {
            lines.push(("stable", match (stability.first_edge(), stability.begins_stable()) {
                (Some(edge), _) => {
                    let exact = edge.rational().map_or(String::new(), |s| format!(" = sqrt({s})"));
                    let below = if edge.coexistence { "<=" } else { "<" };
                    let ends = omega_h(edge).to_f64_enclosure();
                    let nominal = self.nominal_edge().map(|ball| ball.to_f64_enclosure());
                    let nominal = nominal.filter(|pair| *pair != ends);
                    let nominal = nominal.map_or(String::new(), |pair| {
                        let own = enclosed(pair);
                        format!("; {own} but for unstable intervals below 1e-9, as rounded coefficients open them")
                    });
                    format!("0 < {unit} {below} {}{exact}{nominal}", enclosed(ends))
                }
                (None, true) => "at every step".into(),
                (None, false) => "not at small steps".into(),
            }));
        }
        if let Some(pieces) = &self.pieces {
            let step = if question.lambda1.is_some() { "h" } else { "omega h" };
            let upto =
                format!("looked at up to {step} = {}", decimal::enclosure(pieces.range.1, pieces.range.1));
            let begins = pieces.all.first().is_some_and(|first| first.stable);
            lines.push((
                "stable",
                match (self.edge_omega_h().filter(|_| begins), pieces.is_free) {
                    (_, true) => "at every step, by theorem: no resonance".into(),
                    (Some(edge), _) => format!("0 < {unit} < {}; {upto}", enclosed(edge.to_f64_enclosure())),
                    _ => format!("see the intervals; {upto}"),
                },
            ));
        }
        if self.word.names_forces() && question.lambda1.is_none() {
            lines.push((
                "stable",
                "not told: two forces want their stiffnesses, --lambda1 and --lambda2".into(),
            ));
        }
        if self.word.has_friction() {
            lines.push((
                "friction",
                match &question.friction {
                    Some(friction) => format!("{friction}: stable steps draw every start to 0, noise aside"),
                    None => "not given: O, F and I do nothing, and the results are of the word without them"
                        .into(),
                },
            ));
        }
        lines
    }

    /// What a step costs, and how far it goes for that.
    fn costs(&self) -> Vec<Line> {
        let (unit, cost) = (self.unit(), self.cost);
        let counts = match (self.word.names_forces(), cost.evaluations) {
            (false, [all, _]) => counted(all, "evaluation"),
            (true, [fast, slow]) => format!("{} of force 1, {slow} of force 2", counted(fast, "evaluation")),
        };
        let more = [(cost.gradients, "gradient"), (cost.solves, "linear solve"), (cost.flows, "exact flow")];
        let more =
            more.into_iter().filter(|(n, _)| *n > 0).map(|(n, text)| format!(", {}", counted(n, text)));
        let mut lines = vec![("cost", format!("{counts}{} a step", more.collect::<String>()))];
        if let Some((most, least)) = self.efficiency().zip(self.per_unit()) {
            let (most, least) = (enclosed(most), enclosed(least));
            lines.push((
                "efficiency",
                format!(
                    "at the longest step each operation covers {unit} = {most}; {unit} = 1 takes {least} operations"
                ),
            ));
        }
        lines
    }

    /// The verdict at the step that was asked about.
    fn at_step(&self, question: &Word) -> Vec<Line> {
        let (Some(found), Some(h)) = (&self.at, &question.h) else { return Vec::new() };
        let stable = match (found.kind, found.is_stable()) {
            ("edge", _) => "on an edge or nearer to one than balls can decide",
            ("marginal", _) => "on an edge: bounded, but not drawn to 0",
            (_, true) => "stable",
            (_, false) => "unstable",
        };
        let trace = enclosed(found.trace.to_f64_enclosure());
        let verdict = ("verdict", format!("{stable} at h = {h}: {}, trace {trace}", found.kind));
        let rates = [
            ("growth rate", &found.ln_multiplier, "per unit time"),
            ("frequency", &found.angle, "at this step"),
            ("impedance", &found.impedance, "at this step"),
        ];
        let rates = rates
            .into_iter()
            .filter_map(|(name, x, unit)| Some((name, format!("{} {unit}", enclosed(rate(x, h)?)))));
        let bias = bias(self, question).map(|bias| {
            (
                "bias",
                format!(
                    "potential over kinetic energy {} at the word's ends; 1 is right",
                    enclosed(bias.to_f64_enclosure())
                ),
            )
        });
        std::iter::once(verdict).chain(rates).chain(bias).collect()
    }
}

/// `1 evaluation`, `2 evaluations`.
fn counted(n: u64, of: &str) -> String {
    format!("{n} {of}{}", if n == 1 { "" } else { "s" })
}

/// x/h as an enclosure.
fn rate(x: &Option<Ball>, h: &Laurent) -> Option<(f64, f64)> {
    Some(x.as_ref()?.div(&h.enclosure(BITS), BITS)?.to_f64_enclosure())
}

/// An enclosure as the digits that are certain.
fn enclosed((lo, hi): (f64, f64)) -> String {
    decimal::enclosure(lo, hi).to_string()
}

/// A sum that should be 1: what it lacks, where that is little.
fn beside_one(sum: &Radical) -> String {
    const LITTLE: f64 = 1e-5;
    let rest = Ball::nearest_f64(|bits| sum.enclosure(bits).sub(&Ball::one(), bits));
    match rest {
        0.0 => shown(sum),
        rest if rest.abs() < LITTLE => format!("1 {} {:.1e}", if rest < 0.0 { '-' } else { '+' }, rest.abs()),
        _ => match shown(sum) {
            text if text.contains('e') => format!("{:.6}", sum.enclosure(BITS).mid_f64()),
            text => text,
        },
    }
}

/// The entries of a word's document.
pub(super) fn record(question: &Word) -> Record<'_, Linted> {
    type Of<'a> = &'a Linted;
    let text = |x: &Radical| Cell::Text(x.text(ToString::to_string));
    let in_rho = |f: &number::Polynomial<Radical>| {
        let term = |(k, c): (usize, &Radical)| match k {
            0 => c.text(ToString::to_string),
            k => format!("({})*rho^{k}", c.text(ToString::to_string)),
        };
        let terms = f.coefficients().iter().enumerate().filter(|(_, c)| !c.is_zero()).map(term);
        let terms: Vec<String> = terms.collect();
        Cell::Text(if terms.is_empty() { "0".into() } else { terms.join(" + ") })
    };
    let term = |pair: &Option<(u64, Radical)>, power: bool| match pair {
        None => Cell::Missing,
        Some((k, _)) if power => (*k).into(),
        Some((_, c)) => Cell::Text(c.text(ToString::to_string)),
    };
    let sum = move |linted: Of, name: &str| {
        linted.sums.iter().find(|(text, _)| *text == name).map_or(Cell::Missing, |(_, sum)| text(sum))
    };
    let at = |linted: Of, which: fn(&At) -> &Option<Ball>| -> Cell {
        linted.at.as_ref().zip(question.h.as_ref()).and_then(|(found, h)| rate(which(found), h)).into()
    };
    let mut record = Record::new()
        .json("word", |linted: Of| Cell::exact(&linted.word))
        .says(TEXT, "The word that is asked about, its coefficients exact.")
        .json("consistent", |linted| linted.word.is_consistent().into())
        .says(FLAG, "Whether every sum of coefficients is 1.");
    for name in ["D", "K", "K1", "K2", "O"] {
        record = record.json(&format!("sums.{name}"), move |linted| sum(linted, name)).says(
            TEXT_OR_NULL,
            if name == "O" { "Of O, F and I together.".into() } else { format!("Of {name}.") },
        );
    }
    record = record
        .json("palindrome", |linted| linted.word.asymmetry().is_none().into())
        .says(FLAG, "Whether the word reads the same backwards, so that the method is symmetric in time.")
        .json("differs.letter", |linted| linted.word.asymmetry().map(|place| place.letter as u64).into())
        .says(INTEGER, "The letter, counted from 1 when letters that touch are joined.")
        .json("differs.there", |linted| {
            linted.word.asymmetry().map_or(Cell::Missing, |place| Cell::Text(place.there))
        })
        .says(TEXT, "That letter.")
        .json("differs.mirrored", |linted| {
            linted.word.asymmetry().map_or(Cell::Missing, |place| Cell::Text(place.mirrored))
        })
        .says(TEXT, "The letter as far from the end.")
        .json("order", |linted| linted.order.order.into())
        .says(INTEGER, "The order on oscillators, exactly; 0 where the word is not consistent.")
        .json("nominal_order", |linted| linted.order.nominal.into())
        .says(
            INTEGER,
            "The order when error coefficients below 2^-30 count as 0, as rounded coefficients leave them.",
        );
    record = with_orders(record);
    for (i, name) in ["A", "B", "C", "D"].into_iter().enumerate() {
        record = record
            .json(&format!("error.{name}"), move |linted| in_rho(&linted.order.error[i]))
            .says(TEXT, format!("Of {name}."));
    }
    record
        .json("frequency.power", move |linted| term(&linted.order.frequency, true))
        .says(INTEGER, "The power k of omega h.")
        .json("frequency.coefficient", move |linted| term(&linted.order.frequency, false))
        .says(TEXT, "The coefficient c, exactly.")
        .json("impedance.power", move |linted| term(&linted.order.impedance, true))
        .says(INTEGER, "The power k of omega h.")
        .json("impedance.coefficient", move |linted| term(&linted.order.impedance, false))
        .says(TEXT, "The coefficient c, exactly.")
        .json("edge.omega_h", |linted| linted.edge_omega_h().map(|edge| edge.to_f64_enclosure()).into())
        .says(WIDE_ENCLOSURE, "In omega h.")
        .json("edge.s", |linted| {
            linted
                .edge_omega_h()
                .map(|edge| linted.edge().map_or_else(|| edge.square(BITS), Edge::s).to_f64_enclosure())
                .into()
        })
        .says(WIDE_ENCLOSURE, "In s = lambda1 h^2.")
        .json("edge.exact", |linted| {
            linted.edge().and_then(Edge::rational).map_or(Cell::Missing, Cell::exact)
        })
        .says(TEXT_OR_NULL, "s = lambda1 h^2 where it is rational.")
        .json("edge.side", |linted| linted.edge().map(|edge| i64::from(edge.side)).into())
        .says(SIDE_OR_NULL, "The trace there is twice this; null where balls enclose the edge.")
        .json("edge.polynomial", |linted| {
            linted.edge().map_or(Cell::Missing, |edge| Cell::Text(polynomial(edge)))
        })
        .says(TEXT_OR_NULL, "s is its only zero in the enclosure; squarefree, exact. Null where balls enclose the edge.")
        .json("free", |linted| linted.pieces.as_ref().map(|pieces| pieces.is_free).into())
        .says(Shape::OrNull(&FLAG), "Whether no step at all is unstable, by theorem; null where the word has neither exact flows nor friction.")
        .json("nominal_edge", |linted| linted.nominal_edge().map(|ball| ball.to_f64_enclosure()).into())
        .says(ENDS_OR_NULL, "The same edge, in omega h, when unstable intervals below 2^-30 of their size do not count, as rounded coefficients open them.")
        .json("evaluations.first", |linted| linted.cost.evaluations[0].into())
        .says(INTEGER, "Evaluations of K1's force, or of the whole one.")
        .json("evaluations.second", |linted| linted.cost.evaluations[1].into())
        .says(INTEGER, "Of K2's.")
        .json("evaluations.gradients", |linted| linted.cost.gradients.into())
        .says(INTEGER, "Kicks with a higher power of the force.")
        .json("evaluations.solves", |linted| linted.cost.solves.into())
        .says(INTEGER, "Implicit midpoints.")
        .json("evaluations.flows", |linted| linted.cost.flows.into())
        .says(INTEGER, "Exact flows.")
        .json("per_unit", |linted| linted.per_unit().into())
        .says(ENDS_OR_NULL, "Evaluations, gradients and solves per unit of omega h at the nominal edge.")
        .json("efficiency", |linted| linted.efficiency().into())
        .says(ENDS_OR_NULL, "omega h at the nominal edge per evaluation, gradient and solve.")
        .json("verdict.kind", |linted| linted.at.as_ref().map(|found| found.kind).into())
        .says(VERDICT, "The verdict, decided; edge where balls of 128 bits do not tell it, damped where friction draws every start to 0, marginal where friction leaves an eigenvalue on the unit circle.")
        .json("verdict.stable", |linted| {
            linted.at.as_ref().filter(|place| place.kind != "edge").map(At::is_stable).into()
        })
        .says(Shape::OrNull(&FLAG), "Whether powers are bounded, with friction whether they fall to 0; null on an edge that balls do not tell.")
        .json("verdict.side", |linted| linted.at.as_ref().map(|found| i64::from(found.side)).into())
        .says(SIGN, "1 where the trace is at least 2, -1 where it is at most -2.")
        .json("verdict.trace", |linted| linted.at.as_ref().map(|found| found.trace.to_f64_enclosure()).into())
        .says(WIDE_ENCLOSURE, "The trace.")
        .json("verdict.growth_rate", move |linted| at(linted, |found| &found.ln_multiplier))
        .says(ENDS_OR_NULL, "The logarithm of the largest eigenvalue's size per unit time, where it is hyperbolic or damped.")
        .json("verdict.frequency", move |linted| at(linted, |found| &found.angle))
        .says(ENDS_OR_NULL, "The effective frequency, where it is elliptic.")
        .json("verdict.impedance", move |linted| at(linted, |found| &found.impedance))
        .says(ENDS_OR_NULL, "The effective impedance, where it is elliptic and A = D.")
        .json("verdict.bias", move |linted| bias(linted, question).map(|bias| bias.to_f64_enclosure()).into())
        .says(ENDS_OR_NULL, "(lambda1 + lambda2) <x^2>/<v^2> at the ends of the word, where it is elliptic and A = D: 1 of the exact motion.")
}

/// ω²/(the impedance)² at the step that was asked about.
fn bias(linted: &Linted, question: &Word) -> Option<Ball> {
    let impedance = linted.at.as_ref()?.impedance.as_ref()?;
    let sum = question.lambda1.clone()? + question.lambda2.clone().unwrap_or_else(Laurent::zero);
    let h = question.h.as_ref()?.enclosure(BITS);
    sum.enclosure(BITS).mul(&h.square(BITS), BITS).div(&impedance.square(BITS), BITS)
}

/// The schema of a word's document.
pub(super) fn schema() -> Schema {
    let body = record(&Word::default())
        .keys()
        .key("sums", GROUP, "The coefficients of the drifts and of the kicks of each force, added up exactly; null where the word does not name the force.")
        .key("differs", GROUP_OR_NULL, "The first place where it does not; null for a palindrome.")
        .key("error", GROUP, "The errors of the four entries of a step to leading order: the coefficients of (sqrt(lambda1) h)^(order + 1) in the time unit 1/sqrt(lambda1), exactly, rho = lambda2/lambda1.")
        .key("frequency", GROUP_OR_NULL, "The effective frequency is omega (1 + c (omega h)^k + ...); null for two forces and where it is exact.")
        .key("impedance", GROUP_OR_NULL, "The effective impedance sqrt(-C/B) is omega (1 + c (omega h)^k + ...); null for two forces, unless A = D, and where it is exact.")
        .key("edge", GROUP_OR_NULL, "The end of the stable interval that begins at 0; null where there is no such interval or no end, or the stiffnesses of two forces are not given.")
        .key("evaluations", GROUP, "The cost of a step; kicks without a drift between them share an evaluation, those at both ends of a step too.")
        .key("verdict", GROUP_OR_NULL, "The verdict at the step h; null where none is given.")
        .key("intervals", Shape::List(&Shape::Object(|| spans("", "").keys())), INTERVALS);
    Schema::new(
        "An integrator as its author writes it: consistency, symmetry, order, stable steps, cost",
        body,
    )
}

const INTERVALS: &str = "Every largest interval of omega h = sqrt(lambda1) h with one answer, or those that meet the range; empty where the stiffnesses of two forces are not given. Of words with exact flows, filters or friction those within the range (by default two periods of the fast force), each end enclosed; two that touch with one answer leave it open between the ends that they share.";
const TEXT_OR_NULL: Shape = Shape::OrNull(&TEXT);
const ENDS_OR_NULL: Shape = Shape::OrNull(&WIDE_ENCLOSURE);
const SIDE_OR_NULL: Shape = Shape::Plain(r#"{"enum": [-1, 1, null]}"#);
const VERDICT: Shape =
    Shape::OneOf(&["elliptic", "hyperbolic", "parabolic", "coexistence", "damped", "marginal", "edge"]);

/// The polynomial of an edge, its coefficients exact.
fn polynomial(edge: &Edge) -> String {
    if let Some(f) = edge.polynomial.rational() {
        return f.primitive().text(&["s"]);
    }
    let term = |(k, c): (usize, &Radical)| format!("({})*s^{k}", c.text(ToString::to_string));
    let terms = edge.polynomial.coefficients().iter().enumerate().filter(|(_, c)| !c.is_zero()).map(term);
    terms.collect::<Vec<_>>().join(" + ")
}

/// The row of an interval; its lower end has this title, and this one in LaTeX.
fn spans(title: &str, formula: &str) -> Record<'static, Span> {
    type Of<'a> = &'a Span;
    let exact = |square: &Option<Rational>| square.as_ref().map_or(Cell::Missing, Cell::exact);
    Record::new()
        .field(Column::new("stable").left(), |span: Of| span.stable.into())
        .says(FLAG, "Whether powers are bounded in it.")
        .field(Column::new("lower").titled(title, formula).enclosure(), |span| span.enclosed()[0].into())
        .says(ENDS_OR_NULL, "Its lower end; 0 for the first one.")
        .field(Column::new("upper").titled("to", "to").enclosure(), |span| span.enclosed()[1].into())
        .says(
            ENDS_OR_NULL,
            "Its upper end; null where there is none, or none in the range that was looked at.",
        )
        .field(Column::new("lower_s").in_words("lower (omega h)^2 exactly").aside(), move |span| {
            exact(&span.squares[0])
        })
        .says(TEXT_OR_NULL, "The square of the lower end where it is rational.")
        .field(Column::new("upper_s").in_words("upper (omega h)^2 exactly").aside(), move |span| {
            exact(&span.squares[1])
        })
        .says(TEXT_OR_NULL, "The square of the upper end where it is rational.")
        .field(Column::new("lower_included").in_words("with lower end").aside(), |span| {
            span.includes[0].into()
        })
        .says(
            Shape::OrNull(&FLAG),
            "Whether the answer holds at the lower end; null where balls do not tell.",
        )
        .field(Column::new("upper_included").in_words("with upper end").aside(), |span| {
            span.includes[1].into()
        })
        .says(
            Shape::OrNull(&FLAG),
            "Whether the answer holds at the upper end; null where balls do not tell.",
        )
        .field(Column::new("h_lower").titled("h from", "$h$ from").enclosure(), |span| span.h[0].into())
        .says(ENDS_OR_NULL, "The lower step; null where no stiffness is given.")
        .field(Column::new("h_upper").titled("h to", "$h$ to").enclosure(), |span| span.h[1].into())
        .says(ENDS_OR_NULL, "The upper step; null where no stiffness is given, or there is none.")
}
