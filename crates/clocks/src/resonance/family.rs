//! The families (a, b) of a resonance: all integer solutions of m = a p + b q, and the one that matters.

use num_integer::Integer;

use super::strength;
use crate::verdict::{Answer, Decidable};
use number::{Ball, Ratio, Rational, Result};

/// The families through a resonance: one pair (a0, b0) with a0 p + b0 q = m and 0 ≤ a0 < q; all others are
/// (a0 + q k, b0 − p k).
pub fn families(ratio: Ratio, m: u64) -> (i64, i64) {
    let [p, q, m] = [ratio.p(), ratio.q(), m].map(i128::from);
    let a0 = (p.extended_gcd(&q).x * m).rem_euclid(q);
    // |a0| < q and |b0| <= max(m/q, p).
    (a0 as i64, ((m - a0 * p) / q) as i64)
}

/// The dominant family of the tongue m of h2/h1 = p/q: the one that maximizes |S_a(θ)| at p θ = m π.
///
/// With ψ = π a − θ = ±π r, |S_a| ∝ (π r ∓ sin θ)/r³ falls with r on either side of zero, so only the least
/// a ≥ 1 and the greatest a ≤ 0 of the residue class compete, and for 0 < θ < π they never tie: that would be
/// π (r r'³ − r' r³) = (r³ + r'³) sin θ, where r ≠ r' makes π algebraic and r = r' makes sin θ zero.
///
/// Tongues m ≥ p have no resonance below the fast clock's Verlet limit; they are labelled as at θ = π, where
/// ties go to the smaller |a|. Where a negative slow stiffness outweighs the fast one the solution grows
/// without turning: m = 0, the trivial family (0, 0).
pub fn dominant_family(ratio: Ratio, m: u64) -> (i64, i64) {
    let (a0, b0) = families(ratio, m);
    if m == 0 {
        return (0, 0);
    }
    let (step_a, step_b) = (ratio.q() as i64, ratio.p() as i64);
    let above = if a0 >= 1 { (a0, b0) } else { (a0 + step_a, b0 - step_b) };
    let below = (above.0 - step_a, above.1 + step_b);
    if m >= ratio.p() {
        return if above.0 - 1 < 1 - below.0 { above } else { below };
    }
    if stronger(above.0, below.0, ratio.p(), m) { above } else { below }
}

impl<S: Decidable> Answer<S> {
    /// The dominant family (a, b) of the tongue, m = a p + b q; `None` unless hyperbolic.
    ///
    /// # Errors
    /// As [`Answer::growth`].
    pub fn family(&self) -> Result<Option<(i64, i64)>> {
        Ok(self.label()?.map(|m| dominant_family(self.clocks().ratio(), m)))
    }
}

/// Whether |S_a| > |S_b| at θ = m π/p: in doubles where they are clearly apart, else in as many bits as
/// needed.
fn stronger(a: i64, b: i64, p: u64, m: u64) -> bool {
    let theta = std::f64::consts::PI * m as f64 / p as f64;
    let (x, y) = (strength(a, theta).abs(), strength(b, theta).abs());
    // The relative error of either is below 1e-13: ψ is right to 2e-15, and ψ − sin θ > ψ³/48 > 0.002 where
    // it is computed as a difference.
    if (x - y).abs() > 1e-12 * x.max(y) {
        return x > y;
    }
    let mut bits = 128;
    loop {
        let theta = Ball::pi(bits).mul(&Ball::from_rational(&Rational::new(m.into(), p.into()), bits), bits);
        let order = relative(a, &theta, bits).compare(&relative(b, &theta, bits));
        if let Some(order) = order {
            return order.is_gt();
        }
        bits *= 2;
    }
}

/// |S_a(θ)| without the factor 2 sin²(θ/2) that all families share: |ψ − sin θ|/|ψ|³.
fn relative(a: i64, theta: &Ball, bits: u32) -> Ball {
    let psi = Ball::pi(bits).mul(&Ball::from_integer(&a.into()), bits).sub(theta, bits);
    let cube = psi.square(bits).mul(&psi, bits).abs();
    psi.sub(&theta.sin(bits), bits).abs().div(&cube, bits).expect("psi is not 0 for 0 < theta < pi")
}
