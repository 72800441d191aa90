//! Sums of a matrix's columns.

use faer::Mat;

/// Σ y_k times column k: coordinates in a basis, lifted to those that the basis is written in.
pub fn combined(columns: &Mat<f64>, y: &[f64]) -> Vec<f64> {
    let row = |i: usize| y.iter().enumerate().map(|(k, y)| columns[(i, k)] * y).sum();
    (0..columns.nrows()).map(row).collect()
}
