//! Sums, products, quotients and square roots of balls.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, Zero};

use super::{Ball, Magnitude};

/// Bits kept below the working precision while a sum is aligned, so that alignment costs next to nothing.
const GUARD: i64 = 8;

/// Two radii are aligned exactly if their exponents differ by no more than this.
const RADIUS_GAP: i64 = 20;

impl Ball {
    /// x + y.
    pub fn add(&self, other: &Ball, bits: u32) -> Ball {
        let (Some(top), Some(other_top)) = (self.top(), other.top()) else {
            let sum = if self.top().is_none() { other } else { self };
            return sum.round(bits);
        };
        // Digits below `floor` matter neither to the rounded sum nor beside a radius that is there anyway.
        let mut floor = top.max(other_top) - i64::from(bits) - GUARD;
        for ball in [self, other] {
            if ball.rad > 0 {
                floor = floor.max(ball.exp - RADIUS_GAP);
            }
        }
        let exp = floor.max(self.exp.min(other.exp));
        let (mut mid, mut error) = self.aligned(exp);
        let (other_mid, other_error) = other.aligned(exp);
        mid += other_mid;
        error = error.plus(other_error);
        Ball::rounded(mid, exp, error, bits)
    }

    /// The midpoint in units of 2^exp, rounded down, and the radius plus what rounding lost (< 1 unit).
    fn aligned(&self, exp: i64) -> (BigInt, Magnitude) {
        let shift = self.exp - exp;
        if shift >= 0 {
            return (&self.mid << shift, self.radius());
        }
        let inexact = self.mid.trailing_zeros().is_some_and(|zeros| zeros < shift.unsigned_abs());
        let lost = if inexact { Magnitude::power_of_two(exp) } else { Magnitude::ZERO };
        (&self.mid >> -shift, self.radius().plus(lost))
    }

    /// x − y.
    pub fn sub(&self, other: &Ball, bits: u32) -> Ball {
        self.add(&other.neg(), bits)
    }

    /// −x, exactly.
    #[allow(clippy::should_implement_trait)] // beside add(bits), mul(bits), ... an operator would stand alone
    pub fn neg(&self) -> Ball {
        Ball { mid: -&self.mid, ..*self }
    }

    /// |x|: exact midpoints unless the ball holds both signs.
    pub fn abs(&self) -> Ball {
        if self.rad == 0 || !self.contains_zero() {
            return Ball { mid: self.mid.abs(), ..*self };
        }
        // [0, h] 2^exp with h = |mid| + rad is h ± h in units of 2^(exp − 1).
        let top: BigInt = self.mid.abs() + self.rad;
        let radius = Magnitude::upper(top.magnitude(), self.exp - 1);
        Ball::rounded(top, self.exp - 1, radius, 64)
    }

    /// x 2^k, exactly.
    pub fn scale2(&self, k: i64) -> Ball {
        let exp = self.exp.saturating_add(k);
        Ball { mid: self.mid.clone(), rad: self.rad, exp }.normalized()
    }

    /// x y.
    pub fn mul(&self, other: &Ball, bits: u32) -> Ball {
        let exp = self.exp + other.exp;
        // |x y − a b| ≤ |a| s + |b| r + r s for x = a ± r, y = b ± s.
        let mut error = Magnitude::ZERO;
        if other.rad > 0 {
            error = self.magnitude().times(other.radius());
        }
        if self.rad > 0 {
            error = error.plus(other.mid_magnitude().times(self.radius()));
        }
        Ball::rounded(&self.mid * &other.mid, exp, error, bits)
    }

    /// x².
    pub fn square(&self, bits: u32) -> Ball {
        self.mul(self, bits)
    }

    /// x / y; `None` if y may be 0.
    pub fn div(&self, other: &Ball, bits: u32) -> Option<Ball> {
        if other.contains_zero() {
            return None;
        }
        // The quotient of the midpoints has bits + 1 or bits + 2 bits; its floor is off by less than a unit.
        let shift = (i64::from(bits) + 2 + other.mid.bits() as i64 - self.mid.bits() as i64).max(0);
        let (quotient, remainder) = (&self.mid << shift).div_mod_floor(&other.mid);
        let exp = self.exp - other.exp - shift;
        let mut error = if remainder.is_zero() { Magnitude::ZERO } else { Magnitude::power_of_two(exp) };
        if self.rad > 0 || other.rad > 0 {
            // |x/y − a/b| = |x b − a y| / |y b| ≤ (r + |a/b| s) / (|b| − s) for x = a ± r, y = b ± s.
            let least = Magnitude::lower(&(other.mid.magnitude() - other.rad), other.exp);
            let ratio = Magnitude::upper(quotient.magnitude(), exp).plus(error);
            error = error.plus(self.radius().plus(ratio.times(other.radius())).over(least));
        }
        Some(Ball::rounded(quotient, exp, error, bits))
    }

    /// √x; `None` unless every point of the ball is ≥ 0.
    pub fn sqrt(&self, bits: u32) -> Option<Ball> {
        if self.mid < BigInt::from(self.rad) {
            return None;
        }
        if self.mid.is_zero() {
            return Some(Ball::zero());
        }
        // The radicand gets 2 bits + 4 bits (or keeps what it has) and an even exponent, so its root has
        // at least bits + 2; the floor of the root is off by less than one unit.
        let mut shift = (2 * i64::from(bits) + 4 - self.mid.bits() as i64).max(0);
        shift += (self.exp - shift).rem_euclid(2);
        let radicand = self.mid.magnitude() << shift;
        let root = radicand.sqrt();
        let exp = (self.exp - shift) / 2;
        let exact = &root * &root == radicand;
        let mut error = if exact { Magnitude::ZERO } else { Magnitude::power_of_two(exp) };
        if self.rad > 0 {
            // |√x − √a| = |x − a| / (√x + √a) ≤ r / √a for x ≥ 0.
            error = error.plus(self.radius().over(Magnitude::lower(&root, exp)));
        }
        Some(Ball::rounded(root.into(), exp, error, bits))
    }

    /// √x of a number known to be ≥ 0: negative points of the ball are ignored; `None` if there are no
    /// others.
    pub fn sqrt_clipped(&self, bits: u32) -> Option<Ball> {
        let (lower, upper) = self.ends();
        if !lower.mid.is_negative() {
            return self.sqrt(bits);
        }
        // [0, √upper] = half ± half, and the root's own radius on both sides.
        let half = upper.sqrt(bits)?.scale2(-1);
        let radius = half.magnitude().plus(half.radius());
        Some(Ball::rounded(half.mid, half.exp, radius, bits))
    }
}
