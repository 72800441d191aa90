//! What a quantity can be.
//!
//! | type | set | sign by |
//! |---|---|---|
//! | [`Rational`] | ℚ | inspection |
//! | [`Laurent`] | ℚ[π, 1/π] | coefficients if all vanish (π is transcendental), else balls of growing precision |
//! | [`Cyclotomic`] | ℚ(2cos(π/n)) | reduced polynomial if it vanishes, else balls of growing precision |
//! | [`Ball`] | an interval that contains a real number | inspection; may be unable to tell |
//! | [`Polynomial`] | R\[x\] over any ring R | not at all: a [`Ring`] only; real roots by Sturm chains |
//! | `f64` | doubles | not at all: a [`Ring`] only |

pub mod ball;
pub mod cyclotomic;
mod float;
pub mod laurent;
mod operators;
pub mod parse;
pub mod polynomial;
pub mod rational;
mod ring;
mod sign;

pub use ball::Ball;
pub use cyclotomic::{Cyclotomic, CyclotomicField};
pub use laurent::Laurent;
pub use polynomial::Polynomial;
pub use ring::{ExactSign, Real, Ring};
pub use sign::Sign;

/// The rationals, always in lowest terms with a positive denominator.
pub type Rational = num_rational::BigRational;
