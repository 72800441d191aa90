//! A number as the unevaluated sum of two doubles.

use num_traits::{ToPrimitive, Zero};

use super::lanes::two_sum;
use crate::number::{Rational, rational};

/// hi + lo, |lo| ≤ ulp(hi)/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Twofold {
    pub hi: f64,
    pub lo: f64,
}

impl Twofold {
    /// a + b, exactly.
    pub fn sum(a: f64, b: f64) -> Twofold {
        let (hi, lo) = two_sum(a, b);
        Twofold { hi, lo }
    }

    /// x to within 2^-104 relative.
    pub fn from_rational(x: &Rational) -> Twofold {
        const EXACT: u64 = 1 << 53;
        if let (Some(a), Some(b)) = (x.numer().to_u64(), x.denom().to_u64())
            && a.max(b) <= EXACT
        {
            let (a, b) = (a as f64, b as f64);
            let hi = a / b;
            return Twofold { hi, lo: (-hi).mul_add(b, a) / b };
        }
        let hi = rational::to_f64(x);
        let rest = rational::from_f64_exact(hi).map_or_else(Rational::zero, |hi| x - hi);
        Twofold { hi, lo: rational::to_f64(&rest) }
    }
}
