//! Advice on the Hessians of a molecule: lines of text, then tables.

use super::answer;
use super::lines::{self, advised, read_from};
use super::tables::{self, enclosed, for_people, published};
use super::words::{Choice, cap, down, fs, nearest, percent, within};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::system::of_each;
use crate::report::table::{Cell, Column, Table};
use molecules::engine::Reading;
use molecules::unit::{TimeUnit, decimal};
use molecules::{Bound, Caution, Finding, Findings, Group, MostBiased, Scheme, Status};
use number::Rational;
use number::rational::to_f64;
use systems::levels::Growing;

/// The document `kickdrift/advise-system/1`.
pub(super) fn document(findings: &Findings, reading: Option<&Reading>, notes: &[String]) -> Document {
    let removed = findings.removed.as_ref();
    let fastest = &findings.fastest;
    let (groups, rows, intervals) = (groups(findings), rows(findings), intervals(findings));
    let (best, between) = (&findings.schemes[0], &findings.between);
    let lines = summary(findings, reading, notes);
    let document = Document::new("advise-system")
        .entries((!between.is_empty()).then(|| ("between_periods", between.clone())))
        .entry("rigid_motions.count", removed.map(|removed| removed.count))
        .entry("rigid_motions.found_by", removed.map(|removed| removed.found_by))
        .entry("rigid_motions.held", removed.map(|removed| removed.held.clone()))
        .entry("accuracy", findings.accuracy)
        .entry("slow_period", findings.slow)
        .entry("groups", groups.to_json_rows())
        .entry("rows", rows.to_json_rows())
        .entry("intervals", intervals.to_json_rows())
        .entry(
            "published",
            published(best.scheme.steps().len(), [called(fastest); 2], |caution: &Caution| {
                (fastest.period.0 / caution.place.parts()).into()
            }),
        )
        .entry("unknown", UNKNOWN.to_vec())
        .entries(reading.map(|reading| ("engine", tables::engine(advised_step(best), reading))))
        .long_rows(for_people(&rows, |key| match key {
            "holds" => false,
            "masked_above" | "damped" => findings.friction.is_some(),
            _ => true,
        }));
    super::levers::add(document, findings.levers.as_ref(), TimeUnit::Femtoseconds)
        .and_rows(for_people(&intervals, |_| true))
        .and_rows(for_people(&groups, |_| true))
        .summary(&lines)
        .answer(answer::of(&lines))
}

/// Limits of Hessians at one place.
const UNKNOWN: [&str; 2] = [
    "how far the Hessians change along a run, beyond the band: they are those of one place",
    lines::NONLINEAR,
];

fn advised_step(finding: &Finding) -> Option<&Rational> {
    advised(&finding.scheme, &finding.safe)
}

fn summary(findings: &Findings, reading: Option<&Reading>, notes: &[String]) -> Vec<String> {
    let (best, fastest) = (&findings.schemes[0], &findings.fastest);
    let period = fastest.period.0;
    let name = named(fastest);
    let band = percent(&findings.band);
    // The safe step, its limit, the levers; then the steps that were asked for.
    let unit = TimeUnit::Femtoseconds;
    let fastest = (name.as_str(), (period, period));
    let (scheme, caps) = (&best.scheme, &findings.caps);
    let (edge, harmonic) = (best.band_edge.unwrap_or(0.0), findings.harmonic);
    let (safe, bound, largest) = (&best.safe, best.bound, &best.largest);
    let choice = Choice { scheme, safe, bound, largest, caps, band: &band, fastest, edge, harmonic, unit };
    let third = rounded(period / 3.0, 3);
    let limit = answer::limit(&name, &format!("{third} fs"), caps, best.first, (scheme, unit));
    let mut lines = vec![choice.words(), limit];
    match &findings.levers {
        Some(levers) => lines.extend(super::levers::longer(levers, unit)),
        None => lines.push("longer: what would let the step grow was not looked at".into()),
    }
    lines.extend(findings.schemes.iter().map(|scheme| line(findings, scheme)));
    if let Some(reading) = reading {
        lines.extend(read_from(advised_step(best), reading));
        lines.extend(lines::grompp(reading, &name, |n| rounded(period / n as f64, 3)));
    }
    let (ratio, slow_ones) = ratios(&best.scheme);
    if let Some(edge) = best.band_edge {
        lines.push(format!(
            "  proven     every outer step below {} fs{ratio} is stable for these Hessians within {:.0e} of their norms, fast periods within \
             {band} each for itself{slow_ones}, as long as the molecule is at a minimum",
            down(edge),
            findings.accuracy
        ));
    }
    let inner = findings.caps.inner().map(|value| cap(value, unit));
    lines.push(lines::published(&name, best.scheme.steps().len(), inner, |place| {
        unit.of(rounded(period / place.parts(), 4))
    }));
    lines.extend(lines::seen(best.scheme.steps().len()));
    lines.extend((2..).zip(&findings.between).map(|(level, value)| between(level, *value)));
    lines.extend((best.scheme.steps().len() > 1).then(|| slow(findings.slow)));
    lines.extend(super::bias::line_of(best));
    lines.push(format!("  unknown    {}", UNKNOWN[0]));
    lines.extend(notes.iter().map(|note| format!("  read       {note}")));
    if let Some(friction) = &findings.friction {
        lines.push(lines::friction(friction, unit));
    }
    if let Some(removed) = &findings.removed {
        let held = of_each(&removed.held);
        lines.push(format!(
            "  rigid      {} motions projected out, by {}{held}",
            removed.count, removed.found_by
        ));
        lines.extend(removed.warning(findings.accuracy).map(|own| format!("  warning    {own}")));
    }
    lines.extend(findings.levers.iter().flat_map(|lever| super::levers::lines(lever, unit)));
    lines
}

/// Name of the motion, else the atoms that move most.
pub(super) fn called(group: &Group) -> &str {
    group.name.as_deref().unwrap_or(&group.atoms)
}

/// "O-H stretch of HOH (32 modes, 8.914-9.069 fs)".
fn named(group: &Group) -> String {
    let [lo, hi] = [group.period.0, group.period.1].map(|period| rounded(period, 4));
    match group.count {
        1 => format!("{} (T = {lo} fs)", called(group)),
        count if lo == hi => format!("{} ({count} modes, T = {lo} fs)", called(group)),
        count => format!("{} ({count} modes, {lo}-{hi} fs)", called(group)),
    }
}

fn rounded(x: f64, digits: usize) -> String {
    nearest((x, x), digits)
}

/// " at the ratio 8", " at the ratios 1:2:8", and which periods beside the fast ones may be off.
fn ratios(scheme: &Scheme) -> (String, &'static str) {
    let all: Vec<String> = scheme.steps().iter().map(|step| decimal(&(step / scheme.inner()))).collect();
    match all.as_slice() {
        [_] => (String::new(), ""),
        [_, ratio] => (format!(" at the ratio {ratio}"), " and slow ones together"),
        _ => (format!(" at the ratios {}", all.join(":")), " and those of each slower level together"),
    }
}

fn between(level: usize, period: f64) -> String {
    let shortest =
        if period.is_infinite() { "no period".into() } else { format!("{} fs", rounded(period, 3)) };
    format!("  level {level}    {shortest}: its shortest period, as if nothing else acted")
}

/// Where the period of the slow force comes from.
fn slow(period: f64) -> String {
    if period.is_infinite() {
        return "  slow       the slow stiffness has no positive eigenvalue, so no period".into();
    }
    format!(
        "  slow       {} fs: 2 pi/sqrt(s), s the largest eigenvalue of the slow stiffness, mass-weighted: as if nothing else acted; periods alone are \
         asked about with slow={0}fs",
        rounded(period, 3)
    )
}

/// "5.0226-5.0228 fs (tenfold in ...)": the first one, and how many more there are.
fn interval(finding: &Finding) -> Option<String> {
    let first = nearest(finding.first?, 5);
    let growing = finding.growing.first()?;
    let end = growing.upper.map_or_else(|| " and on".into(), |upper| format!("-{}", rounded(upper, 5)));
    let (at, rate) = growing.worst;
    let worst = rounded(std::f64::consts::LN_10 / (rate * at), 3);
    let more = match finding.growing.len() {
        1 => String::new(),
        all => format!(", {} more above it", all - 1),
    };
    Some(format!("{first}{end} fs (at worst tenfold in {worst} steps){more}"))
}

fn line(findings: &Findings, finding: &Finding) -> String {
    let outer = to_f64(finding.scheme.outer());
    let next = || {
        let margin = finding.first.map_or_else(String::new, |(lo, hi)| {
            format!(", margin {} fs", nearest((lo - outer, hi - outer), 3))
        });
        interval(finding).map_or_else(String::new, |next| format!("; next unstable interval {next}{margin}"))
    };
    let what = match finding.status {
        Status::Safe => format!("safe{}", next()),
        Status::Caution => format!("stable{}; caution: {}", next(), not_below(findings, finding)),
        Status::Near => {
            format!("stable{}: less than the band of {}: do not use", next(), percent(&findings.band))
        }
        Status::Island => {
            format!("stable, but above the unstable {}: do not use", interval(finding).unwrap_or_default())
        }
        Status::Undecided => {
            format!(
                "not told: nothing is proven of all Hessians within {:.0e} of their norms{}: do not use",
                findings.accuracy,
                if finding.rate == Some(0.0) {
                    ", though those given are stable".into()
                } else {
                    grows(finding)
                }
            )
        }
        Status::Unstable => format!("unstable{}: do not use", grows(finding)),
    };
    let within = within(finding.within_run, &findings.length, TimeUnit::Femtoseconds);
    format!("{:7} {what}{within}", fs(finding.scheme.outer()))
}

/// What a step is not below.
fn not_below(findings: &Findings, finding: &Finding) -> String {
    let unit = TimeUnit::Femtoseconds;
    if let Some((clock, cap)) = findings.caps.too_long(&finding.scheme) {
        return format!(
            "the step of {} is not below T/6.28 = {} of its own forces",
            fs(&finding.scheme.steps()[clock]),
            self::cap(cap, unit)
        );
    }
    let third = || unit.of(rounded(findings.fastest.period.0 / 3.0, 3));
    match findings.caps.outer() {
        Some((_, Bound::Third)) => format!("not below T/3 = {}", third()),
        Some((cap, bound)) => format!("not below {} = {}", bound.name(), self::cap(cap, unit)),
        None => "not below what is published".into(),
    }
}

/// ": tenfold in ...".
fn grows(finding: &Finding) -> String {
    let Some((steps, rate)) = finding.tenfold_steps().zip(finding.rate) else { return String::new() };
    let named = finding.name.as_ref().map_or_else(String::new, |name| format!(", {name}"));
    let atoms = finding.atoms.as_ref().map_or_else(String::new, |atoms| format!(", {atoms} moving most"));
    let friction = match (finding.is_damped, finding.masking) {
        (Some(true), _) => "masked by the friction given, which hides it and does not cure it".into(),
        (Some(false), Some(mask)) => {
            format!(
                "a friction of {}/ps masks it (proven), the one given does not",
                rounded(1000.0 * mask, 3)
            )
        }
        (None, Some(mask)) => {
            format!(
                "a friction of {}/ps masks it; for the one given this is not proven",
                rounded(1000.0 * mask, 3)
            )
        }
        _ => format!("a friction of some {}/ps would mask it, to first order", rounded(2000.0 * rate, 2)),
    };
    format!(
        ": tenfold in {} outer steps = {} ps, {}/ps{named}{atoms} ({friction})",
        rounded(steps, 3),
        rounded(steps * to_f64(finding.scheme.outer()) / 1000.0, 3),
        rounded(1000.0 * rate, 3)
    )
}

fn groups(findings: &Findings) -> Table {
    Record::new()
        .field(Column::new("count"), |group: &Group| (group.count as u64).into())
        .field(Column::new("shortest").in_words("shortest period").in_unit("fs"), |group| {
            group.period.0.into()
        })
        .field(Column::new("longest").in_unit("fs"), |group| group.period.1.into())
        .field(Column::new("half").in_words("T/2"), |group| (group.period.0 / 2.0).into())
        .field(Column::new("name").in_words("modes").left(), |group| group.name.as_deref().into())
        .field(Column::new("atoms").in_words("the fastest moves").left(), |group| group.atoms.as_str().into())
        .table("groups", "Modes of the fast stiffness alone, the fastest first", &findings.groups)
}

/// The intervals of each scheme at its ratio.
fn intervals(findings: &Findings) -> Table {
    let schemes = (1u64..).zip(&findings.schemes);
    let found: Vec<(u64, &Growing)> =
        schemes.flat_map(|(n, finding)| finding.growing.iter().map(move |growing| (n, growing))).collect();
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    let record = Record::new()
        .field(Column::new("scheme"), |pair: &(u64, &Growing)| pair.0.into())
        .field(column("lower", "grows from").in_unit("fs"), |pair| pair.1.lower.into())
        .field(column("upper", "to").in_unit("fs"), |pair| pair.1.upper.into())
        .field(column("stable_again", "stable again").in_unit("fs"), |pair| pair.1.stable_again.into())
        .field(column("worst_outer", "worst at").in_unit("fs"), |pair| pair.1.worst.0.into())
        .field(column("worst_growth_rate", "growth there").in_unit("1/ps"), |pair| {
            (1000.0 * pair.1.worst.1).into()
        })
        .field(column("worst_tenfold_steps", "tenfold in steps"), |pair| {
            (std::f64::consts::LN_10 / (pair.1.worst.0 * pair.1.worst.1)).into()
        });
    record.table("intervals", "Unstable intervals of the outer step: the beginning of the first and that it is stable again proven, the rest sampled", &found)
}

fn rows(findings: &Findings) -> Table {
    let exact = |x: &Option<Rational>| Cell::from(x.as_ref().map(Cell::exact));
    let per_ps = |rate: Option<f64>| Cell::from(rate.map(|rate| 1000.0 * rate));
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    let bias = |most: &Option<MostBiased>| Cell::from(most.as_ref().map(|most| most.bias));
    Record::new()
        .field(column("outer", "outer step").in_unit("fs"), |finding: &Finding| {
            Cell::exact(finding.scheme.outer())
        })
        .field(Column::new("status").left(), |finding| finding.status.name().into())
        .field(Column::new("holds").left(), |finding| finding.holds.name().into())
        .field(column("margin", "margin of the stiffness"), |finding| finding.margin.into())
        .field(enclosed("first", "first unstable from").in_unit("fs"), |finding| finding.first.into())
        .field(column("first_upper", "at least to").in_unit("fs"), |finding| finding.first_upper.into())
        .field(column("growth_rate", "growth").in_unit("1/ps"), move |finding| per_ps(finding.rate))
        .field(column("tenfold_steps", "tenfold in steps"), |finding| finding.tenfold_steps().into())
        .field(column("name", "growing").left(), |finding| finding.name.as_deref().into())
        .field(column("atoms", "moving most").left(), |finding| finding.atoms.as_deref().into())
        .field(column("masked_above", "masked by a friction").in_unit("1/ps"), move |finding| {
            per_ps(finding.masking)
        })
        .field(Column::new("damped"), |finding| finding.is_damped.into())
        .field(column("band_edge", "stable below").in_unit("fs"), |finding| finding.band_edge.into())
        .field(Column::new("largest").in_unit("fs"), move |finding| exact(&finding.largest))
        .field(Column::new("safe").in_unit("fs"), move |finding| exact(&finding.safe))
        .field(Column::new("bound").left(), |finding| finding.bound.map(|bound| bound.name()).into())
        .field(Column::new("within_run"), |finding| finding.within_run.into())
        .field(column("bias", "bias R"), move |finding| bias(&finding.bias))
        .field(column("biased", "most off").left(), |finding| {
            finding.bias.as_ref().map(|most| most.mode.as_str()).into()
        })
        .field(column("safe_bias", "bias R of safe"), move |finding| bias(&finding.safe_bias))
        .table("rows", "The molecule at each scheme of steps", &findings.schemes)
}
