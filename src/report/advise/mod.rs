//! Advice as a document: lines to act on, then tables.

#[cfg(feature = "figure")]
mod chart;
mod lines;
mod molecule;
mod words;

use serde_json::{Value, json};

use super::document::Document;
use super::record::Record;
use super::table::{Cell, Column, Table};
use crate::advise::engine::Reading;
use crate::advise::unit::decimal;
use crate::advise::{Advice, Answer, Mode, PUBLISHED, Pair, Row, Unstable};
use crate::number::Rational;

#[cfg(feature = "figure")]
pub use chart::{figure, figure_of_molecule};
pub use molecule::document as of_molecule;
pub use words::nearest;

/// The document `kickdrift/advise/1`, its input included; the rows with all columns, or with those that fit paper;
/// with what an engine's text says, where the steps are those of one.
pub fn document(advice: &Advice, reading: Option<&Reading>, all_columns: bool) -> Document {
    let rows = row_table(advice, all_columns);
    let (modes, schemes, pairs) = (mode_table(advice, true), scheme_table(advice, true), pair_table(advice));
    let document = echo(Document::new("advise"), advice)
        .entry("modes", modes.to_json_rows())
        .entry("schemes", schemes.to_json_rows())
        .entry("rows", row_table(advice, true).to_json_rows())
        .entry("intervals", interval_table(advice).to_json_rows())
        .entry("pairs", pairs.to_json_rows())
        .entry("published", published(advice))
        .entry("unknown", lines::UNKNOWN.to_vec());
    let document = document.long_rows(rows).and_rows(mode_table(advice, false));
    let document = if pairs.rows().is_empty() { document } else { document.and_rows(pairs) };
    let document = match reading {
        Some(reading) => document.entry("engine", engine(lines::of_answer(&advice.schemes[0]), reading)),
        None => document,
    };
    document.summary(&lines::of(advice, reading))
}

/// What was read of an engine's text, and its lines rewritten with the outer step that is advised.
fn engine(advised: Option<&Rational>, reading: &Reading) -> Value {
    let rewritten = advised.and_then(|outer| reading.changed_lines(outer).ok());
    json!({"name": reading.engine.name(), "dt": reading.engine.dt(), "forces": reading.forces, "used": reading.used, "remarks": reading.remarks, "rewritten": rewritten})
}

fn echo(document: Document, advice: &Advice) -> Document {
    let mode = |mode: &Mode| json!({"name": mode.name, "from": mode.origin.name(), "clock": mode.clock.map(|k| k + 1), "stiffness": mode.stiffness.to_string()});
    let steps =
        |answer: &Answer| -> Value { answer.scheme.steps().iter().map(ToString::to_string).collect() };
    let document = document
        .input("band", &advice.band)
        .input_json("modes", advice.modes.iter().map(mode).collect())
        .input_json("schemes", advice.schemes.iter().map(steps).collect());
    let document = match &advice.length {
        Some(length) => document.input("length", length),
        None => document,
    };
    let document = match &advice.friction {
        Some(friction) => document.input("friction", friction),
        None => document,
    };
    if advice.held.is_empty() {
        return document;
    }
    document.input_json("constrained", advice.held.iter().map(mode).collect())
}

/// The published statements with their limits in fs, for the fastest mode.
fn published(advice: &Advice) -> Value {
    let mode = &advice.modes[advice.fastest];
    let one = |of: &crate::advise::Caution| {
        let (lo, hi) = mode.part(of.parts);
        json!({"mode": mode.name, "parts": of.parts, "step": if of.inner { "inner" } else { "outer" }, "limit": {"lo": lo, "hi": hi},
            "statement": of.statement, "source": of.source})
    };
    PUBLISHED.iter().map(one).collect()
}

/// An enclosure for programs, a rounded decimal for people.
fn quantity(enclosure: Option<(f64, f64)>, all: bool) -> Cell {
    match enclosure {
        Some(ends) if all => ends.into(),
        Some(ends) => Cell::Exact(nearest(ends, 5)),
        None => Cell::Missing,
    }
}

fn column(key: &str, title: &str, all: bool) -> Column {
    let column = Column::new(key).in_words(title);
    if all { column.enclosure() } else { column }
}

fn mode_table(advice: &Advice, all: bool) -> Table {
    let mut record = Record::new()
        .field(Column::new("name").in_words("mode").left(), |mode: &Mode| mode.name.as_str().into())
        .field(Column::new("from").left(), |mode: &Mode| mode.origin.name().into())
        .field(Column::new("clock"), |mode: &Mode| mode.clock.map(|k| k as u64 + 1).into());
    if all {
        record = record
            .field(Column::new("stiffness").in_unit("1/fs^2"), |mode: &Mode| Cell::exact(&mode.stiffness));
    }
    let mut record = record
        .field(column("period", "T", all).in_unit("fs"), move |mode: &Mode| {
            quantity(Some(mode.period()), all)
        })
        .field(column("verlet", "T/pi", all), move |mode: &Mode| quantity(Some(mode.verlet()), all));
    for (parts, key) in [(2, "half"), (3, "third"), (4, "quarter"), (5, "fifth"), (10, "tenth")] {
        let title = format!("T/{parts}");
        record =
            record.field(column(key, &title, all), move |mode: &Mode| quantity(Some(mode.part(parts)), all));
    }
    if advice.modes.iter().any(|mode| mode.before.is_some()) || all {
        record =
            record.field(Column::new("before").in_words("T before").in_unit("fs"), move |mode: &Mode| {
                match mode.before {
                    Some(before) if !all => Cell::Exact(nearest((before, before), 5)),
                    other => other.into(),
                }
            });
    }
    record.table("modes", "Periods in fs, and the steps that they limit", &advice.modes)
}

fn scheme_table(advice: &Advice, all: bool) -> Table {
    let exact = |x: &Option<Rational>| x.as_ref().map_or(Cell::Missing, Cell::exact);
    let record = Record::new()
        .field(Column::new("outer").in_unit("fs"), |answer: &Answer| Cell::exact(answer.scheme.outer()))
        .field(Column::new("status").left(), |answer| answer.status.name().into())
        .field(column("band_edge", "stable below", all).in_unit("fs"), move |answer| {
            quantity(Some(answer.band_edge), all)
        })
        .field(Column::new("largest").in_unit("fs"), move |answer| exact(&answer.largest))
        .field(Column::new("safe").in_unit("fs"), move |answer| exact(&answer.safe))
        .field(Column::new("needs").in_unit("fs"), |answer| answer.needs.into())
        .field(Column::new("within_run"), |answer| answer.within_run.into());
    record.table("schemes", "Schemes of steps", &advice.schemes)
}

/// One row of one scheme, with what names it.
struct Named<'a> {
    scheme: usize,
    answer: &'a Answer,
    mode: &'a str,
    row: &'a Row,
}

type End = fn(&Unstable) -> Option<(f64, f64)>;
type Which = fn(&Row) -> Option<&Unstable>;

fn row_table(advice: &Advice, all: bool) -> Table {
    let named = advice.schemes.iter().enumerate().flat_map(|(n, answer)| {
        let one = move |row| Named { scheme: n + 1, answer, mode: "", row };
        answer.rows.iter().map(one)
    });
    let named: Vec<Named> = named.map(|of| Named { mode: &advice.modes[of.row.mode].name, ..of }).collect();
    let mut record = Record::new()
        .field(Column::new("scheme"), |of: &Named| (of.scheme as u64).into())
        .field(Column::new("outer").in_words("outer step").in_unit("fs"), move |of: &Named| {
            if all {
                Cell::exact(of.answer.scheme.outer())
            } else {
                Cell::Exact(decimal(of.answer.scheme.outer()))
            }
        })
        .field(Column::new("mode").left(), |of: &Named| of.mode.into())
        .field(Column::new("kind").left(), |of: &Named| of.row.found.kind.name().into())
        .field(column("trace", "Tr", all), move |of: &Named| quantity(Some(of.row.found.trace), all));
    record = record
        .field(column("growth_rate", "growth", all).in_unit("1/ps"), move |of: &Named| {
            quantity(Some(per_ps(of.row.found.rate)), all)
        })
        .field(column("tenfold_steps", "tenfold in steps", all), move |of: &Named| {
            quantity(of.row.tenfold_steps, all)
        });
    if all || advice.schemes.iter().any(|answer| answer.rows.iter().any(|row| row.masking.is_some())) {
        record = record.field(
            column("masked_above", "masked above a friction", all).in_unit("1/ps"),
            move |of: &Named| quantity(of.row.masking.map(per_ps), all),
        );
    }
    if all || advice.friction.is_some() {
        record = record.field(Column::new("damped"), |of: &Named| of.row.is_damped.into());
    }
    let places: [(&str, &str, Which); 4] = [
        ("first", "first unstable", |row| row.first.as_ref()),
        ("inside", "inside", |row| row.inside.as_ref()),
        ("below", "below it", |row| row.below.as_ref()),
        ("above", "above it", |row| row.above.as_ref()),
    ];
    let shown = if all { 4 } else { 1 };
    for (key, title, which) in places.into_iter().take(shown) {
        let ends: [(&str, &str, End); 2] =
            [("lower", "from", |of| Some(of.lower)), ("upper", "to", |of| of.upper)];
        for (end, word, find) in ends {
            let column = column(&format!("{key}_{end}"), &format!("{title} {word}"), all).in_unit("fs");
            record = record.field(column, move |of: &Named| quantity(which(of.row).and_then(find), all));
        }
        let worst = Column::new(&format!("{key}_tenfold_steps")).in_words("worst: tenfold in steps");
        record = record.field(worst, move |of: &Named| match which(of.row).and_then(|of| of.worst) {
            Some(worst) if !all => Cell::Exact(nearest((worst.steps, worst.steps), 4)),
            Some(worst) => worst.steps.into(),
            None => Cell::Missing,
        });
    }
    record.table(
        "rows",
        "Each fast mode at each scheme of steps, the stiffest modes on the other clocks",
        &named,
    )
}

fn interval_table(advice: &Advice) -> Table {
    let answers = advice.schemes.iter().enumerate();
    let rows = answers.flat_map(|(n, answer)| answer.rows.iter().map(move |row| (n as u64 + 1, row)));
    let all: Vec<(u64, usize, &Unstable)> =
        rows.flat_map(|(n, row)| row.intervals.iter().map(move |own| (n, row.mode, own))).collect();
    let record = Record::new()
        .field(Column::new("scheme"), |of: &(u64, usize, &Unstable)| of.0.into())
        .field(Column::new("mode").left(), |of| advice.modes[of.1].name.as_str().into())
        .field(Column::new("m"), |of| of.2.label.into())
        .field(column("lower", "from", true), |of| quantity(Some(of.2.lower), true))
        .field(column("upper", "to", true), |of| quantity(of.2.upper, true))
        .field(Column::new("tenfold_steps"), |of| of.2.worst.map(|worst| worst.steps).into());
    record.table("intervals", "Unstable intervals of the outer step", &all)
}

/// A rate per fs as one per ps, rounded outward.
fn per_ps((lo, hi): (f64, f64)) -> (f64, f64) {
    if (lo, hi) == (0.0, 0.0) { (lo, hi) } else { ((1000.0 * lo).next_down(), (1000.0 * hi).next_up()) }
}

fn pair_table(advice: &Advice) -> Table {
    let pairs = advice.schemes.iter().enumerate();
    let pairs: Vec<(usize, &Pair)> =
        pairs.flat_map(|(n, answer)| answer.pairs.iter().map(move |pair| (n + 1, pair))).collect();
    let name = |i: usize| Cell::from(advice.modes[i].name.as_str());
    let record = Record::new()
        .field(Column::new("scheme"), |of: &(usize, &Pair)| (of.0 as u64).into())
        .field(Column::new("first").left(), move |of: &(usize, &Pair)| name(of.1.modes[0]))
        .field(Column::new("second").left(), move |of: &(usize, &Pair)| name(of.1.modes[1]))
        .field(Column::new("near").in_words("outer step near").in_unit("fs"), |of: &(usize, &Pair)| {
            super::decimal::rounded(of.1.near, 4).into()
        });
    record.table("pairs", "Where two modes may resonate with each other (first order, not proven)", &pairs)
}
