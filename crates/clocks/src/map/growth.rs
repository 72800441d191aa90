//! Growth from where the filter's orbits end, with a proven bound.
//!
//! With AD − BC = 1, let ρ be the smaller by the larger of |AD| and |BC| inside a tongue. Then
//!
//! ```text
//!     ρ = tanh²(ln μ / 2),        ln μ = 2 artanh √ρ,                                          (1)
//!     z = min(|AD|, |BC|) = sinh²(ln μ / 2),        ln μ = ln z + 2 ln(1 + √(1 + 1/z)).        (2)
//! ```
//!
//! ρ = (B/D)(C/A) or its reciprocal depends on the *directions* of the two orbits alone, which the filter
//! knows far better than their lengths: (1) is good up to the edge of a tongue. Where growth is strong, ρ is
//! next to 1 and (2) is better, since d ln μ ≤ dz/z. Both bounds are at hand, and the smaller one is taken.

use crate::orbit::filter::{End, Ends};
use number::Interval;
use number::U;

/// Relative errors of factors are added up as long as their sum R is at most this: then products and
/// quotients of them are off by less than 1.01 R.
const LARGEST_ERROR_SUM: f64 = 1.0 / 300.0;

/// Covers terms of second order.
const SECOND_ORDER: f64 = 1.01;

/// ln μ of a hyperbolic pair, side 1 for Tr > 2 and −1 for Tr < −2; `None` where the bounds say too little.
pub(super) fn ln_multiplier(ends: &Ends, side: i8) -> Option<Interval> {
    let (even, odd) = (&ends.even, &ends.odd);
    let ([a, c], [b, d]) = (components(even), components(odd));
    let rho =
        if side > 0 { (odd.x / odd.v) * (even.v / even.x) } else { (odd.v / odd.x) * (even.x / even.v) };
    let [one, two] = if side > 0 { [b, c] } else { [a, d] };
    let z = if side > 0 { (odd.x * even.v).abs() } else { (even.x * odd.v).abs() };
    let by_direction = by_direction(rho, a + b + c + d);
    let lengths = 1.4 * (even.stretch + odd.stretch);
    let by_length = by_length(z, even.exponent + odd.exponent, one + two + lengths);
    match (by_direction, by_length) {
        (Some(x), Some(y)) => Some(if x.width() <= y.width() { x } else { y }),
        (x, y) => x.or(y),
    }
}

/// The relative errors of x and v, but for the length that they have in common.
fn components(end: &End) -> [f64; 2] {
    // |t| |(x, v)|/|(x, v)|² in each component; 1 + 8u covers the roundings of this.
    let slack = end.across / (end.x * end.x + end.v * end.v).sqrt() * (1.0 + 8.0 * U);
    [end.x, end.v].map(|component| slack / component.abs() + end.rounding)
}

/// By (1), from ρ computed with three roundings out of components with the relative errors that add up to
/// `error`.
fn by_direction(rho: f64, error: f64) -> Option<Interval> {
    let r = rho.sqrt();
    // ρ is off by this; 6u for the roundings of ρ and of its root. NaN fails.
    let off = SECOND_ORDER * (error + 6.0 * U) * rho;
    if !(error <= LARGEST_ERROR_SUM && off <= LARGEST_ERROR_SUM * (1.0 - rho)) {
        return None;
    }
    // d(2 artanh √ρ) = dρ / (√ρ (1 − ρ)).
    let error = SECOND_ORDER * off / (r * (1.0 - rho));
    let value = if r <= LARGEST { 2.0 * artanh(r) } else { ln((1.0 + r) / (1.0 - r), 0) };
    Some(Interval::around(value, error + EVALUATION * value))
}

/// By (2), from z 2^exponent, z rounded once, with the relative error `error`.
fn by_length(z: f64, exponent: i64, error: f64) -> Option<Interval> {
    // Below 1, (1) is the better one; a subnormal product has lost digits. NaN fails.
    let ln_z = ln(z, exponent);
    if !(error <= LARGEST_ERROR_SUM && z.is_normal() && ln_z >= 0.0) {
        return None;
    }
    // 1/z beside 1; nothing beside 50.
    let inverse = if ln_z > 50.0 { 0.0 } else { scaled(1.0 / z, -exponent) };
    let value = ln_z + 2.0 * ln(1.0 + (1.0 + inverse).sqrt(), 0);
    Some(Interval::around(value, SECOND_ORDER * (error + 2.0 * U) + EVALUATION * value))
}

/// The relative error of a logarithm, evaluated: [`ln`] is within 16u, its arguments (1 + r)/(1 − r) and
/// 1 + √(1 + 1/z) within 3u where it is 1/3 at least.
const EVALUATION: f64 = 32.0 * U;

/// x 2^exponent, exactly where that is a normal number.
fn scaled(x: f64, exponent: i64) -> f64 {
    let half = exponent / 2;
    [half, exponent - half].into_iter().fold(x, |x, exponent| x * 2f64.powi(exponent as i32))
}

/// ln(x 2^exponent) for a normal x > 0, within 16u relatively.
///
/// x = m 2^k with m in [√½, √2] and y = (m − 1)/(m + 1): m − 1 is exact, so y is within 2u, 2 artanh y within
/// 6u, and k ln 2, which is at least twice as large unless k = 0, within 2u.
fn ln(x: f64, exponent: i64) -> f64 {
    const ONE: u64 = 0x3ff0_0000_0000_0000;
    let bits = x.to_bits();
    let mantissa = f64::from_bits(bits & 0x000f_ffff_ffff_ffff | ONE);
    let halved = mantissa > std::f64::consts::SQRT_2;
    let m = if halved { 0.5 * mantissa } else { mantissa };
    let k = (bits >> 52) as i64 - 1023 + i64::from(halved) + exponent;
    let log = 2.0 * artanh((m - 1.0) / (m + 1.0));
    if k == 0 { log } else { k as f64 * std::f64::consts::LN_2 + log }
}

/// (√2 − 1)/(√2 + 1), rounded up.
const LARGEST: f64 = 0.171_573;

/// artanh y for |y| ≤ [`LARGEST`], within 4u relatively: the series up to y^23, whose rest is below 2^-58.
fn artanh(y: f64) -> f64 {
    let square = y * y;
    let series = (1..12).rev().fold(0.0, |sum, n| (sum + 1.0 / f64::from(2 * n + 1)) * square);
    series.mul_add(y, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::{Ball, Rational};

    fn exact(x: f64) -> Ball {
        Ball::from_rational(&Rational::from_float(x).unwrap(), 200)
    }

    /// |x / reference − 1| ≤ most · u.
    fn within(x: f64, reference: &Ball, most: f64) {
        let off = exact(x).sub(reference, 200).abs().div(&reference.abs(), 200).unwrap();
        assert!(off.to_f64_enclosure().1 <= most * U, "{x}: {} u", off.mid_f64() / U);
    }

    #[test]
    fn logarithms_are_as_near_as_they_say() {
        for n in 1..4000 {
            let x = 2f64.powf(f64::from(n - 2000) / 500.0) * (1.0 + f64::from(n) * 1e-7);
            if x != 1.0 {
                within(ln(x, 0), &exact(x).ln(200).unwrap(), 16.0);
            }
            within(ln(x, 700), &exact(x).scale2(700).ln(200).unwrap(), 16.0);
        }
        for x in [f64::MIN_POSITIVE, 1f64.next_up(), 1f64.next_down(), f64::MAX, 0.7071067811865475] {
            within(ln(x, 0), &exact(x).ln(200).unwrap(), 16.0);
        }
    }

    #[test]
    fn inverse_tangents_are_as_near_as_they_say() {
        for n in 1..2000 {
            let y = LARGEST * f64::from(n) / 2000.0;
            let (one, y_exact) = (Ball::one(), exact(y));
            let quotient = one.add(&y_exact, 200).div(&one.sub(&y_exact, 200), 200).unwrap();
            within(artanh(y), &quotient.ln(200).unwrap().scale2(-1), 4.0);
        }
        const { assert!((1.0 - LARGEST) / (1.0 + LARGEST) * std::f64::consts::SQRT_2 < 1.0) };
    }
}
