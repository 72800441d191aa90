//! All tongues of all ratios, counted and compared.

use super::asking::{Question, Work, question};
use super::ratios::{MOST_SUM, Ratios};
use crate::report::decimal::{self, rounded};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, GROUP, INTEGER, POSITIVE, POSITIVE_ENCLOSURE, ROUNDED, Schema, Shape};
use crate::report::table::{Cell, Column};
use clocks::tongue::{self, Spread, Thin};
use number::{Error, Ratio, Rational, Result};

question! {
    /// All tongues of all coprime p + q up to a sum that begin below s = 4: counts, widths, the thinnest ones
    /// listed.
    struct Survey {
        /// The largest p + q.
        max_sum: u64,
        /// λ2/λ1.
        rho: Rational,
        /// Tongues that are listed.
        thinnest: usize = "10",
    }
}

/// Thin tongues listed unless a number is given, and at most.
pub const THINNEST: usize = 10;
const MOST_THIN: usize = 100_000;

/// Digits that people need of a quotient of widths.
const DIGITS: usize = 4;

/// The captions in LaTeX.
const WIDTHS_LATEX: &str = "Widths of all tongues over the first-order law $2 s \\rho |S|$, by the $a$ of the dominant family $(a, b)$";
const THINNEST_LATEX: &str = "The thinnest tongues that begin below $s = h_1^2 \\Lambda_1 = 4$";

impl Question for Survey {
    const NAME: &'static str = "survey";
    type Answer = tongue::Survey;

    fn schema() -> Option<Schema> {
        let body = counts()
            .keys()
            .key("edges", GROUP, "Edges certified in doubles, and with more bits.")
            .key(
                "predicted",
                GROUP,
                "The points p theta = m pi, m < p, and where they lie about the tongue of their own label.",
            )
            .key(
                "width_ratios",
                Shape::List(&Shape::Object(|| spreads(None).keys())),
                "Width over first-order width by |a| of the dominant family, m < p.",
            )
            .key(
                "thinnest",
                Shape::List(&Shape::Object(|| thin().keys())),
                "The thinnest open tongues, thinnest first.",
            );
        let title = "A survey of all tongues that begin below s = 4, for all coprime p + q up to a number";
        // rho is not below 0.
        let rules =
            r#"{"allOf": [{"properties": {"input": {"properties": {"rho": {"pattern": "^[0-9]"}}}}}]}"#;
        Some(Schema::new(title, body).rules(rules))
    }

    fn answer(&self, _: &Work) -> Result<tongue::Survey> {
        if self.thinnest > MOST_THIN {
            return Err(Error::input("thinnest", self.thinnest, format!("choose at most {MOST_THIN}")));
        }
        Ratios::UpTo(self.max_sum).within(MOST_SUM)?;
        tongue::survey(self.max_sum, &self.rho, self.thinnest)
    }

    fn show(&self, survey: &tongue::Survey) -> Document {
        let of = format!("for all p + q up to {} at rho = {}", survey.max_sum, survey.rho);
        let widths = format!("Width over first-order width, by the dominant family (a, b), {of}");
        let thinnest = format!("The thinnest tongues that begin below s = 4, {of}");
        counts()
            .document(Document::new(Self::NAME), survey)
            .entry("width_ratios", spreads(None).all(&survey.width_ratios))
            .entry("thinnest", thin().all(&survey.thinnest))
            .long_rows(spreads(None).table("width_ratios", &widths, &survey.width_ratios))
            .for_people(
                spreads(Some(DIGITS))
                    .table("width_ratios", &widths, &survey.width_ratios)
                    .captioned(WIDTHS_LATEX),
            )
            .and_rows(thin().table("thinnest", &thinnest, &survey.thinnest).captioned(THINNEST_LATEX))
            .summary(&lines(survey))
    }
}

fn lines(survey: &tongue::Survey) -> Vec<String> {
    let share = |n: u64| rounded(100.0 * n as f64 / survey.predicted.max(1) as f64, 3);
    let closed: Vec<String> = survey.closed.iter().map(|(ratio, m)| format!("{ratio} m = {m}")).collect();
    let mut lines = vec![
        format!(
            "all tongues that begin below s = 4, for all h2/h1 = p/q, p + q <= {}, rho = {}",
            survey.max_sum, survey.rho
        ),
        format!("  ratios       {}", survey.ratios),
        format!(
            "  tongues      {}: {} proven open, {} proven closed",
            survey.tongues,
            survey.open,
            survey.closed.len()
        ),
    ];
    if !closed.is_empty() {
        lines.push(format!("  closed       {}", closed.join(", ")));
    }
    lines.push(format!(
        "  edges        {} certified in doubles, {} with more bits",
        survey.edges.0, survey.edges.1
    ));
    lines.push(format!(
        "  predicted    {} points p theta = m pi: {} ({} %) outside their own tongue, {} ({} %) on its edge, {} inside",
        survey.predicted,
        survey.predicted_outside,
        share(survey.predicted_outside),
        survey.predicted_on_edge,
        share(survey.predicted_on_edge),
        survey.predicted_inside
    ));
    if let Some(thin) = survey.thinnest.first() {
        let width = decimal::enclosure(thin.width.0, thin.width.1);
        lines.push(format!("  thinnest     {width} wide: {}, m = {}", thin.ratio, thin.m));
    }
    lines
}

/// The counts of a survey.
fn counts() -> Record<'static, tongue::Survey> {
    Record::new()
        .json("ratios", |survey: &tongue::Survey| survey.ratios.into())
        .says(COUNT, "The ratios with p + q up to the number.")
        .json("tongues", |survey| survey.tongues.into())
        .says(COUNT, "Each certified open or closed.")
        .json("open", |survey| survey.open.into())
        .says(COUNT, "Proven open.")
        .value("closed", |survey| closed().all(&survey.closed).into())
        .says(Shape::List(&Shape::Object(|| closed().keys())), "Proven closed.")
        .json("edges.doubles", |survey| survey.edges.0.into())
        .says(COUNT, "")
        .json("edges.more_bits", |survey| survey.edges.1.into())
        .says(COUNT, "")
        .json("predicted.points", |survey| survey.predicted.into())
        .says(COUNT, "All of them.")
        .json("predicted.outside", |survey| survey.predicted_outside.into())
        .says(COUNT, "Those outside.")
        .json("predicted.on_edge", |survey| survey.predicted_on_edge.into())
        .says(COUNT, "Those on an edge.")
        .json("predicted.inside", |survey| survey.predicted_inside.into())
        .says(COUNT, "Those inside.")
}

/// The entries of a closed tongue.
fn closed() -> Record<'static, (Ratio, u64)> {
    Record::new()
        .json("p", |(ratio, _): &(Ratio, u64)| ratio.p().into())
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .json("q", |(ratio, _)| ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .json("m", |(_, m)| (*m).into())
        .says(POSITIVE, "The tongue's label.")
}

/// The row of a family's widths, in so many significant digits where a number is given.
fn spreads(digits: Option<usize>) -> Record<'static, Spread> {
    let float = move |x: f64| Cell::Float(digits.map_or(x, |digits| rounded(x, digits)));
    let titled = |key: &str, title: &str| Column::new(key).titled(title, title);
    Record::new()
        .field(Column::new("abs_a").titled("|a|", "$|a|$"), |spread: &Spread| spread.abs_a.into())
        .says(COUNT, "|a| of the dominant family.")
        .field(titled("count", "tongues"), |spread| spread.count.into())
        .says(POSITIVE, "The tongues of such families.")
        .field(Column::new("least"), move |spread| float(spread.least))
        .says(ROUNDED, "")
        .field(Column::new("lower_quartile").titled("lower quartile", "$25\\,\\%$"), move |spread| {
            float(spread.lower_quartile)
        })
        .says(ROUNDED, "")
        .field(Column::new("median"), move |spread| float(spread.median))
        .says(ROUNDED, "")
        .field(Column::new("upper_quartile").titled("upper quartile", "$75\\,\\%$"), move |spread| {
            float(spread.upper_quartile)
        })
        .says(ROUNDED, "")
        .field(Column::new("largest"), move |spread| float(spread.largest))
        .says(ROUNDED, "")
}

/// The row of a thin tongue.
fn thin() -> Record<'static, Thin> {
    Record::new()
        .field(Column::math("p", "p"), |thin: &Thin| thin.ratio.p().into())
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .field(Column::math("q", "q"), |thin| thin.ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .field(Column::math("m", "m"), |thin| thin.m.into())
        .says(POSITIVE, "The tongue's label.")
        .field(Column::math("a", "a"), |thin| thin.a.into())
        .says(INTEGER, "a of the dominant family.")
        .field(Column::math("b", "b"), |thin| thin.b.into())
        .says(INTEGER, "b of the dominant family.")
        .field(Column::math("s", "s"), |thin| thin.s.into())
        .says(Shape::With(&ROUNDED, r#"{"exclusiveMinimum": 0}"#), "A double not above the lower edge.")
        .field(Column::new("width").enclosure(), |thin| thin.width.into())
        .says(POSITIVE_ENCLOSURE, "From one edge to the other, in s.")
}
