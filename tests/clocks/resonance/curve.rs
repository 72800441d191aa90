//! The curves (a, b) in a window.

use kickdrift::number::Laurent;
use kickdrift::number::parse::parse;
use kickdrift::resonance::{Window, curve};

fn paper() -> (Laurent, Window) {
    (parse("lambda1", "pi^2").unwrap(), Window { h1: (0.01, 0.63), h2: (0.01, 3.5) })
}

#[test]
fn points_satisfy_the_symmetric_form() {
    let (lambda1, window) = paper();
    for (a, b) in [(0, 1), (0, 3), (1, -1), (1, -4), (2, -3), (3, -5), (-1, 2)] {
        let curve = curve(a, b, &lambda1, &window, 200).unwrap();
        assert!(!curve.pieces.is_empty(), "({a}, {b})");
        for point in curve.pieces.iter().flatten() {
            let within = |(lo, hi): (f64, f64), x: f64| lo <= x && x <= hi;
            assert!(within(window.h1, point.h1) && within(window.h2, point.h2));
            let theta = 2.0 * (point.h1 * std::f64::consts::PI / 2.0).asin() / std::f64::consts::PI;
            // θ from h1 in doubles is good to 1e-15/cos(θ/2).
            let tip = (1.0 - (point.h1 * std::f64::consts::PI / 2.0).powi(2)).sqrt();
            assert!((point.theta_over_pi - theta).abs() < 1e-15 / tip);
            let other = a as f64 + b as f64 * point.h1 / point.h2;
            assert!((point.theta_over_pi - other).abs() < 1e-14, "({a}, {b}): {point:?}");
        }
    }
}

#[test]
fn curves_without_points_are_empty_and_borders_are_met() {
    let (lambda1, window) = paper();
    for (a, b) in [(0, -1), (1, 1), (2, 0), (-2, -1)] {
        assert!(curve(a, b, &lambda1, &window, 50).unwrap().pieces.is_empty());
    }
    let curve = curve(1, -1, &lambda1, &window, 50).unwrap();
    let top = curve.pieces.iter().flatten().map(|p| p.h2).fold(0.0, f64::max);
    assert!((top - 3.5).abs() < 1e-9, "{top}");
}

#[test]
fn a_window_however_small_has_every_curve_through_it() {
    let (lambda1, window) = paper();
    for (a, b) in [(0, 1), (1, -1), (2, -3), (-1, 2), (-2, 3)] {
        let whole = curve(a, b, &lambda1, &window, 200).unwrap();
        for point in whole.pieces.iter().flatten().step_by(9) {
            for width in [1e-3, 1e-9, 1e-15] {
                let about = |h: f64| (h * (1.0 - width), h * (1.0 + width));
                let window = Window { h1: about(point.h1), h2: about(point.h2) };
                let found = curve(a, b, &lambda1, &window, 5).unwrap();
                assert!(!found.pieces.is_empty(), "({a}, {b}) at {point:?}, {width}");
            }
        }
    }
}

#[test]
fn a_curve_that_turns_in_the_window_is_there_once_and_one_above_it_twice() {
    let lambda1 = parse("lambda1", "4").unwrap();
    let pieces =
        |low, high| curve(-1, 1, &lambda1, &Window { h1: (0.1, 1.0), h2: (low, high) }, 400).unwrap().pieces;
    // h2 = sin(πx/2)/(x + 1) is greatest where tan(πx/2) = (π/2)(x + 1): 0.5286 at x = 0.78.
    let peak = pieces(0.1, 0.6).iter().flatten().map(|point| point.h2).fold(0.0, f64::max);
    assert_eq!(pieces(0.1, 0.6).len(), 1);
    assert_eq!(pieces(0.51, peak - 1e-4).len(), 2);
    assert_eq!(pieces(peak - 1e-6, 0.6).len(), 1);
    assert_eq!(pieces(peak + 1e-4, 0.6).len(), 0);
}
