//! The eigenbasis of a symmetric matrix, block by block where it decouples: molecules whose bonds do not join
//! them.

use faer::{Mat, Side};

use crate::half::compose::connected;
use crate::signs::inertia::backward_error;

/// V and Λ, V block-diagonal but for the order of rows and columns.
pub(super) struct Basis {
    /// Λ, increasing.
    pub values: Vec<f64>,
    blocks: Vec<Block>,
}

/// Rows that no entry joins to others.
struct Block {
    rows: Vec<usize>,
    /// Where its eigenvalues are among all.
    places: Vec<usize>,
    values: Vec<f64>,
    vectors: Mat<f64>,
}

impl Basis {
    /// `None` where the eigenvalue iteration fails: never seen, but not excluded.
    pub fn new(m: &Mat<f64>) -> Option<Basis> {
        let of_column = |j: usize| m.col_as_slice(j).iter().enumerate().filter(|(_, x)| **x != 0.0);
        let places = (0..m.ncols()).flat_map(|j| of_column(j).map(move |(i, _)| (i, j)));
        let parts = connected(m.nrows(), places);
        let mut blocks = parts.into_iter().map(|rows| Block::new(m, rows)).collect::<Option<Vec<_>>>()?;
        let own =
            |(b, block): (usize, &Block)| (0..block.rows.len()).map(move |k| (b, k)).collect::<Vec<_>>();
        let mut order: Vec<(usize, usize)> = blocks.iter().enumerate().flat_map(own).collect();
        let value = |blocks: &[Block], (b, k): (usize, usize)| blocks[b].values[k];
        order.sort_by(|x, y| value(&blocks, *x).total_cmp(&value(&blocks, *y)));
        let values = order.iter().map(|at| value(&blocks, *at)).collect();
        order.iter().enumerate().for_each(|(place, (b, k))| blocks[*b].places[*k] = place);
        Some(Basis { values, blocks })
    }

    /// As [`backward_error`]: of a block-diagonal matrix the largest of its blocks'.
    pub fn backward_error(&self, m: &Mat<f64>) -> Option<(f64, f64)> {
        let own = |block: &Block| backward_error(&block.of(m), &block.vectors, &block.values);
        let both = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.max(c), b.max(d));
        self.blocks.iter().map(own).try_fold((0.0, 0.0), |worst, pair| Some(both(worst, pair?)))
    }

    /// Vᵀ m V.
    pub fn turned(&self, m: &Mat<f64>) -> Mat<f64> {
        match self.blocks.as_slice() {
            [block] => block.vectors.transpose() * m * &block.vectors,
            _ => self.times(&self.times(m).transpose().to_owned()).transpose().to_owned(),
        }
    }

    /// m V.
    fn times(&self, m: &Mat<f64>) -> Mat<f64> {
        let mut product = Mat::zeros(m.nrows(), m.ncols());
        for block in &self.blocks {
            let columns = Mat::from_fn(m.nrows(), block.rows.len(), |i, k| m[(i, block.rows[k])]);
            let matrix = columns * &block.vectors;
            for (k, &place) in block.places.iter().enumerate() {
                product.col_as_slice_mut(place).copy_from_slice(matrix.col_as_slice(k));
            }
        }
        product
    }

    /// V.
    pub fn vectors(&self) -> Mat<f64> {
        let n = self.values.len();
        let mut all = Mat::zeros(n, n);
        for block in &self.blocks {
            for (k, &place) in block.places.iter().enumerate() {
                block.rows.iter().enumerate().for_each(|(l, &i)| all[(i, place)] = block.vectors[(l, k)]);
            }
        }
        all
    }
}

impl Block {
    fn new(m: &Mat<f64>, rows: Vec<usize>) -> Option<Block> {
        let k = rows.len();
        let mut block = Block { rows, places: vec![0; k], values: Vec::new(), vectors: Mat::new() };
        let eigen = block.of(m).self_adjoint_eigen(Side::Lower).ok()?;
        block.vectors = eigen.U().to_owned();
        block.values = (0..k).map(|i| eigen.S()[i]).collect();
        Some(block)
    }

    fn of(&self, m: &Mat<f64>) -> Mat<f64> {
        let k = self.rows.len();
        Mat::from_fn(k, k, |i, j| m[(self.rows[i], self.rows[j])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::half::norm;

    /// Molecules of three degrees of freedom whose rows are far apart.
    #[test]
    fn blocks_give_the_eigenbasis_of_the_whole() {
        let (n, molecules) = (12, 4);
        let entry = |i: usize, j: usize| match (i % molecules == j % molecules, i == j) {
            (true, true) => 1.0 + ((7 * i) % 5) as f64,
            (true, false) => 0.25 + ((i * j) % 3) as f64 / 8.0,
            _ => 0.0,
        };
        let m = Mat::from_fn(n, n, entry);
        let basis = Basis::new(&m).unwrap();
        assert_eq!(basis.blocks.len(), molecules);
        let whole = m.self_adjoint_eigenvalues(Side::Lower).unwrap();
        assert!(basis.values.iter().zip(&whole).all(|(x, y)| (x - y).abs() < 1e-13));
        let (error, defect) = basis.backward_error(&m).unwrap();
        let v = basis.vectors();
        let diagonal = Mat::from_fn(n, n, |i, j| if i == j { basis.values[i] } else { 0.0 });
        // Products of twelve terms of some units.
        assert!(norm::frobenius(&(&m * &v - &v * &diagonal)) < 1e-13);
        assert!(norm::frobenius(&(basis.turned(&m) - &diagonal)) < 1e-13);
        let other = Mat::from_fn(n, n, |i, j| ((3 * i * j + i + j) % 7) as f64);
        assert!(norm::frobenius(&(basis.turned(&other) - v.transpose() * &other * &v)) < 1e-12);
        assert!(error < 1e-12 && defect < 1e-12);
    }
}
