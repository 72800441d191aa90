//! What is written of one thing: named, typed cells, from which its JSON entries, its row of CSV and LaTeX and its line of
//! text all come.

use serde_json::{Map, Value};

use super::document::Document;
use super::table::{Cell, Column, Table};

/// How the cell of one column is found in a `T`.
type Find<'a, T> = Box<dyn Fn(&T) -> Cell + Send + Sync + 'a>;

/// Where a cell stands in a JSON document: among its entries, in an object among them, or echoed as input.
enum Place {
    Entry,
    Inside(&'static str),
    Input,
}

/// The columns that are written of a `T`, each with the way to its cell.
///
/// ```
/// use kickdrift::report::record::Record;
/// use kickdrift::report::table::Column;
/// let squares = Record::new()
///     .field(Column::math("n", "n"), |n: &u64| (*n).into())
///     .field(Column::math("square", "n^2"), |n| (n * n).into());
/// let table = squares.table("squares", "The first squares", &[1, 2]);
/// assert_eq!(kickdrift::report::csv::document(&table), "n,square\r\n1,1\r\n2,4\r\n");
/// assert_eq!(squares.json(&3).to_string(), r#"{"n":3,"square":9}"#);
/// ```
pub struct Record<'a, T> {
    fields: Vec<(Column, Place, Find<'a, T>)>,
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

    fn with(mut self, column: Column, place: Place, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.fields.push((column, place, Box::new(find)));
        self
    }

    /// One more field.
    #[must_use]
    pub fn field(self, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(column, Place::Entry, find)
    }

    /// One more field, which JSON has inside the object `group`; an object without any value is null.
    #[must_use]
    pub fn field_in(
        self,
        group: &'static str,
        column: Column,
        find: impl Fn(&T) -> Cell + Send + Sync + 'a,
    ) -> Self {
        self.with(column, Place::Inside(group), find)
    }

    /// One more field, an exact number, which JSON has as input.
    #[must_use]
    pub fn input(self, column: Column, find: impl Fn(&T) -> Cell + Send + Sync + 'a) -> Self {
        self.with(column, Place::Input, find)
    }

    /// The columns, in order.
    pub fn columns(&self) -> Vec<Column> {
        self.fields.iter().map(|(column, ..)| column.clone()).collect()
    }

    /// The row of one thing: a cell for each column.
    pub fn row(&self, of: &T) -> Vec<Cell> {
        self.fields.iter().map(|(_, _, find)| find(of)).collect()
    }

    /// The rows of many things.
    pub fn table<'b>(&self, name: &str, caption: &str, all: impl IntoIterator<Item = &'b T>) -> Table
    where
        T: 'b,
    {
        let mut table = Table::new(name, caption, self.columns());
        all.into_iter().for_each(|of| table.push(self.row(of)));
        table
    }

    /// The entries of one thing, as in JSON; what is echoed as input is not among them.
    pub fn json(&self, of: &T) -> Value {
        let mut entries = Map::new();
        for (column, place, find) in &self.fields {
            let value = serde_json::to_value(find(of)).expect("a cell is JSON");
            match place {
                Place::Input => {}
                Place::Entry => drop(entries.insert(column.key.clone(), value)),
                Place::Inside(group) => {
                    let group = entries.entry(*group).or_insert(Value::Null);
                    if !value.is_null() && group.is_null() {
                        *group = Map::new().into();
                    }
                    if let Value::Object(inside) = group {
                        inside.insert(column.key.clone(), value);
                    }
                }
            }
        }
        entries.into()
    }

    /// Echoes the inputs of one thing into a document and adds its entries.
    pub fn document(&self, mut document: Document, of: &T) -> Document {
        for (column, place, find) in &self.fields {
            if let (Place::Input, Cell::Exact(text)) = (place, find(of)) {
                document = document.input(&column.key, text);
            }
        }
        let Value::Object(entries) = self.json(of) else { unreachable!("entries are an object") };
        entries.into_iter().fold(document, |document, (key, value)| document.entry(&key, value))
    }
}
