//! Rounding of exact numbers to doubles: down, up, or to the nearest.
//!
//! A positive number enters as its leading 64 bits and a sticky flag; everything below is integer
//! arithmetic on the layout of IEEE 754 binary64, so subnormals and overflow need no special care
//! beyond the exponent range.

use num_bigint::{BigInt, BigUint, Sign as IntSign};
use num_integer::Integer;
use num_traits::{Float, ToPrimitive, Zero};

/// Ends of doubles that one sum or one product rounded, moved outward: what is 0 is so exactly, unless a
/// product vanished.
pub fn outward((lo, hi): (f64, f64)) -> (f64, f64) {
    (if lo == 0.0 { 0.0 } else { lo.next_down() }, if hi == 0.0 { 0.0 } else { hi.next_up() })
}

/// 2^k: exact for −1022 ≤ k ≤ 1023, and as `2f64.powi(k)` has it beyond. `powi` multiplies in a loop; this
/// writes the bits of the exponent.
#[inline]
pub fn power_of_two(k: i32) -> f64 {
    if (-1022..=1023).contains(&k) { f64::from_bits(((k + 1023) as u64) << 52) } else { 2f64.powi(k) }
}

/// A positive number x with `lead 2^exp <= x < (lead + 1) 2^exp`, where lead has 64 significant bits.
struct Leading {
    lead: u64,
    exp: i64,
    /// x is larger than lead 2^exp.
    sticky: bool,
}

/// The two doubles around a positive number, and which one is nearer.
struct Around {
    down: f64,
    up: f64,
    nearest: f64,
}

impl Leading {
    /// The leading bits of `(integer + something in [0, 1)) 2^exp`, the something being 0 iff not sticky.
    fn of(integer: &BigUint, exp: i64, sticky: bool) -> Leading {
        let bits = integer.bits() as i64;
        if bits <= 64 {
            let lead = integer.to_u64().expect("64 bits") << (64 - bits);
            return Leading { lead, exp: exp + bits - 64, sticky };
        }
        let drop = (bits - 64) as u64;
        let lead = (integer >> drop).to_u64().expect("64 bits");
        let dropped = integer.trailing_zeros().is_some_and(|zeros| zeros < drop);
        Leading { lead, exp: exp + bits - 64, sticky: sticky || dropped }
    }

    /// The leading bits of n/d, n and d positive.
    fn of_quotient(n: u64, d: u64) -> Leading {
        // n at the top of 128 bits: the quotient has 64 bits at least.
        let shift = 64 + n.leading_zeros();
        let (n, d) = (u128::from(n) << shift, u128::from(d));
        let (quotient, remainder) = (n / d, n % d);
        let drop = 64 - quotient.leading_zeros();
        let dropped = quotient & ((1 << drop) - 1) != 0;
        let exp = i64::from(drop) - i64::from(shift);
        Leading { lead: (quotient >> drop) as u64, exp, sticky: remainder != 0 || dropped }
    }

    fn around(&self) -> Around {
        let top = self.exp.saturating_add(63); // x in [2^top, 2^(top + 1))
        if top > 1023 {
            return Around { down: f64::MAX, up: f64::INFINITY, nearest: f64::INFINITY };
        }
        // The last place of a double in this binade; subnormals share 2^-1074.
        let last = (top - 52).max(-1074);
        let shift = last - self.exp; // >= 11
        if shift > 64 {
            return Around { down: 0.0, up: f64::from_bits(1), nearest: 0.0 };
        }
        let kept = self.lead.checked_shr(shift as u32).unwrap_or(0);
        let rest = u128::from(self.lead) & ((1u128 << shift) - 1);
        let half = 1u128 << (shift - 1);
        // `kept` carries the implicit bit 52 of a normal number, which adds one to the exponent field.
        let bits = kept + (((top.max(-1023) + 1022).max(0) as u64) << 52);
        let (down, next) = (f64::from_bits(bits), f64::from_bits(bits + 1));
        let up = if rest == 0 && !self.sticky { down } else { next };
        let above_half = rest > half || (rest == half && (self.sticky || kept.is_odd()));
        Around { down, up, nearest: if above_half { next } else { down } }
    }
}

/// The double nearest to n/d, n and d positive, and the double nearest to what it lacks, but for 2^-51 of
/// that.
pub(super) fn short_quotient(n: u64, d: u64) -> (f64, f64) {
    let hi = Leading::of_quotient(n, d).around().nearest;
    // hi = m 2^e with m of 53 bits, and hi d differs from n by less than 2^e d: both are whole in units of
    // 2^min(e, 0).
    let (m, e, _) = Float::integer_decode(hi);
    let e = i32::from(e);
    let (n, product) = (i128::from(n) << (-e).max(0), (i128::from(m) << e.max(0)) * i128::from(d));
    (hi, (n - product) as f64 / d as f64 * power_of_two(e.min(0)))
}

/// The doubles around `numerator / denominator`, denominator > 0.
fn around_quotient(numerator: &BigUint, denominator: &BigUint) -> Around {
    // Numbers as people write them, many times faster.
    if let (Some(n @ 1..), Some(d)) = (numerator.to_u64(), denominator.to_u64()) {
        return Leading::of_quotient(n, d).around();
    }
    let shift = denominator.bits() as i64 - numerator.bits() as i64 + 66;
    let (quotient, remainder) = if shift >= 0 {
        (numerator << shift as u64).div_rem(denominator)
    } else {
        numerator.div_rem(&(denominator << (-shift) as u64))
    };
    Leading::of(&quotient, -shift, !remainder.is_zero()).around()
}

/// The double nearest to `numerator / denominator` (denominator > 0), ties to even.
pub(super) fn nearest_quotient(numerator: &BigInt, denominator: &BigInt) -> f64 {
    let nearest = || around_quotient(numerator.magnitude(), denominator.magnitude()).nearest;
    match numerator.sign() {
        IntSign::NoSign => 0.0,
        IntSign::Plus => nearest(),
        IntSign::Minus => -nearest(),
    }
}

/// The largest double <= and the smallest double >= `numerator / denominator` (denominator > 0).
pub(super) fn enclose_quotient(numerator: &BigInt, denominator: &BigInt) -> (f64, f64) {
    if numerator.is_zero() {
        return (0.0, 0.0);
    }
    signed(numerator.sign(), around_quotient(numerator.magnitude(), denominator.magnitude()))
}

/// The largest double <= and the smallest double >= `integer 2^exp`.
pub(super) fn enclose_dyadic(integer: &BigInt, exp: i64) -> (f64, f64) {
    if integer.is_zero() {
        return (0.0, 0.0);
    }
    signed(integer.sign(), Leading::of(integer.magnitude(), exp, false).around())
}

/// The double nearest to `integer 2^exp`, ties to even.
pub(super) fn nearest_dyadic(integer: &BigInt, exp: i64) -> f64 {
    let nearest = || Leading::of(integer.magnitude(), exp, false).around().nearest;
    match integer.sign() {
        IntSign::NoSign => 0.0,
        IntSign::Plus => nearest(),
        IntSign::Minus => -nearest(),
    }
}

fn signed(sign: IntSign, around: Around) -> (f64, f64) {
    if sign == IntSign::Minus { (-around.up, -around.down) } else { (around.down, around.up) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rational;
    use num_traits::Signed;
    use proptest::prelude::*;

    proptest! {
        /// Quotients by long numbers equal those by short ones, next to doubles and next to halves between
        /// them, too.
        #[test]
        fn short_quotients_are_rounded_as_long_ones(
            n in 1u64.., d in 1u64.., small in 0u32..64, coarse in 0u32..64, double in any::<bool>(),
        ) {
            let d = if double { 1 << coarse } else { d >> coarse | 1 };
            let n = n >> small | 1;
            let long = (BigUint::from(1u8) << 64) + 1u8;
            let short = around_quotient(&n.into(), &d.into());
            let other = around_quotient(&(&long * n), &(&long * d));
            let bits = |around: &Around| [around.down, around.up, around.nearest].map(f64::to_bits);
            prop_assert_eq!(bits(&short), bits(&other));
            // In two doubles: n/d = hi + lo to within 2^-104.
            let (hi, lo) = short_quotient(n, d);
            prop_assert_eq!(hi, short.nearest);
            let exact = |x: f64| Rational::from_float(x).unwrap();
            let off = (exact(hi) + exact(lo)) * Rational::new(d.into(), n.into()) - exact(1.0);
            prop_assert!(off.abs() * (Rational::from_integer(BigInt::from(1) << 104)) <= exact(1.0), "{off}");
        }
    }
}
