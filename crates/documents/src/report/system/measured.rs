//! How far a verdict on measured stiffnesses stands, in JSON and in words.

use crate::report::decimal;
use crate::report::record::Record;
use crate::report::shape::{ALL_ROUNDED, COUNT, ENCLOSURE, FLAG, ROUNDED, ROUNDED_OR_NULL, Shape, TEXT};
use systems::levels::Method;
use systems::{Holds, Measured, Removed};

/// The record of the entry `measured` of a document.
pub(super) fn record() -> Record<'static, Measured> {
    const MOTIONS: Shape = Shape::OrNull(&Shape::Object(|| motions().keys()));
    Record::new()
        .json("accuracy", |measured: &Measured| measured.accuracy.into())
        .says(ROUNDED, "A double: every stiffness is known to this times its norm (2-norm, mass-weighted), along an orbit times the largest norm of its clock's kicks.")
        .json("holds", |measured| measured.holds.name().into())
        .says(Shape::OneOf(Holds::NAMES), "For every matrix within the accuracy.")
        .json("margin", |measured| measured.margin.into())
        .says(ROUNDED_OR_NULL, "A double: the verdict, stable or unstable, is proven of all stiffnesses within this times their norms; null where it is of none.")
        .json("first_unstable", |measured| measured.first_unstable.into())
        .says(Shape::OrNull(&ENCLOSURE), "Every outer step up to lo is proven stable with all other steps in their ratios to it, hi is proven unstable: doubles, taken exactly.")
        .json("above_unstable", |measured| measured.is_above_unstable.into())
        .says(FLAG, "Whether the step lies above an unstable one.")
        .value("rigid_motions", |measured| measured.removed.as_ref().map(|r| motions().entries(r)).into())
        .says(MOTIONS, "Projected out of every potential, and what of the norms they held.")
        .optional("method", |measured| has_other_method(measured).then(|| measured.method.into()))
        .says(Shape::Words(|| Method::all().skip(1).map(|method| method.name().into()).collect()), "The integrator, where it is another than kicks and drifts: the fast force is taken in one go over the outer step.")
}

/// The record of what was projected out.
pub(in crate::report) fn motions() -> Record<'static, Removed> {
    Record::new()
        .json("count", |removed: &Removed| removed.count.into())
        .says(COUNT, "")
        .json("found_by", |removed| removed.found_by.into())
        .says(TEXT, "")
        .value("held", |removed| removed.held.clone().into())
        .says(
            ALL_ROUNDED,
            "Rounded doubles: the part of its norm that each potential held along them, by increasing step.",
        )
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
