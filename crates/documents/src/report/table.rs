//! One table for every format: named columns, typed cells.
//!
//! A cell says what its number *is*: exact text, the double nearest to a value, or an enclosure that contains
//! it. The formats differ in how they show that, never in what they claim.

use num_bigint::BigInt;
use num_traits::ToPrimitive;
use serde::ser::{Serialize, SerializeMap, SerializeSeq, Serializer};

use super::decimal;
use molecules::unit::decimal as decimal_of;
use number::{Error, Result};

/// One value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// An exact number in the notation that kickdrift also reads, as `7/2` or `pi^2/25`.
    Exact(String),
    /// The double nearest to the value.
    Float(f64),
    /// Two doubles with the value between them, ends included.
    Enclosure {
        /// The lower end.
        lo: f64,
        /// The upper end.
        hi: f64,
    },
    /// A number in decimal digits that says how far they hold, see [`decimal`].
    Decimal(String),
    /// A count, a label, an index.
    Integer(i64),
    /// Words.
    Text(String),
    /// Yes or no.
    Flag(bool),
    /// No value belongs here.
    Missing,
}

impl Cell {
    /// An exact number, from its text.
    pub fn exact(number: impl ToString) -> Self {
        Cell::Exact(number.to_string())
    }

    /// A whole number: beyond 2^63 as an exact text.
    pub fn whole(n: &BigInt) -> Self {
        n.to_i64().map_or_else(|| Cell::exact(n), Cell::Integer)
    }
}

impl From<i64> for Cell {
    fn from(value: i64) -> Self {
        Cell::Integer(value)
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        // Counts and labels stay below 2^63.
        Cell::Integer(value as i64)
    }
}

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Cell::from(value as u64)
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Cell::Float(value)
    }
}

impl From<(f64, f64)> for Cell {
    fn from((lo, hi): (f64, f64)) -> Self {
        Cell::Enclosure { lo, hi }
    }
}

impl From<&str> for Cell {
    fn from(words: &str) -> Self {
        Cell::Text(words.into())
    }
}

impl From<bool> for Cell {
    fn from(value: bool) -> Self {
        Cell::Flag(value)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Cell::Missing, Into::into)
    }
}

/// How a column lies on paper and on a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// One column: its key for programs, its titles for people.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use]
pub struct Column {
    /// The name in CSV and JSON.
    pub key: String,
    /// The name in plain text.
    pub title: String,
    /// The name in LaTeX, typeset as it stands; without one the title is typeset as plain text.
    pub latex: Option<String>,
    /// The unit, shown in parentheses after the title.
    pub unit: Option<String>,
    /// The side on which the cells line up.
    pub align: Align,
    /// Whether the cells are enclosures: these take two columns of CSV.
    pub enclosed: bool,
    /// Whether a table on paper does without it unless it is asked for.
    pub aside: bool,
}

impl Column {
    /// A right-aligned column whose titles are its key.
    pub fn new(key: &str) -> Self {
        Column {
            key: key.into(),
            title: key.into(),
            latex: None,
            unit: None,
            align: Align::Right,
            enclosed: false,
            aside: false,
        }
    }

    /// A column whose titles are its key and, in LaTeX, a formula.
    pub fn math(key: &str, formula: &str) -> Self {
        Column::new(key).titled(key, &format!("${formula}$"))
    }

    /// Gives it a title for people, plain and in LaTeX.
    pub fn titled(mut self, title: &str, latex: &str) -> Self {
        self.title = title.into();
        self.latex = Some(latex.into());
        self
    }

    /// Gives it words for a title.
    pub fn in_words(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// Gives it a unit.
    pub fn in_unit(mut self, unit: &str) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Lines its cells up on the left.
    pub fn left(mut self) -> Self {
        self.align = Align::Left;
        self
    }

    /// Leaves it out on paper unless it is asked for.
    pub fn aside(mut self) -> Self {
        self.aside = true;
        self
    }

    /// The column that shows a part of its cells, on paper too.
    fn part(&self, part: Part) -> Column {
        let (end, words) = match part {
            Part::Whole => return Column { aside: false, ..self.clone() },
            Part::Lower => ("lo", "lower bound"),
            Part::Upper => ("hi", "upper bound"),
        };
        Column {
            key: format!("{}_{end}", self.key),
            title: format!("{}, {words}", self.title),
            latex: self.latex.as_ref().map(|title| format!("{title}, {words}")),
            enclosed: false,
            aside: false,
            ..self.clone()
        }
    }

    /// Makes it a column of enclosures.
    pub fn enclosure(mut self) -> Self {
        self.enclosed = true;
        self
    }
}

/// Named columns and rows of cells.
///
/// ```
/// use kickdrift_documents::report::table::{Cell, Column, Table};
/// let mut table = Table::new("steps", "Resonant steps", vec![Column::new("p"), Column::new("h2")]);
/// table.push(vec![Cell::Integer(7), Cell::Exact("7/2".into())]);
/// assert_eq!(kickdrift_documents::report::csv::document(&table), "p,h2\r\n7,7/2\r\n");
/// assert_eq!(table.to_json_rows().to_string(), r#"[{"p":7,"h2":"7/2"}]"#);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Table {
    name: String,
    caption: String,
    typeset: Option<String>,
    columns: Vec<Column>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows.
    pub fn new(name: &str, caption: &str, columns: Vec<Column>) -> Self {
        Table { name: name.into(), caption: caption.into(), typeset: None, columns, rows: Vec::new() }
    }

    /// Gives it a caption for LaTeX, typeset as it stands.
    pub fn captioned(mut self, latex: &str) -> Self {
        self.typeset = Some(latex.into());
        self
    }

    /// The columns with these keys alone, in this order.
    ///
    /// # Errors
    /// A key that no column has.
    pub fn choose(&self, keys: &[String]) -> Result<Table> {
        let choice = Choice::new(&self.columns, keys)?;
        let rows = self.rows.iter().map(|row| choice.row(row)).collect();
        Ok(Table { columns: choice.columns, rows, ..self.clone() })
    }

    /// The columns with these keys alone, in this order.
    ///
    /// # Panics
    /// A key that no column has.
    pub fn only(&self, keys: &[&str]) -> Table {
        let keys: Vec<String> = keys.iter().map(ToString::to_string).collect();
        self.choose(&keys).expect("its own keys")
    }

    /// The columns that are to be kept.
    pub fn keeping(&self, is_kept: impl Fn(&Column) -> bool) -> Table {
        let kept = self.columns.iter().filter(|column| is_kept(column));
        self.only(&kept.map(|column| column.key.as_str()).collect::<Vec<_>>())
    }

    /// The table with so many significant digits at most.
    pub fn shortened(&self, digits: u32) -> Table {
        let shorten = |cell: &Cell| match *cell {
            Cell::Float(x) if x.is_finite() => Cell::Float(decimal::rounded(x, digits as usize)),
            Cell::Enclosure { lo, hi } if lo.is_finite() && hi.is_finite() => {
                match decimal::shortened(lo, hi, digits) {
                    decimal::Shown::Ends(..) => cell.clone(),
                    concise => Cell::Decimal(concise.to_string()),
                }
            }
            _ => cell.clone(),
        };
        let rows = self.rows.iter().map(|row| row.iter().map(shorten).collect()).collect();
        Table { rows, ..self.clone() }
    }

    /// The table with decimals in place of fractions, column by column: one notation in each. A column of
    /// exact numbers keeps its fractions where one of them has no finite decimals.
    pub fn in_decimals(&self) -> Table {
        let decimal =
            |text: &str| text.parse().ok().map(|x| decimal_of(&x)).filter(|text| !text.contains('/'));
        let is_kept = |i: usize| {
            let is_exact = |row: &Vec<Cell>| matches!(row[i], Cell::Exact(_) | Cell::Missing);
            let is_fraction =
                |row: &Vec<Cell>| matches!(&row[i], Cell::Exact(text) if decimal(text).is_none());
            self.rows.iter().all(is_exact) && self.rows.iter().any(is_fraction)
        };
        let kept: Vec<bool> = (0..self.columns.len()).map(is_kept).collect();
        let plain = |(cell, is_kept): (&Cell, &bool)| match cell {
            Cell::Exact(text) if !is_kept => Cell::Exact(decimal(text).unwrap_or_else(|| text.clone())),
            other => other.clone(),
        };
        let rows = self.rows.iter().map(|row| row.iter().zip(&kept).map(plain).collect()).collect();
        Table { rows, ..self.clone() }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If the row has not one cell a column, or an enclosure stands in a column that is not for enclosures:
    /// such a row is a bug of its maker, and would shift the columns of a CSV file.
    pub fn push(&mut self, row: Vec<Cell>) {
        check(&self.columns, &row);
        self.rows.push(row);
    }

    /// The name: the key in JSON, the label in LaTeX.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One sentence on what the rows are.
    pub fn caption(&self) -> &str {
        &self.caption
    }

    /// The caption in LaTeX, where it differs.
    pub fn typeset(&self) -> Option<&str> {
        self.typeset.as_deref()
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The rows, in the order they came.
    pub fn rows(&self) -> &[Vec<Cell>] {
        &self.rows
    }

    /// The rows as a JSON array of objects, one key a column; see the [`Serialize`] implementation.
    pub fn to_json_rows(&self) -> serde_json::Value {
        serde_json::to_value(self).expect("rows of plain cells are always JSON")
    }
}

/// Some of the columns, by their keys or by the names that CSV has: `KEY_lo` is the lower end of an enclosure
/// alone.
#[derive(Clone, Debug)]
pub struct Choice {
    picks: Vec<(usize, Part)>,
    columns: Vec<Column>,
}

/// The part of a cell that is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Whole,
    Lower,
    Upper,
}

impl Choice {
    /// These of the columns, in this order.
    ///
    /// # Errors
    /// A name that no column has.
    pub fn new(columns: &[Column], names: &[String]) -> Result<Choice> {
        let whole = columns.iter().enumerate().map(|(i, column)| (column.key.clone(), (i, Part::Whole)));
        let ends =
            columns.iter().enumerate().filter(|(_, column)| column.enclosed).flat_map(|(i, column)| {
                let name = |end: &str| format!("{}_{end}", column.key);
                [(name("lo"), (i, Part::Lower)), (name("hi"), (i, Part::Upper))]
            });
        let known: Vec<(String, (usize, Part))> = whole.chain(ends).collect();
        let place = |name: &String| {
            let found = known.iter().find(|(text, _)| text == name.trim()).map(|(_, place)| *place);
            found.ok_or_else(|| Error::unknown("columns", name, known.iter().map(|(text, _)| text.as_str())))
        };
        let picks = names.iter().map(place).collect::<Result<Vec<_>>>()?;
        let columns = picks.iter().map(|&(i, part)| columns[i].part(part)).collect();
        Ok(Choice { picks, columns })
    }

    /// The columns chosen.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The cells chosen of a row of all columns.
    pub fn row(&self, row: &[Cell]) -> Vec<Cell> {
        let cell = |&(i, part): &(usize, Part)| match (&row[i], part) {
            (&Cell::Enclosure { lo, .. }, Part::Lower) => Cell::Float(lo),
            (&Cell::Enclosure { hi, .. }, Part::Upper) => Cell::Float(hi),
            (other, _) => other.clone(),
        };
        self.picks.iter().map(cell).collect()
    }
}

/// Panics unless `row` fits `columns`; see [`Table::push`].
pub(super) fn check(columns: &[Column], row: &[Cell]) {
    assert_eq!(row.len(), columns.len(), "a row has one cell a column");
    for (column, cell) in columns.iter().zip(row) {
        let enclosure = matches!(cell, Cell::Enclosure { .. });
        assert!(column.enclosed || !enclosure, "column {} is not for enclosures", column.key);
    }
}

/// As a sequence of maps from column keys to cells, in the order of the columns. Exact numbers are strings,
/// enclosures `{"lo": , "hi": }`, missing values null, and so is a float that is not finite: JSON has none.
impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut rows = serializer.serialize_seq(Some(self.rows.len()))?;
        for row in &self.rows {
            rows.serialize_element(&Row { columns: &self.columns, cells: row })?;
        }
        rows.end()
    }
}

struct Row<'a> {
    columns: &'a [Column],
    cells: &'a [Cell],
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_map(self.columns.iter().map(|column| &column.key).zip(self.cells))
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Cell::Exact(text) | Cell::Decimal(text) | Cell::Text(text) => serializer.serialize_str(text),
            Cell::Float(value) => serializer.serialize_f64(*value),
            Cell::Enclosure { lo, hi } => {
                let mut ends = serializer.serialize_map(Some(2))?;
                ends.serialize_entry("lo", lo)?;
                ends.serialize_entry("hi", hi)?;
                ends.end()
            }
            Cell::Integer(value) => serializer.serialize_i64(*value),
            Cell::Flag(value) => serializer.serialize_bool(*value),
            Cell::Missing => serializer.serialize_none(),
        }
    }
}
