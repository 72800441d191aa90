//! JSON as people write it: a byte order mark is skipped, a key that stands twice in one object is an error,
//! and values are counted before they are built.

use std::cell::Cell;
use std::collections::HashSet;
use std::fmt;

use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use number::error::{is_like, room};

/// A value of this type, from a text in which no object has a key twice.
///
/// # Errors
/// With line and column: no JSON, a key that stands twice, more values than memory has room for, anything
/// else than the type wants.
pub fn from_str<T: DeserializeOwned>(text: &str) -> serde_json::Result<T> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader = serde_json::Deserializer::from_str(text);
    Once(&Cell::new(0)).deserialize(&mut reader)?;
    reader.end()?;
    serde_json::from_str(text)
}

/// What a value takes where it is read, read again as a rational, and kept: measured, a list of numbers of
/// two bytes each takes 340 times those, and a number counts as three, since its digits are kept.
const BYTES_A_VALUE: u128 = 230;

/// So many values are always built.
const FEW_VALUES: u64 = 1 << 20;

/// One value more, where memory has room for as many again.
fn counted<E: Error>(count: &Cell<u64>) -> Result<(), E> {
    let n = count.get() + 1;
    count.set(n);
    if n < FEW_VALUES || !n.is_power_of_two() {
        return Ok(());
    }
    let fits = room(2 * u128::from(n) * BYTES_A_VALUE, "a smaller file");
    fits.map_err(|error| E::custom(format!("more than {n} values; {error}")))
}

/// What is wrong, in words for people, without the place: "found the number 5 where a list belongs".
pub fn plain(cause: &serde_json::Error) -> String {
    let place = format!(" at line {} column {}", cause.line(), cause.column());
    let words = cause.to_string();
    let words = words.strip_suffix(&place).unwrap_or(&words);
    if cause.is_eof() {
        return "the text ends before its last brace or bracket is closed".into();
    }
    if cause.is_syntax() {
        return format!("no JSON from here on ({words})");
    }
    let found =
        ["invalid type: ", "invalid value: ", "invalid "].iter().find_map(|text| words.strip_prefix(text));
    if let Some((found, wanted)) = found.and_then(|found| found.split_once(", expected ")) {
        return format!("found {} where {} belongs", noun(found), noun(wanted));
    }
    match words.split_once(", expected ") {
        Some((unknown, known)) => {
            let known = known.strip_prefix("one of ").unwrap_or(known);
            let given = unknown.split('`').nth(1).unwrap_or_default();
            match known.split('`').skip(1).step_by(2).find(|name| is_like(given, name)) {
                Some(name) => format!("{unknown}; did you mean `{name}`?"),
                None => format!("{unknown}; known here: {known}"),
            }
        }
        None => words.into(),
    }
}

/// What serde calls a part of a document, as JSON calls it.
fn noun(name: &str) -> String {
    let pairs = [
        ("a tuple of size ", "a list of "),
        ("an array of length ", "a list of "),
        ("length ", "a list of "),
        ("string ", "the text "),
        ("integer ", "the number "),
        ("floating point ", "the number "),
        ("boolean ", ""),
    ];
    match name {
        "a sequence" | "sequence" => "a list".into(),
        "a string" => "a text".into(),
        "a map" | "map" => "an object".into(),
        "a boolean" => "true or false".into(),
        "null" | "unit value" => "null".into(),
        "f64" | "f32" => "a number".into(),
        "u8" | "u16" | "u32" | "u64" | "u128" | "usize" => "a whole number, 0 or more,".into(),
        "i8" | "i16" | "i32" | "i64" | "i128" | "isize" => "a whole number".into(),
        _ if name.starts_with("struct ") => "an object".into(),
        _ => {
            let renamed =
                pairs.iter().find_map(|(serde, json)| Some(format!("{json}{}", name.strip_prefix(serde)?)));
            renamed.unwrap_or_else(|| name.into()).replace('`', "")
        }
    }
}

/// Any value whose objects have each key once; how many there were before it.
#[derive(Clone, Copy)]
struct Once<'a>(&'a Cell<u64>);

impl<'de> DeserializeSeed<'de> for Once<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        counted(self.0)?;
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Once<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut all: A) -> Result<(), A::Error> {
        while all.next_element_seed(self)?.is_some() {}
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut all: A) -> Result<(), A::Error> {
        let mut seen = HashSet::new();
        while let Some(key) = all.next_key::<String>()? {
            if seen.contains(&key) {
                return Err(A::Error::custom(format!("the key \"{key}\" stands twice in one object")));
            }
            seen.insert(key);
            counted(self.0)?;
            all.next_value_seed(self)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    #[test]
    fn a_key_that_stands_twice_is_named_with_its_place() {
        let read = from_str::<Value>;
        assert_eq!(read("\u{feff}{\"a\": [1.5, -2, true, null, {\"a\": 1e400}]}").unwrap()["a"][1], -2);
        let message = read("{\"a\": 1,\n \"b\": [{\"c\": 1, \"c\": 2}]}").unwrap_err();
        assert!(
            message.to_string().starts_with("the key \"c\" stands twice in one object at line 2"),
            "{message}"
        );
        assert!(read("{\"a\": 1, \"\\u0061\": 1}").is_err() && read("{} {}").is_err());
    }

    #[test]
    fn values_are_counted_before_they_are_built() {
        let count = Cell::new(0);
        Once(&count)
            .deserialize(&mut serde_json::Deserializer::from_str("[true, [null], {\"a\": \"b\"}]"))
            .unwrap();
        assert_eq!(count.get(), 7);
        assert!(counted::<serde_json::Error>(&Cell::new((1 << 62) - 1)).is_err());
        assert!(counted::<serde_json::Error>(&Cell::new(FEW_VALUES - 2)).is_ok());
    }

    #[test]
    fn what_is_wrong_is_said_in_words_of_json() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Small {
            #[allow(dead_code)]
            list: Vec<[u8; 2]>,
            #[allow(dead_code)]
            name: Option<String>,
        }
        let wrong = |text: &str| plain(&from_str::<Small>(text).unwrap_err());
        assert_eq!(wrong("{\"list\": 5}"), "found the number 5 where a list belongs");
        assert_eq!(wrong("{\"list\": [\"a\"]}"), "found the text \"a\" where a list of 2 belongs");
        assert_eq!(wrong("{\"list\": [[1]]}"), "found a list of 1 where a list of 2 belongs");
        let number = from_str::<f64>("\"a\"").map_err(|cause| plain(&cause)).unwrap_err();
        assert_eq!(number, "found the text \"a\" where a number belongs");
        let whole = from_str::<u64>("1.5").map_err(|cause| plain(&cause)).unwrap_err();
        assert_eq!(whole, "found the number 1.5 where a whole number, 0 or more, belongs");
        assert_eq!(wrong("{\"list\": [], \"name\": [1]}"), "found a list where a text belongs");
        assert_eq!(wrong("{\"lists\": []}"), "unknown field `lists`; did you mean `list`?");
        assert_eq!(wrong("{\"other\": []}"), "unknown field `other`; known here: `list` or `name`");
        assert_eq!(wrong("{}"), "missing field `list`");
        assert_eq!(wrong("{\"list\": ["), "the text ends before its last brace or bracket is closed");
        assert!(wrong("{\"list\": x}").starts_with("no JSON from here on"));
    }
}
