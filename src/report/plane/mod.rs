//! The (h1, h2) plane drawn: unstable pairs, resonance curves, and one over the other; and the atlas of all tongues.

mod atlas;
mod chart;
mod raster;

pub use atlas::{Atlas, Segment};
pub use chart::{Chart, Colouring, window};

use super::figure::palette::{Colour, INK};
use super::figure::{Axis, Cells, Dash, Figure, Layer, Panel, Place, Stroke};
use crate::resonance::{Curve, Window};

/// Unstable pairs as cells of a grid: (i, j) is centred at (i D1, j D2).
#[derive(Clone, Debug)]
pub struct Cloud {
    /// D1 and D2 as doubles.
    pub spacing: [f64; 2],
    /// Sorted by i, then j.
    pub pairs: Vec<(u32, u32)>,
}

/// The colour of unstable pairs on their own, and under the curves.
const UNSTABLE: Colour = Colour(20, 20, 20);
const PALE: Colour = Colour(214, 96, 77);

/// The paper's Figure 1: the unstable pairs on the left, the curves (a, b) on the right.
pub fn side_by_side(window: &Window, cloud: &Cloud, curves: &[Curve], title: &str) -> Figure {
    let left = panel(window).titled("(a) Unstable pairs").with(cells(cloud, UNSTABLE));
    let right = lines(panel(window).titled("(b) Curves 1/*T*_{1/2} = *a*/*h*_1 + *b*/*h*_2"), curves);
    Figure::double_column(110.0).named(title).with(left).with(right)
}

/// The curves over the unstable pairs.
pub fn overlay(window: &Window, cloud: &Cloud, curves: &[Curve], title: &str) -> Figure {
    let panel = panel(window).with(cells(cloud, PALE).labelled("unstable pairs"));
    Figure::new(130.0, 140.0).named(title).with(lines(panel, curves))
}

fn panel(window: &Window) -> Panel {
    Panel::new(Axis::linear("*h*_1 (time)", 0.0, window.h1.1), Axis::linear("*h*_2 (time)", 0.0, window.h2.1))
}

fn cells(cloud: &Cloud, colour: Colour) -> Layer {
    let mut cells = Cells::new([0.0, 0.0], cloud.spacing, vec![colour]).at_least(0.35);
    for &(i, j) in &cloud.pairs {
        cells.push(i, j, 0);
    }
    Layer::cells(cells)
}

/// One layer for each a, in the paper's line styles, and the legend.
fn lines(panel: Panel, curves: &[Curve]) -> Panel {
    lines_in(INK, "", panel, curves)
}

/// The same in another colour, with something before the names.
fn lines_in(colour: Colour, before: &str, mut panel: Panel, curves: &[Curve]) -> Panel {
    let mut families: Vec<i64> = curves.iter().map(|curve| curve.a).collect();
    families.sort_unstable();
    families.dedup();
    for a in families {
        let of_a = curves.iter().filter(|curve| curve.a == a);
        let pieces = of_a.flat_map(|curve| &curve.pieces);
        let lines = pieces.map(|piece| piece.iter().map(|p| [p.h1, p.h2]).collect()).collect();
        let layer = Layer::lines(lines, stroke(a).in_colour(colour));
        panel = panel.with(layer.labelled(&format!("{before}*a* = {a}")));
    }
    panel.legend(Place::Above)
}

/// The paper's styles: a = 0 thick, 1 dotted, 2 dashed, 3 thin; others dash-dotted.
fn stroke(a: i64) -> Stroke {
    match a {
        0 => Stroke::THICK,
        1 => Stroke::DOTTED,
        2 => Stroke::DASHED,
        3 => Stroke::THIN,
        _ => Stroke { dash: Dash::DashDotted, ..Stroke::THIN },
    }
}
