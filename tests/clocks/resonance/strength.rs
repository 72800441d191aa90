//! The strength of a resonance, by quadrature and beside known edges.

use kickdrift::number::rational::ratio;
use kickdrift::resonance::{first_order, strength};

/// The defining integral by the composite Simpson rule; its error is O(n^-4) with bounded derivatives.
fn by_quadrature(a: i64, theta: f64) -> f64 {
    let (s, c) = (theta / 2.0).sin_cos();
    let psi = std::f64::consts::PI * a as f64 - theta;
    let f = |u: f64| {
        (c * c - 4.0 * s * s * u * u) * (2.0 * psi * u).cos() - 4.0 * c * s * u * (2.0 * psi * u).sin()
    };
    let n = 4000;
    let weight = |i: i32| {
        if i == 0 || i == n {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    (0..=n).map(|i| weight(i) * f(f64::from(i) / f64::from(n) - 0.5)).sum::<f64>() / (3.0 * f64::from(n))
}

#[test]
fn the_closed_form_is_the_integral() {
    for a in -4..=5 {
        for theta in [0.01, 0.7, 1.5, 2.6, 2.7, 3.1, 3.139] {
            // Simpson's error: 1/180 n^-4 |f''''| with |f''''| < (2 psi + 4)^4 < 36^4.
            assert!((strength(a, theta) - by_quadrature(a, theta)).abs() < 1e-10, "a = {a}, theta = {theta}");
        }
    }
}

#[test]
fn first_order_widths_match_a_known_tongue() {
    // 7/2, m = 4 at rho = 1/25: edges 2.31510 and 2.44504.
    let law = first_order("7/2".parse().unwrap(), 4, &ratio(1, 25)).unwrap();
    assert!((law.width.mid_f64() - 0.12995).abs() < 0.02, "{law:?}");
    assert!((law.centre.mid_f64() - 2.38007).abs() < 0.02, "{law:?}");
}
