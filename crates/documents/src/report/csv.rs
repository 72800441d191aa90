//! Comma-separated values after RFC 4180: lines end in CR LF, and a field with a comma, a quote or a line
//! break stands in quotes.
//!
//! Floats are the shortest text that reads back as the same double. A column of enclosures becomes two,
//! `KEY_lo` and `KEY_hi`; an exact value in it stands in both, being its own enclosure.

use std::borrow::Cow;
use std::io::Write;

use super::table::{Cell, Column, Table, check};
use number::{Error, Result};

/// The end of a line as the RFC has it.
const LINE_END: &str = "\r\n";

/// The whole table as one text.
pub fn document(table: &Table) -> String {
    let mut bytes = Vec::new();
    let rows = table.rows().iter().map(Vec::as_slice);
    let written = write_header(&mut bytes, table.columns())
        .and_then(|()| write_rows(&mut bytes, table.columns(), rows));
    written.expect("writing to memory does not fail");
    String::from_utf8(bytes).expect("the fields are text")
}

/// The header alone, for rows that come later.
///
/// # Errors
/// Those of `sink`.
pub fn write_header(sink: &mut dyn Write, columns: &[Column]) -> Result<()> {
    let mut line = String::new();
    for column in columns {
        let key = &column.key;
        if column.enclosed {
            put(&mut line, &format!("{key}_lo"));
            put(&mut line, &format!("{key}_hi"));
        } else {
            put(&mut line, key);
        }
    }
    finish(sink, &mut line)
}

/// Rows without a header, one after the other: memory does not grow with their number.
///
/// # Errors
/// Those of `sink`.
///
/// # Panics
/// If a row does not fit the columns, as in [`Table::push`].
pub fn write_rows<R: AsRef<[Cell]>>(
    sink: &mut dyn Write,
    columns: &[Column],
    rows: impl IntoIterator<Item = R>,
) -> Result<()> {
    let mut line = String::new();
    for row in rows {
        check(columns, row.as_ref());
        for (column, cell) in columns.iter().zip(row.as_ref()) {
            put_cell(&mut line, column.enclosed, cell);
        }
        finish(sink, &mut line)?;
    }
    Ok(())
}

fn put_cell(line: &mut String, enclosed: bool, cell: &Cell) {
    let single: Cow<str> = match cell {
        Cell::Enclosure { lo, hi } => {
            put(line, &format!("{lo:?}"));
            return put(line, &format!("{hi:?}"));
        }
        Cell::Exact(text) | Cell::Decimal(text) | Cell::Text(text) => text.into(),
        Cell::Float(value) => format!("{value:?}").into(),
        Cell::Integer(value) => value.to_string().into(),
        Cell::Flag(value) => value.to_string().into(),
        Cell::Missing => "".into(),
    };
    put(line, &single);
    if enclosed {
        put(line, &single);
    }
}

/// Appends a field and the comma after it.
fn put(line: &mut String, field: &str) {
    if field.contains(['"', ',', '\r', '\n']) {
        line.push('"');
        line.push_str(&field.replace('"', "\"\""));
        line.push('"');
    } else {
        line.push_str(field);
    }
    line.push(',');
}

/// Ends the line in place of its last comma and hands it over.
fn finish(sink: &mut dyn Write, line: &mut String) -> Result<()> {
    line.pop();
    line.push_str(LINE_END);
    sink.write_all(line.as_bytes()).map_err(Error::stream)?;
    line.clear();
    Ok(())
}
