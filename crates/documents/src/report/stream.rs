//! JSON documents with more rows than memory should hold: written row by row, in the shape that
//! [`Document`] gives them.

use std::fmt::Display;
use std::io::Write;

use serde_json::{Map, Value};

use super::document::Document;
use number::{Error, Result};

/// A document on its way out; its rows come between what is known before them and what is known after.
pub struct JsonRows<'a> {
    sink: &'a mut dyn Write,
    empty: bool,
}

impl<'a> JsonRows<'a> {
    /// Writes schema, input and entries of `head`, and opens the rows under `key`.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn begin(sink: &'a mut dyn Write, head: &Document, key: &str) -> Result<Self> {
        let Value::Object(head) = head.value() else { unreachable!("a document is an object") };
        let mut rows = JsonRows { sink, empty: true };
        rows.put("{")?;
        for (name, value) in &head {
            rows.put(format_args!("\n  {}: {value},", Value::from(name.as_str())))?;
        }
        rows.put(format_args!("\n  {}: [", Value::from(key)))?;
        Ok(rows)
    }

    /// Writes one row, already JSON.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn row(&mut self, json: &str) -> Result<()> {
        self.put(if self.empty { "\n    " } else { ",\n    " })?;
        self.empty = false;
        self.put(json)
    }

    /// Closes the rows, writes the entries that were known last, and closes the document.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn end(mut self, entries: &Map<String, Value>) -> Result<()> {
        self.put(if self.empty { "]" } else { "\n  ]" })?;
        for (name, value) in entries {
            self.put(format_args!(",\n  {}: {value}", Value::from(name.as_str())))?;
        }
        self.put("\n}\n")
    }

    fn put(&mut self, text: impl Display) -> Result<()> {
        write!(self.sink, "{text}").map_err(Error::stream)
    }
}
