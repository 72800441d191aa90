//! The aperture of a bond as a document, in words, and drawn.

mod chart;

use super::advise::time;
use super::decimal::few;
use super::document::Document;
use super::record::Record;
use super::shape::{ABOVE_0, FLAG, Keys, ROUNDED, ROUNDED_OR_NULL, Shape, TEXT};
use super::table::{Cell, Column};
pub use chart::figure;
use molecules::aperture::{EARLY, Hottest, LATE, Measured, PHASES, Resonance, Step, rungs};
use molecules::unit::{TimeUnit, decimal};
use number::to_f64;

/// What the document, the text and the schema say of every number.
const MEASURED: &str = "a measurement of the method on one bond in doubles, no proof";

/// Digits of tables that people read: energies are measured to a quarter of a kT.
const DIGITS: u32 = 5;

/// The document `kickdrift/aperture/1`; the caller adds the input.
pub fn document(measured: &Measured) -> Document {
    let rows: Vec<Row> = measured.steps.iter().map(|step| (step, measured.is_enough(step))).collect();
    let table = record().table("steps", "How hot a bond may be at each step, as measured", &rows);
    let has_band = measured.steps.iter().any(|step| step.band.is_some());
    head()
        .document(Document::new("aperture"), measured)
        .for_people(table.shortened(DIGITS).keeping(|column| has_band || !column.key.starts_with("band")))
        .rows(table)
        .summary(&lines(measured))
}

/// The keys of the document.
pub fn keys() -> Keys {
    const STEPS: Shape = Shape::With(&Shape::List(&Shape::Object(|| record().keys())), r#"{"minItems": 1}"#);
    let says = "By steps. Starts of energy E = 1/16, 2/16, ... 1, 5/4, ... 40 kT in 48 phases; a bond is lost where it is longer or shorter by more than 1 nm at a kick.";
    head().keys().key("steps", STEPS, says)
}

const NOT_BELOW_0: Shape = Shape::With(&ROUNDED, r#"{"minimum": 0}"#);

/// All but the steps.
fn head() -> Record<'static, Measured> {
    const K: Shape =
        Shape::Plain(r#"{"const": "a measurement of the method on one bond in doubles, no proof"}"#);
    Record::new()
        .json("kind", |_: &Measured| MEASURED.into())
        .says(K, "What every number here is.")
        .json("integrator", |measured| Cell::exact(&measured.word))
        .says(TEXT, "The word that was run.")
        .json("period", |measured| measured.measurement.period().into())
        .says(ABOVE_0, "The period of the smallest oscillations in fs; a rounded double.")
        .json("thermal_energy", |measured| measured.measurement.thermal().into())
        .says(ABOVE_0, "kT in kJ/mol; a rounded double.")
        .json("limit", |measured| measured.measurement.limit.into())
        .says(Shape::OrNull(&NOT_BELOW_0), "The step in fs at which linear stability ends; null where a slow force has steps of its own, or where there is no end; a rounded double.")
        .json("depth", |measured| measured.measurement.depth.into())
        .says(ROUNDED_OR_NULL, "The energy in kT at which the bond breaks by itself, whatever the step; null where it does not; a rounded double.")
        .json("level", |measured| measured.level.into())
        .says(NOT_BELOW_0, "The logarithm of bonds times picoseconds: about the energy in kT of the hottest of them; a rounded double.")
        .value("resonances", |measured| resonance().all(&measured.resonances).into())
        .says(Shape::List(&Shape::Object(|| resonance().keys())), "The first steps at which the method turns by the k-th part of a full turn.")
}

/// A step, and whether it is enough.
type Row<'a> = (&'a Step, bool);

/// The record of a step.
fn record<'a>() -> Record<'a, Row<'a>> {
    const TURN: Shape = Shape::OrNull(&Shape::With(&ROUNDED, r#"{"minimum": 0, "maximum": 0.5}"#));
    const SHARE: Shape = Shape::With(&ROUNDED, r#"{"minimum": 0, "maximum": 1}"#);
    Record::new()
        .field(Column::math("h", "h").in_unit("fs"), |(step, _): &Row| to_f64(&step.step).into())
        .says(ABOVE_0, "The step in fs; a rounded double.")
        .field(Column::new("turn"), |(step, _)| step.turn.into())
        .says(TURN, "The share of a full turn that the method makes in a step, for small oscillations; null where the step is linearly unstable; a rounded double.")
        .field(Column::math("k", "k"), |(step, _)| step.nearest.map(|(k, _)| k).into())
        .says(
            Shape::OrNull(&Shape::Plain(r#"{"type": "integer", "minimum": 2}"#)),
            "The k for which 2 pi/k is nearest to the turn; null where the step is linearly unstable.",
        )
        .field(Column::new("resonance").in_words("step of k").in_unit("fs"), |(step, _)| {
            step.nearest.and_then(|(_, h)| h).into()
        })
        .says(ROUNDED_OR_NULL, "The step in fs nearest to this one at which the method turns by 2 pi/k; null where there is none from 0 to three times this step; a rounded double.")
        .field(Column::new("aperture").titled("E*", "$E^*$").in_unit("kT"), |(step, _)| step.aperture.into())
        .says(ROUNDED_OR_NULL, "The least energy in kT at which some phase is lost within 20000 steps; null where none is up to 40 kT; a rounded double.")
        .field(Column::new("half_aperture").titled("half", "half").in_unit("kT"), |(step, _)| step.half.into())
        .says(ROUNDED_OR_NULL, "The least energy in kT at which at least half of all phases are lost within 20000 steps; null where they are at none up to 40 kT; a rounded double.")
        .field(Column::new("share_lost").in_words("share lost"), |(step, _)| step.share.into())
        .says(SHARE, "The share of a thermal ensemble of starts that is lost within 3000 steps; a rounded double.")
        .field(Column::new("enough_for").in_words("enough for").in_unit("bonds x ps"), |(step, _)| step.enough.into())
        .says(ROUNDED_OR_NULL, "exp(aperture): about one of so many bonds times picoseconds is as hot; null above 40 kT; a rounded double.")
        .field(Column::new("band_aperture").in_words("least of band").in_unit("kT"), |(step, _)| {
            step.band.as_ref().and_then(|hottest| hottest.aperture).into()
        })
        .says(ROUNDED_OR_NULL, "The least aperture of all bonds whose periods are longer by up to the band; null where none of them is lost up to 40 kT, and where no band was asked for; a rounded double.")
        .field(Column::new("band_step").in_words("at").in_unit("fs"), |(step, _)| {
            step.band.as_ref().map(|hottest| to_f64(&hottest.step)).into()
        })
        .says(Shape::OrNull(&ABOVE_0), "The step in fs at which the bond at rest has it; null where no band was asked for; a rounded double.")
        .field(Column::new("enough"), |(_, enough)| (*enough).into())
        .says(FLAG, "Whether the step is linearly stable and its aperture, with a band that of the band, not below the level.")
}

fn resonance() -> Record<'static, Resonance> {
    Record::new()
        .field(Column::new("k"), |resonance: &Resonance| resonance.k.into())
        .says(Shape::Plain(r#"{"type": "integer", "minimum": 3, "maximum": 8}"#), "The part of a full turn.")
        .field(Column::new("h"), |resonance| resonance.step.into())
        .says(ROUNDED_OR_NULL, "The step in fs; null where there is none up to the linear limit, or to 5/4 of the longest step asked for; a rounded double.")
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
            "  level         {} kT: the hottest of {} bonds in {} is about as hot",
            few(*level, 3),
            measured.meant.0,
            time(&measured.meant.1, TimeUnit::Femtoseconds)
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

/// What the bonds of a band have, where that was asked for.
fn band_words(step: &Step) -> String {
    let least = |hottest: &Hottest| hottest.aperture.map(|least| (least, few(to_f64(&hottest.step), 5)));
    let least = step.band.as_ref().and_then(least);
    least.map_or_else(String::new, |(least, at)| format!("; in its band E* = {least} kT, as at {at} fs"))
}

/// What was measured at a step.
fn words(step: &Step) -> String {
    match (step.turn, step.aperture) {
        (None, _) => "the step is linearly unstable".into(),
        (_, None) => format!("none was lost{}", band_words(step)),
        (_, Some(aperture)) => format!(
            "E* = {aperture} kT; of a thermal ensemble {} are lost in {EARLY} steps{}",
            few(step.share, 2),
            band_words(step)
        ),
    }
}
