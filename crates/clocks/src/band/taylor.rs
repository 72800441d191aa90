//! Numbers that depend on the ratio of the steps: Taylor models of the second order (proofs/BANDS.md).

use super::trig::{TRIG, arcsine, sine_cosine};
use crate::orbit::returns::{FLOOR, UP};
use number::U;

/// c + d u + q u² + E(u) for |u| ≤ 1, |E| ≤ ε.
///
/// Every operation encloses its result: what it rounds, and what is of the third order, goes to ε.
#[derive(Clone, Copy, Debug)]
pub struct Taylor {
    pub center: f64,
    pub slope: f64,
    pub square: f64,
    pub error: f64,
}

/// f at a point c.
struct Function {
    /// f(c), f'(c), f''(c).
    values: [f64; 3],
    /// How far each of them may be off.
    off: [f64; 3],
    /// A bound on |f'''| on all values of the argument.
    third: f64,
}

impl Taylor {
    /// A number within `error` of `center`.
    pub fn constant(center: f64, error: f64) -> Self {
        Taylor { center, slope: 0.0, square: 0.0, error }
    }

    /// This model with another slope.
    pub fn with_slope(self, slope: f64) -> Self {
        Taylor { slope, ..self }
    }

    /// All of its coefficients, from the center on.
    pub fn coefficients(&self) -> [f64; 3] {
        [self.center, self.slope, self.square]
    }

    /// |q| + ε: all that is not affine.
    pub fn bent(&self) -> f64 {
        (self.square.abs() + self.error) * UP
    }

    /// How far it lies from its center at most.
    pub fn reach(&self) -> f64 {
        (self.slope.abs() + self.bent()) * UP
    }

    /// No value exceeds it.
    pub fn size(&self) -> f64 {
        (self.center.abs() + self.reach()) * UP
    }

    /// By how much the square of what lies beside the center differs from that of its affine part at most.
    pub fn square_beside_affine(&self) -> f64 {
        self.bent() * (self.reach() + self.slope.abs()) * UP
    }

    pub fn plus(&self, other: &Self) -> Self {
        Taylor {
            center: self.center + other.center,
            slope: self.slope + other.slope,
            square: self.square + other.square,
            error: (self.error + other.error + U * (self.size() + other.size())) * UP,
        }
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    pub fn negative(&self) -> Self {
        self.scaled(-1.0)
    }

    /// x 2^k, exactly but for what underflows.
    pub fn scale2(&self, k: i32) -> Self {
        let scaled = self.scaled(2f64.powi(k));
        Taylor { error: scaled.error + FLOOR, ..scaled }
    }

    fn scaled(&self, by: f64) -> Self {
        let Taylor { center, slope, square, error } = *self;
        Taylor { center: center * by, slope: slope * by, square: square * by, error: error * by.abs() }
    }

    pub fn times(&self, other: &Self) -> Self {
        let (x, y) = (self, other);
        let [x_square, y_square] = [x, y].map(|taylor| taylor.square.abs());
        let third = x.slope.abs() * y_square + x_square * y.slope.abs() + x_square * y_square;
        let carried = x.size() * y.error + y.size() * x.error;
        let rounding = 5.0 * U * x.size() * y.size();
        Taylor {
            center: x.center * y.center,
            slope: x.slope * y.center + x.center * y.slope,
            square: x.square * y.center + x.center * y.square + x.slope * y.slope,
            error: (third + carried + rounding) * UP + FLOOR,
        }
    }

    /// 1/x; `None` where x may be zero.
    pub fn reciprocal(&self) -> Option<Self> {
        let c = self.center;
        let least = c.abs() * (1.0 - 4.0 * U) - self.reach();
        if least.is_nan() || least <= 0.0 {
            return None;
        }
        let inverse = 1.0 / c;
        let values = [inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse];
        let off = values.map(|value| 4.0 * U * value.abs());
        // 1/(c + δ) = 1/c − δ/c² + δ²/c³ − δ³/(c³ (c + δ)).
        let third = 3.0 * values[2].abs() / least * UP;
        Some(self.image(&Function { values, off, third }))
    }

    /// f of it.
    fn image(&self, f: &Function) -> Self {
        let [value, slope, curvature] = f.values;
        let reach = self.reach();
        let left = slope.abs() * self.error
            + 0.5 * curvature.abs() * self.square_beside_affine()
            + f.third / 6.0 * reach * reach * reach;
        let powers = [1.0, reach, reach * reach];
        let rounding: f64 = (0..3).map(|i| (f.off[i] + 6.0 * U * f.values[i].abs()) * powers[i]).sum();
        Taylor {
            center: value,
            slope: self.slope * slope,
            square: self.square * slope + 0.5 * curvature * self.slope * self.slope,
            error: (left + rounding) * UP + FLOOR,
        }
    }

    /// sin x and cos x; `None` where x is too large.
    pub fn sine_cosine(&self) -> Option<[Self; 2]> {
        (self.size() < 1e6).then(|| {
            let [s, c] = sine_cosine(self.center);
            [[s, c, -s], [c, -s, -c]]
                .map(|values| self.image(&Function { values, off: [TRIG; 3], third: 1.0 }))
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
        let slope = 1.0 / cosine;
        let cube = slope * slope * slope;
        // 1/√(1 − x²) at the largest x, from above, and its fifth power.
        let steepest = (1.0 + 8.0 * U) / ((1.0 - most) * (1.0 + most)).sqrt();
        let square = steepest * steepest;
        let fifth = square * square * steepest * UP;
        // g = arcsin x/x has a series with positive coefficients, and x g''' = arcsin''' x − 3 g'' with g'' ≥
        // 1/3.
        let first = (c * slope - angle) / (c * c);
        let second = (c * cube - 2.0 * first) / c;
        let third = (1.0 + 2.0 * most * most) * fifth * UP;
        // The rounding of arcsin x, c arcsin' c and c² arcsin'' c.
        let rounded = 2.0 * off + 8.0 * U * (slope + c * c * cube);
        let functions = [
            ([angle, slope, c * cube], [off, 8.0 * U * slope, 16.0 * U * cube], third),
            (
                [cosine, -c * slope, -cube],
                [8.0 * U * slope, 16.0 * U * slope, 16.0 * U * cube],
                3.0 * most * fifth,
            ),
            (
                [angle / c, first, second],
                [off / c, rounded / (c * c), 4.0 * rounded / (c * c * c)],
                (third - 1.0) / most * UP,
            ),
        ];
        Some(functions.map(|(values, off, third)| self.image(&Function { values, off, third })))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Its polynomial, moved by a share of its error.
    fn value(x: &Taylor, u: f64, share: f64) -> f64 {
        x.center + x.slope * u + x.square * u * u + share * x.error
    }

    fn model(center: std::ops::Range<f64>) -> impl Strategy<Value = Taylor> {
        let rest = (-1.0..1.0, -1.0..1.0, 0.0..1e-3, -9..0);
        (center, rest).prop_map(|(center, (slope, square, error, k)): (f64, (f64, f64, f64, i32))| {
            let unit = 0.3 * 2f64.powi(k);
            Taylor { center, slope: slope * unit, square: square * unit * unit, error: error * unit }
        })
    }

    proptest! {
        #[test]
        fn every_value_is_enclosed(
            x in model(0.2..0.6), y in model(-2.0..2.0), at in -1.0..=1.0f64, shares in prop::array::uniform2(-1.0..=1.0f64),
        ) {
            let (a, b) = (value(&x, at, shares[0]), value(&y, at, shares[1]));
            let [sine, cosine] = y.sine_cosine().unwrap();
            let mut pairs = vec![(x.plus(&y), a + b), (x.minus(&y), a - b), (x.times(&y), a * b), (sine, b.sin()), (cosine, b.cos())];
            pairs.extend(x.reciprocal().map(|taylor| (taylor, 1.0 / a)));
            if let Some([angle, root, quotient]) = x.arcsine() {
                pairs.extend([(angle, a.asin()), (root, (1.0 - a * a).sqrt()), (quotient, a.asin() / a)]);
            }
            for (n, (model, exact)) in pairs.into_iter().enumerate() {
                // The rounding of the comparison itself is subtracted.
                let off = (value(&model, at, 0.0) - exact).abs() - 1e-14 * (1.0 + exact.abs());
                prop_assert!(off <= model.error, "{n}: {off} of {model:?}");
            }
        }
    }
}
