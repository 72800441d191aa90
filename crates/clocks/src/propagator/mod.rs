//! The algebra: kicks and drifts, full- and half-period propagators.
//!
//! The state is the column (x, v). A kick of strength k and a drift of length t are
//!
//! ```text
//!     K(k) = [  1  0 ]        D(t) = [ 1  t ]
//!            [ -k  1 ]               [ 0  1 ]
//! ```
//!
//! and clock i kicks with strength h_i L_i at the multiples of its step h_i. Every function is
//! generic over the scalar: rationals, Q\[π\], cyclotomic numbers, polynomials, and `f64`, which computes
//! but cannot certify.
//!
//! ```
//! use kickdrift_clocks::number::Rational;
//! use kickdrift_clocks::propagator::{half_period, TwoClocks};
//! let rational = |n: i64, d: i64| Rational::new(n.into(), d.into());
//! // h2/h1 = 5/3, s = h1² L1 = 11/4, L2/L1 = 114/55: the slow kick is s (L2/L1)(p/q) = 19/2.
//! let clocks = TwoClocks::new("5/3".parse().unwrap(), rational(11, 4), rational(19, 2));
//! let half = half_period(&clocks);
//! assert_eq!((half.a(), half.b()), (&rational(9, 4), &rational(0, 1)));
//! assert_eq!(half.trace(), rational(2, 1)); // Q = I: the tongue is closed here
//! ```

mod bias;
mod builder;
mod clocks;
mod elementary;
mod half;
pub mod methods;
mod signs;

pub use bias::{Bias, MAX_BIAS_KICKS, bias, enclosed_bias, enclosed_bias_of, rounded_bias};
pub use builder::OscillatorBuilder;
pub use clocks::{LongClocks, Oscillator, TwoClocks};
pub use elementary::{apply_drift, apply_kick, drift, kick};
pub use half::{HalfPeriod, full_period, half_period};
pub use signs::{HalfSigns, PartialSigns};
