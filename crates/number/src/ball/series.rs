//! Power series in fixed-point arithmetic, with their error bound: the kernel of all functions.

use num_bigint::BigInt;
use num_traits::{One, Signed};

use super::{Ball, Magnitude};

/// Σ p_k / e_k with p_0 = 1, p_k = p_{k−1} y / d_k, e_0 = 1, where `divisor`(k) = d_k ≥ 1 and
/// `weight`(k) = e_k ≥ 1, to about `fraction` bits after the point.
///
/// Requires |y| ≤ 1/2, or |y| ≤ 1 and d_k ≥ 2k.
///
/// Error, in units u = 2^-fraction. Rounding: p_k is off by ε_k ≤ (|y| ε_{k−1} + 1)/d_k + 1 ≤ ε_{k−1}/2 + 2,
/// so ε_k ≤ 4, and p_k/e_k by at most 5. Truncation: the loop ends when the computed |p_k| ≤ u, the true one
/// is ≤ 5u, and the ratio of terms is ≤ 1/2, so the tail is ≤ 5u. Argument: |dS/dy| ≤ Σ k 2^{−(k−1)} = 4 in
/// the first case, and ≤ Σ k/(2^k k!) < 1 in the second, so an argument off by η costs at most 4 η, and its
/// own rounding 4u. In all (5N + 9) u + 4η after N terms.
pub(super) fn sum(y: &Ball, fraction: u32, divisor: fn(u64) -> u64, weight: fn(u64) -> u64) -> Ball {
    let exp = -i64::from(fraction);
    let (step, _) = y.mid_scaled(i64::from(fraction));
    let mut power = BigInt::one() << fraction;
    let mut total = power.clone();
    let mut terms = 0;
    while power.magnitude().bits() > 1 {
        terms += 1;
        power = (power * &step) >> fraction;
        if divisor(terms) > 1 {
            power /= divisor(terms);
        }
        if weight(terms) > 1 { total += &power / weight(terms) } else { total += &power }
    }
    debug_assert!(step.abs().bits() <= u64::from(fraction), "|y| < 1");
    let error = Magnitude::new(5 * terms + 9, exp).plus(y.radius().scale2(2));
    Ball::rounded(total, exp, error, fraction + 2)
}

/// d_k = 1 or e_k = 1: no division.
pub(super) fn unit(_: u64) -> u64 {
    1
}

/// The odd numbers 2k + 1: the weights of atan and atanh.
pub(super) fn odd(k: u64) -> u64 {
    2 * k + 1
}
