//! The curves (a, b) in the paper's line styles.

use plot::palette::{Colour, INK};
use plot::{Dash, Layer, Panel, Place, Stroke};

use clocks::resonance::Curve;

/// One layer for each a, in the paper's line styles, and the legend.
pub fn lines(panel: Panel, curves: &[Curve]) -> Panel {
    lines_in(|_| INK, "", panel, curves)
}

/// One layer for each a, each in a colour of its own, behind what comes after; `before` stands before the
/// names.
pub fn lines_in(colour: impl Fn(i64) -> Colour, before: &str, mut panel: Panel, curves: &[Curve]) -> Panel {
    let mut families: Vec<i64> = curves.iter().map(|curve| curve.a).collect();
    families.sort_unstable();
    families.dedup();
    for a in families {
        let of_a = curves.iter().filter(|curve| curve.a == a);
        let pieces = of_a.flat_map(|curve| &curve.pieces);
        let lines = pieces.map(|piece| piece.iter().map(|p| [p.h1, p.h2]).collect()).collect();
        let layer = Layer::lines(lines, stroke(a).in_colour(colour(a)));
        panel = panel.with(layer.labelled(&format!("{before}*a* = {a}").replace('-', "−")));
    }
    panel.legend(Place::Above)
}

/// The paper's styles: a = 0 thick, 1 dotted, 2 dashed, 3 thin; others dash-dotted.
pub fn stroke(a: i64) -> Stroke {
    match a {
        0 => Stroke::THICK,
        1 => Stroke::DOTTED,
        2 => Stroke::DASHED,
        3 => Stroke::THIN,
        _ => Stroke { dash: Dash::DashDotted, ..Stroke::THIN },
    }
}
