//! Advice on periods and bonds: the document, its records, its tables.

use serde_json::Value;

use super::tables::{self, Told, enclosed, for_people};
use super::words::rounded;
use super::{answer, levers, lines};
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{
    ENCLOSED_OR_NULL, EXACT, FLAG_OR_NULL, KIND, POSITIVE, RATIONAL, RATIONAL_OR_NULL, ROUNDED,
    ROUNDED_OR_NULL, Shape, TEXT, TEXTS, WIDE_ENCLOSURE,
};
use crate::report::table::{Cell, Column, Table};
use molecules::aperture::{Cold, Edge};
use molecules::engine::Reading;
use molecules::unit::{self, TimeUnit};
use molecules::{Advice, Answer, Bound, Caution, Mode, Origin, Pair, Row, Status, Unstable};
use number::{Rational, outward};
use systems::friction::Masked;

/// Where a mode comes from.
pub const ORIGIN: Shape = Shape::Words(|| Origin::all().map(|origin| origin.name().into()).collect());

/// The document `kickdrift/advise/1`: JSON and CSV have all columns of the rows, people those that fit paper.
pub(super) fn document(advice: &Advice, reading: Option<&Reading>) -> Document {
    let document = head().document(Document::new("advise"), &(advice, reading));
    let unit = advice.unit;
    let caption = format!(
        "Periods{}, and the steps that they limit",
        if unit == TimeUnit::Plain { "" } else { " in fs" }
    );
    let modes = mode(unit).table("modes", &caption, &advice.modes);
    let changed = advice.modes.iter().any(|mode| mode.before().is_some());
    let modes = for_people(&modes, |key| key != "stiffness" && (key != "before" || changed));
    let document = document.long_rows(row_table(advice, true)).for_people(row_table(advice, false));
    let document = levers::add(document, advice.levers.as_ref(), unit).and_rows(modes);
    let caption = "Where two modes may resonate with each other (first order, not proven)";
    let pairs = pair(unit).table("pairs", caption, &pairs(advice));
    let document = if pairs.rows().is_empty() { document } else { document.and_rows(pairs) };
    let lines = lines::of(advice, reading);
    document.summary(&lines).answer(answer::of(&lines))
}

/// The record of the whole.
pub(super) fn head<'a>() -> Record<'a, Told<'a, Advice>> {
    const MODES: Shape = Shape::List(&Shape::Object(|| mode(TimeUnit::Femtoseconds).keys()));
    const ROWS: Shape = Shape::List(&Shape::Object(|| row(TimeUnit::Femtoseconds, true).keys()));
    const PAIRS: Shape = Shape::List(&Shape::Object(|| pair(TimeUnit::Femtoseconds).keys()));
    Record::new()
        .value("modes", |(advice, _): &Told<Advice>| mode(advice.unit).all(&advice.modes).into())
        .says(MODES, "The periods and the steps that they limit, in fs.")
        .value("schemes", |(advice, _)| scheme().all(&advice.schemes).into())
        .says(Shape::List(&Shape::Object(|| scheme().keys())), "")
        .value("rows", |(advice, _)| row(advice.unit, true).all(&rows(advice)).into())
        .says(ROWS, "Each fast mode at each scheme, with the stiffest modes on the other clocks; steps in fs. An end is null where there is none or balls do not tell it.")
        .value("intervals", |(advice, _)| interval().all(&intervals(advice)).into())
        .says(Shape::List(&Shape::Object(|| interval().keys())), "For each row, the open unstable intervals of the outer step at the ratio of its scheme, from the first one to somewhat beyond the scheme and the first; at most 32.")
        .value("pairs", |(advice, _)| pair(advice.unit).all(&pairs(advice)).into())
        .says(PAIRS, "Where two modes may resonate with each other: the outer step near which w1 + w2 = 2 pi/H, to first order, rounded; not proven.")
        .value("published", |(advice, _)| cautions(advice))
        .says(tables::PUBLISHED, tables::PUBLISHED_SAYS)
        .value("unknown", |(advice, _)| lines::unknown(advice).to_vec().into())
        .says(TEXTS, "What no linear analysis of given periods tells.")
        .optional("measured", |(advice, _)| (!advice.cold.is_empty()).then(|| cold().all(&advice.cold).into()))
        .says(Shape::List(&Shape::Object(|| cold().keys())), "Bonds of a known shape, each by two kinds of schemes: a measurement of the method on one bond in doubles, no proof.")
        .optional("levers", |(advice, _)| Some(levers::value(advice.levers.as_ref()?, advice.unit)))
        .says(levers::SHAPE, levers::SAYS)
        .optional("levers_left_out", |(advice, _)| Some(advice.levers.as_ref()?.left_out.clone().into()))
        .says(TEXTS, levers::LEFT_OUT)
        .optional("engine", |(advice, reading)| Some(tables::engine(lines::of_answer(&advice.schemes[0]), (*reading)?)))
        .says(tables::ENGINE, tables::ENGINE_SAYS)
}

/// What is published about the fastest mode on any clock but the outermost, and about that on the innermost.
fn cautions(advice: &Advice) -> Value {
    if advice.lacks_fast {
        return Vec::<Value>::new().into();
    }
    let fastest = &advice.modes[advice.fastest];
    let on_first = advice.modes.iter().filter(|mode| mode.clock == Some(0));
    let whose = [fastest, on_first.max_by(|a, b| a.stiffness.cmp(&b.stiffness)).unwrap_or(fastest)];
    let limit = |caution: &Caution| whose[usize::from(caution.inner)].at(caution.place).into();
    let steps = advice.schemes[0].scheme.steps().len();
    tables::published(steps, whose.map(|whose| whose.name.as_str()), limit)
}

/// The record of a mode.
fn mode(unit: TimeUnit) -> Record<'static, Mode> {
    let (time, per_square) = (unit.names()[0], if unit == TimeUnit::Plain { "1/time^2" } else { "1/fs^2" });
    let mut record = Record::new()
        .field(Column::new("name").in_words("mode").left(), |mode: &Mode| mode.name.as_str().into())
        .says(TEXT, "")
        .field(Column::new("from").left(), |mode| mode.origin.name().into())
        .says(ORIGIN, "")
        .field(Column::new("clock"), |mode| mode.clock.map(|k| k + 1).into())
        .says(POSITIVE, "1 is the fastest.")
        .field(Column::new("stiffness").in_unit(per_square), |mode| Cell::exact(&mode.stiffness))
        .says(EXACT, "k/m in 1/fs^2.")
        .field(enclosed("period", "T").in_unit(time), |mode| mode.period().into())
        .says(WIDE_ENCLOSURE, "T.")
        .field(enclosed("verlet", "T/pi"), |mode| mode.verlet().into())
        .says(WIDE_ENCLOSURE, "T/pi, the limit of velocity Verlet on this force alone.");
    for (parts, key) in [(2, "half"), (3, "third"), (4, "quarter"), (5, "fifth"), (10, "tenth")] {
        let says = if parts == 2 { "T/2, near which an outer step resonates." } else { "" };
        record = record
            .field(enclosed(key, &format!("T/{parts}")), move |mode| mode.part(parts).into())
            .says(WIDE_ENCLOSURE, says);
    }
    record
        .field(Column::new("before").in_words("T before").in_unit(time), |mode| mode.before().into())
        .says(ROUNDED_OR_NULL, "T with light hydrogens, where heavy ones were asked for; a rounded double.")
}

/// The record of a bond of a known shape, by a kind of scheme.
fn cold() -> Record<'static, Cold> {
    let of = |find: fn(&Edge) -> f64| move |cold: &Cold| cold.first.as_ref().map(find).into();
    Record::new()
        .field(Column::new("mode"), |cold: &Cold| cold.name.as_str().into())
        .says(TEXT, "")
        .field(Column::new("method"), |cold| cold.kind.method.into())
        .says(Shape::OneOf(&["velocity-verlet", "baoab"]), "velocity-verlet also stands for OBABO, baoab for all schemes with a thermostat in the middle of the drift.")
        .field(Column::new("share"), of(|edge| edge.share))
        .says(ROUNDED_OR_NULL, "The first step at which the bond is too hot over its period, rounded down; null where there is none up to the limit of small oscillations; a rounded double.")
        .field(Column::new("aperture"), of(|edge| edge.aperture))
        .says(ROUNDED_OR_NULL, "The least energy in kT at which some phase is lost just above it; a rounded double.")
        .field(Column::new("level"), |cold| cold.level.into())
        .says(ROUNDED, "The logarithm of bonds times picoseconds, in kT; a rounded double.")
}

/// The record of a scheme.
fn scheme() -> Record<'static, Answer> {
    Record::new()
        .field(Column::new("outer"), |answer: &Answer| Cell::exact(answer.scheme.outer()))
        .says(RATIONAL, "The outermost step in fs.")
        .field(Column::new("status"), |answer| answer.status.name().into())
        .says(Shape::OneOf(Status::NAMES), "safe: proven stable for all periods in the band, and below what is published; caution: proven, but not below that; near: below the first unstable interval of the periods given, not of all in the band; island: stable above an unstable step, never to be recommended; not told: nothing is known of the fastest motion; unstable.")
        .field(Column::new("band_edge").enclosure(), |answer| answer.band_edge.into())
        .says(WIDE_ENCLOSURE, "Every outer step below it is proven stable at this ratio for all periods in the band, and for any coupling of such modes (proofs/REGION.md).")
        .field(Column::new("largest"), |answer| answer.largest.as_ref().map(Cell::exact).into())
        .says(RATIONAL_OR_NULL, "The longest multiple of the step before the outermost one that is proven stable for the band; of one clock the band's edge; null where a clock has no period.")
        .field(Column::new("safe"), |answer| answer.safe.as_ref().map(Cell::exact).into())
        .says(RATIONAL_OR_NULL, "The same, and below what is published: T/3 of the fastest mode on any clock but the outermost, T/6.28 of each clock's own forces (h w <= 1), which harmonic bonds lift; null where an inner step is not.")
        .field(Column::new("bound"), |answer| answer.bound.map(|bound| bound.name()).into())
        .says(Shape::OrNull(&Shape::OneOf(Bound::NAMES)), "What bounds safe: the band, what is published, or the aperture of a bond, which is measured.")
        .field(Column::new("safe_bias").enclosure(), |answer| answer.safe_bias.map(|(_, bias)| bias).into())
        .says(ENCLOSED_OR_NULL, "With the outermost step safe: the bias of the mode that is most off, as in rows.")
        .field(Column::new("needs"), |answer| answer.needs.into())
        .says(ROUNDED_OR_NULL, "Where another clock than the innermost has no period: the scheme is proven stable for all longer ones, in fs; a double rounded up.")
        .field(Column::new("within_run"), |answer| answer.within_run.into())
        .says(FLAG_OR_NULL, "Whether an amplitude is tenfold within the run; null where it does not grow or no length was given.")
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

/// Every row of every scheme.
fn rows(advice: &Advice) -> Vec<Named<'_>> {
    let rows = (1..).zip(&advice.schemes).flat_map(|(scheme, answer)| {
        answer.rows.iter().map(move |row| Named { scheme, answer, mode: &advice.modes[row.mode].name, row })
    });
    rows.collect()
}

const TENFOLD: &str = "Outer steps to tenfold where growth is fastest; a rounded double.";

/// The record of a row, with all columns or with those that fit paper.
fn row<'a>(unit: TimeUnit, all: bool) -> Record<'a, Named<'a>> {
    let [time, rate] = unit.names();
    let mut record = Record::new()
        .field(Column::new("scheme"), |named: &Named| named.scheme.into())
        .says(POSITIVE, "")
        .field(Column::new("outer").in_words("outer step").in_unit(time), move |named| {
            let outer = named.answer.scheme.outer();
            if all { Cell::exact(outer) } else { Cell::Exact(unit::decimal(outer)) }
        })
        .says(EXACT, "")
        .field(Column::new("mode").left(), |named| named.mode.into())
        .says(TEXT, "")
        .field(Column::new("kind").left(), |named| named.row.found.kind.name().into())
        .says(KIND, "")
        .field(enclosed("trace", "Tr"), |named| named.row.found.trace.into())
        .says(WIDE_ENCLOSURE, "Tr Q over the synchronization period of the clocks that have a period.")
        .field(enclosed("bias", "bias R"), |named| named.row.bias.into())
        .says(ENCLOSED_OR_NULL, "R, the potential energy of the mode and of the stiffest modes on the other clocks over kT/2, where velocities at the kicks have the temperature (constant energy, OBABO): exactly 1 in the drifts of one clock (BAOAB, LangevinMiddle); null unless elliptic, or where balls do not tell it.")
        .field(enclosed("growth_rate", "growth").in_unit(rate), move |named| {
            per(unit, named.row.found.rate).into()
        })
        .says(WIDE_ENCLOSURE, "Per ps.")
        .field(enclosed("tenfold_steps", "tenfold in steps"), |named| named.row.tenfold_steps.into())
        .says(ENCLOSED_OR_NULL, "Outer steps until an amplitude is tenfold.")
        .field(enclosed("masked_above", "masked above a friction").in_unit(rate), move |named| {
            named.row.masking.as_ref().map(|masking| per(unit, (masking.grows, masking.least()))).into()
        })
        .says(ENCLOSED_OR_NULL, "Per ps: at lo it is proven to grow, at hi the spectral radius is proven below 1 (BAOAB); null where nothing grows, or none was found.")
        .field(Column::new("masked_below").in_words("masked below").in_unit(rate), move |named| {
            let end = |masked: &Masked| {
                Some((f64::from(unit.in_rates()) * masked.ranges[0].1).next_down())
                    .filter(|end| end.is_finite() && !masked.stays())
            };
            named.row.masking.as_ref().and_then(end).into()
        })
        .says(ROUNDED_OR_NULL, "A double, per ps: every friction from masked_above up to this one is proven to mask; null where every larger one is.")
        .field(Column::new("damped"), |named| named.row.is_damped.into())
        .says(FLAG_OR_NULL, "Whether the friction given keeps means and covariances bounded.");
    let ratios: [(&str, Ratio); 2] = [("ratios_lower", |(lo, _)| lo), ("ratios_upper", |(_, hi)| hi)];
    for (key, end) in ratios.into_iter().filter(|_| all) {
        record = record
            .field(Column::new(key), move |named| named.row.ratios.as_ref().map(end).map(Cell::exact).into())
            .says(RATIONAL_OR_NULL, "With the inner step of an unstable scheme of two steps every ratio from ratios_lower to ratios_upper, rational or not, is unstable; null where that is not proven.");
    }
    let places: [(&str, &str, &str, Which); 4] = [
        ("first", "first unstable", "The first unstable outer step at the ratio of the scheme.", |row| {
            row.first.as_ref()
        }),
        ("inside", "inside", "The interval that holds an unstable scheme.", |row| row.inside.as_ref()),
        ("below", "below it", "The nearest unstable interval below a stable scheme.", |row| {
            row.below.as_ref()
        }),
        ("above", "above it", "The nearest one above it.", |row| row.above.as_ref()),
    ];
    let shown = if all { 4 } else { 1 };
    let ends: [(&str, &str, End); 2] =
        [("lower", "from", |unstable| Some(unstable.lower)), ("upper", "to", |unstable| unstable.upper)];
    for (key, title, says, which) in places.into_iter().take(shown) {
        for (end, word, find) in ends {
            let column = enclosed(&format!("{key}_{end}"), &format!("{title} {word}")).in_unit(time);
            record = record
                .field(column, move |named| which(named.row).and_then(find).into())
                .says(ENCLOSED_OR_NULL, says);
        }
        let worst = Column::new(&format!("{key}_tenfold_steps")).in_words("worst: tenfold in steps");
        record = record
            .field(worst, move |named| match which(named.row).and_then(|which| which.worst) {
                Some(worst) if !all => Cell::Exact(rounded(worst.steps, 4)),
                worst => worst.map(|worst| worst.steps).into(),
            })
            .says(ROUNDED_OR_NULL, TENFOLD);
    }
    record
}

fn row_table(advice: &Advice, all: bool) -> Table {
    let named = rows(advice);
    let caption = "Each fast mode at each scheme of steps, the stiffest modes on the other clocks";
    let table = row(advice.unit, all).table("rows", caption, &named);
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

/// An interval, with the number of its scheme and the name of its mode.
type Placed<'a> = (usize, &'a str, &'a Unstable);

fn intervals(advice: &Advice) -> Vec<Placed<'_>> {
    let intervals = rows(advice).into_iter().flat_map(|named| {
        named.row.intervals.iter().map(move |interval| (named.scheme, named.mode, interval))
    });
    intervals.collect()
}

fn interval<'a>() -> Record<'a, Placed<'a>> {
    Record::new()
        .json("scheme", |&(scheme, ..): &Placed| scheme.into())
        .says(POSITIVE, "")
        .json("mode", |&(_, mode, _)| mode.into())
        .says(TEXT, "")
        .json("m", |(.., interval)| interval.label.into())
        .says(POSITIVE, "Half turns of the growing solution in a synchronization period.")
        .json("lower", |(.., interval)| interval.lower.into())
        .says(WIDE_ENCLOSURE, "")
        .json("upper", |(.., interval)| interval.upper.into())
        .says(ENCLOSED_OR_NULL, "")
        .json("tenfold_steps", |(.., interval)| interval.worst.map(|worst| worst.steps).into())
        .says(ROUNDED_OR_NULL, TENFOLD)
}

/// Two modes by their names, with the number of their scheme.
type Two<'a> = (usize, [&'a str; 2], &'a Pair);

fn pairs(advice: &Advice) -> Vec<Two<'_>> {
    let pairs = (1..).zip(&advice.schemes).flat_map(|(n, answer)| {
        answer.pairs.iter().map(move |pair| (n, pair.modes.map(|i| advice.modes[i].name.as_str()), pair))
    });
    pairs.collect()
}

fn pair<'a>(unit: TimeUnit) -> Record<'a, Two<'a>> {
    let near = Column::new("near").in_words("outer step near").in_unit(unit.names()[0]);
    Record::new()
        .field(Column::new("scheme"), |&(scheme, ..): &Two| scheme.into())
        .says(POSITIVE, "")
        .field(Column::new("first").left(), |(_, modes, _)| modes[0].into())
        .says(TEXT, "")
        .field(Column::new("second").left(), |(_, modes, _)| modes[1].into())
        .says(TEXT, "")
        .field(near, |(.., pair)| decimal::rounded(pair.near, 4).into())
        .says(ROUNDED, "A double of four digits.")
}

/// A rate per fs as one per ps, rounded outward.
fn per(unit: TimeUnit, (lo, hi): (f64, f64)) -> (f64, f64) {
    let times = f64::from(unit.in_rates());
    outward((times * lo, times * hi))
}
