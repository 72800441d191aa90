//! A document's values against those computed again.

use serde_json::{Map, Value};

use crate::recheck::context::{Checked, Fault, holds};

/// Keys that say who wrote it and from what.
const HEAD: [&str; 3] = ["schema", "kickdrift", "input"];

/// That all values are the same; the first that is not is named by its path.
pub fn same_values(told: &Map<String, Value>, again: &Value) -> Checked {
    let again = again.as_object().expect("a document is an object");
    let body = |all: &Map<String, Value>| {
        Value::Object(
            all.iter()
                .filter(|(key, _)| !HEAD.contains(&key.as_str()))
                .map(|(k, v)| (k.clone(), v.clone()))
                .collect(),
        )
    };
    compare("", &body(told), &body(again))
}

fn compare(path: &str, told: &Value, again: &Value) -> Checked {
    match (told, again) {
        (Value::Object(a), Value::Object(b)) => {
            let extra = a.keys().find(|key| !b.contains_key(*key));
            holds(extra.is_none(), || format!("{path}{} does not belong there", extra.unwrap()))?;
            b.iter().try_for_each(|(key, again)| {
                let told = a.get(key).ok_or_else(|| Fault::Wrong(format!("{path}{key} is missing")))?;
                compare(&format!("{path}{key}."), told, again)
            })
        }
        (Value::Array(a), Value::Array(b)) => {
            holds(a.len() == b.len(), || format!("{path} has {} entries, not {}", b.len(), a.len()))?;
            (0..).zip(a).zip(b).try_for_each(|((i, a), b)| compare(&format!("{path}{i}."), a, b))
        }
        // Numbers by their value: 1 and 1.0 are the same.
        (Value::Number(a), Value::Number(b)) if a.as_f64() == b.as_f64() => Ok(()),
        _ => holds(told == again, || format!("{} is {again}, not {told}", path.trim_end_matches('.'))),
    }
}
