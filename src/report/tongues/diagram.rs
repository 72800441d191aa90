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

/// Heights at which labels may stand, as shares of the largest ρ.
const HEIGHTS: usize = 24;
/// What a label's letters take of the height, and a point of paper of s: of a panel of the usual size.
const TALL: f64 = 0.07;
const POINT: f64 = LARGEST_S / 455.0;
/// Between a tongue and its label, in points.
const APART: f64 = 2.5;

/// A place for a label: [left, right] in s, and the height.
type Spot = ([f64; 2], f64);

/// A label beside each tongue, in a gap that holds all of it, else inside the tongue; where neither holds it m alone.
fn labels(mut panel: Panel, bands: &[Band]) -> Panel {
    let mut taken: Vec<Spot> = Vec::new();
    for (n, band) in bands.iter().enumerate() {
        let (a, b) = band.family;
        let texts = [format!("{} ({a}, {b})", band.m).replace('-', "−"), band.m.to_string()];
        let found = texts.iter().find_map(|text| Some((text, spot(bands, n, text, &taken)?)));
        let Some((text, ([left, right], height))) = found else { continue };
        let rho = band.edges.last().map_or(0.0, |top| top[2]) * height;
        taken.push(([left, right], height));
        panel = panel.note(Note::new([0.5 * (left + right), rho], text).anchored(Anchor::Middle, [0.0, 0.0]));
    }
    panel
}

/// The roomiest free place for the label of tongue n.
fn spot(bands: &[Band], n: usize, text: &str, taken: &[Spot]) -> Option<Spot> {
    let wide = (Note::new([0.0; 2], text).width() + 2.0 * APART) * POINT;
    let is_free = |&([left, right], height): &Spot| {
        !taken.iter().any(|&([a, b], at)| left < b && a < right && (at - height).abs() < TALL)
    };
    let places = || (1..HEIGHTS).map(|k| k as f64 / HEIGHTS as f64);
    let beside = places().flat_map(|height| spots(bands, n, height, wide));
    let inside = places().filter_map(|height| {
        let [lower, upper] = bands[n].within(height)?;
        let middle = 0.5 * (lower + upper);
        Some((([middle - 0.5 * wide, middle + 0.5 * wide], height), upper - lower - wide))
    });
    let roomiest = |spots: &mut dyn Iterator<Item = (Spot, f64)>| {
        let fit = spots.filter(|(spot, room)| *room >= 0.0 && is_free(spot));
        fit.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(spot, _)| spot)
    };
    roomiest(&mut beside.into_iter()).or_else(|| roomiest(&mut inside.into_iter()))
}

/// Left and right of tongue n, beside it: places of a width that touch no tongue, with the room that is left over.
fn spots(bands: &[Band], n: usize, height: f64, wide: f64) -> Vec<(Spot, f64)> {
    let Some([lower, upper]) = bands[n].around(height) else { return Vec::new() };
    let side = |n: Option<usize>| n.and_then(|n| bands.get(n)).and_then(|band| band.around(height));
    let before = side(n.checked_sub(1)).map_or(0.0, |other| other[1]);
    let after = side(Some(n + 1)).map_or(LARGEST_S, |other| other[0]).min(LARGEST_S);
    let found =
        [([lower - wide, lower], lower - before - wide), ([upper, upper + wide], after - upper - wide)];
    found.map(|(place, room)| ((place, height), room)).to_vec()
}

impl Band {
    /// The edges at a share of the largest ρ.
    fn at(&self, height: f64) -> Option<[f64; 3]> {
        self.edges.get((height.clamp(0.0, 1.0) * (self.edges.len() as f64 - 1.0)) as usize).copied()
    }

    /// Both edges over the height of a label, folded.
    fn spread(&self, height: f64, fold: [fn(f64, f64) -> f64; 2]) -> Option<[f64; 2]> {
        let edges = [-0.6, -0.3, 0.0, 0.3, 0.6].into_iter().filter_map(|part| self.at(height + part * TALL));
        edges
            .map(|[lower, upper, _]| [lower, upper])
            .reduce(|a, b| [fold[0](a[0], b[0]), fold[1](a[1], b[1])])
    }

    /// What it covers anywhere over the height of a label.
    fn around(&self, height: f64) -> Option<[f64; 2]> {
        self.spread(height, [f64::min, f64::max])
    }

    /// What it covers all over the height of a label.
    fn within(&self, height: f64) -> Option<[f64; 2]> {
        self.spread(height, [f64::max, f64::min]).map(|[lower, upper]| [lower, upper.min(LARGEST_S)])
    }
}
