//! Trace against predictions as a document: the counts, and the offenders as rows.

use super::document::Document;
use super::record::Record;
use super::table::{Cell, Column};
use crate::number::Rational;
use crate::resonance::compare::{Comparison, Comparisons, Offender, Tally};

const CAPTION: &str = "Pairs at which the prediction $q h_2 \\approx m T_{1/2}$ is wrong";

/// The document `kickdrift/compare/1`; `places` are the names of an offender's two quantities. The caller
/// adds the input.
pub fn document(all: &Comparisons, tolerance: &Rational, places: [&str; 2]) -> Document {
    let Comparisons { tally, offenders } = all;
    Document::new("compare")
        .entry("pairs", tally.pairs)
        .entry("unstable", tally.unstable)
        .entry("tan.agree", tally.tan_agree)
        .entry("tan.disagree", tally.tan_disagree)
        .entry("resonance.hits", tally.hits)
        .entry("resonance.quiet", tally.quiet)
        .entry("resonance.misses", tally.misses)
        .entry("resonance.false_alarms", tally.false_alarms)
        .entry("resonance.beyond_verlet", tally.beyond_verlet)
        .rows(
            record(places)
                .table("offenders", "Pairs at which a prediction is wrong", offenders)
                .captioned(CAPTION),
        )
        .summary(&lines(tally, tolerance))
}

fn lines(tally: &Tally, tolerance: &Rational) -> Vec<String> {
    let Tally { pairs, unstable, tan_agree, hits, quiet, misses, false_alarms, beyond_verlet, .. } = tally;
    let verdict = if tally.tan_disagree == 0 { "everywhere" } else { "NOT everywhere" };
    vec![
        format!("{pairs} pairs, {unstable} unstable by the trace condition"),
        format!("tan criterion: agrees {verdict} ({tan_agree} of {pairs})"),
        format!("q h2 within {tolerance} T½ of a multiple of T½:"),
        format!("  unstable and near (hits)           {hits:>12}"),
        format!("  stable and away (quiet)            {quiet:>12}"),
        format!("  unstable but away (misses)         {misses:>12}"),
        format!("  stable but near (false alarms)     {false_alarms:>12}"),
        format!("  s >= 4, no effective period        {beyond_verlet:>12}"),
    ]
}

/// What is written of an offender.
fn record(places: [&str; 2]) -> Record<'static, Offender> {
    let [first, second] = places.map(|name| Column::math(name, formula(name)));
    let nearest = |of: &Offender| of.comparison.nearest.clone();
    Record::new()
        .field(first, |of: &Offender| Cell::exact(&of.place[0]))
        .field(second, |of| Cell::exact(&of.place[1]))
        .field(Column::math("p", "p"), |of| of.ratio.p().into())
        .field(Column::math("q", "q"), |of| of.ratio.q().into())
        .field(Column::new("offence").left(), |of| offence(&of.comparison).into())
        .field(Column::new("kind").left().aside(), |of| of.comparison.trace.verdict.kind().name().into())
        .field(Column::new("tan").in_words("tan criterion").left().aside(), |of| {
            of.comparison.tan.kind().name().into()
        })
        .field(Column::new("m").titled("nearest m", "nearest $m$"), move |of| nearest(of).map(|n| n.m).into())
        .field(Column::new("distance").titled("q h2/T½ - m", "$q h_2/T_{1/2} - m$").enclosure(), move |of| {
            nearest(of).map(|n| n.distance.to_f64_enclosure()).into()
        })
}

fn offence(comparison: &Comparison) -> &'static str {
    if comparison.tan_agrees() { comparison.outcome.map_or("none", |outcome| outcome.name()) } else { "tan" }
}

fn formula(name: &str) -> &str {
    match name {
        "h1" => "h_1",
        "h2" => "h_2",
        "rho" => "\\rho",
        other => other,
    }
}
