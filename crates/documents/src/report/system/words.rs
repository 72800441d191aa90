//! A verdict and its growth rate in words.

use crate::report::decimal;
use number::from_f64_exact;

/// Digits of a growth rate in words, and of the least one.
const DIGITS: u32 = 8;
const LEAST_DIGITS: u32 = 5;

/// A growth rate in words.
pub(super) fn rate(pair: Option<(f64, f64)>) -> String {
    match pair {
        Some((lo, hi)) if lo > 0.0 && hi.is_finite() => decimal::shortened(lo, hi, DIGITS).to_string(),
        Some((lo, _)) if lo > 0.0 => {
            let lo = from_f64_exact(lo).expect("a finite double");
            format!("at least {}", decimal::outward(&lo, &lo, LEAST_DIGITS)[0])
        }
        Some((_, 0.0)) => "0".into(),
        Some((_, hi)) if hi.is_finite() => {
            let hi = from_f64_exact(hi).expect("a finite double");
            format!("at most {}", decimal::outward(&hi, &hi, 2)[1])
        }
        _ => "not enclosed".into(),
    }
}

/// A rate with its unit, where there is a number.
pub(super) fn rate_per(pair: Option<(f64, f64)>, unit: &str) -> String {
    let unit = if pair.is_some_and(|pair| pair.0 > 0.0 || pair.1.is_finite()) {
        format!(" per {unit}")
    } else {
        String::new()
    };
    rate(pair) + &unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_growth_rate_is_written_in_digits_that_it_has() {
        assert_eq!(rate(Some((3.162_277_6e-8, 3.162_277_7e-8))), "3.1622777(2)e-8");
        assert_eq!(rate(Some((0.0, 1.04e-9))), "at most 1.1e-9");
        assert_eq!(rate_per(Some((3.456_789, f64::INFINITY)), "ps"), "at least 3.4567 per ps");
        assert_eq!(
            [rate(Some((0.0, 0.0))), rate(Some((0.0, f64::INFINITY))), rate(None)],
            ["0", "not enclosed", "not enclosed"]
        );
        assert_eq!([rate_per(Some((0.0, 0.0)), "ps"), rate_per(None, "ps")], ["0 per ps", "not enclosed"]);
    }
}
