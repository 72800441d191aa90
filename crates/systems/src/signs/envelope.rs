//! Sparse symmetric matrices of doubles, each row kept from its first entry on, and the signs that Cholesky's
//! factorization proves.
//!
//! Elimination does not leave the envelope. Its cost is N w² for N rows of w entries: small where unknowns
//! that meet stand close together in the order, as [`narrow`] finds one (Cuthill and McKee, reversed).

use std::collections::VecDeque;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat};

use number::U;

/// The lower triangle by rows, row i from the column `first[i]` to the diagonal, and what its entries are
/// made of.
#[derive(Clone, Debug)]
pub(crate) struct Envelope {
    first: Vec<usize>,
    rows: Vec<Vec<f64>>,
    /// For each row the sum of the sizes of all terms that were added to its entries, on both sides of the
    /// diagonal.
    sizes: Vec<f64>,
}

/// A proven property of a symmetric matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// It is positive definite.
    Positive,
    /// It has a negative eigenvalue.
    Negative,
}

impl Envelope {
    /// Zeros, row i beginning at `first[i]` ≤ i.
    pub fn new(first: Vec<usize>) -> Self {
        let rows = first.iter().enumerate().map(|(i, &j)| vec![0.0; i + 1 - j]).collect();
        Envelope { sizes: vec![0.0; first.len()], first, rows }
    }

    /// The products of an elimination.
    pub fn products(&self) -> f64 {
        self.rows.iter().map(|row| (row.len() as f64).powi(2) / 2.0).sum()
    }

    /// Adds x to the entries (i, j) and (j, i), once if i = j; j must not lie left of the envelope.
    pub fn add(&mut self, i: usize, j: usize, x: f64) {
        let (i, j) = (i.max(j), i.min(j));
        self.rows[i][j - self.first[i]] += x;
        self.sizes[i] += x.abs();
        if i != j {
            self.sizes[j] += x.abs();
        }
    }

    /// The sign of the true matrix, as far as it is proven. Its entries are sums of at most `terms` terms,
    /// each added here within `roundings` u.
    ///
    /// Definite: Rump's criterion (BIT 46, 2006). Where L Lᵀ of m − c I runs to its end, it differs from it
    /// by at most γ (m_ii m_jj)^½ at each place of the envelope, γ for w + 1 roundings: in norm by γ tr m,
    /// and by γ max m_ii times the most entries of a row. Not: where a pivot is not positive, the elimination
    /// itself gives a z with zᵀ (m − c I) z no greater; the number zᵀ m z, computed with a bound, is a proof
    /// for any z.
    pub fn sign(&self, terms: usize, roundings: usize) -> Option<Sign> {
        let slack = self.slack(terms, roundings);
        match self.stopped(self.shift(slack)) {
            None => Some(Sign::Positive),
            Some(z) => self.is_negative(&z, slack).then_some(Sign::Negative),
        }
    }

    /// Whether that is proven positive, of rows in blocks of n of which each meets only itself and the one
    /// before: the same criterion, by products of blocks, which no order of summation matters to.
    pub fn is_positive_in_blocks(&self, n: usize, terms: usize, roundings: usize) -> bool {
        let shift = self.shift(self.slack(terms, roundings));
        let entry = |i: usize, j: usize| {
            let value = j.checked_sub(self.first[i]).and_then(|place| self.rows[i].get(place));
            value.copied().unwrap_or(0.0)
        };
        let threads = faer::get_global_parallelism();
        let mut room = MemBuffer::new(cholesky_in_place_scratch::<f64>(n, threads, Default::default()));
        let mut before: Option<Mat<f64>> = None;
        for top in (0..self.rows.len()).step_by(n) {
            let lower = |i: usize, j: usize| if i >= j { entry(top + i, top + j) } else { 0.0 };
            let mut matrix = Mat::from_fn(n, n, |i, j| lower(i, j) - if i == j { shift } else { 0.0 });
            if let Some(factor) = before {
                let mut beside = Mat::from_fn(n, n, |i, j| entry(top + j, top - n + i));
                solve_lower_triangular_in_place(factor.as_ref(), beside.as_mut(), threads);
                let left = beside.transpose();
                matmul(matrix.as_mut(), Accum::Add, left, beside.as_ref(), -1.0, threads);
            }
            let none = Default::default();
            let is_done = cholesky_in_place(
                matrix.as_mut(),
                none,
                threads,
                MemStack::new(&mut room),
                Default::default(),
            );
            if is_done.is_err() || (0..n).any(|i| !matrix[(i, i)].is_finite()) {
                return false;
            }
            before = Some(matrix);
        }
        true
    }

    /// By how much Cholesky's factorization is run below the matrix, whose true one is within `slack`.
    fn shift(&self, slack: f64) -> f64 {
        let largest = |x: &[f64]| x.iter().copied().fold(0.0, f64::max);
        let width = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let diagonal: Vec<f64> = self.rows.iter().map(|row| row[row.len() - 1].abs()).collect();
        let norm = diagonal.iter().sum::<f64>().min(self.most_entries() as f64 * largest(&diagonal));
        let n = self.rows.len() as f64;
        // 24: the rounding of the shifted diagonal, roots and the sums here.
        1.01 * (slack + (width as f64 + 24.0) * U * norm) + f64::MIN_POSITIVE * (n + 1.0).powi(2)
    }

    /// How far (2-norm) the true matrix can be: ‖E‖₂ ≤ ‖E‖_∞ for symmetric E; a sum of k terms makes k − 1
    /// roundings.
    fn slack(&self, terms: usize, roundings: usize) -> f64 {
        1.01 * (terms + roundings) as f64 * U * self.sizes.iter().copied().fold(0.0, f64::max)
    }

    /// A bound on the number of negative eigenvalues of the true matrix, as in [`Envelope::sign`]: no fewer
    /// than the least are negative, no more than the other one negative or 0; `None` where elimination
    /// without exchanges is too far from the matrix.
    ///
    /// L D Lᵀ of m ± c I that runs to its end differs from it by at most γ |L| |D| |Lᵀ|, γ for two roundings
    /// more than a row has entries (Higham, Accuracy and Stability, section 10.1): where that and the errors
    /// of m are within c, Sylvester's law gives the count.
    pub fn negatives(&self, terms: usize, roundings: usize, is_least: bool) -> Option<usize> {
        self.pivots(self.slack(terms, roundings), if is_least { 1.0 } else { -1.0 })
    }

    /// The negative pivots of the matrix moved by c I of this sign, c more than all errors; `None` where no c
    /// tried is.
    fn pivots(&self, slack: f64, sign: f64) -> Option<usize> {
        let width = self.rows.iter().map(Vec::len).max().unwrap_or(0) as f64;
        let gamma = 1.01 * (width + 8.0) * U;
        let mut shift = 2.0 * slack + 64.0 * gamma;
        for _ in 0..4 {
            if let Some((negative, size)) = self.eliminated(sign * shift) {
                let off = 1.01 * (slack + gamma * size + 2.0 * U * shift);
                if off <= shift {
                    return Some(negative);
                }
                shift = 2.0 * off;
            } else {
                shift *= 4.0;
            }
        }
        None
    }

    /// The negative pivots of L D Lᵀ = m + shift I, and the largest sum of a row of |L| |D| |Lᵀ|; `None`
    /// where a pivot vanishes.
    fn eliminated(&self, shift: f64) -> Option<(usize, f64)> {
        let n = self.rows.len();
        let (mut factor, mut d): (Vec<Vec<f64>>, Vec<f64>) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for (i, values) in self.rows.iter().enumerate() {
            // u_ij = l_ij d_j.
            let (mut u, first) = (values.clone(), self.first[i]);
            for j in first..i {
                let (other, start) = (&factor[j], self.first[j].max(first));
                u[j - first] -= dot(&u[start - first..j - first], &other[start - self.first[j]..]);
            }
            let pivot = u.pop().expect("a diagonal entry") + shift;
            let l: Vec<f64> = u.iter().zip(&d[first..]).map(|(u, d)| u / d).collect();
            let pivot = pivot - dot(&u, &l);
            if !pivot.is_normal() {
                return None;
            }
            d.push(pivot);
            factor.push(l);
        }
        let mut sums: Vec<f64> = vec![1.0; n];
        for (i, l) in factor.iter().enumerate() {
            sums[self.first[i]..i].iter_mut().zip(l).for_each(|(sum, l)| *sum += l.abs());
        }
        sums.iter_mut().zip(&d).for_each(|(sum, d)| *sum *= d.abs());
        let row = |(i, l): (usize, &Vec<f64>)| {
            sums[i] + l.iter().zip(&sums[self.first[i]..]).map(|(l, sum)| l.abs() * sum).sum::<f64>()
        };
        let size = factor.iter().enumerate().map(row).fold(0.0, f64::max);
        Some((d.iter().filter(|d| **d < 0.0).count(), size))
    }

    /// The most entries in a row of the whole matrix.
    fn most_entries(&self) -> usize {
        // Row k reaches the columns first[k] to k.
        let mut reached = vec![0isize; self.first.len() + 1];
        for (k, &first) in self.first.iter().enumerate() {
            reached[first] += 1;
            reached[k] -= 1;
        }
        let mut below = 0;
        let count = |(k, row): (usize, &Vec<f64>)| {
            below += reached[k];
            row.len() + below.unsigned_abs()
        };
        self.rows.iter().enumerate().map(count).max().unwrap_or(0)
    }

    /// `None` where Cholesky's factorization of the matrix less `shift` I runs to its end; else a vector on
    /// which the form is what the pivot is that stopped it.
    fn stopped(&self, shift: f64) -> Option<Vec<f64>> {
        let mut factor: Vec<Vec<f64>> = Vec::with_capacity(self.rows.len());
        for (i, values) in self.rows.iter().enumerate() {
            let (mut row, first) = (values.clone(), self.first[i]);
            for j in first..i {
                let (other, start) = (&factor[j], self.first[j].max(first));
                let (left, right) = (&row[start - first..j - first], &other[start - self.first[j]..]);
                row[j - first] = (row[j - first] - dot(left, right)) / other[other.len() - 1];
            }
            let (last, before) = row.split_last_mut().expect("a diagonal entry");
            *last = *last - shift - dot(before, before);
            // A pivot that is no number stops it, too.
            if !last.is_finite() || *last <= 0.0 {
                return Some(self.direction(&factor, before));
            }
            *last = last.sqrt();
            factor.push(row);
        }
        None
    }

    /// z = (y, 1, 0, ...) with Lᵀ y = −l, l the row of the factor that was begun last.
    fn direction(&self, factor: &[Vec<f64>], last: &[f64]) -> Vec<f64> {
        let k = factor.len();
        let mut z = vec![0.0; self.rows.len()];
        z[k] = 1.0;
        z[k - last.len()..k].iter_mut().zip(last).for_each(|(z, l)| *z = -l);
        for (i, row) in factor.iter().enumerate().rev() {
            let (pivot, before) = row.split_last().expect("a diagonal entry");
            z[i] /= pivot;
            let value = z[i];
            z[self.first[i]..i].iter_mut().zip(before).for_each(|(z, l)| *z -= l * value);
        }
        z
    }

    /// Whether zᵀ m z < 0 for all m within `slack`: each product makes two roundings, each row and their sum
    /// as many more as they have terms.
    fn is_negative(&self, z: &[f64], slack: f64) -> bool {
        let (mut value, mut size) = (0.0, 0.0);
        let mut width = 0;
        for (i, row) in self.rows.iter().enumerate() {
            let (last, before) = row.split_last().expect("a diagonal entry");
            let others = before.iter().zip(&z[self.first[i]..i]);
            let (sum, sizes) = others
                .fold((0.0, 0.0), |(sum, sizes): (f64, f64), (m, z)| (sum + m * z, sizes + (m * z).abs()));
            value += z[i] * (2.0 * sum + last * z[i]);
            size += z[i].abs() * (2.0 * sizes + (last * z[i]).abs());
            width = width.max(row.len());
        }
        let square: f64 = z.iter().map(|z| z * z).sum();
        let rounding = (width + z.len() + 8) as f64 * U * size;
        value < -1.01 * (rounding + slack * square) - f64::MIN_POSITIVE * (z.len() as f64).powi(2)
    }
}

/// Σ x_i y_i in eight sums side by side.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (x, y) = (x.chunks_exact(8), y[..x.len()].chunks_exact(8));
    let rest: f64 = x.remainder().iter().zip(y.remainder()).map(|(x, y)| x * y).sum();
    let mut sums = [0.0; 8];
    for (x, y) in x.zip(y) {
        sums.iter_mut().zip(x.iter().zip(y)).for_each(|(sum, (x, y))| *sum += x * y);
    }
    rest + sums.iter().sum::<f64>()
}

/// An order of the vertices of a graph in which neighbours stand close together: breadth first from a vertex
/// at its rim, those of few neighbours first, all reversed (Cuthill and McKee 1969; George 1971).
pub fn narrow(graph: &[Vec<usize>]) -> Vec<usize> {
    let (mut order, mut seen) = (Vec::with_capacity(graph.len()), vec![false; graph.len()]);
    for start in 0..graph.len() {
        if !seen[start] {
            // The last one that a search meets is at the rim; once more from there.
            let rim =
                (0..2).fold(start, |at, _| *breadth(graph, at, &mut seen.clone()).last().unwrap_or(&at));
            order.extend(breadth(graph, rim, &mut seen));
        }
    }
    order.reverse();
    order
}

fn breadth(graph: &[Vec<usize>], start: usize, seen: &mut [bool]) -> Vec<usize> {
    let (mut order, mut queue) = (Vec::new(), VecDeque::from([start]));
    seen[start] = true;
    while let Some(at) = queue.pop_front() {
        order.push(at);
        let mut next: Vec<usize> = graph[at].iter().copied().filter(|&j| !seen[j]).collect();
        next.sort_by_key(|&j| (graph[j].len(), j));
        for j in next {
            seen[j] = true;
            queue.push_back(j);
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second difference on a ring of n points, its diagonal `middle`: eigenvalues middle − 2 cos(2π
    /// k/n).
    fn ring(n: usize, middle: f64) -> Envelope {
        let graph: Vec<Vec<usize>> = (0..n).map(|i| vec![(i + n - 1) % n, (i + 1) % n]).collect();
        let order = narrow(&graph);
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(k, &i)| place[i] = k);
        let mut first: Vec<usize> = (0..n).collect();
        for (i, row) in graph.iter().enumerate() {
            row.iter().for_each(|&j| first[place[i]] = first[place[i]].min(place[j]));
        }
        assert!((0..n).all(|k| k - first[k] <= 2), "a ring has an order of width 2");
        let mut matrix = Envelope::new(first);
        for i in 0..n {
            matrix.add(place[i], place[i], middle);
            matrix.add(place[i], place[(i + 1) % n], -1.0);
        }
        matrix
    }

    #[test]
    fn a_matrix_is_proven_definite_or_not_on_both_sides_of_its_edge() {
        for n in [3, 10, 101] {
            assert_eq!(ring(n, 2.0 + 1e-10).sign(2, 0), Some(Sign::Positive));
            assert_eq!(ring(n, 2.0 - 1e-10).sign(2, 0), Some(Sign::Negative));
            // On the edge nothing is claimed.
            assert_eq!(ring(n, 2.0).sign(2, 0), None);
        }
    }
}
