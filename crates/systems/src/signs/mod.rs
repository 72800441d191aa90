//! The four signs for n degrees of freedom: definite half-period forms decide, and count what is unstable.
//!
//! The half period H = \[\[A, B\], \[C, D\]\] is symplectic, so the n x n matrices
//!
//! ```text
//!     P = A Bᵀ,     R = −C Dᵀ,     W = Bᵀ D,     Z = −Aᵀ C
//! ```
//!
//! are symmetric. For n = 1 the verdict is the signs of P and R. For any n (μ the eigenvalues of Bᵀ C, λ +
//! 1/λ = 2 + 4 μ):
//!
//! * P and R both definite of one sign: stable, all μ real, semisimple and in (−1, 0). With N = C A⁻¹
//!   (symmetric), C Bᵀ = N P and R = −(N + N P N); for P > 0 and S = P^½ N P^½, similar to C Bᵀ, P^½ R P^½ =
//!   −(S + S²).
//! * One of the four definite (say > 0; else change every sign): all μ are real, and
//!
//! | definite | μ outside \[−1, 0\] | μ < −1 | μ > 0 |
//! |---|---|---|---|
//! | P | negative eigenvalues of R | | |
//! | R | negative eigenvalues of P | | |
//! | W | both together | those of P | those of R |
//! | Z | both together | those of R | those of P |
//!
//!   A zero eigenvalue of P or R beside a definite form is an edge: a Jordan block at λ = ±1, linear growth.
//!   In doubles no eigenvalue is known to be 0, so exact arithmetic tells that.
//! * None definite: #{μ < −1} ≥ |neg P − neg W|, |neg R − neg Z| and #{μ > 0} ≥ |neg R − neg W|, |neg P − neg
//!   Z| for regular forms (neg: the number of negative eigenvalues). Where these agree two modes may have
//!   collided, and other means decide.
//!
//! Source: proofs/SIGNS.md and proofs/REGION.md.
//!
//! | file | what |
//! |---|---|
//! | `forms` | the table above, from the forms of a half period in doubles |
//! | `inertia` | proven inertias of dense matrices in doubles |
//! | `action`, `envelope` | the action of large sparse systems; sparse matrices and their proven signs |

pub(super) mod action;
pub(super) mod envelope;
mod forms;
pub(super) mod inertia;

pub(super) use forms::proven;
