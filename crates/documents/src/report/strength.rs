//! How strong the families are: measured widths of tongues over the first-order law, against a and
//! against |S_a|.
//!
//! To first order a tongue is 2 s ρ |S| wide in s, and for long periods |S| is |S_a(θ)| (see
//! [`clocks::resonance::strength`]). So near one angle θ all tongues of a family whose q is large lie on one
//! value.

use plot::palette::{GREY, Gradient, INK, family};
use plot::{Axis, ColourBar, Figure, Layer, Panel, Place, Shape, Stroke};

use clocks::resonance::strength;
use clocks::tongue::sampled::Measured;

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
    let y = Axis::log("width of a tongue/(2*sρ*), |*S_a*|", 0.7 * low, 1.4 * high);
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
    // An entry of its own, for the dots' shades are many.
    let tongues = Layer::dots(Vec::new(), Shape::Disc, 2.2, bar.steps(SHADES)[usize::from(SHADES) * 2 / 3]);
    panel = panel.with(tongues.labelled("a tongue, shaded by its *q*"));
    let crosses =
        Layer::dots(law, Shape::Cross, 6.0, INK).labelled("first-order law |*S_a*(*θ*)| for long periods");
    Figure::new(130.0, 95.0)
        .named("Strength of families")
        .with(panel.with(crosses).bar(bar).legend(Place::Above))
}

/// The smallest strength drawn, relative to the largest: beyond this the law has the corrections of higher
/// orders alone to compare with.
const DECADES: f64 = 1e-5;

/// Each tongue's width over 2 s ρ against |S_a(θ)| of its own family and angle: on the diagonal where the
/// first-order law for long periods holds. Families differ in shape as well as in hue.
pub fn widths(title: &str, measured: &[Measured]) -> Figure {
    let places: Vec<(i64, [f64; 2])> =
        measured.iter().map(|m| (m.a, [strength(m.a, m.theta).abs(), m.strength])).collect();
    let places: Vec<_> = places.into_iter().filter(|(_, [law, width])| law.min(*width) > DECADES).collect();
    let all = || places.iter().flat_map(|(_, place)| *place);
    let (low, high) = (0.7 * all().fold(1.0, f64::min), 1.4 * all().fold(0.0, f64::max));
    let axis = |label| Axis::log(label, low, high);
    let mut panel =
        Panel::new(axis("|*S_a*(*θ*)|"), axis("width of a tongue/(2*sρ*)")).titled(title).gridded();
    let kinds = [
        ("|*a*| > 3", 4..=u64::MAX, Shape::Cross),
        ("|*a*| = 3", 3..=3, Shape::Square),
        ("|*a*| = 2", 2..=2, Shape::Diamond),
        ("|*a*| = 1", 1..=1, Shape::Triangle),
        ("*a* = 0", 0..=0, Shape::Disc),
    ];
    for (n, (name, sizes, shape)) in kinds.into_iter().enumerate() {
        let points: Vec<[f64; 2]> = places
            .iter()
            .filter(|(a, _)| sizes.contains(&a.unsigned_abs()))
            .map(|(_, place)| *place)
            .collect();
        if !points.is_empty() {
            let colour = if n == 0 { GREY } else { family(4 - n) };
            panel = panel.with(Layer::dots(points, shape, 2.4, colour).labelled(name));
        }
    }
    let law = Layer::lines(vec![vec![[low, low], [high, high]]], Stroke::LINE.in_colour(INK));
    let panel = panel.with(law.labelled("first-order law for long periods")).legend(Place::Above);
    Figure::new(110.0, 110.0).named("Widths of tongues against the first-order law").with(panel)
}
