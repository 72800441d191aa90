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

/// The whole table as lines of text, the caption first. Where it is wider than `most` characters, enclosures
/// have fewer digits, headings and words fold, and columns are left out and named: those that are empty
/// first, then the last ones.
///
/// Enclosures show the digits that are certain, see [`decimal::enclosure`]. Widths count characters, so
/// columns line up for everything but double-width scripts.
pub fn document(table: &Table, most: Option<usize>) -> String {
    let heads: Vec<String> = table.columns().iter().map(head).collect();
    let mut rows = cells(table);
    let mut widths = whole_widths(&heads, &rows);
    let mut out = String::new();
    if !table.caption().is_empty() {
        out.push_str(table.caption());
        out.push_str("\n\n");
    }
    let Some(most) = most.filter(|&most| total(&widths) > most) else {
        put_whole(&mut out, table.columns(), &widths, &heads, &rows);
        return out;
    };
    let whole = std::mem::replace(&mut rows, cells(&table.shortened(NARROW_DIGITS)));
    let mut less: Vec<String> = Vec::new();
    if whole != rows {
        less.push(format!("at most {NARROW_DIGITS} digits here"));
        widths = whole_widths(&heads, &rows);
    }
    if total(&widths) > most {
        let left_out = put_folded(&mut out, table.columns(), &heads, &rows, most);
        less.extend((!left_out.is_empty()).then(|| format!("left out here: {}", left_out.join(", "))));
    } else {
        put_whole(&mut out, table.columns(), &widths, &heads, &rows);
    }
    if !less.is_empty() {
        out.push_str(&format!("\n{}; a wider terminal or --format json has them\n", less.join("; ")));
    }
    out
}

/// Digits of an enclosure where a table is wider than a terminal.
const NARROW_DIGITS: u32 = 8;

/// All cells as a person reads them.
fn cells(table: &Table) -> Vec<Vec<String>> {
    table.rows().iter().map(|row| row.iter().map(shown).collect()).collect()
}

fn put_whole(out: &mut String, columns: &[Column], widths: &[usize], heads: &[String], rows: &[Vec<String>]) {
    for fields in [heads, &rule(widths)].into_iter().chain(rows.iter().map(Vec::as_slice)) {
        put_line(out, columns, widths, fields);
    }
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

/// The table in lines of at most so many characters, and the headings of the columns that are left out.
fn put_folded(
    out: &mut String,
    columns: &[Column],
    heads: &[String],
    rows: &[Vec<String>],
    most: usize,
) -> Vec<String> {
    let widths = folded_widths(columns, heads, rows, most);
    let mut kept: Vec<usize> = (0..heads.len()).collect();
    let is_empty = |&n: &usize| rows.iter().all(|row| row[n] == shown(&Cell::Missing));
    while kept.len() > 1 && total(&of(&widths, &kept)) > most {
        kept.remove(kept.iter().rposition(is_empty).unwrap_or(kept.len() - 1));
    }
    let (columns, widths) = (of(columns, &kept), of(&widths, &kept));
    put_row(out, &columns, &widths, &of(heads, &kept), true);
    put_line(out, &columns, &widths, &rule(&widths));
    rows.iter().for_each(|row| put_row(out, &columns, &widths, &of(row, &kept), false));
    let mut left_out: Vec<String> = Vec::new();
    for n in (0..heads.len()).filter(|n| !kept.contains(n)) {
        // Two edges have columns of one name.
        left_out.extend((!left_out.contains(&heads[n])).then(|| heads[n].clone()));
    }
    left_out
}

/// Those at these places.
fn of<T: Clone>(all: &[T], places: &[usize]) -> Vec<T> {
    places.iter().map(|&n| all[n].clone()).collect()
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
