//! Where the paper predicts instability: effective periods, the tan criterion, resonant points and the
//! (a, b) curves on which they lie.
//!
//! With cos θ = 1 − s/2, s = h1² L1, the fast clock alone turns by θ each step, so its effective half period
//! is T½ = π h1/θ. The paper predicts instability where q h2 is near an integer multiple of T½, that is
//! p θ near m π (eq. (9)); all these points lie on the curves 1/T½ = a/h1 + b/h2 (eq. (10)), m = a p + b q.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::propagator::TwoClocks;
//! use kickdrift_clocks::resonance::{dominant_family, tan};
//! use kickdrift_clocks::verdict::Limits;
//! // 7/3 just below p th = 4 pi, weak slow force: unstable, tongue m = 4 = 1·7 − 1·3.
//! let clocks = TwoClocks::with_rho("7/3".parse().unwrap(), ratio(2385, 1000), ratio(1, 25));
//! assert!(!tan::criterion(&clocks, &Limits::default()).unwrap().is_stable());
//! assert_eq!(dominant_family("7/3".parse().unwrap(), 4), (1, -1));
//! ```

mod angle;
pub mod compare;
mod curve;
mod families;
mod family;
mod law;
pub mod proposition;
mod strength;
pub mod tan;

pub use angle::{Angle, Nearest};
pub use curve::{Curve, CurvePoint, Window, curve};
pub use families::Families;
pub use family::{dominant_family, families};
pub use law::{FirstOrder, first_order};
pub use strength::strength;
