//! Advice on forces that are no gradient: lines to act on, then tables.

use super::answer;
use super::lines::{self, advised, read_from};
use super::tables::{self, enclosed, for_people, published};
use super::words::{fs, nearest, percent, within};
use crate::report::decimal::is_nothing;
use crate::report::document::{Document, enclosure};
use crate::report::record::Record;
use crate::report::table::{Cell, Column, Table};
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
    let (rows, ladder) = (rows(findings), ladder(findings));
    let best = &findings.schemes[0];
    let step = advised(&best.scheme, &best.safe);
    let document = Document::new("advise-direct")
        .entry("asymmetries", findings.asymmetries.clone())
        .entry("accuracy", findings.accuracy)
        .entry("growth_without_steps", findings.without_steps.map(per_ps).map(enclosure))
        .entry("times", TIMES)
        .entry("fastest_period", findings.fastest)
        .entry("rows", rows.to_json_rows())
        .entry("ladder", ladder.to_json_rows())
        .entry(
            "published",
            published(best.scheme.steps().len(), [FASTEST; 2], |caution: &Caution| {
                (findings.fastest / caution.place.parts()).into()
            }),
        )
        .entry("unknown", UNKNOWN.to_vec())
        .entries(reading.map(|reading| ("engine", tables::engine(step, reading))));
    let has_friction = findings.friction.is_some();
    let lines = summary(findings, reading, notes);
    let shown = |key: &str| match key {
        "damped" | "masked" => has_friction,
        "within_accuracy" => findings.accuracy.is_some(),
        "within_run" => findings.length.is_some(),
        _ => true,
    };
    document
        .long_rows(for_people(&rows, shown))
        .and_rows(for_people(&ladder, shown))
        .summary(&lines)
        .answer(answer::of(&lines))
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
        Some((0.0, hi)) => format!("at most {}/ps", nearest((1000.0 * hi, 1000.0 * hi), 2)),
        Some((lo, hi)) => format!("{}/ps", nearest((1000.0 * lo, 1000.0 * hi), 3)),
    }
}

fn summary(findings: &DirectFindings, reading: Option<&Reading>, notes: &[String]) -> Vec<String> {
    let best = &findings.schemes[0];
    let mut lines = vec![choice(findings, best)];
    lines.extend(findings.schemes.iter().map(|scheme| line(findings, scheme)));
    if let Some(reading) = reading {
        lines.extend(read_from(advised(&best.scheme, &best.safe), reading));
        lines.extend(lines::grompp(reading, FASTEST, |n| {
            nearest((findings.fastest / n as f64, findings.fastest / n as f64), 3)
        }));
    }
    let asymmetries: Vec<String> = findings.asymmetries.iter().map(|x| nearest((*x, *x), 3)).collect();
    lines.push(format!(
        "  forces     are no gradient, |J - J'|/|J + J'| = {}: x'' = -J x itself has {}, whatever the steps",
        asymmetries.join(", "),
        rate(findings.without_steps)
    ));
    lines.extend(looked_at(best));
    let part = |place: Place| {
        let step = findings.fastest / place.parts();
        format!("{} fs", nearest((step, step), 4))
    };
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
    let third = nearest((findings.fastest / 3.0, findings.fastest / 3.0), 3);
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
                nearest(
                    (
                        findings.fastest / Place::Turn(HEEDED).parts(),
                        findings.fastest / Place::Turn(HEEDED).parts()
                    ),
                    3
                ),
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
            format!(
                "; a friction of {}/ps masks it (proven), the one given does not",
                nearest((1000.0 * mask, 1000.0 * mask), 3)
            )
        }
        (_, Some(mask)) => {
            format!("; a friction of {}/ps masks it (proven)", nearest((1000.0 * mask, 1000.0 * mask), 3))
        }
        _ => String::new(),
    };
    let run = within(direct_finding.within_run, &findings.length, TimeUnit::Femtoseconds);
    format!("{:7} {adds}{of_steps}{tenfold}{masks}{run}{band}", fs(direct_finding.scheme.outer()))
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

fn rows(findings: &DirectFindings) -> Table {
    let exact = |x: &Option<Rational>| Cell::from(x.as_ref().map(Cell::exact));
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    Record::new()
        .field(column("outer", "outer step").in_unit("fs"), |direct_finding: &DirectFinding| {
            Cell::exact(direct_finding.scheme.outer())
        })
        .field(column("status", "the steps add").left(), |direct_finding| direct_finding.adds.name().into())
        .field(column("in_band", "in the band").left(), |direct_finding| direct_finding.in_band.name().into())
        .field(rates("growth_rate", "growth"), |direct_finding| direct_finding.rate.map(per_ps).into())
        .field(rates("added_by_steps", "of which by steps"), |direct_finding| {
            direct_finding.added.map(per_ps).into()
        })
        .field(rates("within_accuracy", "within the accuracy"), |direct_finding| {
            direct_finding.within_accuracy.map(per_ps).into()
        })
        .field(enclosed("tenfold_steps", "tenfold in steps"), |direct_finding| {
            direct_finding.tenfold_steps.into()
        })
        .field(column("atoms", "moving most").left(), |direct_finding| direct_finding.atoms.as_deref().into())
        .field(column("masked_above", "masked by a friction").in_unit("1/ps"), |direct_finding| {
            direct_finding.masking.map(|masking| 1000.0 * masking).into()
        })
        .field(Column::new("damped"), |direct_finding| direct_finding.is_damped.into())
        .field(Column::new("largest").in_unit("fs"), move |direct_finding| exact(&direct_finding.largest))
        .field(Column::new("safe").in_unit("fs"), move |direct_finding| exact(&direct_finding.safe))
        .field(column("masked", "masked up to").in_unit("fs"), move |direct_finding| {
            exact(&direct_finding.masked)
        })
        .field(Column::new("within_run"), |direct_finding| direct_finding.within_run.into())
        .table("rows", "Each scheme of steps", &findings.schemes)
}

fn ladder(findings: &DirectFindings) -> Table {
    let schemes = (1u64..).zip(&findings.schemes);
    let all: Vec<(u64, &Rung)> = schemes
        .flat_map(|(n, direct_finding)| direct_finding.ladder.iter().map(move |rung| (n, rung)))
        .collect();
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    Record::new()
        .field(Column::new("scheme"), |pair: &(u64, &Rung)| pair.0.into())
        .field(Column::new("multiple"), |pair| pair.1.multiple.into())
        .field(column("outer", "outer step").in_unit("fs"), |pair| Cell::exact(&pair.1.outer))
        .field(rates("growth_rate", "growth"), |pair| pair.1.rate.map(per_ps).into())
        .field(column("status", "the steps add").left(), |pair| pair.1.adds.name().into())
        .field(column("in_band", "in the band").left(), |pair| pair.1.in_band.name().into())
        .field(Column::new("damped"), |pair| pair.1.is_damped.into())
        .table("ladder", "Every multiple of the step before the outermost one that was looked at", &all)
}
