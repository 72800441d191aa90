//! Forces that are no gradient, as learned ones that are predicted directly: their Jacobians are not
//! symmetric (proofs/NO_GRADIENT.md).
//!
//! M x'' = −Σ J_k x, A_k = M⁻¹ J_k. The kicks are a palindrome of shears whatever the matrices, so with R =
//! diag(I, −I) the period is Q = R H⁻¹ R H, H the half period, and H⁻¹ H = 1 gives
//!
//! ```text
//!     Q₁₁ = 1 + 2 S,     S = B' C,     λ + 1/λ = 2 + 4 μ,     μ an eigenvalue of S,
//! ```
//!
//! B' that block of R H⁻¹ R, the same events in the opposite order. Stable iff all μ are real, in [−1, 0],
//! and Q is diagonalizable: as for symmetric matrices, whose B' is Bᵀ. But x'' = −A x itself grows wherever
//! an eigenvalue of A is not real and positive: what is asked of such a force is at which rate, and how much
//! of that the steps add.
//!
//! | file | what |
//! |---|---|
//! | `model` | the matrices with their clocks, without rigid motions |
//! | `orbit` | the half period in doubles with a proven bound, and exactly |
//! | `decide` | the verdict, the growth with and without steps |
//! | `friction` | periods with friction, and the friction that masks growth |

mod decide;
mod friction;
mod model;
mod orbit;

pub use decide::NoGradient;
pub use model::Jacobians;
