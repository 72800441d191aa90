//! Eigenvalues of small dense matrices in doubles, without bounds, for those who import this crate: faer's
//! generic code is compiled here alone.

use faer::{Mat, Side};
use num_complex::Complex;

/// All eigenvalues of the symmetric matrix of n rows with these entries; `None` where faer finds none.
pub fn symmetric_eigenvalues(n: usize, entry: &dyn Fn(usize, usize) -> f64) -> Option<Vec<f64>> {
    Mat::from_fn(n, n, entry).self_adjoint_eigenvalues(Side::Lower).ok()
}

/// All eigenvalues of a matrix and the real parts of its eigenvectors, its columns; `None` where faer finds
/// none.
pub fn eigen(matrix: &Mat<f64>) -> Option<(Vec<Complex<f64>>, Mat<f64>)> {
    let (n, eigen) = (matrix.nrows(), matrix.eigen().ok()?);
    let values = (0..n).map(|k| eigen.S()[k]).collect();
    Some((values, Mat::from_fn(n, n, |i, k| eigen.U()[(i, k)].re)))
}
