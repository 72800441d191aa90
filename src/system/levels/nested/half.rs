//! The half period in doubles: discs about its eigenvalues, what grows and how fast, friction.

use faer::Mat;
use num_complex::Complex64;

use super::levels::{ROUNDINGS, Steps};
use crate::number::rational::{from_f64_exact, to_f64};
use crate::number::{Rational, U};
use crate::schedule::Weight;
use crate::system::friction::{Damping, Radius, damping};
use crate::system::half::float::FloatBlocks;
use crate::system::half::norm;
use crate::system::half::period::{Drifts, Propagated, Stiff, Stiffness, follow, follow_proven};
use crate::system::levels::counts::between_signs;
use crate::system::levels::damped::least_masking;
use crate::system::spectrum::discs::{Spectrum, product};
use crate::system::spectrum::rate::exponent;
use crate::verdict::Kind;

/// Coordinates at a step: x = V D⁻¹ y, p = V⁻ᵀ D q. A drift and a kick turn y by about as much in them, so that products stay near 1. What is soft drifts by one
/// in a period: less would let errors of stiffnesses move it far.
#[derive(Clone, Debug)]
struct Turning {
    /// D.
    roots: Vec<f64>,
    /// The least of D².
    least: f64,
    /// y ← y + D² q a tick, which is known to `off` (2-norm).
    drifts: Vec<Vec<(usize, f64)>>,
    off: f64,
}

impl Steps<'_> {
    /// The period with friction γ per unit time, v → exp(−γ t) v in the middle of every drift, and a bound on its error.
    fn damped_period(&self, step: f64, friction: f64) -> Option<(Mat<f64>, f64)> {
        let ticks = step / self.outer * to_f64(self.schedule.tick());
        let decay = from_f64_exact(friction * ticks).filter(|own| *own >= Rational::default())?;
        let turning = self.turning(step);
        let kicks = self.rounded_kicks(step, &turning);
        let drifts = Drifts { inverse_mass: &turning.drifts, decay: &decay, off: turning.off };
        let found = follow(&drifts, self.schedule.symmetric_period(), |_, clock| &kicks[clock]);
        found.error.map(|error| (found.matrix(), error))
    }

    /// Where the spectral radius of a period with friction γ per unit time lies; `None`: doubles do not tell.
    pub fn damping(&self, step: f64, friction: f64) -> Option<Damping> {
        let (q, error) = self.damped_period(step, friction)?;
        damping(&q, error, Radius::of(&q, error))
    }

    /// A friction that is proven to mask, where something grows without one: about the least. `None` where none was found.
    pub fn masking_friction(&self, step: f64) -> Option<f64> {
        let radius = |friction: f64| {
            let values = self.damped_period(step, friction).and_then(|(q, _)| q.eigenvalues().ok());
            values.map_or(f64::NAN, |all| all.into_iter().map(Complex64::norm).fold(0.0, f64::max))
        };
        let proven = |friction: f64| self.damping(step, friction) == Some(Damping::Damped);
        least_masking(self.rounded_rate(step), step, radius, proven)
    }

    /// The coordinates at a step.
    fn turning(&self, step: f64) -> Turning {
        let modes = self.nested.modes_of_all();
        let tick = to_f64(self.schedule.tick()) * self.square(step).sqrt();
        let slowest = 1.0 / self.schedule.period() as f64;
        let roots: Vec<f64> = modes.frequencies.iter().map(|own| (own * tick).max(slowest).sqrt()).collect();
        let squares = || roots.iter().map(|own| own * own);
        let (least, most) = (squares().fold(f64::INFINITY, f64::min), squares().fold(0.0, f64::max));
        let drifts = squares().enumerate().map(|own| vec![own]).collect();
        // (Vᵀ V)⁻¹ in place of the identity, and a rounding of the square.
        let off = 1.01 * most * (modes.defect / (1.0 - modes.defect) + U);
        Turning { roots, least, drifts, off }
    }

    /// F of the kicks q ← q − F y at a step, rounded.
    fn kicks_at(&self, step: f64, turning: &Turning) -> Vec<Mat<f64>> {
        let (square, roots) = (self.square(step), &turning.roots);
        let kick = |((turned, _), kick): (&(Mat<f64>, f64), &f64)| {
            let factor = square * kick;
            let entry = |i: usize, j: usize| factor * turned[(i, j)] / (roots[i] * roots[j]);
            Mat::from_fn(roots.len(), roots.len(), entry)
        };
        self.nested.modes_of_all().stiffnesses.iter().zip(&self.kicks).map(kick).collect()
    }

    /// The kicks of F, off by their roundings alone.
    fn rounded_kicks(&self, step: f64, turning: &Turning) -> Vec<Stiff> {
        self.kicks_at(step, turning).into_iter().map(|own| stiff(own, 0.0, 0.0)).collect()
    }

    /// How far (2-norm) these kicks are from those of all stiffnesses within ε.
    fn kick_errors(&self, step: f64, turning: &Turning, epsilon: f64) -> Vec<f64> {
        let modes = self.nested.modes_of_all();
        let error = |k: usize| {
            let error = (1.0 + modes.defect) * self.nested.error_within(k, epsilon) + modes.stiffnesses[k].1;
            1.01 * self.square(step) * self.kicks[k] * error / turning.least
        };
        (0..self.kicks.len()).map(error).collect()
    }

    fn followed(&self, kicks: &[Stiff], turning: &Turning) -> Option<Propagated> {
        let drifts = Drifts { inverse_mass: &turning.drifts, decay: &Rational::default(), off: turning.off };
        follow_proven(&drifts, self.events.iter().copied(), |_, clock| &kicks[clock])
    }

    /// The half period at a step with a bound for all stiffnesses within ε.
    pub(super) fn half_period(&self, step: f64, epsilon: f64) -> Option<FloatBlocks> {
        let turning = self.turning(step);
        let kicks = self.kicks_at(step, &turning).into_iter().zip(self.kick_errors(step, &turning, epsilon));
        let kicks: Vec<Stiff> = kicks.map(|(own, error)| stiff(own, error, 0.0)).collect();
        Some(self.followed(&kicks, &turning)?.blocks(vec![1.0; self.nested.size()]))
    }

    /// The kind that discs prove at all outer steps between two, of all stiffnesses within ε.
    ///
    /// With kicks (1 + η) (F + ζ E), ζ E within the errors at ζ = 1, S = Bᵀ C is a polynomial in η and ζ, within r of what is computed of F where |η| ≤ ρ, |ζ| ≤ z.
    /// So by Cauchy's bounds on its coefficients (`proofs/REGION.md`, section 10)
    ///
    /// ```text
    ///     |S(η, 1) − S(0, 1) − S₁ η − S₂ η²| ≤ r (x³ + x/z)/((1 − x) (1 − 1/z)),     x = |η|/ρ,
    /// ```
    ///
    /// and S of F in the middle and at both ends has S₁ and S₂. Where a cell is too narrow for these differences, S(0, 1) alone is kept.
    pub(super) fn by_discs_between(&self, [lo, hi]: [f64; 2], epsilon: f64) -> Option<Kind> {
        let middle = lo / 2.0 + hi / 2.0;
        let turning = self.turning(middle);
        let rounded = |step: f64| {
            let kicks = self.rounded_kicks(step, &turning);
            let (s, error) = product(&self.followed(&kicks, &turning)?.blocks(Vec::new()));
            Some((s, error?))
        };
        let of = |step: f64| self.square(step) / self.square(middle);
        let (below, above) = (1.0 - of(lo), of(hi) - 1.0);
        let eta = 1.01 * below.max(above) + 8.0 * U;
        let (s, s_off) = rounded(middle)?;
        if below.min(above) < NARROW {
            let (off, rest) = self.off_about(middle, &turning, eta, 1, epsilon)?;
            return Spectrum::of(s, Some(1.01 * (off + rest)))?.by_discs();
        }
        let ((left, left_off), (right, right_off)) = (rounded(lo)?, rounded(hi)?);
        let (off, rest) = self.off_about(middle, &turning, eta, 3, epsilon)?;
        // Both ends' differences from the middle are S₁ η + S₂ η² within this.
        let known = left_off + right_off + 2.0 * s_off + 2.0 * rest;
        let bend = faer::Scale(below) * (&right - &s) + faer::Scale(above) * (&left - &s);
        let whole = below + above;
        let second = eta / below * (eta / above) * (norm::frobenius(&bend) / whole + known);
        let change = faer::Scale(1.01 * eta / whole) * (right - left);
        let first = eta / whole * known + (above - below).abs() / eta * second;
        Spectrum::of(s, Some(1.02 * (off + rest + first + second)))?.certified_along(&change)
    }

    /// Bounds on |S(0, 1) − S| and on what is of this order in η and beyond it, at |η| ≤ `eta`: see [`Steps::by_discs_between`].
    fn off_about(
        &self,
        step: f64,
        turning: &Turning,
        eta: f64,
        order: i32,
        epsilon: f64,
    ) -> Option<(f64, f64)> {
        let kicks = self.kicks_at(step, turning);
        let errors = self.kick_errors(step, turning, epsilon);
        let sizes: Vec<f64> = kicks.iter().map(norm::spectral).collect();
        // z/ρ: E takes at most half of what η takes.
        let share = sizes.iter().zip(&errors).map(|(size, error)| size / error).fold(1e6, f64::min) / 4.0;
        let known = |(size, error): (f64, f64)| (error, 1.01 * (size + 2.0 * share * error));
        let known = sizes.into_iter().zip(errors).map(known);
        let kicks: Vec<Stiff> =
            kicks.into_iter().zip(known).map(|(own, (error, known))| stiff(own, error, known)).collect();
        let state =
            self.followed(&kicks, &Turning { off: (1.0 + share) * turning.off, ..turning.clone() })?;
        let blocks = state.blocks(Vec::new());
        let rest = |rho: f64| {
            let error = Some(state.error_within(rho)?);
            let r = product(&FloatBlocks { error, ..blocks.clone() }).1?;
            let (x, z) = (eta / rho, rho * share);
            let terms = x.powi(order) + x / z;
            (x < 1.0 && z > 1.0).then(|| 1.01 * r * terms / ((1.0 - x) * (1.0 - 1.0 / z)))
        };
        let least = (1..16).filter_map(|k| rest(0.5f64.powi(k))).reduce(f64::min)?;
        product(&blocks).1.map(|off| (off, least))
    }

    /// (A B) and (C D) of the half period, rounded, by products of whole matrices.
    fn rounded_half(&self, step: f64) -> [Mat<f64>; 2] {
        let (n, square) = (self.nested.size(), self.square(step));
        let one = |first: usize| Mat::from_fn(n, 2 * n, |i, j| f64::from(u8::from(j == first + i)));
        let (mut x, mut p) = (one(0), one(n));
        for event in &self.events {
            x += faer::Scale(event.drift as f64) * &p;
            let weight = if event.weight == Weight::Half { 0.5 } else { 1.0 };
            let kick = event.clocks().fold(Mat::<f64>::zeros(n, n), |sum, k| {
                sum + faer::Scale(weight * square * self.kicks[k]) * &self.nested.levels[k].stiffness
            });
            p -= kick * &x;
        }
        [x, p]
    }

    /// Values of s = 1 + μ between modes of one of Krein's signs and of the other, the sign that of vᵀ Aᵀ C v; `None` where some μ are off \[−1, 0\], or where
    /// signs change too often. Rounded: whatever they are, counts at them prove what they prove.
    pub(super) fn twists(&self, step: f64) -> Option<Vec<f64>> {
        let n = self.nested.size();
        let [x, p] = self.rounded_half(step);
        let spectrum = Spectrum::of(x.subcols(n, n).transpose() * p.subcols(0, n), None)?;
        if spectrum.mu.iter().any(|mu| mu.im != 0.0 || !(-1.0..=0.0).contains(&mu.re)) {
            return None;
        }
        let v = Mat::from_fn(n, n, |i, k| spectrum.vectors[(i, k)].re);
        let (av, cv) = (x.subcols(0, n) * &v, p.subcols(0, n) * &v);
        let sign = |k: usize| (0..n).map(|i| av[(i, k)] * cv[(i, k)]).sum::<f64>() > 0.0;
        between_signs(spectrum.mu.iter().enumerate().map(|(k, mu)| (1.0 + mu.re, sign(k))).collect())
    }

    /// Bᵀ C of that.
    fn rounded_product(&self, step: f64) -> Mat<f64> {
        let (n, [x, p]) = (self.nested.size(), self.rounded_half(step));
        x.subcols(n, n).transpose() * p.subcols(0, n)
    }

    /// max ln |λ|/T; no number where the iteration for the eigenvalues fails.
    pub(super) fn rounded_rate(&self, step: f64) -> f64 {
        let values = self.rounded_product(step).eigenvalues();
        let largest = |mu: Vec<Complex64>| mu.into_iter().map(|mu| exponent(mu).re).fold(0.0, f64::max);
        values.map_or(f64::NAN, largest) / self.period(step)
    }

    fn period(&self, step: f64) -> f64 {
        step / self.outer * to_f64(self.schedule.tick()) * self.schedule.period() as f64
    }

    /// What grows fastest, and how fast per unit time: rounded.
    pub(super) fn fastest(&self, step: f64) -> Option<(f64, [Vec<f64>; 2])> {
        let spectrum = Spectrum::of(self.rounded_product(step), None)?;
        let rates = spectrum.mu.iter().map(|&mu| exponent(mu).re / self.period(step)).enumerate();
        let (fastest, rate) = rates.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let own = spectrum.shape(fastest, &vec![1.0; self.nested.size()]);
        let lifted = |part: fn(&Complex64) -> f64| -> Vec<f64> {
            let own: Vec<f64> = own.iter().map(part).collect();
            match &self.nested.basis {
                Some(basis) => {
                    let row = |i: usize| own.iter().enumerate().map(|(k, y)| basis[(i, k)] * y).sum();
                    (0..basis.nrows()).map(row).collect()
                }
                None => own,
            }
        };
        Some((rate, [lifted(|z| z.re), lifted(|z| z.im)]))
    }
}

/// Where cells are narrower, relatively, four roundings are not far below their width.
const NARROW: f64 = 1e-10;

/// A kick in doubles, off by its roundings, too.
fn stiff(kick: Mat<f64>, error: f64, known: f64) -> Stiff {
    let off = error + ROUNDINGS as f64 * U * norm::frobenius(&kick);
    Stiff { stiffness: Stiffness::Whole(kick), off, known }
}
