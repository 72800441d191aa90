//! Leapfrog with local time steps, as codes for waves have it (Diaz and Grote 2009): M x'' + K x = 0 with a
//! diagonal M, whose fine degrees of freedom take p substeps while forces on the others stand still.
//!
//! ```text
//!     x₊ − 2 x + x₋ = −M⁻¹ f x,     f = 2 S₀,
//!     S_L = d_L²/2 K,     S_(l−1) = W_p(1 − S_l P_l M⁻¹) S_l,     W_(m+1)(c) = 2 c W_m(c) + 2 − W_(m−1)(c),  W₀ = 0, W₁ = 1
//! ```
//!
//! with P_l on the degrees of freedom that are fine at level l, p its substeps and d_l their length; with one
//! level and A = M⁻¹K this is the method of proofs/LOCAL_STEPS.md. f is symmetric, so **the scheme is
//! Verlet's with the stiffness f/dt²**: stable iff 0 < f < 4 M but for rigid motions, and every route of a
//! system of one clock decides it. Its stiffness is a polynomial in dt², so unstable intervals of dt lie
//! between real roots of two determinants.
//!
//! | file | what |
//! |---|---|
//! | `scheme` | the levels, the effective stiffness |
//! | `intervals` | all unstable intervals of dt, exactly |
//! | `elements` | AVI of elements in levels |
//! | `columns` | the effective stiffness in sparse doubles |
//! | `sparse` | many thousands of degrees of freedom: f in sparse doubles, its verdicts, what grows fastest |

mod columns;
mod elements;
mod intervals;
mod scheme;
mod sparse;

pub use elements::ElementSteps;
pub use scheme::{Level, LocalSteps, Scheme, SchemeSummary};
pub use sparse::{Growth, SparseSteps};
