//! Enclosures as decimals that say how far they can be trusted.
//!
//! `2.3150964146(1)` means: between 2.3150964145 and 2.3150964147. The digits in parentheses count units of
//! the last digit, as physicists write uncertainties, but here they bound the error instead of estimating it:
//! the shown interval always contains the given one, which exact rational arithmetic makes sure of.

use std::fmt;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

/// As many significant digits as any double needs to be told from its neighbours.
const MOST_DIGITS: i32 = 17;
/// The largest uncertainty shown: a single digit, lest a last digit be shown that means nothing.
const LARGEST_UNCERTAINTY: u32 = 9;
/// Numbers from 10^-5 up to below 10^7 are written without an exponent.
const PLAIN: std::ops::Range<i32> = -5..7;

/// An enclosure made ready to be shown in plain text by [`Display`](fmt::Display).
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// `sign digits x 10^-places`, right within `uncertainty` units of the last digit.
    Concise {
        /// Whether a minus sign stands in front.
        negative: bool,
        /// The decimal digits without a point.
        digits: String,
        /// How many of them stand behind the point (if negative: how many zeros follow).
        places: i32,
        /// The bound on the error, in units of the last digit; 0 if there is none.
        uncertainty: u32,
    },
    /// Both ends, where no digit is certain or an end is not finite.
    Ends(f64, f64),
}

/// The shortest honest way to write "between `lo` and `hi`".
///
/// ```
/// use kickdrift::report::decimal::enclosure;
/// assert_eq!(enclosure(2.31509641451, 2.31509641469).to_string(), "2.3150964146(1)");
/// assert_eq!(enclosure(0.5, 0.5).to_string(), "0.5");
/// assert_eq!(enclosure(1.1e-9, 1.2e-9).to_string(), "1.15(6)e-9");
/// assert_eq!(enclosure(-0.5, 0.25).to_string(), "[-0.5, 0.25]");
/// ```
pub fn enclosure(lo: f64, hi: f64) -> Shown {
    let small = lo.abs().min(hi.abs());
    if lo == 0.0 && hi == 0.0 {
        return Shown::Concise { negative: false, digits: "0".into(), places: 0, uncertainty: 0 };
    }
    // Wider than half its size, or around zero: a leading digit in doubt tells less than the two ends.
    let vague =
        !(lo.is_finite() && hi.is_finite()) || lo > hi || lo * hi.signum() <= 0.0 || hi - lo > small / 2.0;
    if vague {
        return Shown::Ends(lo, hi);
    }
    let (lo, hi) = (rational(lo), rational(hi));
    let mut places = MOST_DIGITS - 1 - exponent(small);
    loop {
        if let Some(shown) = at_places(&lo, &hi, places) {
            return shown;
        }
        places -= 1;
    }
}

fn rational(value: f64) -> BigRational {
    BigRational::from_float(value).expect("the ends are finite")
}

/// The decimal exponent of a positive double: value = d.ddd x 10^exponent.
fn exponent(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, power)| power.parse().ok()).expect("a finite double has an exponent")
}

/// The midpoint rounded to `places`, if its distance to both ends fits the uncertainty allowed.
fn at_places(lo: &BigRational, hi: &BigRational, places: i32) -> Option<Shown> {
    let ten = BigRational::from_integer(10.into());
    let scale = ten.pow(places);
    let (lo, hi) = (lo * &scale, hi * &scale);
    let middle = ((&lo + &hi) / BigRational::from_integer(2.into())).round();
    let error = (&middle - lo).abs().max((hi - &middle).abs()).ceil();
    let uncertainty = error.to_integer().to_u32().filter(|&units| units <= LARGEST_UNCERTAINTY)?;
    let mut whole: BigInt = middle.to_integer();
    let mut places = places;
    if uncertainty == 0 {
        // An exact decimal: zeros behind the point say nothing.
        while places > 0 && (&whole % 10u32).is_zero() {
            whole /= 10u32;
            places -= 1;
        }
    }
    Some(Shown::Concise {
        negative: whole.is_negative(),
        digits: whole.abs().to_string(),
        places,
        uncertainty,
    })
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (negative, digits, places, uncertainty) = match self {
            Shown::Ends(lo, hi) => return write!(f, "[{lo:?}, {hi:?}]"),
            Shown::Concise { negative, digits, places, uncertainty } => {
                (*negative, digits, *places, *uncertainty)
            }
        };
        let leading = digits.len() as i32 - 1 - places;
        let plain = places >= 0 && PLAIN.contains(&leading);
        let behind = if plain { places as usize } else { digits.len() - 1 };
        let padded = format!("{digits:0>width$}", width = behind + 1);
        let (whole, fraction) = padded.split_at(padded.len() - behind);
        f.write_str(if negative { "-" } else { "" })?;
        f.write_str(whole)?;
        if !fraction.is_empty() {
            write!(f, ".{fraction}")?;
        }
        if uncertainty > 0 {
            write!(f, "({uncertainty})")?;
        }
        if plain { Ok(()) } else { write!(f, "e{leading}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What the text claims, read back from the text alone.
    fn claimed(text: &str) -> (BigRational, BigRational) {
        let (mantissa, power) = text.split_once('e').unwrap_or((text, "0"));
        let (number, units) = mantissa.split_once('(').unwrap_or((mantissa, "0)"));
        let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
        let digits: BigInt = format!("{whole}{fraction}").parse().unwrap();
        let units: BigInt = units.trim_end_matches(')').parse().unwrap();
        let power = power.parse::<i32>().unwrap() - fraction.len() as i32;
        let scale = BigRational::from_integer(10.into()).pow(power);
        let at = |n: BigInt| BigRational::from_integer(n) * &scale;
        (at(&digits - &units), at(digits + units))
    }

    #[test]
    fn tiny_and_huge_numbers_get_an_exponent() {
        assert_eq!(enclosure(1.0, 1.0).to_string(), "1");
        assert_eq!(enclosure(-0.25, -0.25).to_string(), "-0.25");
        assert_eq!(enclosure(123456.0, 123458.0).to_string(), "123457(1)");
        assert_eq!(enclosure(3e20, 3.001e20).to_string(), "3.0005(5)e20");
    }

    proptest! {
        #[test]
        fn the_shown_interval_contains_the_given_one(bits in any::<u64>(), steps in 0u64..1_000_000_000_000) {
            let lo = f64::from_bits(bits);
            prop_assume!(lo.is_finite());
            let hi = f64::from_bits(bits + steps);
            prop_assume!(hi.is_finite());
            let (lo, hi) = (lo.min(hi), lo.max(hi));
            let shown = enclosure(lo, hi);
            prop_assume!(matches!(shown, Shown::Concise { .. }));
            let (low, high) = claimed(&shown.to_string());
            prop_assert!(low <= rational(lo) && rational(hi) <= high, "{} for [{:?}, {:?}]", shown, lo, hi);
            // Sharp: never more than ten times as wide, plus a unit where a double needs 17 digits.
            let unit = &high - &low;
            let width = rational(hi) - rational(lo);
            let ulp = rational(lo.abs().max(hi.abs())) * BigRational::new(1.into(), BigInt::from(10).pow(15));
            prop_assert!(unit <= width * BigRational::from_integer(20.into()) + ulp);
        }
    }
}
