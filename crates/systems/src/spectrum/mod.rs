//! The eigenvalues μ of Bᵀ C in doubles: where they lie for sure, how fast they grow, what they are.
//!
//! | file | what |
//! |---|---|
//! | `discs` | all of them, each in a proven disc |
//! | `bauer_fike`, `clusters` | the discs' radii; multiple eigenvalues |
//! | `dense` | eigenvalues without bounds, for second routes |
//! | `rate` | growth rates, enclosed |
//! | `modes`, `explain` | normal modes; what grows and why |

pub(super) mod bauer_fike;
pub(super) mod clusters;
pub(super) mod dense;
pub(super) mod discs;
pub(super) mod explain;
pub(super) mod modes;
pub(super) mod rate;
