//! Tables for a terminal: aligned columns under a rule, numbers on the right.

use super::decimal;
use super::table::{Align, Cell, Column, Table};

/// The space between two columns.
const GAP: &str = "  ";

/// A number with its noun.
pub fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// A word with what a shell would take for its own in quotes.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./,:=+^%@".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// The whole table as lines of text, the caption first.
///
/// Enclosures show the digits that are certain, see [`decimal::enclosure`]. Widths count characters, so
/// columns line up for everything but double-width scripts.
pub fn document(table: &Table) -> String {
    let heads: Vec<String> = table.columns().iter().map(head).collect();
    let rows: Vec<Vec<String>> = table.rows().iter().map(|row| row.iter().map(shown).collect()).collect();
    let widths: Vec<usize> = (0..heads.len())
        .map(|i| rows.iter().map(|row| &row[i]).chain([&heads[i]]).map(|text| width(text)).max().unwrap_or(0))
        .collect();
    let mut out = String::new();
    if !table.caption().is_empty() {
        out.push_str(table.caption());
        out.push_str("\n\n");
    }
    let rule: Vec<String> = widths.iter().map(|&width| "-".repeat(width)).collect();
    for fields in [&heads, &rule].into_iter().chain(&rows) {
        put_line(&mut out, table.columns(), &widths, fields);
    }
    out
}

/// One cell as a person reads it.
pub fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Exact(text) | Cell::Decimal(text) | Cell::Text(text) => text.clone(),
        Cell::Float(value) => format!("{value:?}"),
        Cell::Enclosure { lo, hi } => decimal::enclosure(*lo, *hi).to_string(),
        Cell::Integer(value) => value.to_string(),
        Cell::Flag(true) => "yes".into(),
        Cell::Flag(false) => "no".into(),
        Cell::Missing => "-".into(),
    }
}

fn head(column: &Column) -> String {
    match &column.unit {
        Some(unit) => format!("{} ({unit})", column.title),
        None => column.title.clone(),
    }
}

fn width(text: &str) -> usize {
    text.chars().count()
}

fn put_line(out: &mut String, columns: &[Column], widths: &[usize], fields: &[String]) {
    let mut line = String::new();
    for ((column, &wide), field) in columns.iter().zip(widths).zip(fields) {
        let padding = " ".repeat(wide - width(field));
        match column.align {
            Align::Left => line.extend([field, &padding, GAP]),
            Align::Right => line.extend([&padding, field, GAP]),
        }
    }
    out.push_str(line.trim_end());
    out.push('\n');
}
