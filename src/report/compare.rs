//! Trace against predictions as a document: the counts, and the offenders as rows.

use serde_json::json;

use super::document::Document;
use super::table::{Cell, Column, Table};
use crate::number::{Ratio, Rational};
use crate::resonance::compare::{Comparison, Tally};

/// A pair at which a prediction is wrong.
#[derive(Clone, Debug)]
pub struct Offender {
    /// Two exact quantities that name the pair: h1 and h2 on a grid, s and rho for ratios.
    pub place: [String; 2],
    pub ratio: Ratio,
    pub comparison: Comparison,
}

/// The document `kickdrift/compare/1`; `places` are the names of an offender's two quantities. The caller
/// adds the rest of the input.
pub fn document(tally: &Tally, tolerance: &Rational, places: [&str; 2], offenders: &[Offender]) -> Document {
    Document::new("compare")
        .input("tolerance", tolerance)
        .entry("pairs", tally.pairs)
        .entry("unstable", tally.unstable)
        .entry("tan", json!({"agree": tally.tan_agree, "disagree": tally.tan_disagree}))
        .entry(
            "resonance",
            json!({
                "hits": tally.hits, "quiet": tally.quiet, "misses": tally.misses,
                "false_alarms": tally.false_alarms, "beyond_verlet": tally.beyond_verlet,
            }),
        )
        .rows(table(places, offenders))
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

fn table(places: [&str; 2], offenders: &[Offender]) -> Table {
    let [first, second] = places.map(|name| Column::new(name).titled(name, &typeset(name)));
    let columns = vec![
        first,
        second,
        Column::new("p").titled("p", "$p$"),
        Column::new("q").titled("q", "$q$"),
        Column::new("offence").left(),
        Column::new("kind").left(),
        Column::new("tan").titled("tan criterion", "tan criterion").left(),
        Column::new("m").titled("nearest m", "nearest $m$"),
        Column::new("distance").titled("q h2/T½ - m", "$q h_2/T_{1/2} - m$").enclosure(),
    ];
    let mut table = Table::new("offenders", "Pairs at which a prediction is wrong", columns);
    for offender in offenders {
        table.push(row(offender));
    }
    table
}

fn row(offender: &Offender) -> Vec<Cell> {
    let Comparison { trace, tan, nearest, outcome } = &offender.comparison;
    let offence = if offender.comparison.tan_agrees() { outcome.map_or("none", |o| o.name()) } else { "tan" };
    let [first, second] = offender.place.clone().map(Cell::Exact);
    vec![
        first,
        second,
        Cell::Integer(offender.ratio.p() as i64),
        Cell::Integer(offender.ratio.q() as i64),
        Cell::Text(offence.into()),
        Cell::Text(trace.verdict.kind().name().into()),
        Cell::Text(tan.kind().name().into()),
        nearest.as_ref().map_or(Cell::Missing, |n| Cell::Integer(n.m as i64)),
        nearest.as_ref().map_or(Cell::Missing, |n| {
            let (lo, hi) = n.distance.to_f64_enclosure();
            Cell::Enclosure { lo, hi }
        }),
    ]
}

fn typeset(name: &str) -> String {
    match name {
        "h1" => "$h_1$".into(),
        "h2" => "$h_2$".into(),
        "rho" => "$\\rho$".into(),
        other => format!("${other}$"),
    }
}
