//! A run of Algorithm 1 as a document: the series as rows, measured growth beside the predicted one; and drawn.

#[cfg(feature = "figure")]
mod chart;

use crate::avi::Sample;
use crate::report::document::Document;
use crate::report::table::{Cell, Column, Table};
#[cfg(feature = "figure")]
pub use chart::figure;

/// What a run showed.
#[derive(Clone, Debug)]
pub struct Run {
    pub series: Vec<Sample>,
    /// Measured growth rate of small deviations, per unit time.
    pub measured: f64,
    /// Predicted by the system's multipliers.
    pub predicted: f64,
    /// The largest difference after running forward and back, relative to the start.
    pub irreversibility: f64,
    /// How far the integrator's own orbit, about which growth is predicted and measured, lies from the equilibrium; `None` where
    /// the equilibrium is one.
    pub displacement: Option<f64>,
    /// Whether deviations of any size move like small ones.
    pub linear: bool,
}

impl Run {
    /// What cannot be told from no growth: a bounded solution returns to its size only after a beat, and over half the
    /// run that looks like growth.
    fn resolution(&self) -> f64 {
        self.series.last().filter(|s| s.time > 0.0).map_or(f64::INFINITY, |s| 2.0 / s.time)
    }
}

/// The document `kickdrift/simulate/1`; the caller adds the input.
pub fn document(run: &Run) -> Document {
    let (first, last) = (run.series.first(), run.series.last());
    let drift = first.zip(last).map(|(a, b)| (b.energy - a.energy) / a.energy.abs());
    let drift = drift.filter(|drift| drift.is_finite()).map(|drift| format!("{drift:.3e}"));
    let of = if run.linear { "" } else { " of small deviations" };
    let mut lines = vec![
        format!("{} samples up to t = {}", run.series.len(), last.map_or(0.0, |s| s.time)),
        format!("  relative change of energy    {}", drift.as_deref().unwrap_or("none: it begins at 0")),
        format!("  forward and back again       {:.3e} off the start", run.irreversibility),
        format!("  growth rate, predicted       {:.6}{of}", run.predicted),
        if run.measured.is_finite() && run.resolution().is_finite() {
            let off = run.resolution();
            format!(
                "  growth rate, measured        {:.6}{of}, give or take {off:.1e}: run longer to see less",
                run.measured
            )
        } else {
            "  growth rate, measured        none: the run overflows".into()
        },
    ];
    let document = Document::new("simulate")
        .entry("growth_rate_predicted", run.predicted)
        .entry("growth_rate_measured", run.measured)
        .entry("linear", run.linear)
        .entry("irreversibility", run.irreversibility);
    let document = match run.displacement {
        Some(off) => {
            lines.push(format!("  growth, about the integrator's own orbit, {off:.3e} from the equilibrium"));
            document.entry("own_orbit", serde_json::json!({"displacement": off}))
        }
        None => document,
    };
    document.rows(table(&run.series)).told(&lines)
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
