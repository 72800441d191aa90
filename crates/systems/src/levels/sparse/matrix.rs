//! Symmetric sparse matrices of doubles: products with vectors, sums that are proven positive definite.

use std::ops::Range;
use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::simplicial::SymbolicSimplicialCholesky;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, Side};

use super::dissect::dissected;
use super::fronts::{Elimination, Fronts, Pivots, products_of, supernodes, zeros};
use super::krylov::top;
use number::parallel::map;
use number::{Error, Result, U};

/// The lower triangles of some matrices of one pattern, column by column, every diagonal entry there.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// Where each column begins, and where the last one ends.
    columns: Vec<usize>,
    rows: Vec<usize>,
    symbolic: Arc<SymbolicCholesky<usize>>,
    /// The most entries of a row of Cholesky's factor: no sum of products in the factorization has more
    /// terms.
    terms: usize,
}

/// A symmetric matrix of n rows as triplets (i, j, x), each pair of entries once or both alike; triplets of
/// one entry add up, in doubles.
pub type Triplets = [(usize, usize, f64)];

/// Entries of both triangles may differ by so much, relative to the largest one: the roundings of a product.
const SYMMETRIC: f64 = 1e-14;

/// The lower triangle of a symmetric matrix of n rows. Where it `is_whole` an entry that is not given is 0,
/// else it is that of the other triangle.
///
/// # Errors
/// Numbers that are not finite, indices beyond the rows, an entry and its mirror image that differ, all by
/// `field`.
pub fn symmetric(
    field: &str,
    n: usize,
    given: &Triplets,
    is_whole: bool,
) -> Result<Vec<(usize, usize, f64)>> {
    if let Some((i, j, x)) = given.iter().find(|(i, j, x)| !x.is_finite() || *i.max(j) >= n) {
        let remedy = format!("give finite numbers, and indices below {n}");
        return Err(Error::input(&format!("{field}[{i}][{j}]"), x, remedy));
    }
    let largest = given.iter().fold(0.0f64, |most, triple| most.max(triple.2.abs()));
    let lower: Vec<_> = given.iter().filter(|(i, j, _)| i >= j).copied().collect();
    let upper: Vec<_> = given.iter().filter(|(i, j, _)| i < j).map(|&(i, j, x)| (j, i, x)).collect();
    let (lower, upper) = (added(lower), added(upper));
    let (mut below, mut above) = (lower.iter().peekable(), upper.iter().peekable());
    let mut all = Vec::with_capacity(lower.len());
    let place = |triple: &&(usize, usize, f64)| (triple.0, triple.1);
    while let Some(at) = below.peek().into_iter().chain(above.peek()).map(place).min() {
        let (i, j) = at;
        let [x, y] = [&mut below, &mut above]
            .map(|triples| triples.next_if(|triple| place(triple) == at).map(|triple| triple.2));
        let (x, y) = match (x, y) {
            (x, y) if is_whole && i != j => (x.unwrap_or(0.0), y.unwrap_or(0.0)),
            (x, y) => (x.or(y).unwrap_or(0.0), y.or(x).unwrap_or(0.0)),
        };
        if (x - y).abs() > SYMMETRIC * largest {
            let remedy = format!(
                "is not symmetric: entry [{j}][{i}] is {y}, and they differ by {:e}; give (K + K.T)/2 where that is meant",
                (x - y).abs()
            );
            return Err(Error::input(&format!("{field}[{i}][{j}]"), x, remedy));
        }
        all.push((i, j, x));
    }
    Ok(all)
}

/// In order, the triplets of each entry added up.
fn added(mut triples: Vec<(usize, usize, f64)>) -> Vec<(usize, usize, f64)> {
    triples.sort_by_key(|&(i, j, _)| (i, j));
    triples.dedup_by(|next, kept| {
        let is_same = (next.0, next.1) == (kept.0, kept.1);
        if is_same {
            kept.2 += next.2;
        }
        is_same
    });
    triples
}

impl Pattern {
    /// That of all entries of some matrices, each with its entries in it.
    ///
    /// # Errors
    /// No row; an index beyond the last row; where the symbolic factorization runs out of memory.
    pub fn of<const K: usize>(n: usize, matrices: [&Triplets; K]) -> Result<(Pattern, [Vec<f64>; K])> {
        let (pattern, values) = Pattern::of_all(n, &matrices)?;
        Ok((pattern, values.try_into().expect("as many as matrices")))
    }

    /// The same of any number of matrices.
    ///
    /// # Errors
    /// As [`Pattern::of`].
    pub fn of_all(n: usize, matrices: &[&Triplets]) -> Result<(Pattern, Vec<Vec<f64>>)> {
        let place = |(k, triples): (usize, &&Triplets)| -> Vec<(usize, usize, usize, f64)> {
            triples.iter().filter(|(i, j, _)| i >= j).map(|&(i, j, x)| (j, i, k, x)).collect()
        };
        if n == 0 || matrices.iter().any(|matrix| matrix.iter().any(|&(i, j, _)| i.max(j) >= n)) {
            return Err(Error::input("stiffness", n, "give 1 row or more, and indices below their number"));
        }
        let mut all: Vec<_> = matrices.iter().enumerate().flat_map(place).collect();
        all.extend((0..n).map(|i| (i, i, 0, 0.0)));
        all.sort_unstable_by_key(|&(j, i, k, _)| (j, i, k));
        let (mut columns, mut rows) = (vec![0; n + 1], Vec::new());
        let mut values = vec![Vec::new(); matrices.len()];
        let mut last = None;
        for (j, i, k, x) in all {
            if last != Some((j, i)) {
                last = Some((j, i));
                columns[j + 1] += 1;
                rows.push(i);
                values.iter_mut().for_each(|values: &mut Vec<f64>| values.push(0.0));
            }
            *values[k].last_mut().expect("just pushed") += x;
        }
        (0..n).for_each(|j| columns[j + 1] += columns[j]);
        let symbolic = symbolic(&columns, &rows)
            .ok_or_else(|| Error::input("stiffness", n, "is too large for the memory of this machine"))?;
        let terms = longest_row(&symbolic);
        Ok((Pattern { columns, rows, symbolic: Arc::new(symbolic), terms }, values))
    }

    /// n.
    pub fn size(&self) -> usize {
        self.columns.len() - 1
    }

    /// The entries of one triangle.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// The products of one factorization: half the squares of its columns' lengths.
    pub fn products(&self) -> f64 {
        products(&self.symbolic)
    }

    fn column(&self, j: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (self.columns[j]..self.columns[j + 1]).map(|at| (at, self.rows[at]))
    }

    /// A x for each column x.
    pub fn times(&self, values: &[f64], x: &Mat<f64>) -> Mat<f64> {
        // As many parts whatever the threads, so that sums have one order.
        let parts = if self.rows.len() < MANY { 1 } else { PARTS };
        let end = |part: usize| self.columns.partition_point(|&at| at < part * self.rows.len() / parts);
        let ranges: Vec<Range<usize>> = (0..parts)
            .map(|part| end(part)..if part + 1 < parts { end(part + 1) } else { self.size() })
            .collect();
        let sums = map(&ranges, |columns| self.part_times(columns.clone(), values, x));
        sums.into_iter().reduce(|sum, part| sum + part).expect("one part or more")
    }

    /// What the columns of a range add, and the rows of the same.
    fn part_times(&self, columns: Range<usize>, values: &[f64], x: &Mat<f64>) -> Mat<f64> {
        let mut y = Mat::zeros(x.nrows(), x.ncols());
        for c in 0..x.ncols() {
            let (from, to) = (x.col_as_slice(c), y.col_as_slice_mut(c));
            for j in columns.clone() {
                let mut sum = 0.0;
                for (at, i) in self.column(j) {
                    sum += values[at] * from[i];
                    if i != j {
                        to[i] += values[at] * from[j];
                    }
                }
                to[j] += sum;
            }
        }
        y
    }

    /// The largest sum of |entries| of a row: no less than the 2-norm, rounded up; and the largest number of
    /// entries of one.
    pub fn size_of(&self, values: &[f64]) -> (f64, usize) {
        let (mut sums, mut counts) = (vec![0.0; self.size()], vec![0; self.size()]);
        for j in 0..self.size() {
            for (at, i) in self.column(j) {
                for k in if i == j { [Some(i), None] } else { [Some(i), Some(j)] }.into_iter().flatten() {
                    sums[k] += values[at].abs();
                    counts[k] += 1;
                }
            }
        }
        let most = counts.into_iter().max().unwrap_or(0);
        (sums.into_iter().fold(0.0, f64::max) * (1.0 + (most as f64 + 2.0) * U), most)
    }

    /// c + Σ a_k A_k, and the sum of |entries| on its diagonal.
    fn sum(&self, c: f64, terms: &[(f64, &[f64])]) -> (Vec<f64>, f64) {
        let mut values = vec![0.0; self.rows.len()];
        for (a, own) in terms {
            values.iter_mut().zip(*own).for_each(|(sum, x)| *sum += a * x);
        }
        let mut trace = 0.0;
        for j in 0..self.size() {
            let at = self.diagonal(j);
            values[at] += c;
            trace += values[at].abs();
        }
        (values, trace)
    }

    /// Where the diagonal entry of a column is: rows below it follow.
    fn diagonal(&self, j: usize) -> usize {
        self.columns[j]
    }

    fn matrix<'a>(&'a self, values: &'a [f64]) -> SparseColMatRef<'a, usize, f64> {
        let n = self.size();
        SparseColMatRef::new(
            SymbolicSparseColMatRef::new_checked(n, n, &self.columns, None, &self.rows),
            values,
        )
    }

    /// Whether every matrix within `slack` (2-norm) of c + Σ a_k A_k is proven positive definite, as
    /// [`Pattern::factored`] proves it, without the factors: memory holds some fronts. False where that
    /// proves nothing, or memory runs out.
    pub fn is_definite(&self, c: f64, terms: &[(f64, &[f64])], slack: f64) -> bool {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(_) => self.factored(c, terms, slack).is_some(),
            SymbolicCholeskyRaw::Supernodal(symbolic_supernodal_cholesky) => self
                .lowered(c, terms, slack)
                .and_then(|values| self.fronts(symbolic_supernodal_cholesky, values, Elimination::Cholesky))
                .is_some(),
        }
    }

    /// The pivots of a matrix of this pattern.
    fn fronts(
        &self,
        symbolic_supernodal_cholesky: &SymbolicSupernodalCholesky<usize>,
        values: Vec<f64>,
        kind: Elimination,
    ) -> Option<Pivots> {
        let places = self.symbolic.perm().map(|perm| perm.arrays().1);
        let place = |i: usize| places.map_or(i, |places| places[i]);
        let fronts =
            Fronts::new(symbolic_supernodal_cholesky, place, [&self.columns, &self.rows], &values, kind)?;
        drop(values);
        fronts.pivots()
    }

    /// The factors of c + Σ a_k A_k minus what makes them prove that every matrix within `slack` of it
    /// (2-norm) is positive definite, by Rump's criterion (BIT 46, 2006); `None` where that proves nothing,
    /// or memory runs out.
    pub fn factored(&self, c: f64, terms: &[(f64, &[f64])], slack: f64) -> Option<Factors> {
        let values = self.factors(&self.lowered(c, terms, slack)?, false)?;
        Some(Factors { symbolic: Arc::clone(&self.symbolic), values })
    }

    /// c + Σ a_k A_k minus as much of the identity as Cholesky's factors may be off by: where they exist,
    /// whatever the order of their sums, every matrix within `slack` of the sum is positive definite. `None`
    /// where a diagonal entry shows that they do not.
    fn lowered(&self, c: f64, terms: &[(f64, &[f64])], slack: f64) -> Option<Vec<f64>> {
        let n = self.size();
        let (mut values, trace) = self.sum(c, terms);
        // γ of the longest sum, with room for the reciprocals of pivots, the rounding of the shifted diagonal
        // and of the sums here.
        let shift = 1.01 * (slack + (self.terms as f64 + 24.0) * U * trace)
            + f64::MIN_POSITIVE * (n as f64 + 1.0).powi(2);
        if !shift.is_finite() || (0..n).any(|j| values[self.diagonal(j)] <= shift) {
            return None;
        }
        (0..n).for_each(|j| values[self.diagonal(j)] -= shift);
        Some(values)
    }

    /// \[lo, hi\], which holds the largest eigenvalue of every matrix within `slack` of A (2-norm), to
    /// `within` of itself or as near as doubles tell: above it c − A is proven positive definite, below it c
    /// − A has a negative pivot. `None` where it is not positive.
    pub fn largest(&self, values: &[f64], slack: f64, within: f64) -> Option<(f64, f64)> {
        let (mut lo, mut hi) = (0.0, self.size_of(values).0 + slack);
        let minus = [(-1.0, values)];
        while hi - lo > within * hi {
            // Beside the middle, where c − A of a regular chain has a pivot 0, which nothing is divided by.
            let middle = lo + 0.486_2 * (hi - lo);
            if self.is_definite(middle, &minus, slack) {
                hi = middle;
                continue;
            }
            match self.negative(-middle, &minus) {
                Some((1.., off)) if middle - 1.01 * (off + slack) > lo => lo = middle - 1.01 * (off + slack),
                _ => break,
            }
        }
        (lo > 0.0).then_some((lo, hi))
    }

    /// How many negative eigenvalues a matrix has that is no farther from Σ a_k A_k − c (2-norm) than the
    /// number beside: that of the negative pivots of L D Lᵀ without exchanges, whose error is γ |L||D||Lᵀ|
    /// (Higham, chapter 11) and the roundings of the sum.
    pub fn negative(&self, c: f64, terms: &[(f64, &[f64])]) -> Option<(usize, f64)> {
        let (values, trace) = self.sum(-c, terms);
        let Pivots { negative, size } = match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(symbolic_simplicial_cholesky) => {
                self.simplicial(symbolic_simplicial_cholesky, &values)?
            }
            SymbolicCholeskyRaw::Supernodal(symbolic_supernodal_cholesky) => {
                self.fronts(symbolic_supernodal_cholesky, values, Elimination::Signed)?
            }
        };
        let off = self.off(size + trace, c);
        off.is_finite().then_some((negative, off))
    }

    /// How far pivots may be off, by Σ |d_k| |l_k|² and the sum of |entries| on the diagonal.
    fn off(&self, sizes: f64, c: f64) -> f64 {
        2.0 * (self.terms as f64 + 24.0) * U * (sizes + c.abs())
    }

    /// No fewer than the eigenvalues that are not above 0 of any matrix within `slack` of c + Σ a_k A_k:
    /// those below a τ that is proven to lie beyond the slack and what the factorization may be off by.
    pub fn at_most_negative(&self, c: f64, terms: &[(f64, &[f64])], slack: f64) -> Option<usize> {
        let mut tau = 1.1 * slack;
        for _ in 0..SHIFTS {
            let (negative, value) = self.negative(tau - c, terms)?;
            if tau > 1.01 * (value + slack) {
                return Some(negative);
            }
            tau = 1.1 * (value + slack);
        }
        None
    }

    /// The pivots of L D Lᵀ column by column.
    fn simplicial(
        &self,
        symbolic_simplicial_cholesky: &SymbolicSimplicialCholesky<usize>,
        values: &[f64],
    ) -> Option<Pivots> {
        let factor = self.factors(values, true)?;
        // Of each column: its pivot, and the square of its length, 1 on the diagonal.
        Some(symbolic_simplicial_cholesky.col_ptr().windows(2).fold(Pivots::default(), |sum, ends| {
            let (pivot, below) = (factor[ends[0]], &factor[ends[0] + 1..ends[1]]);
            let square = 1.0 + below.iter().map(|x| x * x).sum::<f64>();
            sum.and(Pivots { negative: usize::from(pivot < 0.0), size: pivot.abs() * square })
        }))
    }

    /// The values of the factors L Lᵀ of a matrix of this pattern, or L D Lᵀ; `None` where a pivot is none,
    /// memory runs out, or they are too many to keep.
    fn factors(&self, entries: &[f64], is_signed: bool) -> Option<Vec<f64>> {
        let (symbolic_cholesky, threads) = (&self.symbolic, faer::get_global_parallelism());
        let scratch = match is_signed {
            false => symbolic_cholesky.factorize_numeric_llt_scratch::<f64>(threads, Default::default()),
            true => symbolic_cholesky.factorize_numeric_ldlt_scratch::<f64>(threads, Default::default()),
        };
        let mut room = MemBuffer::try_new(scratch).ok()?;
        let mut values = if symbolic_cholesky.len_val() < MOST_KEPT {
            zeros(symbolic_cholesky.len_val(), 0.0)?
        } else {
            return None;
        };
        let (to, matrix, side) = (&mut values[..], self.matrix(entries), Side::Lower);
        let (none, stack) = (Default::default(), MemStack::new(&mut room));
        let is_done = if is_signed {
            symbolic_cholesky
                .factorize_numeric_ldlt(to, matrix, side, none, threads, stack, Default::default())
                .is_ok()
        } else {
            let none = Default::default();
            symbolic_cholesky
                .factorize_numeric_llt(to, matrix, side, none, threads, stack, Default::default())
                .is_ok()
        };
        is_done.then_some(values)
    }
}

/// Shifts τ that are tried: from the second one on a tenth above what the factorization with the last one may
/// be off by.
const SHIFTS: u32 = 8;

/// So many values of factors are not kept: 8 GB.
const MOST_KEPT: usize = 1_000_000_000;

/// Entries from which on a product is made in parts, and how many.
const MANY: usize = 1 << 18;
const PARTS: usize = 4;

/// The residual, relative to the inverse's eigenvalue, at which a vector is taken: the eigenvalue's error is
/// its square, over the distance of the next one.
const ENOUGH: f64 = 1e-3;

/// Cholesky's factors.
pub struct Factors {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
}

impl Factors {
    /// What the matrix takes to x, rounded; `None` where memory runs out.
    pub fn solve(&self, mut x: Mat<f64>) -> Option<Mat<f64>> {
        let threads = faer::get_global_parallelism();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), threads);
        let mut room = MemBuffer::try_new(scratch).ok()?;
        let stack = MemStack::new(&mut room);
        let llt_ref = LltRef::<usize, f64>::new(&self.symbolic, &self.values);
        llt_ref.solve_in_place_with_conj(Conj::No, x.as_mut(), threads, stack);
        Some(x)
    }

    /// The eigenvector of the least eigenvalue as a Krylov space of the inverse has it, so many steps from x,
    /// off the columns of `rigid`: of length 1, rounded. `None` where memory runs out or nothing is left.
    pub fn least(&self, x: Mat<f64>, rigid: &Mat<f64>, steps: usize) -> Option<Mat<f64>> {
        top(x, rigid, steps, ENOUGH, |x| self.solve(x.clone()))
    }

    /// So many rounds of inverse iteration from x, off the columns of `rigid`; of length 1, rounded. `None`
    /// where memory runs out or nothing is left.
    pub fn iterated(&self, mut x: Mat<f64>, rigid: &Mat<f64>, rounds: usize) -> Option<Mat<f64>> {
        for _ in 0..rounds {
            x = self.solve(x)?;
            x -= rigid * (rigid.transpose() * &x);
            let length = x.norm_l2();
            if !(length.is_finite() && length > 0.0) {
                return None;
            }
            x /= faer::Scale(length);
        }
        Some(x)
    }
}

/// Cholesky's factors in the order of least degrees, or by dissection where that fills them less; `None`
/// where memory runs out.
fn symbolic(columns: &[usize], rows: &[usize]) -> Option<SymbolicCholesky<usize>> {
    let n = columns.len() - 1;
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
    let in_order = |order| factorize_symbolic_cholesky(pattern, Side::Lower, order, Default::default()).ok();
    let symbolic_cholesky = in_order(SymmetricOrdering::Amd)?;
    // Where a factorization costs little more than to find an order, any does.
    if products(&symbolic_cholesky) < WORTH_AN_ORDER * rows.len() as f64 {
        return Some(symbolic_cholesky);
    }
    let order = dissected(columns, rows);
    let mut places = vec![0; n];
    order.iter().enumerate().for_each(|(place, &i)| places[i] = place);
    let other = in_order(SymmetricOrdering::Custom(PermRef::new_checked(&order, &places, n)));
    Some(other.filter(|other| products(other) < products(&symbolic_cholesky)).unwrap_or(symbolic_cholesky))
}

/// Products an entry of the matrix.
const WORTH_AN_ORDER: f64 = 1000.0;

/// Half the squares of the lengths of the factor's columns.
fn products(symbolic: &SymbolicCholesky<usize>) -> f64 {
    match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(symbolic_simplicial_cholesky) => symbolic_simplicial_cholesky
            .col_ptr()
            .windows(2)
            .map(|ends| products_of(1, ends[1] - ends[0] - 1))
            .sum(),
        SymbolicCholeskyRaw::Supernodal(symbolic_supernodal_cholesky) => {
            supernodes(symbolic_supernodal_cholesky)
                .map(|(columns, below)| products_of(columns.len(), below.len()))
                .sum()
        }
    }
}

/// The most entries of a row of the factor, zeros that are kept within supernodes included.
fn longest_row(symbolic: &SymbolicCholesky<usize>) -> usize {
    let mut counts = vec![0; symbolic.nrows()];
    match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(symbolic_simplicial_cholesky) => {
            symbolic_simplicial_cholesky.row_idx().iter().for_each(|&i| counts[i] += 1)
        }
        SymbolicCholeskyRaw::Supernodal(symbolic_supernodal_cholesky) => {
            supernodes(symbolic_supernodal_cholesky).for_each(|(columns, below)| {
                let width = columns.len();
                columns.chain(below.iter().copied()).for_each(|i| counts[i] += width);
            })
        }
    }
    counts.into_iter().max().unwrap_or(0)
}

#[cfg(test)]
mod tests;
