//! A document held, value by value, against the same document computed again from its input.
//!
//! One input gives one document, digit by digit, so whatever was changed afterwards differs. Values that the
//! input does not determine are [`Excluded`], and only those: what a check names as not rechecked follows
//! from this comparison.

use serde_json::{Map, Value};

use super::context::Failure;

/// A value that the input does not determine: its path (`*` stands for every row), and why.
pub type Excluded = (&'static str, &'static str);

/// The result of a comparison.
pub struct Compared {
    /// One for every row that differs, then one for each part of the rest that does.
    pub failures: Vec<Failure>,
    /// The values excluded that the document has.
    pub excluded: Vec<String>,
}

/// Compares a document with the one computed again; `table` is the key of its rows. In its input only the
/// fields that `again` echoes are compared.
pub fn compare(written: &Map<String, Value>, again: Value, table: &str, excluded: &[Excluded]) -> Compared {
    let (mut written, mut again) = (Value::Object(written.clone()), again);
    let version = ("kickdrift.version", "which version wrote it is no claim");
    let mut named = Vec::new();
    for (path, why) in [version].iter().chain(excluded) {
        let steps: Vec<&str> = path.split('.').collect();
        let met = take(&mut written, &steps);
        take(&mut again, &steps);
        named.extend(met.then(|| format!("{path}: {why}")));
    }
    if let (Some(written), Some(again)) = (written["input"].as_object_mut(), again["input"].as_object()) {
        written.retain(|key, _| again.contains_key(key));
    }
    let rows =
        |whole: &mut Value| whole.as_object_mut().and_then(|as_object_mut| as_object_mut.shift_remove(table));
    let (value, truth) = (rows(&mut written), rows(&mut again));
    let mut failures = match (&value, &truth) {
        (Some(Value::Array(values)), Some(Value::Array(truth))) => rows_apart(table, values, truth),
        _ => different(value.as_ref(), truth.as_ref())
            .map(|different| different.of(0, table))
            .into_iter()
            .collect(),
    };
    // A document without rows is one row itself.
    let row = u64::from(table.is_empty());
    failures.extend(parts_apart(&written, &again, row));
    Compared { failures, excluded: named }
}

/// Takes out what lies at a path, and says whether something did.
fn take(value: &mut Value, path: &[&str]) -> bool {
    match (path, value) {
        ([last], Value::Object(object)) => object.shift_remove(*last).is_some(),
        (["*", rest @ ..], Value::Array(items)) => {
            items.iter_mut().filter_map(|item| take(item, rest).then_some(())).count() > 0
        }
        ([first, rest @ ..], Value::Object(object)) => {
            object.get_mut(*first).is_some_and(|get_mut| take(get_mut, rest))
        }
        _ => false,
    }
}

fn rows_apart(table: &str, written: &[Value], again: &[Value]) -> Vec<Failure> {
    let apart = (1..).zip(written.iter().zip(again)).filter_map(|(row, (written, again))| {
        different(Some(written), Some(again))
            .map(|different| different.of(row, &written.as_object().map(place).unwrap_or_default()))
    });
    let count = (written.len() != again.len()).then(|| {
        let why = format!("{table} has {} rows, not {}", again.len(), written.len());
        Failure { row: written.len().min(again.len()) as u64 + 1, place: table.into(), why }
    });
    apart.chain(count).collect()
}

/// The parts of a document beside its rows, one by one.
fn parts_apart(written: &Value, again: &Value, row: u64) -> Vec<Failure> {
    let (Value::Object(a), Value::Object(b)) = (written, again) else { return Vec::new() };
    let keys = b.keys().chain(a.keys().filter(|key| !b.contains_key(*key)));
    let apart = keys.filter_map(|key| {
        let place = if row == 0 { key.clone() } else { place(a) };
        different(a.get(key), b.get(key)).map(|different| different.below(key).of(row, &place))
    });
    apart.collect()
}

/// The first plain values of a row, which name it: `p = 7, q = 3, m = 4`.
pub fn place(row: &Map<String, Value>) -> String {
    const NAMES: usize = 3;
    let head = ["schema", "kickdrift", "input"];
    let values = row.iter().filter(|(key, _)| !head.contains(&key.as_str()));
    let plain = values.take_while(|(_, value)| value.is_string() || value.is_i64() || value.is_u64());
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), String::from);
    let named: Vec<String> =
        plain.take(NAMES).map(|(key, value)| format!("{key} = {}", text(value))).collect();
    named.join(", ")
}

/// The first difference: where, from the inside out, and what it is.
struct Different {
    path: Vec<String>,
    why: String,
}

impl Different {
    fn below(mut self, key: impl ToString) -> Different {
        self.path.push(key.to_string());
        self
    }

    fn of(self, row: u64, place: &str) -> Failure {
        let path: Vec<&str> = self.path.iter().rev().map(String::as_str).collect();
        let why = format!("{} {}", path.join("."), self.why);
        Failure { row, place: place.into(), why: why.trim_start().into() }
    }
}

fn different(written: Option<&Value>, again: Option<&Value>) -> Option<Different> {
    let here = |why: String| Some(Different { path: Vec::new(), why });
    match (written, again) {
        (None, None) => None,
        (None, Some(_)) => here("is missing".into()),
        (Some(_), None) => here("does not belong there".into()),
        (Some(Value::Object(a)), Some(Value::Object(b))) => {
            let keys = b.keys().chain(a.keys().filter(|key| !b.contains_key(*key)));
            keys.into_iter().find_map(|key| Some(different(a.get(key), b.get(key))?.below(key)))
        }
        (Some(Value::Array(a)), Some(Value::Array(b))) => {
            let longest = a.len().max(b.len());
            (0..longest).find_map(|i| Some(different(a.get(i), b.get(i))?.below(i)))
        }
        (Some(a), Some(b)) if same(a, b) => None,
        (Some(a), Some(b)) => here(format!("is {}, not {}", short(b), short(a))),
    }
}

/// Numbers by their value, since 1 and 1.0 are the same; whole ones by all of their digits.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => match (x.as_i128(), y.as_i128()) {
            (Some(x), Some(y)) => x == y,
            _ => x.as_f64().is_some() && x.as_f64() == y.as_f64(),
        },
        _ => a == b,
    }
}

/// So many characters show what a value is.
const SHOWN: usize = 80;

fn short(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
