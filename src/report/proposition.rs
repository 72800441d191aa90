//! The exhaustive check of the Proposition as a document.

use super::document::Document;
use super::record::Record;
use super::table::Column;
use crate::resonance::proposition::{Check, Witness};

const CAPTION: &str = "Resonant points h2/h1 = p/q, p theta = m pi, and a curve (a, b) through each";

/// The same in LaTeX.
const CAPTION_LATEX: &str = "Resonant points $h_2/h_1 = p/q$, $p\\theta = m\\pi$, and a curve $(a, b)$ with $m = ap + bq$ through each";

/// The document `kickdrift/proposition/1` without its input: counts, failures, and a witness for every resonant point.
pub fn document(max: u64, check: &Check, witnesses: &[Witness]) -> Document {
    let Check { forward, backward, failures } = check;
    let verdict = if failures.is_empty() { "holds" } else { "FAILS" };
    let lines = [
        format!("the Proposition {verdict} for all coprime p, q <= {max}, exactly"),
        format!("  resonant points (p, q, m), each on a curve (a, b) with b != 0   {forward:>9}"),
        format!("  curves (a, b) at a ratio p/q, each resonant with m = a p + b q  {backward:>9}"),
        format!("  failures                                                        {:>9}", failures.len()),
    ];
    Document::new("proposition")
        .entry("holds", failures.is_empty())
        .entry("resonant_points", *forward)
        .entry("curves", *backward)
        .entry("failures", record().all(failures))
        .rows(record().table("witnesses", CAPTION, witnesses).captioned(CAPTION_LATEX))
        .summary(&lines)
}

/// What is written of a resonant point.
fn record() -> Record<'static, Witness> {
    Record::new()
        .field(Column::math("p", "p"), |of: &Witness| of.ratio.p().into())
        .field(Column::math("q", "q"), |of| of.ratio.q().into())
        .field(Column::math("m", "m"), |of| of.m.into())
        .field(Column::math("a", "a"), |of| of.a.into())
        .field(Column::math("b", "b"), |of| of.b.into())
}
