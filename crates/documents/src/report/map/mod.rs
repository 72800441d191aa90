//! The verdicts of a grid on their way out: counts for the summary, rows of the pairs that are not plainly
//! stable, arrays of all pairs. All take one band at a time.

mod arrays;
mod rows;
mod tally;

pub use arrays::MapArrays;
pub use rows::{Found, Marked, Rows, marked, needed};
pub(crate) use tally::Fastest;
pub use tally::{Counts, MapTally};

use super::document::Document;
use super::record::Record;
use super::shape::{COUNT, GROUP, POSITIVE, Schema};
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
    let document = record().document(Document::new("map"), tally);
    match rows {
        Some(table) => document.long_rows(table),
        None => document,
    }
    .summary(&lines)
}

/// The schema of the document.
pub fn schema() -> Schema {
    let says = "Every pair is decided, so stable + unstable = pairs = filter + refine + exact. The pairs themselves are in the CSV form.";
    let body = record()
        .keys()
        .key("decided_by", GROUP, "The pairs that each tier of arithmetic decided.")
        .key("work", GROUP, "The cost of the map, the same on every machine.");
    Schema::new("The verdicts of a grid of step pairs, counted", body).about(says)
}

/// The record of the counts.
fn record() -> Record<'static, MapTally> {
    let mut record = Record::new()
        .json("pairs", |tally: &MapTally| tally.counts.pairs.into())
        .says(POSITIVE, "All pairs of the grid, or of its part.")
        .json("stable", |tally| tally.counts.stable.into())
        .says(COUNT, "Elliptic or coexistence.")
        .json("unstable", |tally| tally.counts.unstable.into())
        .says(COUNT, "Hyperbolic or parabolic.")
        .json("parabolic", |tally| tally.counts.parabolic.into())
        .says(COUNT, "")
        .json("coexistence", |tally| tally.counts.coexistence.into())
        .says(COUNT, "");
    for (k, tier) in Tier::ALL.into_iter().enumerate() {
        let path = format!("decided_by.{}", tier.name());
        record = record.json(&path, move |tally| tally.counts.decided_by[k].into()).says(COUNT, "");
    }
    record
        .json("work.kicks", |tally| tally.counters.kicks.into())
        .says(COUNT, "Kicks composed by the filter.")
        .json("work.kicks_again", |tally| tally.counters.kicks_again.into())
        .says(COUNT, "Kicks composed again for labels and growth.")
        .json("work.escalated", |tally| tally.counters.escalated.into())
        .says(COUNT, "Pairs that the filter sent up the ladder.")
        .optional("families", MapTally::families)
        .says(tally::FAMILIES, "Growing pairs by the a of their dominant family; only where labels were asked for and some pair grows.")
        .optional("fastest", MapTally::fastest)
        .says(tally::FASTEST, "The pair that grows fastest: no other one is proven to grow faster. Only where growth was asked for and some pair grows.")
}
