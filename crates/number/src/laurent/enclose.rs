//! Signs, balls and doubles of elements of ℚ[π, 1/π].

use num_traits::Signed;

use super::Laurent;
use crate::{Ball, ExactSign, Real, Sign, Twofold, rational};

/// The precision of the first attempt; every further attempt doubles it.
const FIRST_BITS: u32 = 128;

impl ExactSign for Laurent {
    /// 0 iff there are no terms, π being transcendental; else from balls of doubling precision, which
    /// end because the number is not 0.
    fn sign(&self) -> Sign {
        let Some((_, first)) = self.terms.first() else { return Sign::Zero };
        // π > 0: terms of one sign need no enclosure.
        if self.terms.iter().all(|(_, c)| c.is_positive() == first.is_positive()) {
            return first.sign();
        }
        self.refined(|ball| ball.sign())
    }
}

impl Real for Laurent {
    fn enclosure(&self, bits: u32) -> Ball {
        if let Some(rational) = self.as_rational() {
            return Ball::from_rational(&rational, bits + 2);
        }
        Ball::to_accuracy(bits, |working| self.evaluated(working))
    }

    /// For c π^k with |k| ≤ 2: c is within 2^-104, π² within 2^-100.9, and a product or a quotient adds
    /// 2^-100 at most.
    fn two_doubles(&self) -> Option<(f64, f64)> {
        let (k, c) = self.as_monomial()?;
        let (hi, lo) = c.two_doubles()?;
        let c = Twofold { hi, lo };
        let Twofold { hi, lo } = match k {
            -2 => c.divided_by(Twofold::PI.times(Twofold::PI)),
            -1 => c.divided_by(Twofold::PI),
            0 => c,
            1 => c.times(Twofold::PI),
            2 => c.times(Twofold::PI.times(Twofold::PI)),
            _ => return None,
        };
        Some((hi, lo))
    }
}

impl Laurent {
    /// The double nearest to the number (ties, which only rationals can meet, to even).
    pub fn to_f64(&self) -> f64 {
        if let Some(rational) = self.as_rational() {
            return rational::to_f64(&rational);
        }
        self.refined(|ball| same(rational::to_f64(&ball.lower()), rational::to_f64(&ball.upper())))
    }

    /// The largest double ≤ the number and the smallest double ≥ it: equal iff the number is a double.
    pub fn enclose_f64(&self) -> (f64, f64) {
        if let Some(rational) = self.as_rational() {
            return rational::enclose_f64(&rational);
        }
        // An irrational number is no double, so the ends of a small ball have the same neighbours.
        self.refined(|ball| same(rational::enclose_f64(&ball.lower()), rational::enclose_f64(&ball.upper())))
    }

    /// The first answer to `question` among balls of doubling precision. Ends if small balls have an answer.
    fn refined<T>(&self, question: impl Fn(&Ball) -> Option<T>) -> T {
        let mut bits = FIRST_BITS;
        loop {
            if let Some(answer) = question(&self.evaluated(bits)) {
                return answer;
            }
            bits *= 2;
        }
    }

    /// A ball about Σ c_k π^k by Horner's rule, all steps rounded to `bits` bits.
    fn evaluated(&self, bits: u32) -> Ball {
        let (mut value, mut exponent) = (Ball::zero(), self.terms.last().map_or(0, |(k, _)| *k));
        for (k, c) in self.terms.iter().rev() {
            value = value.mul(&pi_power(exponent - k, bits), bits).add(&Ball::from_rational(c, bits), bits);
            exponent = *k;
        }
        value.mul(&pi_power(exponent, bits), bits)
    }
}

fn same<T: PartialEq>(a: T, b: T) -> Option<T> {
    (a == b).then_some(a)
}

/// π^k by repeated squaring.
fn pi_power(k: i32, bits: u32) -> Ball {
    let size = k.unsigned_abs();
    let mut power = Ball::one();
    for bit in (0..32 - size.leading_zeros()).rev() {
        power = power.square(bits);
        if size >> bit & 1 == 1 {
            power = power.mul(&Ball::pi(bits), bits);
        }
    }
    if k < 0 { Ball::one().div(&power, bits).expect("π^k > 0") } else { power }
}
