//! Exact values as texts: how the fields of a question are read and written.

use num_traits::ToPrimitive;
use serde_json::{Map, Value};

use crate::report::shape::{
    EXACT, INTEGERS, RANGE, RATIO, RATIONAL, RATIONAL_RANGE, SET, Shape, TEXT, WHOLE,
};
use clocks::map::Shard;
use clocks::tongue::Labels;
use number::parse::{
    parse, parse_integer_range, parse_range, parse_ratio, parse_rational, parse_rational_range,
};
use number::{Error, Laurent, Ratio, Rational, Result, to_f64};

/// Labels of tongues as a text.
const LABELS: Shape = Shape::Plain(r#"{"type": "string", "pattern": "^[0-9.,]+$"}"#);

/// A closed range of steps.
pub type StepRange = (Laurent, Laurent);

/// A closed range as it is written, exactly.
pub fn shown_range<T: std::fmt::Display>((lo, hi): &(T, T)) -> String {
    format!("{lo}..{hi}")
}

/// A value that is written as a text, exactly: in a question, and in documents.
pub trait Notation: Sized {
    /// Reads what is written, and whatever else a person may type.
    ///
    /// # Errors
    /// Another text, named by the field.
    fn parsed(field: &str, text: &str) -> Result<Self>;
}

macro_rules! notation {
    ($($type:ty: $parse:expr, $show:expr $(, $shape:expr)?;)*) => {
        $(
            impl $crate::question::Notation for $type {
                fn parsed(field: &str, text: &str) -> number::error::Result<Self> {
                    $parse(field, text)
                }
            }

            impl $crate::question::field::Flag for $type {
                type Value = Self;
            }

            impl $crate::question::field::Field for $type {
                $(const SHAPE: $crate::report::shape::Shape = $shape;)?

                fn of(given: Option<&serde_json::Value>, name: &str) -> Option<number::error::Result<Self>> {
                    given.map(|value| $crate::question::field::parsed(name, value))
                }

                fn shown(&self) -> Option<serde_json::Value> {
                    Some($show(self).into())
                }
            }
        )*
    };
}
pub(super) use notation;

notation! {
    Rational: parse_rational, ToString::to_string, RATIONAL;
    Laurent: parse, ToString::to_string, EXACT;
    Ratio: parse_ratio, ToString::to_string, RATIO;
    (Laurent, Laurent): parse_range, shown_range, RANGE;
    (Rational, Rational): parse_rational_range, shown_range, RATIONAL_RANGE;
    (i64, i64): parse_integer_range, shown_range, INTEGERS;
    u64: whole, ToString::to_string, WHOLE;
    u32: whole, ToString::to_string, WHOLE;
    usize: whole, ToString::to_string, WHOLE;
    Labels: |_, text: &str| text.parse(), ToString::to_string, LABELS;
    Shard: |_, text: &str| text.parse(), ToString::to_string, RATIO;
    f64: |field: &str, text: &str| Ok(to_f64(&parse_rational(field, text)?)), ToString::to_string;
    String: |_, text: &str| Ok(text.to_string()), String::clone;
}

/// A flag, which is not there where it is not set.
impl Field for bool {
    const SHAPE: Shape = SET;
    const IS_REQUIRED: bool = false;

    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        Some(match given {
            None | Some(Value::Bool(false)) => Ok(false),
            Some(Value::Bool(true)) => Ok(true),
            Some(Value::String(text)) if text == "true" => Ok(true),
            Some(other) => Err(Error::input(name, other, "is \"true\", or is not there")),
        })
    }

    fn shown(&self) -> Option<Value> {
        self.then(|| "true".into())
    }
}

fn whole<T: TryFrom<u64>>(field: &str, text: &str) -> Result<T> {
    let refused = |remedy| Error::input(field, text, remedy);
    let number = parse_rational(field, text)?;
    let number = if number.is_integer() { number.numer().to_u64() } else { None };
    let number = number.ok_or_else(|| refused("write a whole number, 0 or more, within 64 bits"))?;
    T::try_from(number).map_err(|_| refused("choose a smaller number"))
}

/// A parser of an argument, whose flag names the field.
pub fn flag<T: Notation>(text: &str) -> std::result::Result<T, String> {
    T::parsed("value", text).map_err(|error| error.remedy().to_string())
}

/// A field that is written behind a flag: a value, or an option of one.
pub trait Flag {
    /// What is written.
    type Value: Notation;
}

impl<T: Flag> Flag for Option<T> {
    type Value = T::Value;
}

/// A field of a question: a value, an option of one, or a flag.
pub trait Field: Sized {
    /// What documents hold of it.
    const SHAPE: Shape = TEXT;
    /// Whether every document echoes it.
    const IS_REQUIRED: bool = true;

    /// Reads the value that is given; `None` where a value is missing that has to be there.
    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>>;

    /// The value that documents echo, as a rule a text; `None` where the field is left out.
    fn shown(&self) -> Option<Value>;
}

impl<T: Field> Field for Option<T> {
    const SHAPE: Shape = T::SHAPE;
    const IS_REQUIRED: bool = false;

    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        match given {
            None => Some(Ok(None)),
            Some(_) => T::of(given, name).map(|number| number.map(Some)),
        }
    }

    fn shown(&self) -> Option<Value> {
        self.as_ref()?.shown()
    }
}

/// A value: a text, or a number of JSON by its digits.
pub(super) fn parsed<T: Notation>(name: &str, value: &Value) -> Result<T> {
    match value {
        Value::String(text) => T::parsed(name, text),
        Value::Number(number) => T::parsed(name, &number.to_string()),
        other => Err(Error::input(name, other, "write a number, or a text as \"pi^2/25\"")),
    }
}

/// A field, or its default.
pub fn read<T: Field>(name: &str, from: &Map<String, Value>, default: Option<&str>) -> Result<T> {
    let default = default.map(Value::from);
    let number = T::of(from.get(name).or(default.as_ref()), name);
    number.unwrap_or_else(|| Err(Error::missing(name, NEEDED)))
}

/// The remedy where a field is missing; the program names its flag instead.
pub const NEEDED: &str = "the question needs it: add it";

/// The first of a field's names that is given, or its own.
pub fn name<'a>(names: &[&'a str], from: &Map<String, Value>) -> &'a str {
    names.iter().find(|name| from.contains_key(**name)).unwrap_or(&names[0])
}

/// That all fields are among those known, by their own or by other names.
pub fn known(input: &Map<String, Value>, fields: &[&str], others: &[&[&str]]) -> Result<()> {
    let is_known = |name: &str| fields.contains(&name) || others.iter().any(|others| others.contains(&name));
    match input.keys().find(|name| !is_known(name)) {
        None => Ok(()),
        Some(name) => {
            let remedy = format!("is no field of this question: there are {}", fields.join(", "));
            Err(Error::input(name, "given", remedy))
        }
    }
}
