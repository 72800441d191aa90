//! The forms in which a quantity can be given: text, an integer, a rational, an element of ℚ[π, 1/π].
//!
//! A double is rarely the number that its writer meant (0.3 is not 3/10), so it has to be asked for by name.
//!
//! ```
//! use kickdrift_number::{Laurent, Quantity};
//! assert_eq!("0.3".quantity("h1")?, Laurent::try_from("3/10")?);
//! assert_eq!(2.quantity("h1")?.to_string(), "2");
//! assert_eq!(Laurent::try_from(0.3)?.to_string(), "5404319552844595/18014398509481984");
//! assert_eq!("0,3".quantity("h1").unwrap_err().field(), "h1");
//! assert!(Laurent::try_from(f64::NAN).is_err());
//! # Ok::<(), kickdrift_number::error::Error>(())
//! ```

use std::str::FromStr;

use super::{Laurent, Ratio, Rational, parse, rational};
use crate::error::{Error, Result};

/// An exact number, or text that denotes one.
pub trait Quantity {
    /// The number, exactly.
    ///
    /// # Errors
    /// Text that denotes none; the error names `field`.
    fn quantity(self, field: &str) -> Result<Laurent>;
}

impl Quantity for &str {
    fn quantity(self, field: &str) -> Result<Laurent> {
        parse::parse(field, self)
    }
}

impl Quantity for &String {
    fn quantity(self, field: &str) -> Result<Laurent> {
        parse::parse(field, self)
    }
}

macro_rules! exact {
    ($($type:ty: $x:ident => $laurent:expr),* $(,)?) => {$(
        impl From<$type> for Laurent {
            fn from($x: $type) -> Laurent {
                $laurent
            }
        }

        impl Quantity for $type {
            fn quantity(self, _field: &str) -> Result<Laurent> {
                Ok(self.into())
            }
        }
    )*};
}

exact! {
    i32: n => Laurent::from_integer(n.into()),
    i64: n => Laurent::from_integer(n),
    u64: n => Laurent::from_rational(Rational::from_integer(n.into())),
    Ratio: ratio => Laurent::from_rational(ratio.into()),
    Rational: x => Laurent::from_rational(x),
    &Rational: x => Laurent::from_rational(x.clone()),
    &Laurent: x => x.clone(),
}

impl Quantity for Laurent {
    fn quantity(self, _field: &str) -> Result<Laurent> {
        Ok(self)
    }
}

impl FromStr for Laurent {
    type Err = Error;

    fn from_str(text: &str) -> Result<Laurent> {
        parse::parse("number", text)
    }
}

impl FromStr for Ratio {
    type Err = Error;

    fn from_str(text: &str) -> Result<Ratio> {
        parse::parse_ratio("ratio", text)
    }
}

impl TryFrom<&str> for Laurent {
    type Error = Error;

    fn try_from(text: &str) -> Result<Laurent> {
        text.parse()
    }
}

impl TryFrom<f64> for Laurent {
    type Error = Error;

    /// The number that the double is, to its last bit; infinities and NaN are none.
    fn try_from(x: f64) -> Result<Laurent> {
        let exact = rational::from_f64_exact(x)
            .ok_or_else(|| Error::input("number", x, "is not a finite number: give one"))?;
        Ok(exact.into())
    }
}

impl TryFrom<f64> for Ratio {
    type Error = Error;

    /// The ratio that the double is, to its last bit.
    fn try_from(x: f64) -> Result<Ratio> {
        let exact = rational::from_f64_exact(x)
            .ok_or_else(|| Error::input("ratio", x, "is not a finite number: give one"))?;
        Ratio::try_from(&exact)
    }
}

/// Exact numbers are strings in documents, as people write them.
mod text {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    macro_rules! text {
        ($($type:ty),*) => {$(
            impl Serialize for $type {
                fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    serializer.collect_str(self)
                }
            }

            impl<'de> Deserialize<'de> for $type {
                fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
                }
            }
        )*};
    }

    text!(super::Laurent, super::Ratio);

    /// Two doubles with the ball between them.
    impl Serialize for crate::Ball {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let (lo, hi) = self.to_f64_enclosure();
            serializer.collect_map([("lo", lo), ("hi", hi)])
        }
    }
}
