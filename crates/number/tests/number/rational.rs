//! Rationals: rounding to doubles and back.

use kickdrift_number::Rational;
use kickdrift_number::rational::*;
use num_bigint::BigInt;
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

#[test]
fn a_double_that_came_by_a_few_roundings_is_what_was_meant() {
    for (x, meant) in [
        (0.02, ratio(1, 50)),
        (0.009000000000000001, ratio(9, 1000)),
        (-0.1 - 0.2, ratio(-3, 10)),
        (4.0 / 3.0, ratio(4, 3)),
        (0.0005 * 1000.0 / 7.0, ratio(1, 14)),
        (5e-16, ratio(1, 2_000_000_000_000_000)),
        (0.0, ratio(0, 1)),
        (0.731_058_578_630_004_9, ratio(7_310_585_786_300_049, 10_000_000_000_000_000)),
    ] {
        assert_eq!(from_f64_meant(x), Some(meant), "{x}");
    }
    assert!(from_f64_meant(f64::NAN).is_none() && from_f64_meant(f64::INFINITY).is_none());
}

#[test]
fn the_simplest_rational_has_the_least_denominator_of_all() {
    let mut seen = 0;
    for (a, b) in (1..60i64).flat_map(|b| (1..4 * b).map(move |a| (a, b))) {
        for width in [ratio(0, 1), ratio(1, 7 * b), ratio(1, 97), ratio(5, 3)] {
            let (lo, hi) = (ratio(a, b), ratio(a, b) + width);
            let found = simplest(&lo, &hi);
            assert!(lo <= found && found <= hi, "{found} in {lo}..{hi}");
            let least = (1..).map(BigInt::from).find(|d| {
                let numerator = (&lo * Rational::from_integer(d.clone())).ceil();
                numerator <= &hi * Rational::from_integer(d.clone())
            });
            assert_eq!(Some(found.denom()), least.as_ref(), "{lo}..{hi}");
            assert_eq!(Rational::new(found.numer().clone(), found.denom().clone()), found);
            seen += 1;
        }
    }
    assert!(seen > 10_000);
}

#[test]
fn rounded_numbers_stand_for_simple_ones() {
    for (p, q) in (1..200).flat_map(|q| (1..3 * q).map(move |p| (p, q))) {
        assert_eq!(simplest_beside(p as f64 / q as f64), Some(ratio(p, q)));
        assert_eq!(simplest_beside(-p as f64 / q as f64), Some(ratio(-p, q)));
    }
    assert_eq!(simplest_beside(0.0), Some(ratio(0, 1)));
    assert_eq!(simplest_beside(f64::NAN), None);
    for x in [f64::from_bits(1), f64::MIN_POSITIVE, f64::MAX, 0.1 + 0.2, std::f64::consts::PI] {
        assert_eq!(simplest_beside(x).map(|beside| to_f64(&beside)), Some(x), "{x}");
    }
}
