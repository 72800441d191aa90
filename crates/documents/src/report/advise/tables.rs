//! Tables that all advice has.

use serde_json::{Value, json};

use super::words::nearest;
use crate::report::record::Record;
use crate::report::table::{Cell, Column, Table};
use molecules::Caution;
use molecules::engine::Reading;
use number::Rational;

/// An engine's text as it was read, and its lines rewritten with the outer step that is advised.
pub fn engine(advised: Option<&Rational>, reading: &Reading) -> Value {
    let rewritten = advised.and_then(|outer| reading.changed_lines(outer).ok());
    json!({"name": reading.engine.name(), "dt": reading.engine.dt(), "forces": reading.forces, "used": reading.used, "remarks": reading.remarks, "rewritten": rewritten})
}

/// What is published about a scheme of so many steps, for the fastest mode on any clock but the outermost and
/// for that on the innermost one: each with its limit in fs.
pub fn published(steps: usize, modes: [&str; 2], limit: impl Fn(&Caution) -> Cell + Send + Sync) -> Value {
    let record = Record::new()
        .field(Column::new("mode"), |caution: &Caution| modes[usize::from(caution.inner)].into())
        .field(Column::new("place"), |caution| Cell::Text(caution.place.name()))
        .field(Column::new("step"), |caution| if caution.inner { "inner" } else { "outer" }.into())
        .field(Column::new("limit"), |caution| limit(caution))
        .field(Column::new("statement"), |caution| caution.statement.into())
        .field(Column::new("source"), |caution| caution.source.into());
    record.all(molecules::published(steps)).into()
}

/// A table for people: of its columns those that are to be shown, numbers rounded to five digits.
pub fn for_people(full: &Table, shown: impl Fn(&str) -> bool) -> Table {
    let kept = full.keeping(|column| shown(&column.key));
    let columns = kept.columns().iter().map(|column| Column { enclosed: false, ..column.clone() });
    let mut table = Table::new(kept.name(), kept.caption(), columns.collect());
    let five_digits = |cell: &Cell| match *cell {
        Cell::Float(x) => Cell::Exact(nearest((x, x), 5)),
        Cell::Enclosure { lo, hi } => Cell::Exact(nearest((lo, hi), 5)),
        _ => cell.clone(),
    };
    kept.rows().iter().for_each(|row| table.push(row.iter().map(five_digits).collect()));
    table
}

/// An enclosure, in fs unless it is said otherwise.
pub fn enclosed(key: &str, title: &str) -> Column {
    Column::new(key).in_words(title).enclosure()
}
