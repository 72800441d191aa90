//! Lifts: by how much a matrix on its way from the identity has turned the vector (1, 0).
//!
//! The angle is kept as whole turns and the direction in which the vector now points, so it is exact however
//! large it is. Lifts compose: G after F turns (1, 0) by φ_F + φ_G + δ, δ the difference between how far G
//! turns F(1, 0) and how far it turns (1, 0). A lift is increasing and commutes with half turns, so −ψ < δ <
//! π − ψ, ψ the direction of F(1, 0) less half turns, and δ is known from directions alone.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Directions are known this well, in radians, or no turn is.
const CERTAIN: f64 = 0.02;

/// A turn by 2π whole + angle, counterclockwise; |angle| ≤ π, and the true angle is within [`CERTAIN`] of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    pub whole: i128,
    pub angle: f64,
}

/// How near [`angle`] is, and what of [`CERTAIN`] is left to the vector's own error.
const ANGLE_ERROR: f64 = 0.0039;
const OWN: f64 = 0.016;

/// The angle of a vector that is not zero, in [-π, π], within [`ANGLE_ERROR`]: directions need no more, and
/// an arctangent costs as much as a product of matrices.
#[inline(always)]
pub fn angle([x, y]: [f64; 2]) -> f64 {
    let (wide, high) = (x.abs(), y.abs());
    let is_steep = high > wide;
    let slope = if is_steep { wide / high } else { high / wide };
    let within = slope * (FRAC_PI_4 + 0.273 * (1.0 - slope));
    let first = if is_steep { FRAC_PI_2 - within } else { within };
    let upper = if x < 0.0 { PI - first } else { first };
    upper.copysign(y)
}

/// The direction of a vector known up to `error`; `None` where that is not certain.
#[inline(always)]
pub fn direction([x, y]: [f64; 2], error: f64) -> Option<f64> {
    const { assert!(ANGLE_ERROR + OWN < CERTAIN) };
    // asin r < 1.001 r for r this small.
    let length = (x * x + y * y).sqrt();
    (1.001 * error <= OWN * length && length > 0.0).then(|| angle([x, y]))
}

/// The angle in [-π, π] that differs by whole turns.
#[inline(always)]
pub fn principal(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Turn {
    /// Of the identity.
    pub const NONE: Turn = Turn { whole: 0, angle: 0.0 };

    /// Turned on by `by` to the direction `angle`, each within a few times [`CERTAIN`].
    #[inline(always)]
    pub fn on(self, by: f64, angle: f64) -> Turn {
        let whole = ((self.angle + by - angle) / TAU).round();
        Turn { whole: self.whole + whole as i128, angle }
    }

    /// `later` after self, where the vector ends in the direction `angle`; `None` where directions do not
    /// decide.
    #[inline(always)]
    pub fn then(self, later: Turn, angle: f64) -> Option<Turn> {
        let difference = principal(angle - self.angle - later.angle);
        // Three directions, each within CERTAIN.
        let is_certain = difference.abs() < PI - 4.0 * CERTAIN;
        let difference = if is_certain { difference } else { self.nearly_opposite(difference)? };
        let turn = self.on(later.angle + difference, angle);
        Some(Turn { whole: turn.whole + later.whole, ..turn })
    }

    /// The difference δ, known but for a whole turn, where it is nearly a half turn: δ + ψ lies between 0 and
    /// π. `None` where ψ is next to one of them.
    #[cold]
    fn nearly_opposite(self, difference: f64) -> Option<f64> {
        let psi = self.angle.rem_euclid(PI);
        let is_apart = (4.0 * CERTAIN..PI - 4.0 * CERTAIN).contains(&psi);
        is_apart.then(|| principal(difference + psi - FRAC_PI_2) + FRAC_PI_2 - psi)
    }

    /// After a shear, which turns by less than π, and clockwise where that is said.
    pub fn sheared(self, clockwise: bool, angle: f64) -> Turn {
        let by = principal(angle - self.angle);
        let beyond = if clockwise { by > 1.0 } else { by < -1.0 };
        let by = if !beyond {
            by
        } else if clockwise {
            by - TAU
        } else {
            by + TAU
        };
        self.on(by, angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_as_near_as_they_say() {
        // Between two of these places angles change by 1e-5, and what is returned by less than twice that.
        let turns = (0..=628_319).map(|k| f64::from(k) * 1e-5 - PI);
        for turn in turns {
            let (y, x) = turn.sin_cos();
            let lost = principal(angle([3.0 * x, 3.0 * y]) - turn).abs();
            assert!(lost < ANGLE_ERROR - 3e-5, "{turn}: {lost}");
        }
    }

    /// A hyperbolic matrix draws nearly every direction to one axis, those beside the other axis to either
    /// end of it.
    #[test]
    fn lifts_compose_where_directions_are_nearly_opposite() {
        let mut decided = 0;
        for first in (1..314).map(|k| f64::from(k) / 100.0) {
            // The axis that repels stands between (1, 0) and the vector, or beyond it.
            for repelling in (1..314).map(|k| f64::from(k) / 100.0) {
                let image = |angle: f64| {
                    let ((y, x), (sine, cosine)) = (angle.sin_cos(), repelling.sin_cos());
                    let (along, across) = (x * cosine + y * sine, y * cosine - x * sine);
                    (across * 1e6).atan2(along * 1e-6)
                };
                // A symmetric positive matrix turns nothing by a right angle, and as much on the way from the
                // identity.
                let turned = |angle: f64| principal(image(angle) + repelling - angle);
                let (start, end) = (turned(0.0), turned(first));
                if [start, end].iter().any(|turn| turn.abs() > FRAC_PI_2 - 1e-9) {
                    continue;
                }
                let [one, later] = [first, start].map(|angle| Turn { whole: 0, angle });
                let total = first + end;
                let Some(found) = one.then(later, principal(total)) else { continue };
                assert!(
                    (TAU * found.whole as f64 + found.angle - total).abs() < 1e-9,
                    "{first}, {repelling}"
                );
                decided += 1;
            }
        }
        // All but those beside the first axis.
        assert!(decided > 90_000, "{decided}");
    }
}
