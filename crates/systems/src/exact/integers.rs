//! The half period over ℚ, in integers: no fraction is ever reduced.
//!
//! Momenta are measured in units that make M⁻¹ integer, and each row carries the power of one denominator f
//! that it still has to be divided by; only a kick raises it.

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use crate::half::compose::{Program, Row, State};
use crate::linear::frame::Frame;
use crate::linear::system::System;
use clocks::schedule::Weight;
use number::Rational;

/// Positive multiples of the blocks of H, and the scale of B and C together.
pub(crate) struct IntegerBlocks {
    pub a: DMatrix<BigInt>,
    pub b: DMatrix<BigInt>,
    pub c: DMatrix<BigInt>,
    pub d: DMatrix<BigInt>,
    /// Bᵀ C of the true blocks is that of these divided by it.
    pub scale: BigInt,
}

/// A program in integers over the denominator f.
pub(crate) struct IntegerProgram {
    program: Program<BigInt>,
    f: BigInt,
}

impl IntegerProgram {
    pub fn new(system: &System) -> Self {
        let rational = Program::new(system);
        let e = denominator(rational.inverse_mass.iter());
        // x' = n (e M⁻¹) (p/e) and p/e loses F/e x: in halves, over f.
        let twice_e = Rational::from_integer(&e * 2);
        let halved = |kicks: &Rational| kicks / &twice_e;
        let f = rational
            .kicks
            .iter()
            .flat_map(|kick| kick.rows.iter().flat_map(|(_, row)| row))
            .fold(BigInt::one(), |lcm, (_, x)| lcm.lcm(halved(x).denom()));
        let scaled = |x: Rational| x.to_integer();
        let mut program = rational.map(|x| scaled(halved(x) * Rational::from_integer(f.clone())));
        let over_e = Rational::from_integer(e);
        program.inverse_mass = rational.map(|x| scaled(x * &over_e)).inverse_mass;
        IntegerProgram { program, f }
    }

    /// The bits of f: how much longer one kick makes the numbers.
    pub fn bits(&self) -> u64 {
        self.f.bits()
    }

    /// Runs the half period in the frame's coordinates.
    pub fn half_period(&self, system: &System, frame: &Frame) -> IntegerBlocks {
        let delta = frame.denominator();
        let mut rows = Rows::start(self, frame, &delta);
        self.program.run(system.schedule().half_period(), &mut rows);
        rows.finish(frame, &delta)
    }
}

fn denominator<'a>(rows: impl Iterator<Item = &'a Row<Rational>>) -> BigInt {
    rows.flatten().fold(BigInt::one(), |lcm, (_, x)| lcm.lcm(x.denom()))
}

/// A row of integers to be divided by f^level.
#[derive(Clone)]
struct Scaled {
    values: Vec<BigInt>,
    level: usize,
}

struct Rows<'a> {
    f: &'a BigInt,
    powers: Vec<BigInt>,
    x: Vec<Scaled>,
    p: Vec<Scaled>,
}

impl<'a> Rows<'a> {
    /// Columns: positions first (unit vectors), then δ times the frame's momenta.
    fn start(program: &'a IntegerProgram, frame: &Frame, delta: &BigInt) -> Self {
        let (n, m) = (program.program.size(), frame.kept.len());
        let zero = Scaled { values: vec![BigInt::zero(); 2 * m], level: 0 };
        let (mut x, mut p) = (vec![zero.clone(); n], vec![zero; n]);
        for k in 0..m {
            x[frame.kept[k]].values[k] = BigInt::one();
            for (i, value) in frame.momentum(k) {
                p[i].values[m + k] = (value * Rational::from_integer(delta.clone())).to_integer();
            }
        }
        Rows { f: &program.f, powers: vec![BigInt::one()], x, p }
    }

    fn power(&mut self, k: usize) -> BigInt {
        while self.powers.len() <= k {
            let next = self.powers.last().expect("not empty") * self.f;
            self.powers.push(next);
        }
        self.powers[k].clone()
    }

    fn raise(&mut self, which: fn(&mut Self) -> &mut Vec<Scaled>, i: usize, level: usize) {
        let by = level - which(self)[i].level;
        if by > 0 {
            let factor = self.power(by);
            let row = &mut which(self)[i];
            row.values.iter_mut().filter(|v| !v.is_zero()).for_each(|v| *v *= &factor);
            row.level = level;
        }
    }

    fn finish(mut self, frame: &Frame, delta: &BigInt) -> IntegerBlocks {
        let level = self.x.iter().chain(&self.p).map(|row| row.level).max().unwrap_or(0);
        for i in 0..self.x.len() {
            self.raise(|rows| &mut rows.x, i, level);
            self.raise(|rows| &mut rows.p, i, level);
        }
        let d = self.power(level);
        let (m, n) = (frame.kept.len(), self.x.len());
        let delta_ratio = Rational::from_integer(delta.clone());
        let x = DMatrix::from_fn(n, 2 * m, |i, j| Rational::from_integer(self.x[i].values[j].clone()));
        let y = frame.project(&x, &delta_ratio).map(|x| x.to_integer());
        let p = DMatrix::from_fn(m, 2 * m, |i, j| self.p[frame.kept[i]].values[j].clone());
        IntegerBlocks {
            a: y.columns(0, m).into_owned(),
            b: y.columns(m, m).into_owned(),
            c: p.columns(0, m).into_owned(),
            d: p.columns(m, m).into_owned(),
            // B was started and projected with δ each.
            scale: &d * &d * delta * delta,
        }
    }
}

impl State<BigInt> for Rows<'_> {
    fn drift(&mut self, program: &Program<BigInt>, island: usize, ticks: u64) {
        if ticks == 0 {
            return;
        }
        for &i in &program.islands[island] {
            let row = &program.inverse_mass[i];
            let level = row.iter().map(|(j, _)| self.p[*j].level).max().unwrap_or(0).max(self.x[i].level);
            self.raise(|rows| &mut rows.x, i, level);
            for (j, a) in row {
                let factor = a * ticks * self.power(level - self.p[*j].level);
                add(&mut self.x[i].values, &factor, &self.p[*j].values);
            }
        }
    }

    fn kick(&mut self, i: usize, row: &Row<BigInt>, weight: Weight) {
        let lowest = row.iter().map(|(j, _)| self.x[*j].level + 1).max().unwrap_or(0);
        let level = lowest.max(self.p[i].level);
        self.raise(|rows| &mut rows.p, i, level);
        for (j, a) in row {
            let halves = if weight == Weight::Full { -2 } else { -1 };
            let factor = a * halves * self.power(level - self.x[*j].level - 1);
            add(&mut self.p[i].values, &factor, &self.x[*j].values);
        }
    }
}

fn add(row: &mut [BigInt], factor: &BigInt, other: &[BigInt]) {
    for (x, y) in row.iter_mut().zip(other).filter(|(_, y)| !y.is_zero()) {
        *x += factor * y;
    }
}

impl IntegerBlocks {
    /// Bᵀ C times [`IntegerBlocks::scale`].
    pub fn product(&self) -> DMatrix<BigInt> {
        product(&self.b.transpose(), &self.c)
    }
}

/// a b.
fn product(a: &DMatrix<BigInt>, b: &DMatrix<BigInt>) -> DMatrix<BigInt> {
    let entry = |i: usize, j: usize| (0..a.ncols()).map(|k| &a[(i, k)] * &b[(k, j)]).sum();
    DMatrix::from_fn(a.nrows(), b.ncols(), entry)
}
