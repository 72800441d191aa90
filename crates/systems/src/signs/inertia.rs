//! Inertias of symmetric matrices in doubles, proven.

use std::cmp::Ordering;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Side};

use crate::half::norm;
use number::U;

/// How many eigenvalues of a symmetric matrix have which sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Inertia {
    pub positive: usize,
    pub negative: usize,
    pub zero: usize,
    /// Those whose sign is not known.
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

    /// The inertia of c times the matrix, c of the sign given.
    pub fn times(self, sign: i8) -> Inertia {
        if sign >= 0 { self } else { Inertia { positive: self.negative, negative: self.positive, ..self } }
    }
}

/// Whether every symmetric matrix within `slack` (2-norm) of the symmetric m is positive definite, by Rump's
/// criterion (Verification of positive definiteness, BIT 46, 2006): if Cholesky's factorization of m − c I
/// runs to its end in doubles, m + c' I is positive definite for c' = γ/(1 − γ) tr m − c; no order of
/// summation or fused product matters. Only the lower triangle of m is read, and m is where it is factored.
pub(crate) fn is_definite(mut m: Mat<f64>, slack: f64) -> bool {
    let n = m.nrows();
    if n == 0 {
        return true;
    }
    let trace: f64 = (0..n).map(|i| m[(i, i)].abs()).sum();
    // γ_(n+1), with room for the reciprocals of pivots, the rounding of the shifted diagonal and of the sums
    // here.
    let shift = 1.01 * (slack + (n as f64 + 24.0) * U * trace) + f64::MIN_POSITIVE * (n as f64 + 1.0).powi(2);
    if !shift.is_finite() || (0..n).any(|i| m[(i, i)] <= shift) {
        return false;
    }
    (0..n).for_each(|i| m[(i, i)] -= shift);
    let threads = faer::get_global_parallelism();
    let mut room = MemBuffer::new(cholesky_in_place_scratch::<f64>(n, threads, Default::default()));
    let none = Default::default();
    cholesky_in_place(m.as_mut(), none, threads, MemStack::new(&mut room), Default::default()).is_ok()
}

/// The inertia that every symmetric matrix within `slack` (2-norm) of the symmetric m has: of a definite one
/// by Cholesky, else by L B Lᵀ, or, where that does not decide all signs, by eigenvalues.
pub fn proven(m: &Mat<f64>, slack: f64) -> Inertia {
    let n = m.nrows();
    if is_definite(m.clone(), slack) {
        return Inertia { positive: n, ..Inertia::default() };
    }
    if is_definite(-m, slack) {
        return Inertia { negative: n, ..Inertia::default() };
    }
    match by_factors(m, m, slack) {
        (Some(negative), Some(most)) if negative == most => {
            Inertia { positive: n - negative, negative, ..Inertia::default() }
        }
        _ => by_eigenvalues(m, slack),
    }
}

/// The inertia by the computed eigenvectors V and eigenvalues Λ, ‖Vᵀ V − I‖ ≤ η: for the
/// orthogonal factor Q of V, ‖Q − V‖ ≤ η, Qᵀ m Q = Λ + E with ‖E‖ ≤ ‖m V − V Λ‖ + η (‖m‖ + ‖Λ‖), and no
/// eigenvalue is farther than ‖E‖ + slack from its place in Λ (Weyl).
fn by_eigenvalues(m: &Mat<f64>, slack: f64) -> Inertia {
    let n = m.nrows();
    let unknown = Inertia { unknown: n, ..Inertia::default() };
    let Ok(eigen) = m.self_adjoint_eigen(Side::Lower) else { return unknown };
    let values: Vec<f64> = (0..n).map(|i| eigen.S()[i]).collect();
    let Some((error, _)) = backward_error(m, &eigen.U().to_owned(), &values) else { return unknown };
    let radius = 1.01 * (error + slack);
    let count = |test: &dyn Fn(f64) -> bool| values.iter().filter(|&&x| test(x)).count();
    let (positive, negative) = (count(&|x| x > radius), count(&|x| x < -radius));
    Inertia { positive, negative, zero: 0, unknown: n - positive - negative }
}

/// Bounds for every symmetric matrix within `slack` (2-norm) of one between `low` ≤ `high` in Loewner's
/// order: at least the first number of its eigenvalues are negative, at most the second number are negative
/// or 0.
pub(crate) fn negative_bounds(low: &Mat<f64>, high: &Mat<f64>, slack: f64) -> (usize, usize) {
    let (least, most) = by_factors(low, high, slack);
    (
        least.unwrap_or_else(|| by_eigenvalues(high, slack).negative),
        most.unwrap_or_else(|| low.nrows() - by_eigenvalues(low, slack).positive),
    )
}

/// These numbers, each where a factorization gives it.
///
/// L B Lᵀ (Bunch and Kaufman 1977) of a matrix moved by c I has the inertia of B (Sylvester), and where it is
/// within c − `slack` of that it lies above, or below, all of them. No eigenvector and no gap between
/// eigenvalues is asked for.
fn by_factors(low: &Mat<f64>, high: &Mat<f64>, slack: f64) -> (Option<usize>, Option<usize>) {
    let least = moved(high, slack, 1.0).map(|inertia| inertia.negative);
    let most = moved(low, slack, -1.0).map(|inertia| inertia.negative + inertia.zero);
    (least, most)
}

/// The inertia of some matrix that is no smaller (sign 1), or no greater (−1), than all within `slack` of m;
/// `None` where the factorization is too far from it.
fn moved(m: &Mat<f64>, slack: f64, sign: f64) -> Option<Inertia> {
    let (n, size) = (m.nrows(), norm::frobenius(m));
    let mut shift = 1.02 * slack + 8.0 * (n as f64 + 16.0) * U * size + f64::MIN_POSITIVE;
    // The room that the check usually needs; once more with twice the room for roundings that it asked for.
    for _ in 0..2 {
        let at = |i: usize, j: usize| m[(i.max(j), i.min(j))] + if i == j { sign * shift } else { 0.0 };
        let matrix = Mat::from_fn(n, n, at);
        let lblt = matrix.lblt(Side::Lower);
        let (order, l) = (lblt.P().arrays().0, lblt.L().to_owned());
        let (diagonal, next) = (lblt.B_diag().column_vector(), lblt.B_subdiag().column_vector());
        let (product, sizes) = times_blocks(&l, &|i| diagonal[i], &|i| next[i]);
        let residual = 1.01 * lower_residual(&matrix, order, &product, &l);
        let products = (n as f64 + 4.0) * norm::frobenius(&product) + 4.0 * sizes;
        let rounding = 1.1 * U * (norm::frobenius(&l) * products + 2.0 * (size + shift * n as f64));
        let off = 1.01 * (residual + rounding + slack);
        if off <= shift {
            return of_blocks(&|i| diagonal[i], &|i| next[i], n);
        }
        shift = 1.02 * slack + 2.0 * (off - slack);
        if !shift.is_finite() {
            break;
        }
    }
    None
}

/// The Frobenius norm of X − L B Lᵀ, X being `own` in the order given and `product` L B, rounded: column by
/// column of the lower triangle, which needs as many columns of L as the last of them has rows.
fn lower_residual(matrix: &Mat<f64>, order: &[usize], product: &Mat<f64>, l: &Mat<f64>) -> f64 {
    const PANEL: usize = 32;
    let (n, threads) = (matrix.nrows(), faer::get_global_parallelism());
    let mut panel = Mat::<f64>::zeros(n, PANEL);
    let mut squares = 0.0;
    for first in (0..n).step_by(PANEL) {
        let (rows, columns) = (n - first, PANEL.min(n - first));
        let last = first + columns;
        // L B reaches a column beyond L's diagonal, where L has nothing.
        let left = product.submatrix(first, 0, rows, last);
        let right = l.submatrix(first, 0, columns, last).transpose();
        matmul(panel.submatrix_mut(first, 0, rows, columns), Accum::Replace, left, right, 1.0, threads);
        for j in first..last {
            let (values, found) = (matrix.col_as_slice(order[j]), &panel.col_as_slice(j - first)[j..]);
            let off = |(&i, x): (&usize, &f64)| (values[i] - x).powi(2);
            let (diagonal, below): (f64, f64) =
                (off((&order[j], &found[0])), order[j + 1..].iter().zip(&found[1..]).map(off).sum());
            squares += diagonal + 2.0 * below;
        }
    }
    squares.sqrt()
}

/// L B, and the Frobenius norm of |L| |B|, for a block-diagonal B.
fn times_blocks(
    l: &Mat<f64>,
    diagonal: &dyn Fn(usize) -> f64,
    next: &dyn Fn(usize) -> f64,
) -> (Mat<f64>, f64) {
    let n = l.nrows();
    let (mut product, none) = (Mat::zeros(n, n), vec![0.0; n]);
    let mut squares = 0.0;
    for j in 0..n {
        let beside = |k: Option<usize>| k.filter(|&k| k < n).map_or(&none[..], |k| l.col_as_slice(k));
        let (left, values, right) = (beside(j.checked_sub(1)), l.col_as_slice(j), beside(Some(j + 1)));
        let (a, b, c) =
            (j.checked_sub(1).map_or(0.0, next), diagonal(j), if j + 1 < n { next(j) } else { 0.0 });
        let terms = left.iter().zip(values).zip(right).map(|((x, y), z)| [a * x, b * y, c * z]);
        for (to, [x, y, z]) in product.col_as_slice_mut(j).iter_mut().zip(terms) {
            *to = x + y + z;
            let size = x.abs() + y.abs() + z.abs();
            squares += size * size;
        }
    }
    (product, 1.01 * f64::sqrt(squares))
}

/// The inertia of a block-diagonal B of 1 x 1 and 2 x 2 blocks, the latter where the entry below the diagonal
/// is not 0; `None` where one of these is not indefinite for sure.
fn of_blocks(diagonal: &dyn Fn(usize) -> f64, next: &dyn Fn(usize) -> f64, n: usize) -> Option<Inertia> {
    let (mut found, mut i) = (Inertia::default(), 0);
    while i < n {
        if i + 1 < n && next(i) != 0.0 {
            let (square, product) = (next(i) * next(i), diagonal(i) * diagonal(i + 1));
            if !square.is_normal() || square * (1.0 - 4.0 * U) <= product {
                return None;
            }
            (found.positive, found.negative, i) = (found.positive + 1, found.negative + 1, i + 2);
        } else {
            match diagonal(i).partial_cmp(&0.0)? {
                Ordering::Less => found.negative += 1,
                Ordering::Equal => found.zero += 1,
                Ordering::Greater => found.positive += 1,
            }
            i += 1;
        }
    }
    Some(found)
}

/// More than ‖E‖₂, Qᵀ m Q = Λ + E for the orthogonal Q nearest to the computed eigenvectors V, and the defect
/// of these; `None` where they are not nearly orthogonal.
pub(crate) fn backward_error(m: &Mat<f64>, v: &Mat<f64>, values: &[f64]) -> Option<(f64, f64)> {
    let defect = orthogonality(v)?;
    let n = m.nrows();
    let scaled = Mat::from_fn(n, n, |i, j| v[(i, j)] * values[j]);
    let largest = values.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    let residual = m * v - &scaled;
    let (size, length) = (norm::frobenius(m), norm::frobenius(v));
    let rounding = 1.1 * (n as f64 + 4.0) * U * length * (size + largest);
    let error = norm::frobenius(&residual) + rounding + 1.01 * defect * (size + largest);
    error.is_finite().then_some((error, defect))
}

/// More than ‖Vᵀ V − I‖₂; `None` from 1/10 on.
pub(crate) fn orthogonality(v: &Mat<f64>) -> Option<f64> {
    let k = v.ncols();
    let gram = v.transpose() * v - Mat::<f64>::identity(k, k);
    let defect = norm::frobenius(&gram) + 1.1 * (v.nrows() as f64 + 4.0) * U * norm::frobenius(v).powi(2);
    (defect < 0.1).then_some(defect)
}

/// A proven upper bound of ‖m‖₂ of every symmetric matrix within `slack`, close to it: t I ± m are definite.
pub(crate) fn spectral_norm(m: &Mat<f64>, slack: f64) -> f64 {
    let n = m.nrows();
    let largest = m
        .self_adjoint_eigenvalues(Side::Lower)
        .map_or(f64::INFINITY, |values| values.iter().fold(0.0, |a: f64, x| a.max(x.abs())));
    let mut bound = largest * 1.0001 + 2.0 * slack;
    let whole = norm::frobenius(m) + slack;
    while bound < whole {
        let shifted =
            |sign: f64| Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) * bound + sign * m[(i, j)]);
        if is_definite(shifted(1.0), slack) && is_definite(shifted(-1.0), slack) {
            return bound;
        }
        bound *= 1.001;
    }
    whole
}

/// From so many rows on eigenvalues cost more than they give.
const LARGE: usize = 256;

/// A proven b ≥ 0 with m + b I ≥ 0 for every symmetric matrix within `slack` of m: close to the least, of
/// large matrices by sums of rows (Gershgorin); infinite where doubles find none.
pub(crate) fn lack(m: &Mat<f64>, slack: f64) -> f64 {
    let n = m.nrows();
    if n > LARGE {
        let row = |i: usize| (0..n).map(|j| m[(i, j)].abs()).sum::<f64>() - m[(i, i)].abs() - m[(i, i)];
        return 1.01 * ((0..n).map(row).fold(0.0, f64::max) + slack) + f64::MIN_POSITIVE;
    }
    m.self_adjoint_eigenvalues(Side::Lower).map_or(f64::INFINITY, |values| lack_beside(&values, m, slack))
}

/// The same of a matrix with these eigenvalues, rounded, whatever its size.
pub(crate) fn lack_beside(values: &[f64], m: &Mat<f64>, slack: f64) -> f64 {
    let n = m.nrows();
    let (least, largest) =
        values.iter().fold((0.0, 0.0), |(a, b): (f64, f64), x| (a.min(*x), b.max(x.abs())));
    // Farther than the roundings of the proof; twice as far each time.
    let mut more = 2.0 * slack + 4.0 * (n as f64 + 24.0) * U * n as f64 * largest + f64::MIN_POSITIVE;
    while more.is_finite() {
        let bound = more - least;
        if is_definite(
            Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) * bound + m[(i, j)]),
            1.01 * slack,
        ) {
            return bound;
        }
        more *= 2.0;
    }
    f64::INFINITY
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::Numbers;

    #[test]
    fn counts_of_negative_eigenvalues_enclose_those_of_all_matrices_near() {
        let mut numbers = Numbers(7);
        for n in [1, 2, 5, 20] {
            let g = Mat::from_fn(n, n, |_, _| numbers.signed());
            // Entries of many sizes.
            let m = Mat::from_fn(n, n, |i, j| (g[(i, j)] + g[(j, i)]) * 0.5f64.powi((i + j) as i32));
            let values = m.self_adjoint_eigenvalues(Side::Lower).unwrap();
            let below = |bound: f64| values.iter().filter(|&&x| x < bound).count();
            assert_eq!(negative_bounds(&m, &m, 0.0), (below(0.0), below(0.0)));
            // With a slack as wide as the k-th eigenvalue only its sign is unknown.
            for &x in values.iter().filter(|x| x.abs() > 1e-3) {
                let slack = x.abs() * 1.01;
                let (least, most) = negative_bounds(&m, &m, slack);
                assert!(least <= below(-slack) && most >= below(slack), "{least} {most} {slack}");
                assert!(least >= below(-4.0 * slack) && most <= below(4.0 * slack), "{least} {most} {slack}");
            }
        }
        // 0, and a permutation that has no pivot on its diagonal.
        assert_eq!(negative_bounds(&Mat::zeros(3, 3), &Mat::zeros(3, 3), 0.0), (0, 3));
        let swap = Mat::from_fn(4, 4, |i, j| f64::from(u8::from(i + j == 3)));
        assert_eq!(negative_bounds(&swap, &swap, 1e-3), (2, 2));
    }
}
