//! Tables for a terminal: aligned columns under a rule, numbers on the right.

use super::decimal;
use super::table::{Align, Cell, Column, Table};

/// The space between two columns.
const GAP: &str = "  ";

/// The farthest column at which the text after a label may begin.
const FARTHEST_LABEL: usize = 16;

/// How a text stands where it is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Page {
    /// With the reasons and tables that a short answer leaves out.
    pub details: bool,
    /// Characters a line; lines are as long as they come where none is given.
    pub width: Option<usize>,
    /// The words of verdicts in colour.
    pub colour: bool,
    /// How to see what a short answer leaves out.
    pub more: Option<&'static str>,
}

impl Page {
    /// Without what a terminal alone has.
    #[must_use]
    pub fn of_a_file(self) -> Self {
        Page { width: None, colour: false, ..self }
    }
}

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

/// The whole table as lines of text, the caption first; of the columns as many as have room in `room`
/// characters, and below them the names of those that have none.
///
/// Enclosures show the digits that are certain, see [`decimal::enclosure`]. Widths count characters, so
/// columns line up for everything but double-width scripts.
pub fn document(table: &Table, room: Option<usize>) -> String {
    let heads: Vec<String> = table.columns().iter().map(head).collect();
    let rows: Vec<Vec<String>> = table.rows().iter().map(|row| row.iter().map(shown).collect()).collect();
    let widths: Vec<usize> = (0..heads.len())
        .map(|i| rows.iter().map(|row| &row[i]).chain([&heads[i]]).map(|text| width(text)).max().unwrap_or(0))
        .collect();
    let ends = widths.iter().scan(0, |end, width| {
        *end += width + GAP.len();
        Some(*end - GAP.len())
    });
    let fitting = room.map_or(heads.len(), |room| ends.take_while(|&end| end <= room).count().max(1));
    let mut out = String::new();
    if !table.caption().is_empty() {
        out.push_str(&wrapped(table.caption(), room));
        out.push_str("\n\n");
    }
    let rule: Vec<String> = widths.iter().map(|&width| "-".repeat(width)).collect();
    for fields in [&heads, &rule].into_iter().chain(&rows) {
        put_line(&mut out, table.columns(), &widths[..fitting], fields);
    }
    if fitting < heads.len() {
        let missing = format!("no room for: {}", heads[fitting..].join(", "));
        out.push_str(&wrapped(&missing, room));
        out.push('\n');
    }
    out
}

/// A line in lines of at most `room` characters, broken at spaces. What follows hangs below the text behind
/// the label that the line begins with. A word that is longer than a line stays whole.
pub fn wrapped(line: &str, room: Option<usize>) -> String {
    let Some(room) = room.filter(|&room| width(line) > room) else { return line.into() };
    let label = line.trim_start();
    let gap = label.find(GAP).map(|at| at + label[at..].len() - label[at..].trim_start().len());
    let hang = gap.map_or(0, |at| width(&line[..line.len() - label.len() + at]));
    let hang = if (1..=FARTHEST_LABEL).contains(&hang) { hang } else { width(line) - width(label) + 2 };
    let mut words = line.split(' ');
    let mut lines = vec![words.next().unwrap_or_default().to_string()];
    for word in words {
        let last = lines.last_mut().expect("there is a first");
        if width(last) + 1 + width(word) <= room || last.trim().is_empty() {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(format!("{}{word}", " ".repeat(hang)));
        }
    }
    lines.join("\n")
}

/// The words that verdicts and steps are called by, where a line or the text behind its label begins with
/// one, and cautions anywhere, each with its colour of a terminal.
pub fn coloured(line: &str) -> String {
    const RED: u8 = 31;
    const GREEN: u8 = 32;
    const YELLOW: u8 = 33;
    let at = line.find(GAP).filter(|_| !line.starts_with(' '));
    let starts = [0, at.map_or(0, |at| line.len() - line[at..].trim_start().len())];
    let verdicts =
        [("unstable", RED), ("safe", GREEN), ("stable", GREEN), ("not told", YELLOW), ("undecided", YELLOW)];
    let begins = |&(word, _): &(&str, u8)| starts.into_iter().find(|&at| begins_with(&line[at..], word));
    let first = verdicts.iter().find_map(|verdict| Some((begins(verdict)?, *verdict)));
    let anywhere = [("caution", YELLOW), ("do not use", RED)];
    let found = anywhere.into_iter().filter_map(|(word, colour)| Some((line.rfind(word)?, (word, colour))));
    let mut found: Vec<_> = first.into_iter().chain(found.filter(|_| first.is_some())).collect();
    found.sort_unstable();
    let mut out = line.to_string();
    for (at, (word, colour)) in found.into_iter().rev() {
        out.replace_range(at..at + word.len(), &format!("\u{1b}[{colour}m{word}\u{1b}[0m"));
    }
    out
}

/// Whether the text begins with the word, whole.
fn begins_with(text: &str, word: &str) -> bool {
    text.strip_prefix(word).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
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
