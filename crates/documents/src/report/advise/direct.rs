//! Advice on forces that are no gradient: lines to act on, then tables.

use super::answer;
use super::lines::{self, advised, read_from};
use super::tables::{self, Numbered, Told, enclosed, for_people, numbered};
use super::words::{fs, nearest, percent, rounded, within};
use crate::report::decimal::is_nothing;
use crate::report::document::Document;
use crate::report::friction::above;
use crate::report::record::Record;
use crate::report::shape::{
    ALL_ROUNDED, ENCLOSED_OR_NULL, FLAG_OR_NULL, POSITIVE, RATIONAL, RATIONAL_OR_NULL, ROUNDED,
    ROUNDED_OR_NULL, Shape, TEXT, TEXTS,
};
use crate::report::table::{Cell, Column};
use molecules::engine::Reading;
use molecules::unit::TimeUnit;
use molecules::unit::decimal;
use molecules::{Adds, Caution, DirectFinding, DirectFindings, HEEDED, Place, Rung, TIMES};
use number::{Rational, outward};

/// Limits of Jacobians at one place.
const UNKNOWN: [&str; 2] = [
    "outer steps between the multiples that were looked at, and how far the Jacobians change along a run, beyond the band: they are those of one place",
    lines::NONLINEAR,
];

/// The document `kickdrift/advise-direct/1`.
pub(super) fn document(findings: &DirectFindings, reading: Option<&Reading>, notes: &[String]) -> Document {
    let rows = row().table("rows", "Each scheme of steps", &findings.schemes);
    let caption = "Every multiple of the step before the outermost one that was looked at";
    let ladder = rung().table("ladder", caption, &rungs(findings));
    let has_friction = findings.friction.is_some();
    let lines = summary(findings, reading, notes);
    let shown = |key: &str| match key {
        "damped" | "masked" => has_friction,
        "within_accuracy" => findings.accuracy.is_some(),
        "within_run" => findings.length.is_some(),
        _ => true,
    };
    head()
        .document(Document::new("advise-direct"), &(findings, reading))
        .long_rows(for_people(&rows, shown))
        .and_rows(for_people(&ladder, shown))
        .summary(&lines)
        .answer(answer::of(&lines))
}

/// The record of the whole.
pub(super) fn head<'a>() -> Record<'a, Told<'a, DirectFindings>> {
    Record::new()
        .value("asymmetries", |(findings, _): &Told<DirectFindings>| findings.asymmetries.clone().into())
        .says(ALL_ROUNDED, "|J - J'|/|J + J'| of each potential.")
        .json("accuracy", |(findings, _)| findings.accuracy.into())
        .says(ROUNDED_OR_NULL, "Every Jacobian is known to this times its norm, null of exact ones. A double, rounded.")
        .json("growth_without_steps", |(findings, _)| findings.without_steps.map(per_ps).into())
        .says(ENCLOSED_OR_NULL, "Of x'' = -J x itself, per ps; null where it is not bounded.")
        .json("times", |_| TIMES.into())
        .says(ROUNDED, "Growth with the steps may be so many times that without. A double, rounded.")
        .json("fastest_period", |(findings, _)| findings.fastest.into())
        .says(ROUNDED, "Of the fastest motion of the forces of the innermost step alone, in fs. A double, rounded.")
        .value("rows", |(findings, _)| row().all(&findings.schemes).into())
        .says(Shape::List(&Shape::Object(|| row().keys())), "One for each scheme of steps; steps in fs. `largest`: the longest multiple of the step before the outermost one up to which all multiples add little, in the band too; `safe`: below what is published too: T/3 of the fastest motion, and the inner step below T/6.28 of it (h w <= 1), which harmonic bonds lift; `masked`: the longest up to which the friction given is proven to mask all growth.")
        .value("ladder", |(findings, _)| rung().all(&rungs(findings)).into())
        .says(Shape::List(&Shape::Object(|| rung().keys())), "Every multiple of the step before the outermost one that was looked at; between them nothing is told.")
        .value("published", |(findings, _)| {
            let steps = findings.schemes[0].scheme.steps().len();
            let limit = |caution: &Caution| (findings.fastest / caution.place.parts()).into();
            tables::published(steps, [FASTEST; 2], limit)
        })
        .says(tables::PUBLISHED, tables::PUBLISHED_SAYS)
        .value("unknown", |_| UNKNOWN.to_vec().into())
        .says(TEXTS, "What Hessians at one place do not tell.")
        .optional("engine", |(findings, reading)| {
            let best = &findings.schemes[0];
            Some(tables::engine(advised(&best.scheme, &best.safe), (*reading)?))
        })
        .says(tables::ENGINE, tables::ENGINE_SAYS)
}

const FASTEST: &str = "the fastest motion of the innermost forces";

/// Rounded outward.
fn per_ps((lo, hi): (f64, f64)) -> (f64, f64) {
    outward((1000.0 * lo, 1000.0 * hi))
}

/// "0.0200/ps", "no growth".
fn rate(rate: Option<(f64, f64)>) -> String {
    match rate {
        None => "a rate that is not bounded".into(),
        Some((_, 0.0)) => "no growth".into(),
        Some((0.0, hi)) => format!("at most {}/ps", rounded(1000.0 * hi, 2)),
        Some((lo, hi)) => format!("{}/ps", nearest((1000.0 * lo, 1000.0 * hi), 3)),
    }
}

fn summary(findings: &DirectFindings, reading: Option<&Reading>, notes: &[String]) -> Vec<String> {
    let best = &findings.schemes[0];
    let mut lines = vec![choice(findings, best)];
    lines.extend(findings.schemes.iter().map(|scheme| line(findings, scheme)));
    if let Some(reading) = reading {
        lines.extend(read_from(advised(&best.scheme, &best.safe), reading));
        lines.extend(lines::grompp(reading, FASTEST, |n| rounded(findings.fastest / n as f64, 3)));
    }
    let asymmetries: Vec<String> = findings.asymmetries.iter().map(|x| rounded(*x, 3)).collect();
    lines.push(format!(
        "  forces     are no gradient, |J - J'|/|J + J'| = {}: x'' = -J x itself has {}, whatever the steps",
        asymmetries.join(", "),
        rate(findings.without_steps)
    ));
    lines.extend(looked_at(best));
    let part = |place: Place| format!("{} fs", rounded(findings.fastest / place.parts(), 4));
    let inner = (!findings.harmonic).then(|| part(Place::Turn(HEEDED)));
    lines.push(lines::published(FASTEST, best.scheme.steps().len(), inner, part));
    lines.push(format!("  unknown    {}", UNKNOWN[0]));
    lines.extend(notes.iter().map(|note| format!("  read       {note}")));
    if let Some(friction) = &findings.friction {
        lines.push(friction_line(friction, best));
    }
    lines
}

/// Which outer step to take.
fn choice(findings: &DirectFindings, best: &DirectFinding) -> String {
    let step = best.scheme.last_but_one();
    if best.ladder.is_empty() {
        return "advice: none: there is one step alone, so no multiple of another to choose".into();
    }
    let times = |outer: &Rational| format!("{} ({} of {})", fs(outer), decimal(&(outer / step)), fs(step));
    let third = rounded(findings.fastest / 3.0, 3);
    let proven = format!(
        "up to it every multiple of {} is proven to grow at most twice as fast as the forces do by themselves, with all periods {} shorter too",
        fs(step),
        percent(&findings.band)
    );
    match (&best.safe, &best.largest) {
        (Some(safe), Some(largest)) if safe == largest => {
            format!("advice: outer step {}: {proven}", times(safe))
        }
        (Some(safe), Some(largest)) => format!(
            "advice: outer step {}: below T/3 = {third} fs; {} is the longest: {proven}; drift is published beyond T/3",
            times(safe),
            times(largest)
        ),
        (None, Some(largest)) => {
            format!(
                "advice: none: the step of {} is not below T/6.28 = {} fs of {FASTEST} or T/3 = {third} fs: take a shorter one. {} is the longest \
                 multiple of small oscillations: {proven}",
                fs(step),
                rounded(findings.fastest / Place::Turn(HEEDED).parts(), 3),
                times(largest)
            )
        }
        _ => format!(
            "advice: no multiple of {} is proven to grow at most twice as fast as the forces do by themselves, with all periods {} shorter too",
            fs(step),
            percent(&findings.band)
        ),
    }
}

fn line(findings: &DirectFindings, direct_finding: &DirectFinding) -> String {
    let band = match (direct_finding.adds, direct_finding.in_band) {
        (Adds::Little, Adds::Little) => String::new(),
        (Adds::Little, _) => {
            format!("; with all periods {} shorter that is not proven: do not use", percent(&findings.band))
        }
        _ => ": do not use".into(),
    };
    let adds = match direct_finding.adds {
        Adds::Little if direct_finding.rate == Some((0.0, 0.0)) && findings.accuracy.is_some() => {
            "stable (proven of the Jacobians given)".into()
        }
        Adds::Little if direct_finding.rate == Some((0.0, 0.0)) => "stable (proven)".into(),
        Adds::Little => format!(
            "grows as the forces do by themselves or up to twice as fast (proven), {}",
            rate(direct_finding.rate)
        ),
        Adds::Much => format!(
            "grows more than twice as fast as the forces do by themselves (proven), {}",
            rate(direct_finding.rate)
        ),
        Adds::Undecided => {
            format!(
                "not told: {} with the steps, {} without",
                rate(direct_finding.rate),
                rate(findings.without_steps)
            )
        }
    };
    let of_steps = direct_finding.added.filter(|_| direct_finding.rate != Some((0.0, 0.0))).map_or_else(
        String::new,
        |(lo, hi)| {
            if is_nothing((lo, hi), direct_finding.rate) {
                return ", of which the steps add nothing within rounding".into();
            }
            format!(", of which the steps add {}/ps", nearest((1000.0 * lo, 1000.0 * hi), 3))
        },
    );
    let tenfold = direct_finding.tenfold_steps.map_or_else(String::new, |steps| {
        let ps = |steps: f64| steps * number::rational::to_f64(direct_finding.scheme.outer()) / 1000.0;
        let most =
            direct_finding.atoms.as_ref().map_or_else(String::new, |own| format!(", {own} moving most"));
        format!("; tenfold in {} ps{most}", nearest((ps(steps.0), ps(steps.1)), 3))
    });
    let masks = match (direct_finding.is_damped, direct_finding.masking) {
        (Some(true), _) => "; masked by the friction given (proven)".into(),
        (Some(false), Some(mask)) => {
            format!("; a friction of {}/ps masks it (proven), the one given does not", above(1000.0 * mask))
        }
        (_, Some(mask)) => {
            format!("; a friction of {}/ps masks it (proven)", above(1000.0 * mask))
        }
        _ => String::new(),
    };
    let run = within(direct_finding.within_run, &findings.length, TimeUnit::Femtoseconds);
    format!("{:6}  {adds}{of_steps}{tenfold}{masks}{run}{band}", fs(direct_finding.scheme.outer()))
}

/// The modes that the advice rests on.
fn looked_at(best: &DirectFinding) -> Option<String> {
    let (first, last) = (best.ladder.first()?, best.ladder.last()?);
    Some(format!(
        "  looked at  {} points: the multiples from {} to {}, for the Jacobians given; `kickdrift system FILE --scan outer=LO..HI:BY` looks between them",
        best.ladder.len(),
        fs(&first.outer),
        fs(&last.outer)
    ))
}

fn friction_line(friction: &Rational, best: &DirectFinding) -> String {
    let rate = decimal(&(friction * Rational::from_integer(1000.into())));
    let up_to = match &best.masked {
        Some(outer) => format!("is proven to mask all growth at every multiple up to {}", fs(outer)),
        None => "is not proven to mask the growth at any multiple".into(),
    };
    format!(
        "  friction   {rate}/ps in the middle of every drift (BAOAB) {up_to}: it hides growth and does not cure it"
    )
}

fn rates(key: &str, title: &str) -> Column {
    enclosed(key, title).in_unit("1/ps")
}

const STATUS: &str = "What the steps add: little: growth is proven to be at most `times` that without steps (none, where that is none), or tenfold after 1 µs at the earliest; much: it is proven to be more; not told: neither.";
const IN_BAND: &str = "The same with all periods shorter by the band.";
const ADDS: Shape = Shape::OneOf(Adds::NAMES);

/// The record of a scheme.
fn row() -> Record<'static, DirectFinding> {
    let exact = |x: &Option<Rational>| Cell::from(x.as_ref().map(Cell::exact));
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    Record::new()
        .field(column("outer", "outer step").in_unit("fs"), |direct_finding: &DirectFinding| {
            Cell::exact(direct_finding.scheme.outer())
        })
        .says(RATIONAL, "")
        .field(column("status", "the steps add").left(), |direct_finding| direct_finding.adds.name().into())
        .says(ADDS, STATUS)
        .field(column("in_band", "in the band").left(), |direct_finding| direct_finding.in_band.name().into())
        .says(ADDS, IN_BAND)
        .field(rates("growth_rate", "growth"), |direct_finding| direct_finding.rate.map(per_ps).into())
        .says(ENCLOSED_OR_NULL, "With the steps, per ps, for the Jacobians given; null where it is not bounded.")
        .field(rates("added_by_steps", "of which by steps"), |direct_finding| {
            direct_finding.added.map(per_ps).into()
        })
        .says(ENCLOSED_OR_NULL, "That less the growth without steps, per ps; null where one of them is not bounded.")
        .field(rates("within_accuracy", "within the accuracy"), |direct_finding| {
            direct_finding.within_accuracy.map(per_ps).into()
        })
        .says(ENCLOSED_OR_NULL, "Growth with the steps for all Jacobians within their accuracy, per ps; null of exact ones, and where it is not bounded.")
        .field(enclosed("tenfold_steps", "tenfold in steps"), |direct_finding| {
            direct_finding.tenfold_steps.into()
        })
        .says(ENCLOSED_OR_NULL, "Outer steps until an amplitude is tenfold; null where growth is not proven.")
        .field(column("atoms", "moving most").left(), |direct_finding| direct_finding.atoms.as_deref().into())
        .says(Shape::OrNull(&TEXT), "Who moves in what grows fastest.")
        .field(column("masked_above", "masked by a friction").in_unit("1/ps"), |direct_finding| {
            direct_finding.masking.map(|masking| 1000.0 * masking).into()
        })
        .says(ROUNDED_OR_NULL, "A friction per ps, about the least, that is proven to keep all bounded; null where nothing grows or none is proven. A double, rounded.")
        .field(Column::new("damped"), |direct_finding| direct_finding.is_damped.into())
        .says(FLAG_OR_NULL, "Whether the friction given is proven to keep all bounded, or something is proven to grow all the same; null where neither is, or none was given.")
        .field(Column::new("largest").in_unit("fs"), move |direct_finding| exact(&direct_finding.largest))
        .says(RATIONAL_OR_NULL, "")
        .field(Column::new("safe").in_unit("fs"), move |direct_finding| exact(&direct_finding.safe))
        .says(RATIONAL_OR_NULL, "")
        .field(column("masked", "masked up to").in_unit("fs"), move |direct_finding| {
            exact(&direct_finding.masked)
        })
        .says(RATIONAL_OR_NULL, "")
        .field(Column::new("within_run"), |direct_finding| direct_finding.within_run.into())
        .says(FLAG_OR_NULL, "Whether an amplitude is tenfold within the run; null where neither is proven, or no length was given.")
}

/// The rungs of all ladders.
fn rungs(findings: &DirectFindings) -> Vec<Numbered<'_, Rung>> {
    numbered(&findings.schemes, |scheme| &scheme.ladder)
}

/// The record of a rung.
fn rung<'a>() -> Record<'a, Numbered<'a, Rung>> {
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    Record::new()
        .field(Column::new("scheme"), |pair: &Numbered<Rung>| pair.0.into())
        .says(POSITIVE, "")
        .field(Column::new("multiple"), |pair| pair.1.multiple.into())
        .says(POSITIVE, "")
        .field(column("outer", "outer step").in_unit("fs"), |pair| Cell::exact(&pair.1.outer))
        .says(RATIONAL, "")
        .field(rates("growth_rate", "growth"), |pair| pair.1.rate.map(per_ps).into())
        .says(ENCLOSED_OR_NULL, "With the steps, per ps; null where it is not bounded.")
        .field(column("status", "the steps add").left(), |pair| pair.1.adds.name().into())
        .says(ADDS, STATUS)
        .field(column("in_band", "in the band").left(), |pair| pair.1.in_band.name().into())
        .says(ADDS, IN_BAND)
        .field(Column::new("damped"), |pair| pair.1.is_damped.into())
        .says(FLAG_OR_NULL, "As of rows.")
}
