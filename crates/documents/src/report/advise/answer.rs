//! The answer in a few lines: which of the summary's lines a person wants first, and what limits the step.

use super::words::{cap, named, nearest};
use molecules::unit::TimeUnit;
use molecules::{Advice, Bound, Caps, Scheme};

/// Lines of reasons that stand in the answer too: to be written, to beware of in an engine and elsewhere,
/// assumed, not known.
const FIRST: [&str; 9] =
    ["write", "note", "warning", "assumed", "forces", "fast", "beads", "bias", "unknown"];

/// Lines at most, with one that says where the rest is.
const MOST: usize = 11;

/// The lines of a summary that answer: all without a label, and those to act on.
pub(super) fn of(summary: &[String]) -> Vec<String> {
    let label =
        |line: &str| line.strip_prefix("  ").and_then(|rest| rest.split(' ').next()).map(String::from);
    let is_first = |line: &&String| label(line).is_none_or(|label| FIRST.contains(&label.as_str()));
    let mut lines: Vec<String> = summary.iter().filter(is_first).cloned().collect();
    // Steps that were asked for beyond what a person reads at once; the first one is advised about.
    let is_of_step = |line: &String| {
        label(line).is_none() && !["advice:", "limit:", "longer:"].iter().any(|word| line.starts_with(word))
    };
    let surplus = lines.len().saturating_sub(MOST);
    let steps: Vec<usize> = (0..lines.len()).filter(|&n| is_of_step(&lines[n])).collect();
    let hidden = if surplus == 0 { 0 } else { (surplus + 1).min(steps.len().saturating_sub(1)) };
    if hidden > 1 {
        let from = steps[steps.len() - hidden];
        lines.drain(from..from + hidden);
        lines.insert(from, format!("and {hidden} schemes more"));
    }
    lines
}

/// What bounds the outer step: the published limit of the fastest motion and the first unstable step.
pub(super) fn limit(
    name: &str,
    third: &str,
    caps: &Caps,
    first: Option<(f64, f64)>,
    (scheme, unit): (&Scheme, TimeUnit),
) -> String {
    let outer = if scheme.steps().len() == 1 { "" } else { "outer " };
    let first = first.map_or_else(String::new, |first| {
        format!("; the first unstable {outer}step is {} (proven)", unit.of(nearest(first, 4)))
    });
    match caps.outer().map(|(value, bound)| (cap(value, unit), bound)) {
        Some((_, Bound::Third)) => {
            format!("limit: {name}: outer steps near T/3 = {third} drift (published){first}")
        }
        Some((own, Bound::Aperture)) => {
            format!("limit: {name}: beyond {own} hot bonds are lost, as measured{first}")
        }
        Some((own, bound)) => format!("limit: {name}: {} = {own}, h w <= 1 (published){first}", bound.name()),
        None => format!("limit: {name}{first}"),
    }
}

/// The same for periods, where the fastest one is known.
pub(super) fn limit_of_periods(advice: &Advice) -> Option<String> {
    let (answer, unit) = (&advice.schemes[0], advice.unit);
    let fastest = &advice.modes[advice.fastest];
    let firsts = answer.rows.iter().filter_map(|row| row.first.as_ref().map(|first| first.lower));
    let first = firsts.min_by(|a, b| a.0.total_cmp(&b.0));
    let third = unit.of(nearest(fastest.part(3), 3));
    let is_told = !advice.lacks_fast && advice.beads.is_none() && answer.needs.is_none();
    is_told.then(|| limit(&named(fastest, unit), &third, &advice.caps, first, (&answer.scheme, unit)))
}
