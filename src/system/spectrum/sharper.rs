//! Eigenvalues close to an edge or to each other: their own residuals decide where the discs of all are too wide.
//!
//! In V⁻¹ S V = D + F the rows of F carry the error of the whole half period. A column carries that of one vector alone:
//!
//! ```text
//!     F e_i = V⁻¹ (S v_i − μ_i v_i),      |F e_i| ≤ c_i = |V⁻¹| |S v_i − μ_i v_i|,
//! ```
//!
//! and S v_i = (Q v_i − v_i)/2 in positions is one run of a full period in balls. Let J be the real μ_i that are undecided, c² = Σ c_i² over them, and T = 1/τ
//! at these and 1 elsewhere: T D = D T, and the rows of T⁻¹ F T are ρ_i' ≤ τ ρ_i + c in J and ρ_j' ≤ ρ_j + c/τ elsewhere. So **a small τ narrows the discs
//! of J to about c**, and widens the others by c/τ.

use num_traits::Zero;

use super::discs::Spectrum;
use crate::number::rational::from_f64_exact;
use crate::number::{Enclosed, Ring, U};
use crate::system::half::compose::{Columns, Program};
use crate::system::linear::system::System;
use crate::verdict::Kind;

/// The most eigenvalues that are looked at one by one.
const MOST: usize = 24;

/// Of the balls: a period of some thousand kicks takes some dozen of these.
const BITS: u32 = 192;

type Fixed = Enclosed<BITS>;

/// The τ that are tried.
const WEIGHTS: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

impl Spectrum {
    /// The kind that the discs prove once the undecided ones are narrowed, if any; `scales` are those of the half period's positions, of a system
    /// without rigid modes.
    pub fn sharper(&self, system: &System, scales: &[f64]) -> Option<Kind> {
        let open = self.untold()?;
        if open.len() > MOST || open.iter().any(|&i| self.mu[i].im != 0.0) {
            return None;
        }
        let columns = self.columns(&open, system, scales)?;
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

    /// c_i of some real μ_i, by one period of their vectors side by side.
    fn columns(&self, open: &[usize], system: &System, scales: &[f64]) -> Option<Vec<f64>> {
        let exact = |x: f64| from_f64_exact(x).map(|x| Fixed::from_rational(&x));
        // Scales are powers of two.
        let row = |(k, a): (usize, &f64)| {
            open.iter().map(|&i| exact(self.vectors[(k, i)].re / a)).collect::<Option<Vec<_>>>()
        };
        let start: Vec<_> = scales.iter().enumerate().map(row).collect::<Option<_>>()?;
        let mu: Vec<_> = open.iter().map(|&i| exact(self.mu[i].re)).collect::<Option<_>>()?;
        let mut run = Columns { x: start.clone(), p: vec![vec![Fixed::zero(); open.len()]; start.len()] };
        let program = Program::new(system).map(Fixed::from_rational);
        program.run(system.schedule().symmetric_period(), &mut run);
        let mut squares = vec![0.0; open.len()];
        for ((after, before), a) in run.x.iter().zip(&start).zip(scales) {
            for (k, square) in squares.iter_mut().enumerate() {
                let s = after[k].0.sub(&before[k].0, BITS).scale2(-1);
                let (lo, hi) = s.sub(&mu[k].0.mul(&before[k].0, BITS), BITS).to_f64_enclosure();
                *square += (a * lo.abs().max(hi.abs())).powi(2);
            }
        }
        // Some roundings of each term, and of their sum.
        let factor = 1.01 * self.inverse? * (1.0 + (scales.len() as f64 + 8.0) * U);
        let column = |square: f64| Some(factor * square.sqrt()).filter(|c| c.is_finite());
        squares.into_iter().map(column).collect()
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
        let mut proven = [0, 0];
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
                    proven[usize::from(kind == Kind::Elliptic)] += 1;
                }
            }
        }
        assert!(proven[0] > 0 && proven[1] > 20, "{proven:?}");
    }
}
