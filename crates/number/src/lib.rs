//! The types of numbers.
//!
//! | type | set | sign by |
//! |---|---|---|
//! | [`Rational`] | ℚ | inspection |
//! | [`Laurent`] | ℚ[π, 1/π] | coefficients if all vanish (π is transcendental), else balls of growing precision |
//! | [`Cyclotomic`] | ℚ(2cos(π/n)) | reduced polynomial if it vanishes, else balls of growing precision |
//! | [`Radical`] | ℚ(c^(1/n)), c rational | as of a cyclotomic number |
//! | [`Ball`] | an interval that contains a real number | inspection; may be unable to decide |
//! | [`Polynomial`] | R\[x\] over any ring R | not at all: a [`Ring`] only; real roots by Sturm chains |
//! | `f64` | doubles | not at all: a [`Ring`] only |
//!
//! Exact types know their sign ([`ExactSign`]) and can be enclosed ([`Real`]); a [`Ball`] answers `None`
//! where it cannot decide; no exact type converts from a double silently ([`rational::from_f64_exact`] is
//! loud).
//!
//! ```
//! use kickdrift_number::{ExactSign, Laurent, Real, Sign, parse};
//! // h² Λ − 4, the margin of velocity Verlet, at Λ = π² and h = 2/π: exactly on its stability limit.
//! let lambda = parse::parse("lambda", "pi^2").unwrap();
//! let h = parse::parse("h", "2/pi").unwrap();
//! let margin = &(&(&h * &h) * &lambda) - &Laurent::from_integer(4);
//! assert_eq!(margin.sign(), Sign::Zero);
//! // The doubles next to h are not on it, and a ball of few bits cannot decide.
//! let ball = h.enclosure(53).square(53).mul(&lambda.enclosure(53), 53);
//! assert_eq!(ball.sub(&Laurent::from_integer(4).enclosure(53), 53).sign(), None);
//! ```

pub mod ball;
mod bisect;
pub mod cyclotomic;
mod element;
mod enclosed;
pub mod error;
pub mod file;
mod float;
mod interval;
pub mod jet;
pub mod laurent;
mod named;
mod operators;
pub mod parallel;
pub mod parse;
pub mod polynomial;
mod prime_field;
mod quantity;
pub mod radical;
mod ratio;
pub mod rational;
mod reduced;
mod ring;
mod sign;
mod twofold;
#[doc(hidden)]
pub mod vector;

pub use ball::Ball;
pub use bisect::bisected;
pub use cyclotomic::{Cyclotomic, CyclotomicField};
pub use element::{Element, NumberField};
pub use enclosed::Enclosed;
pub use error::{Error, Result};
pub use float::{outward, power_of_two};
pub use interval::Interval;
pub use laurent::Laurent;
pub use polynomial::Polynomial;
pub use prime_field::Lift;
pub use prime_field::{PrimeField, prime_fields};
pub use quantity::Quantity;
pub use radical::{Radical, RadicalField};
pub use ratio::Ratio;
pub use rational::{Rational, from_f64_exact, ratio, to_f64};
pub use ring::{ExactSign, Real, Ring};
pub use sign::Sign;
pub use twofold::Twofold;

/// The unit roundoff u = 2^-53 of doubles: half the distance from 1 to the next one.
pub const U: f64 = f64::EPSILON / 2.0;
