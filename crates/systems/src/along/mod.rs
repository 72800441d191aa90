//! About a periodic orbit of the integrator's own: every kick with the Hessian at its own position
//! (docs/theory/many.md, proofs/FRICTION.md section 3).
//!
//! An orbit that starts at rest in the middle of a kick of every clock is its own mirror image in time. So
//! the Hessians of the kicks form a palindrome, and the tangent map H of half the period decides as for one
//! Hessian a clock: every kick is by a symmetric matrix, H is symplectic,
//!
//! ```text
//!     Q + 1/Q = diag(2 + 4 S, 2 + 4 Sᵀ),     S = Bᵀ C,     λ + 1/λ = 2 + 4 μ,     μ an eigenvalue of S.
//! ```
//!
//! Measured Hessians are known to an accuracy ε: K' = K + E, E symmetric, |E| ≤ ε times the largest |K| of
//! the clock's kicks (2-norms, mass-weighted; one kick of a clock may be nearly nothing, as of what is held).
//! Each kick then is off by h E, and the half period by the sum of what these become (file `period` of the
//! half period): what is proven holds for all such Hessians.
//!
//! **Rigid motions** of a free molecule are no null vectors of single Hessians along an orbit. But forces
//! that turn with the atoms keep the momentum and the angular momentum. Let the columns of J₀ and J₁ move the
//! atoms rigidly where the orbit starts and where it turns, at rest both times. Then
//!
//! ```text
//!     A J₀ = J₁,     C J₀ = 0,     J₁ᵀ C = 0,     J₁ᵀ D = J₀ᵀ,
//! ```
//!
//! and with orthonormal bases U₀, U₁ of what is orthogonal to them the map U₁ᵀ H U₀, block by block, is
//! symplectic: it is H on what has no momentum, up to rigid motions. Its S is U₀ᵀ Bᵀ U₁ U₁ᵀ C U₀ = U₀ᵀ Bᵀ C
//! U₀, whose eigenvalues are those of Bᵀ C but for the zeros of J₀. What is proven holds for the Hessians
//! within the accuracy for which C J₀ = 0 and J₁ᵀ C = 0; that there may be such is checked. In a periodic box
//! the translations are projected out of each Hessian, as of any other.
//!
//! **Held distances** turn along an orbit. In coordinates that go with them drifts are plain ones again,
//! between symmetric kicks that are added to the Hessians (`python/kickdrift/_hessians.py`, `plain`); the
//! rigid motions are given as columns then ([`Along::free_of`]).
//!
//! | file | what |
//! |---|---|
//! | `model` | the Hessians, their accuracy, the rigid motions |
//! | `scaled` | coordinates in which positions and momenta are of one size |
//! | `decide` | the half period with its bound, the verdict, how far it stands |

mod decide;
mod model;
mod scaled;

pub use decide::{OwnOrbit, decide_along};
pub use model::Along;
