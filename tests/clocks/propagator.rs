//! The algebra's identities, in exact arithmetic.

use kickdrift::number::rational::ratio;
use kickdrift::number::{Ratio, Rational};
use kickdrift::propagator::methods::{avi, respa, verlet};
use kickdrift::propagator::{HalfPeriod, TwoClocks, drift, full_period, half_period, kick};
use nalgebra::Matrix2;
use num_integer::Integer;
use proptest::prelude::*;

fn pair() -> impl Strategy<Value = TwoClocks<Rational>> {
    (1u64..30, 1u64..30, 1i64..900, 1i64..200, -400i64..400, 1i64..100).prop_map(|(p, q, s, d, k, e)| {
        TwoClocks::new(Ratio::new(p / p.gcd(&q), q / p.gcd(&q)).unwrap(), ratio(s, d), ratio(k, e))
    })
}

fn trace(m: &Matrix2<Rational>) -> Rational {
    &m[(0, 0)] + &m[(1, 1)]
}

fn determinant(m: &Matrix2<Rational>) -> Rational {
    &m[(0, 0)] * &m[(1, 1)] - &m[(0, 1)] * &m[(1, 0)]
}

/// (Q_fast)^m = G R(m th) G⁻¹, with G = diag(1, sin(th)/h1) and R(m th) = [[cos, sin], [−sin, cos]], in
/// doubles; 0 < h1² L1 < 4.
fn rotated(h1: f64, m: u64, lambda1: f64) -> Matrix2<f64> {
    let s = h1 * h1 * lambda1;
    let (sin, cos) = ((s * (1.0 - s / 4.0)).sqrt(), 1.0 - s / 2.0);
    let (sin_m, cos_m) = (m as f64 * sin.atan2(cos)).sin_cos();
    let g = sin / h1;
    Matrix2::new(1.0, 0.0, 0.0, g)
        * Matrix2::new(cos_m, sin_m, -sin_m, cos_m)
        * Matrix2::new(1.0, 0.0, 0.0, 1.0 / g)
}

proptest! {
    #[test]
    fn determinants_are_one(clocks in pair()) {
        prop_assert_eq!(determinant(&full_period(&clocks)), ratio(1, 1));
        prop_assert_eq!(determinant(half_period(&clocks).matrix()), ratio(1, 1));
        prop_assert_eq!(determinant(&avi::staggered(&clocks)), ratio(1, 1));
    }

    #[test]
    fn the_full_period_is_the_reversed_half_times_the_half(clocks in pair()) {
        prop_assert_eq!(half_period(&clocks).full(), full_period(&clocks));
    }

    #[test]
    fn the_trace_is_two_plus_4bc_and_4ad_minus_two(clocks in pair()) {
        let half: HalfPeriod<Rational> = half_period(&clocks);
        let full = trace(&full_period(&clocks));
        prop_assert_eq!(&full - ratio(2, 1), half.b() * half.c() * ratio(4, 1));
        prop_assert_eq!(&full + ratio(2, 1), half.a() * half.d() * ratio(4, 1));
        prop_assert_eq!(full, half.trace());
    }

    #[test]
    fn staggered_and_symmetric_avi_have_one_trace(clocks in pair()) {
        prop_assert_eq!(trace(&avi::staggered(&clocks)), trace(&avi::symmetric(&clocks)));
    }

    #[test]
    fn q_equal_1_is_respa(p in 1u64..40, s in 1i64..400, k in -100i64..100) {
        let clocks = TwoClocks::new(Ratio::new(p, 1).unwrap(), ratio(s, 100), ratio(k, 30));
        // In the time unit h1 = 1: lambda1 = s and lambda2 = slow/p.
        let lambda2 = clocks.slow() / ratio(p as i64, 1);
        let closed_form = respa::propagator(ratio(1, 1), p, clocks.fast().clone(), lambda2);
        prop_assert_eq!(full_period(&clocks), closed_form);
    }

    #[test]
    fn swapping_the_clocks_changes_no_trace(clocks in pair()) {
        prop_assert_eq!(half_period(&clocks).trace(), half_period(&clocks.swapped()).trace());
        prop_assert_eq!(clocks.swapped().swapped(), clocks);
    }
}

proptest! {
    #[test]
    fn powers_of_the_fast_step_are_rotations(h1 in 0.1f64..1.0, s in 0.1f64..3.9, m in 0u64..50) {
        let lambda1 = s / (h1 * h1);
        let exact = respa::power(verlet::velocity_form(h1, lambda1), m);
        // Condition: entries of G, G⁻¹ below 10, angle error m ulp / sin th below 50 · 1e-16 / 0.15.
        prop_assert!((exact - rotated(h1, m, lambda1)).amax() < 1e-11);
    }
}

#[test]
fn the_trace_is_the_papers_formula() {
    let (h1, m, lambda1, lambda2) = (0.3, 7, 2.0, 0.5);
    let s: f64 = h1 * h1 * lambda1;
    let theta = (1.0 - s / 2.0f64).acos();
    let alpha = h1 * h1 * 7.0 * lambda2 / (2.0 * theta.sin());
    let formula = 2.0 * ((7.0 * theta).cos() - alpha * (7.0 * theta).sin());
    // A dozen products of numbers of size about 1.
    assert!((respa::propagator(h1, m, lambda1, lambda2).trace() - formula).abs() < 1e-13);
}

proptest! {
    #[test]
    fn velocity_form_is_the_closed_form_and_the_staggered_form_its_conjugate(
        n in 1i64..1000, d in 1i64..1000, l in -1000i64..1000, e in 1i64..1000,
    ) {
        let r = |n: i64, d: i64| Rational::new(n.into(), d.into());
        let (h, l) = (r(n, d), r(l, e));
        let s = &h * &h * &l;
        let diagonal = r(1, 1) - &s / r(2, 1);
        let corner = -&h * &l * (r(1, 1) - &s / r(4, 1));
        let velocity = verlet::velocity_form(h.clone(), l.clone());
        prop_assert_eq!(&velocity, &Matrix2::new(diagonal.clone(), h.clone(), corner, diagonal));
        let half_kick = kick(&h * &l / r(2, 1));
        let staggered = drift(h.clone()) * kick(&h * &l);
        prop_assert_eq!(&half_kick * staggered, velocity * half_kick);
    }
}
