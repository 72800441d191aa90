//! All tongues of all ratios, counted and compared.

use super::asking::{Question, Work, question};
use super::ratios::{MOST_SUM, Ratios};
use crate::report::decimal::{self, rounded};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::table::{Cell, Column};
use clocks::tongue::{self, Spread, Thin};
use number::error::{Error, Result};
use number::{Ratio, Rational};

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

    fn answer(&self, _: &Work) -> Result<tongue::Survey> {
        if self.thinnest > MOST_THIN {
            return Err(Error::input("thinnest", self.thinnest, format!("choose at most {MOST_THIN}")));
        }
        Ratios::UpTo(self.max_sum).within(MOST_SUM)?;
        tongue::survey(self.max_sum, &self.rho, self.thinnest)
    }

    fn show(&self, survey: &tongue::Survey) -> Document {
        let closed = Record::new()
            .json("p", |(ratio, _): &(Ratio, u64)| ratio.p().into())
            .json("q", |(ratio, _)| ratio.q().into())
            .json("m", |(_, m)| (*m).into());
        let of = format!("for all p + q up to {} at rho = {}", survey.max_sum, survey.rho);
        let widths = format!("Width over first-order width, by the dominant family (a, b), {of}");
        let thinnest = format!("The thinnest tongues that begin below s = 4, {of}");
        Document::new(Self::NAME)
            .entry("ratios", survey.ratios)
            .entry("tongues", survey.tongues)
            .entry("open", survey.open)
            .entry("closed", closed.all(&survey.closed))
            .entry("edges.doubles", survey.edges.0)
            .entry("edges.more_bits", survey.edges.1)
            .entry("predicted.points", survey.predicted)
            .entry("predicted.outside", survey.predicted_outside)
            .entry("predicted.on_edge", survey.predicted_on_edge)
            .entry("predicted.inside", survey.predicted_inside)
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

/// The row of a family's widths, in so many significant digits where a number is given.
fn spreads(digits: Option<usize>) -> Record<'static, Spread> {
    let float = move |x: f64| Cell::Float(digits.map_or(x, |digits| rounded(x, digits)));
    let titled = |key: &str, title: &str| Column::new(key).titled(title, title);
    Record::new()
        .field(Column::new("abs_a").titled("|a|", "$|a|$"), |spread: &Spread| spread.abs_a.into())
        .field(titled("count", "tongues"), |spread| spread.count.into())
        .field(Column::new("least"), move |spread| float(spread.least))
        .field(Column::new("lower_quartile").titled("lower quartile", "$25\\,\\%$"), move |spread| {
            float(spread.lower_quartile)
        })
        .field(Column::new("median"), move |spread| float(spread.median))
        .field(Column::new("upper_quartile").titled("upper quartile", "$75\\,\\%$"), move |spread| {
            float(spread.upper_quartile)
        })
        .field(Column::new("largest"), move |spread| float(spread.largest))
}

/// The row of a thin tongue.
fn thin() -> Record<'static, Thin> {
    Record::new()
        .field(Column::math("p", "p"), |thin: &Thin| thin.ratio.p().into())
        .field(Column::math("q", "q"), |thin| thin.ratio.q().into())
        .field(Column::math("m", "m"), |thin| thin.m.into())
        .field(Column::math("a", "a"), |thin| thin.a.into())
        .field(Column::math("b", "b"), |thin| thin.b.into())
        .field(Column::math("s", "s"), |thin| thin.s.into())
        .field(Column::new("width").enclosure(), |thin| thin.width.into())
}
