use proptest::prelude::*;

use kickdrift_number::rational::{ratio, to_f64};
use kickdrift_number::{
    Ball, Cyclotomic, CyclotomicField, ExactSign, NumberField, Polynomial, Rational, Real, Ring, Sign,
};
use num_traits::{One, Zero};

fn integers(coefficients: &[i64]) -> Polynomial<Rational> {
    Polynomial::new(coefficients.iter().map(|&c| ratio(c, 1)).collect())
}

#[test]
fn known_minimal_polynomials() {
    let known: [(u32, &[i64]); 9] = [
        (1, &[2, 1]),
        (2, &[0, 1]),
        (3, &[-1, 1]),
        (4, &[-2, 0, 1]),
        (5, &[-1, -1, 1]),
        (6, &[-3, 0, 1]),
        (7, &[1, -2, -1, 1]),
        (8, &[2, 0, -4, 0, 1]),
        (12, &[1, 0, -4, 0, 1]),
    ];
    for (n, coefficients) in known {
        assert_eq!(CyclotomicField::new(n).minimal_polynomial(), integers(coefficients), "n = {n}");
    }
}

/// φ(2n)/2, by counting.
#[test]
fn degrees_and_roots() {
    for n in 2u32..60 {
        let field = CyclotomicField::new(n);
        let units = (1..2 * n).filter(|k| num_integer::gcd(*k, 2 * n) == 1).count();
        assert_eq!(field.degree(), units / 2, "n = {n}");
        // ψ at a ball about c holds 0 and is small.
        let c = field.two_cos(1).enclosure(300);
        let value = field
            .minimal_polynomial()
            .coefficients()
            .iter()
            .rev()
            .fold(Ball::zero(), |value, k| value.mul(&c, 300).add(&Ball::from_rational(k, 300), 300));
        assert!(value.contains_zero() && value.top().is_none_or(|top| top < -200), "n = {n}");
    }
}

/// T_p(1 − s/2) = cos(p θ) = (−1)^m at every resonant s, by the recurrence of 2cos(k θ) and exactly.
#[test]
fn chebyshev_at_the_resonances() {
    let integer = |n: i64| Cyclotomic::from_rational(&ratio(n, 1));
    for p in 1u32..25 {
        let field = CyclotomicField::new(p);
        for m in 0..=i64::from(p) {
            let c = &integer(2) - &field.resonant_s(m); // 2cos θ
            let (mut before, mut now) = (integer(2), c.clone());
            for _ in 1..p {
                let next = &(&c * &now) - &before;
                (before, now) = (now, next);
            }
            assert_eq!(now, integer(if m % 2 == 0 { 2 } else { -2 }), "p = {p}, m = {m}");
        }
    }
}

#[test]
fn values_and_signs_agree_with_doubles() {
    for n in 1u32..40 {
        let field = CyclotomicField::new(n);
        for m in -3..2 * i64::from(n) {
            let exact = field.two_cos(m);
            let close = 2.0 * (m as f64 * std::f64::consts::PI / f64::from(n)).cos();
            let (lo, hi) = exact.enclosure(60).to_f64_enclosure();
            assert!((lo - close).abs() < 1e-12 && (hi - close).abs() < 1e-12, "{m}/{n}");
            let is_zero = 2 * m.rem_euclid(i64::from(n)) == i64::from(n);
            assert_eq!(exact.sign() == Sign::Zero, is_zero, "{m}/{n}");
            assert!(is_zero || (exact.sign() == Sign::Positive) == (close > 0.0), "{m}/{n}");
        }
    }
}

#[test]
#[should_panic(expected = "mixed")]
fn fields_do_not_mix() {
    let _ = Cyclotomic::two_cos(1, 5) + Cyclotomic::two_cos(1, 7);
}

#[test]
fn text_names_the_generator() {
    assert_eq!(Cyclotomic::two_cos(2, 7).to_string(), "c^2 - 2 [c = 2cos(pi/7)]");
    assert_eq!(Cyclotomic::resonant_s(1, 3).to_string(), "1");
}

proptest! {
    #[test]
    fn field_laws(n in 1u32..20, a in proptest::collection::vec(-9i64..9, 0..6), b in proptest::collection::vec(-9i64..9, 0..6), q in 1i64..5) {
        let field = CyclotomicField::new(n);
        let (x, y) = (field.element(integers(&a)), field.element(integers(&b).scale(&ratio(1, q))));
        prop_assert_eq!(&(&x + &y) * &(&x - &y), &(&x * &x) - &(&y * &y));
        prop_assert_eq!((&x * &y).sign(), x.sign() * y.sign());
        match x.inverse() {
            Some(inverse) => prop_assert_eq!(&inverse * &x, Cyclotomic::one()),
            None => prop_assert!(x.is_zero()),
        }
        let product = (&x * &y).enclosure(80);
        let factors = x.enclosure(80).mul(&y.enclosure(80), 80);
        prop_assert!(product.sub(&factors, 80).contains_zero());
        if let Some(r) = x.as_rational() {
            prop_assert!(to_f64(&r).is_finite());
        }
    }

    /// 2cos(aπ/n) 2cos(bπ/n) = 2cos((a+b)π/n) + 2cos((a−b)π/n).
    #[test]
    fn product_formula(n in 1u32..60, a in -99i64..99, b in -99i64..99) {
        let field = CyclotomicField::new(n);
        prop_assert_eq!(&field.two_cos(a) * &field.two_cos(b), &field.two_cos(a + b) + &field.two_cos(a - b));
    }
}
