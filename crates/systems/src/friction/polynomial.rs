//! One oscillator at all frictions at once.
//!
//! Tr Q is a polynomial in c (file `powers`), and det Q = c^N. A friction masks iff f₋ = 1 + c^N − Tr Q and
//! f₊ = 1 + c^N + Tr Q are positive (Jury), something grows iff one is negative. In the basis of Bernstein on
//! a cell of c a polynomial lies between its least and its largest coefficient: cells are halved until these
//! have one sign (proofs/FRICTION.md).

use super::masking::Mask;
use super::powers::{Coefficients, Powers, bernstein, combined};
use number::{Ball, Sign};

/// The degree in c: to halve a cell costs its square, some milliseconds at this.
const MAX_STEPS: usize = 128;

/// Sums of balls that halving may cost in all: about a second, and some six edges to the width of
/// [`MIN_CELL`] at the largest degree.
const MAX_SUMS: usize = 5_000_000;

/// Cells that are halved in all.
const MAX_HALVINGS: usize = 1500;

/// The width of a cell that is not halved, relative to all of them.
const MIN_CELL: f64 = 1.0 / (1_u64 << 48) as f64;

/// f₋ and f₊ by powers of c.
pub(super) struct Polynomials<'a> {
    sides: [Coefficients; 2],
    powers: &'a Powers,
}

/// What a cell of c holds.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Masks,
    Grows,
    Open,
}

impl Polynomials<'_> {
    /// `None` for more than one degree of freedom, and for periods that are too long.
    pub fn new(powers: &Powers) -> Option<Polynomials<'_>> {
        let [first, second] = &powers.columns[..] else { return None };
        let (n, bits) = (powers.degree, powers.bits);
        if n > MAX_STEPS {
            return None;
        }
        let trace = combined(&first[0], &second[1], &Ball::one(), bits);
        let mut sums = vec![Ball::zero(); n + 1];
        for i in [0, n] {
            sums[i] = sums[i].add(&Ball::one(), bits);
        }
        let sides = [Ball::one().neg(), Ball::one()].map(|sign| combined(&sums, &trace, &sign, bits));
        Some(Polynomials { sides, powers })
    }

    /// The frictions that mask, above one at which something grows; 0: without any.
    pub fn above(&self, grows: f64) -> Option<Mask> {
        let (bits, top) = (self.powers.bits, self.powers.top(grows)?);
        let mut halvings = MAX_HALVINGS.min(MAX_SUMS / self.sides[0].len().pow(2));
        let mut cells = Vec::new();
        let sides = self.sides.each_ref().map(|side| Some(bernstein(side, &top, bits)));
        self.visit(sides, (0.0, 1.0), &mut halvings, &mut cells);
        let rate = |share: f64| self.powers.rate(share, &top);
        let (mut least, mut ranges) = (grows, Vec::new());
        for (cell, lo, hi) in joined(&cells) {
            match cell {
                Cell::Masks => ranges.push((rate(hi)?.1, rate(lo)?.0)),
                Cell::Grows if ranges.is_empty() => least = rate(lo)?.0.max(grows),
                _ => {}
            }
        }
        ranges.retain(|(lo, hi)| lo <= hi);
        Some(Mask::found(least, ranges))
    }

    /// The cells from `lo` to `hi`, the last one first; `None` in place of a polynomial that is positive
    /// there.
    fn visit(
        &self,
        sides: [Option<Coefficients>; 2],
        (lo, hi): (f64, f64),
        halvings: &mut usize,
        cells: &mut Vec<(Cell, f64, f64)>,
    ) {
        let all = |side: &Coefficients, sign: Sign| side.iter().all(|b| b.sign() == Some(sign));
        if sides.iter().flatten().any(|side| all(side, Sign::Negative)) {
            return cells.push((Cell::Grows, lo, hi));
        }
        let sides = sides.map(|side| side.filter(|side| !all(side, Sign::Positive)));
        if sides.iter().all(Option::is_none) {
            return cells.push((Cell::Masks, lo, hi));
        }
        if hi - lo <= MIN_CELL || *halvings == 0 {
            return cells.push((Cell::Open, lo, hi));
        }
        *halvings -= 1;
        let middle = lo + (hi - lo) / 2.0;
        let [lower, upper] = {
            let halves = sides.map(|side| side.map(|side| halved(side, self.powers.bits)).unzip());
            let [(a, b), (c, d)] = halves;
            [[a, c], [b, d]]
        };
        self.visit(upper, (middle, hi), halvings, cells);
        self.visit(lower, (lo, middle), halvings, cells);
    }
}

/// Neighbours of one kind as one.
fn joined(cells: &[(Cell, f64, f64)]) -> Vec<(Cell, f64, f64)> {
    let mut all: Vec<(Cell, f64, f64)> = Vec::new();
    for &(cell, lo, hi) in cells {
        match all.last_mut() {
            Some(last) if last.0 == cell => last.1 = lo,
            _ => all.push((cell, lo, hi)),
        }
    }
    all
}

/// The same polynomial on the lower and the upper half (de Casteljau).
fn halved(mut row: Coefficients, bits: u32) -> (Coefficients, Coefficients) {
    let (mut lower, mut upper) = (Vec::with_capacity(row.len()), Vec::with_capacity(row.len()));
    while let (Some(first), Some(last)) = (row.first(), row.last()) {
        lower.push(first.clone());
        upper.push(last.clone());
        row = row.windows(2).map(|pair| pair[0].add(&pair[1], bits).scale2(-1)).collect();
    }
    upper.reverse();
    (lower, upper)
}
