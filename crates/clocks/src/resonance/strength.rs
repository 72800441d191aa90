//! How strong a resonance is: the first-order law in L2.
//!
//! To first order in L2 the tongue about p θ = m π lies in
//!
//! ```text
//!     p th = m pi - q alpha (S0 ± |S|)        (alpha taken at the resonance)
//!     S0 = mean |P(sigma_k)|²,   S = mean P(sigma_k)² e^{2 i n_k th}   over the q slow kicks, k p/q = n_k + sigma_k,
//! ```
//!
//! P(σ) = 1 − σ + σ e^{iθ} being the fast clock's solution between two of its kicks. A phase δ off the middle
//! lets the amplitude grow by √((q α |S|)² − δ²) per period, so by q α |S| in the middle. On a fixed family
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
//! use kickdrift_clocks::resonance::strength;
//! // a = 0 is r-RESPA's own family; slow fast-clock angle: full strength.
//! assert!((strength(0, 1e-3) - 1.0).abs() < 1e-6);
//! assert!(strength(2, 1.0).abs() < strength(1, 1.0).abs());
//! ```

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
