//! Verdicts over a number: maps, and the stable and unstable intervals of a range, none left out.
//!
//! | file | what |
//! |---|---|
//! | `scan` | maps over two parameters |
//! | `between` | all systems between two |
//! | `critical`, `edges` | where the verdict can change, exactly; what lies between |
//! | `stretches` | a range covered |
//! | `nearest` | the unstable intervals next to a number |

pub(super) mod between;
pub(super) mod critical;
pub mod edges;
pub mod nearest;
pub mod scan;
pub mod stretches;

pub use between::Intervals;
