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

/// The whole table as lines of text, the caption first. Where it is wider than `most` characters, headings
/// and words fold, and the last columns are left out and named.
///
/// Enclosures show the digits that are certain, see [`decimal::enclosure`]. Widths count characters, so
/// columns line up for everything but double-width scripts.
pub fn document(table: &Table, most: Option<usize>) -> String {
    let heads: Vec<String> = table.columns().iter().map(head).collect();
    let rows: Vec<Vec<String>> = table.rows().iter().map(|row| row.iter().map(shown).collect()).collect();
    let widths = whole_widths(&heads, &rows);
    let mut out = String::new();
    if !table.caption().is_empty() {
        out.push_str(table.caption());
        out.push_str("\n\n");
    }
    if let Some(most) = most.filter(|&most| total(&widths) > most) {
        put_folded(&mut out, table.columns(), &heads, &rows, most);
        return out;
    }
    for fields in [&heads, &rule(&widths)].into_iter().chain(&rows) {
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

fn whole_widths(heads: &[String], rows: &[Vec<String>]) -> Vec<usize> {
    let column = |n: usize| rows.iter().map(move |row| &row[n]).chain([&heads[n]]);
    (0..heads.len()).map(|n| column(n).map(|text| width(text)).max().unwrap_or(0)).collect()
}

fn rule(widths: &[usize]) -> Vec<String> {
    widths.iter().map(|&width| "-".repeat(width)).collect()
}

fn total(widths: &[usize]) -> usize {
    widths.iter().sum::<usize>() + GAP.len() * widths.len().saturating_sub(1)
}

/// Words of a column are folded down to so many characters.
const FOLDED: usize = 16;

fn longest_word<'a>(cells: impl Iterator<Item = &'a String>) -> usize {
    cells.flat_map(|cell| cell.split(' ')).map(width).max().unwrap_or(0)
}

/// The widths of all columns with their headings and words folded as far as `most` asks.
fn folded_widths(columns: &[Column], heads: &[String], rows: &[Vec<String>], most: usize) -> Vec<usize> {
    let cells = |n: usize| rows.iter().map(move |row| &row[n]);
    let head = |n: usize| longest_word(std::iter::once(&heads[n]));
    let body = |n: usize| cells(n).map(|cell| width(cell)).max().unwrap_or(0);
    let mut widths: Vec<usize> = (0..heads.len()).map(|n| body(n).max(head(n))).collect();
    let least = |n: usize| match columns[n].align {
        Align::Left => longest_word(cells(n)).max(head(n)).max(FOLDED),
        Align::Right => widths[n],
    };
    let least: Vec<usize> = (0..heads.len()).map(least).collect();
    while total(&widths) > most {
        let widest = (0..widths.len()).filter(|&n| widths[n] > least[n]).max_by_key(|&n| widths[n]);
        let Some(widest) = widest else { break };
        let excess = total(&widths) - most;
        widths[widest] = widths[widest].saturating_sub(excess).max(least[widest]);
    }
    widths
}

/// The table in lines of at most so many characters.
fn put_folded(out: &mut String, columns: &[Column], heads: &[String], rows: &[Vec<String>], most: usize) {
    let mut widths = folded_widths(columns, heads, rows, most);
    while widths.len() > 1 && total(&widths) > most {
        widths.pop();
    }
    put_row(out, columns, &widths, heads, true);
    put_line(out, columns, &widths, &rule(&widths));
    rows.iter().for_each(|row| put_row(out, columns, &widths, row, false));
    let left_out = &heads[widths.len()..];
    if !left_out.is_empty() {
        let names = left_out.join(", ");
        out.push_str(&format!("\nleft out here: {names}; a wider terminal or --format json has them\n"));
    }
}

/// A row in as many lines as its longest cell takes; headings stand on the rule.
fn put_row(out: &mut String, columns: &[Column], widths: &[usize], cells: &[String], is_head: bool) {
    let cells: Vec<Vec<String>> =
        cells.iter().zip(widths).map(|(cell, &wide)| in_words(cell, wide)).collect();
    let tall = cells.iter().map(Vec::len).max().unwrap_or(1);
    for n in 0..tall {
        let field = |cell: &Vec<String>| {
            let above = if is_head { tall - cell.len() } else { 0 };
            n.checked_sub(above).and_then(|at| cell.get(at)).cloned().unwrap_or_default()
        };
        put_line(out, columns, widths, &cells.iter().map(field).collect::<Vec<_>>());
    }
}

/// A cell at its words.
fn in_words(cell: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in cell.split(' ') {
        let last = lines.last_mut().expect("there is one");
        if last.is_empty() {
            last.push_str(word);
        } else if width(last) + 1 + width(word) <= most {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(word.into());
        }
    }
    lines
}
