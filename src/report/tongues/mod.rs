//! Tongues on their way out: every edge as an enclosure, in s and where L1 is known in h1 and h2.
//!
//! | file | what is in it |
//! |---|---|
//! | `json` | one row of JSON |
//! | `rows` | the same as cells: all columns, or those that fit paper |
//! | `tally` | what stands out among many |

mod json;
mod rows;
mod tally;

pub use json::row as json_row;
pub use rows::Rows;
pub use tally::Tally;
