//! The label of a tongue: how many half turns the growing solution makes in one period.
//!
//! In Floquet coordinates the point g P turns by the base's angle between kicks, φ = p θ/2 in all, and a kick
//! moves it by i β x |P|²: up or down, never across the line x = 0. So the turn of the even solution over the
//! half period is φ + Σ δ, δ the change of arg(g P) in each kick, |δ| < π. Inside a tongue m half turns of the
//! growing solution over the period are m/2 over its half, give or take less than one quarter turn; the signs
//! of x and v at T/2 leave one m for it.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::floquet::Floquet;
use super::kind::{Kind, Verdict};

/// m, or `None` where the pair is not hyperbolic or the turn is too uncertain to tell.
pub(super) fn label(floquet: &Floquet, verdict: Verdict) -> Option<u64> {
    if verdict.kind() != Kind::Hyperbolic {
        return None;
    }
    let (turn, (x, v)) = even_turn(floquet);
    // The end point's own angle knows the turn up to whole turns; the sum tells their number.
    let own = (-v).atan2(x);
    let whole = (turn - own) / (2.0 * PI);
    let off = (whole - whole.round()).abs();
    let half_turns = 2.0 * whole.round() + own / PI;
    let m = if verdict.side() > 0 { 2.0 * half_turns.round() } else { 2.0 * half_turns.ceil() - 1.0 };
    (off < 0.25 && m >= 0.0).then_some(m as u64)
}

/// The even solution's turn over the half period in radians, and where it ends as (x, v).
fn even_turn(floquet: &Floquet) -> (f64, (f64, f64)) {
    let (mut turn, mut g) = (floquet.phi, Complex64::ONE);
    for step in floquet.steps() {
        let [turn_by, p] = [step.turn, step.p].map(|[re, im]| Complex64::new(re, im));
        g *= turn_by;
        let before = g * p;
        g += Complex64::I * p.conj() * (step.beta * before.re);
        turn += (before.conj() * g * p).arg();
        // Only directions matter; a power of two keeps growing orbits in range.
        if g.re.abs().max(g.im.abs()) > 2f64.powi(500) {
            g *= 2f64.powi(-500);
        }
    }
    let end = g * Complex64::new(floquet.last_turn[0], floquet.last_turn[1]);
    (turn, (end.re, -end.im))
}
