//! The bias of a stable system's modes, in JSON and in words.

use serde_json::Value;

use crate::report::decimal::few;
use crate::report::record::Record;
use crate::report::shape::{ABOVE_0, Shape};
use crate::report::text::counted;
use systems::{BiasedMode, NoBias};

/// The modes, or why they are not told.
pub type Biases = Result<Vec<BiasedMode>, NoBias>;

/// The modes that a person is shown.
const SHOWN: usize = 3;

/// The sentence on the entry `bias` of a document.
pub(super) const SAYS: &str = "The normal modes of the period, the fastest first, and by how much the potential energy of each is off; null unless the system is elliptic, of other than kicks and drifts of dense symmetric stiffnesses at one place, and where it would cost more than some seconds.";
/// What it is.
pub(super) const SHAPE: Shape = Shape::OrNull(&Shape::List(&Shape::Object(|| record().keys())));

/// The entry `bias` of a document.
pub(super) fn value(bias: Option<&Biases>) -> Value {
    bias.and_then(|bias| bias.as_ref().ok()).map(|modes| record().all(modes)).into()
}

fn record() -> Record<'static, BiasedMode> {
    Record::new()
        .json("turn", |mode: &BiasedMode| mode.turn.into())
        .says(ABOVE_0, "A double, rounded: its turn over the period as a part of a full one, whole turns left out, 1/2 at most.")
        .json("period", |mode| mode.period.into())
        .says(ABOVE_0, "A double, rounded: 2 pi sqrt(x'Mx/x'Kx), x its positions at the start of a period and K the sum of all stiffnesses.")
        .json("at_kicks", |mode| mode.bias.at_kicks.into())
        .says(ABOVE_0, "A double, rounded: its potential over its kinetic energy where all clocks kick, as at constant energy; 1 is right.")
        .json("in_drifts", |mode| mode.bias.in_drifts.into())
        .says(ABOVE_0, "A double, rounded: its potential energy over kT/2 under a weak thermostat in the middle of every drift (BAOAB); 1 is right.")
}

/// The entry in words, the modes that are most off first; `unit` is that of times, after a space.
pub(super) fn lines(bias: &Biases, unit: &str, is_whole: bool) -> Vec<String> {
    let modes = match bias {
        Ok(modes) => modes,
        Err(reason) => return vec![format!("  bias: not told: {}", reason.name())],
    };
    let off = |mode: &&BiasedMode| mode.bias.at_kicks.ln().abs();
    let mut most: Vec<&BiasedMode> = modes.iter().collect();
    most.sort_by(|a, b| off(b).total_cmp(&off(a)));
    let shown = if is_whole { SHOWN } else { 1 };
    let left_out = most.len().saturating_sub(shown);
    most.truncate(shown);
    let list = |shown: &dyn Fn(&BiasedMode) -> String| {
        most.iter().map(|mode| shown(mode)).collect::<Vec<_>>().join(", ")
    };
    let at_kicks = list(&|mode| {
        let (bias, period) = (few(mode.bias.at_kicks, 4), few(mode.period, 4));
        format!("{bias} of the mode with T = {period}{unit}")
    });
    let in_drifts = list(&|mode| few(mode.bias.in_drifts, 4));
    let others = match left_out {
        0 => String::new(),
        n if is_whole => format!("; {} nearer to 1, all in JSON", counted(n, "mode is", "modes are")),
        n => format!("; {} nearer to 1", counted(n, "mode is", "modes are")),
    };
    let right = if is_whole { "" } else { "; 1 is right" };
    let first =
        format!("  bias: potential energy over kT/2 at constant energy (rounded): {at_kicks}{others}{right}");
    let second = format!(
        "        with a weak thermostat in every drift (BAOAB) these modes have {in_drifts}; 1 is right"
    );
    if is_whole { vec![first, second] } else { vec![first] }
}
