//! How strong a resonance is: the first-order law in L2.
//!
//! To first order in L2 the tongue about p θ = m π lies in
//!
//! ```text
//!     p th = m pi - q alpha (S0 ± |S|)        (alpha taken at the resonance)
//!     S0 = mean |P(sigma_k)|²,   S = mean P(sigma_k)² e^{2 i n_k th}   over the q slow kicks, k p/q = n_k + sigma_k,
//! ```
//!
//! P(σ) = 1 − σ + σ e^{iθ} being the fast clock's solution between two of its kicks. A phase δ off the middle lets the
//! amplitude grow by √((q α |S|)² − δ²) per period, so by q α |S| in the middle. On a fixed family
//! (a, b), as q grows, S0 → 1 − s/6 and |S| → |S_a(θ)|,
//!
//! ```text
//!     S_a = ∫ (c² - 4 s² u²) cos 2ψu - 4 c s u sin 2ψu du  over [-1/2, 1/2],   c, s = cos, sin (θ/2),  ψ = π a - θ,
//! ```
//!
//! whose value is, by parts, with sin ψ = −(−1)^a sin θ and cos ψ = (−1)^a cos θ (the terms in 1/ψ cancel),
//!
//! ```text
//!     S_a(θ) = (-1)^a 2 sin²(θ/2) (ψ - sin θ)/ψ³.
//! ```
//!
//! So a resonance weakens like 1/a², whatever b.
//!
//! ```
//! use kickdrift::resonance::strength;
//! // a = 0 is r-RESPA's own family; slow fast-clock angle: full strength.
//! assert!((strength(0, 1e-3) - 1.0).abs() < 1e-6);
//! assert!(strength(2, 1.0).abs() < strength(1, 1.0).abs());
//! ```

use crate::number::Ratio;
use num_complex::Complex64;

/// S_a(θ), 0 < θ < π, in doubles: relative error a few units in the last place except where ψ − sin θ
/// cancels (a = 1, θ near π), for which the series of (ψ − sin ψ)/ψ³ is used.
pub fn strength(a: i64, theta: f64) -> f64 {
    let sign = if a % 2 == 0 { 1.0 } else { -1.0 };
    let half = (theta / 2.0).sin();
    let psi = std::f64::consts::PI * a as f64 - theta;
    let ratio = if a == 1 && psi < 0.5 {
        // sin θ = sin ψ; (ψ − sin ψ)/ψ³ = Σ (−1)^k ψ^2k/(2k + 3)!, the next term below 1e-18 at ψ = 1/2.
        let x = psi * psi;
        (1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0 * (1.0 - x / 110.0 * (1.0 - x / 156.0))))) / 6.0
    } else {
        (psi - theta.sin()) / psi.powi(3)
    };
    sign * 2.0 * half * half * ratio
}

/// The first-order prediction of a tongue, in s = h1² L1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstOrder {
    /// The middle of the tongue.
    pub centre: f64,
    /// Its width.
    pub width: f64,
    /// ln of the multiplier at the middle, per period: q alpha |S|, half the width in the phase p θ.
    pub ln_multiplier: f64,
}

/// The first-order tongue of h2/h1 = p/q about p θ = m π, for L2 = rho L1, 0 < m < p.
///
/// Rounded; the law itself is of first order in rho: its error is O(rho²).
pub fn first_order(ratio: Ratio, m: u64, rho: f64) -> Option<FirstOrder> {
    let (p, q) = ratio.terms();
    if m == 0 || m >= p {
        return None;
    }
    let theta = std::f64::consts::PI * m as f64 / p as f64;
    let (s0, s1) = means(ratio, theta);
    let s = 4.0 * (theta / 2.0).sin().powi(2);
    let alpha = s * rho * (p as f64 / q as f64) / (2.0 * theta.sin());
    let phase = q as f64 * alpha;
    // ds/dθ = 2 sin θ, and the phase is p θ.
    let per_phase = 2.0 * theta.sin() / p as f64;
    Some(FirstOrder {
        centre: s - phase * s0 * per_phase,
        width: 2.0 * phase * s1 * per_phase,
        ln_multiplier: phase * s1,
    })
}

/// S0 and |S| over the q slow kicks of one period, p θ = m π. The kicks k and q − k mirror each other: n' = p − 1 − n, σ' = 1 − σ,
/// P(σ') = e^{iθ} P(σ)*, so their terms of S are conjugate, and half the period gives both sums.
fn means(ratio: Ratio, theta: f64) -> (f64, f64) {
    let (p, q) = ratio.terms();
    let turn = Complex64::cis(theta);
    // k = 0, where P = 1.
    let (mut s0, mut s1) = (1.0, 1.0);
    // k p = n q + r, step by step.
    let (whole, rest) = (p / q, p % q);
    let (mut n, mut r) = (0, 0);
    for k in 1..=q / 2 {
        let wraps = r >= q - rest;
        r = if wraps { r - (q - rest) } else { r + rest };
        n += whole + u64::from(wraps);
        let sigma = r as f64 / q as f64;
        let position = 1.0 - sigma + turn * sigma;
        let times = if 2 * k == q { 1.0 } else { 2.0 };
        s0 += times * position.norm_sqr();
        s1 += times * (position * position * Complex64::cis(2.0 * n as f64 * theta)).re;
    }
    (s0 / q as f64, s1.abs() / q as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_many_kicks_tends_to_the_closed_form() {
        // p/q = 301/100, m = 101 = 1·301 − 2·100: family (1, −2), theta = 101 pi/301.
        let theta = std::f64::consts::PI * 101.0 / 301.0;
        let (s0, s1) = means("301/100".parse().unwrap(), theta);
        let s = 4.0 * (theta / 2.0f64).sin().powi(2);
        // The kicks sample sigma at spacing 1/100: errors of order 1/q.
        assert!((s0 - (1.0 - s / 6.0)).abs() < 1e-2);
        assert!((s1 - strength(1, theta).abs()).abs() < 1e-2);
    }
}
