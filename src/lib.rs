//! kickdrift: exact, certified linear stability of multiple-time-step integrators.

pub mod error;
pub mod report;
