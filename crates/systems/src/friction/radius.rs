//! Spectral radii of matrices that are known within an error.

use faer::Mat;

use super::damping::Damping;
use crate::half::norm;
use crate::signs::inertia::is_definite;
use crate::spectrum::discs::{components, residual};
use number::U;

/// Where the spectral radius of all matrices within `error` (2-norm) of q lies: by its enclosure, or, near double eigenvalues where that is
/// wide, by a form that each of them shrinks.
pub fn damping(q: &Mat<f64>, error: f64, radius: Option<Radius>) -> Option<Damping> {
    let by_radius = radius.and_then(Radius::damping);
    by_radius.or_else(|| shrinks_a_form(q, error).then_some(Damping::Damped))
}

/// Whether P − Qᵀ P Q > 0 for some P > 0 and all Q within `error` (2-norm) of q, so that their spectral radius is below 1 (Stein): tried with
/// P = Σ (qᵏ)ᵀ qᵏ, in doubles, for which it would be the identity less what the sum leaves out.
fn shrinks_a_form(q: &Mat<f64>, error: f64) -> bool {
    const DOUBLINGS: usize = 48;
    let n = q.nrows();
    let (mut power, mut p) = (q.clone(), Mat::<f64>::identity(n, n));
    for _ in 0..DOUBLINGS {
        let size = norm::frobenius(&power);
        if !size.is_finite() || size < 0.5 {
            break;
        }
        p = &p + power.transpose() * &p * &power;
        power = &power * &power;
    }
    let symmetric = |x: &Mat<f64>| Mat::from_fn(n, n, |i, j| (x[(i, j)] + x[(j, i)]) / 2.0);
    let p = symmetric(&p);
    let (size_q, size_p) = (norm::frobenius(q), norm::frobenius(&p));
    let rounding = 1.1 * U * ((2 * n + 8) as f64 * size_q * size_q + 4.0) * size_p;
    let slack = 1.01 * (rounding + error * (2.0 * size_q + error) * size_p);
    let rest = symmetric(&(&p - q.transpose() * &p * q));
    slack.is_finite() && is_definite(rest, slack) && is_definite(p, 0.0)
}

/// An enclosure of a spectral radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Radius {
    lo: f64,
    hi: f64,
}

impl Radius {
    /// For all matrices within `error` (2-norm) of q: no eigenvalue lies outside the discs, and at least one in each of their connected
    /// components. `None` where doubles bound nothing.
    pub fn of(q: &Mat<f64>, error: f64) -> Option<Radius> {
        let eigen = q.eigen().ok()?;
        let values: Vec<_> = (0..q.nrows()).map(|i| eigen.S()[i]).collect();
        let radius = 1.01 * residual(q, error + U * norm::frobenius(q), &values, &eigen.U().to_owned())?.norm;
        let far = values.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let least = |component: &Vec<usize>| {
            component.iter().map(|&i| values[i].norm()).fold(f64::INFINITY, f64::min)
        };
        let lower = components(&values, radius).iter().map(least).fold(0.0, f64::max);
        Some(Radius { lo: (lower - radius).next_down(), hi: (far + radius).next_up() })
    }

    /// `None` where 1 lies inside.
    pub fn damping(self) -> Option<Damping> {
        if self.hi < 1.0 { Some(Damping::Damped) } else { (self.lo > 1.0).then_some(Damping::Growing) }
    }

    /// ln ρ/T, the period within 4u: beside the quotient's, ln x is off by some roundings of |ln x| + 1.
    pub fn growth(self, period: f64) -> (f64, f64) {
        let [lo, hi] = [self.lo.max(f64::MIN_POSITIVE), self.hi].map(f64::ln);
        ((lo - 10.0 * U * (lo.abs() + 1.0)) / period, (hi + 10.0 * U * (hi.abs() + 1.0)) / period)
    }
}
