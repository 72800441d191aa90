//! Lists of tables in TOML, as `[[word]]`: each value as the text that was written, each key with its line.

use std::collections::BTreeMap;

use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use number::{Error, Result};

/// One table of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its values as texts: a number by its digits, `true` or `false`.
    pub fields: Map<String, Value>,
    /// Where its first key stands.
    first: Place,
    lines: BTreeMap<String, Place>,
}

/// A line of a file, as compilers write it: FILE:LINE.
type Place = String;

impl Entry {
    /// Where a key stands, as FILE:LINE; the first one where the key is not there.
    pub fn place(&self, key: &str) -> &str {
        self.lines.get(key).unwrap_or(&self.first)
    }

    /// The same error, about a field of this entry, with the field's place.
    pub fn locate(&self, error: Error) -> Error {
        let place = format!("{}: {}", self.place(error.field()), error.field());
        error.at(place)
    }
}

/// The tables `[[name]]` of a file, in their order; there is at least one, and nothing beside them.
///
/// # Errors
/// A text that is no TOML, another key or table, a list or a time as a value: each with file and line.
pub fn tables(file: &str, text: &str, name: &str) -> Result<Vec<Entry>> {
    let line = |at: usize| text.as_bytes()[..at.min(text.len())].iter().filter(|c| **c == b'\n').count() + 1;
    let place = |at: usize| format!("{file}:{}", line(at));
    let document = DeTable::parse(text).map_err(|cause| {
        let at = cause.span().map_or(0, |span| span.start);
        Error::io(place(at), format!("this is no TOML ({}): write lines such as order = 4", cause.message()))
    })?;
    let document = document.into_inner();
    let heading = format!("write [[{name}]] above the lines of each");
    if let Some(other) = document.keys().find(|key| key.get_ref() != name) {
        let field = format!("{}: key", place(other.span().start));
        return Err(Error::input(&field, other.get_ref(), format!("is no part of a {name}: {heading}")));
    }
    let all = document.into_iter().next().ok_or_else(|| Error::input(file, "empty", &heading))?.1;
    let at = all.span().start;
    let refused = Error::input(&format!("{}: key", place(at)), name, &heading);
    let DeValue::Array(all) = all.into_inner() else { return Err(refused) };
    all.into_iter()
        .map(|table| {
            let start = table.span().start;
            let DeValue::Table(table) = table.into_inner() else { return Err(refused.clone()) };
            let mut entry = Entry { fields: Map::new(), first: place(start), lines: BTreeMap::new() };
            for (key, value) in table {
                let (place, key) = (place(key.span().start), key.into_inner().into_owned());
                entry.fields.insert(key.clone(), written(&place, &key, value)?);
                entry.lines.insert(key, place);
            }
            Ok(entry)
        })
        .collect()
}

/// The text of a value.
fn written(place: &str, key: &str, value: Spanned<DeValue>) -> Result<Value> {
    Ok(Value::String(match value.into_inner() {
        DeValue::String(text) => text.into_owned(),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.as_str().to_string(),
        DeValue::Boolean(flag) => flag.to_string(),
        other => {
            let remedy = "write a number, true, false or a text in quotes";
            return Err(Error::input(&format!("{place}: {key}"), other.type_str(), remedy));
        }
    }))
}
