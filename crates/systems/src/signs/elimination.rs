//! Exact inertias by elimination without fractions, in ℤ.

use crate::signs::inertia::Inertia;
use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

/// The inertia of a symmetric matrix.
///
/// Bareiss's elimination with pivots on the diagonal: after k steps every entry is a minor of the matrix (of
/// one that is congruent to it by permutations and unimodular additions), so divisions are exact and numbers
/// stay as short as determinants are. The signs of d_k = Δ_k/Δ_(k−1) in L D Lᵀ are the inertia (Sylvester).
/// Where no diagonal entry is left but m_ij ≠ 0, row and column j are added to i, which makes m_ii = 2 m_ij.
///
/// Cost: n³/3 products of integers of up to n times the entries' length.
pub fn inertia(mut m: DMatrix<BigInt>) -> Inertia {
    let n = m.nrows();
    let (mut found, mut last, mut was_positive) = (Inertia::default(), BigInt::one(), true);
    for k in 0..n {
        if !bring_pivot(&mut m, k) {
            found.zero = n - k;
            break;
        }
        let pivot = m[(k, k)].clone();
        let is_positive = pivot.is_positive();
        if is_positive == was_positive {
            found.positive += 1;
        } else {
            found.negative += 1;
        }
        for i in k + 1..n {
            for j in k + 1..=i {
                m[(i, j)] = bareiss([&pivot, &m[(i, j)], &m[(i, k)], &m[(j, k)]], &last);
            }
        }
        for i in k + 1..n {
            for j in i + 1..n {
                m[(i, j)] = m[(j, i)].clone();
            }
        }
        (last, was_positive) = (pivot, is_positive);
    }
    found
}

/// (a b − c d)/last, which is a minor.
fn bareiss([a, b, c, d]: [&BigInt; 4], last: &BigInt) -> BigInt {
    (a * b - c * d) / last
}

/// Brings an entry that is not 0 to the place (k, k), by congruence; false where the rest of the matrix is 0.
fn bring_pivot(m: &mut DMatrix<BigInt>, k: usize) -> bool {
    let n = m.nrows();
    let shortest = (k..n).filter(|&i| !m[(i, i)].is_zero()).min_by_key(|&i| m[(i, i)].bits());
    let index = match shortest {
        Some(i) => i,
        None => {
            let mut pairs = (k..n).flat_map(|i| (k..i).map(move |j| (i, j)));
            let Some((i, j)) = pairs.find(|&at| !m[at].is_zero()) else { return false };
            for c in k..n {
                let x = m[(j, c)].clone();
                m[(i, c)] += x;
            }
            for c in k..n {
                let x = m[(c, j)].clone();
                m[(c, i)] += x;
            }
            i
        }
    };
    m.swap_rows(k, index);
    m.swap_columns(k, index);
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn congruent_to_a_diagonal_is_of_its_inertia(
            d in prop::collection::vec(-2i64..=2, 1..7), g in prop::collection::vec(-3i64..=3, 36),
        ) {
            let n = d.len();
            // G unit lower triangular times unit upper triangular: regular.
            let lower = DMatrix::from_fn(n, n, |i, j| BigInt::from(if i == j { 1 } else if i > j { g[6 * i + j] } else { 0 }));
            let upper = DMatrix::from_fn(n, n, |i, j| BigInt::from(if i == j { 1 } else if i < j { g[6 * i + j] } else { 0 }));
            let g = lower * upper;
            let diagonal = DMatrix::from_fn(n, n, |i, j| BigInt::from(if i == j { d[i] } else { 0 }));
            let got = inertia(&g * diagonal * g.transpose());
            let count = |s: i64| d.iter().filter(|x| x.signum() == s).count();
            prop_assert_eq!(got, Inertia { positive: count(1), negative: count(-1), zero: count(0), unknown: 0 });
        }
    }
}
