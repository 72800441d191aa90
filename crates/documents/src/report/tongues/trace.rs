//! Traces through a resonance: Tr Q over s between the lines ±2, one tongue close by, and what of the half
//! period vanishes at its edges.

use plot::palette::{GREY, INK, family};
use plot::{Anchor, Axis, Dash, Figure, Layer, Note, Panel, Place, Stroke, typeset};

use clocks::tongue::sampled::{Near, Trace};

/// Beyond this Tr Q is cut.
const SHOWN: f64 = 3.2;

/// Tr Q over all tongues; below it one of them: how far |Tr Q| exceeds 2, and the entries whose product that
/// is.
pub fn figure(trace: &Trace) -> Figure {
    let name = format!("Traces of h2/h1 = {}", trace.ratio);
    let figure = Figure::double_column(150.0).columns(1).named(&name);
    [whole(trace), excess(&trace.near), entries(&trace.near)].into_iter().fold(figure, Figure::with)
}

fn shade(spans: impl Iterator<Item = [f64; 2]>, [low, high]: [f64; 2]) -> Layer {
    let outline = |[a, b]: [f64; 2]| vec![[a, low], [b, low], [b, high], [a, high]];
    Layer::areas(spans.map(outline).collect(), GREY, 0.35)
}

fn level(values: &[f64], [from, upto]: [f64; 2]) -> Layer {
    let lines = values.iter().map(|&y| vec![[from, y], [upto, y]]).collect();
    Layer::lines(lines, Stroke { dash: Dash::Dashed, ..Stroke::THIN })
}

fn whole(trace: &Trace) -> Panel {
    let end = trace.whole.last().map_or(4.0, |point| point[0]);
    let panel =
        Panel::new(Axis::linear("*s* = *h*_1^2*Λ*_1", 0.0, end), Axis::linear("Tr *Q*", -SHOWN, SHOWN));
    let panel = panel.titled(&format!(
        "*h*_2/*h*_1 = {}, *ρ* = {}; at each tongue *m*",
        trace.ratio,
        typeset(&trace.rho)
    ));
    // The panels below have the same shade and level; the first one names them.
    let tongues = shade(trace.tongues.iter().map(|tongue| tongue.1), [-SHOWN, SHOWN]);
    let panel = panel.with(tongues.labelled("tongue, between certified edges"));
    let panel = panel.with(level(&[-2.0, 2.0], [0.0, end]).labelled("|Tr *Q*| = 2"));
    let panel =
        panel.with(Layer::lines(vec![trace.whole.clone()], Stroke::LINE.in_colour(INK)).labelled("Tr *Q*"));
    let note = |(m, [lower, upper]): &(u64, [f64; 2])| {
        let side = if m.is_multiple_of(2) { -2.6 } else { 2.6 };
        Note::new([0.5 * (lower + upper), side], &m.to_string()).anchored(Anchor::Middle, [0.0, 0.0])
    };
    trace.tongues.iter().map(note).fold(panel, Panel::note).legend(Place::Above)
}

/// The axis of one tongue.
fn across(near: &Near) -> Axis {
    let width = match format!("{:.3e}", near.width).split_once("e-") {
        Some((digits, power)) if near.width < 1e-3 => format!("{digits}·10^{{−{power}}}"),
        _ => format!("{:.5}", near.width),
    };
    Axis::linear(
        &format!("(*s* − *s*_0)/width, lower edge *s*_0 = {:.6}, width {width}", near.lower),
        -1.0,
        2.0,
    )
}

fn excess(near: &Near) -> Panel {
    let values = || near.excess.iter().map(|point| point[1]);
    let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    let (low, high) = (low.max(-3.0 * high) * 1.1, high * 1.25);
    let sign = if near.m.is_multiple_of(2) { "" } else { "−" };
    let panel = Panel::new(across(near), Axis::linear(&format!("{sign}Tr *Q* − 2"), low, high));
    panel
        .titled(&format!("Tongue {}: the full period", near.m))
        .with(shade([[0.0, 1.0]].into_iter(), [low, high]))
        .with(level(&[0.0], [-1.0, 2.0]))
        .with(Layer::lines(vec![near.excess.clone()], Stroke::LINE.in_colour(INK)))
}

fn entries(near: &Near) -> Panel {
    let panel = Panel::new(across(near), Axis::linear("entry/largest", -1.1, 1.1));
    let panel = panel
        .titled(&format!("Tongue {}: half a period", near.m))
        .with(shade([[0.0, 1.0]].into_iter(), [-1.1, 1.1]))
        .with(level(&[0.0], [-1.0, 2.0]));
    let strokes = [
        Stroke::LINE.in_colour(family(0)),
        Stroke { dash: Dash::Dashed, ..Stroke::LINE.in_colour(family(1)) },
    ];
    let lines = near.entries.iter().zip(strokes);
    let lines = lines.map(|((entry, line), stroke)| {
        Layer::lines(vec![line.clone()], stroke.wide(1.1)).labelled(&format!("entry {}", entry.name()))
    });
    lines.fold(panel, Panel::with).legend(Place::Above)
}
