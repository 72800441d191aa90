//! The unstable outer steps next to that of a verdict, in JSON and in words.

use serde_json::{Value, json};

use crate::report::decimal;
use crate::report::document::enclosure;
use systems::nearest::{Nearest, Unstable};

/// The entry `nearest_unstable` of a document.
pub(super) fn value(nearest: &Nearest) -> Value {
    let interval = |unstable: Unstable| json!({"lo": unstable.proven.0, "hi": unstable.proven.1, "stable_below": unstable.within.0, "stable_above": unstable.within.1});
    json!({
        "step": nearest.number,
        "searched": enclosure(nearest.searched),
        "own": nearest.own.map(interval),
        "below": nearest.below.map(interval),
        "above": nearest.above.map(interval),
        "untold": nearest.untold.iter().copied().map(enclosure).collect::<Vec<_>>(),
    })
}

/// The entry as lines of text; `unit` is that of times, after a space.
pub(super) fn lines(nearest: &Nearest, unit: &str) -> Vec<String> {
    let side = |name: &str, found: Option<Unstable>, end: f64| match found {
        Some(found) => format!("  {name}: {}", interval(found, unit)),
        None => format!("  {name}: none between {} and {}{unit}", nearest.number, decimal::few(end, 6)),
    };
    let mut lines = vec!["  unstable outer steps next to this one, all steps in their ratios; none between the two ends is proven stable:".to_string()];
    if let Some(found) = nearest.own {
        lines.push(format!("  this one lies in {}", interval(found, unit)));
    }
    lines.push(side("below", nearest.below, nearest.searched.0));
    lines.push(side("above", nearest.above, nearest.searched.1));
    for &(lo, hi) in &nearest.untold {
        let between = decimal::enclosure(lo, hi);
        lines.push(format!(
            "  not decided, by the accuracy of the data or for want of a proof: {between}{unit}"
        ));
    }
    lines
}

/// Its two ends, each between the last step proven one thing and the first proven the other.
fn interval(unstable: Unstable, unit: &str) -> String {
    let lower =
        unstable.within.0.map_or(format!("{} or below", decimal::few(unstable.proven.0, 7)), |stable| {
            decimal::enclosure(stable, unstable.proven.0).to_string()
        });
    let upper =
        unstable.within.1.map_or(format!("{} or above", decimal::few(unstable.proven.1, 7)), |stable| {
            decimal::enclosure(unstable.proven.1, stable).to_string()
        });
    format!("{lower} to {upper}{unit}")
}
