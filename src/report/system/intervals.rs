//! Stretches of outer steps: rows, and the unstable ones in words.

use crate::report::document::Document;
use crate::report::table::{Cell, Column, Table};
use crate::report::text::counted;
use crate::system::Holds;
use crate::system::levels::Stretch;

/// The document `kickdrift/system-intervals/1`; the caller adds the input.
pub fn document(stretches: &[Stretch], inner_steps: u64) -> Document {
    let columns = vec![Column::new("lo"), Column::new("hi"), Column::new("verdict").left()];
    let mut table = Table::new("stretches", "Verdicts on outer steps", columns);
    for own in stretches {
        table.push(vec![Cell::Float(own.lo), Cell::Float(own.hi), Cell::Text(own.verdict.name().into())]);
    }
    let number = |verdict: Holds| stretches.iter().filter(|own| own.verdict == verdict).count();
    let (unstable, untold) = (number(Holds::Unstable), number(Holds::NotTold));
    let lines = [
        format!(
            "{} of the outer step, with {} in each",
            counted(unstable, "unstable interval", "unstable intervals"),
            counted(inner_steps as usize, "inner step", "inner steps")
        ),
        format!("  {} where nothing is proven", counted(untold, "stretch", "stretches")),
    ];
    Document::new("system-intervals")
        .entry("inner_steps", inner_steps)
        .entry("unstable", unstable)
        .entry("untold", untold)
        .rows(table)
        .summary(&lines)
}
