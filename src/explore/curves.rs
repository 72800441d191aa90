//! The curves (a, b), 1/T½ = a/h1 + b/h2, in the window, as fractions of it.

use serde_json::{Value, json};

use super::frame::Frame;
use super::query::Query;
use super::reply::Reply;
use super::session::Session;
use clocks::resonance::{Curve, Families, Window};
use documents::question::FAMILIES;
use number::parse::parse_integer_range;
use number::{Ball, Laurent, Rational, Real, Result, rational};

/// Points of a curve across a window.
const SAMPLES: usize = 160;

/// Points across a deep window, in which every curve is nearly straight.
const FEW: i64 = 8;

/// Digits before a window's own from which doubles do not place a curve in it.
const DEEP: u32 = 9;

/// `{"curves": [{"a", "b", "lines": [[u, v, u, v, ...], ...]}]}`.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let ((lambda1, _), window) = (query.stiffnesses(session)?, query.window(session)?);
    let range = |key, default| Ok(query.read(key, parse_integer_range)?.unwrap_or(default));
    let families = Families { a: range("a", FAMILIES.a)?, b: range("b", FAMILIES.b)?, samples: SAMPLES };
    let frame = Frame::new(&window);
    let [h1, h2] = &window;
    let curves: Vec<Value> = if frame.depth() >= DEEP {
        // It checks the ranges and L1.
        Families { samples: 2, ..families }.curves(&lambda1, &Window::new(h1, h2))?;
        let all =
            (families.a.0..=families.a.1).flat_map(|a| (families.b.0..=families.b.1).map(move |b| (a, b)));
        all.filter_map(|(a, b)| deep(a, b, &lambda1, &frame)).collect()
    } else {
        families.curves(&lambda1, &Window::new(h1, h2))?.iter().map(|curve| shallow(curve, &frame)).collect()
    };
    Ok(Reply::json(&json!({ "curves": curves })))
}

fn shallow(curve: &Curve, frame: &Frame) -> Value {
    let fraction = |side, h| frame.fraction(side, &rational::from_f64_exact(h).expect("a point is finite"));
    let lines = curve.pieces.iter().map(|piece| {
        piece.iter().flat_map(|point| [fraction(0, point.h1), fraction(1, point.h2)]).collect::<Vec<f64>>()
    });
    json!({"a": curve.a, "b": curve.b, "lines": lines.collect::<Vec<_>>()})
}

/// A curve where it passes near a deep window.
fn deep(a: i64, b: i64, lambda1: &Laurent, frame: &Frame) -> Option<Value> {
    // A digit takes 3.33 bits; the quotient loses some, and a double is wanted of the rest.
    let bits = 4 * frame.depth() + 128;
    let root = lambda1.enclosure(bits).sqrt(bits)?;
    let points = (-FEW..=2 * FEW).filter_map(|k| {
        let u = rational::ratio(k, FEW);
        Some([rational::to_f64(&u), height(a, b, &frame.at(0, &u), &root, bits, frame)?])
    });
    let line: Vec<[f64; 2]> = points.collect();
    let near =
        line.windows(2).any(|pair| pair[0][1].min(pair[1][1]) <= 1.5 && pair[0][1].max(pair[1][1]) >= -0.5);
    near.then(|| json!({"a": a, "b": b, "lines": [line.concat()]}))
}

/// Where h2 = b h1/(θ/π − a) lies in the window, θ = 2 asin(h1 √L1/2).
fn height(a: i64, b: i64, h1: &Rational, root: &Ball, bits: u32, frame: &Frame) -> Option<f64> {
    let exact = |x: &Rational| Ball::from_rational(x, bits);
    let whole = |n: i64| Rational::from_integer(n.into());
    let sine = exact(h1).mul(root, bits).scale2(-1);
    let over_pi = sine.asin(bits)?.scale2(1).div(&Ball::pi(bits), bits)?;
    let h2 = exact(&(h1 * whole(b))).div(&over_pi.sub(&exact(&whole(a)), bits), bits)?;
    Some(frame.fraction(1, &((h2.lower() + h2.upper()) / whole(2)))).filter(|v| v.is_finite())
}
