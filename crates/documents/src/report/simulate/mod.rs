//! A run of Algorithm 1 as a document: the series as rows, measured growth beside the predicted one; and
//! drawn.

mod chart;

use crate::report::decimal::few;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{FLAG, Keys, ROUNDED, Shape};
use crate::report::table::Column;
pub use chart::figure;
use systems::avi::{Run, Sample};

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
        if run.predicted.is_finite() {
            format!("  growth rate, predicted       {}{of}", few(run.predicted, 6))
        } else {
            "  growth rate, predicted       none: no verdict is proven".into()
        },
        if run.measured.is_finite() && run.resolution().is_finite() {
            let off = run.resolution();
            format!(
                "  growth rate, measured        {}{of}, give or take {off:.1e}: run longer to see less",
                few(run.measured, 6)
            )
        } else {
            "  growth rate, measured        none: the run overflows".into()
        },
    ];
    if let Some(off) = run.displacement {
        lines.push(format!("  growth, about the integrator's own orbit, {off:.3e} from the equilibrium"));
    }
    head()
        .document(Document::new("simulate"), run)
        .rows(record().table("series", "Energy, momentum and amplitude over time", &run.series))
        .summary_alone(&lines)
}

/// The keys of the document.
pub fn keys() -> Keys {
    let says = "The state at every multiple of the synchronization period.";
    head().keys().key("series", Shape::List(&Shape::Object(|| record().keys())), says)
}

/// All but the series.
fn head() -> Record<'static, Run> {
    Record::new()
        .json("growth_rate_predicted", |run: &Run| run.predicted.into())
        .says(Shape::OrNull(&ROUNDED), "The middle of the enclosure that a verdict holds, a rounded double; null where none is proven.")
        .json("growth_rate_measured", |run| run.measured.into())
        .says(Shape::OrNull(&ROUNDED), "The growth rate of small deviations; rounded double; null where the run overflows.")
        .json("linear", |run| run.linear.into())
        .says(FLAG, "Whether deviations of any size move like small ones.")
        .json("irreversibility", |run| run.irreversibility.into())
        .says(Shape::OrNull(&ROUNDED), "Rounded double: forward one period and back, the largest difference relative to the start; null where it overflows.")
        .optional("own_orbit", |run| Some(serde_json::json!({"displacement": run.displacement?})))
        .says(
            Shape::Object(|| {
                Keys::new().key("displacement", ROUNDED, "Rounded double: how far it is from the equilibrium.")
            }),
            "Growth is predicted and measured about the integrator's own orbit, where it is not the equilibrium.",
        )
}

/// The record of a sample.
fn record() -> Record<'static, Sample> {
    Record::new()
        .field(Column::new("time"), |sample: &Sample| sample.time.into())
        .says(ROUNDED, "")
        .field(Column::new("energy"), |sample| sample.energy.into())
        .says(ROUNDED, "")
        .field(Column::new("momentum"), |sample| sample.momentum.into())
        .says(ROUNDED, "")
        .field(Column::new("amplitude"), |sample| sample.amplitude.into())
        .says(ROUNDED, "")
}
