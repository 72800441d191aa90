//! The curves (a, b) of eq. (10), sampled for tables and figures.

use crate::error::{Error, Result};
use crate::number::{Ball, ExactSign, Laurent, Rational, Real, Sign, rational};

/// The part of the (h1, h2) plane in which curves are wanted; closed ranges.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    pub h1: (f64, f64),
    pub h2: (f64, f64),
}

impl Window {
    /// The window of two closed ranges, widened to doubles.
    pub fn new(h1: &(Laurent, Laurent), h2: &(Laurent, Laurent)) -> Window {
        let ends = |(lo, hi): &(Laurent, Laurent)| (lo.enclose_f64().0, hi.enclose_f64().1);
        Window { h1: ends(h1), h2: ends(h2) }
    }
}

/// A curve 1/T½(h1) = a/h1 + b/h2 within a window: its pieces from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pub a: i64,
    pub b: i64,
    pub pieces: Vec<Vec<CurvePoint>>,
}

/// A point of a curve: h1 a double, h2 and θ/π the doubles nearest to the exact values there (to within one
/// unit in the last place), so that θ/π = a + b h1/h2 up to 4 roundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    pub h1: f64,
    pub h2: f64,
    pub theta_over_pi: f64,
}

/// Working precision of a point; what it loses (a few bits to each function, the cancellation in θ/π − a) is
/// far less than the 43 bits above a double's.
const BITS: u32 = 96;

/// The curve (a, b), with `samples` points evenly spaced in θ over all of 0 < θ < π, those outside the window
/// left out and the crossings of its border added. Empty where no point lies in the window: for 0 < θ/π < 1
/// that includes all curves with a = 0, b ≤ 0, with a ≥ 1, b ≥ 0, and with a ≤ −1, b ≤ 0.
///
/// # Errors
/// Where L1 ≤ 0, or fewer than 2 samples are asked for.
pub fn curve(a: i64, b: i64, lambda1: &Laurent, window: &Window, samples: usize) -> Result<Curve> {
    curve_over((0.0, 1.0), (a, b), lambda1, window, samples)
}

/// The same curve with all its samples in the window's range of h1: for windows that show a small part of it.
///
/// # Errors
/// As [`curve`].
pub fn curve_within(a: i64, b: i64, lambda1: &Laurent, window: &Window, samples: usize) -> Result<Curve> {
    // θ = 2 asin(h1 √L1/2); from the limit h1 √L1 = 2 on there is none.
    let half_root = lambda1.to_f64().max(0.0).sqrt() / 2.0;
    let x = |h1: f64| (h1 * half_root).clamp(0.0, 1.0).asin() / std::f64::consts::FRAC_PI_2;
    let (lo, hi) = (x(window.h1.0), x(window.h1.1));
    // A sample beyond either side, so that the border is crossed.
    let beyond = 2.0 * (hi - lo) / samples.max(1) as f64;
    curve_over(((lo - beyond).max(0.0), (hi + beyond).min(1.0)), (a, b), lambda1, window, samples)
}

fn curve_over(
    (lo, hi): (f64, f64),
    (a, b): (i64, i64),
    lambda1: &Laurent,
    window: &Window,
    samples: usize,
) -> Result<Curve> {
    if lambda1.sign() != Sign::Positive {
        return Err(Error::input("lambda1", lambda1, "the fast stiffness must be positive"));
    }
    if samples < 2 {
        return Err(Error::input("samples", samples, "a curve needs at least 2"));
    }
    let root = lambda1.enclosure(BITS).sqrt(BITS).expect("lambda1 > 0");
    let on_curve = |x: f64| point(a, b, &root, x);
    let mut pieces = Vec::new();
    let mut piece: Vec<CurvePoint> = Vec::new();
    let mut before: Option<f64> = None;
    for i in 1..samples {
        let x = lo + (hi - lo) * (i as f64 / samples as f64);
        let now = on_curve(x).filter(|p| window.contains(p));
        if now.is_some() == piece.is_empty()
            && let Some(border) = before.and_then(|before| crossing(&on_curve, window, before, x))
        {
            piece.push(border);
        }
        match now {
            Some(inside) => piece.push(inside),
            None if !piece.is_empty() => pieces.push(std::mem::take(&mut piece)),
            None => {}
        }
        before = Some(x);
    }
    if !piece.is_empty() {
        pieces.push(piece);
    }
    Ok(Curve { a, b, pieces })
}

impl Window {
    fn contains(&self, point: &CurvePoint) -> bool {
        let within = |(lo, hi): (f64, f64), x: f64| lo <= x && x <= hi;
        within(self.h1, point.h1) && within(self.h2, point.h2)
    }
}

/// The last point inside the window between x0 and x1, one of which is inside: by bisection to neighbouring
/// doubles.
fn crossing(
    at: &impl Fn(f64) -> Option<CurvePoint>,
    window: &Window,
    x0: f64,
    x1: f64,
) -> Option<CurvePoint> {
    let inside = |x: f64| at(x).is_some_and(|p| window.contains(&p));
    let (mut within, mut outside) = if inside(x1) { (x1, x0) } else { (x0, x1) };
    loop {
        let middle = (within + outside) / 2.0;
        if middle == within || middle == outside {
            return at(within);
        }
        if inside(middle) { within = middle } else { outside = middle }
    }
}

/// The point near θ/π = x. h1 = 2 sin(θ/2)/√L1 is rounded to a double first; θ and h2 belong to that double.
fn point(a: i64, b: i64, root: &Ball, x: f64) -> Option<CurvePoint> {
    let h1 = 2.0 * (std::f64::consts::FRAC_PI_2 * x).sin() / root.mid_f64();
    let exact = Ball::from_rational(&rational::from_f64_exact(h1)?, BITS);
    let sine = exact.mul(root, BITS).scale2(-1);
    let over_pi = sine.asin(BITS)?.scale2(1).div(&Ball::pi(BITS), BITS)?;
    let b = Rational::from_integer(b.into());
    let h2 = exact.mul(&Ball::from_rational(&b, BITS), BITS).div(&over_pi.sub(&integer(a), BITS), BITS)?;
    let (h2, theta_over_pi) = (h2.mid_f64(), over_pi.mid_f64());
    (h2 > 0.0 && h2.is_finite()).then_some(CurvePoint { h1, h2, theta_over_pi })
}

fn integer(n: i64) -> Ball {
    Ball::from_integer(&n.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse::parse;

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
                assert!(window.contains(point));
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
}
