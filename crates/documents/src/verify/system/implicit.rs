//! Two levels whose fast force is solved for: the kind by exact masses against the kernel of the step in
//! doubles.

use crate::verify::context::{Checked, holds};
use systems::levels::Method;
use systems::{Analysis, Limits, MeasuredSystem, Model, System};

/// Checks that doubles, where they decide the kind at all, find the same one: by definite forms in the fast
/// modes, with the system's own masses.
pub fn in_doubles(plain: &System, analysis: &Analysis) -> Checked {
    // A mass matrix, or numbers beyond doubles: there is no such second route.
    let Ok(doubles) = MeasuredSystem::rounded(plain) else { return Ok(()) };
    let model = doubles.with_method(Method::ImplicitExplicit)?;
    let Ok(other) = model.verdict(0.0, &Limits::default()) else { return Ok(()) };
    let both = other.is_stable().zip(analysis.holds().is_stable());
    holds(both.is_none_or(|(flag, exact)| flag == exact), || format!("in doubles it is {}", other.name()))
}
