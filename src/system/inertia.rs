//! Inertias of symmetric matrices in doubles, proven.

use faer::{Mat, Side};

use super::norm;
use crate::number::U;

/// How many eigenvalues of a symmetric matrix have which sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Inertia {
    pub positive: usize,
    pub negative: usize,
    pub zero: usize,
    /// Those whose sign was not told; 0 in exact arithmetic.
    pub unknown: usize,
}

impl Inertia {
    /// 1 or −1 for a definite matrix, else 0.
    pub fn definite(&self) -> i8 {
        match (self.positive, self.negative, self.zero + self.unknown) {
            (1.., 0, 0) => 1,
            (0, 1.., 0) => -1,
            _ => 0,
        }
    }

    /// That of c times the matrix, c of the sign given.
    pub fn times(self, sign: i8) -> Inertia {
        if sign >= 0 { self } else { Inertia { positive: self.negative, negative: self.positive, ..self } }
    }
}

/// Whether every symmetric matrix within `slack` (2-norm) of the symmetric m is positive definite, by Rump's criterion
/// (Verification of positive definiteness, BIT 46, 2006): if Cholesky's factorization of m − c I runs to its end in
/// doubles, m + c' I is positive definite for c' = γ/(1 − γ) tr m − c; no order of summation or fused product matters.
/// Only the lower triangle of m is read.
pub(super) fn is_definite(m: &Mat<f64>, slack: f64) -> bool {
    let n = m.nrows();
    if n == 0 {
        return true;
    }
    let trace: f64 = (0..n).map(|i| m[(i, i)].abs()).sum();
    // γ_(n+1), with room for the reciprocals of pivots, the rounding of the shifted diagonal and of the sums here.
    let shift = 1.01 * (slack + (n as f64 + 24.0) * U * trace) + f64::MIN_POSITIVE * (n as f64 + 1.0).powi(2);
    if !shift.is_finite() || (0..n).any(|i| m[(i, i)] <= shift) {
        return false;
    }
    let shifted = Mat::from_fn(n, n, |i, j| if i == j { m[(i, i)] - shift } else { m[(i, j)] });
    shifted.llt(Side::Lower).is_ok()
}

/// The inertia that every symmetric matrix within `slack` (2-norm) of the symmetric m has.
///
/// A definite one by Cholesky; else with the computed eigenvectors V and eigenvalues Λ, ‖Vᵀ V − I‖ ≤ η: for the
/// orthogonal factor Q of V, ‖Q − V‖ ≤ η, Qᵀ m Q = Λ + E with ‖E‖ ≤ ‖m V − V Λ‖ + η (‖m‖ + ‖Λ‖), and no eigenvalue is
/// farther than ‖E‖ + slack from its place in Λ (Weyl).
pub(super) fn proven(m: &Mat<f64>, slack: f64) -> Inertia {
    let n = m.nrows();
    if is_definite(m, slack) {
        return Inertia { positive: n, ..Inertia::default() };
    }
    if is_definite(&-m, slack) {
        return Inertia { negative: n, ..Inertia::default() };
    }
    let unknown = Inertia { unknown: n, ..Inertia::default() };
    let Ok(eigen) = m.self_adjoint_eigen(Side::Lower) else { return unknown };
    let values: Vec<f64> = (0..n).map(|i| eigen.S()[i]).collect();
    let Some(error) = backward_error(m, eigen.U().to_owned(), &values) else { return unknown };
    let radius = 1.01 * (error + slack);
    let count = |test: &dyn Fn(f64) -> bool| values.iter().filter(|&&x| test(x)).count();
    let (positive, negative) = (count(&|x| x > radius), count(&|x| x < -radius));
    Inertia { positive, negative, zero: 0, unknown: n - positive - negative }
}

/// More than ‖E‖₂, Qᵀ m Q = Λ + E for the orthogonal Q nearest to the computed eigenvectors V; `None` where these are not
/// nearly orthogonal.
pub(super) fn backward_error(m: &Mat<f64>, v: Mat<f64>, values: &[f64]) -> Option<f64> {
    let defect = orthogonality(&v)?;
    let n = m.nrows();
    let scaled = Mat::from_fn(n, n, |i, j| v[(i, j)] * values[j]);
    let largest = values.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    let residual = m * &v - &scaled;
    let (size, length) = (norm::frobenius(m), norm::frobenius(&v));
    let rounding = 1.1 * (n as f64 + 4.0) * U * length * (size + largest);
    let error = norm::frobenius(&residual) + rounding + 1.01 * defect * (size + largest);
    error.is_finite().then_some(error)
}

/// More than ‖Vᵀ V − I‖₂; `None` from 1/10 on.
pub(super) fn orthogonality(v: &Mat<f64>) -> Option<f64> {
    let k = v.ncols();
    let gram = v.transpose() * v - Mat::<f64>::identity(k, k);
    let defect = norm::frobenius(&gram) + 1.1 * (v.nrows() as f64 + 4.0) * U * norm::frobenius(v).powi(2);
    (defect < 0.1).then_some(defect)
}
