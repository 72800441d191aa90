//! Verdicts over a number: maps, and the stable and unstable intervals of a range, none left out.
//!
//! | file | what |
//! |---|---|
//! | `scan` | maps over two parameters |
//! | `between` | all systems between two |
//! | `family` | the systems of one number |
//! | `stretches` | a range covered |
//! | `nearest` | the unstable intervals next to a number |

pub(super) mod between;
pub(super) mod family;
pub mod nearest;
pub mod scan;
pub mod stretches;

pub use between::Intervals;
