//! How far a computed orbit can have strayed: one theorem for every tier that rounds.
//!
//! Exact orbit u_k = M_k u_{k−1} with det M_k = 1 and ‖M_k‖ ≤ κ; computed orbit û_k = M_k û_{k−1} + r_k,
//! û_0 = u_0. Since det(u, e) is preserved by every M_k, the error *across* the orbit does not grow with
//! the orbit: it is the sum of what each step adds, and turns into an angle on division by |û_k|².
//!
//! **Theorem** (theorems `perturbed_orbit`, `sign_certificate` in proofs/). Suppose for k = 1..n that
//! |r_k| ≤ ε |û_{k−1}|, that |û_k| and |û_{k−1}| differ by a factor of at most g, that
//! b_k ≥ Σ_{j≤k} |r_j| |û_j|, and that 2 b_k ≤ τ |û_k|². Put ω = g ε + g κ τ. If n (κ ε + ω) ≤ 1/4, then
//!
//! ```text
//!     u_k = a_k (û_k + (t_k/|û_k|²) J û_k),   |t_k| ≤ 2 b_k,   1 - kω ≤ a_k ≤ 1/(1 - kω),
//! ```
//!
//! J the rotation by a right angle. So a linear form n has the same sign on u_k as on û_k wherever
//! |⟨n, û_k⟩| |û_k| > 2 b_k |n|. Weakly and strongly unstable pairs alike: growth makes the bound better,
//! since |û_k|² outruns b_k.

/// Bounds of one step on a vector and on its error: the constants of the theorem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepBound {
    /// ‖M_k‖ ≤ κ.
    pub kappa: f64,
    /// |r_k| ≤ ε |û_{k−1}|.
    pub epsilon: f64,
}

impl StepBound {
    /// g: by how much |û| can change in a step, either way.
    ///
    /// |û_k| ≤ (κ + ε) |û_{k−1}| and, M_k⁻¹ having the norm of M_k, |û_{k−1}| ≤ κ (|û_k| + ε |û_{k−1}|).
    /// With κ ε ≤ 1/200, which [`StepBound::tau`] demands, both factors are below 1.01 κ.
    pub fn growth(&self) -> f64 {
        1.01 * self.kappa
    }

    /// The largest τ for which the theorem's condition n (κ ε + ω) ≤ 1/4 holds over n steps, or `None`
    /// where ε alone is too large for any.
    pub fn tau(&self, n: u64) -> Option<f64> {
        let (g, n) = (self.growth(), n as f64);
        let left = 0.25 / n - (self.kappa + g) * self.epsilon;
        // The margin 0.99 covers the roundings of this very computation.
        (self.kappa * self.epsilon <= 0.005 && left > 0.0).then(|| 0.99 * left / (g * self.kappa))
    }

    /// n ω, the relative uncertainty of the orbit's length after n steps; below 1/4 for τ within
    /// [`StepBound::tau`].
    pub fn length_uncertainty(&self, n: u64, tau: f64) -> f64 {
        1.01 * n as f64 * self.growth() * (self.epsilon + self.kappa * tau)
    }
}
