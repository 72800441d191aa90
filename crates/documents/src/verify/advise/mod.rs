//! Advice: the full period kick by kick in balls of many bits, and the first region by the pivots of its
//! action.
//!
//! The action of a path over the half period, J = Σ |x_j − x_(j−1)|²/τ_j − Σ k_j x_j², is a tridiagonal form;
//! it is positive iff all pivots of its elimination are (Sylvester). That is another route than the strings
//! of the tongues and than the orbits of many clocks.
//!
//! | file | what |
//! |---|---|
//! | `claim` | the rows of the document, and what concerns it as a whole |
//! | `mass` | one mass on its clocks: trace, friction, first region |
//! | `scheme`, `row` | the row of a scheme, of a mode at a scheme |
//! | `lever` | levers that would let the step grow |
//! | `direct` | advice on forces that are no gradient: computed again, its growth by the dense full period |
//! | `molecule` | advice on Hessians: computed again, its proofs and growth by another route |

mod claim;
mod direct;
mod lever;
mod mass;
mod molecule;
mod row;
mod scheme;

pub use claim::Claim;
pub use direct::Claim as Direct;
pub use molecule::Claim as Molecule;

use super::again::Left;

/// The leaves of advice on a system's file that nothing follows from.
const LEFT: &[Left] =
    &[("input.file", "a name"), ("engine", "the text that it was read from is not part of the document")];
