//! kickdrift: exact, certified linear stability of multiple-time-step integrators.

pub mod cli;
pub mod error;
pub mod number;
pub mod propagator;
pub mod report;
pub mod resonance;
pub mod scene;
pub mod tongue;
pub mod verdict;
