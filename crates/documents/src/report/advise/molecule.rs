//! Advice on the Hessians of a molecule: lines of text, then tables.

use super::answer;
use super::lines::{self, advised, read_from};
use super::tables::{self, Numbered, Told, enclosed, for_people, numbered};
use super::words::{Choice, cap, down, fs, nearest, not_below, percent, rounded, within};
use crate::report::document::Document;
use crate::report::friction::above;
use crate::report::record::Record;
use crate::report::shape::{
    ENCLOSED_OR_NULL, FLAG_OR_NULL, POSITIVE, RATIONAL, RATIONAL_OR_NULL, ROUNDED, ROUNDED_OR_NULL, Shape,
    TEXT, TEXTS,
};
use crate::report::system::{motions, of_each};
use crate::report::table::{Cell, Column};
use molecules::engine::Reading;
use molecules::unit::{TimeUnit, decimal};
use molecules::{Bound, Caution, Finding, Findings, Group, MostBiased, Scheme, Status};
use number::{Rational, to_f64};
use systems::Holds;
use systems::levels::Growing;

/// The document `kickdrift/advise-system/1`.
pub(super) fn document(findings: &Findings, reading: Option<&Reading>, notes: &[String]) -> Document {
    let rows = row().table("rows", "The molecule at each scheme of steps", &findings.schemes);
    let caption = "Unstable intervals of the outer step: the beginning of the first and that it is stable again proven, the rest sampled";
    let intervals = growing().table("intervals", caption, &all_growing(findings));
    let caption = "Modes of the fast stiffness alone, the fastest first";
    let groups = group().table("groups", caption, &findings.groups);
    let lines = summary(findings, reading, notes);
    let document = head().document(Document::new("advise-system"), &(findings, reading)).long_rows(
        for_people(&rows, |key| match key {
            "holds" => false,
            "masked_above" | "damped" => findings.friction.is_some(),
            _ => true,
        }),
    );
    super::levers::add(document, findings.levers.as_ref(), TimeUnit::Femtoseconds)
        .and_rows(for_people(&intervals, |_| true))
        .and_rows(for_people(&groups, |_| true))
        .summary(&lines)
        .answer(answer::of(&lines))
}

/// The record of the whole.
pub(super) fn head<'a>() -> Record<'a, Told<'a, Findings>> {
    Record::new()
        .optional("between_periods", |(findings, _): &Told<Findings>| {
            (!findings.between.is_empty()).then(|| findings.between.clone().into())
        })
        .says(Shape::List(&ROUNDED_OR_NULL), "Those of the levels between the fast and the slowest one, from the inside out, in fs, null where the level has none; not there where there are none.")
        .value("rigid_motions", |(findings, _)| findings.removed.as_ref().map(|r| motions().entries(r)).into())
        .says(Shape::OrNull(&Shape::Object(|| motions().keys())), "Those projected out of both stiffnesses.")
        .json("accuracy", |(findings, _)| findings.accuracy.into())
        .says(ROUNDED, "Every stiffness is known to this times its norm; a rounded double.")
        .json("slow_period", |(findings, _)| findings.slow.into())
        .says(ROUNDED_OR_NULL, "The shortest period of the slowest stiffness alone, in fs; a rounded double, null where nothing is slow.")
        .value("groups", |(findings, _)| group().all(&findings.groups).into())
        .says(Shape::List(&Shape::Object(|| group().keys())), "Modes of the innermost stiffness alone, the fastest first, those of nearly one period together; fs, rounded doubles.")
        .value("rows", |(findings, _)| row().all(&findings.schemes).into())
        .says(Shape::List(&Shape::Object(|| row().keys())), "One for each scheme of steps; steps in fs.")
        .value("intervals", |(findings, _)| growing().all(&all_growing(findings)).into())
        .says(Shape::List(&Shape::Object(|| growing().keys())), "Unstable intervals of the outer step at each scheme's ratio, steps in fs: up to the first that is not thin (a thousandth of the step); thinner ones between may be missing.")
        .value("published", |(findings, _)| {
            let (fastest, steps) = (&findings.fastest, findings.schemes[0].scheme.steps().len());
            let limit = |caution: &Caution| (fastest.period.0 / caution.place.parts()).into();
            tables::published(steps, [called(fastest); 2], limit)
        })
        .says(tables::PUBLISHED, tables::PUBLISHED_SAYS)
        .value("unknown", |_| UNKNOWN.to_vec().into())
        .says(TEXTS, "What Hessians at one place do not tell.")
        .optional("engine", |(findings, reading)| {
            Some(tables::engine(advised_step(&findings.schemes[0]), (*reading)?))
        })
        .says(tables::ENGINE, tables::ENGINE_SAYS)
        .optional("levers", |(findings, _)| {
            Some(super::levers::value(findings.levers.as_ref()?, TimeUnit::Femtoseconds))
        })
        .says(super::levers::SHAPE, super::levers::SAYS)
        .optional("levers_left_out", |(findings, _)| Some(findings.levers.as_ref()?.left_out.clone().into()))
        .says(TEXTS, super::levers::LEFT_OUT)
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

/// "the unstable 5.0226-5.0228 fs (tenfold in ...)": the first one behind `kind`, and how many more there
/// are.
fn interval(finding: &Finding, kind: &str) -> Option<String> {
    let first = nearest(finding.first?, 5);
    let growing = finding.growing.first()?;
    let end = growing.upper.map(|upper| rounded(upper, 5));
    let reach =
        end.map_or_else(|| format!("unstable from {first} fs on"), |end| format!("{kind} {first}-{end} fs"));
    let (at, rate) = growing.worst;
    let worst = rounded(std::f64::consts::LN_10 / (rate * at), 3);
    let more = match finding.growing.len() {
        1 => String::new(),
        all => format!(", {} more above it", all - 1),
    };
    Some(format!("{reach} (at worst tenfold in {worst} steps){more}"))
}

fn line(findings: &Findings, finding: &Finding) -> String {
    let outer = to_f64(finding.scheme.outer());
    let next = || {
        let margin = finding.first.map_or_else(String::new, |(lo, hi)| {
            format!(", margin {} fs", nearest((lo - outer, hi - outer), 3))
        });
        let next = interval(finding, "next unstable interval");
        next.map_or_else(String::new, |next| format!("; {next}{margin}"))
    };
    let what = match finding.status {
        Status::Safe => format!("safe{}", next()),
        Status::Caution => {
            let third = rounded(findings.fastest.period.0 / 3.0, 3);
            let limit = not_below(&findings.caps, &finding.scheme, third, TimeUnit::Femtoseconds);
            format!("stable{}; caution: {limit}", next())
        }
        Status::Near => {
            format!("stable{}: less than the band of {}: do not use", next(), percent(&findings.band))
        }
        Status::Island => {
            format!("stable, but above {}: do not use", interval(finding, "the unstable").unwrap_or_default())
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
    format!("{:6}  {what}{within}", fs(finding.scheme.outer()))
}

/// ": tenfold in ...".
fn grows(finding: &Finding) -> String {
    let Some((steps, rate)) = finding.tenfold_steps().zip(finding.rate) else { return String::new() };
    let named = finding.name.as_ref().map_or_else(String::new, |name| format!(", {name}"));
    let atoms = finding.atoms.as_ref().map_or_else(String::new, |atoms| format!(", {atoms} moving most"));
    let friction = match (finding.is_damped, finding.masking) {
        (Some(true), _) => "masked by the friction given, which hides it and does not cure it".into(),
        (Some(false), Some(mask)) => {
            format!("a friction of {}/ps masks it (proven), the one given does not", above(1000.0 * mask))
        }
        (None, Some(mask)) => {
            format!(
                "a friction of {}/ps masks it; for the one given this is not proven",
                above(1000.0 * mask)
            )
        }
        _ => format!("a friction of some {}/ps would mask it, to first order", rounded(2000.0 * rate, 2)),
    };
    format!(
        ": tenfold in {} {} = {} ps, {}/ps{named}{atoms} ({friction})",
        rounded(steps, 3),
        lines::steps_of(&finding.scheme),
        rounded(steps * to_f64(finding.scheme.outer()) / 1000.0, 3),
        rounded(1000.0 * rate, 3)
    )
}

/// The record of a group.
fn group() -> Record<'static, Group> {
    Record::new()
        .field(Column::new("count"), |group: &Group| group.count.into())
        .says(POSITIVE, "")
        .field(Column::new("shortest").in_words("shortest period").in_unit("fs"), |group| {
            group.period.0.into()
        })
        .says(ROUNDED, "")
        .field(Column::new("longest").in_unit("fs"), |group| group.period.1.into())
        .says(ROUNDED, "")
        .field(Column::new("half").in_words("T/2"), |group| (group.period.0 / 2.0).into())
        .says(ROUNDED, "Half the shortest period; a rounded double.")
        .field(Column::new("name").in_words("modes").left(), |group| group.name.as_deref().into())
        .says(Shape::OrNull(&TEXT), "What these modes are called, as O-H stretch of HOH; null where it is not known who is bonded to whom, or a mode is mostly neither a stretch, a bend nor the motion of whole molecules.")
        .field(Column::new("atoms").in_words("the fastest moves").left(), |group| group.atoms.as_str().into())
        .says(TEXT, "Who moves in the fastest of them.")
}

/// The intervals of each scheme at its ratio.
fn all_growing(findings: &Findings) -> Vec<Numbered<'_, Growing>> {
    numbered(&findings.schemes, |finding| &finding.growing)
}

/// The record of an interval.
fn growing<'a>() -> Record<'a, Numbered<'a, Growing>> {
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    Record::new()
        .field(Column::new("scheme"), |pair: &Numbered<Growing>| pair.0.into())
        .says(POSITIVE, "")
        .field(column("lower", "grows from").in_unit("fs"), |pair| pair.1.lower.into())
        .says(ROUNDED, "Where it begins: of the first proven unstable, of the next ones sampled; a rounded double.")
        .field(column("upper", "to").in_unit("fs"), |pair| pair.1.upper.into())
        .says(ROUNDED_OR_NULL, "Growth was found at every step sampled from lower up to this one; null where it goes on beyond 1.3 times lower; a rounded double.")
        .field(column("stable_again", "stable again").in_unit("fs"), |pair| pair.1.stable_again.into())
        .says(ROUNDED_OR_NULL, "The first step above that which is proven stable again, as near as doubles tell; null where none was found; a rounded double.")
        .field(column("worst_outer", "worst at").in_unit("fs"), |pair| pair.1.worst.0.into())
        .says(ROUNDED, "Where growth is fastest of those sampled; a rounded double.")
        .field(column("worst_growth_rate", "growth there").in_unit("1/ps"), |pair| {
            (1000.0 * pair.1.worst.1).into()
        })
        .says(ROUNDED, "Growth there, per ps; a rounded double.")
        .field(column("worst_tenfold_steps", "tenfold in steps"), |pair| {
            (std::f64::consts::LN_10 / (pair.1.worst.0 * pair.1.worst.1)).into()
        })
        .says(ROUNDED, "Outer steps until an amplitude is tenfold there; a rounded double.")
}

/// The record of a scheme.
fn row() -> Record<'static, Finding> {
    let exact = |x: &Option<Rational>| Cell::from(x.as_ref().map(Cell::exact));
    let per_ps = |rate: Option<f64>| Cell::from(rate.map(|rate| 1000.0 * rate));
    let column = |key: &str, title: &str| Column::new(key).in_words(title);
    let bias = |most: &Option<MostBiased>| Cell::from(most.as_ref().map(|most| most.bias));
    Record::new()
        .field(column("outer", "outer step").in_unit("fs"), |finding: &Finding| {
            Cell::exact(finding.scheme.outer())
        })
        .says(RATIONAL, "")
        .field(Column::new("status").left(), |finding| finding.status.name().into())
        .says(Shape::OneOf(Status::NAMES), "safe: proven stable for all periods in the band, and below what is published; caution: proven, but not below that; near: in the first stable region, not for all periods in the band; island: stable above an unstable step, never to be recommended; not told: the data are not accurate enough; unstable.")
        .field(Column::new("holds").left(), |finding| finding.holds.name().into())
        .says(Shape::OneOf(Holds::NAMES), "What is proven of all matrices within their accuracy.")
        .field(column("margin", "margin of the stiffness"), |finding| finding.margin.into())
        .says(ROUNDED_OR_NULL, "The largest change of the stiffnesses, relative to their norms, under which the verdict is proven to stand; null where nothing is; a rounded double.")
        .field(enclosed("first", "first unstable from").in_unit("fs"), |finding| finding.first.into())
        .says(ENCLOSED_OR_NULL, "Every outer step up to lo is proven stable at this ratio, hi is proven unstable.")
        .field(column("first_upper", "at least to").in_unit("fs"), |finding| finding.first_upper.into())
        .says(ROUNDED_OR_NULL, "Every outer step from there to this one is proven unstable, and the interval may end later; a rounded double.")
        .field(column("growth_rate", "growth").in_unit("1/ps"), move |finding| per_ps(finding.rate))
        .says(ROUNDED_OR_NULL, "Per ps; a rounded double, 0 where nothing grows; null where that is not decided.")
        .field(column("tenfold_steps", "tenfold in steps"), |finding| finding.tenfold_steps().into())
        .says(ROUNDED_OR_NULL, "Outer steps until an amplitude is tenfold; a rounded double.")
        .field(column("name", "growing").left(), |finding| finding.name.as_deref().into())
        .says(Shape::OrNull(&TEXT), "What grows fastest is called; null as of groups.")
        .field(column("atoms", "moving most").left(), |finding| finding.atoms.as_deref().into())
        .says(Shape::OrNull(&TEXT), "Who moves in what grows fastest.")
        .field(column("masked_above", "masked by a friction").in_unit("1/ps"), move |finding| {
            per_ps(finding.masking)
        })
        .says(ROUNDED_OR_NULL, "A friction per ps that is proven to mask the growth, about the least; null where none was given or nothing grows; a rounded double.")
        .field(Column::new("damped"), |finding| finding.is_damped.into())
        .says(FLAG_OR_NULL, "Whether the friction given keeps all bounded: by the spectral radius in doubles; null where none was given.")
        .field(column("band_edge", "stable below").in_unit("fs"), |finding| finding.band_edge.into())
        .says(ROUNDED_OR_NULL, "Every outer step up to this is proven stable at this ratio for the band: fast periods shorter or longer each for itself, those of each slower level together, as long as the total stiffness is definite (proofs/REGION.md); a rounded double.")
        .field(Column::new("largest").in_unit("fs"), move |finding| exact(&finding.largest))
        .says(RATIONAL_OR_NULL, "The longest multiple of the step before the outermost one for which that holds, and for all shorter ones; of one step alone the end of the band.")
        .field(Column::new("safe").in_unit("fs"), move |finding| exact(&finding.safe))
        .says(RATIONAL_OR_NULL, "The same, and below what is published: T/3 of the fastest mode on any clock but the outermost, T/6.28 of each clock's own forces (h w <= 1), which harmonic bonds lift; null where an inner step is not.")
        .field(Column::new("bound").left(), |finding| finding.bound.map(|bound| bound.name()).into())
        .says(Shape::OrNull(&Shape::OneOf(Bound::NAMES)), "What bounds safe: the band, or what is published.")
        .field(Column::new("within_run"), |finding| finding.within_run.into())
        .says(FLAG_OR_NULL, "Whether an amplitude is tenfold within the run; null where it does not grow or no length was given.")
        .field(column("bias", "bias R"), move |finding| bias(&finding.bias))
        .says(ROUNDED_OR_NULL, "A double, rounded: R, the potential over the kinetic energy at the kicks of the normal mode that is most off, as at constant energy; 1 is right; null unless stable for all matrices, and where it would cost more than some seconds.")
        .field(column("biased", "most off").left(), |finding| {
            finding.bias.as_ref().map(|most| most.mode.as_str()).into()
        })
        .says(Shape::OrNull(&TEXT), "That mode: its name or, where it has none, who moves in it.")
        .field(column("safe_bias", "bias R of safe"), move |finding| bias(&finding.safe_bias))
        .says(ROUNDED_OR_NULL, "A double, rounded: R of the mode that is most off with the step safe; null where there is none.")
}
