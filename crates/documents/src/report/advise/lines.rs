//! Advice as text: a line for each scheme, then which step to take, then why.

use super::words::{Choice, cap, down, length, named, nearest, not_below, percent, rounded, typical, within};
use super::{answer, silent};
use crate::report::decimal::few;
use crate::report::friction;
use molecules::aperture::{Cold, Edge};
use molecules::engine::{Engine, Reading, nested_beside, not_nested};
use molecules::unit::{TimeUnit, decimal};
use molecules::{
    Advice, Answer, Beads, Bound, GROMPP, Mode, Origin, PRACTICE, Pair, Place, Row, SEEN, Scheme, Status,
    Unstable,
};
use number::{Rational, to_f64};

/// Limits of every linear analysis of given periods; the first is left out where these are the periods of all
/// modes.
const UNKNOWN: [&str; 3] = [
    "whether a faster mode exists than those given: coupled modes are faster than two-body formulas say",
    "how far anharmonic motion, another temperature or other surroundings move the periods beyond the band",
    NONLINEAR,
];
pub(super) const NONLINEAR: &str = "how much the nonlinear resonances that are published heat this system";

/// The limits that apply to these periods.
pub(super) fn unknown(advice: &Advice) -> &'static [&'static str] {
    &UNKNOWN[usize::from(advice.all_modes)..]
}

/// Both ends, each to five digits.
fn interval(unstable: &Unstable, unit: TimeUnit) -> String {
    match unstable.upper {
        Some(upper) => unit.of(format!("{}-{}", nearest(unstable.lower, 5), nearest(upper, 5))),
        None => format!("{} and above", unit.of(nearest(unstable.lower, 5))),
    }
}

/// All lines.
pub(super) fn of(advice: &Advice, reading: Option<&Reading>) -> Vec<String> {
    let mut lines: Vec<String> = advice.schemes.iter().map(|answer| line(advice, answer)).collect();
    lines.extend(advice.schemes.iter().filter_map(|answer| ratios(answer, advice.unit)));
    lines.push(action(advice, &advice.schemes[0]));
    lines.extend(answer::limit_of_periods(advice));
    lines.extend(advice.levers.as_ref().and_then(|levers| super::levers::longer(levers, advice.unit)));
    if let Some(reading) = reading {
        let fastest = &advice.modes[advice.fastest];
        lines.extend(read_from(of_answer(&advice.schemes[0]), reading));
        let of_bonds = || grompp(reading, &named(fastest, advice.unit), |n| nearest(fastest.part(n), 3));
        lines.extend((!advice.lacks_fast).then(of_bonds).flatten());
    }
    lines.extend(reasons(advice));
    lines.extend(advice.levers.iter().flat_map(|lever| super::levers::lines(lever, advice.unit)));
    lines
}

/// The outer step that is advised, where it is another one than that of the scheme: no other one is ever
/// written into an engine's input.
pub(super) fn advised<'a>(scheme: &Scheme, safe: &'a Option<Rational>) -> Option<&'a Rational> {
    safe.as_ref().filter(|outer| *outer != scheme.outer())
}

pub(super) fn of_answer(answer: &Answer) -> Option<&Rational> {
    advised(&answer.scheme, &answer.safe)
}

/// GROMACS's own check of its innermost step, in its own words; of the fastest motion its name and its period
/// over n.
pub(super) fn grompp(reading: &Reading, fastest: &str, part: impl Fn(u64) -> String) -> Option<String> {
    let limits = GROMPP.map(|(n, does)| format!("{does} where dt is longer than T/{n} = {} fs", part(n)));
    let line = format!("  note       {fastest}: grompp {}, {}", limits[0], limits[1]);
    (reading.engine == Engine::Gromacs).then_some(line)
}

/// The engine's own lines with the step that is advised, and what was read.
pub(super) fn read_from(advised: Option<&Rational>, reading: &Reading) -> Vec<String> {
    let name = reading.engine.name();
    let mut lines = Vec::new();
    // Why nothing is written, said once.
    let mut told = None;
    match advised.map(|outer| reading.changed_lines(outer)) {
        Some(Ok(changed)) => lines.extend(changed.iter().map(|line| format!("  write      {line}"))),
        Some(Err(error)) => {
            lines.push(format!("  write      nothing: {}", error.remedy()));
            told = Some(error.remedy().to_string());
        }
        None => {}
    }
    let remarks = reading.remarks.iter().filter(|remark| told.as_ref() != Some(remark));
    let steps: Vec<String> = reading.scheme.steps().iter().map(|step| length(step, reading.unit)).collect();
    let forces = reading.forces.iter().zip(&steps).map(|(forces, step)| format!("{step}: {forces}"));
    lines.push(format!("  {name:10} {}; {}", reading.engine.dt(), forces.collect::<Vec<_>>().join("; ")));
    lines.push(format!("  used       {}", reading.used.join("; ")));
    lines.extend(remarks.map(|remark| format!("  note       {remark}")));
    lines
}

/// "  4 fs  stable; next unstable interval ...".
fn line(advice: &Advice, answer: &Answer) -> String {
    let unit = advice.unit;
    let outer = length(answer.scheme.outer(), unit);
    // No engine runs this scheme, so its resonance does no harm.
    if let Some(beside) = nested_beside(&answer.scheme, unit) {
        let kind = if answer.rows.iter().any(|row| row.found.rate.1 > 0.0) { "unstable" } else { "stable" };
        let beside = beside.strip_prefix(&format!("{outer} is ")).unwrap_or(&beside);
        return format!(
            "{outer:6}  {beside}; asynchronous, as it stands, it is {kind} (`verdict` shows more)"
        );
    }
    // The row that says most: one that grows, else the one whose first unstable interval is the lowest.
    let grows = |row: &&Row| row.found.rate.1;
    let worst = answer.rows.iter().max_by(|a, b| grows(a).total_cmp(&grows(b)));
    let next = next(advice, answer);
    let what = match answer.status {
        Status::Safe => format!("safe{}{next}", silent::condition(advice, answer)),
        Status::Caution => {
            let third = nearest(advice.modes[advice.fastest].part(3), 3);
            let limit = not_below(&advice.caps, &answer.scheme, third, unit);
            format!("stable{}{next}; caution: {limit}", silent::condition(advice, answer))
        }
        Status::Near => format!("stable{next}: less than the band of {}: do not use", percent(&advice.band)),
        Status::Island => island(answer, unit),
        Status::Undecided if advice.lacks_fast => {
            format!(
                "not told: the fastest period is not given, so nothing is called safe{next}, by the periods given alone"
            )
        }
        Status::Undecided => {
            format!("not told: ring polymers have faster modes of their own{next}, by their centroids alone")
        }
        Status::Unstable => unstable(answer, worst, unit),
    };
    format!("{outer:6}  {what}{}", within(answer.within_run, &advice.length, unit))
}

/// "; next unstable interval 4.6768-4.9679 fs, margin 0.677 fs".
fn next(advice: &Advice, answer: &Answer) -> String {
    let (unit, outer) = (advice.unit, to_f64(answer.scheme.outer()));
    let lowest = |first: &&Unstable| first.lower.0;
    let firsts = answer.rows.iter().filter_map(|row| row.first.as_ref());
    let Some(next) = firsts.min_by(|a, b| lowest(a).total_cmp(&lowest(b))) else { return String::new() };
    let lower = || unit.of(nearest(next.lower, 5));
    let what = match next.upper {
        Some(_) => format!("next unstable interval {}", interval(next, unit)),
        None if answer.scheme.steps().len() == 1 => format!("unstable from {} on", lower()),
        None if advice.silent => format!("resonance at {}", lower()),
        None => format!("unstable steps begin at {}", lower()),
    };
    let margin = nearest((next.lower.0 - outer, next.lower.1 - outer), 3);
    format!("; {what}, margin {}", unit.of(margin))
}

fn island(answer: &Answer, unit: TimeUnit) -> String {
    let outer = to_f64(answer.scheme.outer());
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
                format!(" (worst: tenfold in {})", unit.of(rounded(worst.time, 3)))
            });
            let above = unit.of(nearest((outer - upper.1, outer - upper.0), 2));
            format!("stable, but {above} above the unstable {}{worst}: do not use", interval(below, unit))
        }
        (_, _, Some(first)) => format!(
            "stable, but above an unstable step: these begin at {}: do not use",
            unit.of(nearest(first.lower, 5))
        ),
        _ => "stable, but not proven to lie below every unstable step: do not use".into(),
    }
}

fn unstable(answer: &Answer, worst: Option<&Row>, unit: TimeUnit) -> String {
    let Some(row) = worst else { return "unstable".into() };
    let Some((lo, hi)) = row.tenfold_steps else {
        return "unstable: on the edge of an unstable interval, where amplitudes grow linearly".into();
    };
    let (outer, per) = (to_f64(answer.scheme.outer()), f64::from(unit.in_rates()));
    let rate = (per * row.found.rate.0, per * row.found.rate.1);
    let inside =
        row.inside.as_ref().map_or_else(String::new, |inside| format!(", within {}", interval(inside, unit)));
    let friction = match (row.is_damped, &row.masking) {
        (Some(true), _) => " (masked by the friction given, which hides it and does not cure it)".into(),
        (given, Some(mask)) => {
            let own = if given.is_some() { ", the one given does not" } else { "" };
            format!(" ({} it{own})", friction::masking(mask, per, &unit.rate("")))
        }
        (_, None) => String::new(),
    };
    format!(
        "unstable{inside}: tenfold in {} {} = {}, {}{friction}: do not use",
        nearest((lo, hi), 3),
        steps_of(&answer.scheme),
        unit.of(nearest((lo * outer, hi * outer), 3)),
        unit.rate(nearest(rate, 4))
    )
}

/// What the steps are called that a growth is counted in.
pub(super) fn steps_of(scheme: &Scheme) -> &'static str {
    if scheme.steps().len() == 1 { "steps" } else { "outer steps" }
}

/// Another ratio beside an unstable one is no way out. Ends are shown to three decimals, inward.
fn ratios(answer: &Answer, unit: TimeUnit) -> Option<String> {
    let proven = answer.rows.iter().filter_map(|row| row.ratios.as_ref());
    let (lo, hi) = proven.max_by(|a, b| (&a.1 - &a.0).cmp(&(&b.1 - &b.0)))?;
    let thousand = Rational::from_integer(1000.into());
    let (from, to) = ((lo * &thousand).ceil() / &thousand, (hi * &thousand).floor() / &thousand);
    (from < to).then(|| {
        let (inner, outer) = (length(answer.scheme.inner(), unit), length(answer.scheme.outer(), unit));
        let [from, to] = [&from, &to].map(decimal);
        format!("  ratios     {outer}: with an inner step of {inner} every ratio from {from} to {to}, whole or not, is unstable (proven)")
    })
}

/// The advice itself.
fn action(advice: &Advice, answer: &Answer) -> String {
    let (scheme, band, unit) = (&answer.scheme, percent(&advice.band), advice.unit);
    let fastest = &advice.modes[advice.fastest];
    if advice.lacks_fast {
        let place = if scheme.steps().len() > 1 {
            ", or put one that is given on the fastest clock, as --on angle=1"
        } else {
            ""
        };
        return format!(
            "advice: none: give the fastest period that is left, as fast=19.45fs, or a typical one by name, as fast=protein,h-bonds{place}"
        );
    }
    if let Some(beads) = &advice.beads {
        return format!(
            "advice: none: {} beads move by their ring modes too, which no period here describes; see `beads`",
            beads.count
        );
    }
    if let Some(slow) = answer.needs {
        return format!(
            "advice: give the shortest period of {}, which has none yet; {} is proven stable (all periods within {band}) where it is above {}",
            silent::clocks(advice, scheme),
            length(scheme.outer(), unit),
            unit.of(few(slow * 1.005, 3))
        );
    }
    if let Some(beside) = nested_beside(scheme, unit) {
        return format!("advice: {beside}");
    }
    if let (None, Some(why)) = (&answer.largest, not_nested(scheme, unit)) {
        return format!(
            "advice: {why}, so the clocks meet late and thin resonances begin early: choose steps that are multiples of each other"
        );
    }
    let name = named(fastest, unit);
    let choice = Choice {
        scheme,
        safe: &answer.safe,
        bound: answer.bound,
        largest: &answer.largest,
        caps: &advice.caps,
        band: &band,
        fastest: (&name, fastest.period()),
        edge: answer.band_edge.0,
        harmonic: advice.harmonic,
        unit,
    };
    choice.words()
}

/// The published limits of a mode, T/n by `part`, where a scheme has so many steps; the inner one's own cap.
pub(super) fn published(
    name: &str,
    steps: usize,
    inner: Option<String>,
    part: impl Fn(Place) -> String,
) -> String {
    if steps == 1 {
        let at = [3, 4, 5, 6].map(|k| format!("{} = {}", Place::Turn(k).name(), part(Place::Turn(k))));
        return format!(
            "  published  {name}: bonds that are not harmonic meet resonances where the method turns by 1/3, 1/4, 1/5, 1/6 a step, at {} (Schlick, \
             Mandziuk, Skeel, Srinivas 1998)",
            at.join(", ")
        );
    }
    let own = inner.map_or_else(String::new, |own| {
        format!("; the inner step stays below T/6.28 = {own} unless bonds are harmonic, {PRACTICE}")
    });
    format!(
        "  published  {name}: outer steps near T/3 = {} and T/4 = {} meet nonlinear resonances (Ma, Izaguirre, Skeel 2003){own}",
        part(Place::Part(3)),
        part(Place::Part(4))
    )
}

/// Bonds and angles, which those runs are about, have shorter periods, fs.
const LONGEST_BOND_PERIOD: f64 = 30.0;

/// What runs show beside what is published of several clocks.
pub(super) fn seen(steps: usize) -> Option<String> {
    (steps > 1).then(|| format!("  measured   {SEEN}"))
}

pub(super) fn friction(rate: &Rational, unit: TimeUnit) -> String {
    let rate = unit.rate(decimal(&(rate * Rational::from_integer(unit.in_rates().into()))));
    format!(
        "  friction   {rate} in the middle of every drift (BAOAB): it can hide a linear resonance, no advice rests on it"
    )
}

/// Ring modes by name: their periods, and where kicks meet them.
fn ring(beads: &Beads) -> String {
    let count = beads.count;
    let formula = "2 pi/w, w = 2 P k T/hbar sin(k pi/P)";
    match (&beads.kelvin, beads.ends()) {
        (Some(kelvin), Some([fast, slow])) => format!(
            "  beads      {count} at {} K: ring modes 1 to {} have periods of {} down to {} fs ({formula}). They move exactly between kicks, and a step \
             near half of one, {} fs of the fastest, resonates with it; with stiff forces it begins below that",
            decimal(kelvin),
            count / 2,
            few(slow, 4),
            few(fast, 4),
            few(fast / 2.0, 4)
        ),
        _ => format!(
            "  beads      {count} at an unknown temperature: ring modes have periods {formula}; a step near half of one resonates with it"
        ),
    }
}

/// Up to which step of its own a bond of a known shape stays, by a kind of scheme.
fn measured(advice: &Advice, cold: &Cold) -> String {
    let Cold { name, kind, first, level, temperature } = cold;
    let start = format!("  measured   {name} at {} K by {}:", decimal(temperature), kind.names);
    let Some(Edge { share, aperture }) = first else {
        return format!("{start} hot bonds stay up to the limit of small oscillations");
    };
    let mode = advice.modes.iter().find(|mode| mode.name == *name);
    let at = mode.map_or_else(String::new, |mode| {
        let (lo, hi) = mode.period();
        format!(" = {}", advice.unit.of(nearest((lo * share, hi * share), 4)))
    });
    format!(
        "{start} from T/{}{at} on bonds of {aperture} kT are lost, and about one of all is as hot as {} kT (kickdrift aperture)",
        few(share.recip(), 4),
        few(*level, 3)
    )
}

/// What is proven, published, unknown.
fn reasons(advice: &Advice) -> Vec<String> {
    let unit = advice.unit;
    let fastest = &advice.modes[advice.fastest];
    let answer = &advice.schemes[0];
    let ratios: Vec<String> =
        answer.scheme.steps().windows(2).map(|pair| decimal(&(&pair[1] / &pair[0]))).collect();
    let ratio =
        if ratios.is_empty() { String::new() } else { format!(" at the ratio {}", ratios.join(" x ")) };
    let inner = advice.caps.inner().filter(|_| advice.caps.bound(0) != Bound::Aperture);
    let inner = inner.map(|value| cap(value, unit));
    let mut lines = vec![format!(
        "  proven     {}every outer step below {}{ratio} is stable for all periods within {}{}",
        if advice.lacks_fast {
            "of the periods given alone, and of no run that has faster ones: "
        } else {
            ""
        },
        unit.of(down(answer.band_edge.0)),
        percent(&advice.band),
        match () {
            () if advice.lacks_fast => "",
            () if advice.beads.is_some() => ", of the centroid of a ring polymer alone",
            () if advice.silent => ", without the force of the clock that has no period",
            () => ", and for any number of coupled modes that are no stiffer: sums of two modes included",
        }
    )];
    // Of the fastest motion, which has to be known.
    let limits = || {
        let own = published(&named(fastest, unit), answer.scheme.steps().len(), inner, |place| {
            unit.of(nearest(fastest.at(place), 4))
        });
        if unit == TimeUnit::Plain { own.replace(&format!(", {PRACTICE}"), "") } else { own }
    };
    lines.extend((!advice.lacks_fast).then(limits));
    let is_of_bonds = !advice.lacks_fast
        && unit == TimeUnit::Femtoseconds
        && advice.modes.iter().any(|mode| mode.period().0 < LONGEST_BOND_PERIOD);
    lines.extend(seen(answer.scheme.steps().len()).filter(|_| is_of_bonds));
    lines.extend(advice.cold.iter().map(|cold| measured(advice, cold)));
    lines.extend(super::bias::line(advice));
    lines.push(format!("  unknown    {}", unknown(advice)[0]));
    lines.extend(advice.beads.as_ref().map(ring));
    lines.extend(advice.harmonic.then(|| {
        "  assumed    bonds are harmonic, as said: then only the proven limit bounds an inner step; a bond that breaks or softens is none".into()
    }));
    lines.extend(sums(answer, &advice.modes, unit));
    if !advice.held.is_empty() {
        let held: Vec<String> = advice.held.iter().map(|mode| named(mode, unit)).collect();
        lines.push(format!(
            "  assumed    {}: constrained, so on no clock; solved to the end at every inner step; the periods given are those of the constrained \
             molecule, in which coupled angles are faster than alone",
            held.join(", ")
        ));
    }
    lines.extend(advice.friction.as_ref().map(|rate| friction(rate, unit)));
    if let Some(why) = not_nested(&answer.scheme, unit) {
        lines.push(format!("  engines    {why}: OpenMM, LAMMPS, GROMACS and NAMD refuse that; the scheme is decided above all the same"));
    }
    lines.extend(silent::missing(advice));
    lines.extend(advice.modes.iter().filter_map(|mode| match mode.origin {
        Origin::Typical(known) => {
            let word = if known.is_fast { "fast" } else { "slow" };
            let own = if known.is_fast { "; your molecule may have a faster one" } else { "" };
            Some(format!("  {word}       {}{own}", typical(known)))
        }
        _ => None,
    }));
    lines
}

/// Pairs of modes that may meet.
fn sums(answer: &Answer, modes: &[Mode], unit: TimeUnit) -> Option<String> {
    let near = |pair: &Pair| {
        let [a, b] = pair.modes.map(|i| modes[i].name.as_str());
        format!("{a} + {b} near {}", unit.of(rounded(pair.near, 3)))
    };
    let shown: Vec<String> = answer.pairs.iter().take(4).map(near).collect();
    let more = if answer.pairs.len() > 4 { ", ..." } else { "" };
    let shown = shown.join(", ");
    (!shown.is_empty()).then(|| {
        format!("  sums       two coupled modes may resonate with each other, to first order: {shown}{more}")
    })
}
