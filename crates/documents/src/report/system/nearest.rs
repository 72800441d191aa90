//! The unstable outer steps next to that of a verdict, in JSON and in words.

use serde_json::{Value, json};

use crate::report::decimal;
use crate::report::document::enclosure;
use systems::nearest::{Nearest, Unstable};

/// The entry `nearest_unstable` of a document.
pub(super) fn value(own: &Nearest) -> Value {
    let interval = |own: Unstable| json!({"lo": own.proven.0, "hi": own.proven.1, "stable_below": own.within.0, "stable_above": own.within.1});
    json!({
        "step": own.number,
        "searched": enclosure(own.searched),
        "own": own.own.map(interval),
        "below": own.below.map(interval),
        "above": own.above.map(interval),
        "untold": own.untold.iter().copied().map(enclosure).collect::<Vec<_>>(),
    })
}

/// The entry as lines of text; `unit` is that of times, after a space.
pub(super) fn lines(own: &Nearest, unit: &str) -> Vec<String> {
    let side = |name: &str, found: Option<Unstable>, end: f64| match found {
        Some(found) => format!("  {name}: {}", interval(found, unit)),
        None => format!("  {name}: none between {} and {}{unit}", own.number, decimal::few(end, 6)),
    };
    let mut lines = vec!["  unstable outer steps next to this one, all steps in their ratios; none between the two ends is proven stable:".to_string()];
    if let Some(found) = own.own {
        lines.push(format!("  this one lies in {}", interval(found, unit)));
    }
    lines.push(side("below", own.below, own.searched.0));
    lines.push(side("above", own.above, own.searched.1));
    for &(lo, hi) in &own.untold {
        let between = decimal::enclosure(lo, hi);
        lines.push(format!(
            "  not decided, by the accuracy of the data or for want of a proof: {between}{unit}"
        ));
    }
    lines
}

/// Its two ends, each between the last step proven one thing and the first proven the other.
fn interval(own: Unstable, unit: &str) -> String {
    let lower = own.within.0.map_or(format!("{} or below", decimal::few(own.proven.0, 7)), |stable| {
        decimal::enclosure(stable, own.proven.0).to_string()
    });
    let upper = own.within.1.map_or(format!("{} or above", decimal::few(own.proven.1, 7)), |stable| {
        decimal::enclosure(own.proven.1, stable).to_string()
    });
    format!("{lower} to {upper}{unit}")
}
