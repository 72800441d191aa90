//! Every tongue of a ratio, exactly: a grid can miss a thin tongue, this cannot.
//!
//! For fixed h2/h1 = p/q and ρ = L2/L1 ≥ 0 the unstable set in s = h1² L1 is a finite list of intervals.
//! Their edges are the zeros of the half period's entries A, B, C, D, and those are the eigenvalues of four
//! vibrating strings (the `string` module). So nothing is searched on a grid:
//!
//! ```text
//!     counts -> brackets -> modes, Rayleigh quotients -> edges -> tongues -> rows, survey, closings
//! ```
//!
//! | room | what is there |
//! |---|---|
//! | `string` | the half period as masses and springs |
//! | `edge` | edges in doubles and by more bits |
//! | `gap` | a tongue between its two edges: which is the lower one, how wide, open or closed |
//! | `peak` | the fastest growth inside |
//! | `closing` | where tongues close as ρ changes |
//! | `row` | a tongue with all that is known about it |
//! | `tongues`, `select` | the tongues of one ratio, and some of them |
//! | `request`, `question` | a tongue with all that is asked for, tongues of many ratios |
//! | `survey` | what all ratios up to a sum have to say |
//! | [`sampled`] | tongues as points: over ρ, through one resonance, beside the first-order law |
//!
//! Every edge is enclosed, as a rule between neighbouring doubles, and every tongue is proven open or closed.
//! Inside tongue m the growing solution changes sign m times in a period: m is the label that the map and the
//! verdict give, and the paper's m of q h2 = m T½ (eq. (9)).
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::tongue::{Entry, Tongues};
//! // 7/2 at rho = 1/25, m = 4: one edge sits on the resonance 4 sin²(2 pi/7).
//! let tongues = Tongues::new("7/2".parse().unwrap(), &ratio(1, 25)).unwrap();
//! let gap = tongues.gap(4).unwrap();
//! let (lower, upper) = (gap.lower, gap.upper.unwrap());
//! assert!(lower.lo <= 2.3150964145691537 && 2.3150964145691537 <= lower.hi);
//! assert_eq!((lower.entry, upper.entry), (Entry::C, Entry::B));
//! assert!(upper.hi <= upper.lo.next_up().next_up() && !gap.closed);
//! // Fifty digits of it.
//! let precise = tongues.refine(&lower, 50).unwrap();
//! assert!(precise.width() < &precise.lo * num_rational::BigRational::new(1.into(), num_bigint::BigInt::from(10).pow(50)));
//! ```

mod closing;
mod edge;
mod gap;
mod peak;
mod question;
mod request;
mod row;
pub mod sampled;
mod select;
mod string;
mod survey;
mod tongues;

pub use closing::{COMPLETE_UP_TO, Closing, Found, Search, closings, closings_of};
pub use edge::{Edge, Effort, Enclosure, Tongues};
pub use gap::{Gap, count_closings, entries};
pub use peak::Peak;
pub use question::{Listing, Progress, StepWindow, Stiffness};
pub use request::{Bounds, Request, Tongue, TongueEdge};
pub use row::{ExactEdge, Law, Predicted, Resonance, Row, Side, Wanted};
pub use select::{Labels, Range, Selection};
pub use string::Entry;
pub use survey::{Spread, Survey, Thin, survey};
