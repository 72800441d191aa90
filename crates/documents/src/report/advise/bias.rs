//! How far off the energy of a stable mode is, for people.

use super::words::{cap, length, nearest};
use molecules::{Advice, Biased, most_biased};

/// The bias of the mode that is most off, at the step that was asked for and at the one that is advised.
pub(super) fn line(advice: &Advice) -> Option<String> {
    let (answer, unit) = (&advice.schemes[0], advice.unit);
    if advice.lacks_fast || advice.beads.is_some() {
        return None;
    }
    let is_alone = answer.scheme.steps().len() == 1;
    let shown = |(mode, bias): Biased, place: String| {
        format!("{} {} at {place}", advice.modes[mode].name, nearest(bias, 3))
    };
    let asked = most_biased(answer.rows.iter().filter_map(|row| Some((row.mode, row.bias?))));
    let asked = asked.map(|biased| shown(biased, length(answer.scheme.outer(), unit)));
    let other = answer.safe.as_ref().filter(|safe| *safe != answer.scheme.outer());
    let advised = answer.safe_bias.zip(other).map(|(biased, safe)| {
        let step = if is_alone { cap(safe, unit) } else { length(safe, unit) };
        shown(biased, format!("the advised {step}"))
    });
    let told: Vec<String> = asked.into_iter().chain(advised).collect();
    let middle = if is_alone {
        "BAOAB and LangevinMiddle have it right"
    } else {
        "a thermostat in the drifts has another bias"
    };
    (!told.is_empty()).then(|| {
        format!(
            "  bias       potential energy over kT/2 at constant energy or by OBABO: {}; {middle}",
            told.join(", ")
        )
    })
}
