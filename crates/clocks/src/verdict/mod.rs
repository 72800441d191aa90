//! The verdict: four signs → stable or not, and the ladder of arithmetic that finds the signs.
//!
//! [`filter`](Tier::Filter) → [`refine`](Tier::Refine) → [`exact`](Tier::Exact): a certified answer in
//! doubles first, more bits where they do not suffice, exact arithmetic for what is left. Every answer is
//! proven: by the rounding bounds of `orbit` or by exact arithmetic. A verdict is never a guess,
//! and there is no tolerance anywhere.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::propagator::TwoClocks;
//! use kickdrift_clocks::verdict::{decide, Kind, Limits, Tier};
//! // r-RESPA, h2 = 3 h1 at s = 1: the resonance 3 th = pi. A step below it is stable ...
//! let verdict_at = |s| decide(&TwoClocks::with_rho("3/1".parse().unwrap(), s, ratio(1, 25)), &Limits::default()).unwrap();
//! assert_eq!(verdict_at(ratio(8, 10)).verdict.kind(), Kind::Elliptic);
//! // ... close below the resonance is not, and on it sits the edge of the tongue.
//! assert_eq!(verdict_at(ratio(99, 100)).verdict.kind(), Kind::Hyperbolic);
//! let edge = verdict_at(ratio(1, 1));
//! assert_eq!((edge.verdict.kind(), edge.decided_by), (Kind::Parabolic, Tier::Exact));
//! ```

mod answer;
mod exact;
mod growth;
mod kind;
mod label;
mod ladder;
mod lone;
mod tier;

pub use crate::orbit::refine::kicks as refine_kicks;
pub use crate::orbit::returns::is_worth as takes_return_maps;
pub use crate::propagator::{HalfSigns, PartialSigns};
pub use answer::{Answer, Decision};
pub use exact::{Decidable, exact_trace};
pub use growth::{Growth, filter_trace, growth, long_growth};
pub use kind::{Kind, Side, Verdict};
pub use label::label;
pub use ladder::{decide, decide_anew, decide_from, decide_long, decide_steps, decide_with_growth};
pub use tier::{Limits, Tier};
