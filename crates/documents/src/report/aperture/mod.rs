//! The aperture of a bond as a document, in words, and drawn.

mod chart;

use super::decimal::few;
use super::document::Document;
use super::record::Record;
use super::table::{Cell, Column};
pub use chart::figure;
use molecules::aperture::{EARLY, LATE, Measured, PHASES, Resonance, Step, rungs};
use molecules::unit::decimal;
use number::rational::to_f64;

/// What the document, the text and the schema say of every number.
const MEASURED: &str = "a measurement of the method on one bond in doubles, no proof";

/// Digits of tables that people read: energies are measured to a quarter of a kT.
const DIGITS: u32 = 5;

/// The document `kickdrift/aperture/1`; the caller adds the input.
pub fn document(measured: &Measured) -> Document {
    let Measured { measurement, resonances, steps, level, .. } = measured;
    let table = record(measured).table("steps", "How hot a bond may be at each step, as measured", steps);
    Document::new("aperture")
        .entry("kind", MEASURED)
        .entry("integrator", measured.word.to_string())
        .entry("period", measurement.period())
        .entry("thermal_energy", measurement.thermal())
        .entry("limit", measurement.limit)
        .entry("depth", measurement.depth)
        .entry("level", *level)
        .entry("resonances", resonance().all(resonances))
        .for_people(table.shortened(DIGITS))
        .rows(table)
        .summary(&lines(measured))
}

/// The record of a step.
fn record(measured: &Measured) -> Record<'_, Step> {
    Record::new()
        .field(Column::math("h", "h").in_unit("fs"), |step: &Step| to_f64(&step.step).into())
        .field(Column::new("turn"), |step| step.turn.into())
        .field(Column::math("k", "k"), |step| step.nearest.map(|(k, _)| k).into())
        .field(Column::new("resonance").in_words("its step").in_unit("fs"), |step| {
            step.nearest.and_then(|(_, h)| h).into()
        })
        .field(Column::new("aperture").titled("E*", "$E^*$").in_unit("kT"), |step| step.aperture.into())
        .field(Column::new("half_aperture").titled("half", "half").in_unit("kT"), |step| step.half.into())
        .field(Column::new("share_lost").in_words("share lost"), |step| step.share.into())
        .field(Column::new("enough_for").in_words("enough for"), |step| step.enough.into())
        .field(Column::new("enough"), move |step| measured.is_enough(step).into())
}

fn resonance() -> Record<'static, Resonance> {
    let step = |resonance: &Resonance| resonance.step.map_or(Cell::Missing, Cell::Float);
    Record::new()
        .field(Column::new("k"), |resonance: &Resonance| resonance.k.into())
        .field(Column::new("h"), step)
}

fn lines(measured: &Measured) -> Vec<String> {
    let Measured { measurement, resonances, steps, level, .. } = measured;
    let last = rungs().last().expect("there are rungs");
    let limit = measurement
        .limit
        .map_or_else(String::new, |limit| format!("; linear stability ends at {} fs", few(limit, 5)));
    let places = resonances.iter().filter_map(|resonance| {
        resonance.step.map(|step| format!("{} fs (k = {})", few(step, 4), resonance.k))
    });
    let mut lines = vec![
        format!("{}: {MEASURED}", measured.bond.name),
        format!("  starts        {PHASES} phases, up to {last} kT; lost beyond 1 nm within {LATE} steps"),
        format!("  period        {} fs at rest{limit}", few(measurement.period(), 5)),
        format!("  resonances    {}", places.collect::<Vec<_>>().join(", ")),
        format!(
            "  level         {} kT: about as hot is the hottest of {} bonds in {} ps",
            few(*level, 3),
            measured.meant.0,
            decimal(&(&measured.meant.1 / number::Rational::from_integer(1000.into())))
        ),
    ];
    if let Some(depth) = measurement.depth.filter(|depth| *depth <= last) {
        lines.push(format!("  breaks        by itself at {} kT, whatever the step", few(depth, 3)));
    }
    let first = steps.iter().find(|step| !measured.is_enough(step));
    lines.push(match first {
        None => "  enough        every step asked for".into(),
        Some(step) => format!("  not enough    {} fs: {}", decimal(&step.step), words(step)),
    });
    lines
}

/// What was measured at a step.
fn words(step: &Step) -> String {
    match (step.turn, step.aperture) {
        (None, _) => "the step is linearly unstable".into(),
        (_, None) => "none was lost".into(),
        (_, Some(aperture)) => format!(
            "E* = {aperture} kT; of a thermal ensemble {} are lost in {EARLY} steps",
            few(step.share, 2)
        ),
    }
}
