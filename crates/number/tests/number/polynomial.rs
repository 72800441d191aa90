use num_traits::{One, Signed, Zero};
use proptest::prelude::*;

use kickdrift_number::Rational;
use kickdrift_number::polynomial::*;
use kickdrift_number::rational::ratio;

type Q = Polynomial<Rational>;

fn any_polynomial(degree: usize) -> impl Strategy<Value = Q> {
    let coefficient = (-9i64..10, 1i64..4).prop_map(|(p, q)| ratio(p, q));
    proptest::collection::vec(coefficient, 0..=degree + 1).prop_map(Polynomial::new)
}

fn from_roots(roots: &[Rational]) -> Q {
    roots.iter().fold(Q::one(), |f, root| f * Q::new(vec![-root, Rational::one()]))
}

fn any_roots() -> impl Strategy<Value = Vec<Rational>> {
    proptest::collection::vec((-12i64..12, 1i64..5).prop_map(|(p, q)| ratio(p, q)), 0..6)
}

#[test]
fn text_of_nested_polynomials() {
    let rho = Polynomial::constant(Q::new(vec![ratio(1, 2), ratio(-1, 1)]));
    let s = Polynomial::<Q>::variable();
    let f = &(&rho * &s) - &Polynomial::constant(Q::constant(ratio(4, 1)));
    assert_eq!(f.text(&["s", "rho"]), "(-rho + 1/2)*s - 4");
    assert_eq!(Q::zero().text(&["x"]), "0");
}

/// Wilkinson's polynomial of degree 20, where floating-point roots go astray.
#[test]
fn wilkinson() {
    let roots: Vec<Rational> = (1..=20).map(|k| ratio(k, 1)).collect();
    let f = from_roots(&roots);
    assert_eq!(f.count_roots(&ratio(1, 1), &ratio(20, 1)), 20);
    assert_eq!(f.count_roots(&ratio(3, 2), &ratio(39, 2)), 18);
    assert_eq!(Sturm::new(&f).isolate().len(), 20);
}

proptest! {
    #[test]
    fn ring_laws_and_evaluation(a in any_polynomial(4), b in any_polynomial(4), c in any_polynomial(3), p in -9i64..9, q in 1i64..5) {
        let x = ratio(p, q);
        prop_assert_eq!(&(&a + &b) * &c, &(&a * &c) + &(&b * &c));
        prop_assert_eq!(&(&a - &b) + &b, a.clone());
        prop_assert_eq!((&a * &b).eval(&x), a.eval(&x) * b.eval(&x));
        prop_assert_eq!((&a * &b).derivative(), &(&a.derivative() * &b) + &(&a * &b.derivative()));
    }

    #[test]
    fn division_and_common_divisors(a in any_polynomial(5), b in any_polynomial(3), c in any_polynomial(2)) {
        if let Some((quotient, rest)) = a.div_rem(&b) {
            prop_assert!(rest.degree() < b.degree());
            prop_assert_eq!(&(&quotient * &b) + &rest, a.clone());
        }
        let gcd = (&a * &c).gcd(&(&b * &c));
        prop_assert_eq!(gcd.clone(), a.gcd(&b) * c.monic());
    }

    #[test]
    fn real_roots_are_found(roots in any_roots(), c in 1i64..9, lo in -13i64..13, hi in -13i64..13) {
        // A factor without real roots, and every root as often as drawn.
        let f = from_roots(&roots) * Q::new(vec![ratio(c, 1), ratio(1, 1), ratio(c, 1)]);
        let mut distinct = roots.clone();
        distinct.sort();
        distinct.dedup();
        let (lo, hi) = (ratio(lo, 2), ratio(hi, 2));
        let inside = distinct.iter().filter(|x| lo <= **x && **x <= hi).count();
        let sturm = Sturm::new(&f);
        prop_assert_eq!(sturm.count(&lo, &hi), inside);
        let intervals = sturm.isolate();
        prop_assert_eq!(intervals.len(), distinct.len());
        for (interval, root) in intervals.iter().zip(&distinct) {
            let (a, b) = sturm.refine(interval, &ratio(1, 1000));
            prop_assert!(interval.0 <= a && a <= *root && *root <= b && b <= interval.1);
            prop_assert!((b - a).abs() <= ratio(1, 1000));
        }
        for pair in intervals.windows(2) {
            prop_assert!(pair[0].1 <= pair[1].0);
        }
    }
}
