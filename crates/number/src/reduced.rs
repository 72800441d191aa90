//! Sums and products of fractions in lowest terms, with Lehmer's greatest common divisor.
//!
//! The library's own divisor is the binary one: on numbers of a thousand bits, as the coefficients of a long
//! word have, it was nineteen twentieths of all work.

use num_bigint::{BigInt, BigUint, Sign};
use num_integer::Integer;
use num_traits::{One, ToPrimitive, Zero};

use super::Rational;

/// Leading bits that stand for a number: quotients of these are found in one register, with room for the
/// cofactors beside them.
const LEADING: u64 = 62;

/// a b in lowest terms: each numerator and the other's denominator have the only common factors (Knuth,
/// The Art of Computer Programming, volume 2, 4.5.1).
pub fn product(a: &Rational, b: &Rational) -> Rational {
    if a.is_zero() || b.is_zero() {
        return Rational::zero();
    }
    let (first, second) = (common(a.numer(), b.denom()), common(b.numer(), a.denom()));
    let numer = without(a.numer(), &first) * without(b.numer(), &second);
    Rational::new_raw(numer, without(a.denom(), &second) * without(b.denom(), &first))
}

/// a + b in lowest terms: beside the denominators' common divisor g, the sum's numerator has common factors
/// with g alone (the same section).
pub fn sum(a: &Rational, b: &Rational) -> Rational {
    let g = common(a.denom(), b.denom());
    let (a_rest, b_rest) = (without(a.denom(), &g), without(b.denom(), &g));
    let numer = a.numer() * &b_rest + b.numer() * &a_rest;
    if numer.is_zero() {
        return Rational::zero();
    }
    let left = if g.is_one() { g } else { common(&numer, &g) };
    Rational::new_raw(without(&numer, &left), a_rest * without(b.denom(), &left))
}

/// Exact.
fn without(n: &BigInt, divisor: &BigInt) -> BigInt {
    if divisor.is_one() { n.clone() } else { n / divisor }
}

/// The greatest common divisor of two numbers that are not zero.
fn common(a: &BigInt, b: &BigInt) -> BigInt {
    if a.magnitude().is_one() || b.magnitude().is_one() {
        return BigInt::one();
    }
    // The denominators of doubles: a divisor would cost as much as some products of matrices.
    let zeros = [a, b].map(|n| n.trailing_zeros().unwrap_or_default());
    if a.bits() == zeros[0] + 1 || b.bits() == zeros[1] + 1 {
        return BigInt::one() << zeros[0].min(zeros[1]);
    }
    BigInt::from_biguint(Sign::Plus, gcd(a.magnitude().clone(), b.magnitude().clone()))
}

/// The greatest common divisor; of n and 0, n. Lehmer's: as long as the leading digits of both tell the
/// quotients of Euclid's algorithm for sure, these are collected in four cofactors (Knuth, algorithm L).
pub fn gcd(mut a: BigUint, mut b: BigUint) -> BigUint {
    if a < b {
        std::mem::swap(&mut a, &mut b);
    }
    while b.bits() > LEADING {
        let shift = a.bits() - LEADING;
        let [first, second] = [&a, &b].map(|n| (n >> shift).to_i64().expect("62 bits"));
        let [[p, q], [r, s]] = cofactors(first, second);
        if q == 0 {
            let rest = &a % &b;
            (a, b) = (b, rest);
        } else {
            (a, b) = (combined(p, &a, q, &b), combined(r, &a, s, &b));
        }
    }
    if b.is_zero() {
        return a;
    }
    let small = b.to_u64().expect("62 bits");
    small.gcd(&(a % small).to_u64().expect("less than a divisor of 62 bits")).into()
}

/// The steps of Euclid's algorithm that all numbers with these leading digits have in common.
fn cofactors(mut x: i64, mut y: i64) -> [[i64; 2]; 2] {
    let ([mut p, mut q], [mut r, mut s]) = ([1, 0], [0, 1]);
    while y + r != 0 && y + s != 0 {
        let quotient = (x + p) / (y + r);
        if quotient != (x + q) / (y + s) {
            break;
        }
        (p, r) = (r, p - quotient * r);
        (q, s) = (s, q - quotient * s);
        (x, y) = (y, x - quotient * y);
    }
    [[p, q], [r, s]]
}

/// p a + q b ≥ 0, p and q of opposite signs.
fn combined(p: i64, a: &BigUint, q: i64, b: &BigUint) -> BigUint {
    let (one, other) = (a * p.unsigned_abs(), b * q.unsigned_abs());
    if p > 0 || q < 0 { one - other } else { other - one }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rational::{from_f64_exact, ratio};
    use proptest::prelude::*;

    /// Numbers of up to some 700 bits, of both signs.
    fn whole() -> impl Strategy<Value = BigInt> {
        (prop::collection::vec(any::<u32>(), 0..22), any::<bool>()).prop_map(|(digits, negative)| {
            BigInt::from_slice(if negative { Sign::Minus } else { Sign::Plus }, &digits)
        })
    }

    #[test]
    fn fractions_of_doubles_are_those_of_the_library() {
        let doubles = [1.0, -0.75, 6.0, 0.3, -1e300, 5e-324, 0.123_456_789];
        let mut all: Vec<_> = doubles.into_iter().filter_map(from_f64_exact).collect();
        all.extend([ratio(1, 3), ratio(-6, 35), ratio(12, 1), ratio(3, 64)]);
        for a in &all {
            for b in &all {
                let results = [(product(a, b), a * b), (product(a, &b.recip()), a / b), (sum(a, b), a + b)];
                for (found, right) in results {
                    assert_eq!((found.numer(), found.denom()), (right.numer(), right.denom()), "{a}, {b}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn the_divisor_is_the_one_of_the_library(a in whole(), b in whole(), c in whole()) {
            for [a, b] in [[&a * &c, &b * &c], [a.clone(), &a * &b], [a.clone(), b.clone()], [a, c]] {
                let [a, b] = [a, b].map(|n| n.magnitude().clone());
                prop_assert_eq!(gcd(a.clone(), b.clone()), a.gcd(&b));
            }
        }

        #[test]
        fn fractions_are_those_of_the_library(a in whole(), b in whole(), c in whole(), d in whole(), e in whole()) {
            let fraction = |n: &BigInt, d: &BigInt| Rational::new(n.clone(), if d.is_zero() { BigInt::one() } else { d.clone() });
            let (x, y) = (fraction(&(&a * &e), &(&b * &c)), fraction(&c, &(&d * &b)));
            let (found, right) = (product(&x, &y), &x * &y);
            prop_assert_eq!((found.numer(), found.denom()), (right.numer(), right.denom()));
            for y in [y.clone(), -&x, &y - &x] {
                let (found, right) = (sum(&x, &y), &x + &y);
                prop_assert_eq!((found.numer(), found.denom()), (right.numer(), right.denom()));
            }
        }
    }
}
