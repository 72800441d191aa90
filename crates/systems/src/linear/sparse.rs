//! Symmetric rational matrices by rows, zeros left out: what a mass or a stiffness is.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Display;
use std::sync::{Arc, OnceLock};

use faer::Mat;
use nalgebra::DMatrix;
use num_traits::{One, Signed, Zero};

use crate::exact::modular;
use crate::half::norm;
use crate::signs::inertia::{Inertia, proven};
use number::rational::product_to_f64;
use number::{Error, Rational, Result, Twofold, U, from_f64_exact};

/// A symmetric n x n matrix over ℚ. Clones share their entries until one of them is changed.
#[derive(Clone, Debug)]
pub struct Symmetric {
    entries: Arc<Entries>,
}

/// The entries by rows.
///
/// Invariant: `rows[i][j] == rows[j][i]`, and no stored entry is 0.
#[derive(Clone, Debug)]
struct Entries {
    rows: OnceLock<Vec<BTreeMap<usize, Rational>>>,
    /// The matrix that it is a multiple of, and the factor, not 0: products are computed once someone asks
    /// for them.
    multiple: Option<(Symmetric, Rational)>,
    /// The rows in two doubles, once they are asked for: rounding them costs more than a small system's
    /// verdict.
    doubles: OnceLock<Vec<Vec<(usize, Twofold)>>>,
}

impl PartialEq for Symmetric {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.entries, &other.entries) || self.rows() == other.rows()
    }
}

impl Symmetric {
    /// The zero matrix.
    pub fn zero(n: usize) -> Self {
        Symmetric::of_rows(vec![BTreeMap::new(); n])
    }

    fn of_rows(rows: Vec<BTreeMap<usize, Rational>>) -> Self {
        let entries = Entries { rows: rows.into(), multiple: None, doubles: OnceLock::new() };
        Symmetric { entries: Arc::new(entries) }
    }

    fn rows(&self) -> &[BTreeMap<usize, Rational>] {
        self.entries.rows.get_or_init(|| {
            let (symmetric, c) = self.entries.multiple.as_ref().expect("rows or what they are a multiple of");
            let scaled = |row: &BTreeMap<usize, Rational>| row.iter().map(|(&j, x)| (j, x * c)).collect();
            symmetric.rows().iter().map(scaled).collect()
        })
    }

    /// Rows whose entries are those of the matrix but for a factor that is not 0.
    pub(super) fn pattern(&self) -> &[BTreeMap<usize, Rational>] {
        self.entries.multiple.as_ref().map_or_else(|| self.rows(), |(symmetric, _)| symmetric.rows())
    }

    /// To be changed.
    fn rows_mut(&mut self) -> &mut [BTreeMap<usize, Rational>] {
        self.rows();
        let entries = Arc::make_mut(&mut self.entries);
        (entries.multiple, entries.doubles) = (None, OnceLock::new());
        entries.rows.get_mut().expect("just seen")
    }

    /// The entries by rows, in two doubles.
    fn doubles(&self) -> &[Vec<(usize, Twofold)>] {
        let row = |row: &BTreeMap<usize, Rational>| {
            row.iter().map(|(&j, x)| (j, Twofold::from_rational(x))).collect()
        };
        self.entries.doubles.get_or_init(|| self.rows().iter().map(row).collect())
    }

    /// diag(d_1, ..., d_n).
    pub fn diagonal(entries: &[Rational]) -> Self {
        let mut matrix = Symmetric::zero(entries.len());
        entries.iter().enumerate().for_each(|(i, x)| matrix.add(i, i, x));
        matrix
    }

    /// From all entries by rows.
    ///
    /// # Errors
    /// Names the first row of a wrong length and the first pair of entries that differ.
    pub fn dense(field: &str, entries: &[Vec<Rational>]) -> Result<Self> {
        Symmetric::check(field, entries)?;
        let mut matrix = Symmetric::zero(entries.len());
        for (i, row) in entries.iter().enumerate() {
            row[..=i].iter().enumerate().for_each(|(j, x)| matrix.add(i, j, x));
        }
        Ok(matrix)
    }

    /// That rows of any numbers make a symmetric matrix.
    ///
    /// # Errors
    /// As [`Symmetric::dense`].
    pub fn check<T: PartialEq + Display>(field: &str, entries: &[Vec<T>]) -> Result<()> {
        let n = entries.len();
        if let Some((i, row)) = entries.iter().enumerate().find(|(_, row)| row.len() != n) {
            let remedy = format!("a matrix of {n} rows needs {n} entries in each");
            return Err(Error::input(&format!("{field}[{i}]"), format!("{} entries", row.len()), remedy));
        }
        for (i, row) in entries.iter().enumerate() {
            for (j, x) in row[..i].iter().enumerate() {
                if entries[j][i] != *x {
                    let remedy =
                        format!("differs from {field}[{j}][{i}] = {}: make it symmetric", entries[j][i]);
                    return Err(Error::input(&format!("{field}[{i}][{j}]"), x, remedy));
                }
            }
        }
        Ok(())
    }

    /// Adds x to the entries (i, j) and (j, i), once if i = j.
    ///
    /// # Panics
    /// Where an index is out of range.
    pub fn add(&mut self, i: usize, j: usize, x: &Rational) {
        let rows = self.rows_mut();
        add(&mut rows[i], j, x);
        if i != j {
            add(&mut rows[j], i, x);
        }
    }

    /// A spring of stiffness k between i and j, energy k (x_i − x_j)²/2; to a wall without j.
    ///
    /// # Panics
    /// Where an index is out of range.
    pub fn add_spring(&mut self, i: usize, j: Option<usize>, k: &Rational) {
        self.add(i, i, k);
        if let Some(j) = j {
            self.add(j, j, k);
            self.add(i, j, &-k);
        }
    }

    /// Adds the other matrix of the same size.
    pub fn add_all(&mut self, other: &Symmetric) {
        for (table, row) in self.rows_mut().iter_mut().zip(other.rows()) {
            row.iter().for_each(|(&j, x)| add(table, j, x));
        }
    }

    /// c times the matrix; its entries are computed when they are asked for.
    pub fn scaled(&self, c: &Rational) -> Self {
        if c.is_zero() {
            return Symmetric::zero(self.size());
        }
        let multiple = match &self.entries.multiple {
            Some((symmetric, factor)) => (symmetric.clone(), factor * c),
            None => (self.clone(), c.clone()),
        };
        let entries = Entries { rows: OnceLock::new(), multiple: Some(multiple), doubles: OnceLock::new() };
        Symmetric { entries: Arc::new(entries) }
    }

    /// n.
    pub fn size(&self) -> usize {
        self.pattern().len()
    }

    /// The entries of row i that are not 0, by column.
    pub fn row(&self, i: usize) -> &BTreeMap<usize, Rational> {
        &self.rows()[i]
    }

    /// (i, j) of the entries that are not 0.
    pub fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        self.pattern().iter().enumerate().flat_map(|(i, row)| row.keys().map(move |&j| (i, j)))
    }

    /// The entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> Rational {
        self.rows()[i].get(&j).cloned().unwrap_or_else(Rational::zero)
    }

    /// The rows that are not 0.
    pub fn support(&self) -> Vec<usize> {
        (0..self.size()).filter(|&i| !self.pattern()[i].is_empty()).collect()
    }

    /// Whether all entries are 0.
    pub fn is_zero(&self) -> bool {
        self.pattern().iter().all(BTreeMap::is_empty)
    }

    /// Whether all entries off the diagonal are 0.
    pub fn is_diagonal(&self) -> bool {
        self.pattern().iter().enumerate().all(|(i, row)| row.keys().all(|&j| i == j))
    }

    /// The rows and columns in `indices`.
    pub fn restricted(&self, indices: &[usize]) -> Self {
        if let Some((symmetric, c)) = &self.entries.multiple {
            return symmetric.restricted(indices).scaled(c);
        }
        let place: BTreeMap<usize, usize> =
            indices.iter().enumerate().map(|(new, &old)| (old, new)).collect();
        let row = |&i: &usize| {
            self.rows()[i].iter().filter_map(|(j, x)| Some((*place.get(j)?, x.clone()))).collect()
        };
        Symmetric::of_rows(indices.iter().map(row).collect())
    }

    /// Zᵀ self Z for the n x m matrix with the given columns.
    pub fn congruent(&self, columns: &[Vec<Rational>]) -> Self {
        let images: Vec<_> = columns.iter().map(|z| self.times(z)).collect();
        let mut matrix = Symmetric::zero(columns.len());
        for (i, z) in columns.iter().enumerate() {
            for (j, image) in images.iter().enumerate().take(i + 1) {
                matrix.add(i, j, &dot(z, image));
            }
        }
        matrix
    }

    /// self x.
    pub fn times(&self, x: &[Rational]) -> Vec<Rational> {
        let row = |row: &BTreeMap<usize, Rational>| {
            row.iter()
                .fold(Rational::zero(), |sum, (&j, a)| if x[j].is_zero() { sum } else { sum + a * &x[j] })
        };
        self.rows().iter().map(row).collect()
    }

    /// self diag(weights) other, where that is symmetric.
    pub(crate) fn symmetric_product(&self, weights: &[Rational], other: &Symmetric) -> Self {
        let mut product = Symmetric::zero(self.size());
        let rows = product.rows_mut();
        for (i, row) in self.rows().iter().enumerate() {
            for (&k, a) in row.iter().filter(|(k, _)| !weights[**k].is_zero()) {
                let factor = a * &weights[k];
                for (&j, b) in other.row(k).range(i..) {
                    add(&mut rows[i], j, &(&factor * b));
                }
            }
            for (j, x) in rows[i].clone().range(i + 1..) {
                rows[*j].insert(i, x.clone());
            }
        }
        product
    }

    /// All entries.
    pub fn to_dense(&self) -> DMatrix<Rational> {
        DMatrix::from_fn(self.size(), self.size(), |i, j| self.get(i, j))
    }

    /// Whether xᵀ self x ≥ 0 for all x, exactly: by an inertia in doubles where that proves it, else by
    /// elimination over ℚ.
    pub fn is_positive_semidefinite(&self) -> bool {
        is_sum_semidefinite(&[self], || self.clone())
    }

    /// Whether xᵀ self x > 0 for all x ≠ 0, exactly: by its entries where it is diagonal, else as for
    /// semidefinite ones.
    pub fn is_positive_definite(&self) -> bool {
        if self.is_diagonal() {
            return (0..self.size()).all(|i| self.get(i, i).is_positive());
        }
        match inertia_of_sum(&[self]) {
            Inertia { negative: 1.., .. } => false,
            Inertia { unknown: 0, .. } => true,
            _ => self.pivots() == Some(self.size()),
        }
    }

    /// The entries, each rounded.
    pub fn rounded(&self) -> Mat<f64> {
        let mut rounded = Mat::<f64>::zeros(self.size(), self.size());
        for (i, row) in self.rounded_products(&Rational::one()) {
            row.into_iter().for_each(|(j, x)| rounded[(i, j)] = x);
        }
        rounded
    }

    /// The entries on the diagonal, each rounded.
    pub(crate) fn rounded_diagonal(&self) -> Vec<f64> {
        let rounded = self.rounded();
        (0..self.size()).map(|i| rounded[(i, i)]).collect()
    }

    /// The rows that are not 0, c times each entry, rounded once.
    pub(crate) fn rounded_products(&self, c: &Rational) -> Vec<(usize, Vec<(usize, f64)>)> {
        if let Some((symmetric, factor)) = &self.entries.multiple {
            return symmetric.rounded_products(&(factor * c));
        }
        let factor = Twofold::from_rational(c);
        let rows = self.rows().iter().zip(self.doubles()).enumerate();
        rows.filter(|(_, (row, _))| !row.is_empty())
            .map(|(i, (row, doubles))| {
                let entry = |((&j, x), (_, double)): ((&usize, &Rational), &(usize, Twofold))| {
                    let product = if c.is_one() { Some(double.hi) } else { double.nearest_product(factor) };
                    (j, product.unwrap_or_else(|| product_to_f64(x, c)))
                };
                (i, row.iter().zip(doubles).map(entry).collect())
            })
            .collect()
    }

    /// The number of positive pivots of a semidefinite matrix (its rank), or `None` if it is not one.
    fn pivots(&self) -> Option<usize> {
        let mut rest = self.rows().to_vec();
        let mut rank = 0;
        for i in 0..self.size() {
            let row = std::mem::take(&mut rest[i]);
            let pivot = row.get(&i).cloned().unwrap_or_else(Rational::zero);
            let others: Vec<_> = row.into_iter().filter(|(j, _)| *j != i).collect();
            if pivot.is_negative() || (pivot.is_zero() && !others.is_empty()) {
                return None;
            }
            rank += usize::from(pivot.is_positive());
            for (j, a) in &others {
                rest[*j].remove(&i);
                let factor = a / &pivot;
                others.iter().for_each(|(k, b)| add(&mut rest[*j], *k, &-(&factor * b)));
            }
        }
        Some(rank)
    }

    /// A basis of the null space in reduced form, each vector with the coordinate of its own where it is 1
    /// and all others are 0.
    pub fn null_space(&self) -> Vec<(usize, Vec<Rational>)> {
        null_space(self.pattern().to_vec(), self.size())
    }
}

/// row\[j\] += x.
fn add(row: &mut BTreeMap<usize, Rational>, j: usize, x: &Rational) {
    match row.entry(j) {
        Entry::Vacant(place) if !x.is_zero() => drop(place.insert(x.clone())),
        Entry::Vacant(_) => {}
        Entry::Occupied(mut place) => {
            *place.get_mut() += x;
            if place.get().is_zero() {
                place.remove();
            }
        }
    }
}

/// Whether xᵀ (Σ X_k) x ≥ 0 for all x, exactly: by an inertia in doubles where that proves it, else by
/// elimination over ℚ.
pub(crate) fn is_sum_semidefinite(parts: &[&Symmetric], sum: impl FnOnce() -> Symmetric) -> bool {
    match inertia_of_sum(parts) {
        Inertia { negative: 1.., .. } => false,
        Inertia { unknown: 0, .. } => true,
        _ => sum().pivots().is_some(),
    }
}

/// The signs of the eigenvalues of Σ X_k, as far as doubles prove them; nothing where it is large and nearly
/// a chain (three entries a row): there exact elimination fills in little and costs less.
pub(crate) fn inertia_of_sum(parts: &[&Symmetric]) -> Inertia {
    const SMALL: usize = 64;
    let n = parts.first().map_or(0, |symmetric| symmetric.size());
    let entries: usize = parts.iter().flat_map(|part| part.pattern()).map(BTreeMap::len).sum();
    let unknown = Inertia { unknown: n, ..Inertia::default() };
    if n > SMALL && entries < 5 * n {
        return unknown;
    }
    let (mut sum, mut size) = (Mat::<f64>::zeros(n, n), 0.0);
    for rounded in parts.iter().map(|part| part.rounded()) {
        sum += &rounded;
        size += norm::frobenius(&rounded);
    }
    // Each entry of each part within u of its size, or within the smallest double, and a rounding for each
    // sum, each at most u times the sum of the parts' sizes: Frobenius's norm of all that.
    let terms = parts.len() as f64;
    let slack = 1.01 * terms * (U * size + n as f64 * f64::MIN_POSITIVE);
    if slack.is_finite() { proven(&sum, slack) } else { unknown }
}

impl TryFrom<&DMatrix<Rational>> for Symmetric {
    type Error = Error;

    /// All entries, exactly.
    ///
    /// # Errors
    /// Names the first pair of entries that differ, and rows of another number than columns.
    fn try_from(matrix: &DMatrix<Rational>) -> Result<Self> {
        let rows: Vec<Vec<Rational>> = matrix.row_iter().map(|row| row.iter().cloned().collect()).collect();
        Symmetric::dense("stiffness", &rows)
    }
}

impl TryFrom<&DMatrix<f64>> for Symmetric {
    type Error = Error;

    /// All entries as the rationals that the doubles are, exactly: 0.1 is not 1/10.
    ///
    /// # Errors
    /// As for rationals; an entry that is not finite.
    fn try_from(matrix: &DMatrix<f64>) -> Result<Self> {
        let infinite = matrix.iter().find(|x| !x.is_finite());
        if let Some(x) = infinite {
            return Err(Error::input("stiffness", x, "give finite numbers"));
        }
        Symmetric::try_from(&matrix.map(|x| from_f64_exact(x).expect("finite")))
    }
}

/// A basis of {x : rows x = 0}: (free coordinate, vector) pairs, each vector 1 there and 0 at the other free
/// ones.
///
/// For rows with many entries it is empty where they are independent modulo a prime: elimination over ℚ makes
/// numbers of n times their length.
pub(crate) fn null_space(mut rows: Vec<BTreeMap<usize, Rational>>, n: usize) -> Vec<(usize, Vec<Rational>)> {
    if 8 * rows.iter().map(BTreeMap::len).sum::<usize>() > n * n && modular::rank_of(&rows, n) == Some(n) {
        return Vec::new();
    }
    // Gauss and Jordan: each row by the column that it was solved for, where all others are 0.
    let mut solved: BTreeMap<usize, BTreeMap<usize, Rational>> = BTreeMap::new();
    while solved.len() < n
        && let Some(mut row) = rows.pop()
    {
        let columns: Vec<usize> = row.keys().filter(|j| solved.contains_key(j)).copied().collect();
        columns.iter().for_each(|j| eliminate(&mut row, *j, &solved[j]));
        let Some((&column, pivot)) = row.first_key_value() else { continue };
        let inverse = pivot.recip();
        row.values_mut().for_each(|x| *x *= &inverse);
        solved.values_mut().for_each(|other| eliminate(other, column, &row));
        solved.insert(column, row);
    }
    let vector = |free: usize| {
        let mut x = vec![Rational::zero(); n];
        x[free] = Rational::from_integer(1.into());
        for (column, row) in &solved {
            x[*column] = row.get(&free).map_or_else(Rational::zero, |a| -a);
        }
        (free, x)
    };
    (0..n).filter(|j| !solved.contains_key(j)).map(vector).collect()
}

/// `row -= row[column] pivot_row`, where pivot_row\[column\] = 1.
fn eliminate(row: &mut BTreeMap<usize, Rational>, column: usize, pivot_row: &BTreeMap<usize, Rational>) {
    let Some(factor) = row.get(&column).cloned() else { return };
    for (&j, x) in pivot_row {
        let entry = row.entry(j).or_insert_with(Rational::zero);
        *entry -= &factor * x;
        if entry.is_zero() {
            row.remove(&j);
        }
    }
}

/// Σ x_i y_i.
pub fn dot(x: &[Rational], y: &[Rational]) -> Rational {
    x.iter()
        .zip(y)
        .filter(|(a, b)| !a.is_zero() && !b.is_zero())
        .fold(Rational::zero(), |sum, (a, b)| sum + a * b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    #[test]
    fn a_changed_clone_is_rounded_anew_and_leaves_the_other_as_it_was() {
        let first = Symmetric::diagonal(&[ratio(1, 3), ratio(2, 7)]);
        assert_eq!(first.rounded()[(0, 0)], 1.0 / 3.0);
        let mut other = first.clone();
        other.add(0, 1, &ratio(1, 10));
        other.add(0, 0, &ratio(-1, 3));
        assert_eq!((other.rounded()[(0, 1)], other.rounded()[(0, 0)]), (0.1, 0.0));
        assert_eq!((first.rounded()[(0, 1)], first.rounded_diagonal()), (0.0, vec![1.0 / 3.0, 2.0 / 7.0]));
        assert_ne!(first, other);
    }

    #[test]
    fn products_are_rounded_once_whatever_their_size() {
        let long = Rational::new(num_bigint::BigInt::from(3).pow(90), num_bigint::BigInt::from(7).pow(70));
        let tiny = Rational::new(1.into(), num_bigint::BigInt::from(10).pow(300));
        for x in [ratio(1, 3), ratio(-22, 7), ratio((1 << 53) + 1, 1), long.clone(), -&long, tiny] {
            let (matrix, c) = (Symmetric::diagonal(std::slice::from_ref(&x)), ratio(355, 113));
            for c in [c.clone(), ratio(1, 1), &c * &long] {
                let expected = product_to_f64(&x, &c);
                assert_eq!(matrix.rounded_products(&c), [(0, vec![(0, expected)])], "{x} {c}");
            }
        }
    }
}
