//! The rationals: exact arithmetic, signs by inspection, doubles with known rounding.
//!
//! ```
//! use kickdrift::number::{Rational, Real, rational};
//! let third = Rational::new(1.into(), 3.into());
//! let (lo, hi) = rational::enclose_f64(&third);
//! assert!(lo < hi && hi == lo.next_up() && rational::to_f64(&third) == 1.0 / 3.0);
//! assert!(third.enclosure(100).lower() <= third && third <= third.enclosure(100).upper());
//! ```

use num_bigint::BigInt;

use super::{Rational, float};

/// The rational p/q of two machine integers.
///
/// **Panics** if q = 0.
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

/// x 2^k, exactly.
pub fn scale2(x: &BigInt, k: i64) -> Rational {
    if k >= 0 {
        Rational::from_integer(x << k.unsigned_abs())
    } else {
        Rational::new(x.clone(), BigInt::from(1) << k.unsigned_abs())
    }
}
