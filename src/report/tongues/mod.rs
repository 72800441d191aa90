//! Tongues on their way out: every edge as an enclosure, in s and where L1 is known in h1 and h2.
//!
//! | file | what is in it |
//! |---|---|
//! | `told` | a tongue with all that is asked for |
//! | `json` | one row of JSON |
//! | `rows` | the same as cells: all columns, or those that fit paper |
//! | `tally` | what stands out among many |

mod json;
mod rows;
mod tally;
mod told;

pub use json::row as json_row;
pub use rows::Rows;
pub use tally::Tally;
pub use told::{Frame, Quantity, Told, ToldEdge};
