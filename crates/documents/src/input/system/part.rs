//! The parts of a system file, each as a reader has it and as the schema says it.

use num_traits::ToPrimitive;
use serde_json::Value;

use crate::report::shape::{COUNT, COUNT_WRITTEN, FLAG, QUANTITY, Shape, TEXT};
use number::parse::{parse, parse_rational};
use number::{Error, Laurent, Rational, Result};

/// A part of the file.
pub(super) trait Part {
    /// How people may write it.
    const SHAPE: Shape;
    /// Whether a field of this type has to be there.
    const IS_REQUIRED: bool = true;
}

/// Structs of the file, each field declared once: read by its type, in the schema with its type's shape, or
/// with one behind it in brackets, and with its own words. `#[serde(default)]` fields may be left out.
macro_rules! parts {
    ($(
        $(#[doc = $about:literal])*
        struct $Name:ident {
            $($(#[doc = $says:literal])* $(#[serde($default:ident)])? $field:ident: $type:ty $([$shape:expr])?,)*
        }
    )*) => {$(
        $(#[doc = $about])*
        #[derive(Clone, Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        #[allow(dead_code, reason = "titles and names are read where documents are written")]
        pub(super) struct $Name {
            $($(#[doc = $says])* $(#[serde($default)])? pub $field: $type,)*
        }

        impl $Name {
            pub fn keys() -> crate::report::shape::Keys {
                crate::report::shape::Keys::new()$(.with(
                    stringify!($field),
                    [$($shape,)? <$type as Part>::SHAPE][0],
                    concat!($($says),*).trim(),
                    <$type as Part>::IS_REQUIRED && [$(stringify!($default),)? ""][0].is_empty(),
                ))*
            }
        }

        impl Part for $Name {
            const SHAPE: crate::report::shape::Shape = crate::report::shape::Shape::Object($Name::keys);
        }
    )*};
}
pub(super) use parts;

macro_rules! shapes {
    ($($type:ty: $shape:expr;)*) => {$(impl Part for $type { const SHAPE: Shape = $shape; })*};
}

shapes! {
    String: TEXT;
    bool: FLAG;
    usize: COUNT;
    Number: QUANTITY;
    Index: COUNT;
    Count: COUNT_WRITTEN;
    (Index, Option<Index>, Number): Shape::Row(&[COUNT, Shape::OrNull(&COUNT), QUANTITY]);
}

impl<T: Part> Part for Option<T> {
    const SHAPE: Shape = T::SHAPE;
    const IS_REQUIRED: bool = false;
}

impl<T: Part> Part for Vec<T> {
    const SHAPE: Shape = Shape::List(&T::SHAPE);
}

impl<T: Part> Part for [T; 2] {
    const SHAPE: Shape = Shape::Row(&[T::SHAPE, T::SHAPE]);
}

/// An exact number: a text, or a JSON number, whose digits are taken as they stand. Anything else is kept
/// until a reader can name its field.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(from = "Value")]
pub(super) enum Number {
    Text(String),
    Json(String),
    Other(Value),
}

impl From<Value> for Number {
    fn from(value: Value) -> Self {
        match value {
            Value::String(text) => Number::Text(text),
            Value::Number(number) => Number::Json(number.as_str().into()),
            other => Number::Other(other),
        }
    }
}

impl Number {
    fn text(&self, field: &str) -> Result<&str> {
        match self {
            Number::Text(text) | Number::Json(text) => Ok(text),
            Number::Other(value) => {
                Err(Error::input(field, value, "write an exact number, as \"1/4\" or 0.25"))
            }
        }
    }

    /// As a rational.
    pub fn read(&self, field: &str) -> Result<Rational> {
        parse_rational(field, self.text(field)?)
    }

    /// As an element of ℚ\[π, 1/π\].
    pub fn read_laurent(&self, field: &str) -> Result<Laurent> {
        parse(field, self.text(field)?)
    }
}

/// A number of things.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(transparent)]
pub(super) struct Count(Number);

impl Count {
    /// As a count of at most `most`.
    pub fn read(&self, field: &str, most: usize) -> Result<usize> {
        let value = self.0.read(field)?;
        let count = value.is_integer().then(|| value.to_integer().to_usize()).flatten();
        let remedy = || Error::input(field, &value, format!("write a whole number of at most {most}"));
        count.filter(|&n| n <= most).ok_or_else(remedy)
    }
}

/// A place in a list, counted from 0.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(transparent)]
pub(super) struct Index(Number);

impl Index {
    /// As an index below n.
    pub fn read(&self, field: &str, n: usize) -> Result<usize> {
        let remedy = || format!("indices are 0 to {}", n.max(1) - 1);
        match &self.0 {
            Number::Json(digits) => {
                let index = digits.parse().ok().filter(|&i: &usize| i < n);
                index.ok_or_else(|| Error::input(field, digits, remedy()))
            }
            Number::Text(text) => {
                Err(Error::input(field, text, format!("write an index without quotes; {}", remedy())))
            }
            Number::Other(value) => Err(Error::input(field, value, remedy())),
        }
    }
}
