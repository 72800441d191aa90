//! Every tongue of a ratio, exactly: a grid can miss a thin tongue, this cannot.
//!
//! For fixed h2/h1 = p/q and ρ = L2/L1 ≥ 0 the unstable set in s = h1² L1 is a finite list of intervals. Their edges are
//! the zeros of the half period's entries A, B, C, D, and those are the eigenvalues of four vibrating strings (the
//! `string` module). So nothing is searched on a grid:
//!
//! ```text
//!     counts -> brackets -> modes, Rayleigh quotients -> edges -> tongues -> rows, survey, closings
//!
//!     counts, brackets     sturm, isolate
//!     modes                locate, half, mode, side by side in a batch
//!     edges                spectrum; by more bits: precise, exact_count
//!     tongues              gaps, order; thinner than doubles tell: tunnel; open or closed: modular, elimination
//!     largest growth       peak, meet
//! ```
//!
//! Every edge is enclosed, as a rule between neighbouring doubles, and every tongue is proven open or closed.
//! Inside tongue m the growing solution changes sign m times in a period: m is the label that the map and the
//! verdict give, and the paper's m of q h2 = m T½ (eq. (9)).
//!
//! ```
//! use kickdrift::number::rational::ratio;
//! use kickdrift::tongue::{Entry, Tongues};
//! // 7/2 at rho = 1/25, m = 4: one edge sits on the resonance 4 sin²(2 pi/7).
//! let mut tongues = Tongues::new("7/2".parse().unwrap(), &ratio(1, 25)).unwrap();
//! let gap = tongues.gap(4).unwrap();
//! let (lower, upper) = (gap.lower, gap.upper.unwrap());
//! assert!(lower.lo <= 2.3150964145691537 && 2.3150964145691537 <= lower.hi);
//! assert_eq!((lower.entry, upper.entry), (Entry::C, Entry::B));
//! assert!(upper.hi <= upper.lo.next_up().next_up() && !gap.closed);
//! // Fifty digits of it.
//! let precise = tongues.refine(&lower, 50).unwrap();
//! assert!(precise.width() < &precise.lo * num_rational::BigRational::new(1.into(), num_bigint::BigInt::from(10).pow(50)));
//! ```

mod batch;
mod closing;
mod elimination;
mod exact_count;
mod gaps;
mod half;
mod isolate;
mod jet;
mod lanes;
mod locate;
mod meet;
mod mode;
mod modular;
mod order;
mod peak;
mod precise;
mod row;
mod select;
mod spectrum;
mod string;
mod sturm;
mod survey;
mod tunnel;
mod twofold;

pub use closing::{Closing, ELIMINATION, Found, Search, closings};
pub use elimination::{count_closings, entries};
pub use gaps::{Effort, Tongues};
pub use order::Gap;
pub use peak::Peak;
pub use precise::Enclosure;
pub use row::{ExactEdge, Law, Predicted, Row, Side, Wanted};
pub use select::{Resonance, Selection};
pub use spectrum::Edge;
pub use string::Entry;
pub use survey::{Spread, Survey, Thin, survey};
