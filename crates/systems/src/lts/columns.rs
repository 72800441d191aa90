//! The effective stiffness in sparse doubles: every C_j by columns, and how far it is from the one that is
//! meant.

use super::scheme::Level;
use crate::levels::sparse::{Pattern, Triplets};
use number::{Result, U};

/// Some rows and columns of A, and how far they are from what is meant.
#[derive(Clone, Debug)]
pub struct Block {
    pub pattern: Pattern,
    pub values: Vec<f64>,
    pub error: f64,
}

impl Block {
    /// Its largest eigenvalue, enclosed to `within` of itself or as near as doubles can decide; `None` where
    /// it is not positive.
    pub fn largest(&self, within: f64) -> Option<(f64, f64)> {
        self.pattern.largest(&self.values, self.error, within)
    }
}

/// C_j of f, j from 1 on.
pub fn effective(whole: Sparse, levels: &[Level]) -> Vec<Sparse> {
    let n = whole.size();
    let all: f64 = levels.iter().map(|level| f64::from(level.substeps)).product();
    let finest = vec![whole.scaled(1.0 / (2.0 * all * all))];
    let found = levels.iter().rev().fold(finest, |sparses, level| {
        let mut is_fine = vec![false; n];
        level.fine.iter().for_each(|&i| is_fine[i] = true);
        substeps(&sparses, &is_fine, level.substeps)
    });
    found.into_iter().map(|sparse| sparse.scaled(2.0)).collect()
}

/// W_p(1 − S P) S as polynomials in dt², lowest first.
fn substeps(sparses: &[Sparse], is_fine: &[bool], substeps: u32) -> Vec<Sparse> {
    let (mut before, mut now): (Vec<Sparse>, Vec<Sparse>) = (Vec::new(), sparses.to_vec());
    for _ in 1..substeps {
        let coefficient = |j: usize| {
            let of = |all: &[Sparse]| all.get(j).cloned();
            let (now_j, own_j, before_j) = (of(&now), of(sparses), of(&before));
            let sums: Vec<(f64, &Sparse)> = [(2.0, &now_j), (2.0, &own_j), (-1.0, &before_j)]
                .into_iter()
                .filter_map(|(a, m)| Some((a, m.as_ref()?)))
                .collect();
            // Places j − 1 stand for dt^2j.
            let product = |i: usize| Some((-2.0, sparses.get(i)?, now.get(j.checked_sub(i + 1)?)?));
            let products: Vec<_> = (0..j).filter_map(product).collect();
            Sparse::combined(is_fine, &sums, &products)
        };
        let next = (0..sparses.len() + now.len()).map(coefficient).collect();
        (before, now) = (now, next);
    }
    now
}

/// A sparse matrix by columns, and how far it is from the one that is meant, by sums of |entries| of rows and
/// of columns alike.
#[derive(Clone, Debug)]
pub struct Sparse {
    ends: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    pub error: f64,
    /// The largest sum of |entries| of a row or a column.
    size: f64,
}

impl Sparse {
    /// From its lower triangle, weighed with masses: two roots, their product, the quotient.
    pub fn symmetric(n: usize, lower: &Triplets) -> Sparse {
        let upper = lower.iter().filter(|triple| triple.0 != triple.1).map(|&(i, j, x)| (j, i, x));
        let mut all: Vec<_> = lower.iter().copied().chain(upper).collect();
        all.sort_by_key(|triple| (triple.1, triple.0));
        let mut sparse =
            Sparse { ends: vec![0; n + 1], rows: Vec::new(), values: Vec::new(), error: 0.0, size: 0.0 };
        for (i, j, x) in all {
            sparse.ends[j + 1] += 1;
            sparse.rows.push(i);
            sparse.values.push(x);
        }
        (0..n).for_each(|j| sparse.ends[j + 1] += sparse.ends[j]);
        sparse.size = sparse.sums();
        sparse.error = 4.1 * U * sparse.size;
        sparse
    }

    pub fn size(&self) -> usize {
        self.ends.len() - 1
    }

    fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        (self.ends[j]..self.ends[j + 1]).map(|at| (self.rows[at], self.values[at]))
    }

    pub fn sums(&self) -> f64 {
        let mut rows = vec![0.0; self.size()];
        let mut most = 0.0f64;
        for j in 0..self.size() {
            self.column(j).for_each(|(i, x)| rows[i] += x.abs());
            most = most.max(self.column(j).map(|(_, x)| x.abs()).sum());
        }
        // Sums of n terms at most.
        rows.into_iter().fold(most, f64::max) * (1.0 + (self.size() as f64 + 2.0) * U)
    }

    pub fn scaled(mut self, by: f64) -> Sparse {
        self.values.iter_mut().for_each(|x| *x *= by);
        self.size *= by.abs() * (1.0 + 2.0 * U);
        // Of the factor and of each product.
        self.error = self.error * by.abs() * (1.0 + 2.0 * U) + 3.0 * U * self.size;
        self
    }

    pub fn lower(&self) -> Vec<(usize, usize, f64)> {
        (0..self.size())
            .flat_map(|j| self.column(j).filter(move |pair| pair.0 >= j).map(move |(i, x)| (i, j, x)))
            .collect()
    }

    /// These rows and columns, in increasing order.
    pub fn block(&self, kept: impl ExactSizeIterator<Item = usize>) -> Result<Block> {
        let (mut place, count) = (vec![usize::MAX; self.size()], kept.len());
        kept.enumerate().for_each(|(new, old)| place[old] = new);
        let is_kept =
            |triple: &&(usize, usize, f64)| place[triple.0] != usize::MAX && place[triple.1] != usize::MAX;
        let lower = self.lower();
        let triples: Vec<_> =
            lower.iter().filter(is_kept).map(|&(i, j, x)| (place[i], place[j], x)).collect();
        let (pattern, [values]) = Pattern::of(count, [&triples])?;
        Ok(Block { pattern, values, error: self.error })
    }

    /// Σ a A + Σ b S P B, P on the fine degrees of freedom.
    fn combined(is_fine: &[bool], sums: &[(f64, &Sparse)], products: &[(f64, &Sparse, &Sparse)]) -> Sparse {
        let n = is_fine.len();
        let mut sparse = Sparse {
            ends: Vec::with_capacity(n + 1),
            rows: Vec::new(),
            values: Vec::new(),
            error: 0.0,
            size: 0.0,
        };
        sparse.ends.push(0);
        let (mut sum, mut seen, mut touched) = (vec![0.0; n], vec![usize::MAX; n], Vec::new());
        let mut most = 0;
        for j in 0..n {
            let mut terms = sums.len();
            let mut add = |i: usize, x: f64| {
                if seen[i] != j {
                    seen[i] = j;
                    sum[i] = 0.0;
                    touched.push(i);
                }
                sum[i] += x;
            };
            for (a, matrix) in sums {
                matrix.column(j).for_each(|(i, x)| add(i, a * x));
            }
            for (b, left, right) in products {
                for (k, y) in right.column(j).filter(|(k, _)| is_fine[*k]) {
                    terms += 1;
                    left.column(k).for_each(|(i, x)| add(i, b * x * y));
                }
            }
            most = most.max(terms);
            touched.sort_unstable();
            for i in touched.drain(..) {
                sparse.rows.push(i);
                sparse.values.push(sum[i]);
            }
            sparse.ends.push(sparse.rows.len());
        }
        sparse.size = sparse.sums();
        // The errors of the parts, and the roundings: two for each product, for the sums as many as terms.
        let carried: f64 = sums.iter().map(|(a, m)| a.abs() * m.error).sum::<f64>()
            + products
                .iter()
                .map(|(b, s, v)| b.abs() * (s.error * (v.size + v.error) + s.size * v.error))
                .sum::<f64>();
        let sizes: f64 = sums.iter().map(|(a, m)| a.abs() * m.size).sum::<f64>()
            + products.iter().map(|(b, s, v)| b.abs() * s.size * v.size).sum::<f64>();
        sparse.error = 1.01 * (carried + (most as f64 + 3.0) * U * sizes);
        sparse
    }
}
