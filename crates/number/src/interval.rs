//! Intervals of doubles, rounded outwards.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Ball, U};

/// All numbers from `lo` to `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub lo: f64,
    pub hi: f64,
}

/// 4u, a quotient, a product, and what is left over.
const SLACK: f64 = 8.0 * U;

impl Interval {
    const EVERYTHING: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// One number.
    #[inline]
    pub fn point(x: f64) -> Self {
        Interval { lo: x, hi: x }
    }

    /// All numbers within `error` of `value`.
    #[inline]
    pub fn around(value: f64, error: f64) -> Self {
        Interval::outward(value - error, value + error)
    }

    /// One rounding wider on both sides.
    #[inline]
    fn outward(lo: f64, hi: f64) -> Self {
        Interval { lo: lo.next_down(), hi: hi.next_up() }
    }

    /// All numbers of the ball.
    pub fn of(ball: &Ball) -> Self {
        let (lo, hi) = ball.to_f64_enclosure();
        Interval { lo, hi }
    }

    /// hi − lo.
    #[inline]
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// The double in the middle.
    #[inline]
    pub fn middle(self) -> f64 {
        0.5 * self.lo + 0.5 * self.hi
    }

    /// No number in here is farther from the [middle](Interval::middle).
    #[inline]
    pub fn error(self) -> f64 {
        (self.hi - self.middle()).max(self.middle() - self.lo).next_up()
    }

    /// Whether the middle is off by less than this share of it.
    pub fn within(self, share: f64) -> bool {
        self.lo > 0.0 && self.width() <= share * self.lo
    }

    /// Whether it is above 0; `None` where 0 is in it.
    #[inline]
    pub fn sign(self) -> Option<bool> {
        if self.lo > 0.0 { Some(true) } else { (self.hi < 0.0).then_some(false) }
    }

    /// A half of it.
    #[inline]
    pub fn half(self) -> Self {
        Interval::outward(self.lo / 2.0, self.hi / 2.0)
    }

    /// Positive numbers over x > 0, which is known within 4u relatively.
    pub fn over(self, x: f64) -> Self {
        Interval { lo: self.lo / x * (1.0 - SLACK), hi: self.hi / x * (1.0 + SLACK) }
    }

    /// x > 0, known within 4u relatively, over positive numbers.
    pub fn under(self, x: f64) -> Self {
        Interval { lo: x / self.hi * (1.0 - SLACK), hi: x / self.lo * (1.0 + SLACK) }
    }
}

impl Add for Interval {
    type Output = Interval;
    #[inline]
    fn add(self, other: Interval) -> Interval {
        Interval::outward(self.lo + other.lo, self.hi + other.hi)
    }
}

impl Neg for Interval {
    type Output = Interval;
    #[inline]
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Sub for Interval {
    type Output = Interval;
    #[inline]
    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Interval;
    #[inline]
    fn mul(self, other: Interval) -> Interval {
        let products = [self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi];
        // 0 times an end without a bound, or an end that is no number: `min` and `max` would pass it over.
        if products.iter().any(|x| x.is_nan()) {
            return Interval::EVERYTHING;
        }
        let (lo, hi) =
            products.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &x| (lo.min(x), hi.max(x)));
        Interval::outward(lo, hi)
    }
}

impl Div for Interval {
    type Output = Interval;
    /// Everything where the divisor may be 0.
    #[inline]
    fn div(self, other: Interval) -> Interval {
        if other.lo <= 0.0 && other.hi >= 0.0 {
            return Interval::EVERYTHING;
        }
        self * Interval::outward(1.0 / other.hi, 1.0 / other.lo)
    }
}
