//! Closed tongues as a document: each a box s × ρ that holds exactly one of them.

use serde_json::{Value, json};

use super::digits::outward;
use super::document::{Document, enclosure};
use super::table::{Cell, Column, Table};
use crate::number::Rational;
use crate::tongue::{Closing, Enclosure, Found};

/// Significant digits unless others are asked for: the boxes are known to 2^-100.
pub const DIGITS: u32 = 25;

/// The document `kickdrift/closings/1`. The caller adds the input; `what` says in words what was searched.
///
/// With `all_columns` the table is made for programs, else for people and paper.
pub fn document(found: &[Found], digits: u32, what: &str, all_columns: bool) -> Document {
    let rows: Vec<Value> =
        found.iter().flat_map(|of| &of.closings).map(|closing| row(closing, digits)).collect();
    let complete: Vec<Value> = found
        .iter()
        .map(|of| json!({"p": of.ratio.p(), "q": of.ratio.q(), "complete": of.complete}))
        .collect();
    Document::new("closings")
        .entry("closings", rows)
        .entry("ratios", complete)
        .long_rows(if all_columns { table(found, digits) } else { short_table(found) })
        .summary(&lines(found, what))
}

fn row(closing: &Closing, digits: u32) -> Value {
    let exact = closing.exact.as_ref();
    json!({
        "p": closing.ratio.p(),
        "q": closing.ratio.q(),
        "m": closing.m,
        "s": quantity(&closing.s, exact.map(|(s, _)| s), digits),
        "rho": quantity(&closing.rho, exact.map(|(_, rho)| rho), digits),
        "below_verlet": closing.below_verlet,
    })
}

/// `lo, hi, exact, decimal`.
fn quantity(x: &Enclosure, exact: Option<&Rational>, digits: u32) -> Value {
    let mut value = enclosure(x.to_f64());
    let [lo, hi] = ends(x, exact, digits);
    let map = value.as_object_mut().expect("an enclosure is an object");
    map.insert("exact".into(), exact.map(ToString::to_string).into());
    map.insert("decimal".into(), json!({"lo": lo, "hi": hi}));
    value
}

fn ends(x: &Enclosure, exact: Option<&Rational>, digits: u32) -> [String; 2] {
    exact.map_or_else(|| outward(&x.lo, &x.hi, digits), |x| outward(x, x, digits))
}

fn lines(found: &[Found], what: &str) -> Vec<String> {
    let closings = || found.iter().flat_map(|of| &of.closings);
    let count = closings().count();
    let exact = closings().filter(|closing| closing.exact.is_some()).count();
    let below = closings().filter(|closing| closing.below_verlet).count();
    let complete = found.iter().filter(|of| of.complete).count();
    let plural = if count == 1 { "" } else { "s" };
    vec![
        format!("{count} closed tongue{plural} of {what}"),
        format!("  rational     {exact}: s and rho known exactly"),
        format!("  below s = 4  {below}: the fast clock alone is stable there"),
        format!(
            "  complete     {complete} of {} ratios: elimination proves that there are no others",
            found.len()
        ),
    ]
}

const CAPTION: &str = "Closed tongues: Q = I or -I";

fn labels() -> Vec<Column> {
    ["p", "q", "m"].map(|key| Column::new(key).titled(key, &format!("${key}$"))).into()
}

/// s and ρ exactly where they are rational, else as enclosures.
fn short_table(found: &[Found]) -> Table {
    let mut columns = labels();
    columns.extend(
        [("s", "$s$"), ("rho", "$\\rho$")]
            .map(|(key, latex)| Column::new(key).titled(key, latex).enclosure()),
    );
    columns.push(Column::new("below_verlet").titled("s < 4", "$s < 4$"));
    let mut table = Table::new("closings", CAPTION, columns);
    for closing in found.iter().flat_map(|of| &of.closings) {
        let exact = closing.exact.as_ref();
        let shown = |x: &Enclosure, exact: Option<&Rational>| {
            let (lo, hi) = x.to_f64();
            exact.map_or(Cell::Enclosure { lo, hi }, |x| Cell::Exact(x.to_string()))
        };
        let mut cells: Vec<Cell> =
            [closing.ratio.p(), closing.ratio.q(), closing.m].map(|n| Cell::Integer(n as i64)).into();
        cells.push(shown(&closing.s, exact.map(|e| &e.0)));
        cells.push(shown(&closing.rho, exact.map(|e| &e.1)));
        cells.push(Cell::Flag(closing.below_verlet));
        table.push(cells);
    }
    table
}

fn table(found: &[Found], digits: u32) -> Table {
    let mut columns = labels();
    for (key, latex) in [("s", "$s$"), ("rho", "$\\rho$")] {
        columns.push(Column::new(key).titled(key, latex).enclosure());
        columns.push(Column::new(&format!("{key}_exact")).titled("exact", "exact"));
        columns.extend(["lo", "hi"].map(|end| Column::new(&format!("{key}_decimal_{end}")).titled(end, end)));
    }
    columns.push(Column::new("below_verlet").titled("s < 4", "$s < 4$"));
    let mut table = Table::new("closings", CAPTION, columns);
    for closing in found.iter().flat_map(|of| &of.closings) {
        let mut cells: Vec<Cell> =
            [closing.ratio.p(), closing.ratio.q(), closing.m].map(|n| Cell::Integer(n as i64)).into();
        let exact = closing.exact.as_ref();
        for (x, exact) in [(&closing.s, exact.map(|e| &e.0)), (&closing.rho, exact.map(|e| &e.1))] {
            let (lo, hi) = x.to_f64();
            cells.push(Cell::Enclosure { lo, hi });
            cells.push(exact.map_or(Cell::Missing, |x| Cell::Exact(x.to_string())));
            cells.extend(ends(x, exact, digits).map(Cell::Exact));
        }
        cells.push(Cell::Flag(closing.below_verlet));
        table.push(cells);
    }
    table
}
