//! The values of documents, read once into types that cannot be wrong.

use std::ops::Deref;

use serde::de::{Deserialize, Deserializer, Error as _};

use super::context::{Checked, Fault, holds};
use crate::question::Notation;
use clocks::tongue;
use number::error::{Error, Result};
use number::{Rational, rational};

/// A value that stands in a document as a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written<T>(pub T);

impl<T> Deref for Written<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<'de, T: Notation> Deserialize<'de> for Written<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        // The path and the text itself are named by who reads the document.
        T::parsed("value", &String::deserialize(deserializer)?)
            .map(Written)
            .map_err(|error| D::Error::custom(error.remedy()))
    }
}

macro_rules! by_name {
    ($($type:ty: $field:literal;)*) => {
        $(impl Notation for $type {
            fn parsed(_: &str, text: &str) -> Result<Self> {
                one_of($field, text, <$type>::ALL, <$type>::name)
            }
        })*
    };
}

by_name! {
    tongue::Entry: "entry";
    tongue::Resonance: "resonance";
    tongue::Side: "position";
}

/// One of some values, by its name.
fn one_of<T: Copy, const N: usize>(
    field: &str,
    text: &str,
    all: [T; N],
    name: impl Fn(T) -> &'static str,
) -> Result<T> {
    let found = all.into_iter().find(|&value| name(value) == text);
    found.ok_or_else(|| Error::input(field, text, format!("is none of {}", all.map(name).join(", "))))
}

/// A column that a document may have or not, and in which a row may have a value or null.
#[derive(Clone, Debug, Default)]
pub enum Column<T> {
    #[default]
    Absent,
    Null,
    Value(T),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Column<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        Ok(Option::deserialize(deserializer)?.map_or(Column::Null, Column::Value))
    }
}

impl<T> Column<T> {
    pub fn is_absent(&self) -> bool {
        matches!(self, Column::Absent)
    }

    pub fn value(&self) -> Option<&T> {
        if let Column::Value(value) = self { Some(value) } else { None }
    }
}

/// A field that must be there and may be null.
pub fn nullable<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> std::result::Result<Option<T>, D::Error> {
    Option::deserialize(deserializer)
}

/// An enclosure in doubles, lo ≤ hi; an end that is null lies beyond all doubles, the other one being the
/// last of them.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(try_from = "RawEnds")]
pub struct Ends {
    pub lo: f64,
    pub hi: f64,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct RawEnds {
    #[serde(deserialize_with = "nullable")]
    lo: Option<f64>,
    #[serde(deserialize_with = "nullable")]
    hi: Option<f64>,
}

impl TryFrom<RawEnds> for Ends {
    type Error = &'static str;

    fn try_from(RawEnds { lo, hi }: RawEnds) -> std::result::Result<Self, Self::Error> {
        Ends::new(lo, hi).ok_or("an enclosure has lo <= hi")
    }
}

impl Ends {
    /// `None` where the ends are those of no enclosure.
    pub fn new(lo: Option<f64>, hi: Option<f64>) -> Option<Ends> {
        let beyond = (lo.is_some() || hi == Some(f64::MIN)) && (hi.is_some() || lo == Some(f64::MAX));
        let ends = Ends { lo: lo.unwrap_or(f64::NEG_INFINITY), hi: hi.unwrap_or(f64::INFINITY) };
        (beyond && ends.lo <= ends.hi).then_some(ends)
    }

    /// Both ends exactly.
    pub fn exact(&self) -> Checked<(Rational, Rational)> {
        exact(self.lo, self.hi)
    }
}

/// Two doubles exactly, as an interval.
pub fn exact(lo: f64, hi: f64) -> Checked<(Rational, Rational)> {
    let ends = rational::from_f64_exact(lo).zip(rational::from_f64_exact(hi)).filter(|(lo, hi)| lo <= hi);
    ends.ok_or_else(|| Fault::Wrong(format!("{lo}..{hi} is no enclosure")))
}

/// Decimals around a value.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decimal {
    pub lo: Written<Rational>,
    pub hi: Written<Rational>,
}

impl Decimal {
    /// Both ends.
    pub fn ends(&self) -> Checked<(Rational, Rational)> {
        let (lo, hi) = (self.lo.0.clone(), self.hi.0.clone());
        holds(lo <= hi, || format!("{lo}..{hi} is no enclosure"))?;
        Ok((lo, hi))
    }
}
