//! Tongues on their way out: every edge as an enclosure, in s and where L1 is known in h1 and h2.
//!
//! | file | what is in it |
//! |---|---|
//! | `rows` | what is written of one: every column, or those that fit paper |
//! | `tally` | what stands out among many |

mod rows;
mod tally;

pub use rows::{CAPTION, record};
pub use tally::Tally;
