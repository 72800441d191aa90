//! The verdict on a linear system, part by part, and everything that is known beside it.
//!
//! | file | what |
//! |---|---|
//! | `decide`, `piece` | the parts, each by the cheapest means that proves it |
//! | `large` | thousands of degrees of freedom: signs of the sparse action, and the mode that grows fastest |
//! | `analysis`, `measured` | the answer; how far it holds where stiffnesses were measured |
//! | `limits` | which means are tried, and what they may cost |

pub(super) mod analysis;
pub(super) mod decide;
pub(super) mod large;
pub(super) mod limits;
pub(super) mod measured;
pub(super) mod piece;
