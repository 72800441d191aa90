//! Spectral radii of matrices that are known within an error.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Scale};

use super::damping::Damping;
use crate::half::norm;
use crate::signs::inertia::is_definite;
use crate::spectrum::discs::{components, real_form, residual};
use number::U;

/// Where the spectral radius of all matrices within `error` (2-norm) of q lies: by its enclosure, or, near
/// double eigenvalues where that is wide, by a form that each of them shrinks.
pub fn damping(q: &Mat<f64>, error: f64, radius: Option<Radius>) -> Option<Damping> {
    let by_radius = radius.and_then(Radius::damping);
    by_radius.or_else(|| shrinks_a_form(q, error).then_some(Damping::Damped))
}

/// Whether P − Qᵀ P Q > 0 for some P > 0 and all Q within `error` (2-norm) of q, so that their spectral
/// radius is below 1 (Stein).
fn shrinks_a_form(q: &Mat<f64>, error: f64) -> bool {
    let form = of_powers(q);
    is_definite(form.clone(), 0.0) && shrinks(&form, q, error)
}

/// As for each of many q with one P, so for all of their means, since norms are convex: tried with the
/// eigenvectors of one in their middle, and with its powers, which do not mind where eigenvalues meet.
pub(crate) fn shrink_one_form(middle: &Mat<f64>, all: &[Mat<f64>], error: f64) -> bool {
    let Ok(eigen) = middle.eigen() else { return false };
    let values: Vec<_> = (0..middle.nrows()).map(|i| eigen.S()[i]).collect();
    let radius = values.iter().map(|z| z.norm()).fold(0.0, f64::max);
    if radius.is_nan() || radius >= 1.0 {
        return false;
    }
    let is_shrunk =
        |form: &Mat<f64>| is_definite(form.clone(), 0.0) && all.iter().all(|q| shrinks(form, q, error));
    let by_vectors = real_form(&values, &eigen.U().to_owned()).map(|(vectors, _)| {
        let inverse = vectors.partial_piv_lu().inverse();
        symmetric(&(inverse.transpose() * &inverse))
    });
    // Half way to the circle, so that no power lasts.
    let nearer = Scale(2.0 / (1.0 + radius)) * middle;
    by_vectors.is_some_and(|form| is_shrunk(&form)) || is_shrunk(&of_powers(&nearer))
}

fn symmetric(x: &Mat<f64>) -> Mat<f64> {
    Mat::from_fn(x.nrows(), x.ncols(), |i, j| (x[(i, j)] + x[(j, i)]) / 2.0)
}

/// P = Σ (qᵏ)ᵀ qᵏ in doubles, for which P − qᵀ P q would be the identity less what the sum leaves out.
fn of_powers(q: &Mat<f64>) -> Mat<f64> {
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
    symmetric(&p)
}

/// Whether P − Qᵀ P Q > 0 for all Q within `error` of q.
fn shrinks(p: &Mat<f64>, q: &Mat<f64>, error: f64) -> bool {
    let (size_q, size_p) = (norm::frobenius(q), norm::frobenius(p));
    let rounding = 1.1 * U * ((2 * q.nrows() + 8) as f64 * size_q * size_q + 4.0) * size_p;
    let slack = 1.01 * (rounding + error * (2.0 * size_q + error) * size_p);
    let rest = symmetric(&(p - q.transpose() * p * q));
    slack.is_finite() && is_definite(rest, slack)
}

/// An enclosure of a spectral radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Radius {
    lo: f64,
    hi: f64,
}

impl Radius {
    /// For all matrices within `error` (2-norm) of q: no eigenvalue lies outside the discs, and at least one
    /// in each of their connected components. `None` where doubles bound nothing.
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
