//! The (h1, h2) plane drawn: unstable pairs, resonance curves, and one over the other; and the atlas of all
//! tongues.

mod atlas;
mod chart;
mod lines;
mod raster;

pub use atlas::{Atlas, Segment};
use chart::labels;
pub use chart::{Chart, Colouring, window};
use lines::{lines, lines_in};
use plot::palette::{Colour, GREY};
use plot::{Axis, Cells, Figure, Layer, Panel};

use clocks::resonance::{Curve, Window};

/// Unstable pairs as cells of a grid: (i, j) is centred at (i D1, j D2).
#[derive(Clone, Debug)]
pub struct Cloud {
    /// D1 and D2 as doubles.
    pub spacing: [f64; 2],
    /// Sorted by i, then j.
    pub pairs: Vec<(u32, u32)>,
}

/// The colour of unstable pairs on their own, and over the curves.
const UNSTABLE: Colour = Colour(20, 20, 20);
const RED: Colour = Colour(178, 40, 30);

const CURVES: &str = "Curves 1/*T*_{1/2} = *a*/*h*_1 + *b*/*h*_2";

/// The paper's Figure 1: the unstable pairs on the left, the curves (a, b) on the right.
pub fn side_by_side(window: &Window, cloud: &Cloud, curves: &[Curve], title: &str) -> Figure {
    let left = panel(window).titled("(a) Unstable pairs").with(cells(cloud, UNSTABLE));
    let right = lines(panel(window).titled(&format!("(b) {CURVES}")), curves);
    Figure::double_column(110.0).named(title).with(left).with(right)
}

/// The curves alone, those with a = 0 by their names.
pub fn families(window: &Window, curves: &[Curve]) -> Figure {
    let panel = labels(lines(panel(window).titled(CURVES), curves), curves, window);
    Figure::new(130.0, 140.0).named("Resonance curves").with(panel)
}

/// The curves over the unstable pairs.
pub fn overlay(window: &Window, cloud: &Cloud, curves: &[Curve], title: &str) -> Figure {
    // The curves first: they are behind the pairs.
    let panel =
        lines_in(|_| GREY, "", panel(window), curves).with(cells(cloud, RED).labelled("unstable pairs"));
    Figure::new(130.0, 140.0).named(title).with(panel)
}

fn panel(window: &Window) -> Panel {
    let axis = |label, (_, end): (f64, f64)| Axis::linear(label, 0.0, end).of_time();
    Panel::new(axis("*h*_1", window.h1), axis("*h*_2", window.h2))
}

fn cells(cloud: &Cloud, colour: Colour) -> Layer {
    let mut cells = Cells::new([0.0, 0.0], cloud.spacing, vec![colour]).at_least(0.35);
    for &(i, j) in &cloud.pairs {
        cells.push(i, j, 0);
    }
    Layer::cells(cells)
}
