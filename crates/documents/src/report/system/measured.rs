//! How far a verdict on measured stiffnesses stands, in JSON and in words.

use serde_json::{Value, json};

use crate::report::decimal;
use crate::report::document::enclosure;
use systems::levels::Method;
use systems::{Holds, Measured};

/// The entry `measured` of a document.
pub(super) fn value(own: &Measured) -> Value {
    let removed =
        own.removed.as_ref().map(|r| json!({"count": r.count, "found_by": r.found_by, "held": r.held}));
    let mut value = json!({
        "accuracy": own.accuracy,
        "holds": own.holds.name(),
        "margin": own.margin,
        "first_unstable": own.first_unstable.map(enclosure),
        "above_unstable": own.is_above_unstable,
        "rigid_motions": removed,
    });
    if has_other_method(own) {
        value["method"] = own.method.into();
    }
    value
}

/// Whether it is another than kicks and drifts: there are no inner steps then.
fn has_other_method(own: &Measured) -> bool {
    own.method != Method::Respa.name()
}

/// ": they held 3.5e-3, 6.4e-2 of the stiffnesses".
pub(in crate::report) fn of_each(held: &[f64]) -> String {
    let parts: Vec<String> = held.iter().map(|part| format!("{part:.1e}")).collect();
    match parts.as_slice() {
        [] => String::new(),
        [part] => format!(": they held {part} of the stiffness"),
        _ => format!(": they held {} of the stiffnesses, by increasing step", parts.join(", ")),
    }
}

/// The entries as lines of text; `unit` is that of times, after a space.
pub(super) fn lines(own: &Measured, (clocks, is_stable): (usize, bool), unit: &str) -> Vec<String> {
    let mut lines = Vec::new();
    if has_other_method(own) {
        lines.push(format!("  by {}: the fast force in one go over the outer step", own.method));
    }
    if let Some(r) = &own.removed {
        lines.push(format!("  {} rigid motions projected out ({}){}", r.count, r.found_by, of_each(&r.held)));
    }
    let accuracy = own.accuracy;
    lines.push(match own.holds {
        Holds::Stable => format!("  stable for all stiffnesses within {accuracy:.0e} of their norms"),
        Holds::Unstable => format!("  unstable for all stiffnesses within {accuracy:.0e} of their norms"),
        Holds::NotTold => {
            let place = match own.is_above_unstable {
                true => "below the first unstable one",
                false => "farther from the edge of stability",
            };
            format!(
                "  not decided for all stiffnesses within {accuracy:.0e} of their norms: choose a step {place}, or write \"accuracy\" into the file if they are known better"
            )
        }
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
        let step = match (clocks, has_other_method(own)) {
            (1, _) => "step",
            (_, true) => "outer step",
            _ => "outer step with as many inner ones",
        };
        lines.push(format!(
            "  first unstable {step}: {first}{unit}; every smaller one is proven stable{place}"
        ));
    }
    lines
}
