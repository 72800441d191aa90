//! JSON documents with more rows than memory should hold: written row by row, in the shape that
//! [`Document`] gives them.

use std::io::{self, Write};

use serde_json::Value;

use super::document::Document;

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
    pub fn begin(sink: &'a mut dyn Write, head: &Document, key: &str) -> io::Result<Self> {
        let Value::Object(head) = head.value() else { unreachable!("a document is an object") };
        sink.write_all(b"{")?;
        for (name, value) in &head {
            write!(sink, "\n  {}: {value},", Value::from(name.as_str()))?;
        }
        write!(sink, "\n  {}: [", Value::from(key))?;
        Ok(JsonRows { sink, empty: true })
    }

    /// Writes one row, already JSON.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn row(&mut self, json: &str) -> io::Result<()> {
        let before = if self.empty { "\n    " } else { ",\n    " };
        self.empty = false;
        self.sink.write_all(before.as_bytes())?;
        self.sink.write_all(json.as_bytes())
    }

    /// Closes the rows, writes the entries that were known last, and closes the document.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn end(self, entries: &[(&str, Value)]) -> io::Result<()> {
        self.sink.write_all(if self.empty { b"]" } else { b"\n  ]" })?;
        for (name, value) in entries {
            write!(self.sink, ",\n  {}: {value}", Value::from(*name))?;
        }
        self.sink.write_all(b"\n}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::document::Format;
    use serde_json::json;

    #[test]
    fn the_bytes_are_those_of_a_document() {
        for rows in [vec![json!({"p": 1}), json!({"p": 2, "lower": {"lo": 0.5, "hi": 0.5}})], vec![]] {
            let head = || Document::new("tongues").input("rho", "1/25");
            let mut streamed = Vec::new();
            let mut out = JsonRows::begin(&mut streamed, &head(), "tongues").unwrap();
            rows.iter().for_each(|row| out.row(&row.to_string()).unwrap());
            out.end(&[("count", rows.len().into())]).unwrap();
            let whole = head().entry("tongues", rows.clone()).entry("count", rows.len());
            assert_eq!(String::from_utf8(streamed).unwrap(), whole.render(Format::Json).unwrap());
        }
    }
}
