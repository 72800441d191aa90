//! Numbers that depend on a box of steps: affine in it, with a bound on all else (proofs/BANDS.md).

use super::trig::{TRIG, arcsine, sine_cosine};
use super::{FLOOR, UP};
use crate::number::U;

/// c + d₁ u₁ + d₂ u₂ + E(u) on the box |u₁|, |u₂| ≤ 1, |E| ≤ ε.
///
/// Every operation encloses its result: what it rounds, and what is not affine, goes to ε.
#[derive(Clone, Copy, Debug)]
pub struct Affine {
    pub center: f64,
    pub slopes: [f64; 2],
    pub error: f64,
}

impl Affine {
    /// A number within `error` of `center`.
    pub fn constant(center: f64, error: f64) -> Self {
        Affine { center, slopes: [0.0; 2], error }
    }

    /// The same with another slope in one of the two directions.
    pub fn with_slope(mut self, direction: usize, slope: f64) -> Self {
        self.slopes[direction] = slope;
        self
    }

    /// |d₁| + |d₂| + ε: how far it lies from its center at most.
    pub fn reach(&self) -> f64 {
        (self.slopes[0].abs() + self.slopes[1].abs() + self.error) * UP
    }

    /// No value exceeds it.
    pub fn size(&self) -> f64 {
        (self.center.abs() + self.reach()) * UP
    }

    pub fn plus(&self, other: &Self) -> Self {
        Affine {
            center: self.center + other.center,
            slopes: [self.slopes[0] + other.slopes[0], self.slopes[1] + other.slopes[1]],
            error: (self.error + other.error + U * (self.size() + other.size())) * UP,
        }
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    pub fn negative(&self) -> Self {
        let Affine { center, slopes, error } = *self;
        Affine { center: -center, slopes: slopes.map(|slope| -slope), error }
    }

    /// x 2^k, exactly but for what underflows.
    pub fn scale2(&self, k: i32) -> Self {
        let unit = 2f64.powi(k);
        let Affine { center, slopes, error } = *self;
        Affine { center: center * unit, slopes: slopes.map(|x| x * unit), error: error * unit + FLOOR }
    }

    pub fn times(&self, other: &Self) -> Self {
        let (x, y) = (self, other);
        let curved = (x.reach() - x.error).max(0.0) * (y.reach() - y.error).max(0.0);
        let carried = x.size() * y.error + y.size() * x.error;
        let rounding = 3.0 * U * x.size() * y.size();
        Affine {
            center: x.center * y.center,
            slopes: [0, 1].map(|i| x.slopes[i] * y.center + x.center * y.slopes[i]),
            error: (curved + carried + rounding) * UP + FLOOR,
        }
    }

    /// 1/x; `None` where x may be zero.
    pub fn reciprocal(&self) -> Option<Self> {
        let (c, reach) = (self.center, self.reach());
        let least = c.abs() * (1.0 - 4.0 * U) - reach;
        if least.is_nan() || least <= 0.0 {
            return None;
        }
        // 1/(c + δ) = 1/c − δ/c² + δ²/(c² (c + δ)).
        let square = c * c;
        let curved = reach * reach / (square * least);
        let rounding = 4.0 * U * (1.0 / c.abs() + reach / square);
        Some(Affine {
            center: 1.0 / c,
            slopes: self.slopes.map(|slope| -slope / square),
            error: (curved + self.error / square + rounding) * UP + FLOOR,
        })
    }

    /// f of it, from f(c), f'(c), both within `off`, and a bound on |f''| on all its values.
    fn image(&self, [value, slope, curvature, off]: [f64; 4]) -> Self {
        let reach = self.reach();
        let bent = slope.abs() * self.error + 0.5 * curvature * reach * reach;
        let rounding = off * (1.0 + reach) + 2.0 * U * (value.abs() + slope.abs() * reach);
        Affine {
            center: value,
            slopes: self.slopes.map(|own| own * slope),
            error: (bent + rounding) * UP + FLOOR,
        }
    }

    /// sin x and cos x; `None` where x is too large.
    pub fn sine_cosine(&self) -> Option<[Self; 2]> {
        (self.size() < 1e6).then(|| {
            let [s, c] = sine_cosine(self.center);
            [self.image([s, c, 1.0, TRIG]), self.image([c, -s, 1.0, TRIG])]
        })
    }

    /// arcsin x, √(1 − x²) and arcsin x/x; `None` unless 0 < x < 1.
    pub fn arcsine(&self) -> Option<[Self; 3]> {
        let (c, reach) = (self.center, self.reach());
        let (least, most) = (c - reach, (c + reach) * (1.0 + 4.0 * U));
        if !(least > 0.0 && most < 1.0) {
            return None;
        }
        let [angle, off] = arcsine(c);
        let cosine = ((1.0 - c) * (1.0 + c)).sqrt();
        // √(1 − x²) at the largest x, from below.
        let lowest = ((1.0 - most) * (1.0 + most)).sqrt() * (1.0 - 8.0 * U);
        let cube = lowest * lowest * lowest;
        let slope = 1.0 / cosine;
        // g = arcsin x/x has a series with positive coefficients, g' ≥ x/3, and x g'' = x/√(1 − x²)³ − 2 g'.
        let share = [angle / c, (c * slope - angle) / (c * c), 1.0 / cube * UP - 0.66];
        Some([
            self.image([angle, slope, most / cube * UP, off.max(8.0 * U * slope)]),
            self.image([cosine, -c / cosine, 1.0 / cube * UP, 8.0 * U * slope]),
            self.image([share[0], share[1], share[2], (2.0 * off + 8.0 * U * slope) / (c * c)]),
        ])
    }
}
