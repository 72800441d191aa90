//! kickdrift: exact, certified linear stability of multiple-time-step integrators.

pub mod error;
pub mod map;
pub mod number;
pub mod propagator;
pub mod verdict;
