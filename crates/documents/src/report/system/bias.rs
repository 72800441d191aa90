//! The bias of a stable system's modes, in JSON and in words.

use serde_json::{Value, json};

use crate::report::decimal::few;
use crate::report::text::counted;
use systems::{BiasedMode, NoBias};

/// The modes, or why they are not told.
pub type Biases = Result<Vec<BiasedMode>, NoBias>;

/// The modes that a person is shown.
const SHOWN: usize = 3;

/// The entry `bias` of a document.
pub(super) fn value(bias: Option<&Biases>) -> Value {
    let mode = |mode: &BiasedMode| {
        json!({
            "turn": mode.turn, "period": mode.period,
            "at_kicks": mode.bias.at_kicks, "in_drifts": mode.bias.in_drifts,
        })
    };
    let modes = bias.and_then(|bias| bias.as_ref().ok());
    modes.map(|modes| modes.iter().map(mode).collect::<Vec<_>>()).into()
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
