//! Advice as text: a line for each scheme, then which step to take, then why.

use super::words::{choice, down, fs, named, nearest, percent, within};
use crate::advise::engine::{Reading, nested_beside, not_nested};
use crate::advise::unit::decimal;
use crate::advise::{Advice, Answer, Origin, Pair, Row, SLOW, Scheme, Slow, Status, Unstable};
use crate::number::Rational;
use crate::number::rational::to_f64;
use crate::report::decimal::few;
use crate::report::friction;

/// Limits of every linear analysis of given periods; the first is left out where these are the periods of all modes.
const UNKNOWN: [&str; 3] = [
    "whether a faster mode exists than those given: coupled modes are faster than two-body formulas say",
    "how far anharmonic motion, another temperature or other surroundings move the periods beyond the band",
    NONLINEAR,
];
pub(super) const NONLINEAR: &str = "how much the nonlinear resonances near T/3 and T/4 heat this system";

/// The limits that apply to these periods.
pub(super) fn unknown(advice: &Advice) -> &'static [&'static str] {
    &UNKNOWN[usize::from(advice.all_modes)..]
}

/// Both ends, each to five digits.
fn interval(of: &Unstable) -> String {
    match of.upper {
        Some(upper) => format!("{}-{} fs", nearest(of.lower, 5), nearest(upper, 5)),
        None => format!("{} fs and above", nearest(of.lower, 5)),
    }
}

/// All lines.
pub(super) fn of(advice: &Advice, reading: Option<&Reading>) -> Vec<String> {
    let mut lines: Vec<String> = advice.schemes.iter().map(|answer| line(advice, answer)).collect();
    lines.extend(advice.schemes.iter().filter_map(ratios));
    lines.push(action(advice, &advice.schemes[0]));
    if let Some(reading) = reading {
        lines.extend(read_from(of_answer(&advice.schemes[0]), reading));
    }
    lines.extend(reasons(advice));
    lines.extend(advice.levers.iter().flat_map(super::levers::lines));
    lines
}

/// The outer step that is advised, where it is another one than that of the scheme.
pub(super) fn advised<'a>(
    scheme: &Scheme,
    safe: &'a Option<Rational>,
    largest: &'a Option<Rational>,
) -> Option<&'a Rational> {
    safe.as_ref().or(largest.as_ref()).filter(|outer| *outer != scheme.outer())
}

pub(super) fn of_answer(answer: &Answer) -> Option<&Rational> {
    advised(&answer.scheme, &answer.safe, &answer.largest).filter(|_| answer.needs.is_none())
}

/// The engine's own lines with the step that is advised, and what was read.
pub(super) fn read_from(advised: Option<&Rational>, reading: &Reading) -> Vec<String> {
    let name = reading.engine.name();
    let mut lines = Vec::new();
    if let Some(changed) = advised.and_then(|outer| reading.changed_lines(outer).ok()) {
        lines.extend(changed.iter().map(|line| format!("  write      {line}")));
    }
    let steps: Vec<String> = reading.scheme.steps().iter().map(fs).collect();
    let forces = reading.forces.iter().zip(&steps).map(|(forces, step)| format!("{step}: {forces}"));
    lines.push(format!("  {name:10} {}; {}", reading.engine.dt(), forces.collect::<Vec<_>>().join("; ")));
    lines.push(format!("  used       {}", reading.used.join("; ")));
    lines.extend(reading.remarks.iter().map(|remark| format!("  note       {remark}")));
    lines
}

/// "  4 fs  stable; next unstable interval ...".
fn line(advice: &Advice, answer: &Answer) -> String {
    let outer = to_f64(answer.scheme.outer());
    let third = advice.modes[advice.fastest].part(3);
    // The row that says most: one that grows, else the one whose first unstable interval is the lowest.
    let grows = |row: &&Row| row.found.rate.1;
    let worst = answer.rows.iter().max_by(|a, b| grows(a).total_cmp(&grows(b)));
    let lowest = |row: &&Row| row.first.as_ref().map_or(f64::INFINITY, |first| first.lower.0);
    let first = answer.rows.iter().min_by(|a, b| lowest(a).total_cmp(&lowest(b)));
    let below = first.and_then(|row| row.first.as_ref());
    let margin = |lower: (f64, f64)| nearest((lower.0 - outer, lower.1 - outer), 3);
    let next = || {
        let named = below.map_or_else(String::new, |next| {
            let lower = || nearest(next.lower, 5);
            let what = match next.upper {
                Some(_) => format!("next unstable interval {}", interval(next)),
                None if answer.scheme.steps().len() == 1 => format!("unstable from {} fs on", lower()),
                None if advice.silent => format!("resonance at {} fs", lower()),
                None => format!("unstable steps begin at {} fs", lower()),
            };
            format!("; {what}, margin {} fs", margin(next.lower))
        });
        let needs = answer.needs.map_or_else(String::new, |slow| {
            format!("; proven for slow forces of periods above {} fs", few(slow * 1.005, 3))
        });
        named + &needs
    };
    let what = match answer.status {
        Status::Safe => format!("safe{}", next()),
        Status::Caution => format!("stable{}; caution: not below T/3 = {} fs", next(), nearest(third, 3)),
        Status::Near => {
            format!("stable{}: less than the band of {}: do not use", next(), percent(&advice.band))
        }
        Status::Island => island(answer, outer),
        Status::Unstable | Status::NotTold => unstable(answer, worst),
    };
    let within = within(answer.within_run, &advice.length);
    // No engine runs this scheme, so its resonance does no harm.
    if let Some(beside) = nested_beside(&answer.scheme) {
        let kind = if answer.rows.iter().any(|row| row.found.rate.1 > 0.0) { "unstable" } else { "stable" };
        return format!(
            "{:7} {beside} (asynchronous, as it stands, it is {kind}; `verdict` shows more)",
            fs(answer.scheme.outer())
        );
    }
    format!("{:7} {what}{within}", fs(answer.scheme.outer()))
}

fn island(answer: &Answer, outer: f64) -> String {
    let below = answer
        .rows
        .iter()
        .filter_map(|row| row.below.as_ref())
        .max_by(|a, b| a.lower.0.total_cmp(&b.lower.0));
    let first = answer
        .rows
        .iter()
        .filter_map(|row| row.first.as_ref())
        .min_by(|a, b| a.lower.0.total_cmp(&b.lower.0));
    match (below, below.and_then(|below| below.upper), first) {
        (Some(below), Some(upper), _) => {
            let worst = below.worst.map_or_else(String::new, |worst| {
                format!(" (worst: tenfold in {} fs)", nearest((worst.time, worst.time), 3))
            });
            let above = nearest((outer - upper.1, outer - upper.0), 2);
            format!("stable, but {above} fs above the unstable {}{worst}: do not use", interval(below))
        }
        (_, _, Some(first)) => format!(
            "stable, but above an unstable step: these begin at {} fs: do not use",
            nearest(first.lower, 5)
        ),
        _ => "stable, but not proven to lie below every unstable step: do not use".into(),
    }
}

fn unstable(answer: &Answer, worst: Option<&Row>) -> String {
    let Some(row) = worst else { return "unstable".into() };
    let Some((lo, hi)) = row.tenfold_steps else {
        return "unstable: on the edge of an unstable interval, where amplitudes grow linearly".into();
    };
    let outer = to_f64(answer.scheme.outer());
    let rate = (1000.0 * row.found.rate.0, 1000.0 * row.found.rate.1);
    let inside =
        row.inside.as_ref().map_or_else(String::new, |inside| format!(", within {}", interval(inside)));
    let friction = match (row.is_damped, &row.masking) {
        (Some(true), _) => " (masked by the friction given, which hides it and does not cure it)".into(),
        (given, Some(mask)) => {
            let own = if given.is_some() { ", the one given does not" } else { "" };
            format!(" ({} it{own})", friction::masking(mask, 1000.0, "/ps"))
        }
        (_, None) => String::new(),
    };
    format!(
        "unstable{inside}: tenfold in {} outer steps = {} fs, {}/ps{friction}: do not use",
        nearest((lo, hi), 3),
        nearest((lo * outer, hi * outer), 3),
        nearest(rate, 4)
    )
}

/// Another ratio beside an unstable one is no way out. Ends are shown to three decimals, inward.
fn ratios(answer: &Answer) -> Option<String> {
    let proven = answer.rows.iter().filter_map(|row| row.ratios.as_ref());
    let (lo, hi) = proven.max_by(|a, b| (&a.1 - &a.0).cmp(&(&b.1 - &b.0)))?;
    let thousand = Rational::from_integer(1000.into());
    let (from, to) = ((lo * &thousand).ceil() / &thousand, (hi * &thousand).floor() / &thousand);
    (from < to).then(|| {
        let (inner, outer) = (fs(answer.scheme.inner()), fs(answer.scheme.outer()));
        let [from, to] = [&from, &to].map(decimal);
        format!("  ratios     {outer}: with an inner step of {inner} every ratio from {from} to {to}, whole or not, is unstable (proven)")
    })
}

/// The advice itself.
fn action(advice: &Advice, answer: &Answer) -> String {
    let (scheme, band) = (&answer.scheme, percent(&advice.band));
    let fastest = &advice.modes[advice.fastest];
    if scheme.steps().len() == 1 {
        let edge = down(answer.band_edge.0);
        return format!(
            "advice: keep the step below {edge} fs (proven for all periods within {band}); T/10 = {} fs resolves {}",
            nearest(fastest.part(10), 3),
            named(fastest)
        );
    }
    if let Some(slow) = answer.needs {
        return format!(
            "advice: give the period of the slow force; {} is proven stable (all periods within {band}) where it is above {} fs",
            fs(scheme.outer()),
            few(slow * 1.005, 3)
        );
    }
    if let Some(beside) = nested_beside(scheme) {
        return format!("advice: {beside}: ask for one of these");
    }
    if let (None, Some(why)) = (&answer.largest, not_nested(scheme)) {
        return format!(
            "advice: {why}, so the clocks meet late and thin resonances begin early: choose steps that are multiples of each other"
        );
    }
    choice(scheme, [&answer.safe, &answer.largest], &band, (&named(fastest), fastest.period()))
}

/// The published limits of a mode, T/n by `part`.
pub(super) fn published(name: &str, part: impl Fn(f64) -> String) -> String {
    format!(
        "  published  {name}: outer steps near T/3 = {} fs and T/4 = {} fs meet nonlinear resonances (Ma, Izaguirre, Skeel 2003); grompp warns \
         above an inner step of T/5 = {} fs, notes above T/10 = {} fs",
        part(3.0),
        part(4.0),
        part(5.0),
        part(10.0)
    )
}

pub(super) fn friction(rate: &Rational) -> String {
    let rate = decimal(&(rate * Rational::from_integer(1000.into())));
    format!(
        "  friction   {rate}/ps in the middle of every drift (BAOAB): it can hide a linear resonance, no advice rests on it"
    )
}

/// A period that is known by name, and where it comes from.
fn slow(own: &Slow) -> String {
    format!("slow={} is {} fs, the shortest period {} ({})", own.name, own.period, own.what, own.source)
}

/// What is proven, published, unknown.
fn reasons(advice: &Advice) -> Vec<String> {
    let fastest = &advice.modes[advice.fastest];
    let answer = &advice.schemes[0];
    let ratios: Vec<String> =
        answer.scheme.steps().windows(2).map(|pair| decimal(&(&pair[1] / &pair[0]))).collect();
    let ratio =
        if ratios.is_empty() { String::new() } else { format!(" at the ratio {}", ratios.join(" x ")) };
    let mut lines = vec![
        format!(
            "  proven     every outer step below {} fs{ratio} is stable for all periods within {}{}",
            down(answer.band_edge.0),
            percent(&advice.band),
            if advice.silent {
                ", without the force of the clock that has no period"
            } else {
                ", and for any number of coupled modes that are no stiffer: sums of two modes included"
            }
        ),
        published(&named(fastest), |n| nearest(fastest.part(n as u64), 4)),
        format!("  unknown    {}", unknown(advice)[0]),
    ];
    if !answer.pairs.is_empty() {
        let near = |pair: &Pair| {
            let [a, b] = pair.modes.map(|i| advice.modes[i].name.as_str());
            format!("{a} + {b} near {} fs", nearest((pair.near, pair.near), 3))
        };
        let shown: Vec<String> = answer.pairs.iter().take(4).map(near).collect();
        let more = if answer.pairs.len() > 4 { ", ..." } else { "" };
        lines.push(format!(
            "  sums       two coupled modes may resonate with each other, to first order: {}{more}",
            shown.join(", ")
        ));
    }
    if !advice.held.is_empty() {
        let held: Vec<String> = advice.held.iter().map(named).collect();
        lines.push(format!(
            "  assumed    {}: constrained, so on no clock; solved to the end at every inner step; the periods given are those of the constrained \
             molecule, in which coupled angles are faster than alone",
            held.join(", ")
        ));
    }
    if let Some(friction) = &advice.friction {
        lines.push(self::friction(friction));
    }
    if let Some(why) = not_nested(&answer.scheme) {
        lines.push(format!("  engines    {why}: OpenMM, LAMMPS, GROMACS and NAMD refuse that; the scheme is decided above all the same"));
    }
    if advice.silent {
        let line = "  unknown    a clock has no period given: its force is taken as 0; with it unstable steps begin somewhat below the step given here";
        lines.push(line.into());
        lines.push(format!("  slow       measured at a minimum: {}", SLOW.each_ref().map(slow).join("; ")));
    }
    lines.extend(advice.modes.iter().filter_map(|own| match own.origin {
        Origin::Slow(known) => Some(format!("  slow       {}", slow(known))),
        _ => None,
    }));
    lines
}
