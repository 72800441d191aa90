//! Many clocks, many degrees of freedom: M x'' + Σ K_k x = 0, each potential with a step of its own.
//!
//! The kick pattern is a palindrome, so the half period H = \[\[A, B\], \[C, D\]\], now in n x n blocks,
//! decides. H is symplectic in positions and momenta, and with S = Bᵀ C
//!
//! ```text
//!     Q + 1/Q = diag(2 + 4 S, 2 + 4 Sᵀ):     λ + 1/λ = 2 + 4 μ,   μ an eigenvalue of S
//! ```
//!
//! so the multipliers come from an n x n matrix and half a period. Stable iff every μ is real and in [−1, 0]
//! and Q is diagonalizable.
//!
//! | room | what |
//! |---|---|
//! | `model` | what a system may be made of; one verdict for all, whichever route decides |
//! | `linear` | masses, potentials and clocks over ℚ; the usual systems, finite elements |
//! | `half` | the half period, in any ring and in doubles |
//! | `signs` | signs of symmetric matrices decide: of the half period's forms, of the sparse action |
//! | `spectrum` | eigenvalues with proven discs, where the signs cannot decide; growth rates, modes |
//! | `exact` | exact arithmetic over ℚ |
//! | `single` | one oscillator under any number of clocks |
//! | `pi` | stiffnesses that involve π: decided over ℚ\[π\] |
//! | `levels` | two levels of dense stiffnesses in doubles, with margins |
//! | `verdict` | the verdict, part by part, and what is known beside it |
//! | `along` | about the integrator's own orbit: a Hessian for each kick, measured to an accuracy |
//! | `jacobian` | forces that are no gradient: Jacobians that are not symmetric |
//! | `lts` | local time steps, as codes for waves have them: leapfrog, AVI |
//! | `geometry` | where degrees of freedom are in space |
//! | `bias` | by how much a stable step bends what each normal mode holds |
//! | `friction` | O-steps between the kicks: spectral radius, the friction that masks a resonance |
//! | `vary` | maps; the unstable intervals of one number |
//!
//! The cost for n degrees of freedom, whose potentials kick T/h_k times a period and hold e_k entries: n Σ
//! (T/h_k) e_k for the half period, some n³ for the eigenvalues and their bound in doubles. Exact arithmetic
//! grows with the length of its numbers, about n^4 T/h and n³ (T/h)² products of machine words, and states
//! its cost before it begins.
//!
//! ```
//! use kickdrift_systems::number::rational::ratio;
//! use kickdrift_systems::{Limits, builders, decide_system};
//! // Eight masses, soft springs with a step of 1/2 between stiff ones with a step of 1/4.
//! let chain = builders::alternating_chain(8, [&ratio(10, 1), &ratio(1, 1)], [&ratio(1, 4), &ratio(1, 2)]).unwrap();
//! let analysis = decide_system(&chain, &Limits::default()).unwrap();
//! assert!(analysis.is_proof());
//! assert!(analysis.is_stable());
//! ```

mod along;
pub mod avi;
mod bias;
mod columns;
mod exact;
pub mod friction;
mod geometry;
mod half;
mod implicit;
mod jacobian;
pub mod levels;
mod linear;
mod lts;
mod model;
#[cfg(test)]
mod numbers;
mod pi;
mod signs;
mod single;
mod spectrum;
pub mod vary;
mod verdict;

pub use clocks;
pub use number;
pub use words;

pub use along::{Along, OwnOrbit, decide_along};
pub use bias::{BiasedMode, NoBias};
pub use exact::decide::{ExactVerdict, MuCount, decide_exact};
pub use geometry::Geometry;
pub use half::compose::{full_period, half_period};
pub use implicit::ImplicitExplicit;
pub use jacobian::{Jacobians, NoGradient};
pub use linear::sparse::Symmetric;
pub use linear::system::{Potential, System};
pub use linear::{builders, mesh};
pub use lts::{ElementSteps, Growth, Level, LocalSteps, Scheme, SchemeSummary, SparseSteps};
pub use model::{Body, MeasuredLevels, MeasuredSystem, Model, Number, Oscillator, SparseSystem};
pub use pi::{BesidePi, PiPotential, beside_pi};
pub use single::clocks::{ManyClocks, families, shortest_families, shortest_family};
pub use single::decide::decide_oscillator;
pub use spectrum::dense::{eigen, symmetric_eigenvalues};
pub use spectrum::modes::{Origin, Resonance};
pub use spectrum::rate::{Multiplier, middle};
pub use vary::{edges, nearest, scan, stretches};
pub use verdict::analysis::{Analysis, Clocked, Evidence, Instability, Part};
pub use verdict::decide::{decide_by, decide_system, exact_kind, verdict_cost};
pub use verdict::limits::{Limits, Route, seconds};
pub use verdict::measured::{Holds, Measured, Removed};
