//! What Python calls: exact numbers in and out, verdicts of one pair and of many, maps as arrays, and the
//! program.
//!
//! The typed package `kickdrift` is the interface; this module, `kickdrift._native`, is its thin native half.

mod arguments;
mod error;
mod job;
mod map;
mod motion;
mod number;
mod page;
mod pair;
mod pairs;
mod palette;
mod program;

/// The native half of the package `kickdrift`.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::map::{Map, map, multipliers};
    #[pymodule_export]
    use crate::motion::motions;
    #[pymodule_export]
    use crate::number::{Number, number};
    #[pymodule_export]
    use crate::page::{Page, Stop};
    #[pymodule_export]
    use crate::pair::{Pair, decide};
    #[pymodule_export]
    use crate::pairs::{names, verdicts};
    #[pymodule_export]
    use crate::palette::palette;
    #[pymodule_export]
    use crate::program::{Answer, ask, draw, main, recheck};
}
