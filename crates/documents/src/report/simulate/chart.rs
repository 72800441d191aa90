//! A run of Algorithm 1 drawn.

use plot::palette::{GREY, family};
use plot::{Axis, Figure, Layer, Panel, Place, Stroke, literal};

use crate::report::decimal;
use systems::avi::{Run, Sample};

/// A quantity that grows by more than this is drawn on a logarithmic scale.
const LINEAR_RANGE: f64 = 100.0;

/// The title of a file is drawn where it fits the paper.
const LONGEST_TITLE: usize = 90;

/// Energy, momentum and amplitude over time, one above the other; the predicted growth beside the amplitude.
pub fn figure(run: &Run, title: &str) -> Figure {
    let energy = panel(run, "energy", |s| s.energy, 0);
    let momentum = panel(run, "momentum Σ *p*", |s| s.momentum, 4);
    let amplitude = panel(run, "amplitude max |Δ*x*|", |s| s.amplitude, 1);
    let figure = Figure::double_column(165.0).columns(1);
    let figure = if title.chars().count() <= LONGEST_TITLE {
        figure.headed(&literal(title))
    } else {
        figure.named(title)
    };
    figure.with(energy).with(momentum).with(with_prediction(run, amplitude))
}

fn panel(run: &Run, label: &str, value: fn(&Sample) -> f64, colour: usize) -> Panel {
    let points: Vec<[f64; 2]> = run.series.iter().map(|s| [s.time, value(s)]).collect();
    let (lo, hi) =
        points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p[1]), hi.max(p[1])));
    let end = points.last().map_or(1.0, |p| p[0]).max(f64::MIN_POSITIVE);
    let axis = if lo > 0.0 && hi > LINEAR_RANGE * lo {
        Axis::log(label, lo / 1.5, hi * 1.5)
    } else {
        let margin = if hi > lo { (hi - lo) * 0.05 } else { hi.abs().max(1.0) * 0.05 };
        Axis::linear(label, lo - margin, hi + margin)
    };
    let stroke = Stroke::LINE.in_colour(family(colour));
    Panel::new(Axis::linear("*t*", 0.0, end).of_time(), axis)
        .with(Layer::lines(vec![points], stroke).labelled("Algorithm 1"))
}

/// a exp(rate t): through the last sample of a linear run, where the fastest mode is left alone; through the
/// first one of a nonlinear run, which follows it while deviations are small.
fn with_prediction(run: &Run, panel: Panel) -> Panel {
    let (Some(first), true) = (run.series.first(), run.predicted > run.resolution()) else { return panel };
    let end = run.series.last().map_or(1.0, |s| s.time);
    let anchor = if run.linear { run.series.last().unwrap_or(first) } else { first };
    let line = (0..=200).map(|i| end * f64::from(i) / 200.0);
    let line = line.map(|t| [t, anchor.amplitude * (run.predicted * (t - anchor.time)).exp()]).collect();
    let label = format!("predicted: exp({} *t*)", decimal::few(run.predicted, 4));
    panel
        .with(Layer::lines(vec![line], Stroke::DASHED.in_colour(GREY).wide(1.2)).labelled(&label))
        .legend(Place::Above)
}
