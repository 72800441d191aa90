//! Enclosures of a function and of its derivative: how much it changes across an interval.

use num_traits::{One, Zero};

use super::operators::ring_operators;
use super::{Ball, Sign};

/// f and f' of one variable, each in a ball of `BITS` bits. Over an interval of the variable both contain
/// every value there.
#[derive(Clone, Debug)]
pub struct Jet<const BITS: u32> {
    pub value: Ball,
    pub slope: Ball,
}

impl<const BITS: u32> Jet<BITS> {
    /// A number that does not vary.
    pub fn constant(value: Ball) -> Self {
        Jet { value, slope: Ball::zero() }
    }

    /// The variable itself.
    pub fn variable(value: Ball) -> Self {
        Jet { value, slope: Ball::one() }
    }

    /// f of this, of derivative f'.
    pub fn chained(&self, value: Ball, derivative: &Ball) -> Self {
        Jet { value, slope: self.slope.mul(derivative, BITS) }
    }

    fn sum(&self, other: &Self) -> Self {
        Jet { value: self.value.add(&other.value, BITS), slope: self.slope.add(&other.slope, BITS) }
    }

    fn difference(&self, other: &Self) -> Self {
        Jet { value: self.value.sub(&other.value, BITS), slope: self.slope.sub(&other.slope, BITS) }
    }

    fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.value.mul(&other.slope, BITS), self.slope.mul(&other.value, BITS));
        Jet { value: self.value.mul(&other.value, BITS), slope: a.add(&b, BITS) }
    }

    fn negated(&self) -> Self {
        Jet { value: self.value.neg(), slope: self.slope.neg() }
    }
}

ring_operators!([const BITS: u32] Jet<BITS>, |x| Jet::constant(Ball::from_rational(x, BITS)));

impl<const BITS: u32> PartialEq for Jet<BITS> {
    /// Both are one number with one slope, and the same.
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &Ball, b: &Ball| a.compare(b) == Some(std::cmp::Ordering::Equal);
        same(&self.value, &other.value) && same(&self.slope, &other.slope)
    }
}

impl<const BITS: u32> Zero for Jet<BITS> {
    fn zero() -> Self {
        Jet::constant(Ball::zero())
    }

    fn is_zero(&self) -> bool {
        self.value.sign() == Some(Sign::Zero) && self.slope.sign() == Some(Sign::Zero)
    }
}

impl<const BITS: u32> One for Jet<BITS> {
    fn one() -> Self {
        Jet::constant(Ball::one())
    }
}
