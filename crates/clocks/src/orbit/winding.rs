//! How far the even solution turns over the half period.
//!
//! The kernel's shears move it through the plane, never across the axis they keep, so counting the axes
//! crossed counts its quarter turns: those of the exact solution, whose angle to the computed one stays small
//! all the way.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::floquet::Pair;

/// ⌊Θ/(π/2)⌋ at T/2, Θ the even solution's turn: from the quarters counted up to the last update, the state
/// (re, im) there, and the turn left with its cosine and sine.
pub fn at_end(pair: &Pair, counted: i64, [re, im]: [f64; 2], [cos, sin]: [f64; 2]) -> i64 {
    // The last shear may have crossed the axis re = 0 once more: the quarter of the same half plane.
    let angle = im.atan2(re);
    let before = nearest_turn(counted as f64 * FRAC_PI_2 + FRAC_PI_2 / 2.0, angle);
    // Half turns left out of the updates, and the turn left.
    let carries = u128::from(pair.updates) * u128::from(pair.rest) / u128::from(pair.modulus);
    let [without, with] = [0, 1].map(|carry| pair.base.turn(pair.whole + carry).half_turns as f64);
    let half_turns = (pair.updates as f64 - carries as f64) * without + carries as f64 * with;
    let turn =
        before + 2.0 * FRAC_PI_2 * half_turns + pair.left().unwrap_or(0) as f64 * pair.base.theta / 2.0;
    // The end's own direction knows the quarter; the sum, which of the whole turns. Odd half turns reverse
    // it.
    let sign = if half_turns.rem_euclid(2.0) == 1.0 { -1.0 } else { 1.0 };
    let (x, y) = (sign * (re * cos - im * sin), sign * (re * sin + im * cos));
    let quarter = match (x < 0.0, y < 0.0) {
        (false, false) => 0,
        (true, false) => 1,
        (true, true) => 2,
        (false, true) => 3,
    };
    quarter + 4 * ((turn - quarter as f64 * FRAC_PI_2 - FRAC_PI_2 / 2.0) / TAU).round() as i64
}

/// The angle equal to `angle` up to whole turns that is nearest to `to`.
fn nearest_turn(to: f64, angle: f64) -> f64 {
    angle + TAU * ((to - angle) / TAU).round()
}
