//! The fastest growth inside a tongue.
//!
//! | file | what is there |
//! |---|---|
//! | `largest` | where the growth rate is largest, and how large |
//! | `meet` | the two entries of a tongue at a point, in two doubles each |

mod largest;
mod meet;

pub use largest::Peak;
