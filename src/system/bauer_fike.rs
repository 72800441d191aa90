//! Bauer and Fike's bound for a computed basis of eigenvectors, of multiple eigenvalues too.

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

use super::norm;
use crate::number::U;

/// γ: a sum of m products, in any order, has an error of at most this times the sum of their absolute values.
pub(super) fn gamma(m: usize) -> f64 {
    1.01 * (m as f64 + 4.0) * U
}

/// V D for the block-diagonal D of blocks of size 1 and 2.
fn times_blocks(v: &Mat<f64>, d: &Mat<f64>) -> Mat<f64> {
    let m = v.ncols();
    Mat::from_fn(m, m, |i, j| {
        let neighbours = j.saturating_sub(1)..(j + 2).min(m);
        neighbours.map(|k| v[(i, k)] * d[(k, j)]).sum()
    })
}

/// More than ‖F‖₂, V⁻¹ S V = D + F, for the true S, which is within `delta` of the given one, and a normal D of blocks of
/// size 1 and 2.
pub(super) fn bauer_fike(s: &Mat<f64>, delta: f64, v: &Mat<f64>, d: &Mat<f64>) -> Option<f64> {
    let m = v.ncols();
    let w = v.partial_piv_lu().inverse();
    let vd = times_blocks(v, d);
    let residual = norm::frobenius(&(s * v - &vd));
    let (nv, nw) = (norm::frobenius(v), norm::frobenius(&w));
    let rounding = gamma(m) * (norm::frobenius(s) * nv + norm::frobenius(&vd) + nv * norm::frobenius(d));
    let y = Mat::<f64>::identity(m, m) - &w * v;
    let y = norm::frobenius(&y) + gamma(m) * (nw * nv + m as f64);
    if y.is_nan() || y >= 0.5 {
        return None;
    }
    let off = residual + rounding + delta * norm::spectral(v);
    let radius = 1.01 * norm::spectral(&w) * off / (1.0 - y);
    radius.is_finite().then_some(radius)
}
