//! How far off the energy of a stable mode is, for people.

use super::words::{called, cap, length, nearest};
use molecules::unit::TimeUnit;
use molecules::{Advice, Biased, Finding, Scheme, most_biased};
use number::Rational;

/// The bias of the mode that is most off, at the step that was asked for and at the one that is advised.
pub(super) fn line(advice: &Advice) -> Option<String> {
    let answer = &advice.schemes[0];
    if advice.lacks_fast || advice.beads.is_some() {
        return None;
    }
    let named = |(mode, bias): Biased| (called(&advice.modes[mode], advice.unit), bias);
    let asked = most_biased(answer.rows.iter().filter_map(|row| Some((row.mode, row.bias?))));
    told(&answer.scheme, asked.map(named), answer.safe.as_ref().zip(answer.safe_bias.map(named)), advice.unit)
}

/// That of the normal modes of a molecule.
pub(super) fn line_of(finding: &Finding) -> Option<String> {
    let [asked, safe] = [&finding.bias, &finding.safe_bias]
        .map(|most| most.as_ref().map(|most| (most.mode.clone(), (most.bias, most.bias))));
    told(&finding.scheme, asked, finding.safe.as_ref().zip(safe), TimeUnit::Femtoseconds)
}

/// A mode's name and its bias.
type Named = (String, (f64, f64));

fn told(
    scheme: &Scheme,
    asked: Option<Named>,
    safe: Option<(&Rational, Named)>,
    unit: TimeUnit,
) -> Option<String> {
    let is_alone = scheme.steps().len() == 1;
    let safe = safe.filter(|(safe, _)| *safe != scheme.outer());
    // One mode is named once, behind both of its numbers.
    let is_one = asked.as_ref().zip(safe.as_ref()).is_some_and(|(asked, (_, safe))| asked.0 == safe.0);
    let shown = |(mode, bias): Named, place: String, is_named: bool| {
        let name = if is_named { format!(" for {mode}") } else { String::new() };
        format!("{} at {place}{name}", nearest(bias, 3))
    };
    let asked = asked.map(|biased| shown(biased, length(scheme.outer(), unit), !is_one));
    let advised = safe.map(|(safe, biased)| {
        let step = if is_alone { cap(safe, unit) } else { length(safe, unit) };
        shown(biased, format!("the advised {step}"), true)
    });
    let told: Vec<String> = asked.into_iter().chain(advised).collect();
    let middle = if is_alone {
        "BAOAB and LangevinMiddle have it right"
    } else {
        "BAOAB and other thermostats in the drifts have another bias"
    };
    (!told.is_empty()).then(|| {
        format!(
            "  bias       potential energy over kT/2 at constant energy or by OBABO: {}; {middle}",
            told.join(", ")
        )
    })
}
