//! Two doubles with a number between them.

use number::{Ball, U};

/// A positive number lies in [`lo`, `hi`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    pub lo: f64,
    pub hi: f64,
}

impl Enclosure {
    /// All numbers within `error` of `value`.
    pub(super) fn around(value: f64, error: f64) -> Self {
        Enclosure { lo: (value - error).next_down(), hi: (value + error).next_up() }
    }

    /// All numbers of the ball.
    pub(super) fn of(ball: &Ball) -> Self {
        let (lo, hi) = ball.to_f64_enclosure();
        Enclosure { lo, hi }
    }

    /// hi − lo.
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// The double in the middle.
    pub fn middle(self) -> f64 {
        0.5 * self.lo + 0.5 * self.hi
    }

    /// No number in here is farther from the [middle](Enclosure::middle).
    pub fn error(self) -> f64 {
        (self.hi - self.middle()).max(self.middle() - self.lo).next_up()
    }

    /// Whether the middle is off by less than this share of it.
    pub(super) fn within(self, share: f64) -> bool {
        self.lo > 0.0 && self.width() <= share * self.lo
    }

    /// The numbers over x > 0, which is known within 4u relatively.
    pub(super) fn over(self, x: f64) -> Self {
        Enclosure { lo: self.lo / x * (1.0 - SLACK), hi: self.hi / x * (1.0 + SLACK) }
    }

    /// x > 0, known within 4u relatively, over the numbers.
    pub(super) fn under(self, x: f64) -> Self {
        Enclosure { lo: x / self.hi * (1.0 - SLACK), hi: x / self.lo * (1.0 + SLACK) }
    }
}

/// 4u, a quotient, a product, and what is left over.
const SLACK: f64 = 8.0 * U;
