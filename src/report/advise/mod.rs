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
use crate::advise::{Advice, Answer, Caution, Mode, PUBLISHED, Pair, Row, Scheme, Unstable};
use crate::number::Rational;

#[cfg(feature = "figure")]
pub use chart::{figure, figure_of_molecule};
pub use molecule::document as of_molecule;
pub use words::nearest;

/// The document `kickdrift/advise/1`, its input included; the rows with all columns, or with those that fit paper;
/// with what an engine's text says, where the steps are those of one.
pub fn document(advice: &Advice, reading: Option<&Reading>, all_columns: bool) -> Document {
    let (modes, pairs, fastest) = (mode_table(advice), pair_table(advice), &advice.modes[advice.fastest]);
    let document = echo(Document::new("advise"), advice)
        .entry("modes", modes.to_json_rows())
        .entry("schemes", scheme_table(advice).to_json_rows())
        .entry("rows", row_table(advice, true).to_json_rows())
        .entry("intervals", interval_table(advice).to_json_rows())
        .entry("pairs", pairs.to_json_rows())
        .entry("published", published(&fastest.name, |parts| fastest.part(parts).into()))
        .entry("unknown", lines::UNKNOWN.to_vec());
    let changed = advice.modes.iter().any(|mode| mode.before.is_some());
    let modes = for_people(&modes, |key| key != "stiffness" && (key != "before" || changed));
    let document = document.long_rows(row_table(advice, all_columns)).and_rows(modes);
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
    let document = document
        .input("band", &advice.band)
        .input_json("modes", advice.modes.iter().map(mode).collect())
        .input_json("schemes", schemes(advice.schemes.iter().map(|own| &own.scheme)));
    let document = document
        .input_given("length", advice.length.as_ref())
        .input_given("friction", advice.friction.as_ref());
    if advice.held.is_empty() {
        return document;
    }
    document.input_json("constrained", advice.held.iter().map(mode).collect())
}

/// The published statements for the fastest mode, with their limits in fs: `part` of its period.
fn published(mode: &str, part: impl Fn(u64) -> Cell + Send + Sync) -> Value {
    let record = Record::new()
        .field(Column::new("mode"), |_: &Caution| mode.into())
        .field(Column::new("parts"), |of| of.parts.into())
        .field(Column::new("step"), |of| if of.inner { "inner" } else { "outer" }.into())
        .field(Column::new("limit"), |of| part(of.parts))
        .field(Column::new("statement"), |of| of.statement.into())
        .field(Column::new("source"), |of| of.source.into());
    record.all(&PUBLISHED).into()
}

/// The steps of schemes, from the innermost on.
fn schemes<'a>(all: impl Iterator<Item = &'a Scheme>) -> Value {
    all.map(|own| own.steps().iter().map(ToString::to_string).collect::<Value>()).collect()
}

/// A table for people: of its columns those that are to be shown, numbers rounded to five digits.
fn for_people(full: &Table, shown: impl Fn(&str) -> bool) -> Table {
    let kept = || full.columns().iter().map(|column| shown(&column.key));
    let columns = full.columns().iter().zip(kept()).filter(|(_, kept)| *kept);
    let columns = columns.map(|(column, _)| Column { enclosed: false, ..column.clone() }).collect();
    let mut table = Table::new(full.name(), full.caption(), columns);
    for row in full.rows() {
        let cell = |(cell, kept): (&Cell, bool)| match *cell {
            _ if !kept => None,
            Cell::Float(x) => Some(Cell::Exact(nearest((x, x), 5))),
            Cell::Enclosure { lo, hi } => Some(Cell::Exact(nearest((lo, hi), 5))),
            _ => Some(cell.clone()),
        };
        table.push(row.iter().zip(kept()).filter_map(cell).collect());
    }
    table
}

/// An enclosure, in fs unless it is said otherwise.
fn enclosed(key: &str, title: &str) -> Column {
    Column::new(key).in_words(title).enclosure()
}

fn mode_table(advice: &Advice) -> Table {
    let mut record = Record::new()
        .field(Column::new("name").in_words("mode").left(), |mode: &Mode| mode.name.as_str().into())
        .field(Column::new("from").left(), |mode| mode.origin.name().into())
        .field(Column::new("clock"), |mode| mode.clock.map(|k| k as u64 + 1).into())
        .field(Column::new("stiffness").in_unit("1/fs^2"), |mode| Cell::exact(&mode.stiffness))
        .field(enclosed("period", "T").in_unit("fs"), |mode| mode.period().into())
        .field(enclosed("verlet", "T/pi"), |mode| mode.verlet().into());
    for (parts, key) in [(2, "half"), (3, "third"), (4, "quarter"), (5, "fifth"), (10, "tenth")] {
        record = record.field(enclosed(key, &format!("T/{parts}")), move |mode| mode.part(parts).into());
    }
    record.field(Column::new("before").in_words("T before").in_unit("fs"), |mode| mode.before.into()).table(
        "modes",
        "Periods in fs, and the steps that they limit",
        &advice.modes,
    )
}

fn scheme_table(advice: &Advice) -> Table {
    Record::new()
        .field(Column::new("outer"), |answer: &Answer| Cell::exact(answer.scheme.outer()))
        .field(Column::new("status"), |answer| answer.status.name().into())
        .field(Column::new("band_edge").enclosure(), |answer| answer.band_edge.into())
        .field(Column::new("largest"), |answer| answer.largest.as_ref().map(Cell::exact).into())
        .field(Column::new("safe"), |answer| answer.safe.as_ref().map(Cell::exact).into())
        .field(Column::new("needs"), |answer| answer.needs.into())
        .field(Column::new("within_run"), |answer| answer.within_run.into())
        .table("schemes", "", &advice.schemes)
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
        .field(Column::new("outer").in_words("outer step").in_unit("fs"), move |of| {
            let outer = of.answer.scheme.outer();
            if all { Cell::exact(outer) } else { Cell::Exact(decimal(outer)) }
        })
        .field(Column::new("mode").left(), |of| of.mode.into())
        .field(Column::new("kind").left(), |of| of.row.found.kind.name().into())
        .field(enclosed("trace", "Tr"), |of| of.row.found.trace.into())
        .field(enclosed("growth_rate", "growth").in_unit("1/ps"), |of| per_ps(of.row.found.rate).into())
        .field(enclosed("tenfold_steps", "tenfold in steps"), |of| of.row.tenfold_steps.into())
        .field(enclosed("masked_above", "masked above a friction").in_unit("1/ps"), |of| {
            of.row.masking.map(per_ps).into()
        })
        .field(Column::new("damped"), |of| of.row.is_damped.into());
    let places: [(&str, &str, Which); 4] = [
        ("first", "first unstable", |row| row.first.as_ref()),
        ("inside", "inside", |row| row.inside.as_ref()),
        ("below", "below it", |row| row.below.as_ref()),
        ("above", "above it", |row| row.above.as_ref()),
    ];
    let shown = if all { 4 } else { 1 };
    let ends: [(&str, &str, End); 2] =
        [("lower", "from", |of| Some(of.lower)), ("upper", "to", |of| of.upper)];
    for (key, title, which) in places.into_iter().take(shown) {
        for (end, word, find) in ends {
            let column = enclosed(&format!("{key}_{end}"), &format!("{title} {word}")).in_unit("fs");
            record = record.field(column, move |of| which(of.row).and_then(find).into());
        }
        let worst = Column::new(&format!("{key}_tenfold_steps")).in_words("worst: tenfold in steps");
        record = record.field(worst, move |of| match which(of.row).and_then(|of| of.worst) {
            Some(worst) if !all => Cell::Exact(nearest((worst.steps, worst.steps), 4)),
            worst => worst.map(|worst| worst.steps).into(),
        });
    }
    let caption = "Each fast mode at each scheme of steps, the stiffest modes on the other clocks";
    let table = record.table("rows", caption, &named);
    if all {
        return table;
    }
    let masked = named.iter().any(|of| of.row.masking.is_some());
    for_people(&table, |key| match key {
        "masked_above" => masked,
        "damped" => advice.friction.is_some(),
        _ => true,
    })
}

fn interval_table(advice: &Advice) -> Table {
    let answers = advice.schemes.iter().enumerate();
    let rows = answers.flat_map(|(n, answer)| answer.rows.iter().map(move |row| (n as u64 + 1, row)));
    let all: Vec<(u64, usize, &Unstable)> =
        rows.flat_map(|(n, row)| row.intervals.iter().map(move |own| (n, row.mode, own))).collect();
    let record = Record::new()
        .field(Column::new("scheme"), |of: &(u64, usize, &Unstable)| of.0.into())
        .field(Column::new("mode"), |of| advice.modes[of.1].name.as_str().into())
        .field(Column::new("m"), |of| of.2.label.into())
        .field(Column::new("lower").enclosure(), |of| of.2.lower.into())
        .field(Column::new("upper").enclosure(), |of| of.2.upper.into())
        .field(Column::new("tenfold_steps"), |of| of.2.worst.map(|worst| worst.steps).into());
    record.table("intervals", "", &all)
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
