//! The numbers that coefficients are made of: doubles, two doubles, long numbers.

use num_traits::Float;

use super::lanes::Lanes;
use super::long;
pub use super::long::Long;
use number::{Ball, Rational, Twofold, U, power_of_two};

/// A floating number. Every operation returns its exact result but for [`UNIT`](Coefficient::UNIT): a product
/// within UNIT |a b|, a sum within UNIT (|a| + |b|), as long as nothing is smaller than 2^-900.
pub trait Coefficient: Copy {
    /// The next shorter numbers; of the shortest themselves.
    type Lower: Coefficient;
    type Lanes: Lanes<Self>;
    const UNIT: f64;
    /// The precision at which balls serve it.
    const BITS: u32;
    /// So many coefficients a function has: the terms of a product of two smooth ones beyond them are as
    /// small as UNIT.
    const TERMS: usize;
    /// The logarithm of the factors that are multiplied in one row, up to `row::LONGEST` of them: 0 where
    /// single products, which leave out what is small when it is known, are cheaper.
    const ROW: u32;
    /// The cost of a product of functions, about, relative to that of doubles.
    const COST: u64;
    /// The most products of functions that one run may cost: a fraction of a second, or some seconds.
    const PRODUCTS: u64;
    /// The error that all products of many factors may have together, where rounding leaves it so small.
    const CLOSE: f64;

    fn zero() -> Self;
    /// x, exactly.
    fn of(x: f64) -> Self;
    fn negative(&self) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// self + x y, in at most these two operations.
    #[inline(always)]
    fn plus_times(&self, x: &Self, y: &Self) -> Self {
        self.plus(&x.times(y))
    }
    /// x 2^k, exactly.
    fn scale2(&self, k: i32) -> Self;
    /// Within 2^-50 relatively.
    fn near(&self) -> f64;
    /// Near the ball's midpoint.
    fn of_ball(ball: &Ball) -> Self;
    /// The number, exactly.
    fn ball(&self) -> Ball;
    /// Within two units of those numbers, relatively.
    fn to<P: Coefficient>(&self) -> P;
    /// A number near two doubles' sum, and how far from it at most.
    fn near_twofold(x: Twofold) -> (Self, f64);

    /// n/d within 3 UNIT relatively.
    fn quotient(n: i128, d: u128) -> Self {
        let exact = Rational::new(n.into(), d.into());
        Self::of_ball(&Ball::from_rational(&exact, Self::BITS))
    }
}

impl<T: Coefficient> Lanes<T> for [T; 4] {
    #[inline(always)]
    fn of(x: [&T; 4]) -> Self {
        x.map(|x| *x)
    }

    #[inline(always)]
    fn entries(self) -> [T; 4] {
        self
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        std::array::from_fn(|i| self[i].plus(&other[i]))
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        std::array::from_fn(|i| self[i].times(&other[i]))
    }

    #[inline(always)]
    fn plus_times(&self, x: &Self, y: &Self) -> Self {
        std::array::from_fn(|i| self[i].plus_times(&x[i], &y[i]))
    }
}

impl Coefficient for f64 {
    type Lower = f64;
    type Lanes = [f64; 4];
    const UNIT: f64 = U;
    const BITS: u32 = 80;
    const TERMS: usize = 13;
    const ROW: u32 = 3;
    const COST: u64 = 1;
    const PRODUCTS: u64 = 50_000;
    const CLOSE: f64 = 1e-7;

    fn zero() -> Self {
        0.0
    }

    fn of(x: f64) -> Self {
        x
    }

    fn negative(&self) -> Self {
        -self
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        self * other
    }

    #[inline(always)]
    fn plus_times(&self, x: &Self, y: &Self) -> Self {
        x.mul_add(*y, *self)
    }

    fn scale2(&self, k: i32) -> Self {
        self * power_of_two(k)
    }

    #[inline(always)]
    fn near(&self) -> f64 {
        *self
    }

    fn of_ball(ball: &Ball) -> Self {
        ball.mid_f64()
    }

    fn ball(&self) -> Ball {
        exact(*self)
    }

    fn to<P: Coefficient>(&self) -> P {
        P::of(*self)
    }

    fn near_twofold(x: Twofold) -> (Self, f64) {
        (x.hi, x.lo.abs())
    }

    fn quotient(n: i128, d: u128) -> Self {
        // Numbers of one register are converted in one instruction.
        match (i64::try_from(n), i64::try_from(d)) {
            (Ok(n), Ok(d)) => n as f64 / d as f64,
            _ => n as f64 / d as f64,
        }
    }
}

impl Coefficient for Twofold {
    type Lower = f64;
    type Lanes = Twofold<[f64; 4]>;
    const UNIT: f64 = 1.0 / (1u128 << 101) as f64;
    const BITS: u32 = 130;
    const TERMS: usize = 22;
    const ROW: u32 = 0;
    const COST: u64 = 5;
    const PRODUCTS: u64 = 20_000;
    const CLOSE: f64 = 1e-18;

    fn zero() -> Self {
        Twofold::ZERO
    }

    fn of(x: f64) -> Self {
        Twofold { hi: x, lo: 0.0 }
    }

    fn negative(&self) -> Self {
        Twofold::negative(*self)
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Twofold::plus(*self, *other)
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Twofold::times(*self, *other)
    }

    fn scale2(&self, k: i32) -> Self {
        let unit = power_of_two(k);
        Twofold { hi: self.hi * unit, lo: self.lo * unit }
    }

    fn near(&self) -> f64 {
        self.hi
    }

    fn of_ball(ball: &Ball) -> Self {
        let hi = ball.mid_f64();
        Twofold::sum(hi, ball.sub(&exact(hi), Self::BITS).mid_f64())
    }

    fn quotient(n: i128, d: u128) -> Self {
        quotient(n, d)
    }

    fn ball(&self) -> Ball {
        // Two doubles may lie far apart: a sum of exact balls within 2^-2000 of the larger is exact for those
        // above 2^-900.
        exact(self.hi).add(&exact(self.lo), 2200)
    }

    fn to<P: Coefficient>(&self) -> P {
        P::of(self.hi).plus(&P::of(self.lo))
    }

    fn near_twofold(x: Twofold) -> (Self, f64) {
        (x, 0.0)
    }
}

impl Coefficient for Long {
    type Lower = Twofold;
    type Lanes = [Self; 4];
    const UNIT: f64 = f64::from_bits((1023 + 2 - long::LENGTH as u64) << 52);
    const BITS: u32 = long::LENGTH + 32;
    const TERMS: usize = 8 + long::LENGTH as usize / 7;
    const ROW: u32 = 0;
    const COST: u64 = 100;
    const PRODUCTS: u64 = 10_000;
    const CLOSE: f64 = 1e-40;

    fn zero() -> Self {
        Long::ZERO
    }

    fn of(x: f64) -> Self {
        Long::of(x)
    }

    fn negative(&self) -> Self {
        Long::negative(*self)
    }

    fn plus(&self, other: &Self) -> Self {
        Long::plus(self, other)
    }

    fn times(&self, other: &Self) -> Self {
        Long::times(self, other)
    }

    fn scale2(&self, k: i32) -> Self {
        Long::scale2(self, k)
    }

    fn near(&self) -> f64 {
        Long::near(self)
    }

    fn of_ball(ball: &Ball) -> Self {
        let (n, exponent) = ball.middle();
        Long::of_dyadic(n, exponent)
    }

    fn ball(&self) -> Ball {
        let (n, exponent) = self.dyadic();
        Ball::from_integer(&n).scale2(exponent)
    }

    fn to<P: Coefficient>(&self) -> P {
        self.doubles().fold(P::zero(), |sum, half| sum.plus(&P::of(half)))
    }

    fn near_twofold(x: Twofold) -> (Self, f64) {
        near_ball(&Coefficient::ball(&x))
    }
}

/// n/d within 3 2^-101 relatively, |n| and d below 2^127.
pub fn quotient(n: i128, d: u128) -> Twofold {
    // Each within 2^-105, and 2^-100 of the quotient.
    let two = |n: u128| {
        let hi = n as f64;
        Twofold::sum(hi, n.wrapping_sub(hi as u128) as i128 as f64)
    };
    let size = two(n.unsigned_abs()).divided_by(two(d));
    if n < 0 { size.negative() } else { size }
}

/// A double, exactly.
pub fn exact(x: f64) -> Ball {
    let (mantissa, exponent, sign) = Float::integer_decode(x);
    Ball::from_integer(&(i64::from(sign) * mantissa as i64).into()).scale2(exponent.into())
}

/// A number near the ball, and how far from what it holds at most.
pub fn near_ball<T: Coefficient>(ball: &Ball) -> (T, f64) {
    let near = T::of_ball(ball);
    let (lo, hi) = ball.sub(&near.ball(), T::BITS).to_f64_enclosure();
    (near, lo.abs().max(hi.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_of_two_doubles_are_near() {
        let places =
            [1u128, 2, 3, 10, 12345, 1 << 31, (1 << 53) + 1, (1 << 62) - 57, (1 << 106) + 1, (1 << 124) - 57];
        for n in places {
            for d in places {
                for n in [n as i128, -(n as i128)] {
                    let near = <Twofold as Coefficient>::quotient(n, d).ball();
                    let exact = Ball::from_rational(&Rational::new(n.into(), d.into()), 300);
                    let lost = near.sub(&exact, 300).div(&exact, 300).unwrap().abs().to_f64_enclosure().1;
                    assert!(lost < 3.0 * Twofold::UNIT, "{n}/{d}: {lost}");
                }
            }
        }
    }
}
