//! The values of documents, read once into types that cannot be wrong.

use std::fmt;
use std::ops::Deref;

use num_bigint::BigInt;
use serde::de::{Deserialize, Deserializer, Error as _};

use super::context::{Checked, Fault, holds};
use crate::question::Notation;
use clocks::tongue;
use clocks::verdict::{Kind, Tier};
use number::error::{Error, Result};
use number::{Ball, Rational, rational};

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

/// A whole number, beyond doubles' reach as a text.
#[derive(Clone, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(try_from = "RawWhole")]
pub struct Whole(pub BigInt);

impl fmt::Display for Whole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[derive(serde::Deserialize)]
#[serde(untagged)]
enum RawWhole {
    Short(u64),
    Long(String),
}

impl TryFrom<RawWhole> for Whole {
    type Error = String;

    fn try_from(raw: RawWhole) -> std::result::Result<Self, String> {
        match raw {
            RawWhole::Short(n) => Ok(Whole(n.into())),
            RawWhole::Long(text) => text.parse().map(Whole).map_err(|_| format!("{text} is no whole number")),
        }
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
    Kind: "kind";
    Tier: "tier";
    tongue::Entry: "entry";
    tongue::Resonance: "resonance";
    tongue::Side: "position";
}

/// A flag, which stands in a document only where it is set.
impl Notation for bool {
    fn parsed(_: &str, text: &str) -> Result<Self> {
        one_of("flag", text, [true], |_| "true")
    }
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

/// The logarithm of what lies beyond every double, where an outward rounding to doubles loses nothing that is
/// written.
const BEYOND_DOUBLES: i64 = 2000;

impl Ends {
    /// `None` where the ends are those of no enclosure.
    pub fn new(lo: Option<f64>, hi: Option<f64>) -> Option<Ends> {
        let beyond = (lo.is_some() || hi == Some(f64::MIN)) && (hi.is_some() || lo == Some(f64::MAX));
        let ends = Ends { lo: lo.unwrap_or(f64::NEG_INFINITY), hi: hi.unwrap_or(f64::INFINITY) };
        (beyond && ends.lo <= ends.hi).then_some(ends)
    }

    /// Whether the ball's value can lie inside.
    pub fn holds(&self, ball: &Ball) -> bool {
        // Far beyond doubles a ball is not worth its digits.
        if ball.top().is_some_and(|log2| log2 > BEYOND_DOUBLES) {
            let (lower, upper) = ball.to_f64_enclosure();
            return self.lo <= upper && lower <= self.hi;
        }
        let below = rational::from_f64_exact(self.lo).is_none_or(|lo| lo <= ball.upper());
        below && rational::from_f64_exact(self.hi).is_none_or(|hi| ball.lower() <= hi)
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
