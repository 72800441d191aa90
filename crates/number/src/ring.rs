//! What types of numbers can do: compute ([`Ring`]), decide their sign ([`ExactSign`]), be enclosed
//! ([`Real`]).
//!
//! `f64` is a [`Ring`] and nothing more: it can compute but not certify, so no code that decides a
//! verdict accepts it.

use std::fmt::Debug;
use std::ops::{AddAssign, MulAssign, Neg, SubAssign};

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::{Ball, Rational, Sign, Twofold, rational, reduced};

/// A commutative ring that contains the rationals (for `f64`: their nearest doubles).
///
/// The bounds are those of nalgebra's scalars, so `Matrix2<R>` works for every ring.
pub trait Ring:
    Clone + Debug + PartialEq + Zero + One + Neg<Output = Self> + AddAssign + SubAssign + MulAssign + 'static
{
    /// The rational x as an element of the ring.
    fn from_rational(x: &Rational) -> Self;

    /// `self += a b`.
    fn add_product(&mut self, a: &Self, b: &Self);

    /// `self -= a b`.
    fn sub_product(&mut self, a: &Self, b: &Self);

    /// `a b`.
    fn product(a: &Self, b: &Self) -> Self {
        let mut product = Self::zero();
        product.add_product(a, b);
        product
    }
}

/// A ring of real numbers whose signs are decided, zero included.
pub trait ExactSign: Ring {
    /// The exact sign.
    fn sign(&self) -> Sign;
}

/// An exact real number that can be enclosed as tightly as asked.
pub trait Real: ExactSign {
    /// A ball that contains the number, with about `bits` correct bits (relative to its size,
    /// the exact zero being the ball 0).
    fn enclosure(&self, bits: u32) -> Ball;

    /// hi + lo within 2^-99 of the number, relatively, |lo| ≤ ulp(hi)/2, where a few operations on doubles
    /// give it; `None` says nothing about the number.
    fn two_doubles(&self) -> Option<(f64, f64)> {
        None
    }
}

impl Ring for f64 {
    /// The double nearest to x (ties to even); infinite beyond the largest double.
    fn from_rational(x: &Rational) -> f64 {
        rational::to_f64(x)
    }

    fn add_product(&mut self, a: &f64, b: &f64) {
        *self += a * b;
    }

    fn sub_product(&mut self, a: &f64, b: &f64) {
        *self -= a * b;
    }
}

impl Ring for Rational {
    fn from_rational(x: &Rational) -> Self {
        x.clone()
    }

    fn add_product(&mut self, a: &Self, b: &Self) {
        *self = reduced::sum(self, &reduced::product(a, b));
    }

    fn sub_product(&mut self, a: &Self, b: &Self) {
        *self = reduced::sum(self, &-reduced::product(a, b));
    }

    fn product(a: &Self, b: &Self) -> Self {
        reduced::product(a, b)
    }
}

impl ExactSign for Rational {
    /// The numerator's sign, the denominator being positive.
    fn sign(&self) -> Sign {
        if self.is_zero() {
            Sign::Zero
        } else if self.is_positive() {
            Sign::Positive
        } else {
            Sign::Negative
        }
    }
}

impl Real for Rational {
    fn enclosure(&self, bits: u32) -> Ball {
        Ball::from_rational(self, bits + 2)
    }

    fn two_doubles(&self) -> Option<(f64, f64)> {
        let magnitude = |n: &BigInt| n.magnitude().to_u64();
        let Twofold { hi, lo } = Twofold::quotient(magnitude(self.numer())?, magnitude(self.denom())?)?;
        Some(if self.is_negative() { (-hi, -lo) } else { (hi, lo) })
    }
}
