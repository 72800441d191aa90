//! The pivots of a sparse factorization without its factors (multifrontal elimination).
//!
//! Each supernode's columns are eliminated in a dense matrix of their own, the front: what belongs there of
//! the matrix and of the supernodes below it in the elimination tree. What elimination leaves on the rows
//! that follow is handed on; the columns of the factor are dropped. So memory holds some fronts along a path
//! of the tree in place of the whole factor, and parts of the tree that do not meet are eliminated side by
//! side.

use std::collections::BTreeMap;
use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::{ldlt, llt};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::prelude::*;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, MatMut, MatRef};

use number::parallel::map;

/// What is eliminated: L Lᵀ, which ends at the first pivot that is not positive, or L D Lᵀ without exchanges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Elimination {
    Cholesky,
    Signed,
}

/// What is kept of L D Lᵀ.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pivots {
    pub negative: usize,
    /// Σ |d_k| |l_k|² over the columns, no less than the 2-norm of |L||D||Lᵀ| but for roundings; 0 of L Lᵀ.
    pub size: f64,
}

/// The supernodes of a factorization as a tree, and the matrix that is eliminated.
pub(super) struct Fronts<'a> {
    own: &'a SymbolicSupernodalCholesky<usize>,
    children: Vec<Vec<usize>>,
    /// The products below and at each supernode.
    products: Vec<f64>,
    /// Those of all.
    total: f64,
    roots: Vec<usize>,
    /// Of each column, in the order of elimination, where its rows and values begin in `entries`.
    columns: Vec<usize>,
    entries: Vec<(u32, f64)>,
    kind: Elimination,
}

/// What a supernode leaves on the rows below it: the lower triangle column by column.
struct Left {
    pivots: Pivots,
    update: Vec<f64>,
}

/// Supernodes with so large a part of all products, theirs and those below, are eliminated side by side.
const HEAVY: f64 = 1.0 / 64.0;

/// With so large a part they are eliminated one after the other, each by all threads: of 10,000 waters that
/// takes 6.3 GB in place of 7.2.
const LARGE: f64 = 1.0 / 3.0;

impl<'a> Fronts<'a> {
    /// Of the lower triangle with these rows and values of each column, row i being the `place[i]`-th that is
    /// eliminated; `None` where it has 2³² rows or more, or memory runs out.
    pub fn new(
        own: &'a SymbolicSupernodalCholesky<usize>,
        place: impl Fn(usize) -> usize,
        [ends, rows]: [&[usize]; 2],
        values: &[f64],
        kind: Elimination,
    ) -> Option<Fronts<'a>> {
        let n = ends.len() - 1;
        u32::try_from(n).ok()?;
        let all = || {
            (0..n).flat_map(|j| (ends[j]..ends[j + 1]).map(move |k| (j, k))).map(|(j, k)| {
                let (i, j) = (place(rows[k]), place(j));
                (i.min(j), i.max(j), values[k])
            })
        };
        let mut columns = vec![0; n + 1];
        all().for_each(|(column, ..)| columns[column + 1] += 1);
        (0..n).for_each(|j| columns[j + 1] += columns[j]);
        let mut entries = zeros(rows.len(), (0, 0.0))?;
        let mut next = columns.clone();
        for (column, row, x) in all() {
            entries[next[column]] = (row as u32, x);
            next[column] += 1;
        }
        let count = own.n_supernodes();
        let mut children = vec![Vec::new(); count];
        let (mut products, mut roots) = (vec![0.0; count], Vec::new());
        let mut of_column = vec![0; n];
        supernodes(own).enumerate().for_each(|(k, (columns, _))| of_column[columns].fill(k));
        for (k, (columns, below)) in supernodes(own).enumerate() {
            products[k] += products_of(columns.len(), below.len());
            match below.first() {
                Some(&row) => {
                    children[of_column[row]].push(k);
                    products[of_column[row]] += products[k];
                }
                None => roots.push(k),
            }
        }
        let total = roots.iter().map(|&k: &usize| products[k]).sum();
        Some(Fronts { own, children, products, total, roots, columns, entries, kind })
    }

    /// All pivots; `None` where one is not positive in L Lᵀ or vanishes in L D Lᵀ, or memory runs out.
    pub fn pivots(&self) -> Option<Pivots> {
        let left = map(&self.roots, |&k| self.subtree(k));
        left.into_iter().try_fold(Pivots::default(), |sum, left| Some(sum.and(left?.pivots)))
    }

    /// What is left of a supernode and all below it.
    fn subtree(&self, root: usize) -> Option<Left> {
        if !self.has(HEAVY, root) {
            return self.in_turn(root);
        }
        // A path down to where the tree branches or ends, then back up: depth is that of branches, whatever
        // the length of a chain.
        let mut path = vec![root];
        let next = loop {
            let indexes = &self.children[path[path.len() - 1]];
            let mut large = indexes.iter().filter(|&&k| self.has(HEAVY, k));
            match (large.next(), large.next()) {
                (Some(&only), None) => path.push(only),
                _ => break indexes,
            }
        };
        let mut left = self.all_of(next)?;
        while let Some(k) = path.pop() {
            let own = self.front(k, left)?;
            let Some(&above) = path.last() else { return Some(own) };
            let others: Vec<usize> =
                self.children[above].iter().copied().filter(|&other| other != k).collect();
            left = self.all_of(&others)?;
            left.push((k, own));
        }
        None
    }

    /// Whether a supernode and all below it have this part of all products.
    fn has(&self, part: f64, k: usize) -> bool {
        self.products[k] >= part * self.total
    }

    /// What is left of some that do not meet.
    fn all_of(&self, all: &[usize]) -> Option<Vec<(usize, Left)>> {
        let own = |&k: &usize| Some((k, self.subtree(k)?));
        let are_large = all.iter().any(|&k| self.has(LARGE, k));
        if are_large { all.iter().map(own).collect() } else { map(all, own).into_iter().collect() }
    }

    /// What is left of a supernode, all below it eliminated first, on this thread.
    fn in_turn(&self, root: usize) -> Option<Left> {
        let (mut all, mut seen) = (vec![root], 0);
        while seen < all.len() {
            all.extend(&self.children[all[seen]]);
            seen += 1;
        }
        all.sort_unstable();
        let mut left = BTreeMap::new();
        for k in all {
            let below = self.children[k].iter().filter_map(|&child| Some((child, left.remove(&child)?)));
            let own = self.front(k, below.collect())?;
            left.insert(k, own);
        }
        left.remove(&root)
    }

    /// Assembles and eliminates one front.
    fn front(&self, k: usize, children: Vec<(usize, Left)>) -> Option<Left> {
        let (columns, rows) = supernode(self.own, k);
        let (width, rest) = (columns.len(), rows.len());
        let height = width + rest;
        let mut panel = zeros(height * width, 0.0)?;
        let mut update = zeros(rest * rest, 0.0)?;
        let place = |row: usize| match row.checked_sub(columns.end) {
            None => row - columns.start,
            Some(_) => width + rows.partition_point(|&other| other < row),
        };
        for j in columns.clone() {
            let column = &mut panel[(j - columns.start) * height..][..height];
            self.entries[self.columns[j]..self.columns[j + 1]]
                .iter()
                .for_each(|&(row, x)| column[place(row as usize)] += x);
        }
        let mut pivots = Pivots::default();
        for (child, left) in children {
            pivots = pivots.and(left.pivots);
            let places: Vec<usize> = supernode(self.own, child).1.iter().map(|&row| place(row)).collect();
            let mut from = &left.update[..];
            for (j, &to) in places.iter().enumerate() {
                let (values, others) = from.split_at(places.len() - j);
                from = others;
                let (column, top) = match to.checked_sub(width) {
                    None => (&mut panel[to * height..][..height], 0),
                    Some(to) => (&mut update[to * rest..][..rest], width),
                };
                places[j..].iter().zip(values).for_each(|(i, x)| column[i - top] += x);
            }
        }
        let panel = MatMut::from_column_major_slice_mut(&mut panel, height, width);
        let own = self.eliminate(panel, MatMut::from_column_major_slice_mut(&mut update, rest, rest))?;
        pack(&mut update, rest);
        Some(Left { pivots: pivots.and(own), update })
    }

    /// Eliminates the columns of a panel: the lower triangle of `update` loses what they take.
    fn eliminate(&self, panel: MatMut<'_, f64>, update: MatMut<'_, f64>) -> Option<Pivots> {
        let width = panel.ncols();
        let (mut top, below) = panel.split_at_row_mut(width);
        let mut below = below.transpose_mut();
        let threads = faer::get_global_parallelism();
        match self.kind {
            Elimination::Cholesky => {
                cholesky(top.as_mut())?;
                solve_lower_triangular_in_place(top.as_ref(), below.as_mut(), threads);
                take(update, below.rb(), below.rb());
                Some(Pivots::default())
            }
            Elimination::Signed => {
                let scratch =
                    ldlt::factor::cholesky_in_place_scratch::<f64>(width, threads, Default::default());
                let mut room = MemBuffer::try_new(scratch).ok()?;
                let (stack, none) = (MemStack::new(&mut room), Default::default());
                ldlt::factor::cholesky_in_place(top.as_mut(), none, threads, stack, Default::default())
                    .ok()?;
                solve_unit_lower_triangular_in_place(top.as_ref(), below.as_mut(), threads);
                let mut found = Pivots::default();
                let mut scaled = zeros(width * below.ncols(), 0.0)?;
                let mut scaled = MatMut::from_column_major_slice_mut(&mut scaled, width, below.ncols());
                for k in 0..width {
                    let pivot = top[(k, k)];
                    let beside = (k + 1..width).map(|i| top[(i, k)].powi(2)).sum::<f64>();
                    let mut rows = 0.0;
                    for (to, x) in scaled.rb_mut().row_mut(k).iter_mut().zip(below.rb().row(k).iter()) {
                        *to = x / pivot;
                        rows += to.powi(2);
                    }
                    found.negative += usize::from(pivot < 0.0);
                    found.size += pivot.abs() * (1.0 + beside + rows);
                }
                take(update, scaled.rb(), below.rb());
                Some(found)
            }
        }
    }
}

impl Pivots {
    pub fn and(self, other: Pivots) -> Pivots {
        Pivots { negative: self.negative + other.negative, size: self.size + other.size }
    }
}

/// Cholesky's factor in place; `None` where a pivot is not positive, or memory runs out.
fn cholesky(mut matrix: MatMut<'_, f64>) -> Option<()> {
    let (n, threads) = (matrix.nrows(), faer::get_global_parallelism());
    let scratch = llt::factor::cholesky_in_place_scratch::<f64>(n, threads, Default::default());
    let mut room = MemBuffer::try_new(scratch).ok()?;
    let (stack, none) = (MemStack::new(&mut room), Default::default());
    llt::factor::cholesky_in_place(matrix.as_mut(), none, threads, stack, Default::default()).ok()?;
    (0..n).all(|k| matrix[(k, k)] > 0.0 && matrix[(k, k)].is_finite()).then_some(())
}

/// The lower triangle of Aᵀ B taken from that of a matrix.
fn take(from: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>) {
    let (whole, half) = (BlockStructure::Rectangular, BlockStructure::TriangularLower);
    matmul(from, half, Accum::Add, a.transpose(), whole, b, whole, -1.0, faer::get_global_parallelism());
}

/// The lower triangle of n rows alone, column by column, in place.
fn pack(square: &mut Vec<f64>, n: usize) {
    let mut to = 0;
    for j in 0..n {
        square.copy_within(j * n + j..(j + 1) * n, to);
        to += n - j;
    }
    square.truncate(to);
    square.shrink_to_fit();
}

/// The columns of a supernode, and the rows below them.
fn supernode(
    symbolic_supernodal_cholesky: &SymbolicSupernodalCholesky<usize>,
    k: usize,
) -> (Range<usize>, &[usize]) {
    let ends = symbolic_supernodal_cholesky.col_ptr_for_row_idx();
    (
        symbolic_supernodal_cholesky.supernode_begin()[k]..symbolic_supernodal_cholesky.supernode_end()[k],
        &symbolic_supernodal_cholesky.row_idx()[ends[k]..ends[k + 1]],
    )
}

/// All of them, in the order of elimination.
pub(super) fn supernodes(
    symbolic_supernodal_cholesky: &SymbolicSupernodalCholesky<usize>,
) -> impl Iterator<Item = (Range<usize>, &[usize])> {
    (0..symbolic_supernodal_cholesky.n_supernodes()).map(|k| supernode(symbolic_supernodal_cholesky, k))
}

/// The products that the elimination of so many columns takes, so many rows below them: half the squares of
/// the columns' lengths.
pub(super) fn products_of(columns: usize, below: usize) -> f64 {
    (1..=columns).map(|k| ((k + below) as f64).powi(2) / 2.0).sum()
}

/// From so many numbers on that is worth the time that the system takes to hand out each page when it is
/// first written to.
const FRESH: usize = 1 << 26;

/// So many zeros; `None` where memory runs out.
pub(super) fn zeros<T: Clone>(n: usize, zero: T) -> Option<Vec<T>> {
    let mut numbers = Vec::new();
    numbers.try_reserve_exact(n).ok()?;
    if n > FRESH {
        // Given back: the system hands out zeros, and pages that nobody writes to, as of upper triangles,
        // take no memory.
        drop(std::hint::black_box(numbers));
        return Some(vec![zero; n]);
    }
    numbers.resize(n, zero);
    Some(numbers)
}
