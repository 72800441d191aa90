//! The rationals: exact arithmetic, signs by inspection, doubles with known rounding.
//!
//! ```
//! use kickdrift_number::{Rational, Real, rational};
//! let third = Rational::new(1.into(), 3.into());
//! let (lo, hi) = rational::enclose_f64(&third);
//! assert!(lo < hi && hi == lo.next_up() && rational::to_f64(&third) == 1.0 / 3.0);
//! assert!(third.enclosure(100).lower() <= third && third <= third.enclosure(100).upper());
//! ```

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use super::float;

/// The rationals, always in lowest terms with a positive denominator.
pub type Rational = num_rational::BigRational;

/// The rational p/q of two machine integers.
///
/// **Panics** if q = 0.
#[inline]
pub fn ratio(p: i64, q: i64) -> Rational {
    Rational::new(p.into(), q.into())
}

/// The double nearest to a b, ties to even, without reducing the product.
pub fn product_to_f64(a: &Rational, b: &Rational) -> f64 {
    float::nearest_quotient(&(a.numer() * b.numer()), &(a.denom() * b.denom()))
}

/// The double nearest to x, ties to even; ±∞ from 2^1024 − 2^970 on.
pub fn to_f64(x: &Rational) -> f64 {
    float::nearest_quotient(x.numer(), x.denom())
}

/// The largest double ≤ x and the smallest double ≥ x: equal iff x is a double.
///
/// Beyond the largest double one side is infinite.
pub fn enclose_f64(x: &Rational) -> (f64, f64) {
    float::enclose_quotient(x.numer(), x.denom())
}

/// The rational that the double x is, exactly; `None` for infinities and NaN.
///
/// The name is loud because a double is rarely the number its writer meant: 0.3 is not 3/10.
pub fn from_f64_exact(x: f64) -> Option<Rational> {
    Rational::from_float(x)
}

/// The rational number that a double most likely stands for after a few roundings (a change of units, a
/// quotient of steps): a decimal of at most twelve digits within 2^-51 |x|, or p/q with p q below 2^40, else
/// the shortest decimal that rounds to x. `None` for infinities and NaN.
///
/// ```
/// use kickdrift_number::rational::{from_f64_meant, ratio};
/// assert_eq!(from_f64_meant(0.1 + 0.2), Some(ratio(3, 10)));
/// assert_eq!(from_f64_meant(0.004 / 9.0 * 1000.0), Some(ratio(4, 9)));
/// ```
pub fn from_f64_meant(x: f64) -> Option<Rational> {
    let (exact, sign) = (from_f64_exact(x.abs())?, if x < 0.0 { -1 } else { 1 });
    let off = &exact / Rational::from_integer(BigInt::one() << 51);
    let (lo, hi) = (&exact - &off, &exact + &off);
    let short = (0..12)
        .map(|digits| decimal(&format!("{:.digits$e}", x.abs())))
        .find(|value| lo <= *value && *value <= hi);
    let fraction = || {
        let value = simplest(&lo, &hi);
        (value.numer().bits() + value.denom().bits() <= 40).then_some(value)
    };
    let value = short.or_else(fraction).unwrap_or_else(|| decimal(&format!("{:e}", x.abs())));
    Some(value * Rational::from_integer(sign.into()))
}

/// `1.25e-3`, as Rust writes doubles.
fn decimal(text: &str) -> Rational {
    let (digits, power) = text.split_once('e').expect("an exponent");
    let places = digits.split_once('.').map_or(0, |(_, behind)| behind.len());
    let whole: BigInt = digits.replace('.', "").parse().expect("digits");
    let power = power.parse::<i32>().expect("an exponent") - places as i32;
    Rational::from_integer(whole) * Rational::from_integer(10.into()).pow(power)
}

/// x 2^k, exactly. Its lowest terms are found by shifts, for a greatest common divisor costs the square of
/// the digits.
///
/// ```
/// use kickdrift_number::rational::{ratio, scale2};
/// assert_eq!([scale2(&12.into(), -5), scale2(&12.into(), -2), scale2(&0.into(), -3)], [ratio(3, 8), ratio(3, 1), ratio(0, 1)]);
/// ```
pub fn scale2(x: &BigInt, k: i64) -> Rational {
    if k >= 0 {
        return Rational::from_integer(x << k.unsigned_abs());
    }
    let places = k.unsigned_abs();
    let common = x.trailing_zeros().map_or(places, |zeros| zeros.min(places));
    Rational::new_raw(x >> common, BigInt::from(1) << (places - common))
}

/// The rational of least denominator in [lo, hi], 0 < lo ≤ hi (Stern and Brocot): the terms that the
/// continued fractions of lo and hi have in common, and the least that fits for the last one. Whole numbers
/// that stay coprime: nothing is ever reduced.
pub fn simplest(lo: &Rational, hi: &Rational) -> Rational {
    let (mut lo, mut hi) = (lo.clone().into_raw(), hi.clone().into_raw());
    let (mut before, mut now) = ((BigInt::zero(), BigInt::one()), (BigInt::one(), BigInt::zero()));
    loop {
        let (mut term, rest) = lo.0.div_mod_floor(&lo.1);
        let (top, above) = hi.0.div_mod_floor(&hi.1);
        let is_last = rest.is_zero() || term < top;
        if !rest.is_zero() && is_last {
            term += 1u8;
        }
        let next = (&now.0 * &term + before.0, &now.1 * &term + before.1);
        (before, now) = (now, next);
        if is_last {
            return Rational::new_raw(now.0, now.1);
        }
        // The next term's range, rest/lo.1 ≤ x ≤ above/hi.1, inverted.
        (lo, hi) = ((hi.1, above), (lo.1, rest));
    }
}

/// The simplest rational within half a unit in the last place of a double, what a rounded number most likely
/// stands for: 1/3 of 0.3333333333333333. `None` unless the double is finite.
pub fn simplest_beside(x: f64) -> Option<Rational> {
    let own = from_f64_exact(x.abs())?;
    let above = from_f64_exact(x.abs().next_up()).unwrap_or_else(|| own.clone());
    let half = (above - &own) / Rational::from_integer(2.into());
    let beside = if own.is_zero() { own } else { simplest(&(&own - &half), &(&own + &half)) };
    Some(if x < 0.0 { -beside } else { beside })
}
