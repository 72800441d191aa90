//! Two levels of sparse stiffnesses: the first stable region of many thousands of degrees of freedom.
//!
//! No eigenvalue of F is computed but its largest. With E(s) = a/b of one mode, concave where the odd
//! solution rises (proofs/REGION.md, section 7), and M = (p/2) h² S:
//!
//! ```text
//!     stable:     α − β h² F − M > 0 for a line α − β s below E over the spectrum of h² F, and F + S > 0 but for rigid motions;
//!     unstable:   E(h² xᵀFx) < xᵀMx for one x of length 1, since xᵀE(h²F)x ≤ E(xᵀ h²F x) (Jensen), where F + S > 0.
//! ```
//!
//! The first is two sparse Cholesky factorizations that run to their end, the second one vector, from a
//! Krylov space of the form. In between nothing is said: that gap is as wide as the line lies below E where x
//! has its share. Above the first region no step is called stable, and none unstable but where that vector
//! still proves it. Factors are kept only where something is solved with them; the rest asks for signs, and
//! goes front by front.
//!
//! | file | what |
//! |---|---|
//! | `matrix` | sparse symmetric matrices, sums proven positive definite |
//! | `dissect` | in which order their rows are eliminated |
//! | `fronts` | the pivots of an elimination that keeps no factors |
//! | `krylov` | one eigenvector of an operator |
//! | `region` | the verdict; in `edge` the margin and the first unstable step, in `total` the sum of both |

mod dissect;
mod fronts;
mod krylov;
mod matrix;
mod region;

pub(crate) use matrix::Pattern;
pub use matrix::Triplets;
pub use matrix::symmetric;
pub use region::SparseLevels;
