//! What went wrong elsewhere with intervals and balls: radii that are no numbers, ends rounded to the nearest
//! double, a tangent across its pole, intervals of no width.

use kickdrift_number::rational::{from_f64_exact, ratio};
use kickdrift_number::{Ball, Interval, Rational};
use proptest::prelude::*;

fn exact(x: f64) -> Rational {
    from_f64_exact(x).unwrap()
}

fn holds(interval: Interval, x: &Rational) -> bool {
    // An infinite end holds everything on its side.
    let below = |end: f64, x: &Rational| end == f64::NEG_INFINITY || exact(end) <= *x;
    below(interval.lo, x) && below(-interval.hi, &-x)
}

#[test]
fn a_radius_that_is_no_number_decides_nothing_whatever_is_done_with_it() {
    let unknown = Interval::around(1.0, f64::NAN);
    let sure = Interval::point(2.0);
    for x in [
        unknown,
        unknown + sure,
        unknown * sure,
        sure - unknown,
        sure / unknown,
        unknown / sure,
        unknown.half(),
    ] {
        assert_eq!((x.sign(), x.within(f64::INFINITY)), (None, false), "{x:?}");
    }
}

#[test]
fn nothing_times_everything_holds_nothing() {
    let everything = Interval::point(1.0) / Interval { lo: -1.0, hi: 1.0 };
    for zero in [Interval::point(0.0), Interval::point(-0.0), Interval { lo: 0.0, hi: 1.0 }] {
        for product in [zero * everything, everything * zero] {
            assert!(holds(product, &ratio(0, 1)) && product.sign().is_none(), "{product:?}");
        }
    }
}

#[test]
fn an_interval_of_no_width_is_its_number() {
    for x in [1.0, -3.5, 1e-300, f64::MIN_POSITIVE, f64::MAX] {
        let point = Interval::point(x);
        assert_eq!((point.width(), point.middle()), (0.0, x));
        assert_eq!(point.sign(), Some(x > 0.0));
        assert_eq!(point.within(0.0), x > 0.0);
        // x − x and x/x are not exact here, but hold 0 and 1.
        assert!(holds(point - point, &ratio(0, 1)) && holds(point / point, &ratio(1, 1)));
    }
    let zero = Interval::point(0.0);
    assert_eq!((zero.sign(), (zero * zero).sign(), (zero / zero).sign()), (None, None, None));
    let third = Ball::from_rational(&ratio(1, 3), 100);
    assert!(third.union(&third, 200).relative_accuracy_bits() > 95);
    assert!(Ball::one().union(&Ball::one(), 64).contains(&ratio(1, 1)));
}

#[test]
fn a_tangent_across_its_pole_is_refused_and_beside_it_has_its_sign() {
    let tangent = |x: &Ball| x.sin(128).div(&x.cos(128), 128);
    let quarter_turn = Ball::pi(128).scale2(-1);
    let beside = |off: i64| quarter_turn.add(&Ball::from_rational(&ratio(off, 1000), 128), 128);
    assert!(tangent(&quarter_turn).is_none());
    assert!(tangent(&beside(-1).union(&beside(1), 128)).is_none());
    let signs = [-1, 1].map(|off| tangent(&beside(off)).unwrap().mid_f64() > 0.0);
    assert_eq!(signs, [true, false]);
}

proptest! {
    /// Doubles of all sizes, so that hardly any result is one.
    #[test]
    fn ends_are_rounded_outwards_and_not_to_the_nearest(
        a in -1e150f64..1e150, b in -1e150f64..1e150, c in 1e-140f64..1.0, d in 1e-140f64..1.0,
    ) {
        for (x, y) in [(a, b), (a, c), (c, b), (c, d)] {
            let (p, q) = (Interval::point(x), Interval::point(y));
            let (e, f) = (exact(x), exact(y));
            prop_assert!(holds(p + q, &(&e + &f)) && holds(p - q, &(&e - &f)) && holds(p * q, &(&e * &f)));
            prop_assert!(holds(p.half(), &(&e / ratio(2, 1))));
            if y != 0.0 {
                prop_assert!(holds(p / q, &(&e / &f)));
                let quotient = Interval::of(&Ball::from_rational(&(&e / &f), 200));
                prop_assert!(holds(quotient, &(&e / &f)));
            }
        }
        prop_assert!(holds(Interval::point(c).over(d), &(exact(c) / exact(d))));
        prop_assert!(holds(Interval::point(c).under(d), &(exact(d) / exact(c))));
    }
}
