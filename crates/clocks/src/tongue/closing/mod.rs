//! Where tongues close.
//!
//! | file | what is there |
//! |---|---|
//! | `search` | sampling ρ, and the count that proves a list complete |
//! | `certify` | one closing in a box that is proven to hold it |
//! | `jet` | the entries with their derivatives, enclosed over a box |

mod certify;
mod jet;
mod search;

pub use certify::Closing;
pub use search::{COMPLETE_UP_TO, Found, Search, closings, closings_of};
