//! The kind of a system in exact arithmetic.

use crate::error::{Error, Result};
use crate::recheck::context::{Checked, same};
use crate::scene::SystemScene;
use crate::system::Limits;
use crate::verdict::Kind;

/// The kind by characteristic polynomials over ℚ or power sums over ℚ\[π\], part by part; of an oscillator with π by the four signs.
///
/// # Errors
/// A budget error with the cost, before any work.
pub fn exact_kind(scene: &SystemScene, limits: &Limits) -> Result<Kind> {
    if let Some(kind) = scene.exact_kind(limits)? {
        return Ok(kind);
    }
    let clocks = scene.many_clocks().expect("one oscillator with pi");
    let kicks = clocks.schedule().strikes();
    // Kick by kick over ℚ[π], whose numbers grow by some words with each kick.
    let cost = kicks.saturating_mul(kicks).saturating_mul(kicks);
    if cost > limits.products {
        return Err(Error::budget(format!("exact signs after {kicks} kicks"), cost));
    }
    Ok(clocks.half_signs().verdict().kind())
}

/// Kinds agree, a part that is at rest apart.
pub fn same_kind(found: Kind, truth: Kind) -> Checked {
    same("kind", found.name(), truth.name())
}
