//! One oscillator at all frictions at once.
//!
//! With c = exp(−γ t), t the longest time that divides every drift, a drift of n of these multiplies velocities by cⁿ. So the entries of the period Q are polynomials in c, det Q = c^N over N of them,
//! and a friction masks iff f₋ = 1 + c^N − Tr Q and f₊ = 1 + c^N + Tr Q are positive (Jury), something grows iff one is negative. Every c in (0, 1) belongs to one friction,
//! c = 0 to velocities that each drift stops. In the basis of Bernstein on a cell of c a polynomial lies between its least and its largest coefficient: cells are
//! halved until these have one sign (proofs/FRICTION.md).

use num_integer::Integer;
use num_traits::One;

use super::masking::Mask;
use crate::half::compose::Program;
use crate::linear::system::System;
use clocks::schedule::Weight;
use number::rational::from_f64_exact;
use number::{Ball, Rational, Sign};

/// The degree in c: to halve a cell costs its square, some milliseconds at this.
const MAX_STEPS: u64 = 128;

/// Sums of balls that halving may cost in all: about a second, and some six edges to the width of [`MIN_CELL`] at the largest degree.
const MAX_SUMS: usize = 5_000_000;

/// Cells that are halved in all.
const MAX_HALVINGS: usize = 1500;

/// The width of a cell that is not halved, relative to all of them.
const MIN_CELL: f64 = 1.0 / (1_u64 << 48) as f64;

/// Stiffnesses may be rounded so far, relative to them (2^-98 or more: `near` in `matrices`).
const REL_ROUNDING: f64 = 4e-30;

type Coefficients = Vec<Ball>;

/// f₋ and f₊ by powers of c.
pub(super) struct Polynomials {
    sides: [Coefficients; 2],
    /// The time t of c = exp(−γ t).
    tick: Rational,
    bits: u32,
}

/// What a cell of c holds.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Masks,
    Grows,
    Open,
}

impl Polynomials {
    /// `None` for more than one degree of freedom, and for periods that are too long.
    pub fn new(system: &System) -> Option<Polynomials> {
        let schedule = system.schedule();
        // Velocities stop by one factor for the ticks that divide every drift.
        let unit = schedule.symmetric_period().fold(0, |unit, event| event.drift.gcd(&unit)).max(1);
        let steps = schedule.period() / unit;
        if system.size() != 1 || steps > MAX_STEPS {
            return None;
        }
        let (n, bits) = (steps as usize, 160 + 4 * steps as u32);
        let ball = |x: &Rational| Ball::from_rational(x, bits);
        let program = Program::new(system);
        let inverse_mass = ball(&program.inverse_mass[0][0].1);
        let rounded = Ball::one().add(&Ball::about_zero(REL_ROUNDING), bits);
        let kicks: Vec<Ball> = program
            .kicks
            .iter()
            .map(|kick| {
                kick.rows.first().map_or_else(Ball::zero, |(_, row)| ball(&row[0].1).mul(&rounded, bits))
            })
            .collect();
        let combine = |a: &Coefficients, b: &Coefficients, factor: &Ball| -> Coefficients {
            a.iter().zip(b).map(|(a, b)| a.add(&b.mul(factor, bits), bits)).collect()
        };
        let shifted = |a: &Coefficients, by: usize| -> Coefficients {
            (0..a.len()).map(|i| i.checked_sub(by).map_or_else(Ball::zero, |i| a[i].clone())).collect()
        };
        let constant = |is_one: bool| {
            let mut all = vec![Ball::zero(); n + 1];
            if is_one {
                all[0] = Ball::one();
            }
            all
        };
        let mut columns = [[constant(true), constant(false)], [constant(false), constant(true)]];
        for event in schedule.symmetric_period() {
            let half = inverse_mass.mul(&Ball::from_integer(&event.drift.into()), bits).scale2(-1);
            let full = event.clocks().fold(Ball::zero(), |sum, k| sum.add(&kicks[k], bits));
            let kick = if event.weight == Weight::Half { full.scale2(-1) } else { full }.neg();
            for [x, v] in &mut columns {
                let stopped = shifted(v, (event.drift / unit) as usize);
                *x = combine(&combine(x, v, &half), &stopped, &half);
                *v = combine(&stopped, x, &kick);
            }
        }
        let trace = combine(&columns[0][0], &columns[1][1], &Ball::one());
        let mut sums = constant(true);
        sums[n] = sums[n].add(&Ball::one(), bits);
        let sides = [Ball::one().neg(), Ball::one()].map(|sign| combine(&sums, &trace, &sign));
        let tick = system.tick() * Rational::from_integer(unit.into());
        Some(Polynomials { sides, tick, bits })
    }

    /// The frictions that mask, above one at which something grows; 0: without any.
    pub fn above(&self, grows: f64) -> Option<Mask> {
        let from = from_f64_exact(grows)? * &self.tick;
        let top = Ball::from_rational(&from, self.bits).neg().exp(self.bits).upper().min(Rational::one());
        let top = Ball::from_rational(&top, self.bits);
        let mut halvings = MAX_HALVINGS.min(MAX_SUMS / self.sides[0].len().pow(2));
        let mut cells = Vec::new();
        let sides = self.sides.each_ref().map(|side| Some(bernstein(side, &top, self.bits)));
        self.visit(sides, (0.0, 1.0), &mut halvings, &mut cells);
        let rate = |share: f64| {
            let share = Ball::from_rational(&from_f64_exact(share)?, self.bits).mul(&top, self.bits);
            Some(
                share
                    .ln(self.bits)?
                    .neg()
                    .div(&Ball::from_rational(&self.tick, self.bits), self.bits)?
                    .to_f64_enclosure(),
            )
        };
        let (mut least, mut ranges) = (grows, Vec::new());
        for (cell, lo, hi) in joined(&cells) {
            match cell {
                Cell::Masks => {
                    let end = if lo == 0.0 { f64::INFINITY } else { rate(lo)?.0 };
                    ranges.push((rate(hi)?.1, end));
                }
                Cell::Grows if ranges.is_empty() => least = rate(lo)?.0.max(grows),
                _ => {}
            }
        }
        ranges.retain(|(lo, hi)| lo <= hi);
        Some(Mask::found(least, ranges))
    }

    /// The cells from `lo` to `hi`, the last one first; `None` in place of a polynomial that is positive there.
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
            let halves = sides.map(|side| side.map(|side| halved(side, self.bits)).unzip());
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

/// Σ aᵢ cⁱ on 0 ≤ c ≤ `top` in the basis of Bernstein: its differences are aᵢ topⁱ/C(n, i).
fn bernstein(powers: &Coefficients, top: &Ball, bits: u32) -> Coefficients {
    let n = powers.len() - 1;
    let (mut all, mut factor) = (Vec::with_capacity(n + 1), Ball::one());
    for (i, a) in powers.iter().enumerate() {
        all.push(a.mul(&factor, bits));
        // C(n, i + 1) = C(n, i) (n − i)/(i + 1).
        let ratio = Rational::new((i as u64 + 1).into(), (n as u64 - i as u64).max(1).into());
        factor = factor.mul(top, bits).mul(&Ball::from_rational(&ratio, bits), bits);
    }
    for level in (1..=n).rev() {
        for j in level..=n {
            all[j] = all[j].add(&all[j - 1], bits);
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
