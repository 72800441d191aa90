//! The half period in doubles, with a proven bound on what rounding did to it.
//!
//! Every row update is a symplectic shear: H_k = M_k H_(k−1) exactly, Ĥ_k = M_k Ĥ_(k−1) + e_i r_kᵀ computed,
//! the error r_k in the one row i. So the error is E_k = Σ_j H_k H_j⁻¹ e_i r_jᵀ. The inverse of a symplectic
//! matrix is its transpose up to signs and order: |H_j⁻¹ e_i| = |row i' of H_j|, where i' is the momentum of
//! the position i and the other way round, a row that the shear leaves alone. With σ = Σ |row i' of
//! Ĥ_j| |r_j|, ρ = Σ |r_j|, G = max ‖Ĥ_k‖ and e a bound on all earlier errors,
//!
//! ```text
//!     ‖E_k‖ ≤ (‖Ĥ_k‖ + ‖E_k‖) s,   s = σ + e ρ:      ‖E_k‖ ≤ ‖Ĥ_k‖ s/(1 − s).
//! ```
//!
//! If 8 G ρ ≤ 1 then e = 2Gσ does: σ ≤ Gρ ≤ 1/8, s ≤ 1.25 σ < 0.16, and 1.25/0.84 < 2. At the end ‖Ĥ‖ is the
//! spectral norm, and so is that of the bound on E. Positions and momenta are scaled by powers of two,
//! exactly, so that both are of one size.
//!
//! Drifts that follow each other change no momentum, and kicks no position: together they are one shear, with
//! the errors r_i in rows i of one matrix R, and H_j⁻¹ takes R to (rows i' of H_j)ᵀ R: a term of σ is ‖rows
//! i' of Ĥ_j‖₂ ‖R‖₂, one of ρ is ‖R‖₂. Of n rows that reach few others that is some n times less than row by
//! row; ‖·‖₂² is at most the largest sum of a row times that of a column.

use faer::Mat;

use crate::half::compose::{Program, Row, State};
use crate::half::norm;
use crate::linear::frame::Frame;
use crate::linear::system::System;
use crate::spectrum::modes::frequency_range;
use crate::verdict::limits::SIDE_BY_SIDE;
use clocks::schedule::Weight;
use number::parallel::both;
use number::{Rational, U, to_f64};

/// The blocks of Ĥ in the frame's coordinates, and the bound on their error.
#[derive(Clone, Debug)]
pub(crate) struct FloatBlocks {
    /// A, B, C and D, m x m.
    pub matrices: [Mat<f64>; 4],
    /// The spectral norm of the error of all together is at most this; `None` where the bound's condition
    /// fails.
    pub error: Option<f64>,
    /// More than the spectral norm of each.
    pub norm: f64,
    /// Positions are a_i y_i, momenta p_i/a_i.
    pub scales: Vec<f64>,
}

impl FloatBlocks {
    /// m: the number of columns and rows of a block.
    pub fn size(&self) -> usize {
        self.matrices[0].nrows()
    }
}

/// From how many degrees of freedom on shears are looked at as a whole, and those of how many rows: fewer
/// gain little.
const MANY: usize = 64;
const FEW: usize = 16;

struct Rows {
    columns: usize,
    x: Vec<f64>,
    p: Vec<f64>,
    /// Squared norms of the rows.
    x_norms: Vec<f64>,
    p_norms: Vec<f64>,
    /// The sum of all squared norms and the largest it has been.
    total: f64,
    largest: f64,
    /// Σ |r_j|, or ‖R‖₂ of a shear.
    rho: f64,
    /// Σ |row i'| |r_j|, or ‖rows i'‖₂ ‖R‖₂ of a shear.
    sigma: f64,
    /// The shear under way, where there are many rows.
    shear: Option<Shear>,
}

/// The rows that a shear changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Positions,
    Momenta,
}

/// Rows of one side, each changed once by multiples f_ij of rows j of the other side, which stay: |r_i| ≤ c_i
/// (|before| + Σ |f_ij| |row j|) entry by entry.
struct Shear {
    side: Side,
    rows: Vec<usize>,
    is_changed: Vec<bool>,
    /// The largest c_i, and the largest c_i Σ_j |f_ij|.
    share: f64,
    row: f64,
    /// Σ_i c_i |f_ij|, by j.
    columns: Vec<f64>,
    /// Σ |r_i| and Σ |row i'| |r_i|.
    apart: [f64; 2],
}

impl Shear {
    fn empty(n: usize) -> Shear {
        let (rows, is_changed, columns) = (Vec::new(), vec![false; n], vec![0.0; n]);
        Shear { side: Side::Positions, rows, is_changed, share: 0.0, row: 0.0, columns, apart: [0.0; 2] }
    }

    fn clear(&mut self) {
        self.rows.drain(..).for_each(|i| self.is_changed[i] = false);
        self.columns.fill(0.0);
        (self.share, self.row, self.apart) = (0.0, 0.0, [0.0; 2]);
    }

    /// Row i, changed by these multiples of the other side's rows.
    fn change(&mut self, i: usize, share: f64, multiples: impl Iterator<Item = (usize, f64)>) {
        self.rows.push(i);
        self.is_changed[i] = true;
        let mut sum = 0.0;
        for (j, f) in multiples {
            sum += share * f.abs();
            self.columns[j] += share * f.abs();
        }
        (self.share, self.row) = (self.share.max(share), self.row.max(sum));
    }

    /// Upper bounds of the terms of ρ and σ, together or row by row, whichever is less:
    /// with |before| ≤ |after| + |F| |other|, ‖R‖₂ ≤ c ‖|after|‖₂ + 2 ‖C |F|‖₂ ‖|other|‖₂.
    fn terms<'a>(&self, width: usize, changed: &'a [f64], other: &'a [f64]) -> [f64; 2] {
        let row = |values: &'a [f64], i: usize| &values[i * width..(i + 1) * width];
        let changed = norm::by_sums(width, self.rows.iter().map(|&i| row(changed, i)));
        let taken = |j: &usize| self.is_changed[*j] || self.columns[*j] > 0.0;
        let other = norm::by_sums(width, (0..self.columns.len()).filter(taken).map(|j| row(other, j)));
        let column = self.columns.iter().fold(0.0, |a: f64, x| a.max(*x));
        let error = 1.01 * (self.share * changed + 2.0 * (self.row * column).sqrt() * other);
        if other * error < self.apart[1] { [error, other * error] } else { self.apart }
    }
}

impl Rows {
    /// The identity: all 2n columns, since the bound is on the whole propagator.
    fn identity(n: usize) -> Self {
        let columns = 2 * n;
        let unit = |first: usize| {
            (0..n * columns).map(|k| f64::from(u8::from(k % columns == first + k / columns))).collect()
        };
        let total = columns as f64;
        Rows {
            columns,
            x: unit(0),
            p: unit(n),
            x_norms: vec![1.0; n],
            p_norms: vec![1.0; n],
            total,
            largest: total,
            rho: 0.0,
            sigma: 0.0,
            shear: (n >= MANY).then(|| Shear::empty(n)),
        }
    }

    /// Accounts for a row that had the squared norm `before` and was computed with an error of at most
    /// `error`, the conjugate row having the squared norm `conjugate`.
    fn account(&mut self, before: f64, after: f64, error: f64, conjugate: f64) {
        self.total += after - before;
        self.largest = self.largest.max(self.total);
        let [rho, sigma] = match &mut self.shear {
            Some(shear) => shear.apart.each_mut(),
            None => [&mut self.rho, &mut self.sigma],
        };
        *rho += error;
        *sigma += error * conjugate.sqrt();
    }

    /// Begins another shear where row i of this side does not belong to the one under way.
    fn enter(&mut self, side: Side, i: usize) {
        if self.shear.as_ref().is_some_and(|shear| shear.side != side || shear.is_changed[i]) {
            self.end_shear();
        }
        if let Some(shear) = &mut self.shear {
            shear.side = side;
        }
    }

    fn end_shear(&mut self) {
        let Some(shear) = &mut self.shear else { return };
        let [changed, other] = match shear.side {
            Side::Positions => [&self.x, &self.p],
            Side::Momenta => [&self.p, &self.x],
        };
        let [rho, sigma] =
            if shear.rows.len() < FEW { shear.apart } else { shear.terms(self.columns, changed, other) };
        self.rho += rho;
        self.sigma += sigma;
        shear.clear();
    }
}

impl State<f64> for Rows {
    fn drift(&mut self, program: &Program<f64>, island: usize, ticks: u64) {
        if ticks == 0 {
            return;
        }
        let (m, t) = (self.columns, ticks as f64);
        for &i in &program.islands[island] {
            self.enter(Side::Positions, i);
            let before = self.x_norms[i];
            let mut size = before.sqrt();
            let row = &mut self.x[i * m..(i + 1) * m];
            for (j, a) in &program.inverse_mass[i] {
                let factor = t * a;
                axpy(row, factor, &self.p[j * m..(j + 1) * m]);
                size += factor.abs() * self.p_norms[*j].sqrt();
            }
            let after = norm2(row);
            self.x_norms[i] = after;
            // Each of the k terms: the factor's three roundings (t, a, product), the product's, at most k
            // sums.
            let share = 1.01 * U * (program.inverse_mass[i].len() as f64 + 4.0);
            self.account(before, after, share * size, self.p_norms[i]);
            if let Some(shear) = &mut self.shear {
                shear.change(i, share, program.inverse_mass[i].iter().map(|(j, a)| (*j, t * a)));
            }
        }
    }

    fn kick(&mut self, i: usize, row: &Row<f64>, weight: Weight) {
        let m = self.columns;
        let weight = -weight.share();
        self.enter(Side::Momenta, i);
        let before = self.p_norms[i];
        let mut size = before.sqrt();
        let target = &mut self.p[i * m..(i + 1) * m];
        for (j, a) in row {
            let factor = weight * a;
            axpy(target, factor, &self.x[j * m..(j + 1) * m]);
            size += factor.abs() * self.x_norms[*j].sqrt();
        }
        let after = norm2(target);
        self.p_norms[i] = after;
        let share = 1.01 * U * (row.len() as f64 + 3.0);
        self.account(before, after, share * size, self.x_norms[i]);
        if let Some(shear) = &mut self.shear {
            shear.change(i, share, row.iter().copied());
        }
    }
}

/// row += factor other.
fn axpy(row: &mut [f64], factor: f64, other: &[f64]) {
    row.iter_mut().zip(other).for_each(|(x, y)| *x += factor * y);
}

/// Σ x², in eight sums side by side.
fn norm2(row: &[f64]) -> f64 {
    let chunks = row.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().map(|x| x * x).sum();
    let mut sums = [0.0; 8];
    for chunk in chunks {
        sums.iter_mut().zip(chunk).for_each(|(sum, x)| *sum += x * x);
    }
    rest + sums.iter().sum::<f64>()
}

/// The coefficients in doubles, positions a_i x_i and momenta p_i/a_i in place of x_i and p_i, and the a_i.
pub(crate) fn scaled_program(system: &System, frame: &Frame) -> (Program<f64>, Vec<f64>) {
    let mut program = Program::rounded(system);
    let scales = scales(&program, middle_frequency(system, frame));
    rescale(&mut program, &scales);
    (program, scales)
}

/// Runs the half period in doubles.
pub fn half_period(system: &System, frame: &Frame) -> FloatBlocks {
    let (program, scales) = scaled_program(system, frame);
    let is_rounded_well = program.entries().all(|x| x.abs() > 1e-290 && x.is_finite());
    let mut rows = Rows::identity(system.size());
    program.run(system.schedule().half_period(), &mut rows);
    rows.end_shear();
    let mut blocks = finish(rows, &frame.scaled(&scales), frame.kept.iter().map(|&i| scales[i]).collect());
    // An entry that underflows or overflows has no relative error to speak of.
    blocks.error = blocks.error.filter(|_| is_rounded_well);
    blocks
}

/// Projects rows of positions and columns of momenta, y_i = x_i − Σ n_J\[i\] x_J.
fn finish(rows: Rows, frame: &Frame, scales: Vec<f64>) -> FloatBlocks {
    let (m, columns) = (frame.kept.len(), rows.columns);
    let rigid: Vec<(usize, Vec<f64>)> = frame
        .rigid
        .iter()
        .map(|(index, n)| (*index, frame.kept.iter().map(|&i| to_f64(&n[i])).collect()))
        .collect();
    let row = |from: &[f64], i: usize| from[i * columns..(i + 1) * columns].to_vec();
    let mut y: Vec<Vec<f64>> = frame.kept.iter().map(|&i| row(&rows.x, i)).collect();
    for (index, n) in &rigid {
        let values = row(&rows.x, *index);
        y.iter_mut().zip(n).for_each(|(row, factor)| axpy(row, -factor, &values));
    }
    let p: Vec<Vec<f64>> = frame.kept.iter().map(|&i| row(&rows.p, i)).collect();
    let project = |row: Vec<f64>| {
        let momentum = |(k, &i): (usize, &usize)| {
            rigid.iter().fold(row[columns / 2 + i], |sum, (index, n)| sum - n[k] * row[columns / 2 + index])
        };
        let positions = frame.kept.iter().map(|&i| row[i]);
        positions.chain(frame.kept.iter().enumerate().map(momentum)).collect::<Vec<_>>()
    };
    let sides: [Vec<Vec<f64>>; 2] = [y, p].map(|rows| rows.into_iter().map(project).collect());
    let block = |side: usize, first: usize| Mat::from_fn(m, m, |i, j| sides[side][i][first + j]);
    let matrices = [block(0, 0), block(0, m), block(1, 0), block(1, m)];
    let stretch = rigid.iter().map(|(_, n)| norm2(n)).sum::<f64>();
    let end = rows.spectral_norm();
    let error = rows.error(rigid.len(), stretch, end);
    let norm = 1.01 * end * (1.0 + stretch) + error.unwrap_or(0.0);
    FloatBlocks { matrices, error, norm, scales }
}

impl Rows {
    /// The bound of the module's head, through a projection P = (I, −N) on both sides, r columns in N of
    /// squared norm `stretch` together, ‖Ĥ‖₂ ≤ `end`: ‖P‖² ≤ 1 + ‖N‖², and each side rounds r + 1 terms, N
    /// itself included.
    fn error(&self, r: usize, stretch: f64, end: f64) -> Option<f64> {
        // 1.01: the roundings of norms and of their running sums (fewer than 10^12 updates).
        let largest = 1.01 * (self.largest + self.total.abs()).sqrt();
        let (rho, sigma) = (1.01 * self.rho, 1.01 * self.sigma);
        if rho.is_nan() || 8.0 * largest * rho > 1.0 {
            return None;
        }
        let s = sigma + 2.0 * largest * sigma * rho;
        let absolute = (1.0 + stretch.sqrt()).powi(2);
        let projection = if r == 0 { 0.0 } else { 4.0 * (r as f64 + 2.0) * U * absolute * largest };
        Some(1.01 * (end * s / (1.0 - s) * (1.0 + stretch) + projection))
    }

    /// More than ‖Ĥ‖₂: block by block, ‖Ĥ‖² ≤ ‖A‖² + ‖B‖² + ‖C‖² + ‖D‖².
    fn spectral_norm(&self) -> f64 {
        let n = self.columns / 2;
        let block = |rows: &[f64], first: usize| {
            norm::spectral(&Mat::from_fn(n, n, |i, j| rows[i * self.columns + first + j])).powi(2)
        };
        let of = |rows: &[f64]| [block(rows, 0), block(rows, n)];
        let ([a, b], [c, d]) = both(n >= SIDE_BY_SIDE, || of(&self.x), || of(&self.p));
        1.01 * (a + b + c + d).sqrt()
    }
}

/// For each degree of freedom a power of two a_i near √(m_i ω): positions are taken times a_i, momenta
/// divided by it. With ω between the lowest and the highest frequency (their geometric mean, per tick) a mode
/// of frequency w enters the propagator with entries up to max(ω/w, w/ω).
fn scales(program: &Program<f64>, omega: f64) -> Vec<f64> {
    let scale = |(i, row): (usize, &Row<f64>)| {
        let inverse_mass = row.iter().find(|(j, _)| *j == i).map_or(1.0, |(_, x)| x.abs());
        let ratio = (omega / inverse_mass).sqrt();
        if ratio.is_normal() { ratio.log2().round().clamp(-300.0, 300.0).exp2() } else { 1.0 }
    };
    program.inverse_mass.iter().enumerate().map(scale).collect()
}

/// The geometric mean of the lowest and the highest frequency per tick; 1 where there is none.
fn middle_frequency(system: &System, frame: &Frame) -> f64 {
    let omega = frequency_range(system, frame).map_or(0.0, |(lowest, highest)| (lowest * highest).sqrt());
    let per_tick = omega * to_f64(system.tick());
    if per_tick.is_normal() { per_tick } else { 1.0 }
}

fn rescale(program: &mut Program<f64>, a: &[f64]) {
    for (i, row) in program.inverse_mass.iter_mut().enumerate() {
        row.iter_mut().for_each(|(j, x)| *x *= a[i] * a[*j]);
    }
    for (i, row) in program.kicks.iter_mut().flat_map(|kick| &mut kick.rows) {
        row.iter_mut().for_each(|(j, x)| *x /= a[*i] * a[*j]);
    }
}

impl Frame {
    /// The frame in positions a_i x_i: rigid modes n_J\[i\] a_i/a_J.
    fn scaled(&self, a: &[f64]) -> Frame {
        let factor = |x: f64| Rational::from_float(x).expect("a power of two");
        let rigid = |(index, n): &(usize, Vec<Rational>)| {
            let scaled = n.iter().enumerate().map(|(i, x)| x * factor(a[i] / a[*index])).collect();
            (*index, scaled)
        };
        Frame { rigid: self.rigid.iter().map(rigid).collect(), kept: self.kept.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::half::compose;
    use crate::linear::builders::graded_bar;
    use number::ratio;

    #[test]
    fn the_bound_of_whole_shears_holds_and_is_less_than_that_row_by_row() {
        let system = graded_bar(MANY + 8, 3, &ratio(7, 10)).unwrap();
        let frame = Frame::new(&system);
        assert!(frame.rigid.is_empty());
        let blocks = half_period(&system, &frame);
        let (n, a) = (system.size(), &blocks.scales);
        let exact = compose::half_period::<Rational>(&system);
        let off = |k: usize, j: usize| {
            let row = if k < n { a[k] } else { a[k - n].recip() };
            let column = if j < n { a[j].recip() } else { a[j - n] };
            let value = blocks.matrices[2 * (k / n) + j / n][(k % n, j % n)];
            let rounded = Rational::from_float(value / row / column).expect("powers of two are exact");
            to_f64(&(rounded - &exact[(k, j)])) * row * column
        };
        let largest = Mat::from_fn(2 * n, 2 * n, off).singular_values().unwrap()[0];
        let error = blocks.error.unwrap();
        assert!(largest > 0.0 && largest <= error, "{largest} {error}");
        let (program, scales) = scaled_program(&system, &frame);
        let mut apart = Rows::identity(n);
        apart.shear = None;
        program.run(system.schedule().half_period(), &mut apart);
        let apart = finish(apart, &frame.scaled(&scales), scales).error.unwrap();
        // The gain grows as the root of n: 2.5 here, 33 for a plate of 2,080.
        assert!(2.0 * error < apart, "{error} {apart}");
    }
}
