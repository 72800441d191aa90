//! Many clocks, many degrees of freedom: M x'' + Σ K_k x = 0, each potential with a step of its own.
//!
//! The kick pattern is a palindrome, so the half period H = \[\[A, B\], \[C, D\]\], now in n x n blocks, decides. H is
//! symplectic in positions and momenta, and with S = Bᵀ C
//!
//! ```text
//!     Q + 1/Q = diag(2 + 4 S, 2 + 4 Sᵀ):     λ + 1/λ = 2 + 4 μ,   μ an eigenvalue of S
//! ```
//!
//! so the multipliers come from an n x n matrix and half a period. Stable iff every μ is real and in [−1, 0] and Q is
//! diagonalizable.
//!
//! | file | what |
//! |---|---|
//! | `models` | what a system may be; which route decides it |
//! | `model`, `sparse`, `builders`, `mesh` | what a system is, and the usual ones; finite elements |
//! | `compose` | kicks and drifts that touch only the degrees of freedom of their potential |
//! | `frame`, `split` | rigid modes set apart, commuting potentials split: exactly |
//! | `scalar`, `enclose`, `single` | K clocks on one oscillator: exact, in balls, decided |
//! | `float`, `inertia`, `signs` | the half period in doubles with a proven bound; signs of symmetric matrices decide |
//! | `large`, `action`, `envelope` | thousands of degrees of freedom: signs of the sparse action, and the mode that grows fastest |
//! | `spectrum`, `bauer_fike`, `clusters` | eigenvalues with proven discs, where the signs do not tell |
//! | `integers`, `modular`, `roots`, `exact`, `refined` | exact arithmetic |
//! | `rate` | growth rates, enclosed |
//! | `pi` | stiffnesses that involve π: decided over ℚ\[π\] |
//! | `decide`, `piece` | the verdict, part by part |
//! | `analysis`, `explain`, `modes` | what is told of it, what grows and why |
//! | `period` | whole periods in doubles, with friction or a stiffness of its own for each kick |
//! | `friction` | O-steps between the kicks: spectral radius, the friction that masks a resonance |
//! | `along` | about a periodic orbit: a Hessian for each kick |
//! | `scan`, `vary`, `stretches`, `nearest` | maps; all systems between two; a range covered; the unstable intervals next to a number |
//! | `critical`, `edges` | where the verdict can change, exactly; what lies between |
//!
//! The cost for n degrees of freedom, whose potentials kick T/h_k times a period and hold e_k entries: n Σ (T/h_k) e_k
//! for the half period, some n³ for the eigenvalues and their bound in doubles. Exact arithmetic grows with the length
//! of its numbers, about n^4 T/h and n³ (T/h)² products of machine words, and tells its cost before it begins.
//!
//! ```
//! use kickdrift::number::rational::ratio;
//! use kickdrift::system::{Limits, builders, decide_system};
//! // Eight masses, soft springs with a step of 1/2 between stiff ones with a step of 1/4.
//! let chain = builders::alternating_chain(8, [&ratio(10, 1), &ratio(1, 1)], [&ratio(1, 4), &ratio(1, 2)]).unwrap();
//! let analysis = decide_system(&chain, &Limits::default()).unwrap();
//! assert!(analysis.is_proof());
//! assert!(analysis.is_stable());
//! ```

mod action;
mod along;
mod analysis;
mod bauer_fike;
pub mod builders;
mod clusters;
mod compose;
mod critical;
mod decide;
pub mod edges;
mod enclose;
mod envelope;
mod exact;
mod explain;
mod float;
mod frame;
pub mod friction;
mod inertia;
mod integers;
mod large;
pub mod levels;
mod limits;
mod measured;
pub mod mesh;
mod model;
mod models;
mod modes;
mod modular;
pub mod nearest;
mod norm;
#[cfg(test)]
mod numbers;
mod period;
mod pi;
mod piece;
mod rate;
mod refined;
mod roots;
mod scalar;
pub mod scan;
mod signs;
mod single;
mod sparse;
mod spectrum;
mod split;
pub mod stretches;
pub mod vary;

pub use along::{OwnOrbit, decide_along};
pub use analysis::{Analysis, Clocked, Evidence, Instability, Part};
pub use compose::{full_period, half_period};
pub use decide::{decide_by, decide_system, exact_kind, verdict_cost};
pub use exact::{ExactVerdict, MuCount, decide_exact};
pub use limits::{Limits, Route};
pub use measured::{Holds, Measured, Removed};
pub use model::{Potential, System};
pub use models::{Body, MeasuredSystem, Model, Number, Oscillator, TwoLevels};
pub use modes::{Origin, Resonance};
pub use pi::{PiPotential, PiSystem};
pub use rate::{Multiplier, middle};
pub use scalar::{ManyClocks, families, shortest_families, shortest_family};
pub use single::decide_oscillator;
pub use sparse::Symmetric;
