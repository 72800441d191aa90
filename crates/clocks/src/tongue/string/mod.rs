//! The half period as a vibrating string, and the arithmetic that its orbits are followed in.
//!
//! | file | what is there |
//! |---|---|
//! | `entry` | A, B, C and D as four eigenvalue problems |
//! | `half_string` | the masses and springs of a half period |
//! | `lanes` | doubles side by side, powers of two |

mod entry;
mod half_string;
pub mod lanes;
mod twofold;

pub use entry::Entry;
pub(crate) use entry::Indices;
pub(crate) use half_string::{HalfString, KINDS, MOST_KICKS, Node, Step};
pub use number::Twofold;
pub use twofold::Digits;
