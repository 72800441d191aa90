//! Lifts: by how much a matrix on its way from the identity has turned the vector (1, 0).
//!
//! The angle is kept as whole turns and the direction in which the vector now points, so it is exact however large it is.
//! Lifts compose: G after F turns (1, 0) by φ_F + φ_G + δ, δ the difference between how far G turns F(1, 0) and how far it
//! turns (1, 0). A lift is increasing and commutes with half turns, so |δ| < π, and δ is known from directions alone.

use std::f64::consts::{PI, TAU};

/// Directions are known this well, in radians, or no turn is.
const CERTAIN: f64 = 0.02;

/// A turn by 2π whole + angle, counterclockwise; |angle| ≤ π, and the true angle is within [`CERTAIN`] of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    pub whole: i128,
    pub angle: f64,
}

/// The direction of a vector known up to `error`; `None` where that is not certain.
pub fn direction([x, y]: [f64; 2], error: f64) -> Option<f64> {
    // asin r < 1.001 r for r this small.
    (1.001 * error <= CERTAIN * x.hypot(y) && x.hypot(y) > 0.0).then(|| y.atan2(x))
}

/// The angle in [-π, π] that differs by whole turns.
pub fn principal(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

impl Turn {
    /// Of the identity.
    pub const NONE: Turn = Turn { whole: 0, angle: 0.0 };

    /// Turned on by `by` to the direction `angle`, both up to rounding.
    pub fn on(self, by: f64, angle: f64) -> Turn {
        let whole = ((self.angle + by - angle) / TAU).round();
        Turn { whole: self.whole + whole as i128, angle }
    }

    /// `later` after self, where the vector ends in the direction `angle`; `None` where directions do not decide.
    pub fn then(self, later: Turn, angle: f64) -> Option<Turn> {
        let difference = principal(angle - self.angle - later.angle);
        // Three directions, each within CERTAIN.
        (difference.abs() < PI - 4.0 * CERTAIN).then(|| {
            let turn = self.on(later.angle + difference, angle);
            Turn { whole: turn.whole + later.whole, ..turn }
        })
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
