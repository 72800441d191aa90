//! Every tongue of a ratio.
mod mode;
mod spectrum;
mod string;
mod sturm;
mod twofold;

pub use spectrum::{Edge, edges};
pub use string::Entry;
