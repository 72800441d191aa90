//! The tongues of a ratio drawn: s across, ρ up, each an area between its edges.

use plot::palette::{self, COEXISTENCE, GREY, INK};
use plot::{Axis, Dash, Figure, Layer, Panel, Place, Shape, Stroke};

use super::labels;
use clocks::tongue::sampled::{Diagram, LARGEST_S};

/// The height of the paper for each ratio in any width, and of what is beside them, in mm.
const HEIGHT: f64 = 62.0;
const BESIDE: f64 = 18.0;

/// A panel for each ratio, one above the other, ρ up to `rho`, so wide (175 mm unless given). The labels know
/// the width: in another one they would meet.
pub fn figure(diagrams: &[Diagram], rho: f64, width_mm: Option<f64>) -> Figure {
    let height = BESIDE + HEIGHT * diagrams.len() as f64;
    let sheet = Figure::new(width_mm.unwrap_or(175.0), height).named("Tongues over stiffness").columns(1);
    let whole = diagrams.iter().fold(sheet, |figure, diagram| figure.with(panel(diagram, rho)));
    let notes = diagrams
        .iter()
        .zip(whole.frames())
        .map(|(diagram, size)| labels::notes(diagram, rho, size))
        .collect();
    whole.noted(notes)
}

fn panel(diagram: &Diagram, rho: f64) -> Panel {
    let x = Axis::linear("*s* = *h*_1^2*Λ*_1", 0.0, LARGEST_S);
    let mut panel = Panel::new(x, Axis::linear("*ρ* = *Λ*_2/*Λ*_1", 0.0, rho));
    panel = panel.titled(&format!("*h*_2/*h*_1 = {}; at each tongue *m* (*a*, *b*)", diagram.ratio));
    for band in &diagram.bands {
        // Families differ in shade and in the pattern of their edges.
        let (n, dash) = style(band.family.0);
        let colour = palette::family(n);
        let side = |i: usize| band.edges.iter().map(move |edge| [edge[i], edge[2]]);
        let outline: Vec<[f64; 2]> = side(0).chain(side(1).rev()).collect();
        panel = panel.with(Layer::areas(vec![outline], colour, 0.45));
        let stroke = Stroke { dash, ..Stroke::THIN.in_colour(INK).wide(0.5) };
        panel = panel.with(Layer::lines(vec![side(0).collect(), side(1).collect()], stroke));
    }
    let lines = diagram.resonances.iter().map(|&s| vec![[s, 0.0], [s, rho]]).collect();
    let stroke = Stroke { dash: Dash::Dashed, ..Stroke::THIN.in_colour(GREY) };
    panel = panel.with(Layer::lines(lines, stroke).labelled("*p*θ = *m*π"));
    if !diagram.closings.is_empty() {
        let layer = Layer::dots(diagram.closings.clone(), Shape::Ring, 4.5, COEXISTENCE);
        panel = panel.with(layer.labelled("closed: *Q* = ±*I*"));
    }
    panel.legend(Place::Above)
}

/// A family's colour by number, and the pattern of its edges.
fn style(a: i64) -> (usize, Dash) {
    let n = (2 * a.unsigned_abs()).saturating_sub(u64::from(a > 0)) as usize;
    (n, [Dash::Solid, Dash::Dashed, Dash::Dotted, Dash::DashDotted][n % 4])
}
