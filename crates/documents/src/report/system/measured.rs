//! How far a verdict on measured stiffnesses stands, in JSON and in words.

use serde_json::{Value, json};

use crate::report::decimal;
use crate::report::document::enclosure;
use systems::levels::Method;
use systems::{Holds, Measured};

/// The entry `measured` of a document.
pub(super) fn value(measured: &Measured) -> Value {
    let removed =
        measured.removed.as_ref().map(|r| json!({"count": r.count, "found_by": r.found_by, "held": r.held}));
    let mut value = json!({
        "accuracy": measured.accuracy,
        "holds": measured.holds.name(),
        "margin": measured.margin,
        "first_unstable": measured.first_unstable.map(enclosure),
        "above_unstable": measured.is_above_unstable,
        "rigid_motions": removed,
    });
    if has_other_method(measured) {
        value["method"] = measured.method.into();
    }
    value
}

/// Whether it is another than kicks and drifts: there are no inner steps then.
fn has_other_method(measured: &Measured) -> bool {
    measured.method != Method::Respa.name()
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
pub(super) fn lines(
    measured: &Measured,
    (clocks, is_stable): (usize, bool),
    unit: &str,
    is_whole: bool,
) -> Vec<String> {
    let mut lines = Vec::new();
    if has_other_method(measured) {
        lines.push(format!("  by {}: the fast force in one go over the outer step", measured.method));
    }
    if let Some(r) = measured.removed.as_ref().filter(|_| is_whole) {
        lines.push(format!("  {} rigid motions projected out ({}){}", r.count, r.found_by, of_each(&r.held)));
    }
    let accuracy = measured.accuracy;
    lines.push(match measured.holds {
        Holds::Stable => format!("  stable for all stiffnesses within {accuracy:.0e} of their norms"),
        Holds::Unstable => format!("  unstable for all stiffnesses within {accuracy:.0e} of their norms"),
        Holds::Undecided => {
            let place = match measured.is_above_unstable {
                true => "below the first unstable one",
                false => "farther from the edge of stability",
            };
            format!(
                "  not decided for all stiffnesses within {accuracy:.0e} of their norms: choose a step {place}, or write \"accuracy\" into the file if they are known better"
            )
        }
    });
    if let Some(margin) = measured.margin {
        let stable = if is_stable { "stable" } else { "unstable" };
        lines.push(format!("  margin: proven {stable} for all within {margin:.1e} of their norms"));
    }
    if let Some((lo, hi)) = measured.first_unstable {
        let place = if measured.is_above_unstable {
            "; this step lies above it, which is no advice to use it"
        } else {
            ""
        };
        let first = decimal::enclosure(lo, hi);
        let step = match (clocks, has_other_method(measured)) {
            (1, _) => "step",
            (_, true) => "outer step",
            (3.., _) => "outer step, all others in their ratios to it",
            _ => "outer step with as many inner ones",
        };
        lines.push(format!(
            "  first unstable {step}: {first}{unit}; every smaller one is proven stable{place}"
        ));
    }
    lines
}
