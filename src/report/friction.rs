//! Friction in JSON and in words.

use serde_json::{Value, json};

use super::decimal;
use super::document::enclosure;
use crate::system::friction::{Damping, Friction, Mask};

/// The entry `friction` of a document.
pub(crate) fn value(own: &Friction) -> Value {
    let masking = match &own.masking {
        Mask::At(mask) => json!({"lo": mask.rate.0, "hi": mask.rate.1, "stays": mask.stays}),
        Mask::NotNeeded => json!("nothing grows"),
        Mask::NotTold => json!("not told"),
    };
    json!({
        "rate": own.rate.to_string(),
        "damping": own.damping.map_or("not told", Damping::name),
        "growth_rate": own.growth.map(enclosure),
        "masking": masking,
    })
}

/// Lines for people.
pub(crate) fn lines(own: &Friction) -> Vec<String> {
    let radius = match own.damping {
        Some(Damping::Damped) => "spectral radius proven below 1: means and covariances stay bounded",
        Some(Damping::Marginal) => "spectral radius 1, exactly",
        Some(Damping::Growing) => "spectral radius proven above 1: it grows in spite of it",
        None => "doubles cannot decide whether the spectral radius is below 1",
    };
    let rate =
        own.growth.map_or(String::new(), |(lo, hi)| format!("; ln rho/T = {}", decimal::enclosure(lo, hi)));
    let mut lines = vec![format!("  with friction {}: {radius}{rate}", own.rate)];
    lines.push(match &own.masking {
        Mask::At(mask) => {
            let at = decimal::enclosure(mask.rate.0, mask.rate.1);
            let stays = if mask.stays == Some(true) { ", and so does any larger one" } else { "" };
            format!("  a friction above {at} masks all growth{stays}")
        }
        Mask::NotNeeded => "  nothing grows without friction".into(),
        Mask::NotTold => "  a friction that masks what may grow was not found".into(),
    });
    lines
}
