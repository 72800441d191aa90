//! Stretches of outer steps: rows, and the unstable ones in words.

use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::table::Column;
use crate::report::text::counted;
use crate::system::Holds;
use crate::system::levels::Stretch;

/// The document `kickdrift/system-intervals/1`; the caller adds the input.
pub fn document(stretches: &[Stretch], inner_steps: u64) -> Document {
    let record = Record::new()
        .field(Column::new("lo"), |of: &Stretch| of.lo.into())
        .field(Column::new("hi"), |of| of.hi.into())
        .field(Column::new("verdict").left(), |of| of.verdict.name().into());
    let number = |verdict: Holds| stretches.iter().filter(|own| own.verdict == verdict).count();
    let (unstable, undecided) = (number(Holds::Unstable), number(Holds::NotTold));
    let lines = [
        format!(
            "{} of the outer step, with {} in each",
            counted(unstable, "unstable interval", "unstable intervals"),
            counted(inner_steps as usize, "inner step", "inner steps")
        ),
        format!("  {} where nothing is proven", counted(undecided, "stretch", "stretches")),
    ];
    Document::new("system-intervals")
        .entry("inner_steps", inner_steps)
        .entry("unstable", unstable)
        .entry("untold", undecided)
        .rows(record.table("stretches", "Verdicts on outer steps", stretches))
        .summary(&lines)
}
