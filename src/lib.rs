//! kickdrift: exact, certified linear stability of multiple-time-step integrators.

pub mod error;
pub mod number;
pub mod propagator;
pub mod resonance;
pub mod tongue;
pub mod verdict;
