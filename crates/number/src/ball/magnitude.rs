//! Upper bounds of errors: nonnegative floating numbers of 32 bits whose operations round up.

use num_bigint::BigUint;

/// The number `mantissa 2^exp`: 0, or 2^31 <= mantissa < 2^32.
///
/// Every operation returns an upper bound of the exact result, at most 2^-30 too large relatively.
#[derive(Clone, Copy, Debug)]
pub(super) struct Magnitude {
    mantissa: u64,
    exp: i64,
}

impl Magnitude {
    pub(super) const ZERO: Magnitude = Magnitude { mantissa: 0, exp: 0 };

    /// An upper bound of `integer 2^exp`.
    pub(super) fn new(integer: u64, exp: i64) -> Magnitude {
        if integer == 0 {
            return Magnitude::ZERO;
        }
        let bits = 64 - i64::from(integer.leading_zeros());
        if bits <= 32 {
            return Magnitude { mantissa: integer << (32 - bits), exp: exp + bits - 32 };
        }
        let mantissa = integer.div_ceil(1 << (bits - 32));
        if mantissa == 1 << 32 {
            return Magnitude { mantissa: 1 << 31, exp: exp + bits - 31 };
        }
        Magnitude { mantissa, exp: exp + bits - 32 }
    }

    /// The power 2^exp.
    pub(super) fn power_of_two(exp: i64) -> Magnitude {
        Magnitude::new(1, exp)
    }

    /// An upper bound of `integer 2^exp`.
    pub(super) fn upper(integer: &BigUint, exp: i64) -> Magnitude {
        let (lead, dropped) = leading(integer);
        if dropped == 0 { Magnitude::new(lead, exp) } else { Magnitude::new(lead + 1, exp + dropped) }
    }

    /// A lower bound of `integer 2^exp`, the one that divisors need.
    pub(super) fn lower(integer: &BigUint, exp: i64) -> Magnitude {
        let (lead, dropped) = leading(integer);
        let surplus = 32 - i64::from(lead.leading_zeros()); // bits beyond 32
        if surplus > 0 {
            Magnitude { mantissa: lead >> surplus, exp: exp + dropped + surplus }
        } else {
            Magnitude::new(lead, exp + dropped)
        }
    }

    pub(super) fn is_zero(self) -> bool {
        self.mantissa == 0
    }

    /// The exponent t with self < 2^t <= 2 self; `None` for 0.
    pub(super) fn top(self) -> Option<i64> {
        (self.mantissa != 0).then_some(self.exp + 32)
    }

    /// Whether self ≥ other.
    pub(super) fn at_least(self, other: Magnitude) -> bool {
        let order =
            |magnitude: Magnitude| (!magnitude.is_zero()).then_some((magnitude.exp, magnitude.mantissa));
        order(self) >= order(other)
    }

    /// self + other, rounded up.
    pub(super) fn plus(self, other: Magnitude) -> Magnitude {
        if self.mantissa == 0 {
            return other;
        }
        if other.mantissa == 0 {
            return self;
        }
        let (large, small) = if self.exp >= other.exp { (self, other) } else { (other, self) };
        let gap = large.exp - small.exp;
        let aligned = if gap < 64 { small.mantissa.div_ceil(1 << gap) } else { 1 };
        Magnitude::new(large.mantissa + aligned, large.exp)
    }

    /// self · other, rounded up.
    pub(super) fn times(self, other: Magnitude) -> Magnitude {
        Magnitude::new(self.mantissa * other.mantissa, self.exp + other.exp)
    }

    /// An upper bound of self / divisor, where divisor > 0 is a lower bound of the true divisor.
    pub(super) fn over(self, divisor: Magnitude) -> Magnitude {
        let quotient = (self.mantissa << 32).div_ceil(divisor.mantissa);
        Magnitude::new(quotient, self.exp - divisor.exp - 32)
    }

    /// self 2^k, exactly.
    pub(super) fn scale2(self, k: i64) -> Magnitude {
        if self.is_zero() { self } else { Magnitude { exp: self.exp + k, ..self } }
    }

    /// The least integer >= self / 2^exp.
    ///
    /// Requires self <= 2^(exp + 32).
    pub(super) fn units(self, exp: i64) -> u64 {
        let drop = exp - self.exp;
        match drop {
            _ if self.mantissa == 0 => 0,
            ..=0 => self.mantissa << -drop,
            1..64 => self.mantissa.div_ceil(1 << drop),
            _ => 1,
        }
    }
}

/// The leading bits (33 to 63 of them, or the whole integer if it is short) and how many were left out.
fn leading(integer: &BigUint) -> (u64, i64) {
    let mut digits = integer.iter_u64_digits();
    let count = digits.len() as i64;
    let (Some(high), low) = (digits.next_back(), digits.next_back()) else { return (0, 0) };
    let Some(low) = low else {
        return if high >> 63 == 0 { (high, 0) } else { (high >> 1, 1) };
    };
    let drop = 65 - high.leading_zeros(); // of the 128 bits of (high, low): keeps 63
    let lead = ((u128::from(high) << 64 | u128::from(low)) >> drop) as u64;
    (lead, i64::from(drop) + 64 * (count - 2))
}
