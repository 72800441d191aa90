//! Records: the named, typed cells of one thing, from which its JSON entries, its row of CSV and LaTeX and
//! its line of text all come.

use serde_json::{Map, Value};

use super::document::{Document, put};
use super::table::{Cell, Column, Table};

/// How the cell of one column is found in a `T`.
type Find<'a, T> = Box<dyn Fn(&T) -> Cell + Send + Sync + 'a>;

/// One cell: its column, where it is a column of tables, its path among the entries of JSON, where it is one
/// of them, and the way to it.
struct Field<'a, T> {
    column: Option<Column>,
    path: Option<String>,
    find: Find<'a, T>,
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

    fn with(mut self, column: Option<Column>, path: Option<String>, find: Find<'a, T>) -> Self {
        self.fields.push(Field { column, path, find });
        self
    }

    /// One more field: an entry of JSON and a column of the same name.
    #[must_use]
    pub fn field(self, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        let path = column.key.clone();
        self.at(path, column, find)
    }

    /// One more field, which JSON has at `path`.
    #[must_use]
    pub fn at(
        self,
        path: impl Into<String>,
        column: Column,
        find: impl Fn(&T) -> Cell + Send + Sync + 'a,
    ) -> Self {
        self.with(Some(column), Some(path.into()), Box::new(find))
    }

    /// One more entry of JSON alone.
    #[must_use]
    pub fn json(self, path: impl Into<String>, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(None, Some(path.into()), Box::new(find))
    }

    /// One more column of tables alone.
    #[must_use]
    pub fn column(self, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(Some(column), None, Box::new(find))
    }

    /// The columns, in order.
    pub fn columns(&self) -> Vec<Column> {
        self.fields.iter().filter_map(|field| field.column.clone()).collect()
    }

    /// The row of one thing: a cell for each column.
    pub fn row(&self, number: &T) -> Vec<Cell> {
        self.fields.iter().filter(|field| field.column.is_some()).map(|field| (field.find)(number)).collect()
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
        let mut entries = Map::new();
        for field in &self.fields {
            if let Some(path) = &field.path {
                put(&mut entries, path, serde_json::to_value((field.find)(number)).expect("a cell is JSON"));
            }
        }
        entries.into()
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
        let Value::Object(entries) = self.entries(number) else { unreachable!("entries are an object") };
        entries.into_iter().fold(document, |document, (key, value)| document.entry(&key, value))
    }
}
