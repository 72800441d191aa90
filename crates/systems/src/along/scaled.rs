//! Hessians in coordinates in which positions and momenta are of one size.

use faer::Mat;
use nalgebra::DMatrix;

use crate::half::norm;
use crate::half::period::Stiffness;

/// The mean frequency of single degrees of freedom, per unit time.
pub fn frequency(masses: &[f64], hessians: &[Vec<DMatrix<f64>>]) -> f64 {
    let first = hessians.iter().flatten();
    let squares: f64 =
        first.map(|k| (0..masses.len()).map(|i| (k[(i, i)] / masses[i]).abs()).sum::<f64>()).sum();
    let count = (hessians.iter().map(Vec::len).sum::<usize>() * masses.len()).max(1) as f64;
    (squares / count).sqrt()
}

/// For each degree of freedom a power of two near √(m ω), ω the mean frequency a tick, so that positions and
/// momenta are of one size.
pub fn scales(masses: &[f64], hessians: &[Vec<DMatrix<f64>>], tick: f64) -> Vec<f64> {
    let omega = frequency(masses, hessians) * tick;
    masses.iter().map(|m| power(m * omega)).collect()
}

/// The power of two next to the root.
pub fn power(square: f64) -> f64 {
    let root = square.sqrt();
    if root.is_normal() { root.log2().round().clamp(-300.0, 300.0).exp2() } else { 1.0 }
}

/// From one in so many entries on a product of whole matrices takes less time than one of rows.
const DENSE: usize = 8;

/// factor K_ij/(a_i a_j), K_ij as the mean of itself and K_ji.
pub struct Scaled(pub Mat<f64>);

pub fn scaled(k: &DMatrix<f64>, factor: f64, a: &[f64]) -> Scaled {
    Scaled(Mat::from_fn(a.len(), a.len(), |i, j| {
        (k[(i, j)] / 2.0 + k[(j, i)] / 2.0) * factor / (a[i] * a[j])
    }))
}

impl Scaled {
    /// The root of the sum of squares, rounded.
    pub fn frobenius(&self) -> f64 {
        let n = self.0.nrows();
        (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|at| self.0[at] * self.0[at]).sum::<f64>().sqrt()
    }

    /// More than the 2-norm.
    pub fn size(&self, n: usize) -> f64 {
        // 1.01: the roundings of its entries.
        if n == 1 { 1.01 * self.0[(0, 0)].abs() } else { 1.01 * norm::spectral(&self.0) }
    }

    pub fn stiffness(self) -> Stiffness {
        let n = self.0.nrows();
        let row =
            |i: usize| (0..n).map(|j| (j, self.0[(i, j)])).filter(|(_, x)| *x != 0.0).collect::<Vec<_>>();
        let rows: Vec<_> = (0..n).map(|i| (i, row(i))).filter(|(_, row)| !row.is_empty()).collect();
        let filled: usize = rows.iter().map(|(_, row)| row.len()).sum();
        if DENSE * filled > n * n { Stiffness::Whole(self.0) } else { Stiffness::Rows(rows) }
    }
}
