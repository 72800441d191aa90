//! Containment, by exact rationals, by identities, and by the same function at higher precision.

use proptest::prelude::*;

use super::*;
use crate::rational::{ratio, scale2};

/// A rational of any size from 2^-5000 to 2^5000, often short, sometimes 0.
fn any_rational() -> impl Strategy<Value = Rational> {
    let exponent = prop_oneof![-4i64..4, -70i64..70, -5000i64..5000];
    (-99i64..99, 1i64..99, any::<i64>(), exponent, any::<bool>()).prop_map(|(p, q, long, k, short)| {
        let numerator = if short { p } else { long };
        ratio(numerator, q) * scale2(&1.into(), k)
    })
}

/// A ball about x, exact or not, with x off its centre.
fn ball_about(x: &Rational, bits: u32, widen: Option<i64>) -> Ball {
    let ball = Ball::from_rational(x, bits);
    match (widen, ball.top()) {
        (Some(k), Some(top)) => ball.widened(Magnitude::power_of_two(top - k), bits),
        _ => ball,
    }
}

fn any_case() -> impl Strategy<Value = (Rational, Ball)> {
    (any_rational(), 2u32..200, proptest::option::of(-3i64..60))
        .prop_map(|(x, bits, widen)| (x.clone(), ball_about(&x, bits, widen)))
}

fn exact(text: &str) -> Rational {
    text.parse().expect("a rational")
}

proptest! {
    #[test]
    fn sums_products_and_quotients_contain_the_exact_ones((x, a) in any_case(), (y, b) in any_case(), bits in 2u32..200) {
        prop_assert!(a.contains(&x) && b.contains(&y));
        prop_assert!(a.add(&b, bits).contains(&(&x + &y)));
        prop_assert!(a.sub(&b, bits).contains(&(&x - &y)));
        prop_assert!(a.mul(&b, bits).contains(&(&x * &y)));
        prop_assert!(a.union(&b, bits).contains(&x) && a.union(&b, bits).contains(&y));
        match a.div(&b, bits) {
            Some(quotient) => prop_assert!(quotient.contains(&(&x / &y))),
            None => prop_assert!(b.lower() <= Rational::zero() && Rational::zero() <= b.upper()),
        }
        for ball in [a.add(&b, bits), a.mul(&b, bits), a.union(&b, bits)] {
            prop_assert!(ball.rad <= (1 << 30) + 1);
        }
    }

    #[test]
    fn whole_balls_are_mapped_not_only_centres((_, a) in any_case(), (_, b) in any_case(), bits in 2u32..100) {
        for x in [a.lower(), a.upper()] {
            for y in [b.lower(), b.upper()] {
                prop_assert!(a.add(&b, bits).contains(&(&x + &y)));
                prop_assert!(a.mul(&b, bits).contains(&(&x * &y)));
                if let Some(quotient) = a.div(&b, bits) {
                    prop_assert!(quotient.contains(&(&x / &y)));
                }
            }
            prop_assert!(a.abs().contains(&x.abs()) && a.neg().contains(&-&x));
            if let Some(root) = a.sqrt_clipped(bits) {
                let (lo, hi) = (root.lower().max(Rational::zero()), root.upper());
                prop_assert!(x.is_negative() || (&lo * &lo <= x && x <= &hi * &hi));
            } else {
                prop_assert!(a.upper().is_negative());
            }
        }
    }

    #[test]
    fn rounding_costs_about_the_asked_precision(x in any_rational(), y in any_rational(), bits in 10u32..300) {
        prop_assume!(!x.is_zero() && !y.is_zero());
        let (a, b) = (Ball::from_rational(&x, bits), Ball::from_rational(&y, bits));
        let wanted = i64::from(bits) - 4;
        prop_assert!(a.relative_accuracy_bits() >= wanted);
        prop_assert!(a.mul(&b, bits).relative_accuracy_bits() >= wanted);
        prop_assert!(a.div(&b, bits).expect("not 0").relative_accuracy_bits() >= wanted);
        prop_assert!(a.abs().sqrt(bits).expect(">= 0").relative_accuracy_bits() >= wanted);
        prop_assert!(a.abs().add(&b.abs(), bits).relative_accuracy_bits() >= wanted);
    }

    #[test]
    fn signs_and_order_are_right_or_unknown((x, a) in any_case(), (y, b) in any_case()) {
        if let Some(sign) = a.sign() {
            prop_assert_eq!(sign, crate::ExactSign::sign(&x));
        }
        match a.compare(&b) {
            Some(order) => prop_assert_eq!(order, x.cmp(&y)),
            None => prop_assert!(a.lower() <= b.upper() && b.lower() <= a.upper() && !(a.is_exact() && b.is_exact())),
        }
    }

    #[test]
    fn doubles_and_fixed_point_enclose_the_ball((_, a) in any_case(), fraction in -300i64..300) {
        let (lo, hi) = a.to_f64_enclosure();
        let inside = |d: f64, outer: &Rational| rational::from_f64_exact(d).is_none_or(|d| (&d - outer).is_zero() || d < *outer);
        prop_assert!(inside(lo, &a.lower()) && inside(-hi, &-a.upper()));
        prop_assert!(lo > f64::NEG_INFINITY || a.lower() < rational::from_f64_exact(-f64::MAX).unwrap());
        let (mid, error) = a.mid_scaled(fraction);
        let unit = scale2(&1.into(), -fraction);
        let (mid, error) = (Rational::from(mid) * &unit, Rational::from(error) * &unit);
        prop_assert!(&mid - &error <= a.lower() && a.upper() <= &mid + &error);
    }

    #[test]
    fn doubles_are_exact(lo in any::<f64>(), hi in any::<f64>()) {
        let all = [lo, hi].map(rational::from_f64_exact);
        let found = [lo, hi].map(|x| Ball::from_f64(x).map(|ball| [ball.lower(), ball.upper()]));
        prop_assert_eq!(found, all.clone().map(|x| x.map(|x| [x.clone(), x])));
        let between = Ball::between(lo, hi, 53);
        prop_assert_eq!(between.is_some(), all.iter().all(Option::is_some));
        prop_assert!(between.is_none_or(|ball| all.iter().flatten().all(|x| ball.contains(x))));
    }

    /// At p bits every function contains what it is at 4p bits, of the ball's points.
    #[test]
    fn functions_agree_across_precisions((x, a) in any_case(), p in 20u32..150, pick in 0u8..3) {
        let fine = Ball::from_rational(&x, 5 * p + 5200);
        let point = match pick { 0 => fine, 1 => a.ends().0, _ => a.ends().1 };
        let checked = |coarse: Ball, fine: Ball| -> bool { coarse.lower() <= fine.upper() && fine.lower() <= coarse.upper() };
        let q = 4 * p;
        prop_assert!(checked(a.atan(p), point.atan(q)));
        prop_assert!(checked(a.asinh(p), point.asinh(q)));
        prop_assert!(checked(a.sin(p), point.sin(q)), "sin {a:?}");
        prop_assert!(checked(a.cos(p), point.cos(q)));
        if a.top().is_none_or(|top| top <= 20) {
            prop_assert!(checked(a.exp(p), point.exp(q)));
        }
        if let Some(ln) = a.ln(p) {
            prop_assert!(checked(ln, point.ln(q).expect("inside a positive ball")));
        }
        if let (Some(coarse), Some(fine)) = (a.asin(p), point.asin(q)) {
            prop_assert!(checked(coarse, fine));
        }
        if let (Some(coarse), Some(fine)) = (a.acos(p), point.acos(q)) {
            prop_assert!(checked(coarse, fine));
        }
    }

    /// Functions of exact arguments reach the asked precision, relatively where that is promised.
    #[test]
    fn functions_reach_their_precision(p in any::<i64>(), q in 1i64..99, k in -5000i64..10, bits in 20u32..300) {
        prop_assume!(p != 0);
        let x = Ball::from_rational(&(ratio(p, q) * scale2(&1.into(), k - 63)), bits);
        let x = x.midpoint();
        let reached = |y: &Ball| y.relative_accuracy_bits() >= i64::from(bits) - 4;
        prop_assert!(reached(&x.atan(bits)));
        prop_assert!(reached(&x.asinh(bits)));
        prop_assert!(reached(&x.abs().ln(bits).expect("> 0")));
        prop_assert!(reached(&x.exp(bits)));
        if x.top().expect("not 0") < 0 {
            prop_assert!(reached(&x.sin(bits)));
            prop_assert!(reached(&x.asin(bits).expect("inside")));
        }
        let cosine = x.cos(bits);
        prop_assert!(cosine.upper() - cosine.lower() <= scale2(&32.into(), -i64::from(bits)));
    }

    #[test]
    fn identities_hold_inside_the_balls(p in any::<i64>(), k in 0i64..70, bits in 30u32..400) {
        let x = Ball::from_rational(&scale2(&p.into(), -k), 2 * bits + 64);
        let tight = |residue: Ball| residue.contains_zero() && residue.magnitude().top().is_none_or(|t| t <= 16 - i64::from(bits));
        let (sine, cosine, one) = (x.sin(bits), x.cos(bits), Ball::one());
        prop_assert!(tight(sine.square(bits).add(&cosine.square(bits), bits).sub(&one, bits)));
        // tan(arctan x) = x: sin = x cos of that angle.
        let angle = x.atan(bits);
        let relative = angle.sin(bits).sub(&x.mul(&angle.cos(bits), bits), bits);
        prop_assert!(relative.contains_zero());
        if let Some(ln) = x.ln(bits) {
            prop_assert!(tight(ln.exp(bits).div(&x, bits).expect("> 0").sub(&one, bits)));
        }
        // sinh(arsinh x) = x.
        let y = x.abs().asinh(bits);
        let sinh = y.exp(bits).sub(&y.neg().exp(bits), bits).scale2(-1);
        prop_assert!(sinh.sub(&x.abs(), bits).contains_zero());
        if let (Some(angle), Some(turned)) = (x.asin(bits), x.acos(bits)) {
            prop_assert!(tight(angle.add(&turned, bits).sub(&Ball::pi(bits).scale2(-1), bits)));
            prop_assert!(angle.sin(bits).sub(&x, bits).contains_zero());
        }
    }
}

#[test]
fn known_digits() {
    let digits = |text: &str| exact(&format!("{text}/1{}", "0".repeat(60)));
    let unit = exact(&format!("1/1{}", "0".repeat(60)));
    let close = |ball: Ball, text: &str| {
        let known = digits(text); // truncated after 60 places
        ball.upper() >= known && ball.lower() <= &known + &unit && ball.relative_accuracy_bits() > 200
    };
    assert!(close(Ball::pi(220), "3141592653589793238462643383279502884197169399375105820974944"));
    assert!(close(Ball::ln2(220), "693147180559945309417232121458176568075500134360255254120680"));
    assert!(close(Ball::one().exp(220), "2718281828459045235360287471352662497757247093699959574966967"));
    assert!(close(Ball::one().sin(220), "841470984807896506652502321630298999622563060798371065672751"));
    assert!(close(Ball::one().asinh(220), "881373587019543025232609324979792309028160328261635410753295"));
}

#[test]
fn exact_results_stay_exact() {
    let ball = |x: Rational| Ball::from_rational(&x, 64);
    assert!(ball(ratio(3, 8)).add(&ball(ratio(1, 8)), 64).is_exact());
    assert!(ball(ratio(3, 8)).mul(&ball(ratio(5, 2)), 64).is_exact());
    assert!(ball(ratio(9, 4)).sqrt(64).unwrap().is_exact());
    assert_eq!(ball(ratio(3, 8)).sub(&ball(ratio(3, 8)), 64).sign(), Some(Sign::Zero));
    assert_eq!(Ball::zero().cos(64).compare(&Ball::one()), Some(Ordering::Equal));
}

#[test]
fn the_union_of_close_balls_is_as_narrow_as_their_distance() {
    let (a, gap) = (Ball::from_rational(&ratio(1, 3), 300), Ball::one().scale2(-200));
    let union = a.union(&a.add(&gap, 300), 300);
    assert!(union.relative_accuracy_bits() > 195);
}

#[test]
fn domains_end_where_they_should() {
    let (one, tiny) = (Ball::one(), Ball::one().scale2(-5000));
    assert!(one.div(&Ball::zero(), 64).is_none());
    assert!(one.neg().sqrt(64).is_none() && one.neg().sqrt_clipped(64).is_none());
    assert!(Ball::zero().ln(64).is_none() && one.neg().ln(64).is_none());
    assert!(one.scale2(1).asin(64).is_none() && one.scale2(1).neg().acos(64).is_none());
    assert_eq!(one.acos(64).unwrap().sign(), Some(Sign::Zero));
    assert!(one.sub(&tiny, 6000).acos(64).unwrap().relative_accuracy_bits() > 58);
    assert!(one.asin(64).unwrap().sub(&Ball::pi(64).scale2(-1), 64).contains_zero());
}

#[test]
fn an_exponential_beyond_all_exponents_is_enclosed_from_0_on() {
    for exponent in [41, 60, 100, 4000] {
        let huge = Ball::one().scale2(exponent).neg();
        let tiny = huge.exp(64);
        assert_eq!(tiny.compare(&Ball::zero().widened(Magnitude::power_of_two(-1000), 64)), None);
        assert!(tiny.compare(&Ball::one().scale2(-1000)) == Some(Ordering::Less) && !tiny.mid.is_negative());
    }
    // From there up to e.
    let wide = Ball::one().scale2(41).neg().union(&Ball::one(), 64).exp(64);
    assert!(wide.contains(&Rational::default()) && wide.contains(&Rational::from_integer(2.into())));
}

#[test]
fn what_is_below_the_least_exponent_becomes_a_ball_about_zero() {
    let least = Ball::one().scale2(-MAX_EXPONENT);
    let below = least.square(64);
    assert!(below.contains_zero() && below.rad > 0 && below.top().unwrap() <= -MAX_EXPONENT + 1);
    let long = Ball::from_integer(&((BigInt::one() << 200) - 1)).scale2(-MAX_EXPONENT - 100);
    assert!(long.top().unwrap() >= -MAX_EXPONENT + 100);
}

/// A third, its double's neighbours, and the middle between two doubles with an error on either side of it.
#[test]
fn the_nearest_double_is_that_of_the_number_and_not_the_one_below() {
    let third = |bits| Ball::from_rational(&ratio(2, 3), bits);
    assert_eq!(Ball::nearest_f64(third), 2.0 / 3.0);
    assert_eq!(third(200).mid_f64(), 2.0 / 3.0);
    assert_eq!(third(200).neg().mid_f64(), -2.0 / 3.0);
    // 1 + 2^-53 + 2^-200: bits up to 192 leave it open, and it lies nearer to the double above.
    let one = BigInt::from(1);
    let number = Rational::new((&one << 200usize) + (&one << 147usize) + 1, &one << 200usize);
    let seen = std::cell::Cell::new(0);
    let nearest = Ball::nearest_f64(|bits| {
        seen.set(bits);
        Ball::from_rational(&number, bits)
    });
    assert_eq!((nearest, seen.get() > 192), (1f64.next_up(), true));
    assert_eq!(Ball::from_rational(&ratio(1, 1), 64).scale2(5000).mid_f64(), f64::MAX);
}

#[test]
fn a_ball_knows_its_middle_and_how_many_bits_its_radius_leaves() {
    // 1000 has ten bits, 3 has two.
    let ball = Ball { mid: 1000.into(), rad: 3, exp: -7 };
    assert_eq!(ball.relative_accuracy_bits(), 8);
    assert_eq!(Ball { rad: 0, ..ball.clone() }.relative_accuracy_bits(), i64::MAX);
    assert_eq!(ball.middle(), (&1000.into(), -7));
    let (n, exp) = ball.middle();
    assert!(Ball::from_integer(n).scale2(exp).sub(&ball.midpoint(), 64).is_exact());
    // 1000 is 8 · 125: down to eighths its floor is the number itself, and no further.
    let scaled = |shift: i64| Ball { exp: 0, ..ball.clone() }.mid_scaled(-shift);
    assert_eq!(scaled(3), (125.into(), 1.into()));
    assert_eq!(scaled(4), (62.into(), 2.into()));
    assert_eq!(scaled(0), (1000.into(), 3.into()));
    assert_eq!(scaled(-1), (2000.into(), 6.into()));
}

/// Bits are doubled until the radius leaves more than those asked for, and none is asked for in vain.
#[test]
fn a_number_is_evaluated_until_it_is_known_well_enough() {
    let asked = std::cell::RefCell::new(Vec::new());
    let evaluated = |lost: u32| {
        let asked = &asked;
        move |bits: u32| {
            asked.borrow_mut().push(bits);
            // A third, of which so many of the bits are lost.
            let third = Ball::from_rational(&ratio(1, 3), bits);
            third.widened(Magnitude::power_of_two(i64::from(lost) - i64::from(bits)), bits)
        }
    };
    for (bits, lost, times) in [(53, 0, 1), (53, 40, 2), (53, 150, 3), (10, 30, 2), (200, 31, 2)] {
        asked.borrow_mut().clear();
        let known = Ball::to_accuracy(bits, evaluated(lost));
        let steps: Vec<u32> = (0..times).map(|k| (bits + 32) << k).collect();
        assert_eq!(*asked.borrow(), steps, "{bits} bits, {lost} lost");
        assert!(known.contains(&ratio(1, 3)) && known.relative_accuracy_bits() >= i64::from(bits) - 1);
    }
    // As many bits as were asked for are not more than those.
    let tries = std::cell::Cell::new(0);
    let known = Ball::to_accuracy(20, |_| {
        tries.set(tries.get() + 1);
        Ball { mid: BigInt::one() << (19 + tries.get()), rad: 1, exp: 0 }
    });
    assert_eq!((tries.get(), known.top()), (2, Some(22)));
}
