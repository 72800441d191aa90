//! Bauer and Fike's bound for a computed basis of eigenvectors, of multiple eigenvalues too.

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

use crate::number::U;
use crate::parallel::both;
use crate::system::half::norm;
use crate::system::verdict::limits::SIDE_BY_SIDE;

/// γ: a sum of m products, in any order, has an error of at most this times the sum of their absolute values.
pub(in crate::system) fn gamma(m: usize) -> f64 {
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

/// Bounds on F, V⁻¹ S V = D + F.
#[derive(Clone, Debug)]
pub(in crate::system) struct Residual {
    /// More than ‖F‖₂.
    pub norm: f64,
    /// More than the Euclidean norm of each row of F.
    pub rows: Vec<f64>,
    /// More than ‖V⁻¹‖₂.
    pub inverse: f64,
}

impl Residual {
    /// For all S within `off` of the given one, entry by entry, too: they add V⁻¹ (S' − S) V to F.
    pub fn widened(self, v: &Mat<f64>, off: &Mat<f64>) -> Option<Residual> {
        let size = |m: &Mat<f64>| Mat::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)].abs());
        self.moved(v, off, |w| size(w) * (off * size(v)))
    }

    /// For all S + x C, |x| ≤ 1, too: they add x V⁻¹ C V to F, one matrix, where entries cancel.
    pub fn along(self, v: &Mat<f64>, change: &Mat<f64>) -> Option<Residual> {
        self.moved(v, change, |w| w * (change * v))
    }

    /// `moved` of an approximate inverse W of V is W C V, or more than that of every entry.
    fn moved(
        self,
        v: &Mat<f64>,
        change: &Mat<f64>,
        moved: impl Fn(&Mat<f64>) -> Mat<f64>,
    ) -> Option<Residual> {
        let m = v.ncols();
        let w = v.partial_piv_lu().inverse();
        let y = Mat::<f64>::identity(m, m) - &w * v;
        let (nv, nw) = (norm::frobenius(v), norm::frobenius(&w));
        let y = norm::frobenius(&y) + gamma(m) * (nw * nv + m as f64);
        if y.is_nan() || y >= 0.5 {
            return None;
        }
        let moved = moved(&w);
        let rest = (y / (1.0 - y) + 2.1 * gamma(m)) * nw * norm::frobenius(change) * nv;
        let row = |i: usize| (0..m).map(|j| moved[(i, j)] * moved[(i, j)]).sum::<f64>().sqrt();
        let norm = self.norm + 1.01 * (norm::spectral(&moved) + rest);
        let rows = self.rows.iter().enumerate().map(|(i, own)| own + 1.01 * (row(i) + rest)).collect();
        norm.is_finite().then_some(Residual { norm, rows, ..self })
    }
}

/// Those for the true S, which is within `delta` of the given one, and a normal D of blocks of size 1 and 2.
///
/// With W V = I − Y, F = (I − Y)⁻¹ W (S V − V D), and the rows of (I − Y)⁻¹ W are within ‖Y‖ ‖W‖/(1 − ‖Y‖) of those of W.
pub(in crate::system) fn bauer_fike(
    s: &Mat<f64>,
    delta: f64,
    v: &Mat<f64>,
    d: &Mat<f64>,
) -> Option<Residual> {
    let m = v.ncols();
    let vd = times_blocks(v, d);
    let residual = || (norm::frobenius(&(s * v - &vd)), norm::spectral(v));
    let inverse = || {
        let w = v.partial_piv_lu().inverse();
        let size = norm::spectral(&w);
        (w, size)
    };
    let ((residual, v_size), (w, w_size)) = both(m >= SIDE_BY_SIDE, residual, inverse);
    let (nv, nw) = (norm::frobenius(v), norm::frobenius(&w));
    let rounding = gamma(m) * (norm::frobenius(s) * nv + norm::frobenius(&vd) + nv * norm::frobenius(d));
    let y = Mat::<f64>::identity(m, m) - &w * v;
    let y = norm::frobenius(&y) + gamma(m) * (nw * nv + m as f64);
    if y.is_nan() || y >= 0.5 {
        return None;
    }
    let off = residual + rounding + delta * v_size;
    let norm = 1.01 * w_size * off / (1.0 - y);
    let row = |i: usize| (0..m).map(|j| w[(i, j)] * w[(i, j)]).sum::<f64>().sqrt();
    let rows = (0..m).map(|i| 1.01 * (row(i) + nw * y / (1.0 - y)) * off).collect();
    let inverse = 1.01 * w_size / (1.0 - y);
    norm.is_finite().then_some(Residual { norm, rows, inverse })
}
