//! The tongues of a ratio drawn: s across, ρ up, each an area between its edges.

use crate::number::Ratio;
use crate::report::figure::palette::{self, COEXISTENCE, GREY, INK};
use crate::report::figure::{Anchor, Axis, Dash, Figure, Layer, Note, Panel, Place, Shape, Stroke};

/// One tongue over ρ.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    pub m: u64,
    /// Its dominant family.
    pub family: (i64, i64),
    /// [lower s, upper s, ρ], ρ rising; where ρ is 0 both are the point p θ = m π.
    pub edges: Vec<[f64; 3]>,
}

/// All of one ratio that begin below s = 4 at some ρ.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pub ratio: Ratio,
    pub bands: Vec<Band>,
    /// The points p θ = m π, 0 < m < p, in s: the same for every ρ.
    pub resonances: Vec<f64>,
    /// [s, ρ] of closed tongues.
    pub closings: Vec<[f64; 2]>,
}

/// The fast clock's own limit, where the axis ends.
pub const LARGEST_S: f64 = 4.0;

/// A panel for each ratio, one above the other, ρ up to `rho`.
pub fn figure(diagrams: &[Diagram], rho: f64) -> Figure {
    let height = 18.0 + 62.0 * diagrams.len() as f64;
    let figure = Figure::double_column(height).named("Tongues over stiffness").columns(1);
    diagrams.iter().fold(figure, |figure, own| figure.with(panel(own, rho)))
}

fn panel(own: &Diagram, rho: f64) -> Panel {
    let x = Axis::linear("*s* = *h*_1^2*Λ*_1", 0.0, LARGEST_S);
    let mut panel = Panel::new(x, Axis::linear("*ρ* = *Λ*_2/*Λ*_1", 0.0, rho));
    panel = panel.titled(&format!("*h*_2/*h*_1 = {}; at each tongue *m* (*a*, *b*)", own.ratio));
    for band in &own.bands {
        // Families differ in shade and in the pattern of their edges.
        let (n, dash) = style(band.family.0);
        let colour = palette::family(n);
        let side = |i: usize| band.edges.iter().map(move |edge| [edge[i], edge[2]]);
        let outline: Vec<[f64; 2]> = side(0).chain(side(1).rev()).collect();
        panel = panel.with(Layer::areas(vec![outline], colour, 0.45));
        let stroke = Stroke { dash, ..Stroke::THIN.in_colour(INK).wide(0.5) };
        panel = panel.with(Layer::lines(vec![side(0).collect(), side(1).collect()], stroke));
    }
    let lines = own.resonances.iter().map(|&s| vec![[s, 0.0], [s, rho]]).collect();
    let stroke = Stroke { dash: Dash::Dashed, ..Stroke::THIN.in_colour(GREY) };
    panel = panel.with(Layer::lines(lines, stroke).labelled("*p*θ = *m*π"));
    if !own.closings.is_empty() {
        let layer = Layer::dots(own.closings.clone(), Shape::Ring, 4.5, COEXISTENCE);
        panel = panel.with(layer.labelled("closed: *Q* = ±1"));
    }
    labels(panel, &own.bands).legend(Place::Above)
}

/// A family's colour by number, and the pattern of its edges.
fn style(a: i64) -> (usize, Dash) {
    let n = (2 * a.unsigned_abs()).saturating_sub(u64::from(a > 0)) as usize;
    (n, [Dash::Solid, Dash::Dashed, Dash::Dotted, Dash::DashDotted][n % 4])
}

/// Where labels may stand, as shares of the largest ρ, and how much higher or lower the next one in the same gap stands.
const HEIGHTS: [f64; 8] = [0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85];

/// A label beside each tongue, where the gap between it and its neighbour is widest and no other label stands.
fn labels(mut panel: Panel, bands: &[Band]) -> Panel {
    // Taken: the gap before band n, and the height.
    let mut taken: Vec<(usize, f64)> = Vec::new();
    for (n, band) in bands.iter().enumerate() {
        let at = |n: usize, height: f64| bands.get(n).and_then(|band| band.at(height));
        let room = |&(gap, height): &(usize, f64)| {
            let before = gap.checked_sub(1).and_then(|n| at(n, height)).map_or(0.0, |edge| edge[1]);
            at(gap, height).map_or(LARGEST_S, |edge| edge[0].min(LARGEST_S)) - before
        };
        let is_free = |&(gap, height): &(usize, f64)| {
            !taken.iter().any(|&(other, at)| other == gap && (at - height).abs() < 0.15)
        };
        let places = HEIGHTS.into_iter().flat_map(|height| [(n, height), (n + 1, height)]);
        let best = places.filter(is_free).max_by(|a, b| room(a).total_cmp(&room(b)));
        let Some((gap, height)) = best else { continue };
        let Some([lower, upper, rho]) = band.at(height) else { continue };
        taken.push((gap, height));
        let (a, b) = band.family;
        let text = format!("{} ({a}, {b})", band.m).replace('-', "−");
        let note = match gap == n {
            true => Note::new([lower, rho], &text).anchored(Anchor::End, [-2.5, 0.0]),
            false => Note::new([upper, rho], &text).anchored(Anchor::Start, [2.5, 0.0]),
        };
        panel = panel.note(note);
    }
    panel
}

impl Band {
    /// The edges at a share of the largest ρ.
    fn at(&self, height: f64) -> Option<[f64; 3]> {
        self.edges.get((height * (self.edges.len() as f64 - 1.0)) as usize).copied()
    }
}
