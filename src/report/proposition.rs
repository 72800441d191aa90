//! The exhaustive check of the Proposition as a document.

use serde_json::json;

use super::document::Document;
use super::table::{Cell, Column, Table};
use crate::resonance::proposition::{Check, Witness};

/// The document `kickdrift/proposition/1`: counts, failures, and a witness for every resonant point.
pub fn document(max: u64, check: &Check, witnesses: &[Witness]) -> Document {
    let Check { forward, backward, failures } = check;
    let verdict = if failures.is_empty() { "holds" } else { "FAILS" };
    let lines = [
        format!("the Proposition {verdict} for all coprime p, q <= {max}, exactly"),
        format!("  resonant points (p, q, m), each on a curve (a, b) with b != 0   {forward:>9}"),
        format!("  curves (a, b) at a ratio p/q, each resonant with m = a p + b q  {backward:>9}"),
        format!("  failures                                                        {:>9}", failures.len()),
    ];
    let failed: Vec<_> = failures
        .iter()
        .map(|w| json!({"p": w.ratio.p(), "q": w.ratio.q(), "m": w.m, "a": w.a, "b": w.b}))
        .collect();
    Document::new("proposition")
        .input("max", max)
        .entry("holds", failures.is_empty())
        .entry("resonant_points", *forward)
        .entry("curves", *backward)
        .entry("failures", failed)
        .rows(table(witnesses))
        .summary(&lines)
}

fn table(witnesses: &[Witness]) -> Table {
    let columns = ["p", "q", "m", "a", "b"].map(|key| Column::new(key).titled(key, &format!("${key}$")));
    let caption = "Resonant points h2/h1 = p/q, p theta = m pi, and a curve (a, b) through each";
    let mut table = Table::new("witnesses", caption, columns.to_vec());
    for w in witnesses {
        let cells = [w.ratio.p() as i64, w.ratio.q() as i64, w.m as i64, w.a, w.b];
        table.push(cells.map(Cell::Integer).to_vec());
    }
    table
}
