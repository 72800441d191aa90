//! The multipliers of a system, and the shapes of those that grow.

use plot::palette::{GREY, INK, family};
use plot::{Anchor, Axis, Figure, Layer, Note, Panel, Place, Shape, Stroke};

use super::terms;
use super::words::rate;
use crate::report::decimal;
use crate::report::text::counted;
use systems::{Analysis, Instability, Origin, Part, middle};

/// The most shapes on one page: the fastest.
const MOST_SHAPES: usize = 4;
/// Millimetres of paper for the multipliers and for one shape.
const SPECTRUM: f64 = 62.0;
const SHAPE: f64 = 42.0;
/// Up to so many degrees of freedom each has a stem.
const STEMS: usize = 60;

/// All multipliers by angle and growth, and below the shapes of the fastest growing ones.
pub fn figure(analysis: &Analysis, title: &str) -> Figure {
    let parts = analysis
        .parts
        .iter()
        .flat_map(|part| part.instabilities.iter().map(move |instability| (instability, part)));
    let mut growing: Vec<Growing> =
        parts.map(|(instability, part)| (instability, height(instability, part))).collect();
    growing.sort_by(|a, b| b.0.multiplier.size().total_cmp(&a.0.multiplier.size()));
    let shown = &growing[..growing.len().min(MOST_SHAPES)];
    let height = SPECTRUM + SHAPE * shown.len() as f64;
    let first = Figure::double_column(height).columns(1).named(title).with(spectrum(analysis, shown));
    (1..).zip(shown).fold(first, |figure, (n, pair)| figure.with(shape(n, pair)))
}

/// What grows, and its rate as it is drawn.
type Growing<'a> = (&'a Instability, f64);

/// The middle of the rate's enclosure, or ln |λ|/T rounded where it has none.
fn height(instability: &Instability, part: &Part) -> f64 {
    let rounded = || instability.multiplier.lambda.norm().ln().abs() / part.period.to_f64();
    instability.growth_rate.filter(|growth_rate| growth_rate.1.is_finite()).map_or_else(rounded, middle)
}

/// ln |λ|/T over arg λ/π.
fn spectrum(analysis: &Analysis, shown: &[Growing]) -> Panel {
    let (mut still, mut moving) = (Vec::new(), Vec::new());
    for part in &analysis.parts {
        let angle = |z: num_complex::Complex64| z.arg().abs() / std::f64::consts::PI;
        let unstable: Vec<_> =
            part.instabilities.iter().map(|instability| instability.multiplier.mu).collect();
        let stable =
            part.multipliers.iter().filter(|m| !unstable.contains(&m.mu) && !unstable.contains(&m.mu.conj()));
        still.extend(stable.map(|m| [angle(m.lambda), 0.0]));
        moving.extend(
            part.instabilities
                .iter()
                .map(|instability| [angle(instability.multiplier.lambda), height(instability, part)]),
        );
    }
    let fastest = moving.iter().fold(0.0, |a: f64, values| a.max(values[1]));
    let y = if fastest > 0.0 {
        Axis::linear("growth rate", -0.06 * fastest, 1.15 * fastest)
    } else {
        let zero = plot::Tick { at: 0.0, label: Some("0".into()) };
        Axis::linear("growth rate", -0.5, 0.5).ticks(vec![zero])
    };
    let y = y.per_time();
    let grow = counted(moving.len(), "instability", "instabilities");
    let counts = if analysis.has_all_multipliers() {
        format!("Multipliers: {} on the unit circle, {grow}", counted(still.len(), "pair", "pairs"))
    } else {
        format!("Multipliers: {grow}; the others are not computed")
    };
    let stems = moving.iter().map(|&[x, y]| vec![[x, 0.0], [x, y]]).collect();
    let panel = Panel::new(Axis::linear("angle of the multiplier, arg *λ*/π", -0.02, 1.02), y)
        .titled(&counts)
        .with(Layer::lines(vec![vec![[0.0, 0.0], [1.0, 0.0]]], Stroke::THIN.in_colour(GREY)))
        .with(Layer::lines(stems, Stroke::LINE.in_colour(family(3))))
        .with(Layer::dots(still, Shape::Disc, 2.6, INK))
        .with(Layer::dots(moving, Shape::Disc, 3.6, family(3)));
    (1..).zip(shown).fold(panel, |panel, (n, &(unstable, height))| {
        let angle = unstable.multiplier.lambda.arg().abs() / std::f64::consts::PI;
        let (anchor, shift) = if angle > 0.9 { (Anchor::End, -4.0) } else { (Anchor::Start, 4.0) };
        panel.note(Note::new([angle, height], &n.to_string()).anchored(anchor, [shift, 1.0]))
    })
}

/// The positions of a growing solution, one degree of freedom beside the other.
fn shape(n: usize, pair: &Growing) -> Panel {
    let unstable = pair.0;
    let last = unstable.shape.len() as f64 - 1.0;
    let few = unstable.shape.len() <= STEMS;
    let points = |values: &[f64]| (0..).zip(values).map(|(i, &y)| [f64::from(i), y]).collect::<Vec<_>>();
    let (real, imaginary) = (points(&unstable.shape), points(&unstable.quadrature));
    let mut panel =
        Panel::new(Axis::linear("degree of freedom", -0.5, last + 0.5), Axis::linear("shape", -1.15, 1.15))
            .titled(&format!("{n}  {}", described(pair)))
            .with(Layer::lines(vec![vec![[-0.5, 0.0], [last + 0.5, 0.0]]], Stroke::THIN.in_colour(GREY)));
    let beats = unstable.origin == Origin::Collision;
    if beats {
        panel = panel.legend(Place::Above);
    }
    let line = Layer::lines(vec![real.clone()], Stroke::LINE.in_colour(family(0)));
    panel = panel.with(if beats { line.labelled("at the start") } else { line });
    if few {
        let stems = real.iter().map(|&[x, y]| vec![[x, 0.0], [x, y]]).collect();
        panel = panel.with(Layer::lines(stems, Stroke::THIN.in_colour(family(0))));
        panel = panel.with(Layer::dots(real, Shape::Disc, 3.4, family(0)));
    }
    if beats {
        let line = Layer::lines(vec![imaginary.clone()], Stroke::DASHED.in_colour(family(1)));
        panel = panel.with(line.labelled("a quarter of the beat later"));
        if few {
            panel = panel.with(Layer::dots(imaginary, Shape::Ring, 3.4, family(1)));
        }
    }
    panel
}

/// Kind, growth and resonance, in the notation of labels.
fn described(&(unstable, height): &Growing) -> String {
    let kind = unstable.origin.name();
    let rate = match unstable.growth_rate {
        Some((lo, hi)) if lo > 0.0 && hi.is_finite() => decimal::shortened(lo, hi, 4).to_string(),
        Some(pair) => rate(Some(pair)),
        None => format!("about {}", decimal::few(height, 4)),
    };
    let mut text = format!("{kind}, growth {rate}");
    if let Some(r) = &unstable.resonance {
        let sign = if r.sign > 0 { '+' } else { '−' };
        let (first, second) = r.frequencies;
        let (first, second) = (decimal::few(first, 5), decimal::few(second, 5));
        let family = terms(&r.family, "*h*_").replace(" - ", " − ");
        text += &format!("; *w* = {first} {sign} {second} near 2π ({family})");
    }
    text
}
