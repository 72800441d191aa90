//! A number as the unevaluated sum of two doubles.

use num_traits::{ToPrimitive, Zero};

use super::lanes::two_sum;
use crate::number::{Rational, rational};

/// hi + lo, |lo| ≤ ulp(hi)/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twofold {
    pub hi: f64,
    pub lo: f64,
}

impl Twofold {
    /// a + b, exactly.
    pub fn sum(a: f64, b: f64) -> Twofold {
        let (hi, lo) = two_sum(a, b);
        Twofold { hi, lo }
    }

    /// A half of it, exactly.
    pub fn half(self) -> Twofold {
        Twofold { hi: 0.5 * self.hi, lo: 0.5 * self.lo }
    }

    /// a + b to within 2^-104 (|a| + |b|).
    #[inline(always)]
    pub fn plus(self, other: Twofold) -> Twofold {
        let (hi, lo) = two_sum(self.hi, other.hi);
        Twofold::joined(hi, lo + (self.lo + other.lo))
    }

    /// a − b, likewise.
    #[inline(always)]
    pub fn minus(self, other: Twofold) -> Twofold {
        self.plus(Twofold { hi: -other.hi, lo: -other.lo })
    }

    /// a b to within 2^-101 relative.
    #[inline(always)]
    pub fn times(self, other: Twofold) -> Twofold {
        let hi = self.hi * other.hi;
        let lost = self.hi.mul_add(other.hi, -hi);
        Twofold::joined(hi, lost + self.hi.mul_add(other.lo, self.lo * other.hi))
    }

    /// a b to within 2^-103 relative; exact where b is a power of two.
    #[inline(always)]
    pub fn scaled(self, b: f64) -> Twofold {
        let hi = self.hi * b;
        Twofold::joined(hi, self.lo.mul_add(b, self.hi.mul_add(b, -hi)))
    }

    /// a/b to within 2^-103 relative.
    #[inline(always)]
    pub fn over(self, b: f64) -> Twofold {
        let hi = self.hi / b;
        Twofold::joined(hi, ((-hi).mul_add(b, self.hi) + self.lo) / b)
    }

    /// |a|.
    #[inline(always)]
    pub fn magnitude(self) -> Twofold {
        if self.hi < 0.0 { Twofold { hi: -self.hi, lo: -self.lo } } else { self }
    }

    /// hi + lo, |lo| ≤ |hi| (Dekker).
    #[inline(always)]
    fn joined(hi: f64, lo: f64) -> Twofold {
        let sum = hi + lo;
        Twofold { hi: sum, lo: lo - (sum - hi) }
    }

    /// a/b to within 2^-104 relative, for whole numbers that doubles hold.
    pub fn quotient(a: u64, b: u64) -> Option<Twofold> {
        const EXACT: u64 = 1 << 53;
        let (x, y) = (a as f64, b as f64);
        let hi = x / y;
        // The quotient's remainder is a double.
        (a.max(b) <= EXACT).then_some(Twofold { hi, lo: (-hi).mul_add(y, x) / y })
    }

    /// x to within 2^-104 relative.
    pub fn from_rational(x: &Rational) -> Twofold {
        if let (Some(a), Some(b)) = (x.numer().to_u64(), x.denom().to_u64())
            && let Some(quotient) = Twofold::quotient(a, b)
        {
            return quotient;
        }
        let hi = rational::to_f64(x);
        let rest = rational::from_f64_exact(hi).map_or_else(Rational::zero, |hi| x - hi);
        Twofold { hi, lo: rational::to_f64(&rest) }
    }
}
