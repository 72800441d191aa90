//! Enclosures in many digits: both ends in writing, rounded outward.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

use crate::number::{Rational, rational};

/// Numbers from 10^-7 up to below 10^21 are written without an exponent.
const PLAIN: std::ops::Range<i64> = -7..21;

/// Both ends with so many significant digits, the lower rounded down and the upper up: what is written contains
/// [lo, hi], 0 < lo ≤ hi.
///
/// ```
/// use kickdrift::number::rational::ratio;
/// use kickdrift::report::digits::outward;
/// assert_eq!(outward(&ratio(1, 3), &ratio(1, 3), 20), ["0.33333333333333333333", "0.33333333333333333334"]);
/// assert_eq!(outward(&ratio(11, 4), &ratio(11, 4), 6), ["2.75", "2.75"]);
/// ```
///
/// # Panics
/// Where lo ≤ 0 or no digits are asked for.
pub fn outward(lo: &Rational, hi: &Rational, digits: u32) -> [String; 2] {
    assert!(lo.is_positive() && digits > 0, "{digits} digits of [{lo}, {hi}]");
    let places = i64::from(digits) - 1 - exponent(hi);
    let scale = power_of_ten(places);
    [written((lo * &scale).floor().to_integer(), places), written((hi * &scale).ceil().to_integer(), places)]
}

fn power_of_ten(n: i64) -> Rational {
    Rational::from_integer(10.into()).pow(n as i32)
}

/// e with 10^e ≤ x < 10^(e+1), x > 0.
fn exponent(x: &Rational) -> i64 {
    // Lengths in bits tell it to within one or two; comparisons tell the rest.
    let bits = x.numer().bits() as f64 - x.denom().bits() as f64;
    let estimate = (bits * std::f64::consts::LOG10_2).floor().to_i64().expect("small");
    (estimate - 2..=estimate + 2).rev().find(|&e| power_of_ten(e) <= *x).expect("the estimate is within two")
}

/// whole · 10^-places, zeros behind the point left out.
fn written(mut whole: BigInt, mut places: i64) -> String {
    while places > 0 && (&whole % 10u8).is_zero() {
        whole /= 10u8;
        places -= 1;
    }
    let digits = whole.to_string();
    let leading = digits.len() as i64 - 1 - places;
    if !PLAIN.contains(&leading) || places < 0 {
        let (first, rest) = digits.split_at(1);
        let rest = rest.trim_end_matches('0');
        let point = if rest.is_empty() { "" } else { "." };
        return format!("{first}{point}{rest}e{leading}");
    }
    let padded = format!("{digits:0>width$}", width = places as usize + 1);
    let (whole, part) = padded.split_at(padded.len() - places as usize);
    if part.is_empty() { whole.into() } else { format!("{whole}.{part}") }
}

/// A double of so many significant digits, the nearest in decimal: for people, who need no more of a rounded number.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}

/// The same in writing: plain where that is short, else with an exponent.
pub fn few(x: f64, digits: usize) -> String {
    let x = rounded(x, digits);
    if x == 0.0 || (1e-4..1e6).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// The rational that a finite double is.
///
/// # Panics
/// Where it is not finite.
pub fn exact(x: f64) -> Rational {
    rational::from_f64_exact(x).expect("a finite double")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse::parse_rational;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_written_contains_the_enclosure(n in 1u64.., d in 1u64.., k in -300i32..300, digits in 1u32..60) {
            let lo = Rational::new(n.into(), d.into()) * power_of_ten(k.into());
            let hi = &lo + &lo * Rational::new(1.into(), 1_000_003.into());
            let [low, high] = outward(&lo, &hi, digits).map(|text| parse_rational("end", &text).unwrap());
            prop_assert!(low <= lo && hi <= high);
            // Sharp: each end moved by less than one unit of the last digit.
            let unit = power_of_ten(exponent(&hi) + 1 - i64::from(digits));
            prop_assert!(&lo - &low < unit && &high - &hi < unit);
        }
    }

    #[test]
    fn rounding_for_people_keeps_the_leading_digits() {
        assert_eq!([1234.56789, 0.0, -1.23456e-9].map(|x| rounded(x, 4)), [1235.0, 0.0, -1.235e-9]);
        assert!(rounded(f64::INFINITY, 3).is_infinite());
        assert_eq!([7.6849e10, 0.012, 1.0].map(|x| few(x, 3)), ["7.68e10", "0.012", "1"]);
    }
}
