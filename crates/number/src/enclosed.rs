//! Balls of one precision as a ring, so that code which is generic over rings runs in enclosures too.

use num_traits::{One, Zero};

use super::operators::ring_operators;
use super::{Ball, Sign};

/// A ball whose operations round outward to `BITS` bits: each contains the exact result.
#[derive(Clone, Debug)]
pub struct Enclosed<const BITS: u32>(pub Ball);

impl<const BITS: u32> Enclosed<BITS> {
    /// The sign, where the ball does not straddle 0.
    pub fn sign(&self) -> Option<Sign> {
        self.0.sign()
    }

    fn sum(&self, other: &Self) -> Self {
        Enclosed(self.0.add(&other.0, BITS))
    }

    fn difference(&self, other: &Self) -> Self {
        Enclosed(self.0.sub(&other.0, BITS))
    }

    fn times(&self, other: &Self) -> Self {
        Enclosed(self.0.mul(&other.0, BITS))
    }

    fn negated(&self) -> Self {
        Enclosed(self.0.neg())
    }
}

ring_operators!([const BITS: u32] Enclosed<BITS>, |x| Enclosed(Ball::from_rational(x, BITS)));

impl<const BITS: u32> PartialEq for Enclosed<BITS> {
    /// Both are one number, and the same.
    fn eq(&self, other: &Self) -> bool {
        self.0.compare(&other.0) == Some(std::cmp::Ordering::Equal)
    }
}

impl<const BITS: u32> Zero for Enclosed<BITS> {
    fn zero() -> Self {
        Enclosed(Ball::zero())
    }

    fn is_zero(&self) -> bool {
        self.sign() == Some(Sign::Zero)
    }
}

impl<const BITS: u32> One for Enclosed<BITS> {
    fn one() -> Self {
        Enclosed(Ball::one())
    }
}
