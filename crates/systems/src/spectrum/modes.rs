//! Unstable multipliers explained: which normal modes, how fast, near which resonance.
//!
//! The normal modes are those of the continuous system M x'' + Σ K_k x = 0. A real pair of multipliers is one
//! mode w in resonance with itself, 2 w = 2π m/T; a quadruple is the collision of two modes, w_i ± w_j = 2π
//! m/T. Every Σ a_k/h_k is such an m/T, m = Σ a_k T/h_k. Where the total stiffness is positive definite only
//! sums destabilize to first order (Krein: multipliers of one sign of energy meet without leaving the
//! circle), and only these are named.

use std::f64::consts::PI;

use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, Side, c64};

use crate::half::compose::rounded_inverse_mass;
use crate::linear::frame::Frame;
use crate::linear::system::System;
use crate::single::clocks::shortest_family;
use number::{named, to_f64};

named! {
    /// How an unstable multiplier left the unit circle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Origin {
        /// λ real: one mode against itself.
        RealPair = "real pair",
        /// λ, 1/λ and their conjugates: two modes collided.
        Collision = "collision",
    }
}

/// The resonance next to an unstable multiplier: w_i ± w_j ≈ 2π Σ a_k/h_k.
#[derive(Clone, Debug, PartialEq)]
pub struct Resonance {
    /// The frequencies w_i, w_j of the modes most present in the shape (equal for a real pair), per unit
    /// time.
    pub frequencies: (f64, f64),
    /// 1 for w_i + w_j, −1 for w_i − w_j.
    pub sign: i8,
    /// (w_i ± w_j) T/2π is near this integer: half turns in a period for a real pair.
    pub m: i64,
    /// m = Σ a_k T/h_k with the least Σ |a_k|; empty where no such family was found.
    pub family: Vec<i64>,
    /// (w_i ± w_j) T/2π − m.
    pub detuning: f64,
}

/// The normal modes of a system without its rigid modes.
pub(crate) struct NormalModes {
    /// Frequencies, imaginary ones (of an indefinite stiffness) as 0.
    frequencies: Vec<f64>,
    /// Maps coordinates y to mode amplitudes.
    inverse: Mat<f64>,
}

/// Roughly the lowest and the highest frequency; `None` where the stiffness is not positive definite.
///
/// Highest by Gershgorin's rows of M⁻¹ K, lowest by a few steps of inverse iteration.
pub(crate) fn frequency_range(system: &System, frame: &Frame) -> Option<(f64, f64)> {
    let (m, stiffness) = (frame.kept.len(), kept_stiffness(system, frame));
    let diagonal = system.mass().rounded_diagonal();
    let masses: Vec<f64> = frame.kept.iter().map(|&i| diagonal[i]).collect();
    let row = |a: usize| (0..m).map(|b| stiffness[(a, b)].abs()).sum::<f64>() / masses[a];
    let highest = (0..m).map(row).fold(0.0, f64::max).sqrt();
    let factor = stiffness.llt(Side::Lower).ok()?;
    // x ← K⁻¹ M x grows by 1/w² of the lowest mode.
    let mut x = Mat::from_fn(m, 1, |_, _| 1.0);
    let mut growth = 0.0;
    for _ in 0..4 {
        let image = factor.solve(Mat::from_fn(m, 1, |a, _| masses[a] * x[(a, 0)]));
        growth = (0..m).map(|a| image[(a, 0)].abs()).fold(0.0, f64::max);
        x = Mat::from_fn(m, 1, |a, _| image[(a, 0)] / growth);
    }
    Some((growth.sqrt().recip(), highest))
}

/// Σ K_k in the frame's coordinates, rounded.
fn kept_stiffness(system: &System, frame: &Frame) -> Mat<f64> {
    let (m, total) = (frame.kept.len(), system.rounded_total());
    Mat::from_fn(m, m, |a, b| total[(frame.kept[a], frame.kept[b])])
}

/// G and Gᵀ K G: with P = (I, −N), y'' = −P M⁻¹ Pᵀ K y; let P M⁻¹ Pᵀ = G Gᵀ and y = G u, then u'' = −Gᵀ K G
/// u.
fn symmetric_form(system: &System, frame: &Frame) -> Option<(Mat<f64>, Mat<f64>)> {
    let (n, m) = (system.size(), frame.kept.len());
    let mut projection = Mat::<f64>::zeros(m, n);
    for (a, &i) in frame.kept.iter().enumerate() {
        projection[(a, i)] = 1.0;
        frame.rigid.iter().for_each(|(index, n)| projection[(a, *index)] = -to_f64(&n[i]));
    }
    let reduced = &projection * rounded_inverse_mass(system) * projection.transpose();
    let stiffness = kept_stiffness(system, frame);
    let g = reduced.llt(Side::Lower).ok()?.L().to_owned();
    let symmetric = g.transpose() * &stiffness * &g;
    Some((g, symmetric))
}

impl NormalModes {
    /// In the frame's coordinates; `None` where an iteration of the eigenvalue solver fails.
    pub fn new(system: &System, frame: &Frame) -> Option<NormalModes> {
        let (g, symmetric) = symmetric_form(system, frame)?;
        let eigen = symmetric.self_adjoint_eigen(Side::Lower).ok()?;
        let frequencies = (0..symmetric.nrows()).map(|i| eigen.S()[i].max(0.0).sqrt()).collect();
        let inverse_g = g.partial_piv_lu().inverse();
        Some(NormalModes { frequencies, inverse: eigen.U().transpose() * inverse_g })
    }

    /// The resonance of the multiplier exp(z), the modes being those of the largest |amplitude| in `shape`.
    pub fn resonance(&self, system: &System, shape: &[c64], origin: Origin, z: c64) -> Resonance {
        let m = shape.len();
        let amplitude = |i: usize| (0..m).map(|j| shape[j] * self.inverse[(i, j)]).sum::<c64>().norm();
        let mut order: Vec<(f64, usize)> = (0..m).map(|i| (amplitude(i), i)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let period = to_f64(&system.period());
        let turns = |w: f64| w * period / (2.0 * PI);
        let first = self.frequencies[order[0].1];
        let strikes: Vec<u64> = (0..system.clocks().len()).map(|k| system.strikes(k)).collect();
        let (frequencies, sign, m, turns) = match (origin, order.get(1)) {
            (Origin::Collision, Some(&(_, j))) => {
                let second = self.frequencies[j];
                let (sum, difference) = (turns(first + second), turns(first - second));
                let off = |x: f64| (x - x.round()).abs();
                // Modes of positive energy have one sign of Krein's: their differences pass without harm.
                let definite = self.frequencies.iter().all(|&w| w > 0.0);
                let (sign, x) =
                    if definite || off(sum) <= off(difference) { (1, sum) } else { (-1, difference) };
                ((first, second), sign, x.round(), x)
            }
            _ => {
                // An even m where λ > 0, an odd one where λ < 0.
                let odd = f64::from(u8::from(z.im.abs() > PI / 2.0));
                let x = turns(2.0 * first);
                ((first, first), 1, (2.0 * ((x - odd) / 2.0).round() + odd).max(odd), x)
            }
        };
        let m_integer = m as i64;
        let family = shortest_family(m_integer, &strikes).unwrap_or_default();
        Resonance { frequencies, sign, m: m_integer, family, detuning: turns - m }
    }
}
