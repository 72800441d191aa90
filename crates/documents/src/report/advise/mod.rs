//! Advice as a document: lines to act on, then tables.

mod answer;
mod bias;
mod chart;
mod direct;
mod growth;
mod levers;
mod lines;
mod molecule;
mod tables;
mod words;

use super::document::Document;
use super::record::Record;
use super::table::{Cell, Column, Table};
use serde_json::Value;

use molecules::aperture::{Cold, Edge};
use molecules::engine::Reading;
use molecules::unit::{TimeUnit, decimal};
use molecules::{Advice, Answer, Caution, DirectFindings, Findings, Mode, Pair, Row, Unstable};
use number::{Rational, outward};
use systems::friction::Masked;

pub use chart::levers as levers_figure;
use tables::{enclosed, engine, for_people, published};
pub use words::nearest;

/// The subject of advice.
#[derive(Clone, Copy)]
pub enum View<'a> {
    /// Periods and bonds.
    Periods(&'a Advice),
    /// The Hessians of a molecule.
    Hessians(&'a Findings),
    /// Forces that are no gradient.
    Direct(&'a DirectFindings),
}

/// The document `kickdrift/advise/1`, `kickdrift/advise-system/1` or `kickdrift/advise-direct/1`, but for the
/// input; with what an engine's text says, where the steps are those of one; for people with `notes` on how
/// it was read.
pub fn document(view: View, reading: Option<&Reading>, notes: &[String]) -> Document {
    match view {
        View::Periods(advice) => of_periods(advice, reading),
        View::Hessians(findings) => molecule::document(findings, reading, notes),
        View::Direct(findings) => direct::document(findings, reading, notes),
    }
}

/// Each mode and each pair of modes, or the molecule and each group of its fast modes, at each scheme's own
/// ratio, and the schemes' outer steps as lines through their rows. Of forces that are no gradient the growth
/// over the outer step; `None` where there is one step alone.
pub fn figure(view: View, title: &str) -> Option<plot::Figure> {
    match view {
        View::Periods(advice) => Some(chart::of_periods(advice, title)),
        View::Hessians(findings) => Some(chart::of_molecule(findings, title)),
        View::Direct(findings) => growth::figure(findings, title),
    }
}

/// JSON and CSV have all columns of the rows, people those that fit paper.
fn of_periods(advice: &Advice, reading: Option<&Reading>) -> Document {
    let (modes, pairs) = (mode_table(advice), pair_table(advice));
    // The fastest on any clock but the outermost, and on the innermost one.
    let fastest = &advice.modes[advice.fastest];
    let on_first = advice.modes.iter().filter(|mode| mode.clock == Some(0));
    let inner = on_first.max_by(|a, b| a.stiffness.cmp(&b.stiffness)).unwrap_or(fastest);
    let whose = [fastest, inner];
    let limit = |caution: &Caution| whose[usize::from(caution.inner)].at(caution.place).into();
    let steps = advice.schemes[0].scheme.steps().len();
    let rows = row_table(advice, true);
    let document = Document::new("advise")
        .entry("modes", modes.to_json_rows())
        .entry("schemes", scheme_table(advice).to_json_rows())
        .entry("rows", rows.to_json_rows())
        .entry("intervals", interval_table(advice).to_json_rows())
        .entry("pairs", pairs.to_json_rows())
        .entry(
            "published",
            if advice.lacks_fast {
                Vec::<Value>::new().into()
            } else {
                published(steps, whose.map(|whose| whose.name.as_str()), limit)
            },
        )
        .entry("unknown", lines::unknown(advice).to_vec())
        .entries((!advice.cold.is_empty()).then(|| ("measured", cold_record().all(&advice.cold))));
    let changed = advice.modes.iter().any(|mode| mode.before().is_some());
    let modes = for_people(&modes, |key| key != "stiffness" && (key != "before" || changed));
    let document = document.long_rows(rows).for_people(row_table(advice, false));
    let document = levers::add(document, advice.levers.as_ref(), advice.unit).and_rows(modes);
    let document = if pairs.rows().is_empty() { document } else { document.and_rows(pairs) };
    let step = lines::of_answer(&advice.schemes[0]);
    let document = document.entries(reading.map(|reading| ("engine", engine(step, reading))));
    let lines = lines::of(advice, reading);
    document.summary(&lines).answer(answer::of(&lines))
}

fn mode_table(advice: &Advice) -> Table {
    let caption = format!(
        "Periods{}, and the steps that they limit",
        if advice.unit == TimeUnit::Plain { "" } else { " in fs" }
    );
    let mut record = Record::new()
        .field(Column::new("name").in_words("mode").left(), |mode: &Mode| mode.name.as_str().into())
        .field(Column::new("from").left(), |mode| mode.origin.name().into())
        .field(Column::new("clock"), |mode| mode.clock.map(|k| k as u64 + 1).into())
        .field(
            Column::new("stiffness").in_unit(if advice.unit == TimeUnit::Plain {
                "1/time^2"
            } else {
                "1/fs^2"
            }),
            |mode| Cell::exact(&mode.stiffness),
        )
        .field(enclosed("period", "T").in_unit(advice.unit.names()[0]), |mode| mode.period().into())
        .field(enclosed("verlet", "T/pi"), |mode| mode.verlet().into());
    for (parts, key) in [(2, "half"), (3, "third"), (4, "quarter"), (5, "fifth"), (10, "tenth")] {
        record = record.field(enclosed(key, &format!("T/{parts}")), move |mode| mode.part(parts).into());
    }
    record
        .field(Column::new("before").in_words("T before").in_unit(advice.unit.names()[0]), |mode| {
            mode.before().into()
        })
        .table("modes", &caption, &advice.modes)
}

/// The record of a bond of a known shape, by a kind of scheme.
fn cold_record() -> Record<'static, Cold> {
    let of = |find: fn(&Edge) -> f64| move |cold: &Cold| cold.first.as_ref().map(find).into();
    Record::new()
        .field(Column::new("mode"), |cold: &Cold| cold.name.as_str().into())
        .field(Column::new("method"), |cold| cold.kind.method.into())
        .field(Column::new("share"), of(|edge| edge.share))
        .field(Column::new("aperture"), of(|edge| edge.aperture))
        .field(Column::new("level"), |cold| cold.level.into())
}

fn scheme_table(advice: &Advice) -> Table {
    Record::new()
        .field(Column::new("outer"), |answer: &Answer| Cell::exact(answer.scheme.outer()))
        .field(Column::new("status"), |answer| answer.status.name().into())
        .field(Column::new("band_edge").enclosure(), |answer| answer.band_edge.into())
        .field(Column::new("largest"), |answer| answer.largest.as_ref().map(Cell::exact).into())
        .field(Column::new("safe"), |answer| answer.safe.as_ref().map(Cell::exact).into())
        .field(Column::new("bound"), |answer| answer.bound.map(|bound| bound.name()).into())
        .field(Column::new("safe_bias").enclosure(), |answer| answer.safe_bias.map(|(_, bias)| bias).into())
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
type Ratio = fn(&(Rational, Rational)) -> &Rational;

fn row_table(advice: &Advice, all: bool) -> Table {
    let (unit, [time, rate]) = (advice.unit, advice.unit.names());
    let named = advice.schemes.iter().enumerate().flat_map(|(n, answer)| {
        let one = move |row| Named { scheme: n + 1, answer, mode: "", row };
        answer.rows.iter().map(one)
    });
    let named: Vec<Named> =
        named.map(|named| Named { mode: &advice.modes[named.row.mode].name, ..named }).collect();
    let mut record = Record::new()
        .field(Column::new("scheme"), |named: &Named| (named.scheme as u64).into())
        .field(Column::new("outer").in_words("outer step").in_unit(time), move |named| {
            let outer = named.answer.scheme.outer();
            if all { Cell::exact(outer) } else { Cell::Exact(decimal(outer)) }
        })
        .field(Column::new("mode").left(), |named| named.mode.into())
        .field(Column::new("kind").left(), |named| named.row.found.kind.name().into())
        .field(enclosed("trace", "Tr"), |named| named.row.found.trace.into())
        .field(enclosed("bias", "bias R"), |named| named.row.bias.into())
        .field(enclosed("growth_rate", "growth").in_unit(rate), move |named| {
            per(unit, named.row.found.rate).into()
        })
        .field(enclosed("tenfold_steps", "tenfold in steps"), |named| named.row.tenfold_steps.into())
        .field(enclosed("masked_above", "masked above a friction").in_unit(rate), move |named| {
            named.row.masking.as_ref().map(|masking| per(unit, (masking.grows, masking.least()))).into()
        })
        .field(Column::new("masked_below").in_words("masked below").in_unit(rate), move |named| {
            let end = |masked: &Masked| {
                Some((f64::from(unit.in_rates()) * masked.ranges[0].1).next_down())
                    .filter(|end| end.is_finite() && !masked.stays())
            };
            named.row.masking.as_ref().and_then(end).into()
        })
        .field(Column::new("damped"), |named| named.row.is_damped.into());
    let ratios: [(&str, Ratio); 2] = [("ratios_lower", |(lo, _)| lo), ("ratios_upper", |(_, hi)| hi)];
    for (key, end) in ratios.into_iter().filter(|_| all) {
        record = record
            .field(Column::new(key), move |named| named.row.ratios.as_ref().map(end).map(Cell::exact).into());
    }
    let places: [(&str, &str, Which); 4] = [
        ("first", "first unstable", |row| row.first.as_ref()),
        ("inside", "inside", |row| row.inside.as_ref()),
        ("below", "below it", |row| row.below.as_ref()),
        ("above", "above it", |row| row.above.as_ref()),
    ];
    let shown = if all { 4 } else { 1 };
    let ends: [(&str, &str, End); 2] =
        [("lower", "from", |unstable| Some(unstable.lower)), ("upper", "to", |unstable| unstable.upper)];
    for (key, title, which) in places.into_iter().take(shown) {
        for (end, word, find) in ends {
            let column = enclosed(&format!("{key}_{end}"), &format!("{title} {word}")).in_unit(time);
            record = record.field(column, move |named| which(named.row).and_then(find).into());
        }
        let worst = Column::new(&format!("{key}_tenfold_steps")).in_words("worst: tenfold in steps");
        record = record.field(worst, move |named| match which(named.row).and_then(|which| which.worst) {
            Some(worst) if !all => Cell::Exact(nearest((worst.steps, worst.steps), 4)),
            worst => worst.map(|worst| worst.steps).into(),
        });
    }
    let caption = "Each fast mode at each scheme of steps, the stiffest modes on the other clocks";
    let table = record.table("rows", caption, &named);
    if all {
        return table;
    }
    let biased = named.iter().any(|named| named.row.bias.is_some());
    let masked = named.iter().any(|named| named.row.masking.is_some());
    let bounded = named.iter().any(|named| named.row.masking.as_ref().is_some_and(|masked| !masked.stays()));
    for_people(&table, |key| match key {
        "bias" => biased,
        "masked_above" => masked,
        "masked_below" => bounded,
        "damped" => advice.friction.is_some(),
        _ => true,
    })
}

fn interval_table(advice: &Advice) -> Table {
    let answers = advice.schemes.iter().enumerate();
    let rows = answers.flat_map(|(n, answer)| answer.rows.iter().map(move |row| (n as u64 + 1, row)));
    let all: Vec<(u64, usize, &Unstable)> =
        rows.flat_map(|(n, row)| row.intervals.iter().map(move |interval| (n, row.mode, interval))).collect();
    let record = Record::new()
        .field(Column::new("scheme"), |triple: &(u64, usize, &Unstable)| triple.0.into())
        .field(Column::new("mode"), |triple| advice.modes[triple.1].name.as_str().into())
        .field(Column::new("m"), |triple| triple.2.label.into())
        .field(Column::new("lower").enclosure(), |triple| triple.2.lower.into())
        .field(Column::new("upper").enclosure(), |triple| triple.2.upper.into())
        .field(Column::new("tenfold_steps"), |triple| triple.2.worst.map(|worst| worst.steps).into());
    record.table("intervals", "", &all)
}

/// A rate per fs as one per ps, rounded outward.
fn per(unit: TimeUnit, (lo, hi): (f64, f64)) -> (f64, f64) {
    let times = f64::from(unit.in_rates());
    outward((times * lo, times * hi))
}

fn pair_table(advice: &Advice) -> Table {
    let pairs = advice.schemes.iter().enumerate();
    let pairs: Vec<(usize, &Pair)> =
        pairs.flat_map(|(n, answer)| answer.pairs.iter().map(move |pair| (n + 1, pair))).collect();
    let name = |i: usize| Cell::from(advice.modes[i].name.as_str());
    let record = Record::new()
        .field(Column::new("scheme"), |pair: &(usize, &Pair)| (pair.0 as u64).into())
        .field(Column::new("first").left(), move |pair: &(usize, &Pair)| name(pair.1.modes[0]))
        .field(Column::new("second").left(), move |pair: &(usize, &Pair)| name(pair.1.modes[1]))
        .field(
            Column::new("near").in_words("outer step near").in_unit(advice.unit.names()[0]),
            |pair: &(usize, &Pair)| super::decimal::rounded(pair.1.near, 4).into(),
        );
    record.table("pairs", "Where two modes may resonate with each other (first order, not proven)", &pairs)
}
