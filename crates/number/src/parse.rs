//! Typed numbers, read exactly: `0.3` is 3/10, and `pi^2/25` keeps its π.
//!
//! The grammar: sums, differences, products `*`, quotients `/` and integer powers `^` of decimals
//! (`3`, `0.3`, `.5`, `1e-3`), of `pi` (or `π`) and of parentheses. A product needs its `*` (or `·`, `×`),
//! a minus may be printed as `−`, and a power as `π²` or `2⁻¹`. The sign binds
//! weaker than the power: `-2^2` is −4. Every quotient must stay in ℚ[π, 1/π], so a divisor is c π^k.
//!
//! ```
//! use kickdrift_number::parse;
//! assert_eq!(parse::parse("lambda2", "pi^2 / 25").unwrap().to_string(), "pi^2/25");
//! assert_eq!(parse::parse("h1", "0.30").unwrap().to_string(), "3/10");
//! let error = parse::parse("h1", "1/(1 + pi)").unwrap_err().to_string();
//! assert!(error.starts_with("h1 = 1/(1 + pi): a divisor"), "{error}");
//! assert_eq!(parse::parse_ratio("ratio", "14/4").unwrap().terms(), (7, 2));
//! ```

pub mod arithmetic;
mod grammar;

pub use grammar::{MAX_BITS, MAX_CHARACTERS, MAX_PI_EXPONENT, typed};

use num_traits::ToPrimitive;

use super::{Laurent, Ratio, Rational};
use crate::error::{Error, Result};

/// The element of ℚ[π, 1/π] that `text` denotes, exactly.
///
/// **Errors** (naming `field`, the text and the remedy) on anything else, and beyond [`MAX_CHARACTERS`],
/// [`MAX_BITS`] and [`MAX_PI_EXPONENT`].
pub fn parse(field: &str, text: &str) -> Result<Laurent> {
    grammar::evaluate(text).map_err(|remedy| Error::input(field, text.trim(), remedy))
}

/// The rational that `text` denotes: like [`parse`], and an error if π remains.
pub fn parse_rational(field: &str, text: &str) -> Result<Rational> {
    parse(field, text)?
        .as_rational()
        .ok_or_else(|| Error::input(field, text.trim(), "must be rational; write it without pi"))
}

/// The integer that `text` denotes.
pub fn parse_integer(field: &str, text: &str) -> Result<i64> {
    let x = parse_rational(field, text)?;
    let integer = x.is_integer().then(|| x.numer().to_i64()).flatten();
    integer.ok_or_else(|| Error::input(field, text.trim(), "must be an integer of at most 63 bits"))
}

/// A positive ratio: `14/4` is 7/2, `3` is 3/1.
pub fn parse_ratio(field: &str, text: &str) -> Result<Ratio> {
    let x = parse_rational(field, text)?;
    Ratio::try_from(&x).map_err(|error| Error::input(field, text.trim(), error.remedy()))
}

/// The closed range `LO..HI`, LO ≤ HI.
pub fn parse_range(field: &str, text: &str) -> Result<(Laurent, Laurent)> {
    let (lo, hi) = split_range(field, text, "1/100..7/2")?;
    let (lo, hi) = (parse(field, lo)?, parse(field, hi)?);
    if lo > hi { Err(reversed(field, text)) } else { Ok((lo, hi)) }
}

/// The closed range `LO..HI` of rationals, LO ≤ HI.
pub fn parse_rational_range(field: &str, text: &str) -> Result<(Rational, Rational)> {
    let (lo, hi) = parse_range(field, text)?;
    let both = lo.as_rational().zip(hi.as_rational());
    both.ok_or_else(|| Error::input(field, text, "must be rational; write it without pi"))
}

/// The closed range `LO..HI` of integers, LO ≤ HI.
pub fn parse_integer_range(field: &str, text: &str) -> Result<(i64, i64)> {
    let (lo, hi) = split_range(field, text, "-2..3")?;
    let (lo, hi) = (parse_integer(field, lo)?, parse_integer(field, hi)?);
    if lo > hi { Err(reversed(field, text)) } else { Ok((lo, hi)) }
}

fn split_range<'a>(field: &str, text: &'a str, example: &str) -> Result<(&'a str, &'a str)> {
    let ends = text.split_once("..").filter(|(lo, hi)| !lo.trim().is_empty() && !hi.trim().is_empty());
    match ends {
        Some((lo, hi)) if hi.contains(':') => {
            let hi = hi.split(':').next().unwrap_or_default();
            Err(Error::input(field, text, format!("is a range without a spacing: write {lo}..{hi}")))
        }
        Some(ends) => Ok(ends),
        None => Err(Error::input(field, text, format!("must be a range LO..HI, such as {example}"))),
    }
}

fn reversed(field: &str, text: &str) -> Error {
    Error::input(field, text, "the range is empty: write the smaller number first")
}
