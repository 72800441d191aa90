//! How far a verdict on measured stiffnesses stands, in JSON and in words.

use serde_json::{Value, json};

use crate::report::decimal;
use crate::report::document::enclosure;
use crate::system::{Holds, Measured};

/// The entry `measured` of a document.
pub(super) fn value(own: &Measured) -> Value {
    let removed = own
        .removed
        .as_ref()
        .map(|r| json!({"count": r.count, "found_by": r.found_by, "fast": r.fast, "slow": r.slow}));
    json!({
        "accuracy": own.accuracy,
        "holds": own.holds.name(),
        "margin": own.margin,
        "first_unstable": own.first_unstable.map(enclosure),
        "above_unstable": own.is_above_unstable,
        "rigid_motions": removed,
    })
}

/// The same for people; `unit` is that of times, after a space.
pub(super) fn lines(own: &Measured, is_stable: bool, unit: &str) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(r) = &own.removed {
        lines.push(format!(
            "  {} rigid motions projected out ({}): they held {:.1e} of the fast and {:.1e} of the slow stiffness",
            r.count, r.found_by, r.fast, r.slow
        ));
    }
    let accuracy = own.accuracy;
    lines.push(match own.holds {
        Holds::Stable => format!("  stable for all stiffnesses within {accuracy:.0e} of their norms"),
        Holds::Unstable => format!("  unstable for all stiffnesses within {accuracy:.0e} of their norms"),
        Holds::NotTold => format!(
            "  not decided for all stiffnesses within {accuracy:.0e} of their norms: choose a step farther from the edge of stability, or write \"accuracy\" into the file if they are known better"
        ),
    });
    if let Some(margin) = own.margin {
        let stable = if is_stable { "stable" } else { "unstable" };
        lines.push(format!("  margin: proven {stable} for all within {margin:.1e} of their norms"));
    }
    if let Some((lo, hi)) = own.first_unstable {
        let place = if own.is_above_unstable {
            "; this step lies above it, which is no advice to use it"
        } else {
            ""
        };
        let first = decimal::enclosure(lo, hi);
        lines.push(format!(
            "  first unstable outer step with as many inner ones: {first}{unit}; every smaller one is proven stable{place}"
        ));
    }
    lines
}
