//! A run of Algorithm 1 as a document: the series as rows, measured growth beside the predicted one; and drawn.

use super::document::Document;
use super::figure::palette::family;
use super::figure::{Axis, Figure, Layer, Panel, Stroke};
use super::table::{Cell, Column, Table};
use crate::avi::Sample;

/// What a run showed.
#[derive(Clone, Debug)]
pub struct Run {
    pub series: Vec<Sample>,
    /// Measured growth rate, per unit time; linear systems only.
    pub measured: Option<f64>,
    /// Predicted by the system's multipliers.
    pub predicted: f64,
    /// The largest difference after running forward and back, relative to the start.
    pub irreversibility: f64,
}

/// The document `kickdrift/simulate/1`; the caller adds the input.
pub fn document(run: &Run) -> Document {
    let (first, last) = (run.series.first(), run.series.last());
    let drift = first.zip(last).map_or(f64::NAN, |(a, b)| (b.energy - a.energy) / a.energy.abs());
    let mut lines = vec![
        format!("{} samples up to t = {}", run.series.len(), last.map_or(0.0, |s| s.time)),
        format!("  relative change of energy    {drift:.3e}"),
        format!("  forward and back again       {:.3e} off the start", run.irreversibility),
        format!("  growth rate, predicted       {:.6}", run.predicted),
    ];
    if let Some(measured) = run.measured {
        // A bounded solution returns to its size only after a beat: over half the run that looks like growth.
        let resolution = last.map_or(f64::INFINITY, |s| 2.0 / s.time);
        lines.push(format!("  growth rate, measured        {measured:.6}, give or take {resolution:.1e}: run longer to see less"));
    }
    Document::new("simulate")
        .entry("growth_rate_predicted", run.predicted)
        .entry("growth_rate_measured", run.measured)
        .entry("irreversibility", run.irreversibility)
        .rows(table(&run.series))
        .told(&lines)
}

fn table(series: &[Sample]) -> Table {
    let columns = ["time", "energy", "momentum", "amplitude"].map(Column::new).to_vec();
    let mut table = Table::new("series", "Energy, momentum and amplitude over time", columns);
    for sample in series {
        let Sample { time, energy, momentum, amplitude } = *sample;
        table.push([time, energy, momentum, amplitude].map(Cell::Float).to_vec());
    }
    table
}

/// Energy and amplitude over time, one above the other.
pub fn figure(run: &Run, title: &str) -> Figure {
    let panel = |label: &str, value: fn(&Sample) -> f64, colour: usize| {
        let points: Vec<[f64; 2]> = run.series.iter().map(|s| [s.time, value(s)]).collect();
        let (lo, hi) = points
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p[1]), hi.max(p[1])));
        let margin = if hi > lo { (hi - lo) * 0.05 } else { hi.abs().max(1.0) * 0.05 };
        let end = points.last().map_or(1.0, |p| p[0]).max(f64::MIN_POSITIVE);
        let stroke = Stroke::LINE.in_colour(family(colour));
        Panel::new(Axis::linear("*t* (time)", 0.0, end), Axis::linear(label, lo - margin, hi + margin))
            .with(Layer::lines(vec![points], stroke))
    };
    Figure::double_column(120.0).columns(1).named(title).with(panel("energy", |s| s.energy, 0)).with(panel(
        "max |*x*|",
        |s| s.amplitude,
        1,
    ))
}
