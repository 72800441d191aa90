//! Input documents: systems as a person writes them, as library types; JSON in which no key stands twice.

pub mod json;
pub mod kind;
mod system;
mod tables;

pub(crate) use system::OUTER;
pub use system::of_archive;
pub use system::{Array, Arrays, Axis, NEAREST, Scan, Span, SystemFile, SystemScene};
pub use tables::{Entry, tables};
