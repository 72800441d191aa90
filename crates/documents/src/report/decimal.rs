//! Numbers in decimal that say how far they can be trusted.
//!
//! `2.3150964146(1)` means: between 2.3150964145 and 2.3150964147. The digits in parentheses count units of
//! the last digit, as physicists write uncertainties, but here they bound the error instead of estimating it:
//! the shown interval always contains the given one, which exact rational arithmetic makes sure of. Ends that
//! are asked for in many digits are written both, rounded outward.

use std::fmt;
use std::ops::Range;

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

use number::{Rational, rational};

/// As many significant digits as any double needs to differ from its neighbours.
const MOST_DIGITS: i64 = 17;
/// The largest uncertainty shown: a single digit, lest a last digit be shown that means nothing.
const LARGEST_UNCERTAINTY: u32 = 9;
/// Enclosures from 10^-5 up to below 10^7 are written without an exponent, ends in many digits from 10^-7 up
/// to below 10^21.
const PLAIN: Range<i64> = -5..7;
const PLAIN_ENDS: Range<i64> = -7..21;

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
        places: i64,
        /// The bound on the error, in units of the last digit; 0 if there is none.
        uncertainty: u32,
    },
    /// Both ends, where no digit is certain or an end is not finite.
    Ends(f64, f64),
}

/// The shortest honest way to write "between `lo` and `hi`".
///
/// ```
/// use kickdrift_documents::report::decimal::enclosure;
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
    // Wider than half its size, or around zero: a leading digit in doubt says less than the two ends.
    let vague =
        !(lo.is_finite() && hi.is_finite()) || lo > hi || lo * hi.signum() <= 0.0 || hi - lo > small / 2.0;
    if vague {
        return Shown::Ends(lo, hi);
    }
    let [lo, hi] = [lo, hi].map(|end| rational::from_f64_exact(end).expect("the ends are finite"));
    first_that_fits(&lo, &hi, MOST_DIGITS)
}

/// Whether the difference of two numbers is 0 but for their rounding, the larger of them being enclosed in
/// `beside`.
pub(crate) fn is_nothing((lo, hi): (f64, f64), beside: Option<(f64, f64)>) -> bool {
    lo <= 0.0 && 0.0 <= hi && hi - lo <= 1e-12 * beside.map_or(0.0, |pair| pair.1)
}

/// An enclosure in doubles, in so many significant digits at most.
pub fn shortened(lo: f64, hi: f64, digits: u32) -> Shown {
    match (enclosure(lo, hi), [lo, hi].map(rational::from_f64_exact)) {
        (Shown::Concise { .. }, [Some(lo), Some(hi)]) if !lo.is_zero() => concise(&lo, &hi, digits),
        (vague, _) => vague,
    }
}

/// "Between `lo` and `hi`" in so many significant digits, fewer where they are not certain: what is written
/// contains [lo, hi].
///
/// ```
/// use kickdrift_documents::number::rational::ratio;
/// use kickdrift_documents::report::decimal::concise;
/// assert_eq!(concise(&ratio(1, 3), &ratio(1, 3), 5).to_string(), "0.33333(1)");
/// assert_eq!(concise(&ratio(11, 4), &ratio(11, 4), 5).to_string(), "2.75");
/// ```
///
/// # Panics
/// Where an end is 0, their signs differ, or they differ by more than their size: no digit is certain then.
pub fn concise(lo: &Rational, hi: &Rational, digits: u32) -> Shown {
    assert!(lo.is_positive() == hi.is_positive() && lo <= hi && !lo.is_zero(), "[{lo}, {hi}]");
    let small = lo.abs().min(hi.abs());
    assert!(hi - lo <= small, "no digit of [{lo}, {hi}] is certain");
    first_that_fits(lo, hi, i64::from(digits.max(1)))
}

/// The most digits, `digits` at most, whose uncertainty is a single digit.
fn first_that_fits(lo: &Rational, hi: &Rational, digits: i64) -> Shown {
    let most = digits - 1 - exponent(&lo.abs().min(hi.abs()));
    (0..).find_map(|fewer| at_places(lo, hi, most - fewer)).expect("with few digits any error is one unit")
}

/// The midpoint rounded to `places`, if its distance to both ends fits the uncertainty allowed.
fn at_places(lo: &Rational, hi: &Rational, places: i64) -> Option<Shown> {
    let scale = power_of_ten(places);
    let (lo, hi) = (lo * &scale, hi * &scale);
    let middle = ((&lo + &hi) / Rational::from_integer(2.into())).round();
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
        let (mantissa, exponent) = placed(digits, places, PLAIN);
        f.write_str(if negative { "-" } else { "" })?;
        f.write_str(&mantissa)?;
        if uncertainty > 0 {
            write!(f, "({uncertainty})")?;
        }
        exponent.map_or(Ok(()), |exponent| write!(f, "e{exponent}"))
    }
}

/// digits · 10^-places as a mantissa and the power of ten that is to stand behind it, where it is beyond
/// `plain`.
fn placed(digits: &str, places: i64, plain: Range<i64>) -> (String, Option<i64>) {
    let leading = digits.len() as i64 - 1 - places;
    let is_plain = places >= 0 && plain.contains(&leading);
    let behind = if is_plain { places as usize } else { digits.len() - 1 };
    let padded = format!("{digits:0>width$}", width = behind + 1);
    let (whole, fraction) = padded.split_at(padded.len() - behind);
    let mantissa = if fraction.is_empty() { whole.into() } else { format!("{whole}.{fraction}") };
    (mantissa, (!is_plain).then_some(leading))
}

/// A text whose numbers with an uncertainty, as 1.2345(6), are in so many significant digits at most; all
/// else stays.
///
/// ```
/// use kickdrift_documents::report::decimal::in_digits;
/// assert_eq!(in_digits("rate -1.23456789(2)e-7, f(x) = (3)", 4), "rate -1.235(1)e-7, f(x) = (3)");
/// ```
pub fn in_digits(text: &str, digits: u32) -> String {
    let (mut out, mut rest) = (String::with_capacity(text.len()), text);
    while let Some((head, tail)) = rest.split_once('(') {
        let start = head
            .rfind(|c: char| !(c.is_ascii_digit() || c == '.'))
            .map_or(0, |i| i + head[i..].chars().next().map_or(0, char::len_utf8));
        let shorter = tail.split_once(')').and_then(|(units, _)| uncertain(&head[start..], units, digits));
        match shorter {
            Some(shorter) => {
                out += &head[..start];
                out += &shorter;
                rest = tail.split_once(')').map_or("", |(_, behind)| behind);
            }
            None => {
                out += head;
                out.push('(');
                rest = tail;
            }
        }
    }
    out + rest
}

/// `1.2345` and `6` in fewer digits; `None` where they are no such number.
fn uncertain(number: &str, units: &str, digits: u32) -> Option<String> {
    let (whole, fraction) = number.split_once('.').filter(|_| units.bytes().all(|b| b.is_ascii_digit()))?;
    let [middle, error]: [BigInt; 2] = [format!("{whole}{fraction}").parse().ok()?, units.parse().ok()?];
    let scale = power_of_ten(-(fraction.len() as i64));
    let (lo, hi) = (&middle - &error, &middle + &error);
    let [lo, hi] = [lo, hi].map(|end| Rational::from_integer(end) * &scale);
    (lo.is_positive() && &hi - &lo <= lo).then(|| concise(&lo, &hi, digits).to_string())
}

/// Both ends with so many significant digits, the lower rounded down and the upper up: what is written
/// contains [lo, hi], 0 < lo ≤ hi.
///
/// ```
/// use kickdrift_documents::number::rational::ratio;
/// use kickdrift_documents::report::decimal::outward;
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
    // Lengths in bits give it to within one or two; comparisons decide the rest.
    let bits = x.numer().bits() as f64 - x.denom().bits() as f64;
    let estimate = (bits * std::f64::consts::LOG10_2).floor().to_i64().expect("small");
    (estimate - 2..=estimate + 2).rev().find(|&e| power_of_ten(e) <= *x).expect("the estimate is within two")
}

/// whole · 10^-places, zeros that say nothing left out.
fn written(mut whole: BigInt, mut places: i64) -> String {
    let leading = whole.to_string().len() as i64 - 1 - places;
    let has_exponent = places < 0 || !PLAIN_ENDS.contains(&leading);
    while (places > 0 || has_exponent) && !whole.is_zero() && (&whole % 10u8).is_zero() {
        whole /= 10u8;
        places -= 1;
    }
    match placed(&whole.to_string(), places, PLAIN_ENDS) {
        (mantissa, Some(exponent)) => format!("{mantissa}e{exponent}"),
        (mantissa, None) => mantissa,
    }
}

/// A double of so many significant digits, the nearest in decimal: for people, who need no more of a rounded
/// number.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}

/// n 10^-`decimals` without an exponent, exactly.
pub fn shifted(n: i64, decimals: i32) -> String {
    let sign = if n < 0 { "-" } else { "" };
    let digits = n.unsigned_abs().to_string();
    let Ok(behind @ 1..) = usize::try_from(decimals) else {
        return format!("{sign}{digits}{}", "0".repeat(decimals.unsigned_abs() as usize));
    };
    let padded = format!("{digits:0>width$}", width = behind + 1);
    let (whole, part) = padded.split_at(padded.len() - behind);
    format!("{sign}{whole}.{part}").trim_end_matches('0').trim_end_matches('.').into()
}

/// So many significant digits in writing: plain where that is short, else with an exponent.
pub fn few(x: f64, digits: usize) -> String {
    let x = rounded(x, digits);
    if x == 0.0 || (1e-4..1e6).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifted_numbers_are_exact() {
        for (n, decimals, text) in [
            (0, 3, "0"),
            (25, 3, "0.025"),
            (-1200, 2, "-12"),
            (7, 0, "7"),
            (7, -2, "700"),
            (1234, 2, "12.34"),
        ] {
            assert_eq!(shifted(n, decimals), text);
        }
    }
}
