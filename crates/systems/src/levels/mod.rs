//! Two levels of dense stiffnesses in doubles (r-RESPA): Hessians as people measure them, with margins.
//!
//! x'' + (F + S) x = 0 in mass-weighted coordinates, the fast F with the step h, the slow S with the outer
//! step p h. One eigendecomposition F = U diag(w_i²) Uᵀ serves every p and every step. In its basis the fast
//! half period is diagonal, a_i = cos(p θ_i/2) and so on (file `half`: kicks and drifts in intervals), and
//! with M = (p/2) h² Uᵀ S U, in the time unit h,
//!
//! ```text
//!     P = b (E − M) b,   E = a/b > 0:     definite iff E − M is
//!     R = d (N + M) d,   N = −c/d ≥ 0:    definite iff N + M is
//!     W = b d.
//! ```
//!
//! # The stable region that begins at step 0, and its margin
//!
//! Let J\[x\] = Σ |x_(j+1) − x_j|²/τ_j − Σ x_jᵀ k_j x_j be the action of a path over the half period (τ_j the
//! drifts, k_j the kicks, half of them at the ends), free or held at x = 0 at each end. Elimination from the
//! left gives, for J free at 0 and held at T/2: J > 0 iff J held at both ends > 0 and B⁻¹A > 0, that is P >
//! 0; for J held at 0 and free at T/2: J > 0 iff J held at both ends > 0 and D B⁻¹ > 0. And D B⁻¹ = P⁻¹ + C
//! A⁻¹, so with both of these all μ > −1. The free J is, up to congruence, the one held at T/2 and C A⁻¹, so
//! it has n negative eigenvalues iff C A⁻¹ < 0, that is μ < 0.
//!
//! J decreases where a kick increases. So if the first two hold for the kicks k⁺, and the third for k⁻, all
//! three hold for every k with k⁻ ≤ k ≤ k⁺ (x*ᵀ k x ordered for all x*): **the first stable region is an
//! interval in Loewner's order**. Hence
//!
//! * the verdict stands for all F + E₁, S + E₂ with ‖E₁‖₂ ≤ ε ‖F‖₂ and ‖E₂‖₂ ≤ ε ‖S‖₂ iff it does for the two
//!   that are shifted by ± ε ‖·‖ I: a margin is two factorizations, and no smaller than the true one;
//! * errors of the eigendecomposition, of the projection and of the data enter as the same shifts;
//! * J is linear in h² at a fixed ratio: where J > 0 at an outer step and F + S > 0, every smaller outer step
//!   is stable too.
//!
//! Beyond it W is indefinite, modes may collide, and the eigenvalues of Bᵀ C with their discs and clusters
//! decide (file `beyond`). Source: proofs/REGION.md.
//!
//! | file | what |
//! |---|---|
//! | `half` | the fast half period of one mode, in intervals |
//! | `method` | that of other integrators, as exact flows with filters: the same machinery serves them all |
//! | `rigid`, `apart` | rigid motions projected out, and which are |
//! | `basis` | eigenvalues and eigenvectors, block by block |
//! | `kernel` | the eigenbasis, its backward error, norms |
//! | `region` | the first stable region: verdict, margin, first unstable step |
//! | `chord` | the verdict in it without an eigenbasis |
//! | `sparse` | the same of many thousands of degrees of freedom: sparse factorizations |
//! | `band` | the first region of a whole band of stiffnesses |
//! | `counts` | verdicts by counts of negative eigenvalues, wherever the step lies |
//! | `beyond` | the verdict elsewhere, with the Lipschitz constants of the half period |
//! | `cell` | the verdict on all outer steps, or scales, between two |
//! | `growth` | how fast it grows past that, and up to where: sampled |
//! | `nested` | any number of levels, by the action, beyond its first region by the half period: verdict, margin, band, growth |
//! | `damped` | friction: the spectral radius of the period, proven |
//! | `paths` | the action itself and the full period: another route, for rechecks |
//! | `step` | one step of other methods, the same way |
//! | `search` | edges of what is proven: `Search` over the outer step, for both kinds of levels |
//! | `source` | both kinds of levels behind one face |
//! | `answer` | the verdict at one outer step |
//! | `intervals` | the verdicts on a range of outer steps |

mod answer;
pub mod apart;
mod band;
mod basis;
mod beyond;
mod cell;
mod chord;
mod counts;
mod damped;
mod growth;
mod half;
mod intervals;
mod kernel;
mod method;
mod nested;
mod paths;
mod region;
mod rigid;
pub(crate) mod search;
mod source;
pub mod sparse;
mod step;

pub use cell::Cells;
pub use growth::Growing;
pub use kernel::{AtRatio, Kernel, Outer};
pub use method::Method;
pub use nested::{Nested, Steps};
pub use paths::Near;
pub use rigid::{Hessians, rigid_motions, translations};
pub(crate) use rigid::{Motions, Shares, projected};
pub use search::{Decided, Search};
pub use source::Source;
