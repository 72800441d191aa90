//! Single eigenvalues beside an edge or a neighbour, told by their own residuals where the discs of all are too wide.
//!
//! In V⁻¹ S V = D + F the rows of F carry the error of the whole half period. A column carries that of one vector alone:
//!
//! ```text
//!     F e_i = V⁻¹ (S v_i − μ_i v_i),      |F e_i| ≤ c_i = |V⁻¹| |S v_i − μ_i v_i|,
//! ```
//!
//! and S v_i = (Q v_i − v_i)/2 in positions is one run of a full period in balls. Let J be the real μ_i that are not told, c² = Σ c_i² over them, and T = 1/τ
//! at these and 1 elsewhere: T D = D T, and the rows of T⁻¹ F T are ρ_i' ≤ τ ρ_i + c in J and ρ_j' ≤ ρ_j + c/τ elsewhere. So **a small τ narrows the discs
//! of J to about c**, and widens the others by c/τ.

use super::discs::Spectrum;
use crate::number::rational::from_f64_exact;
use crate::number::{Ball, Rational, U};
use crate::schedule::Weight;
use crate::system::half::compose::{Program, Row, State};
use crate::system::linear::system::System;
use crate::verdict::Kind;

/// The most eigenvalues that are looked at one by one.
const MOST: usize = 24;

/// Of the balls: a period of some thousand kicks takes some dozen of these.
const BITS: u32 = 192;

/// The τ that are tried.
const WEIGHTS: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

impl Spectrum {
    /// What the discs prove where those that tell nothing are narrowed, if anything; `scales` are those of the half period's positions, of a system without
    /// rigid modes.
    pub fn sharper(&self, system: &System, scales: &[f64]) -> Option<Kind> {
        let open = self.untold()?;
        if open.len() > MOST || open.iter().any(|&i| self.mu[i].im != 0.0) {
            return None;
        }
        let program = Program::new(system).map(|x| Ball::from_rational(x, BITS));
        let columns = open.iter().map(|&i| self.column(i, &program, system, scales));
        let columns = columns.collect::<Option<Vec<f64>>>()?;
        let column = columns.into_iter().fold(0.0, f64::hypot);
        let narrowed = WEIGHTS.map(|weight| self.narrowed(&open, column, weight));
        for i in open {
            if narrowed.iter().any(|rows| self.is_encircled(i, rows)) {
                return Some(Kind::Hyperbolic);
            }
            if !narrowed.iter().any(|rows| self.is_alone(i, rows)) {
                return None;
            }
        }
        Some(Kind::Elliptic)
    }

    /// c_i of a real μ_i.
    fn column(&self, i: usize, program: &Program<Ball>, system: &System, scales: &[f64]) -> Option<f64> {
        let exact = |x: f64| from_f64_exact(x).map(|x| Ball::from_rational(&x, BITS));
        let own: Vec<f64> = (0..self.mu.len()).map(|k| self.vectors[(k, i)].re).collect();
        // Scales are powers of two.
        let start: Vec<Ball> = own.iter().zip(scales).map(|(v, a)| exact(v / a)).collect::<Option<_>>()?;
        let mut run = Column { x: start.clone(), p: vec![Ball::zero(); start.len()] };
        program.run(system.schedule().symmetric_period(), &mut run);
        let mu = exact(self.mu[i].re)?;
        let square = run.x.iter().zip(&start).zip(scales).try_fold(0.0, |sum, ((after, before), a)| {
            let s = after.sub(before, BITS).scale2(-1);
            let (lo, hi) = s.sub(&mu.mul(before, BITS), BITS).to_f64_enclosure();
            Some(sum + (a * lo.abs().max(hi.abs())).powi(2)).filter(|sum: &f64| sum.is_finite())
        })?;
        // Some roundings of each term, and of their sum.
        let rounding = (own.len() as f64 + 8.0) * U;
        Some(1.01 * self.inverse? * square.sqrt() * (1.0 + rounding)).filter(|c| c.is_finite())
    }
}

/// Positions and momenta in balls.
struct Column {
    x: Vec<Ball>,
    p: Vec<Ball>,
}

impl State<Ball> for Column {
    fn drift(&mut self, program: &Program<Ball>, island: usize, ticks: u64) {
        if ticks == 0 {
            return;
        }
        let ticks = Ball::from_rational(&Rational::from_integer(ticks.into()), BITS);
        for &i in &program.islands[island] {
            for (j, a) in &program.inverse_mass[i] {
                let moved = ticks.mul(a, BITS).mul(&self.p[*j], BITS);
                self.x[i] = self.x[i].add(&moved, BITS);
            }
        }
    }

    fn kick(&mut self, i: usize, row: &Row<Ball>, weight: Weight) {
        let halvings = if weight == Weight::Full { 0 } else { -1 };
        for (j, a) in row {
            let kick = a.mul(&self.x[*j], BITS).scale2(halvings);
            self.p[i] = self.p[i].sub(&kick, BITS);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::rational::ratio;
    use crate::system::builders::alternating_chain;
    use crate::system::exact::decide::decide_exact;
    use crate::system::half::float;
    use crate::system::linear::frame::Frame;
    use crate::system::verdict::limits::Limits;

    #[test]
    fn what_wide_discs_leave_open_is_told_as_exact_arithmetic_does() {
        let mut told = [0, 0];
        for n in 2..7 {
            for k in 1..24 {
                let steps = [&ratio(k, 40), &ratio(k, 20)];
                let system = alternating_chain(n, [&ratio(10, 1), &ratio(1, 1)], steps).unwrap();
                let frame = Frame::whole(n);
                let blocks = float::half_period(&system, &frame);
                // As if the half period were known to so little.
                for error in [1e-2, 1e-4] {
                    let wide = Spectrum::new(&blocks).and_then(|own| own.with_error(error)).unwrap();
                    if wide.by_discs().is_some() {
                        continue;
                    }
                    let Some(kind) = wide.sharper(&system, &blocks.scales) else { continue };
                    assert_eq!(kind, decide_exact(&system, &Limits::default()).unwrap().kind, "{n} {k}");
                    told[usize::from(kind == Kind::Elliptic)] += 1;
                }
            }
        }
        assert!(told[0] > 0 && told[1] > 20, "{told:?}");
    }
}
