//! AVI with two clocks, h2/h1 = p/q: Algorithm 1 of the paper over one synchronization period.
//!
//! ```
//! use kickdrift_clocks::number::Rational;
//! use kickdrift_clocks::propagator::{methods::avi, TwoClocks};
//! let r = |n: i64, d: i64| Rational::new(n.into(), d.into());
//! let clocks = TwoClocks::new("3/2".parse().unwrap(), r(1, 2), r(1, 10));
//! assert_eq!(avi::staggered(&clocks).trace(), avi::symmetric(&clocks).trace());
//! ```

use nalgebra::Matrix2;

use crate::propagator::TwoClocks;
use crate::propagator::half::{compose, full_period};
use crate::schedule::Schedule;
use number::Ring;

/// The staggered form, Algorithm 1: whole kicks at t = 0, then drifts up to each next kick, ending just
/// before the kicks at T. In the time unit h1.
///
/// # Panics
/// Where the period has 2^62 ticks and more.
pub fn staggered<S: Ring>(clocks: &TwoClocks<S>) -> Matrix2<S> {
    compose(clocks, Schedule::staggered_period)
}

/// The time-symmetric form: the kicks at t = 0 split in two halves, one moved to T. Conjugate to the
/// staggered form by half a kick, so the trace is the same (theorem `staggered_trace` in proofs/).
///
/// # Panics
/// As [`staggered`].
pub fn symmetric<S: Ring>(clocks: &TwoClocks<S>) -> Matrix2<S> {
    full_period(clocks)
}
