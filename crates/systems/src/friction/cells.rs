//! More degrees of freedom at all frictions of a cell at once.
//!
//! On a cell of c (file `powers`), written with x from 0 to 1, the period is a mean of matrices Q_j,
//!
//! ```text
//!     Q = Σ_j Q_j C(N, j) x^j (1 − x)^(N − j).
//! ```
//!
//! A form that each Q_j shrinks is shrunk by their means, since norms are convex: then ρ(Q) < 1 at every
//! friction of the cell (proofs/FRICTION.md). The norm is that of the middle's eigenvectors. The Q_j lie
//! within second orders of the cell's width of the true Q, so some ten cells to a hundred reach from an edge
//! to c = 0, where velocities are stopped.

use faer::Mat;

use super::masking::proven_down;
use super::powers::{Powers, bernstein, of_rows};
use super::radius::shrink_one_form;
use crate::half::float::scaled_program;
use crate::linear::frame::Frame;
use crate::linear::system::System;
use number::{Ball, U};

/// Products of doubles that all cells may cost: seconds.
const MAX_PRODUCTS: usize = 5_000_000_000;

/// Cells that are halved in all.
const MAX_HALVINGS: usize = 2000;

/// The period at all frictions.
pub(super) struct Cells {
    powers: Powers,
    /// Rows are multiplied by these, and columns divided: positions and momenta are then of one size.
    scales: Vec<f64>,
}

/// The period on a cell.
struct Cell {
    size: usize,
    /// Column by column the Q_j of each entry.
    entries: Vec<Vec<f64>>,
    /// How far (2-norm) each Q_j may be off.
    error: f64,
}

impl Cells {
    pub fn new(powers: Powers, system: &System) -> Cells {
        let (_, scales) = scaled_program(system, &Frame::whole(system.size()));
        Cells { powers, scales: of_rows(&scales) }
    }

    /// Up to where all frictions from this one on are proven to mask.
    pub fn up(&self, from: f64) -> f64 {
        let end = self.powers.top(from).and_then(|top| {
            let halve = |cell: Cell| (!cell.masks()).then(|| cell.halved());
            let least = proven_down(self.whole(&top), self.halvings(), |cell, _, _| halve(cell));
            Some(self.powers.rate(least, &top)?.0)
        });
        end.map_or(from, |end| end.max(from))
    }

    /// A cell costs the halves of (2n)² polynomials, eigenvalues and a form of 2n rows (some 100 products),
    /// and two products and a factorization for each Q_j.
    fn halvings(&self) -> usize {
        let (size, terms) = (self.scales.len(), self.powers.degree + 1);
        let cost = size.pow(2) * terms.pow(2) + size.pow(3) * (100 + 4 * terms);
        (MAX_PRODUCTS / cost).min(MAX_HALVINGS)
    }

    /// The cell from c = 0 to `top`.
    fn whole(&self, top: &Ball) -> Cell {
        let (size, mut squares) = (self.scales.len(), 0.0);
        let mut entry = |(j, i): (usize, usize)| {
            let all = bernstein(&self.powers.columns[j][i], top, self.powers.bits);
            let scale = self.scales[i] / self.scales[j];
            let ends: Vec<_> = all.iter().map(Ball::to_f64_enclosure).collect();
            squares += ends.iter().map(|(lo, hi)| scale * (hi - lo)).fold(0.0, f64::max).powi(2);
            ends.iter().map(|(lo, hi)| scale * (lo + (hi - lo) / 2.0)).collect()
        };
        let places = (0..size).flat_map(|j| (0..size).map(move |i| (j, i)));
        let entries = places.map(&mut entry).collect();
        Cell { size, entries, error: 1.01 * squares.sqrt() + size as f64 * f64::MIN_POSITIVE }
    }
}

impl Cell {
    fn matrix(&self, j: usize) -> Mat<f64> {
        Mat::from_fn(self.size, self.size, |row, column| self.entries[column * self.size + row][j])
    }

    /// Whether all frictions of the cell are proven to mask.
    fn masks(&self) -> bool {
        let all: Vec<_> = (0..self.entries[0].len()).map(|j| self.matrix(j)).collect();
        let middle = |own: &Vec<f64>| halved(own)[1][0];
        let middle: Vec<f64> = self.entries.iter().map(middle).collect();
        let middle = Mat::from_fn(self.size, self.size, |i, j| middle[j * self.size + i]);
        shrink_one_form(&middle, &all, self.error)
    }

    /// The lower and the upper half. Each of N sums of a coefficient is rounded, and no mean enlarges what
    /// was rounded before.
    fn halved(&self) -> [Cell; 2] {
        let largest = |own: &Vec<f64>| own.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let size = self.entries.iter().map(largest).map(|x| x * x).sum::<f64>().sqrt();
        let rounding =
            1.01 * self.entries[0].len() as f64 * (U * size + self.size as f64 * f64::MIN_POSITIVE);
        let error = 1.01 * (self.error + rounding);
        let (lower, upper) = self.entries.iter().map(|own| halved(own).into()).unzip();
        [lower, upper].map(|entries| Cell { size: self.size, entries, error })
    }
}

/// Coefficients on the lower and the upper half (de Casteljau).
fn halved(row: &[f64]) -> [Vec<f64>; 2] {
    let (mut row, mut lower) = (row.to_vec(), Vec::with_capacity(row.len()));
    for last in (0..row.len()).rev() {
        lower.push(row[0]);
        (0..last).for_each(|j| row[j] = (row[j] + row[j + 1]) / 2.0);
    }
    [lower, row]
}
