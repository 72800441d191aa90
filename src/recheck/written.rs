//! What stands in documents, read once into types that cannot be wrong.

use std::ops::Deref;

use serde::de::{Deserialize, Deserializer, Error as _};

use super::context::{Checked, Fault, holds};
use crate::error::{Error, Result};
use crate::number::{Ball, Laurent, Rational, rational};
use crate::question::Notation;
use crate::tongue;
use crate::verdict::{Kind, Tier};

/// A closed range of exact numbers.
pub type Range = (Laurent, Laurent);

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
            .map_err(|own| D::Error::custom(own.remedy()))
    }
}

macro_rules! named {
    ($($type:ty: $field:literal, $all:expr;)*) => {
        $(impl Notation for $type {
            fn parsed(_: &str, text: &str) -> Result<Self> {
                one_of($field, text, $all, <$type>::name)
            }
        })*
    };
}

named! {
    Kind: "kind", [Kind::Elliptic, Kind::Hyperbolic, Kind::Parabolic, Kind::Coexistence];
    Tier: "tier", Tier::ALL;
    tongue::Entry: "entry", tongue::Entry::ALL;
    tongue::Resonance: "resonance", [tongue::Resonance::Fast, tongue::Resonance::Slow];
    tongue::Side: "position", SIDES;
}

const SIDES: [tongue::Side; 5] = {
    use tongue::Side::{Above, Below, Inside, OnLower, OnUpper};
    [Below, OnLower, Inside, OnUpper, Above]
};

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

    /// The value, which must be there exactly where `due`, unless the column is not there at all.
    pub fn due(&self, name: &str, due: bool) -> Checked<Option<&T>> {
        holds(due || self.value().is_none(), || format!("it has no {name}"))?;
        holds(!due || !matches!(self, Column::Null), || format!("{name} is null, and it has one"))?;
        Ok(self.value())
    }
}

/// A field that must be there and may be null.
pub fn nullable<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> std::result::Result<Option<T>, D::Error> {
    Option::deserialize(deserializer)
}

/// An enclosure in doubles, lo ≤ hi; an end that is null lies beyond all doubles, the other one being the last of them.
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

    /// Whether the ball's value can lie inside.
    pub fn holds(&self, ball: &Ball) -> bool {
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
    /// Both ends, to the significant digits that were asked for: each is a multiple of the last place, they are two of them
    /// apart at most.
    pub fn ends(&self, digits: Option<u64>) -> Checked<(Rational, Rational)> {
        let (lo, hi) = (self.lo.0.clone(), self.hi.0.clone());
        holds(lo <= hi, || format!("{lo}..{hi} is no enclosure"))?;
        let Some(digits) = digits else {
            return Err(Fault::Wrong("has decimals, for which no number of digits was asked".into()));
        };
        let ten = Rational::from_integer(10.into());
        holds(hi > Rational::default() && digits <= 100_000, || "has no digits".into())?;
        // 10^(e + 1 - digits), 10^e ≤ hi < 10^(e + 1).
        let decade = |x: &Rational| (x.numer().to_string().len() as i32, x.denom().to_string().len() as i32);
        let (above, below) = decade(&hi);
        let e = if hi < ten.pow(above - below) { above - below - 1 } else { above - below };
        let fits = |e: i32| {
            let place = ten.pow(e + 1 - digits as i32);
            (&lo / &place).is_integer() && (&hi / &place).is_integer() && &hi - &lo <= &place + &place
        };
        // An end that is rounded up to a power of ten has its place from below.
        let written = fits(e) || (hi == ten.pow(e) && fits(e - 1));
        holds(written, || format!("its decimals have not {digits} digits"))?;
        Ok((lo, hi))
    }
}
