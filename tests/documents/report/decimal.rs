//! Enclosures in decimal.

use kickdrift::number::Rational;
use kickdrift::number::parse::parse_rational;
use kickdrift::number::rational::from_f64_exact;
use kickdrift::report::decimal::*;
use num_bigint::BigInt;
use proptest::prelude::*;

fn power_of_ten(n: i32) -> Rational {
    Rational::from_integer(10.into()).pow(n)
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).expect("finite")
}

/// What the text claims, read back from the text alone.
fn claimed(text: &str) -> (Rational, Rational) {
    let (mantissa, power) = text.split_once('e').unwrap_or((text, "0"));
    let (number, units) = mantissa.split_once('(').unwrap_or((mantissa, "0)"));
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let digits: BigInt = format!("{whole}{fraction}").parse().unwrap();
    let units: BigInt = units.trim_end_matches(')').parse().unwrap();
    let power = power.parse::<i32>().unwrap() - fraction.len() as i32;
    let scale = power_of_ten(power);
    let at = |n: BigInt| Rational::from_integer(n) * &scale;
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
        prop_assert!(low <= exact(lo) && exact(hi) <= high, "{} for [{:?}, {:?}]", shown, lo, hi);
        // Sharp: never more than ten times as wide, plus a unit where a double needs 17 digits.
        let unit = &high - &low;
        let width = exact(hi) - exact(lo);
        let ulp = exact(lo.abs().max(hi.abs())) * Rational::new(1.into(), BigInt::from(10).pow(15));
        prop_assert!(unit <= width * Rational::from_integer(20.into()) + ulp);
    }
}

proptest! {
    #[test]
    fn what_is_written_contains_the_enclosure(n in 1u64.., d in 1u64.., k in -300i32..300, digits in 1u32..60) {
        let lo = Rational::new(n.into(), d.into()) * power_of_ten(k);
        let hi = &lo + &lo * Rational::new(1.into(), 1_000_003.into());
        let [low, high] = outward(&lo, &hi, digits).map(|text| parse_rational("end", &text).unwrap());
        prop_assert!(low <= lo && hi <= high);
        // Sharp: each end moved by less than one unit of the last digit.
        let exponent = (-330..330).rev().find(|&e| power_of_ten(e) <= hi).unwrap();
            let unit = power_of_ten(exponent + 1 - digits as i32);
        prop_assert!(&lo - &low < unit && &high - &hi < unit);
    }
}

#[test]
fn rounding_for_people_keeps_the_leading_digits() {
    assert_eq!([1234.56789, 0.0, -1.23456e-9].map(|x| rounded(x, 4)), [1235.0, 0.0, -1.235e-9]);
    assert!(rounded(f64::INFINITY, 3).is_infinite());
    assert_eq!([7.6849e10, 0.012, 1.0].map(|x| few(x, 3)), ["7.68e10", "0.012", "1"]);
}
