//! Proofs of positive definiteness by an incomplete factorization.
//!
//! Between molecules far from each other elimination leaves next to nothing. Where it comes to such a block E, E is left out and the sums of its
//! |entries| are taken from the diagonal on both sides. What is left out, \[\[diag |E| 1, E\], \[Eᵀ, diag |E|ᵀ 1\]\], is positive semidefinite, so
//! the matrix is no less than what is factored, and positive pivots prove it positive definite (`proofs/REGION.md`, section 11; the mirror image of
//! Ajiz and Jennings, Int. J. Numer. Methods Eng. 20, 1984).
//!
//! All this is done in coordinates in which the matrix of each molecule alone is the identity: what is small beside a bond may be large beside
//! what holds the molecule in its place.

use std::cmp::Ordering;
use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::*;
use faer::{Accum, MatMut};

use super::dissect::clusters;
use super::fronts::cholesky;
use super::matrix::Pattern;
use crate::number::U;
use crate::parallel::map;

/// Small groups of rows that belong together, such as molecules, in the order in which they are eliminated.
#[derive(Debug)]
pub(super) struct Molecules {
    /// Of each row its group and its place there.
    places: Vec<(usize, usize)>,
    /// Where the rows of each group begin, in the order of elimination.
    begins: Vec<usize>,
    /// The later groups that entries join to each.
    near: Vec<Vec<usize>>,
    /// Groups that are eliminated at once: where each of these panels begins.
    panels: Vec<usize>,
}

/// Rows of a group at most.
const LARGEST: usize = 36;

/// Columns that are eliminated at once, about: fewer leave out more, more run faster.
const WIDTH: usize = 48;

/// Of the least eigenvalue that is expected: a block is left out where no sum of |entries| of a row or a column is more than the first part of it, and what is
/// left out of a row in all is no more than the second part. Below half of it positive pivots are certain where it is what is expected; a smaller first part
/// keeps more at once, a larger one uses up the second part by few blocks.
const LEFT_OUT: [f64; 2] = [0.01, 0.45];

/// Sums of so many products at most are counted upon; so many roundings beside them.
const TERMS: usize = 1 << 15;
const BESIDE: usize = 64;

/// Products of a panel from which on it is made in parts, and how many.
const MANY: f64 = 1e7;
const PARTS: usize = 4;

impl Molecules {
    /// Those of the first pattern in the second one; `None` where some are large.
    pub fn new(alone: &Pattern, both: &Pattern) -> Option<Molecules> {
        let rows = alone.components();
        if rows.iter().any(|own| own.len() > LARGEST) {
            return None;
        }
        let mut group = vec![0; both.size()];
        rows.iter().enumerate().for_each(|(k, own)| own.iter().for_each(|&i| group[i] = k));
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for (i, j) in both.places() {
            let pair = [group[i].min(group[j]), group[i].max(group[j])];
            // The rows of a group are beside each other most often.
            if pair[0] != pair[1] && pairs.last() != Some(&pair) {
                pairs.push(pair);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut joined = vec![Vec::new(); rows.len()];
        for &[a, b] in &pairs {
            joined[a].push(b);
            joined[b].push(a);
        }
        let clusters = clusters(rows.iter().map(Vec::len).collect(), joined, WIDTH);
        let mut cluster = vec![0; rows.len()];
        clusters.iter().enumerate().for_each(|(c, own)| own.iter().for_each(|&k| cluster[k] = c));
        let beside: Vec<_> = pairs
            .iter()
            .map(|&[a, b]| (cluster[a].max(cluster[b]), cluster[a].min(cluster[b]), 0.0))
            .collect();
        let order = Pattern::of(clusters.len(), [&beside]).ok()?.0.order();
        let (mut places, mut begins, mut panels) = (vec![(0, 0); both.size()], vec![0], vec![0]);
        let mut turn = vec![0; rows.len()];
        for &k in order.iter().flat_map(|&c| &clusters[c]) {
            let (at, begin) = (begins.len() - 1, begins[begins.len() - 1]);
            turn[k] = at;
            rows[k].iter().enumerate().for_each(|(within, &i)| places[i] = (at, within));
            begins.push(begin + rows[k].len());
        }
        order.iter().for_each(|&c| panels.push(panels[panels.len() - 1] + clusters[c].len()));
        let mut near = vec![Vec::new(); rows.len()];
        for [a, b] in pairs {
            let (a, b) = (turn[a], turn[b]);
            near[a.min(b)].push(a.max(b));
        }
        near.iter_mut().for_each(|own| own.sort_unstable());
        Some(Molecules { places, begins, near, panels })
    }

    fn rows(&self, group: usize) -> Range<usize> {
        self.begins[group]..self.begins[group + 1]
    }

    fn size(&self, group: usize) -> usize {
        self.rows(group).len()
    }

    /// About the products of a whole factorization that takes as long as one of these, where about `reach` times as many rows as are joined to each molecule
    /// are kept. Small blocks take twice the time of large ones.
    pub fn cost(&self, reach: f64) -> f64 {
        let below = |k: usize| self.near[k].iter().map(|&l| self.size(l)).sum::<usize>() * self.size(k);
        let (n, entries) = (self.places.len() as f64, (0..self.near.len()).map(below).sum::<usize>() as f64);
        n * (reach * entries / n).powi(2)
    }

    /// Whether a matrix of the pattern that these were made of is proven positive definite. `least` is about its least eigenvalue: it decides what is left
    /// out, and no proof rests on it.
    pub fn is_definite(&self, pattern: &Pattern, values: &[f64], least: f64) -> bool {
        self.scaled(pattern, values).is_some_and(|scaled| {
            let mut own = Incomplete::new(self, least / scaled.softest);
            own.is_done(scaled)
        })
    }

    /// G A Gᵀ − shift, G of each group about the inverse of its own matrix's Cholesky factor; `None` where there is none.
    ///
    /// The shift is what roundings here and in the elimination may take: where all pivots of the result are positive A is positive definite.
    fn scaled(&self, pattern: &Pattern, values: &[f64]) -> Option<Scaled> {
        let count = self.near.len();
        let mut own: Vec<Mat<f64>> = (0..count).map(|k| Mat::zeros(self.size(k), self.size(k))).collect();
        let mut beside: Vec<Vec<Mat<f64>>> = (0..count)
            .map(|k| self.near[k].iter().map(|&l| Mat::zeros(self.size(l), self.size(k))).collect())
            .collect();
        for (i, j, x) in pattern.triplets(values) {
            let ((k, a), (l, b)) = (self.places[i], self.places[j]);
            match k.cmp(&l) {
                Ordering::Equal => (own[k][(a, b)], own[k][(b, a)]) = (x, x),
                Ordering::Greater => beside[l][self.near[l].binary_search(&k).ok()?][(a, b)] = x,
                Ordering::Less => beside[k][self.near[k].binary_search(&l).ok()?][(b, a)] = x,
            }
        }
        let inverse = |own: &Mat<f64>| {
            let factor = own.llt(faer::Side::Lower).ok()?;
            let mut inverse = Mat::<f64>::identity(own.nrows(), own.nrows());
            solve_lower_triangular_in_place(factor.L(), inverse.as_mut(), faer::Par::Seq);
            Some(inverse)
        };
        let inverses: Vec<Mat<f64>> = own.iter().map(inverse).collect::<Option<_>>()?;
        let lengths: Vec<f64> = inverses.iter().map(|own| own.norm_l2()).collect();
        // Of each group the sum of |G||A||Gᵀ| over its row of blocks, in their Frobenius norms.
        let mut sums = vec![0.0; count];
        let mut trace = 0.0;
        for k in 0..count {
            sums[k] += lengths[k] * own[k].norm_l2() * lengths[k];
            own[k] = &inverses[k] * &own[k] * inverses[k].transpose();
            trace += own[k].diagonal().column_vector().iter().map(|x| x.abs()).sum::<f64>();
            for (&l, x) in self.near[k].iter().zip(&mut beside[k]) {
                let size = lengths[l] * x.norm_l2() * lengths[k];
                (sums[k], sums[l]) = (sums[k] + size, sums[l] + size);
                *x = &inverses[l] * &*x * inverses[k].transpose();
            }
        }
        let n = self.places.len();
        let size = sums.into_iter().fold(0.0, f64::max);
        // Two products of sums of a group's rows; sums of so many products and what beside them.
        let shift = 1.01 * U * ((2 * LARGEST + BESIDE) as f64 * size + (TERMS + BESIDE) as f64 * trace)
            + f64::MIN_POSITIVE * (n as f64 + 1.0).powi(2);
        own.iter_mut().for_each(|own| (0..own.nrows()).for_each(|i| own[(i, i)] -= shift));
        let softest = lengths.iter().map(|length| length.powi(-2)).sum::<f64>() / count as f64;
        shift.is_finite().then_some(Scaled { own, beside, softest })
    }
}

/// The matrix of each group, and those beside it, of later groups.
struct Scaled {
    own: Vec<Mat<f64>>,
    beside: Vec<Vec<Mat<f64>>>,
    /// About the least eigenvalue of a group's own matrix before, on average.
    softest: f64,
}

/// Columns of the factor.
struct Panel {
    /// The later groups that have rows, and where these begin.
    groups: Vec<usize>,
    begins: Vec<usize>,
    values: Mat<f64>,
    /// The first of them that is not eliminated yet.
    next: usize,
}

/// An incomplete factorization under way.
struct Incomplete<'a> {
    molecules: &'a Molecules,
    panels: Vec<Panel>,
    /// Of each panel, the earlier ones whose next group is in it.
    waiting: Vec<Vec<usize>>,
    /// The panel of each group.
    of: Vec<usize>,
    /// What is taken from the diagonal for what is left out.
    taken: Vec<f64>,
    /// Of each group, the products and what else its sums have.
    terms: Vec<usize>,
    /// Where the rows of each group that has any begin in the panel under way.
    places: Vec<usize>,
    left_out: [f64; 2],
}

impl<'a> Incomplete<'a> {
    fn new(molecules: &'a Molecules, above: f64) -> Incomplete<'a> {
        let count = molecules.near.len();
        let mut of = vec![0; count];
        molecules.panels.windows(2).enumerate().for_each(|(k, ends)| of[ends[0]..ends[1]].fill(k));
        Incomplete {
            molecules,
            panels: Vec::new(),
            waiting: vec![Vec::new(); molecules.panels.len() - 1],
            of,
            taken: vec![0.0; molecules.places.len()],
            terms: vec![0; count],
            places: vec![0; count],
            left_out: LEFT_OUT.map(|part| part * above),
        }
    }

    /// Whether all pivots are positive, and no sum has more terms than are counted upon.
    fn is_done(&mut self, mut scaled: Scaled) -> bool {
        (0..self.waiting.len()).all(|k| self.panel(k, &mut scaled).is_some())
            && self.terms.iter().all(|&terms| terms <= TERMS)
    }

    /// Eliminates the columns of a panel; `None` where a pivot is not positive.
    fn panel(&mut self, k: usize, scaled: &mut Scaled) -> Option<()> {
        let molecules = self.molecules;
        let own = molecules.panels[k]..molecules.panels[k + 1];
        let first = molecules.begins[own.start];
        let width = molecules.begins[own.end] - first;
        let earlier = std::mem::take(&mut self.waiting[k]);
        let groups = self.groups(own.clone(), &earlier);
        let mut begins = vec![width];
        own.clone().for_each(|l| self.places[l] = molecules.begins[l] - first);
        for &l in &groups {
            let begin = begins[begins.len() - 1];
            self.places[l] = begin;
            begins.push(begin + molecules.size(l));
        }
        let mut values = self.updates(&earlier, [begins[groups.len()], width], own.end);
        for l in own.clone() {
            let column = self.places[l];
            add(values.as_mut(), [column, column], &scaled.own[l]);
            let beside = std::mem::take(&mut scaled.beside[l]);
            molecules.near[l]
                .iter()
                .zip(&beside)
                .for_each(|(&m, x)| add(values.as_mut(), [self.places[m], column], x));
        }
        self.hand_on(earlier, own.clone(), width);
        let block = |at: usize| values.as_ref().subrows(begins[at], begins[at + 1] - begins[at]);
        let kept: Vec<usize> =
            (0..groups.len()).filter(|&at| !self.is_left_out(groups[at], &own, block(at))).collect();
        let mut ends = vec![0];
        kept.iter().for_each(|&at| ends.push(ends[ends.len() - 1] + block(at).nrows()));
        let mut below = Mat::zeros(ends[kept.len()], width);
        for (&at, &to) in kept.iter().zip(&ends) {
            below.as_mut().subrows_mut(to, block(at).nrows()).copy_from(block(at));
        }
        let mut top = values.as_mut().subrows_mut(0, width);
        (0..width).for_each(|i| top[(i, i)] -= self.taken[first + i]);
        cholesky(top.as_mut(), faer::Par::Seq)?;
        solve_lower_triangular_in_place(top.as_ref(), below.as_mut().transpose_mut(), faer::Par::Seq);
        let groups: Vec<usize> = kept.iter().map(|&at| groups[at]).collect();
        if let Some(&l) = groups.first() {
            self.waiting[self.of[l]].push(k);
        }
        self.panels.push(Panel { groups, begins: ends, values: below, next: 0 });
        Some(())
    }

    /// The later groups that have rows in a panel, by the matrix or by what earlier panels take from it.
    fn groups(&self, own: Range<usize>, earlier: &[usize]) -> Vec<usize> {
        let joined = own.clone().flat_map(|l| &self.molecules.near[l]);
        let taken = earlier.iter().flat_map(|&e| &self.panels[e].groups[self.panels[e].next..]);
        let mut groups: Vec<usize> = joined.chain(taken).copied().filter(|&l| l >= own.end).collect();
        groups.sort_unstable();
        groups.dedup();
        groups
    }

    /// Lets earlier panels wait for the group after these; of those that have none nothing is kept.
    fn hand_on(&mut self, earlier: Vec<usize>, own: Range<usize>, width: usize) {
        for e in earlier {
            let panel = &mut self.panels[e];
            let columns = panel.values.ncols();
            let last = panel.before(own.end);
            panel.groups[panel.next..last].iter().for_each(|&l| self.terms[l] += columns);
            panel.next = last;
            match panel.groups.get(last) {
                Some(&l) => self.waiting[self.of[l]].push(e),
                None => panel.values = Mat::new(),
            }
        }
        own.for_each(|l| self.terms[l] += width);
    }

    /// What earlier panels take from one, own rows first; the groups before `end` are its own.
    fn updates(&self, earlier: &[usize], [height, width]: [usize; 2], end: usize) -> Mat<f64> {
        let cost = |&e: &usize| {
            let panel = &self.panels[e];
            ((panel.values.nrows() - panel.begins[panel.next]) * panel.values.ncols() * width) as f64
        };
        // As many parts whatever the threads, so that sums have one order.
        let parts = if earlier.iter().map(cost).sum::<f64>() > MANY { PARTS } else { 1 };
        let parts: Vec<&[usize]> = earlier.chunks(earlier.len().div_ceil(parts).max(1)).collect();
        let sums = map(&parts, |part| {
            let mut sum = Mat::zeros(height, width);
            part.iter().for_each(|&e| self.update(&self.panels[e], end, sum.as_mut()));
            sum
        });
        sums.into_iter().reduce(|sum, part| sum + part).unwrap_or_else(|| Mat::zeros(height, width))
    }

    /// Adds −L Lᵀ of an earlier panel to one.
    fn update(&self, panel: &Panel, end: usize, mut to: MatMut<'_, f64>) {
        let (ends, own) = (&panel.begins, panel.next..panel.before(end));
        let base = ends[own.start];
        let rows = panel.values.subrows(base, panel.values.nrows() - base);
        let columns = rows.subrows(0, ends[own.end] - base);
        let mut product = Mat::zeros(rows.nrows(), columns.nrows());
        matmul(product.as_mut(), Accum::Replace, rows, columns.transpose(), -1.0, faer::Par::Seq);
        for c in own {
            for j in 0..ends[c + 1] - ends[c] {
                let from = product.col_as_slice(ends[c] - base + j);
                let column = to.rb_mut().col_mut(self.places[panel.groups[c]] + j);
                let column = column.try_as_col_major_mut().expect("a column of a matrix").as_slice_mut();
                for r in c..panel.groups.len() {
                    let (at, from) =
                        (self.places[panel.groups[r]], &from[ends[r] - base..ends[r + 1] - base]);
                    column[at..at + from.len()].iter_mut().zip(from).for_each(|(sum, x)| *sum += x);
                }
            }
        }
    }

    /// Whether a group's rows of a panel are left out; what that takes from the diagonal then is.
    fn is_left_out(&mut self, group: usize, own: &Range<usize>, block: MatRef<'_, f64>) -> bool {
        let columns = self.molecules.begins[own.start]..self.molecules.begins[own.end];
        let rows = self.molecules.rows(group);
        let mut sums = [vec![0.0; rows.len()], vec![0.0; columns.len()]];
        for j in 0..columns.len() {
            for i in 0..rows.len() {
                let x = block[(i, j)].abs();
                sums[0][i] += x;
                sums[1][j] += x;
            }
        }
        // Sums of |entries|, rounded up.
        let up = 1.0 + (rows.len().max(columns.len()) as f64 + 4.0) * U;
        let [of_rows, of_columns] = sums;
        let all = || rows.clone().zip(&of_rows).chain(columns.clone().zip(&of_columns));
        let [most, in_all] = self.left_out;
        let is_small = all().all(|(i, sum)| up * sum <= most && self.taken[i] + up * sum <= in_all);
        if is_small {
            all().for_each(|(i, sum)| self.taken[i] += up * sum);
            own.clone().chain([group]).for_each(|l| self.terms[l] += 1);
        }
        is_small
    }
}

impl Panel {
    /// The first of its groups that is not before `end`.
    fn before(&self, end: usize) -> usize {
        self.next + self.groups[self.next..].partition_point(|&l| l < end)
    }
}

/// Adds a block to part of a matrix.
fn add(mut to: MatMut<'_, f64>, [i, j]: [usize; 2], block: &Mat<f64>) {
    let mut part = to.rb_mut().submatrix_mut(i, j, block.nrows(), block.ncols());
    part += block;
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// F and S of molecules of three rows on a cubic lattice: stiff within, each row held in its place by so much, soft between molecules up to two apart;
    /// numbers without a pattern.
    pub fn lattice(side: i64, [held, soft]: [f64; 2]) -> [Vec<(usize, usize, f64)>; 2] {
        let number = |k: usize| (k as f64 * 0.754_877_666_246_692_7).fract() - 0.5;
        let (mut fast, mut slow) = (Vec::new(), Vec::new());
        for k in 0..side.pow(3) {
            for at in 0..125 {
                let [x, y, z] = [at % 5 - 2, at / 5 % 5 - 2, at / 25 - 2];
                let apart = x * x + y * y + z * z;
                let other = [k % side + x, k / side % side + y, k / side / side + z];
                let l = other[0] + side * (other[1] + side * other[2]);
                if apart > 4 || other.iter().any(|own| !(0..side).contains(own)) || l > k {
                    continue;
                }
                for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
                    let (i, j) = (3 * k as usize + a, 3 * l as usize + b);
                    let own = number(1 + i * 1009 + j * 31);
                    if l < k {
                        slow.push((i, j, soft * own / apart as f64));
                    } else if j <= i {
                        fast.push((i, j, if a == b { 100.0 + 10.0 * own } else { 40.0 * own }));
                        slow.push((i, j, if a == b { held } else { 0.0 }));
                    }
                }
            }
        }
        [fast, slow]
    }

    #[test]
    fn what_is_proven_is_so_and_close_to_all_that_is() {
        let [fast, slow] = lattice(7, [-60.0, 4.0]);
        let n = 3 * 343;
        let all = [fast.clone(), slow].concat();
        let (alone, _) = Pattern::of(n, [&fast]).unwrap();
        let (both, [values]) = Pattern::of(n, [&all]).unwrap();
        let mut dense = Mat::<f64>::zeros(n, n);
        both.triplets(&values).for_each(|(i, j, x)| (dense[(i, j)], dense[(j, i)]) = (x, x));
        let least = dense.self_adjoint_eigenvalues(faer::Side::Lower).unwrap()[0];
        let molecules = Molecules::new(&alone, &both).unwrap();
        assert!(molecules.panels.len() > 20);
        // Off by `part` of the least eigenvalue, which is expected to be `guess` times what it is.
        let done = |part: f64, guess: f64| {
            let lowered = both.lowered(-least * (1.0 - part), &[(1.0, &values)], 0.0).unwrap();
            let scaled = molecules.scaled(&both, &lowered)?;
            let mut own = Incomplete::new(&molecules, guess * part.abs() * least / scaled.softest);
            let is_done = own.is_done(scaled);
            is_done.then(|| own.taken.iter().filter(|&&x| x > 0.0).count())
        };
        for part in [1.0, 0.1, 1e-2, 1e-4] {
            // The least eigenvalue in parts of the molecules' own matrices is not far from what the average of these makes it.
            let taken = done(part, 0.3).expect("far enough from the edge");
            assert!(taken > if part > 0.05 { n / 2 } else { 0 }, "{part}: {taken} rows");
        }
        for (part, guess) in [-1e-7, -1e-3, -0.1]
            .into_iter()
            .flat_map(|part| [0.0, 1e-3, 1.0, 1e3, 1e9].map(|guess| (part, guess)))
        {
            assert_eq!(done(part, guess), None, "{part} {guess}");
        }
    }

    #[test]
    fn large_molecules_are_not_taken_apart() {
        let chain: Vec<_> = (0..50).map(|i| (i, i, 2.0)).chain((1..50).map(|i| (i, i - 1, -0.5))).collect();
        let (pattern, _) = Pattern::of(50, [&chain]).unwrap();
        assert!(Molecules::new(&pattern, &pattern).is_none());
    }
}
