//! Ordered rings without zero divisors in which elimination needs no fractions: ℤ and ℤ\[π\].

use std::fmt::Debug;
use std::ops::{AddAssign, MulAssign, Neg, SubAssign};

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use super::Sign;

/// An ordered ring without zero divisors whose exact quotients can be computed.
///
/// The bounds are those of nalgebra's scalars, so `DMatrix<D>` works for every domain.
pub(crate) trait Domain:
    Clone + Debug + PartialEq + Zero + One + Neg<Output = Self> + AddAssign + SubAssign + MulAssign + 'static
{
    /// The integer n.
    fn from_integer(n: i64) -> Self;
    /// self · other.
    fn product(&self, other: &Self) -> Self;
    /// The q with self = divisor · q, where there is one; else nothing that means anything.
    fn divided_exactly_by(&self, divisor: &Self) -> Self;
    /// The exact sign.
    fn sign(&self) -> Sign;
    /// How long it is, roughly in bits: short pivots are cheap.
    fn length(&self) -> u64;
}

impl Domain for BigInt {
    fn from_integer(n: i64) -> Self {
        n.into()
    }

    fn product(&self, other: &Self) -> Self {
        self * other
    }

    fn divided_exactly_by(&self, divisor: &Self) -> Self {
        self / divisor
    }

    fn sign(&self) -> Sign {
        match self {
            _ if self.is_zero() => Sign::Zero,
            _ if self.is_positive() => Sign::Positive,
            _ => Sign::Negative,
        }
    }

    fn length(&self) -> u64 {
        self.bits()
    }
}
