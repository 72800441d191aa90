//! Records: the named, typed cells of one thing, from which its JSON entries, its row of CSV and LaTeX and
//! its line of text all come.

use std::borrow::Cow;

use serde_json::{Map, Value};

use super::document::{Document, put};
use super::shape::{Keys, Shape};
use super::table::{Cell, Column, Table};

/// How the value of one field is found in a `T`.
enum Find<'a, T> {
    Cell(Box<dyn Fn(&T) -> Cell + Send + Sync + 'a>),
    /// JSON with parts of its own.
    Value(fn(&T) -> Value),
    /// The same, where there is one.
    Optional(fn(&T) -> Option<Value>),
}

/// One cell: its column, where it is a column of tables, its path among the entries of JSON, where it is one
/// of them, and the way to it.
struct Field<'a, T> {
    column: Option<Column>,
    path: Option<String>,
    find: Find<'a, T>,
    /// Its shape, and a sentence on it, for the schema.
    says: Option<(Shape, Cow<'static, str>)>,
}

/// The cells that are written of a `T`, each with the way to it.
///
/// A path such as `s.decimal.lo` leads into objects of JSON. An object without any value is null, and an
/// enclosure is an object, `{"lo": , "hi": }`, that may hold more.
///
/// ```
/// use kickdrift_documents::report::record::Record;
/// use kickdrift_documents::report::table::Column;
/// let squares = Record::new()
///     .field(Column::math("n", "n"), |n: &u64| (*n).into())
///     .field(Column::math("square", "n^2"), |n| (n * n).into())
///     .json("more.cube", |n| n.pow(3).into());
/// let table = squares.table("squares", "The first squares", &[1, 2]);
/// assert_eq!(kickdrift_documents::report::csv::document(&table), "n,square\r\n1,1\r\n2,4\r\n");
/// assert_eq!(squares.entries(&3).to_string(), r#"{"n":3,"square":9,"more":{"cube":27}}"#);
/// ```
#[must_use]
pub struct Record<'a, T> {
    fields: Vec<Field<'a, T>>,
}

impl<T> Default for Record<'_, T> {
    fn default() -> Self {
        Record::new()
    }
}

impl<'a, T> Record<'a, T> {
    /// A record without fields.
    pub fn new() -> Self {
        Record { fields: Vec::new() }
    }

    fn with(mut self, column: Option<Column>, path: Option<&str>, find: Find<'a, T>) -> Self {
        self.fields.push(Field { column, path: path.map(Into::into), find, says: None });
        self
    }

    fn with_column(self, column: Column, find: Find<'a, T>) -> Self {
        let path = column.key.clone();
        self.with(Some(column), Some(&path), find)
    }

    /// One more field: an entry of JSON and a column of the same name.
    pub fn field(self, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with_column(column, Find::Cell(Box::new(find)))
    }

    /// One more field, which JSON has at `path`.
    pub fn at(self, path: &str, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(Some(column), Some(path), Find::Cell(Box::new(find)))
    }

    /// One more entry of JSON alone.
    pub fn json(self, path: &str, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(None, Some(path), Find::Cell(Box::new(find)))
    }

    /// One more entry of JSON alone, which has parts of its own.
    pub fn value(self, path: &str, find: fn(&T) -> Value) -> Self {
        self.with(None, Some(path), Find::Value(find))
    }

    /// One more entry of JSON alone, which is not there where there is none.
    pub fn optional(self, path: &str, find: fn(&T) -> Option<Value>) -> Self {
        self.with(None, Some(path), Find::Optional(find))
    }

    /// One more column of tables alone.
    pub fn column(self, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(Some(column), None, Find::Cell(Box::new(find)))
    }

    /// Says what the last field is: its shape, and a sentence for people.
    pub fn says(mut self, shape: Shape, sentence: impl Into<Cow<'static, str>>) -> Self {
        if let Some(field) = self.fields.last_mut() {
            field.says = Some((shape, sentence.into()));
        }
        self
    }

    /// The keys of its entries.
    ///
    /// # Panics
    /// Where a field does not say what it is: its schema could not be written.
    pub fn keys(&self) -> Keys {
        let entries = self.fields.iter().filter_map(|field| Some((field.path.clone()?, field)));
        entries.fold(Keys::new(), |keys, (path, field)| {
            let says = field.says.clone();
            let (shape, sentence) = says.unwrap_or_else(|| panic!("{path} does not say what it is"));
            keys.with(path, shape, sentence, !matches!(field.find, Find::Optional(_)))
        })
    }

    /// The columns, in order.
    pub fn columns(&self) -> Vec<Column> {
        self.fields.iter().filter_map(|field| field.column.clone()).collect()
    }

    /// The row of one thing: a cell for each column.
    pub fn row(&self, number: &T) -> Vec<Cell> {
        let columns = self.fields.iter().filter(|field| field.column.is_some());
        let cell = |field: &Field<'a, T>| match &field.find {
            Find::Cell(find) => Some(find(number)),
            Find::Value(_) | Find::Optional(_) => None,
        };
        columns.filter_map(cell).collect()
    }

    /// The rows of many things.
    pub fn table<'b>(&self, name: &str, caption: &str, all: impl IntoIterator<Item = &'b T>) -> Table
    where
        T: 'b,
    {
        let mut table = Table::new(name, caption, self.columns());
        all.into_iter().for_each(|number| table.push(self.row(number)));
        table
    }

    /// The entries of one thing, as in JSON.
    pub fn entries(&self, number: &T) -> Value {
        self.object(number).into()
    }

    /// The same by their keys.
    pub fn object(&self, number: &T) -> Map<String, Value> {
        let mut entries = Map::new();
        for field in &self.fields {
            let Some(path) = &field.path else { continue };
            let value = match &field.find {
                Find::Cell(find) => Some(serde_json::to_value(find(number)).expect("a cell is JSON")),
                Find::Value(find) => Some(find(number)),
                Find::Optional(find) => find(number),
            };
            if let Some(value) = value {
                put(&mut entries, path, value);
            }
        }
        entries
    }

    /// The entries of many things.
    pub fn all<'b>(&self, all: impl IntoIterator<Item = &'b T>) -> Vec<Value>
    where
        T: 'b,
    {
        all.into_iter().map(|number| self.entries(number)).collect()
    }

    /// Adds the entries of one thing to a document.
    pub fn document(&self, document: Document, number: &T) -> Document {
        self.object(number).into_iter().fold(document, |document, (key, value)| document.entry(&key, value))
    }
}
