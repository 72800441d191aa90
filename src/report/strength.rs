//! How strong the families are: measured widths of tongues over the first-order law, against a.
//!
//! To first order a tongue is 2 s ρ |S| wide in s, and for long periods |S| is |S_a(θ)| (see
//! [`crate::resonance::strength`]). So near one angle θ all tongues of a family whose q is large lie on one value.

use super::figure::palette::{Gradient, INK};
use super::figure::{Axis, ColourBar, Figure, Layer, Panel, Place, Shape, Stroke};
use crate::resonance::strength;

/// A tongue at the angle: its family, its number of slow kicks, and width/(2 s ρ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    pub a: i64,
    pub q: u64,
    pub strength: f64,
}

/// The largest |a| shown.
const LARGEST_A: i64 = 12;

/// Shades of the colour bar for q.
const SHADES: u16 = 24;

/// The figure for the angle θ = `share` π: each tongue a dot over its a, the darker the larger its q.
pub fn figure(share: f64, title: &str, measured: &[Measured]) -> Figure {
    let measured: Vec<&Measured> = measured.iter().filter(|m| m.a.abs() <= LARGEST_A).collect();
    let (first, last) = measured.iter().fold((0, 1), |(lo, hi), m| (m.a.min(lo), m.a.max(hi)));
    let law: Vec<[f64; 2]> =
        (first..=last).map(|a| [a as f64, strength(a, share * std::f64::consts::PI).abs()]).collect();
    let all = || law.iter().map(|point| point[1]).chain(measured.iter().map(|m| m.strength));
    let (low, high) =
        all().filter(|&y| y > 0.0).fold((1.0, 0.0), |(lo, hi): (f64, f64), y| (lo.min(y), hi.max(y)));
    let x = Axis::linear("*a*", first as f64 - 0.6, last as f64 + 0.6);
    let y = Axis::log("width/(2*s*ρ), |*S_a*|", 0.7 * low, 1.4 * high);
    let most = measured.iter().map(|m| m.q).max().unwrap_or(1);
    let bar = ColourBar::new(Axis::log("*q*", 1.0, most.max(2) as f64), Gradient::on_white());
    let mut panel = Panel::new(x, y).titled(title).gridded();
    panel = panel.with(Layer::lines(vec![law.clone()], Stroke::THIN));
    for (class, colour) in (0..SHADES).zip(bar.steps(SHADES)) {
        let of_class = measured.iter().filter(|m| bar.class(m.q as f64, SHADES) == class);
        let points: Vec<[f64; 2]> = of_class.map(|m| [m.a as f64, m.strength]).collect();
        if !points.is_empty() {
            panel = panel.with(Layer::dots(points, Shape::Disc, 2.2, colour));
        }
    }
    let crosses =
        Layer::dots(law, Shape::Cross, 6.0, INK).labelled("first-order law |*S_a*(*θ*)| for long periods");
    Figure::new(130.0, 95.0)
        .named("Strength of families")
        .with(panel.with(crosses).bar(bar).legend(Place::Above))
}
