//! The period as a polynomial in the factor of friction.
//!
//! With c = exp(−γ t), t the longest time that divides every drift, a drift of n of these multiplies
//! velocities by cⁿ. So the entries of the period Q are polynomials in c. Every c in (0, 1) belongs to one
//! friction, c = 0 to velocities that each drift stops.

use num_integer::Integer;
use num_traits::One;

use crate::half::compose::{Program, Row};
use crate::linear::system::System;
use clocks::schedule::{Event, Weight};
use number::{Ball, Rational, from_f64_exact};

/// Products of balls, of some 250 bits as stiffnesses are rounded: about a second.
const MAX_PRODUCTS: u64 = 6_000_000;

/// Stiffnesses may be rounded so far, relative to them (2^-197 or more: `near` in `matrices`): some 60 kicks
/// have been seen to enlarge it 10^25 times.
const REL_ROUNDING: f64 = 4e-60;

pub(super) type Coefficients = Vec<Ball>;

/// The period by powers of c.
pub(super) struct Powers {
    /// The columns of Q, rows of positions before those of momenta.
    pub columns: Vec<Vec<Coefficients>>,
    /// The degree in c.
    pub degree: usize,
    pub bits: u32,
    /// The time t of c = exp(−γ t).
    tick: Rational,
}

impl Powers {
    /// `None` for periods that are too long.
    pub fn new(system: &System) -> Option<Powers> {
        let (schedule, n) = (system.schedule(), system.size());
        // Velocities stop by one factor for the ticks that divide every drift.
        let unit = schedule.symmetric_period().fold(0, |unit, event| event.drift.gcd(&unit)).max(1);
        let steps = schedule.period() / unit;
        let (size, terms) = (n as u64, steps.saturating_add(1));
        // Every kick on all columns, and all entries from one basis to another.
        let products = schedule.strikes().saturating_mul(size.pow(3)).saturating_add(size.pow(2) * terms);
        if products.saturating_mul(2 * terms) > MAX_PRODUCTS {
            return None;
        }
        let (degree, bits) = (steps as usize, 160 + 4 * steps as u32);
        let factors = Factors::new(system, bits);
        let entry = |is_one: bool| -> Coefficients {
            let first = if is_one { Ball::one() } else { Ball::zero() };
            std::iter::once(first).chain((0..degree).map(|_| Ball::zero())).collect()
        };
        let mut columns: Vec<Vec<_>> =
            (0..2 * n).map(|j| (0..2 * n).map(|i| entry(i == j)).collect()).collect();
        for event in schedule.symmetric_period() {
            let by = (event.drift / unit) as usize;
            columns.iter_mut().for_each(|column| factors.apply(&event, column, |own| shifted(own, by)));
        }
        let tick = system.tick() * Rational::from_integer(unit.into());
        Some(Powers { columns, degree, bits, tick })
    }

    /// No less than c at a friction, exact.
    pub fn top(&self, rate: f64) -> Option<Ball> {
        let exponent = Ball::from_rational(&(from_f64_exact(rate)? * &self.tick), self.bits).neg();
        let top = exponent.exp(self.bits).upper().min(Rational::one());
        Some(Ball::from_rational(&top, self.bits))
    }

    /// The friction whose c is this share of the top one.
    pub fn rate(&self, share: f64, top: &Ball) -> Option<(f64, f64)> {
        if share == 0.0 {
            return Some((f64::INFINITY, f64::INFINITY));
        }
        let c = Ball::from_rational(&from_f64_exact(share)?, self.bits).mul(top, self.bits);
        let tick = Ball::from_rational(&self.tick, self.bits);
        Some(c.ln(self.bits)?.neg().div(&tick, self.bits)?.to_f64_enclosure())
    }
}

/// The drifts and kicks of a period.
pub(super) struct Factors {
    inverse_mass: Vec<Row<Ball>>,
    kicks: Vec<Vec<(usize, Row<Ball>)>>,
    bits: u32,
}

impl Factors {
    pub fn new(system: &System, bits: u32) -> Factors {
        let program = Program::new(system);
        let rounded = Ball::one().add(&Ball::about_zero(REL_ROUNDING), bits);
        let row = |row: &Row<Rational>, factor: &Ball| -> Row<Ball> {
            row.iter().map(|(j, x)| (*j, Ball::from_rational(x, bits).mul(factor, bits))).collect()
        };
        let kick = |rows: &Vec<(usize, Row<Rational>)>| -> Vec<_> {
            rows.iter().map(|(i, own)| (*i, row(own, &rounded))).collect()
        };
        let inverse_mass = program.inverse_mass.iter().map(|own| row(own, &Ball::one())).collect();
        let kicks = program.kicks.iter().map(|own| kick(&own.rows)).collect();
        Factors { inverse_mass, kicks, bits }
    }

    /// x ← x + t (1 + cⁿ)/2 M⁻¹ v, v ← cⁿ v, `stop` being the product with cⁿ, and the kicks behind it.
    pub fn apply(
        &self,
        event: &Event,
        column: &mut [Coefficients],
        stop: impl Fn(&Coefficients) -> Coefficients,
    ) {
        let bits = self.bits;
        let (x, v) = column.split_at_mut(self.inverse_mass.len());
        let half = Ball::from_integer(&event.drift.into()).scale2(-1);
        let stopped: Vec<_> = v.iter().map(stop).collect();
        let both: Vec<_> = v.iter().zip(&stopped).map(|(a, b)| combined(a, b, &Ball::one(), bits)).collect();
        for (x, row) in x.iter_mut().zip(&self.inverse_mass) {
            for (j, w) in row {
                *x = combined(x, &both[*j], &w.mul(&half, bits), bits);
            }
        }
        v.clone_from_slice(&stopped);
        for (i, row) in event.clocks().flat_map(|clock| &self.kicks[clock]) {
            for (j, f) in row {
                let f = if event.weight == Weight::Half { f.scale2(-1) } else { f.clone() };
                v[*i] = combined(&v[*i], &x[*j], &f.neg(), bits);
            }
        }
    }
}

/// a + factor b.
pub(super) fn combined(a: &Coefficients, b: &Coefficients, factor: &Ball, bits: u32) -> Coefficients {
    a.iter().zip(b).map(|(a, b)| a.add(&b.mul(factor, bits), bits)).collect()
}

/// Times a power of c.
fn shifted(a: &Coefficients, by: usize) -> Coefficients {
    (0..a.len()).map(|i| i.checked_sub(by).map_or_else(Ball::zero, |i| a[i].clone())).collect()
}

/// Σ aᵢ cⁱ on 0 ≤ c ≤ `top` in the basis of Bernstein: its differences are aᵢ topⁱ/C(n, i).
pub(super) fn bernstein(powers: &Coefficients, top: &Ball, bits: u32) -> Coefficients {
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

/// What rows of positions and of momenta are multiplied by, and columns divided, where positions are taken
/// times a, momenta divided by it.
pub(super) fn of_rows(scales: &[f64]) -> Vec<f64> {
    scales.iter().copied().chain(scales.iter().map(|a| 1.0 / a)).collect()
}
