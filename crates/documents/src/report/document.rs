//! A result on its way out: one document, four formats.
//!
//! JSON carries everything: the schema's name, the program's version and command, the input as exact strings,
//! the summary, the rows. CSV is the rows alone, LaTeX the rows as a table for a paper, text the summary and
//! (where there are few) the rows for a person at a terminal.

use serde_json::{Map, Value, json};

use super::decimal::in_digits;
use super::latex::{self, Equation, Float};
use super::table::Table;
use super::{csv, text};
use crate::format::Format;
use number::error::visible;
use number::{Error, Result};

/// A named result.
#[derive(Clone, Debug)]
#[must_use]
pub struct Document {
    /// NAME in `kickdrift/NAME/1`.
    name: &'static str,
    input: Map<String, Value>,
    body: Map<String, Value>,
    table: Option<Table>,
    /// In place of it, for LaTeX and text.
    for_people: Option<Table>,
    /// Further tables, for LaTeX and text.
    more: Vec<Table>,
    /// In place of the tables in LaTeX.
    equations: Vec<Equation>,
    /// Significant digits of tables that people read, where a number is asked for.
    digits: Option<u32>,
    /// The environment of tables in LaTeX, where one is asked for.
    float: Option<Float>,
    summary: String,
    summary_only: bool,
    /// The rows that a text has at most.
    most_rows: usize,
    /// In place of the summary and the tables in text, unless details are asked for.
    answer: Option<Vec<String>>,
    is_detailed: bool,
    /// Characters a line of the tables in text, where a terminal bounds them.
    width: Option<usize>,
}

/// The columns and digits that a person asks for.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// The keys of the columns of the first one; all that fit its form where none are given.
    pub columns: Option<Vec<String>>,
    /// Significant digits in text and LaTeX.
    pub digits: Option<u32>,
}

/// Rows beyond this number are left out of the text form, which says so.
const ROWS_FOR_PEOPLE: usize = 60;

impl Document {
    /// A document without content, `name` as in `kickdrift/NAME/1`.
    pub fn new(name: &'static str) -> Self {
        Document {
            name,
            input: Map::new(),
            body: Map::new(),
            table: None,
            for_people: None,
            more: Vec::new(),
            equations: Vec::new(),
            digits: None,
            float: None,
            summary: String::new(),
            summary_only: false,
            most_rows: ROWS_FOR_PEOPLE,
            answer: None,
            is_detailed: false,
            width: None,
        }
    }

    /// Echoes one input, as an exact string.
    pub fn input(mut self, key: &str, value: impl ToString) -> Self {
        self.input.insert(key.into(), Value::String(value.to_string()));
        self
    }

    /// Echoes inputs, in order.
    pub fn inputs<'a, V: Into<Value>>(self, given: impl IntoIterator<Item = (&'a str, V)>) -> Self {
        given.into_iter().fold(self, |document, (key, value)| document.input_json(key, value.into()))
    }

    /// Echoes one input that has parts of its own, as JSON.
    pub fn input_json(mut self, key: &str, value: Value) -> Self {
        self.input.insert(key.into(), value);
        self
    }

    /// Adds one entry to the JSON body, at a path as in a [`Record`](super::record::Record).
    pub fn entry(mut self, key: &str, value: impl Into<Value>) -> Self {
        put(&mut self.body, key, value.into());
        self
    }

    /// Adds entries to the JSON body, in order; none of an `Option` that is `None`.
    pub fn entries<'a, V: Into<Value>>(self, given: impl IntoIterator<Item = (&'a str, V)>) -> Self {
        given.into_iter().fold(self, |document, (key, value)| document.entry(key, value))
    }

    /// The rows for CSV, LaTeX and text; in JSON too, under the table's name, unless the body has that key.
    pub fn rows(mut self, table: Table) -> Self {
        if !self.body.contains_key(table.name()) {
            self.body.insert(table.name().into(), table.to_json_rows());
        }
        self.table = Some(table);
        self
    }

    /// Rows that are too many for JSON: CSV, LaTeX and text alone show them.
    pub fn long_rows(mut self, table: Table) -> Self {
        self.table = Some(table);
        self
    }

    /// A shorter table in place of the rows, for LaTeX and text.
    pub fn for_people(mut self, table: Table) -> Self {
        self.for_people = Some(table);
        self
    }

    /// A further table, for LaTeX and text alone.
    pub fn and_rows(mut self, table: Table) -> Self {
        self.more.push(table);
        self
    }

    /// Equations, which LaTeX shows in place of the rows.
    pub fn equations(mut self, equations: Vec<Equation>) -> Self {
        self.equations = equations;
        self
    }

    /// Lays its tables out as asked for; JSON stays as it is.
    ///
    /// # Errors
    /// A column that the table does not have, no digits at all.
    pub fn laid_out(mut self, layout: &Layout) -> Result<Self> {
        if layout.digits == Some(0) {
            return Err(Error::input("digits", 0, "choose 1 or more"));
        }
        self.digits = layout.digits;
        if let (Some(keys), Some(table)) = (&layout.columns, &self.table) {
            self.table = Some(table.choose(keys)?);
            self.for_people = None;
            // Whoever names columns wants to see them.
            self.is_detailed = true;
        }
        Ok(self)
    }

    /// Puts its LaTeX tables into this environment [default: by their width].
    pub fn floated(self, float: Option<Float>) -> Self {
        Document { float, ..self }
    }

    /// The summary for people: whole lines, the last one without a newline.
    pub fn summary(mut self, lines: &[String]) -> Self {
        self.summary = lines.join("\n");
        self
    }

    /// A summary that says all: the text form leaves the rows out.
    pub fn summary_alone(mut self, lines: &[String]) -> Self {
        self.summary_only = true;
        self.summary(lines)
    }

    /// The answer in a few lines: the text form shows them alone, and the rest where it is
    /// [`detailed`](Self::detailed).
    pub fn answer(self, lines: Vec<String>) -> Self {
        Document { answer: Some(lines), ..self }
    }

    /// With the summary and the tables in text.
    pub fn detailed(self) -> Self {
        Document { is_detailed: true, ..self }
    }

    /// With a line below the answer, where it stands alone.
    pub fn below_answer(mut self, line: &str) -> Self {
        self.answer.iter_mut().for_each(|lines| lines.push(line.into()));
        self
    }

    /// With tables of at most so many characters a line in text.
    pub fn within(self, width: Option<usize>) -> Self {
        Document { width, ..self }
    }

    /// All rows in text, too, of a list that is asked for as one.
    pub fn with_all_rows(self) -> Self {
        Document { most_rows: usize::MAX, ..self }
    }

    /// The summary alone.
    pub fn summary_text(&self) -> &str {
        &self.summary
    }

    /// The document in one format, ending in a newline.
    ///
    /// # Errors
    /// CSV or LaTeX of a document without rows, and the forms that are not of documents.
    pub fn render(&self, format: Format) -> Result<String> {
        self.render_with(format, "write them as csv, json or latex")
    }

    /// The document in one format; where rows are too many for a text, `to_see` says how to see them.
    ///
    /// # Errors
    /// As [`Document::render`].
    pub fn render_with(&self, format: Format, to_see: &str) -> Result<String> {
        let table = |format: &str| {
            let remedy = "this result has no rows: choose text or json";
            self.table.as_ref().ok_or_else(|| Error::input("format", format, remedy))
        };
        match format {
            Format::Json => Ok(self.json()),
            Format::Csv => Ok(csv::document(table("csv")?)),
            Format::Latex if !self.equations.is_empty() => latex::equations(&self.equations, &self.input),
            Format::Latex => {
                let first = self.for_people.as_ref().map_or_else(|| table("latex"), Ok)?;
                let all = std::iter::once(first).chain(&self.more);
                let all: Result<Vec<String>> =
                    all.map(|table| latex::document(table, &self.input, self.digits, self.float)).collect();
                Ok(all?.join("\n"))
            }
            Format::Text => Ok(self.text(to_see)),
            Format::Svg | Format::Pdf | Format::Png | Format::Npz | Format::Xyz | Format::Vtu => {
                let remedy = format!("this result is written as {}", Format::extensions(&Format::DOCUMENT));
                Err(Error::input("format", format.name(), remedy))
            }
        }
    }

    /// The document as a JSON value, its keys in order.
    pub fn value(&self) -> Value {
        let mut all = Map::new();
        all.insert("schema".into(), format!("kickdrift/{}/1", self.name).into());
        all.insert(
            "kickdrift".into(),
            json!({"version": env!("CARGO_PKG_VERSION"), "command": command(self.name)}),
        );
        all.insert("input".into(), Value::Object(self.input.clone()));
        all.extend(self.body.clone());
        Value::Object(all)
    }

    fn json(&self) -> String {
        let mut out = String::new();
        write_json(&mut out, &self.value(), 0);
        out.push('\n');
        out
    }

    fn text(&self, to_see: &str) -> String {
        if let Some(lines) = self.answer.as_ref().filter(|_| !self.is_detailed) {
            let lines = lines.join("\n");
            return visible(&(self.digits.map_or_else(|| lines.clone(), |n| in_digits(&lines, n)) + "\n"));
        }
        let mut out = self.digits.map_or_else(|| self.summary.clone(), |n| in_digits(&self.summary, n));
        out.push('\n');
        let first = self.for_people.as_ref().or(self.table.as_ref());
        for table in first.into_iter().chain(&self.more).filter(|_| !self.summary_only) {
            let rows = table.rows().len();
            if rows > self.most_rows {
                out += &format!("\n{rows} rows: {to_see}\n");
            } else if rows > 0 {
                out += &format!("\n{}\n", text::document(&self.for_text(table), self.width).trim_end());
            }
        }
        visible(&out)
    }

    /// With the digits asked for; an answer for people has decimals where its other forms have fractions.
    fn for_text(&self, table: &Table) -> Table {
        let table = self.digits.map_or_else(|| table.clone(), |n| table.shortened(n));
        if self.answer.is_some() { table.in_decimals() } else { table }
    }
}

/// The command that makes documents of this name, alone or as a part of a larger one.
pub(super) fn command(name: &'static str) -> &'static str {
    match name {
        "system-verdict" | "system-map" | "system-intervals" => "system",
        "advise-system" | "advise-direct" => "advise",
        "survey" => "tongues",
        "methods" | "word-check" | "family" => "word",
        "compare-methods" => "compare",
        name => name,
    }
}

/// Puts a value at a path; a group begins with its first value.
pub(super) fn put(entries: &mut Map<String, Value>, path: &str, value: Value) {
    let Some((group, rest)) = path.split_once('.') else { return drop(entries.insert(path.into(), value)) };
    let group = entries.entry(group).or_insert(Value::Null);
    if !value.is_null() && group.is_null() {
        *group = Map::new().into();
    }
    if let Value::Object(inside) = group {
        put(inside, rest, value);
    }
}

/// `{"lo": , "hi": }`.
pub fn enclosure((lo, hi): (f64, f64)) -> Value {
    let mut ends = Map::new();
    ends.insert("lo".into(), lo.into());
    ends.insert("hi".into(), hi.into());
    Value::Object(ends)
}

/// JSON that people can read and diff: what holds only plain values stands on one line.
fn write_json(out: &mut String, value: &Value, depth: usize) {
    let nested = |value: &Value| matches!(value, Value::Object(_) | Value::Array(_));
    let line = |out: &mut String, depth: usize, first: bool| {
        *out += if first { "\n" } else { ",\n" };
        *out += &"  ".repeat(depth);
    };
    match value {
        Value::Object(map) if depth == 0 || deep(value) => {
            out.push('{');
            for (i, (key, value)) in map.iter().enumerate() {
                line(out, depth + 1, i == 0);
                *out += &format!("{}: ", Value::from(key.as_str()));
                write_json(out, value, depth + 1);
            }
            *out += &format!("\n{}}}", "  ".repeat(depth));
        }
        Value::Array(items) if items.iter().any(nested) => {
            out.push('[');
            for (i, item) in items.iter().enumerate() {
                line(out, depth + 1, i == 0);
                write_json(out, item, depth + 1);
            }
            *out += &format!("\n{}]", "  ".repeat(depth));
        }
        _ => *out += &value.to_string(),
    }
}

/// Whether an array of objects lies somewhere inside.
fn deep(value: &Value) -> bool {
    match value {
        Value::Object(map) => map.values().any(deep),
        Value::Array(items) => items.iter().any(|item| item.is_object() || deep(item)),
        _ => false,
    }
}
