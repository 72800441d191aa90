//! A period for all frictions of a range at once.
//!
//! With c = exp(−γ t) within r of its middle, every drift and the kick behind it are M + Δ, ‖Δ‖ ≤ δ = r ‖dM/dc‖. Let C_ij be the computed products
//! M_j ... M_i, each within κ_j ‖C‖ of M_j times the one before, g ≥ ‖C_ij‖ for all of them, and D = Σ (δ_j + κ_j). The true products T_ij obey
//!
//! ```text
//!     T_ij − C_ij = Σ_l T_(l+1)j (Δ_l C_i(l−1) − ρ_l),     ‖T_ij‖ ≤ G = g/(1 − g D) for g D < 1,
//! ```
//!
//! and ‖T_(l+1)N‖ ≤ ‖C_(l+1)N‖ + G g Σ_(m>l) (δ_m + κ_m) bounds the period's error by Σ_l ‖T_(l+1)N‖ (δ_l + κ_l) ‖C_1(l−1)‖ (proofs/FRICTION.md). The range may have no
//! end: c = 0 there.

use std::collections::BTreeMap;

use faer::Mat;

use super::damping::Damping;
use super::radius::{Radius, damping};
use crate::half::compose::Program;
use crate::half::float::scaled_program;
use crate::half::norm;
use crate::half::period::decayed;
use crate::linear::frame::Frame;
use crate::linear::system::System;
use number::{Ball, Rational, U};

/// Products of doubles that one range may cost: some milliseconds.
const MOST: f64 = 3e6;

/// What a product of small matrices costs beside its products.
const OVERHEAD: f64 = 200.0;

const BITS: u32 = 128;

/// The factors of a period, scaled.
pub(super) struct Ranged {
    inverse_mass: Mat<f64>,
    /// The ticks of each drift, the kick behind it, and a bound on the sizes that its entries are sums of.
    factors: Vec<(u64, Mat<f64>, f64)>,
    tick: Rational,
    period: u64,
}

/// The period in the middle of a range, and a bound on the distance (2-norm) of all others from it.
pub(super) struct Around {
    pub q: Mat<f64>,
    pub error: f64,
    /// The determinants.
    det: Ball,
}

impl Ranged {
    /// `None` where a range would cost too much, or numbers are beyond doubles.
    pub fn new(system: &System) -> Option<Ranged> {
        let (n, kicks) = (system.size(), system.schedule().strikes() as f64);
        if kicks.powi(2) * (4.0 * (n as f64).powi(3) + OVERHEAD) > MOST {
            return None;
        }
        let (program, _) = scaled_program(system, &Frame::whole(n));
        if !program.entries().all(|x| *x == 0.0 || x.abs() > 1e-290 && x.is_finite()) {
            return None;
        }
        let mut inverse_mass = Mat::zeros(n, n);
        for (i, row) in program.inverse_mass.iter().enumerate() {
            row.iter().for_each(|(j, x)| inverse_mass[(i, *j)] = *x);
        }
        let factors = system.schedule().symmetric_period().map(|event| {
            let (kick, size) = kick(&program, n, event.clocks(), event.weight.share());
            (event.drift, kick, size)
        });
        let (factors, period) = (factors.collect(), system.schedule().period());
        Some(Ranged { inverse_mass, factors, tick: system.tick().clone(), period })
    }

    fn size(&self) -> usize {
        self.inverse_mass.nrows()
    }

    /// Where the spectral radius lies at all frictions from `lo` to `hi`, without an end where that is `None`; `None`: not told.
    pub fn damping(&self, lo: &Rational, hi: Option<&Rational>) -> Option<Damping> {
        let own = self.around(lo, hi)?;
        if self.size() > 1 {
            return damping(&own.q, own.error, Radius::of(&own.q, own.error));
        }
        // Jury: |Tr| against 1 + det.
        let (trace, sum) = (own.trace()?, Ball::from_integer(&1.into()).add(&own.det, BITS));
        let sides = [sum.sub(&trace, BITS), sum.add(&trace, BITS)].map(|x| x.to_f64_enclosure());
        if sides.iter().all(|(lo, _)| *lo > 0.0) {
            return Some(Damping::Damped);
        }
        sides.iter().any(|(_, hi)| *hi < 0.0).then_some(Damping::Growing)
    }

    /// `None` where the bound's condition fails.
    pub fn around(&self, lo: &Rational, hi: Option<&Rational>) -> Option<Around> {
        let (n, count) = (self.size(), self.factors.len());
        let mut decays: BTreeMap<u64, [f64; 2]> = BTreeMap::new();
        let (mut matrices, mut sizes, mut offs) = (Vec::new(), Vec::new(), Vec::new());
        for (ticks, kick, size) in &self.factors {
            let decay = *decays.entry(*ticks).or_insert_with(|| self.decay(*ticks, lo, hi));
            let (matrix, off) = self.factor(*ticks as f64, kick, *size, decay);
            sizes.push(norm::frobenius(&matrix));
            matrices.push(matrix);
            offs.push(off);
        }
        let rounding = 1.01 * (2 * n + 2) as f64 * U;
        let all: Vec<f64> =
            offs.iter().zip(&sizes).map(|(off, size)| 1.01 * (off + rounding * size)).collect();
        let (mut largest, mut before, mut behind) = (1.0_f64, Vec::new(), vec![1.0; count + 1]);
        let mut q = Mat::<f64>::identity(2 * n, 2 * n);
        for i in 0..count {
            let mut product = Mat::<f64>::identity(2 * n, 2 * n);
            for matrix in &matrices[i..] {
                let next = matrix * &product;
                if i == 0 {
                    before.push(norm::spectral(&product).max(1.0));
                }
                product = next;
                largest = largest.max(norm::spectral(&product));
            }
            behind[i] = norm::spectral(&product);
            if i == 0 {
                q = product;
            }
        }
        let sum: f64 = all.iter().sum();
        let condition = 1.01 * largest * sum;
        if condition.is_nan() || condition >= 0.5 {
            return None;
        }
        let most = largest / (1.0 - condition);
        let (mut error, mut rest) = (0.0, 0.0);
        for l in (0..count).rev() {
            error += (behind[l + 1] + most * largest * rest).min(most) * all[l] * before[l];
            rest += all[l];
        }
        let volume = |rate: &Rational| {
            let ticks = Rational::from_integer(self.period.into());
            Ball::from_rational(&(rate * &self.tick * ticks), BITS).neg().exp(BITS)
        };
        let det = volume(lo).union(&hi.map_or_else(Ball::zero, volume), BITS);
        let error = 1.02 * error;
        error.is_finite().then_some(Around { q, error, det })
    }

    /// The middle of c = exp(−γ t), and how far it is off.
    fn decay(&self, ticks: u64, lo: &Rational, hi: Option<&Rational>) -> [f64; 2] {
        if ticks == 0 {
            return [1.0, 0.0];
        }
        let at = |rate: &Rational| decayed(&(rate * &self.tick), ticks);
        let (most, least) = (at(lo), hi.map_or(0.0, at));
        let middle = least + (most - least) / 2.0;
        [middle, (most - least) / 2.0 + 4.0 * U * most + f64::MIN_POSITIVE]
    }

    /// A drift and the kick behind it: [[1, α W], [−F, c − α F W]], α = t (1 + c)/2, and how far it is off.
    fn factor(&self, ticks: f64, kick: &Mat<f64>, size: f64, [c, off]: [f64; 2]) -> (Mat<f64>, f64) {
        let n = self.size();
        let w = &self.inverse_mass;
        let product = kick * w;
        let mean = ticks * (1.0 + c) / 2.0;
        let one = |i: usize, j: usize| f64::from(u8::from(i == j));
        let matrix = Mat::from_fn(2 * n, 2 * n, |row, column| {
            let (i, j) = (row % n, column % n);
            match (row < n, column < n) {
                (true, true) => one(i, j),
                (true, false) => mean * w[(i, j)],
                (false, true) => -kick[(i, j)],
                (false, false) => c * one(i, j) - mean * product[(i, j)],
            }
        });
        let change = Mat::from_fn(2 * n, n, |row, j| {
            let i = row % n;
            if row < n { ticks / 2.0 * w[(i, j)] } else { one(i, j) - ticks / 2.0 * product[(i, j)] }
        });
        // Entries of F and W are rounded, and added up in sums of n products.
        let (mass, root) = (norm::frobenius(w), (n as f64).sqrt());
        let rounding = 1.01 * (n as f64 + 16.0) * U * (root + size) * (2.0 * root + ticks * mass);
        let change = norm::frobenius(&change) + (n as f64 + 16.0) * U * (root + size) * (root + ticks * mass);
        (matrix, 1.01 * off * change + rounding)
    }
}

/// Σ w F of the clocks that kick at once, and Σ w |F| (Frobenius).
fn kick(
    program: &Program<f64>,
    n: usize,
    clocks: impl Iterator<Item = usize>,
    weight: f64,
) -> (Mat<f64>, f64) {
    let (mut kick, mut sizes) = (Mat::zeros(n, n), Mat::<f64>::zeros(n, n));
    for clock in clocks {
        for (i, row) in &program.kicks[clock].rows {
            for (j, x) in row {
                kick[(*i, *j)] += weight * x;
                sizes[(*i, *j)] += weight * x.abs();
            }
        }
    }
    let size = norm::frobenius(&sizes);
    (kick, size)
}

impl Around {
    /// Of one oscillator: all traces. That of an error has two entries.
    fn trace(&self) -> Option<Ball> {
        let trace = self.q[(0, 0)] + self.q[(1, 1)];
        let off = 2.0 * self.error + 2.0 * U * trace.abs();
        let exact = |x: f64| Some(Ball::from_rational(&Rational::from_float(x)?, BITS));
        Some(exact((trace - off).next_down())?.union(&exact((trace + off).next_up())?, BITS))
    }

    /// ln ρ of one oscillator at one friction, the larger |λ| of λ² − Tr λ + det: √det for a complex pair, else (|Tr| + √(Tr² − 4 det))/2.
    pub fn ln_radius(&self) -> Option<Ball> {
        let trace = self.trace()?;
        let discriminant = trace.square(BITS).sub(&self.det.scale2(2), BITS);
        let root = self.det.sqrt_clipped(BITS)?;
        let real =
            trace.abs().add(&discriminant.sqrt_clipped(BITS).unwrap_or_else(Ball::zero), BITS).scale2(-1);
        let radius = match discriminant.to_f64_enclosure() {
            (_, hi) if hi < 0.0 => root,
            (lo, _) if lo > 0.0 => real,
            _ => real.union(&root, BITS),
        };
        radius.ln(BITS)
    }
}
