//! Bauer and Fike's bound for a computed basis of eigenvectors, of multiple eigenvalues too.

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

use crate::half::norm;
use crate::verdict::limits::SIDE_BY_SIDE;
use number::U;
use number::parallel::both;

/// γ: a sum of m products, in any order, has an error of at most this times the sum of their absolute values.
pub fn gamma(m: usize) -> f64 {
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
pub(crate) struct Residual {
    /// More than ‖F‖₂.
    pub norm: f64,
    /// More than the Euclidean norm of each row of F.
    pub rows: Vec<f64>,
}

/// L E R in doubles, ‖E‖₂ ≤ `size`: L and R are each within its `off` (2-norm).
#[derive(Clone, Debug)]
pub struct Term {
    pub size: f64,
    pub sides: [Mat<f64>; 2],
    pub off: [f64; 2],
}

/// An approximate inverse W of V, and more than ‖I − W V‖ where that is below 1/2.
fn inverse(v: &Mat<f64>) -> Option<(Mat<f64>, f64)> {
    let m = v.ncols();
    let w = v.partial_piv_lu().inverse();
    let y = Mat::<f64>::identity(m, m) - &w * v;
    let y = norm::frobenius(&y) + gamma(m) * (norm::frobenius(&w) * norm::frobenius(v) + m as f64);
    (y < 0.5).then_some((w, y))
}

/// The Euclidean norm of row i, rounded.
fn row(m: &Mat<f64>, i: usize) -> f64 {
    (0..m.ncols()).map(|j| m[(i, j)] * m[(i, j)]).sum::<f64>().sqrt()
}

impl Residual {
    /// For all S within `off` of the given one, entry by entry, too: they add V⁻¹ (S' − S) V to F.
    pub fn widened(&self, v: &Mat<f64>, off: &Mat<f64>) -> Option<Residual> {
        let size = |m: &Mat<f64>| Mat::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)].abs());
        self.moved(v, off, |w| size(w) * (off * size(v)))
    }

    /// For all S + x C, |x| ≤ 1, too: they add x V⁻¹ C V to F, one matrix, where entries cancel.
    pub fn along(&self, v: &Mat<f64>, change: &Mat<f64>) -> Option<Residual> {
        self.moved(v, change, |w| w * (change * v))
    }

    /// `moved` of an approximate inverse W of V is W C V, or more than that of every entry.
    fn moved(
        &self,
        v: &Mat<f64>,
        change: &Mat<f64>,
        moved: impl Fn(&Mat<f64>) -> Mat<f64>,
    ) -> Option<Residual> {
        let (w, y) = inverse(v)?;
        let moved = moved(&w);
        let sizes = norm::frobenius(&w) * norm::frobenius(change) * norm::frobenius(v);
        let rest = (y / (1.0 - y) + 2.1 * gamma(v.ncols())) * sizes;
        let rows = (0..v.ncols()).map(|i| 1.01 * (row(&moved, i) + rest)).collect();
        self.plus(1.01 * (norm::spectral(&moved) + rest), rows)
    }

    /// For all S + Σ L E R, too: they add V⁻¹ L E R V to F, whose i-th row is no longer than |row i of V⁻¹ L|
    /// ‖E‖ ‖R V‖.
    pub fn with_terms(&self, v: &Mat<f64>, terms: &[Term]) -> Option<Residual> {
        let (w, y) = inverse(v)?;
        let (m, [nv, nw]) = (v.ncols(), [v, &w].map(norm::frobenius));
        let mut rows = vec![0.0; m];
        for Term { size, sides: [left, right], off } in terms {
            let [nl, nr] = [left, right].map(norm::frobenius);
            // (I − Y)⁻¹ W L in place of W L, and roundings.
            let rest = ((y / (1.0 - y) + gamma(m)) * nl + off[0] / (1.0 - y)) * nw;
            let across = norm::spectral(&(right * v)) + (gamma(m) * nr + off[1]) * nv;
            let left = &w * left;
            rows.iter_mut()
                .enumerate()
                .for_each(|(i, value)| *value += 1.01 * size * across * (row(&left, i) + rest));
        }
        let norm = 1.01 * rows.iter().map(|value| value * value).sum::<f64>().sqrt();
        self.plus(norm, rows)
    }

    fn plus(&self, norm: f64, rows: Vec<f64>) -> Option<Residual> {
        let norm = self.norm + norm;
        let rows = self.rows.iter().zip(rows).map(|(value, more)| value + more).collect();
        norm.is_finite().then_some(Residual { norm, rows })
    }
}

/// Those for the true S, which is within `delta` of the given one, and a normal D of blocks of size 1 and 2.
///
/// With W V = I − Y, F = (I − Y)⁻¹ W (S V − V D), and the rows of (I − Y)⁻¹ W are within ‖Y‖ ‖W‖/(1 − ‖Y‖) of
/// those of W.
pub(crate) fn bauer_fike(s: &Mat<f64>, delta: f64, v: &Mat<f64>, d: &Mat<f64>) -> Option<Residual> {
    let m = v.ncols();
    let vd = times_blocks(v, d);
    let residual = || (norm::frobenius(&(s * v - &vd)), norm::spectral(v));
    let inverse = || inverse(v).map(|(w, y)| (norm::spectral(&w), w, y));
    let ((residual, v_size), inverse) = both(m >= SIDE_BY_SIDE, residual, inverse);
    let (w_size, w, y) = inverse?;
    let (nv, nw) = (norm::frobenius(v), norm::frobenius(&w));
    let rounding = gamma(m) * (norm::frobenius(s) * nv + norm::frobenius(&vd) + nv * norm::frobenius(d));
    let off = residual + rounding + delta * v_size;
    let norm = 1.01 * w_size * off / (1.0 - y);
    let rows = (0..m).map(|i| 1.01 * (row(&w, i) + nw * y / (1.0 - y)) * off).collect();
    norm.is_finite().then_some(Residual { norm, rows })
}
