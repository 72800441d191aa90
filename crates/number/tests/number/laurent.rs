use proptest::prelude::*;

use kickdrift_number::rational::ratio;
use kickdrift_number::{ExactSign, Laurent, Rational, Real, Sign};
use num_traits::{One, Zero};

pub fn any_laurent() -> impl Strategy<Value = Laurent> {
    let term = (-4i32..5, -20i64..20, 1i64..20);
    proptest::collection::vec(term, 0..4).prop_map(|terms| {
        terms.into_iter().fold(Laurent::zero(), |sum, (k, p, q)| sum + Laurent::monomial(ratio(p, q), k))
    })
}

/// Convergents of π, down to ones that doubles cannot tell from it.
#[test]
fn signs_of_near_zeros() {
    let pi = Laurent::pi_power(1);
    let convergents = [
        ("103993", "33102", Sign::Negative),
        ("104348", "33215", Sign::Positive),
        ("2646693125139304345", "842468587426513207", Sign::Negative),
    ];
    for (p, q, sign) in convergents {
        let convergent = Rational::new(p.parse().unwrap(), q.parse().unwrap());
        assert_eq!((Laurent::from_rational(convergent) - pi.clone()).sign(), sign, "{p}/{q}");
    }
    let digits: Rational =
        format!("31415926535897932384626433832795028841971/1{}", "0".repeat(40)).parse().unwrap();
    let gap = pi.clone() - Laurent::from_rational(digits);
    assert_eq!(gap.sign(), Sign::Positive);
    assert!(gap.to_f64() > 6.9e-41 && gap.to_f64() < 7e-41);
    assert!(gap.enclosure(200).relative_accuracy_bits() >= 200);
}

#[test]
fn doubles_of_pi() {
    let pi = Laurent::pi_power(1);
    assert_eq!(pi.to_f64(), std::f64::consts::PI);
    assert_eq!(pi.enclose_f64(), (std::f64::consts::PI, std::f64::consts::PI.next_up()));
    assert_eq!(Laurent::from_integer(3).enclose_f64(), (3.0, 3.0));
    assert_eq!(Laurent::pi_power(1000).to_f64(), f64::INFINITY);
    assert_eq!(Laurent::pi_power(-1000).enclose_f64(), (0.0, f64::from_bits(1)));
}

#[test]
fn quotients_and_ratios() {
    let sum = Laurent::one() + Laurent::pi_power(1);
    assert_eq!(Laurent::one().checked_div(&sum), None);
    assert_eq!(sum.checked_div(&Laurent::zero()), None);
    let times = |n| &sum * &Laurent::from_integer(n);
    assert_eq!(Laurent::ratio(&times(6), &times(4)), Some(ratio(3, 2)));
    assert_eq!(Laurent::ratio(&sum, &Laurent::one()), None);
    assert_eq!(Laurent::ratio(&Laurent::zero(), &sum), Some(Rational::zero()));
    assert_eq!(Laurent::ratio(&sum, &Laurent::zero()), None);
}

proptest! {
    #[test]
    fn ring_laws(a in any_laurent(), b in any_laurent(), c in any_laurent(), n in 0i32..5) {
        prop_assert_eq!(&(&a + &b) * &c, &(&a * &c) + &(&b * &c));
        prop_assert_eq!(&(&a - &b) + &b, a.clone());
        prop_assert_eq!(&a * &b, &b * &a);
        prop_assert_eq!(a.pow(n + 1).unwrap(), &a.pow(n).unwrap() * &a);
        if let Some(quotient) = a.checked_div(&b) {
            prop_assert_eq!(&quotient * &b, a.clone());
        }
    }

    #[test]
    fn order_and_enclosures_agree(a in any_laurent(), b in any_laurent(), bits in 20u32..300) {
        let (x, y) = (a.enclosure(bits), b.enclosure(bits));
        prop_assert!(x.relative_accuracy_bits() >= i64::from(bits));
        if let Some(order) = x.compare(&y) {
            prop_assert_eq!(order, a.cmp(&b));
        }
        let (lo, hi) = a.enclose_f64();
        prop_assert!(lo <= a.to_f64() && a.to_f64() <= hi);
        let outer = a.enclosure(53).to_f64_enclosure();
        prop_assert!(outer.0 <= lo && hi <= outer.1);
        prop_assert_eq!(a.sign(), Sign::from_ordering(a.cmp(&Laurent::zero())));
    }
}
