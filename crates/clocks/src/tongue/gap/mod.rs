//! Tongues, each between two edges: proven open or closed.
//!
//! | file | what is there |
//! |---|---|
//! | `order` | which edge is the lower one, and how wide the tongue is |
//! | `tunnel` | widths of tongues that are thinner than their edges are known |
//! | `elimination` | the entries as polynomials, their common factors and resultants |

mod elimination;
mod order;
mod tunnel;

pub use elimination::crossings;
pub use elimination::{count_closings, entries};
pub use order::Gap;
