//! Tongues as points, for figures: over ρ, through one resonance, beside the first-order law.

mod diagram;
mod trace;
mod widths;

pub use diagram::{Band, Diagram};
pub use trace::{Near, Trace};
pub use widths::{Measured, widths};

/// The fast clock's own limit s = 4, where pictures end.
pub const LARGEST_S: f64 = 4.0;
