//! The verdicts of a grid on their way out: counts for the summary, rows of the pairs that are not plainly
//! stable, arrays of all pairs. All take one band at a time.

mod arrays;
mod rows;
mod tally;

use serde_json::json;

pub use arrays::MapArrays;
pub use rows::{Found, Marked, Rows, marked, needed};
pub(crate) use tally::Fastest;
pub use tally::{Counts, MapTally};

use super::document::Document;
use super::table::Table;
use clocks::verdict::Tier;

/// The document `kickdrift/map/1`, with rows where the form is to show them. The caller adds the input.
pub fn document(tally: &MapTally, rows: Option<Table>) -> Document {
    let counts = &tally.counts;
    let [filter, refine, exact] = counts.decided_by;
    let tiers = Tier::ALL.map(Tier::name);
    let mut lines = vec![
        format!(
            "{} pairs, each decided: {} stable, {} unstable",
            counts.pairs, counts.stable, counts.unstable
        ),
        format!("  parabolic {}, coexistence {}", counts.parabolic, counts.coexistence),
        format!("  decided by {} {filter}, {} {refine}, {} {exact}", tiers[0], tiers[1], tiers[2]),
    ];
    lines.extend(tally.lines());
    let document = Document::new("map")
        .entry("pairs", counts.pairs)
        .entry("stable", counts.stable)
        .entry("unstable", counts.unstable)
        .entry("parabolic", counts.parabolic)
        .entry("coexistence", counts.coexistence)
        .entry("decided_by", json!({tiers[0]: filter, tiers[1]: refine, tiers[2]: exact}))
        // The kicks composed: the cost of the map, the same on every machine.
        .entry("work.kicks", tally.counters.kicks)
        .entry("work.kicks_again", tally.counters.kicks_again)
        .entry("work.escalated", tally.counters.escalated)
        .entries(tally.entries());
    match rows {
        Some(table) => document.long_rows(table),
        None => document,
    }
    .summary(&lines)
}
