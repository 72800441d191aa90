//! Tongues on their way out: every edge as an enclosure, in s and where L1 is known in h1 and h2.
//!
//! | file | what is in it |
//! |---|---|
//! | `rows` | what is written of one: every column, or those that fit paper |
//! | `diagram` | those of a few ratios over s and ρ |
//! | `labels` | where its labels stand |
//! | `trace` | the trace of one ratio through its tongues |
//! | `tally` | what stands out among many |

pub mod diagram;
mod labels;
mod rows;
mod tally;
pub mod trace;

pub use rows::{CAPTION, CAPTION_LATEX, keys, needed, record};
pub use tally::TongueTally;
