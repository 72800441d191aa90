//! π and ln 2, from arctangents of reciprocals of integers, kept per thread.

use std::cell::RefCell;

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::{Ball, Magnitude};

/// The longest value of a constant so far, with the precision that was asked for.
type Cache = RefCell<Option<(u32, Ball)>>;

thread_local! {
    static PI: Cache = const { RefCell::new(None) };
    static LN2: Cache = const { RefCell::new(None) };
}

impl Ball {
    /// π = 16 arctan(1/5) − 4 arctan(1/239) (Machin).
    pub fn pi(bits: u32) -> Ball {
        PI.with(|cache| cached(cache, bits, |w| reciprocals(w, true, &[(16, 5), (-4, 239)])))
    }

    /// ln 2 = 18 artanh(1/26) − 2 artanh(1/4801) + 8 artanh(1/8749).
    pub fn ln2(bits: u32) -> Ball {
        LN2.with(|cache| cached(cache, bits, |w| reciprocals(w, false, &[(18, 26), (-2, 4801), (8, 8749)])))
    }
}

/// The constant to `bits` bits: from the cache if that is long enough, else computed and kept.
fn cached(cache: &Cache, bits: u32, compute: impl Fn(u32) -> Ball) -> Ball {
    let mut cache = cache.borrow_mut();
    if cache.as_ref().is_none_or(|(known, _)| *known < bits) {
        // At least 256 bits, and a fourth more than asked: the next request is then often served.
        let ample = (bits + bits / 4).max(256);
        *cache = Some((ample, compute(ample)));
    }
    let (_, value) = cache.as_ref().expect("just filled");
    value.round(bits)
}

/// Σ c arctan(1/n) if alternating, else Σ c artanh(1/n), over the pairs (c, n), to about `bits` bits.
fn reciprocals(bits: u32, alternating: bool, terms: &[(i64, u32)]) -> Ball {
    let fraction = bits + 32;
    let mut total = BigInt::zero();
    let mut error = 0;
    for &(coefficient, n) in terms {
        let (value, units) = reciprocal(fraction, alternating, n);
        total += value * coefficient;
        error += units * coefficient.unsigned_abs();
    }
    let exp = -i64::from(fraction);
    Ball::rounded(total, exp, Magnitude::new(error, exp), bits + 8)
}

/// Σ_k (±1)^k n^−(2k+1) / (2k+1) in units of 2^-fraction, and a bound of the error in units.
///
/// The truncated powers are off by ε_k ≤ ε_{k−1}/n² + 1 ≤ 2, so each term by at most 3; the first power that
/// vanishes is in truth ≤ 2 units, so the tail is ≤ 3.
fn reciprocal(fraction: u32, alternating: bool, n: u32) -> (BigInt, u64) {
    let square = u64::from(n) * u64::from(n);
    let mut power = (BigInt::one() << fraction) / n;
    let mut total = BigInt::zero();
    let mut k = 0u64;
    while !power.is_zero() {
        let term = &power / (2 * k + 1);
        if alternating && k % 2 == 1 {
            total -= term
        } else {
            total += term
        }
        power /= square;
        k += 1;
    }
    (total, 3 * k + 3)
}
