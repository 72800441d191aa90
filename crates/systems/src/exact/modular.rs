//! Linear algebra over prime fields, and polynomials by their coefficients, lowest first.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use num_bigint::BigInt;

use number::{PrimeField, Rational};

/// The matrix modulo the prime.
pub fn matrix(field: &PrimeField, m: &DMatrix<BigInt>) -> DMatrix<u64> {
    m.map(|x| field.of_big(&x))
}

/// a b.
pub fn times(field: &PrimeField, a: &DMatrix<u64>, b: &DMatrix<u64>) -> DMatrix<u64> {
    DMatrix::from_fn(a.nrows(), b.ncols(), |i, j| {
        (0..a.ncols()).fold(0, |sum, k| field.add(sum, field.mul(a[(i, k)], b[(k, j)])))
    })
}

/// Gauss's elimination in the first columns: the columns of the pivots, and their product with the sign of
/// the exchanges. Pivots are 1 then, with zeros below them; above them, too, where it is `whole` (Jordan).
fn eliminate(field: &PrimeField, m: &mut DMatrix<u64>, columns: usize, whole: bool) -> (Vec<usize>, u64) {
    let (mut pivots, mut product) = (Vec::new(), field.of(1));
    for column in 0..columns {
        let row = pivots.len();
        let Some(pivot) = (row..m.nrows()).find(|&i| m[(i, column)] != 0) else { continue };
        if pivot != row {
            m.swap_rows(row, pivot);
            product = field.sub(0, product);
        }
        product = field.mul(product, m[(row, column)]);
        let inverse = field.invert(m[(row, column)]);
        (column..m.ncols()).for_each(|j| m[(row, j)] = field.mul(m[(row, j)], inverse));
        for i in (if whole { 0 } else { row }..m.nrows()).filter(|&i| i != row) {
            let factor = m[(i, column)];
            (column..m.ncols())
                .for_each(|j| m[(i, j)] = field.sub(m[(i, j)], field.mul(factor, m[(row, j)])));
        }
        pivots.push(column);
    }
    (pivots, product)
}

/// The rank.
pub fn rank(field: &PrimeField, mut m: DMatrix<u64>) -> usize {
    let n = m.ncols();
    eliminate(field, &mut m, n, false).0.len()
}

/// A basis of the vectors that m takes to 0.
pub fn kernel(field: &PrimeField, mut m: DMatrix<u64>) -> Vec<Vec<u64>> {
    let n = m.ncols();
    let (pivots, _) = eliminate(field, &mut m, n, true);
    let vector = |free: usize| {
        let mut vector = vec![0; n];
        vector[free] = field.of(1);
        pivots.iter().enumerate().for_each(|(row, &pivot)| vector[pivot] = field.sub(0, m[(row, free)]));
        vector
    };
    (0..n).filter(|column| !pivots.contains(column)).map(vector).collect()
}

/// 1/m and det m; `None` where that is 0.
pub fn inverse(field: &PrimeField, m: DMatrix<u64>) -> Option<(DMatrix<u64>, u64)> {
    let n = m.nrows();
    let mut both = m.resize_horizontally(2 * n, 0);
    (0..n).for_each(|i| both[(i, n + i)] = field.of(1));
    let (pivots, determinant) = eliminate(field, &mut both, n, true);
    (pivots.len() == n).then(|| (both.columns(n, n).into_owned(), determinant))
}

/// The rank modulo a prime of rows of rationals, of n columns, which is no larger than the true one; `None`
/// where the prime divides a denominator.
pub(crate) fn rank_of(rows: &[BTreeMap<usize, Rational>], n: usize) -> Option<usize> {
    let field = PrimeField::LARGEST;
    let mut m = DMatrix::from_element(rows.len(), n, 0);
    for (i, row) in rows.iter().enumerate() {
        for (&j, x) in row {
            m[(i, j)] = field.of_rational(x)?;
        }
    }
    Some(rank(&field, m))
}

/// The coefficients of det(z − m), lowest first, monic; by reduction to Hessenberg's form.
pub(crate) fn characteristic(field: &PrimeField, mut m: DMatrix<u64>) -> Vec<u64> {
    reduce_to_hessenberg(field, &mut m);
    // f_k = det(z − leading k x k) = (z − m_kk) f_(k−1) − Σ_i m_ik (subdiagonals i+1..k) f_(i−1).
    let mut f: Vec<Vec<u64>> = vec![vec![field.of(1)]];
    for k in 0..m.nrows() {
        let mut next = vec![0; k + 2];
        for (j, &c) in f[k].iter().enumerate() {
            next[j + 1] = field.add(next[j + 1], c);
            next[j] = field.sub(next[j], field.mul(m[(k, k)], c));
        }
        let mut below = field.of(1);
        for i in (0..k).rev() {
            below = field.mul(below, m[(i + 1, i)]);
            let factor = field.mul(below, m[(i, k)]);
            for (j, &c) in f[i].iter().enumerate() {
                next[j] = field.sub(next[j], field.mul(factor, c));
            }
        }
        f.push(next);
    }
    f.pop().expect("not empty")
}

fn reduce_to_hessenberg(field: &PrimeField, m: &mut DMatrix<u64>) {
    let n = m.nrows();
    for k in 1..n.saturating_sub(1) {
        let Some(pivot) = (k..n).find(|&i| m[(i, k - 1)] != 0) else { continue };
        m.swap_rows(k, pivot);
        m.swap_columns(k, pivot);
        let inverse = field.invert(m[(k, k - 1)]);
        for i in k + 1..n {
            let factor = field.mul(m[(i, k - 1)], inverse);
            if factor == 0 {
                continue;
            }
            for j in 0..n {
                m[(i, j)] = field.sub(m[(i, j)], field.mul(factor, m[(k, j)]));
            }
            for j in 0..n {
                m[(j, k)] = field.add(m[(j, k)], field.mul(factor, m[(j, i)]));
            }
        }
    }
}

/// The squarefree part of a monic polynomial.
pub(crate) fn squarefree(field: &PrimeField, f: Vec<u64>) -> Vec<u64> {
    let common = field.gcd(f.clone(), derivative(field, &f));
    if common.len() == 1 { f } else { quotient(field, f, &common) }
}

/// a / b, both monic, b a divisor.
pub fn quotient(field: &PrimeField, mut a: Vec<u64>, b: &[u64]) -> Vec<u64> {
    let mut quotient = vec![0; a.len() + 1 - b.len()];
    for k in (0..quotient.len()).rev() {
        let factor = a[k + b.len() - 1];
        a[k..].iter_mut().zip(b).for_each(|(x, &c)| *x = field.sub(*x, field.mul(factor, c)));
        quotient[k] = factor;
    }
    quotient
}

/// The coefficients of f'.
pub fn derivative(field: &PrimeField, f: &[u64]) -> Vec<u64> {
    f.iter().enumerate().skip(1).map(|(k, &c)| field.mul(field.of(k as u64), c)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::prime_fields;

    #[test]
    fn the_characteristic_polynomial_of_a_companion_matrix_is_its_polynomial() {
        let field = prime_fields().nth(3).unwrap();
        // z^4 - 2 z^3 + 3 z^2 - 5 z + 7.
        let last = [-7, 5, -3, 2];
        let m =
            DMatrix::from_fn(4, 4, |i, j| BigInt::from(if j == 3 { last[i] } else { i64::from(i == j + 1) }));
        let got: Vec<_> = characteristic(&field, matrix(&field, &m));
        let want: Vec<_> = [7, -5, 3, -2, 1].map(|c| field.of_big(&BigInt::from(c))).into();
        assert_eq!(got, want);
    }
}
