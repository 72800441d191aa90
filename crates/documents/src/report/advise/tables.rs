//! Tables that all advice has.

use serde_json::Value;

use super::words::{nearest, rounded};
use crate::report::record::Record;
use crate::report::shape::{ROUNDED, Shape, TEXT, TEXTS, WIDE_ENCLOSURE};
use crate::report::table::{Cell, Column, Table};
use molecules::Caution;
use molecules::engine::{Engine, Reading};
use number::Rational;

/// Advice, and the engine's text that its steps are of.
pub type Told<'a, T> = (&'a T, Option<&'a Reading>);

/// The sentence on the entry `engine` of a document, and what it is.
pub const ENGINE_SAYS: &str = "What was read of an engine's input, where the steps are its own.";
pub const ENGINE: Shape = Shape::Object(|| engine_record().keys());

/// An engine's text, and the outer step that is advised.
type Read<'a> = (&'a Reading, Option<&'a Rational>);

/// An engine's text as it was read, and its lines rewritten with the outer step that is advised.
pub fn engine(advised: Option<&Rational>, reading: &Reading) -> Value {
    engine_record().entries(&(reading, advised))
}

fn engine_record<'a>() -> Record<'a, Read<'a>> {
    Record::new()
        .json("name", |(reading, _): &Read| reading.engine.name().into())
        .says(Shape::OneOf(Engine::NAMES), "")
        .json("dt", |(reading, _)| reading.engine.dt().into())
        .says(TEXT, "Which step its dt is.")
        .value("forces", |(reading, _)| reading.forces.clone().into())
        .says(TEXTS, "On each clock, the innermost first.")
        .value("used", |(reading, _)| reading.used.clone().into())
        .says(TEXTS, "The keys that were used.")
        .value("remarks", |(reading, _)| reading.remarks.clone().into())
        .says(TEXTS, "")
        .value("rewritten", |(reading, advised)| {
            advised.and_then(|outer| reading.changed_lines(outer).ok()).into()
        })
        .says(
            Shape::OrNull(&TEXTS),
            "The lines of its input that change with the outer step that is advised; null where none do.",
        )
}

/// The sentence on the entry `published` of a document, and what it is.
pub const PUBLISHED_SAYS: &str = "What is published and not proven, for the fastest mode on any clock but the outermost, or on the innermost one: steps in fs. Of several clocks near T/3 and T/4, as for r-RESPA; of a clock's own step at the turns of the method itself, (T/pi) sin(pi/k).";
pub const PUBLISHED: Shape =
    Shape::List(&Shape::Object(|| published_record([""; 2], |_| Cell::Missing).keys()));

/// What is published about a scheme of so many steps, for the fastest mode on any clock but the outermost and
/// for that on the innermost one: each with its limit in fs.
pub fn published(steps: usize, modes: [&str; 2], limit: impl Fn(&Caution) -> Cell + Send + Sync) -> Value {
    published_record(modes, limit).all(molecules::published(steps)).into()
}

fn published_record<'a>(
    modes: [&'a str; 2],
    limit: impl Fn(&Caution) -> Cell + Send + Sync + 'a,
) -> Record<'a, Caution> {
    const PLACE: Shape = Shape::Plain(r#"{"type": "string", "pattern": "^T/[0-9.]+$"}"#);
    Record::new()
        .json("mode", move |caution: &Caution| modes[usize::from(caution.inner)].into())
        .says(TEXT, "")
        .json("place", |caution| Cell::Text(caution.place.name()))
        .says(PLACE, "")
        .json("step", |caution| if caution.inner { "inner" } else { "outer" }.into())
        .says(Shape::OneOf(&["inner", "outer"]), "")
        .json("limit", limit)
        .says(
            Shape::Any(&[WIDE_ENCLOSURE, ROUNDED]),
            "Of periods an enclosure, of Hessians a rounded double.",
        )
        .json("statement", |caution| caution.statement.into())
        .says(TEXT, "")
        .json("source", |caution| caution.source.into())
        .says(TEXT, "")
}

/// A table for people: of its columns those that are to be shown, numbers rounded to five digits.
pub fn for_people(full: &Table, shown: impl Fn(&str) -> bool) -> Table {
    let kept = full.keeping(|column| shown(&column.key));
    let columns = kept.columns().iter().map(|column| Column { enclosed: false, ..column.clone() });
    let mut table = Table::new(kept.name(), kept.caption(), columns.collect());
    let five_digits = |cell: &Cell| match *cell {
        Cell::Float(x) => Cell::Exact(rounded(x, 5)),
        Cell::Enclosure { lo, hi } => Cell::Exact(nearest((lo, hi), 5)),
        _ => cell.clone(),
    };
    kept.rows().iter().for_each(|row| table.push(row.iter().map(five_digits).collect()));
    table
}

/// One of several things of a scheme, with the number of that scheme.
pub type Numbered<'a, T> = (usize, &'a T);

/// These things of all schemes, in their order.
pub fn numbered<S, T>(schemes: &[S], of: impl Fn(&S) -> &[T]) -> Vec<Numbered<'_, T>> {
    let each = |(n, scheme)| of(scheme).iter().map(move |thing| (n, thing));
    (1..).zip(schemes).flat_map(each).collect()
}

/// An enclosure, in fs unless it is said otherwise.
pub fn enclosed(key: &str, title: &str) -> Column {
    Column::new(key).in_words(title).enclosure()
}
