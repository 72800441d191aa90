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

#[cfg(test)]
mod tests {
    use super::*;
    use num_traits::{Signed, Zero};
    use proptest::prelude::*;

    /// Nearest with ties to even, straight from the definition.
    fn is_nearest(x: &Rational, rounded: f64) -> bool {
        let distance = |d: f64| (from_f64_exact(d).expect("finite") - x).abs();
        let (own, below, above) = (distance(rounded), rounded.next_down(), rounded.next_up());
        let even = rounded.to_bits().is_multiple_of(2);
        [below, above]
            .iter()
            .filter(|d| d.is_finite())
            .all(|&d| own < distance(d) || (own == distance(d) && even))
    }

    fn is_enclosure(x: &Rational, (lo, hi): (f64, f64)) -> bool {
        let exact = |d: f64| from_f64_exact(d).expect("finite");
        let tight = if lo == hi { exact(lo) == *x } else { lo.next_up() == hi };
        tight && exact(lo) <= *x && *x <= exact(hi)
    }

    #[test]
    fn corners_of_the_double_range() {
        let max = from_f64_exact(f64::MAX).unwrap();
        let half_ulp = scale2(&1.into(), 969);
        assert_eq!(to_f64(&(&max + &half_ulp)), f64::MAX);
        assert_eq!(to_f64(&(&max + &half_ulp + &half_ulp)), f64::INFINITY);
        assert_eq!(enclose_f64(&(&max + &half_ulp)), (f64::MAX, f64::INFINITY));
        assert_eq!(enclose_f64(&-(&max + &half_ulp)), (f64::NEG_INFINITY, -f64::MAX));
        let tiny = scale2(&1.into(), -1075); // half the least subnormal: the tie goes to 0
        assert_eq!((to_f64(&tiny), enclose_f64(&tiny)), (0.0, (0.0, f64::from_bits(1))));
        assert_eq!(to_f64(&(&tiny * ratio(3, 2))), f64::from_bits(1));
        assert_eq!(to_f64(&scale2(&1.into(), -100_000)), 0.0);
        assert_eq!(enclose_f64(&-scale2(&1.into(), -100_000)), (-f64::from_bits(1), -0.0));
        assert_eq!(to_f64(&from_f64_exact(f64::MIN_POSITIVE).unwrap()), f64::MIN_POSITIVE);
        let below_normal = from_f64_exact(f64::MIN_POSITIVE.next_down()).unwrap();
        assert_eq!(to_f64(&below_normal), f64::MIN_POSITIVE.next_down());
    }

    proptest! {
        #[test]
        fn doubles_survive_the_round_trip(bits: u64) {
            let x = f64::from_bits(bits);
            prop_assume!(x.is_finite());
            let exact = from_f64_exact(x).unwrap();
            prop_assert_eq!(to_f64(&exact), x);
            prop_assert_eq!(enclose_f64(&exact), (x, x));
        }

        #[test]
        fn rounding_follows_its_definition(p: i64, q in 1i64.., k in -1140i64..960) {
            let x = ratio(p, q) * scale2(&1.into(), k);
            prop_assume!(!x.is_zero());
            prop_assert!(is_nearest(&x, to_f64(&x)));
            prop_assert!(is_enclosure(&x, enclose_f64(&x)));
        }

        #[test]
        fn ties_go_to_even(mantissa in 1u64 << 52..(1 << 53) - 1, k in -1080i64..900) {
            let tie = scale2(&(BigInt::from(mantissa) * 2 + 1), k);
            prop_assert!(is_nearest(&tie, to_f64(&tie)));
            prop_assert!(is_enclosure(&tie, enclose_f64(&tie)));
        }
    }
}
