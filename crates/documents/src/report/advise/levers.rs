//! Levers that would let the step grow: table and lines.

use serde_json::Value;

use super::tables::{enclosed, for_people};
use super::words::rounded;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{ENCLOSED_OR_NULL, EXACT, FLAG, RATIONAL_OR_NULL, ROUNDED_OR_NULL, Shape, TEXT};
use crate::report::table::{Cell, Column, Table};
use molecules::unit::{TimeUnit, decimal};
use molecules::{Bound, Keyword, Lever, Levers, Way};
use number::{Rational, to_f64};

/// The method's name in documents.
fn method(way: Way) -> &'static str {
    match way {
        Way::Verlet | Way::Respa | Way::Hydrogens | Way::Held | Way::HeldAndHeavy => "kicks and drifts",
        Way::Molly(trigonometric) => trigonometric.name(),
        Way::Equilibrium => "molly-equilibrium",
        Way::ImplicitExplicit => "implicit-explicit",
        Way::Friction => "kicks and drifts with friction",
    }
}

fn joined(engines: &[Keyword], each: impl Fn(&Keyword) -> String) -> Cell {
    let all: Vec<String> = engines.iter().map(each).collect();
    if all.is_empty() { Cell::Missing } else { Cell::Text(all.join("; ")) }
}

fn record(unit: TimeUnit) -> Record<'static, Lever> {
    let [time, rate] = unit.names();
    // "/ps".
    let per = &rate[1..];
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    let rounded = |x: Option<Rational>| Cell::from(x.as_ref().map(to_f64));
    let step = |lever: &Lever| lever.step.as_ref().map(|(step, _)| step.clone());
    const METHOD: Shape = Shape::OneOf(&[
        "kicks and drifts",
        "molly-short",
        "molly-linear",
        "molly-long",
        "molly-equilibrium",
        "implicit-explicit",
        "kicks and drifts with friction",
    ]);
    Record::new()
        .field(Column::new("lever").left(), |lever: &Lever| lever.name.as_str().into())
        .says(TEXT, "")
        .field(Column::new("method").left(), |lever| method(lever.way).into())
        .says(METHOD, "")
        .field(enclosed("first", "first unstable").in_unit(time), |lever| lever.first.into())
        .says(ENCLOSED_OR_NULL, "The first unstable outer step, of periods that of one fast mode at a time; null where there is none (free) or it is not told.")
        .field(column("first_exact", "exactly").in_unit(time), |lever| {
            lever.exact.as_ref().map(Cell::exact).into()
        })
        .says(Shape::OrNull(&EXACT), "The same exactly, where it is a rational times a power of pi.")
        .field(Column::new("free"), |lever| lever.is_free.into())
        .says(FLAG, "Whether no outer step at all is unstable by a resonance of one fast mode, for all periods in the band: proven.")
        .field(enclosed("band_edge", "proven below").in_unit(time), |lever| lever.band_edge.into())
        .says(ENCLOSED_OR_NULL, "Every outer step below its lower end is proven stable for all periods in the band: of periods for any coupling of such modes, of Hessians within their accuracy, fast periods each for itself and slow ones together; null where that is not told.")
        .field(column("step", "take").in_unit(time), move |lever| {
            step(lever).as_ref().map(Cell::exact).into()
        })
        .says(RATIONAL_OR_NULL, "The outer step to take; null where none is proven.")
        .field(column("bound", "bounded by").left(), |lever| {
            lever.step.as_ref().map(|(_, bound)| bound.name()).into()
        })
        .says(Shape::OrNull(&Shape::OneOf(Bound::NAMES)), "What bounds the step: the edge of the band; the aperture of a bond whose shape is known, measured; T/3 of the fastest period, published of kicks and drifts; h w <= 1 of the fastest motion on an inner clock or the only one; the same of the slow force, which every method follows by Verlet's rule; the friction given, for the periods given and none beside.")
        .field(Column::new("inner").in_unit(time), |lever| lever.inner.as_ref().map(Cell::exact).into())
        .says(RATIONAL_OR_NULL, "The innermost step beside it; null where the fast forces are solved for.")
        .field(column("slow_per_ps", &format!("slow{per}")), move |lever| rounded(lever.slow_per_ps(unit)))
        .says(ROUNDED_OR_NULL, "Evaluations of the slowest force a picosecond; the nearest double.")
        .field(column("fast_per_ps", &format!("fast{per}")), move |lever| rounded(lever.fast_per_ps(unit)))
        .says(ROUNDED_OR_NULL, "Evaluations of the fastest force; the nearest double.")
        .field(column("solves_per_ps", &format!("solves{per}")), move |lever| {
            rounded(lever.solves_per_ps(unit))
        })
        .says(ROUNDED_OR_NULL, "Linear systems; the nearest double.")
        .field(Column::new("gain"), move |lever| rounded(lever.gain.clone()))
        .says(ROUNDED_OR_NULL, "The step over the longest one of kicks and drifts as they are today, as given or at another ratio; the nearest double.")
        .field(column("engines", "who has it").left(), |lever| {
            joined(lever.way.engines(), |known| format!("{} {}", known.engine, known.keyword))
        })
        .says(Shape::OrNull(&TEXT), "Engines that are known to have it, with their keywords.")
        .field(Column::new("sources").left(), |lever| {
            joined(lever.way.engines(), |known| known.source.into())
        })
        .says(Shape::OrNull(&TEXT), "Where that is written, in the same order.")
}

/// For people: three digits; who has it stands in lines.
fn shown(levers: &Levers, full: &Table, unit: TimeUnit) -> Table {
    let columns: Vec<String> =
        ["lever", "first", "band_edge", "step", "bound", "slow_per_ps", "fast_per_ps", "gain"]
            .map(Into::into)
            .into();
    let mut table = for_people(full, |key| columns.iter().any(|text| text == key));
    let rows: Vec<Vec<Cell>> = table.rows().to_vec();
    table = Table::new(full.name(), full.caption(), table.columns().to_vec());
    let text = |x: &Rational| Cell::Exact(rounded(to_f64(x), 3));
    for (lever, mut row) in levers.rows.iter().zip(rows) {
        if lever.is_free {
            row[1] = Cell::Text("none".into());
        }
        row[3] = lever.step.as_ref().map(|(step, _)| Cell::Exact(decimal(step))).into();
        row[5] = lever.slow_per_ps(unit).as_ref().map(text).into();
        row[6] = match lever.solves_per_ps(unit) {
            Some(solves) => Cell::Text(format!("{} solves", rounded(to_f64(&solves), 3))),
            None => lever.fast_per_ps(unit).as_ref().map(text).into(),
        };
        row[7] = lever.gain.as_ref().map(text).into();
        table.push(row);
    }
    table
}

/// The sentences on the entries `levers` and `levers_left_out` of a document, and what the first is.
pub(super) const SAYS: &str =
    "What would let the outer step of the first scheme grow, where that was asked; lengths in fs.";
pub(super) const LEFT_OUT: &str = "What was not computed, and why.";
pub(super) const SHAPE: Shape = Shape::List(&Shape::Object(|| record(TimeUnit::Femtoseconds).keys()));

/// The entry `levers`.
pub(super) fn value(levers: &Levers, unit: TimeUnit) -> Value {
    record(unit).all(&levers.rows).into()
}

/// Adds the table for people, where they were asked for.
pub(super) fn add(document: Document, levers: Option<&Levers>, unit: TimeUnit) -> Document {
    let Some(levers) = levers.filter(|levers| !levers.rows.is_empty()) else { return document };
    let caption = "What would let the outer step grow: proven below for all periods in the band";
    document.and_rows(shown(levers, &record(unit).table("levers", caption, &levers.rows), unit))
}

/// Levers whose gains are within 2 % of each other are one.
pub(super) const AS_GOOD: f64 = 0.98;

/// One of several levers that are as good, and how many others there are: by name where it is one.
pub(super) fn one_of(name: &str, others: &[&str]) -> String {
    match others {
        [] => name.into(),
        [other] => format!("{name} or {other}"),
        _ => format!("{name} or {} others", others.len()),
    }
}

/// The three levers that let the outer step grow most, longer than kicks and drifts as they are.
pub(super) fn longer(levers: &Levers, unit: TimeUnit) -> Option<String> {
    let mut best: Vec<(&Lever, &Rational, f64)> = levers.rows.iter().filter_map(gained).collect();
    best.retain(|(lever, _, gain)| *gain > 1.0 && !matches!(lever.way, Way::Respa | Way::Friction));
    best.sort_by(|a, b| b.2.total_cmp(&a.2));
    let mut groups: Vec<Vec<(&Lever, &Rational, f64)>> = Vec::new();
    for one in best {
        match groups.last_mut() {
            Some(group) if one.2 >= AS_GOOD * group[0].2 => group.push(one),
            _ => groups.push(vec![one]),
        }
    }
    let shown = |group: &Vec<(&Lever, &Rational, f64)>| {
        // An engine has it, where one has.
        let (lever, step, gain) =
            group.iter().find(|one| !one.0.way.engines().is_empty()).unwrap_or(&group[0]);
        let others: Vec<&str> =
            group.iter().map(|one| &*one.0.name).filter(|name| *name != lever.name).collect();
        let name = one_of(&lever.name, &others);
        let today = *step / lever.gain.as_ref().expect("only what gains is here");
        let today = unit.of(rounded(to_f64(&today), 3));
        let gain = rounded(*gain, 3);
        (format!("{} by {name}", unit.of(decimal(step))), gain, today)
    };
    // What all are compared with is said once.
    let shown: Vec<String> = groups
        .iter()
        .take(3)
        .map(shown)
        .enumerate()
        .map(|(n, (way, gain, today))| match n {
            0 => format!("{way} ({gain} times the {today} of kicks and drifts at their best)"),
            _ => format!("{way} ({gain} times)"),
        })
        .collect();
    if levers.rows.is_empty() {
        None
    } else if shown.is_empty() {
        let is_one_clock = levers.rows[0].way == Way::Verlet;
        let slower = "; forces that are slow may have a longer step of their own: ask about two steps, the shorter first";
        Some(format!(
            "longer: nothing that was looked at lets the step grow{}",
            if is_one_clock { slower } else { "" }
        ))
    } else {
        Some(format!("longer: {}", shown.join("; ")))
    }
}

fn gained(lever: &Lever) -> Option<(&Lever, &Rational, f64)> {
    let (step, _) = lever.step.as_ref()?;
    Some((lever, step, to_f64(lever.gain.as_ref()?)))
}

/// The lines beside the table.
pub(super) fn lines(levers: &Levers, unit: TimeUnit) -> Vec<String> {
    let mut lines = Vec::new();
    let best = levers.rows.iter().filter(|lever| lever.gain.is_some() && lever.way != Way::Friction);
    let best = best.max_by(|a, b| a.gain.cmp(&b.gain).then(std::cmp::Ordering::Greater));
    if let Some((lever, (step, bound))) = best.and_then(|best| Some((best, best.step.as_ref()?))) {
        let gain = lever.gain.as_ref().map_or(1.0, to_f64);
        let word = if gain > 1.0 {
            format!(", {} times that of kicks and drifts as given or at another ratio", rounded(gain, 3))
        } else {
            String::new()
        };
        lines.push(format!(
            "  levers     the longest step: {} by {} (bounded by {}){word}",
            unit.of(decimal(step)),
            lever.name,
            bound.name()
        ));
    }
    let solved =
        |lever: &Lever| matches!(lever.way, Way::Molly(_) | Way::Equilibrium | Way::ImplicitExplicit);
    if levers.rows.iter().any(solved) {
        lines.push(
            "             MOLLY and implicit-explicit: by linear theory alone; T/3 is published of kicks and drifts. MOLLY follows the fast motion \
             exactly; what its filter costs is not counted"
                .into(),
        );
    }
    if levers.rows.iter().any(|lever| matches!(lever.step, Some((_, Bound::Friction)))) {
        lines.push(
            "             friction: it hides what grows for the periods given; no advice rests on it".into(),
        );
    }
    let unknown = |lever: &&Lever| matches!(lever.way, Way::Molly(_) | Way::ImplicitExplicit);
    let unknown: Vec<&str> = levers.rows.iter().filter(unknown).map(|lever| lever.name.as_str()).collect();
    if !unknown.is_empty() {
        lines.push(format!("             {}: no engine is known to have them", unknown.join("; ")));
    }
    let mut shown: Vec<Way> = Vec::new();
    for lever in levers.rows.iter().filter(|lever| !lever.way.engines().is_empty()) {
        if !shown.contains(&lever.way) {
            shown.push(lever.way);
            let all: Vec<String> = lever
                .way
                .engines()
                .iter()
                .map(|known| format!("{} {}", known.engine, known.keyword))
                .collect();
            let name = if lever.way == Way::Respa { "as given, other ratios" } else { &lever.name };
            lines.push(format!("             {name}: {}", all.join("; ")));
        }
    }
    lines.extend(levers.left_out.iter().map(|why| format!("  left out   {why}")));
    lines
}
