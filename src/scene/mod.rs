//! Input documents: systems as a person writes them, as library types; JSON in which no key stands twice.

pub(crate) mod json;
pub(crate) mod kind;
#[cfg(feature = "system")]
mod system;

#[cfg(feature = "system")]
pub(crate) use system::OUTER;
#[cfg(feature = "advise")]
pub use system::of_archive;
#[cfg(feature = "system")]
pub use system::{Array, Arrays, Axis, NEAREST, Scan, Span, SystemFile, SystemScene};
