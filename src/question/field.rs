//! Exact values as texts: how the fields of a question are read and written.

use serde_json::{Map, Value};

use crate::error::{Error, Result};
use crate::number::parse::{
    parse, parse_integer_range, parse_range, parse_ratio, parse_rational, parse_rational_range,
};
use crate::number::{Laurent, Ratio, Rational};
use crate::scene::shown_range;
use crate::tongue::Labels;

/// A value that is written as a text, exactly.
pub trait Notation: Sized {
    /// Reads what [`Notation::written`] writes, and whatever else a person may type.
    ///
    /// # Errors
    /// Another text, named by the field.
    fn parsed(field: &str, text: &str) -> Result<Self>;

    /// The text; `None` where nothing is to be written.
    fn written(&self) -> Option<String>;
}

macro_rules! notation {
    ($($type:ty: $parse:expr, $show:expr;)*) => {
        $(
            impl Notation for $type {
                fn parsed(field: &str, text: &str) -> Result<Self> {
                    $parse(field, text)
                }

                fn written(&self) -> Option<String> {
                    $show(self)
                }
            }

            impl Field for $type {
                fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
                    given.map(|value| parsed(name, value))
                }

                fn shown(&self) -> Option<String> {
                    self.written()
                }
            }
        )*
    };
}

notation! {
    Rational: parse_rational, plain;
    Laurent: parse, plain;
    Ratio: parse_ratio, plain;
    (Laurent, Laurent): parse_range, |range| Some(shown_range(range));
    (Rational, Rational): parse_rational_range, |range| Some(shown_range(range));
    (i64, i64): parse_integer_range, |range| Some(shown_range(range));
    u64: whole, plain;
    u32: whole, plain;
    usize: whole, plain;
    Labels: |_, text: &str| text.parse(), plain;
}

/// A flag, which is not there where it is not set.
impl Field for bool {
    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        Some(match given {
            None | Some(Value::Bool(false)) => Ok(false),
            Some(Value::Bool(true)) => Ok(true),
            Some(Value::String(text)) if text == "true" => Ok(true),
            Some(other) => Err(Error::input(name, other, "is \"true\", or is not there")),
        })
    }

    fn shown(&self) -> Option<String> {
        self.then(|| "true".into())
    }
}

fn plain(value: &impl ToString) -> Option<String> {
    Some(value.to_string())
}

fn whole<T: TryFrom<u64>>(field: &str, text: &str) -> Result<T> {
    let refused = |remedy| Error::input(field, text, remedy);
    let number: u64 =
        text.parse().map_err(|_| refused("write a whole number, in digits only, within 64 bits"))?;
    T::try_from(number).map_err(|_| refused("choose a smaller number"))
}

/// A parser of an argument, whose flag names the field.
pub fn flag<T: Notation>(text: &str) -> std::result::Result<T, String> {
    T::parsed("value", text).map_err(|error| error.remedy().to_string())
}

/// A field of a question: a value, an option of one, or a flag.
pub trait Field: Sized {
    /// What is given; `None` where something has to be.
    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>>;

    /// The text that documents echo; `None` where the field is not to be there.
    fn shown(&self) -> Option<String>;
}

impl<T: Notation> Field for Option<T> {
    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        Some(given.map(|value| parsed(name, value)).transpose())
    }

    fn shown(&self) -> Option<String> {
        self.as_ref()?.written()
    }
}

/// A value: a text, or a number of JSON by its digits.
fn parsed<T: Notation>(name: &str, value: &Value) -> Result<T> {
    match value {
        Value::String(text) => T::parsed(name, text),
        Value::Number(number) => T::parsed(name, &number.to_string()),
        other => Err(Error::input(name, other, "write an exact number or range as a text, as \"1/3\"")),
    }
}

/// A field, or its default.
pub fn read<T: Field>(name: &str, from: &Map<String, Value>, default: Option<&str>) -> Result<T> {
    let default = default.map(Value::from);
    let own = T::of(from.get(name).or(default.as_ref()), name);
    own.unwrap_or_else(|| Err(Error::missing(name, "the question needs it")))
}

/// That all fields are among those known.
pub fn known(input: &Map<String, Value>, fields: &[&str]) -> Result<()> {
    match input.keys().find(|name| !fields.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => {
            let remedy = format!("is no field of this question: there are {}", fields.join(", "));
            Err(Error::input(name, "given", remedy))
        }
    }
}
