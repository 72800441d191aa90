//! Intervals of doubles, rounded outwards.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from `lo` to `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub lo: f64,
    pub hi: f64,
}

impl Interval {
    pub fn point(x: f64) -> Self {
        Interval { lo: x, hi: x }
    }

    /// One rounding wider on both sides.
    fn outward(lo: f64, hi: f64) -> Self {
        Interval { lo: lo.next_down(), hi: hi.next_up() }
    }

    pub fn mid(self) -> f64 {
        self.lo / 2.0 + self.hi / 2.0
    }

    /// More than the distance of any of its numbers from [`Interval::mid`].
    pub fn radius(self) -> f64 {
        (self.hi - self.mid()).max(self.mid() - self.lo).next_up()
    }

    /// Whether it is above 0; `None` where 0 is in it.
    pub fn sign(self) -> Option<bool> {
        if self.lo > 0.0 { Some(true) } else { (self.hi < 0.0).then_some(false) }
    }

    pub fn half(self) -> Self {
        Interval::outward(self.lo / 2.0, self.hi / 2.0)
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, other: Interval) -> Interval {
        Interval::outward(self.lo + other.lo, self.hi + other.hi)
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Sub for Interval {
    type Output = Interval;
    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, other: Interval) -> Interval {
        let products = [self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi];
        let (lo, hi) =
            products.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &x| (lo.min(x), hi.max(x)));
        Interval::outward(lo, hi)
    }
}

impl Div for Interval {
    type Output = Interval;
    /// Everything where the divisor may be 0.
    fn div(self, other: Interval) -> Interval {
        if other.lo <= 0.0 && other.hi >= 0.0 {
            return Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
        }
        self * Interval::outward(1.0 / other.hi, 1.0 / other.lo)
    }
}
