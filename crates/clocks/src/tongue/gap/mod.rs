//! Tongues, each between two edges: proven open or closed.
//!
//! | file | what is there |
//! |---|---|
//! | `order` | which edge is the lower one, and how wide the tongue is |
//! | `tunnel` | widths of tongues that are thinner than their edges are known |
//! | `modular` | the proof modulo a prime that no tongue is closed |
//! | `elimination` | the entries as polynomials, their common factors and resultants |

mod elimination;
mod modular;
mod order;
mod tunnel;

pub use elimination::crossings;
pub use elimination::{count_closings, entries};
pub(crate) use modular::Openness;
pub use order::Gap;
