//! Friction on two levels: where the spectral radius of the period lies, proven, for all stiffnesses within their errors.
//!
//! With γ the friction and c = exp(−γ h), an inner step in (x, h v) is half a fast kick, the drift with v → c v in its middle, and half
//! a kick: G = H D H, for each mode of Λ
//!
//! ```text
//!     H = [[1, 0], [−s/2, 1]],     D = [[1, (1 + c)/2], [0, c]],     ‖H‖ ≤ 1 + |s|/2,  ‖D‖ ≤ √3.
//! ```
//!
//! Let X_k be the computed k-th power, X_(k+1) = G X_k + ρ_k with ‖ρ_k‖ ≤ η ‖X_k‖, and T the true step, no longer mode by mode, ‖T − G‖ ≤ δ.
//! Then Z_k = T^k − X_k obeys Z_(k+1) = T Z_k + (T − G) X_k − ρ_k, so that
//!
//! ```text
//!     ‖Z_p‖ ≤ (δ + η) Σ_(k<p) (‖X_(p−1−k)‖ + ‖Z_(p−1−k)‖) ‖X_k‖:
//! ```
//!
//! sums of products of two powers' norms instead of powers of norms. Between two halves of the slow kick that is the period; its
//! eigenvalues lie in discs about the computed ones (Bauer and Fike), or it shrinks a form (Stein).

use faer::Mat;
use num_complex::Complex64;

use super::kernel::{Kernel, Outer};
use crate::friction::{Damping, Friction, Mask, Radius, Search, damping};
use crate::half::norm;
use crate::half::period::decayed;
use number::rational::{from_f64_exact, to_f64};
use number::{Rational, U};

/// The sums take a step for each pair of inner steps.
const MOST_INNER_STEPS: u64 = 1 << 12;

/// Degrees of freedom of which ranges of frictions are looked at: some hundred eigenvalue problems of twice as many rows.
const FEW: usize = 40;

/// √3, from above.
const DRIFT: f64 = 1.7321;

/// The fast modes over an outer step, (x, h v) → (a x + b h v, c x + d h v), and bounds on the norm of all of them together and on their
/// distance from the true ones.
struct Fast {
    modes: Vec<[f64; 4]>,
    size: f64,
    off: f64,
}

impl Kernel {
    /// Where the spectral radius of a period with friction γ per unit time lies, v → exp(−γ t) v in the middle of every drift;
    /// `None`: doubles cannot decide.
    pub fn damping(&self, outer: &Outer, friction: f64) -> Option<Damping> {
        let (q, error) = self.damped_period(outer, friction)?;
        damping(&q, error, Radius::of(&q, error))
    }

    /// The effect of friction of the rate γ per unit time, and the friction that masks the growth without it: both proven.
    pub fn friction(&self, outer: &Outer, rate: &Rational) -> Friction {
        let period = self.damped_period(outer, to_f64(rate));
        let pair = period.map(|(q, error)| {
            let radius = Radius::of(&q, error);
            (damping(&q, error, radius), radius.map(|radius| radius.growth(outer.step)))
        });
        let (damping, growth) = pair.unwrap_or_default();
        Friction { rate: rate.clone(), damping, growth, masking: self.mask(outer) }
    }

    fn mask(&self, outer: &Outer) -> Mask {
        // A friction that is next to none: does anything grow?
        match self.damping(outer, 1e-6 / outer.step) {
            Some(Damping::Growing) => {}
            None if !self.is_stable(outer, 0.0) => return Mask::NotTold,
            _ => return Mask::NotNeeded,
        }
        let Some(least) = self.masking_friction(outer) else { return Mask::NotTold };
        let side = |friction: f64| self.damping(outer, friction);
        let grows = |friction: &f64| side(*friction) == Some(Damping::Growing);
        let Some(below) = [0.9995, 0.998, 0.99].map(|part| part * least).into_iter().find(grows) else {
            return Mask::NotTold;
        };
        let masks = |lo: f64, hi: f64| self.size() <= FEW && self.masks(outer, lo, hi);
        let search = Search { period: outer.step, side: &side, masks: &masks, per_octave: 1, width: 1e-4 };
        // Steps of the proof shrink with the distance from the edge: a little above it all larger ones may be proven.
        let stays = [1.0, 1.003, 1.01]
            .map(|part| part * least)
            .into_iter()
            .find(|at| search.up(*at) == f64::INFINITY);
        let range = stays.map_or_else(|| (least, search.up(least)), |at| (at, f64::INFINITY));
        Mask::found(below, vec![range])
    }

    /// Whether all frictions from `lo` to `hi`, which may be infinite, are proven to mask.
    fn masks(&self, outer: &Outer, lo: f64, hi: f64) -> bool {
        let inner = outer.step / outer.inner_steps as f64;
        let factor = |friction: f64| if friction.is_finite() { (-friction * inner).exp() } else { 0.0 };
        let [most, least] = [lo, hi].map(factor);
        // Exponentials of rounded numbers, x exp(−x) < 1/2.
        let off = (most - least) / 2.0 + 8.0 * U;
        let period = self.period_within(outer, least + (most - least) / 2.0, off);
        period.is_some_and(|(q, error)| damping(&q, error, Radius::of(&q, error)) == Some(Damping::Damped))
    }

    /// The spectral radius of the computed period, no more than computed.
    fn rounded_radius(&self, outer: &Outer, friction: f64) -> f64 {
        let eigenvalues = self.damped_period(outer, friction).and_then(|(q, _)| q.eigenvalues().ok());
        eigenvalues.map_or(f64::NAN, |all| all.into_iter().map(Complex64::norm).fold(0.0, f64::max))
    }

    /// A friction that is proven to mask, where the radius is above 1 without one: at most a thirtieth above the least that does so in doubles. `None`
    /// where none was found.
    pub fn masking_friction(&self, outer: &Outer) -> Option<f64> {
        let proven = |friction: f64| self.damping(outer, friction) == Some(Damping::Damped);
        least_masking(self.growth(outer), outer.step, |friction| self.rounded_radius(outer, friction), proven)
    }

    /// Velocities are multiplied by c in an inner step, which is known to `decay_error`.
    fn damped_modes(&self, outer: &Outer, c: f64, decay_error: f64) -> Option<Fast> {
        let p = outer.inner_steps;
        if p > MOST_INNER_STEPS {
            return None;
        }
        let [fast_norm, _] = self.norms();
        let moved = self.moved(outer, self.fast_error);
        let kick = 1.01 * (1.0 + outer.scaled_up(fast_norm) / 2.0 + moved);
        // Two half kicks that are off by moved/2, a drift by 1.12 of what c is.
        let delta = 1.01 * (kick * DRIFT * moved + 1.2 * kick * kick * decay_error);
        // A rounding for each of two fused half kicks, three for the drift, on two columns.
        let eta = 20.0 * U * kick * kick;
        let mut modes: Vec<[f64; 4]> = vec![[1.0, 0.0, 0.0, 1.0]; self.size()];
        let (mut sizes, mut offs) = (Vec::new(), Vec::<f64>::new());
        for _ in 0..=p {
            let products =
                offs.iter().zip(&sizes).rev().zip(&sizes).map(|((off, size), other)| (off + size) * other);
            offs.push(1.01 * (delta + eta) * products.sum::<f64>());
            sizes.push(1.01 * modes.iter().map(norm_of).fold(0.0, f64::max));
            if offs.len() as u64 <= p {
                modes
                    .iter_mut()
                    .zip(&self.values)
                    .for_each(|(x, value)| step(x, outer.inner_square * value, c));
            }
        }
        let (size, off) = (*sizes.last()?, *offs.last()?);
        (size + off).is_finite().then_some(Fast { modes, size: size + off, off })
    }

    /// The period, and a bound on its error (2-norm).
    fn damped_period(&self, outer: &Outer, friction: f64) -> Option<(Mat<f64>, f64)> {
        let exponent = from_f64_exact(friction * (outer.step / outer.inner_steps as f64));
        // The friction and the step are within 4u each, and x exp(−x) < 1/2.
        self.period_within(outer, decayed(&exponent.filter(|x| *x >= Default::default())?, 1), 6.0 * U)
    }

    /// The period where velocities are multiplied by c in an inner step, and a bound on the distance (2-norm) of all within `off` of it.
    fn period_within(&self, outer: &Outer, c: f64, off: f64) -> Option<(Mat<f64>, f64)> {
        let fast = self.damped_modes(outer, c, off)?;
        let m = self.size();
        let (k, [kick_size, kick_off]) = self.half_kick(outer, self.errors_within(0.0));
        let kick_size = 1.01 * (1.0 + kick_size);
        let bk = Mat::from_fn(m, m, |i, j| fast.modes[i][1] * k[(i, j)]);
        let kbk = &k * &bk;
        let q = Mat::from_fn(2 * m, 2 * m, |row, column| {
            let (i, j) = (row % m, column % m);
            let diagonal = |n: usize| if i == j { fast.modes[i][n] } else { 0.0 };
            let [a, b, _, _] = fast.modes[j];
            match (row < m, column < m) {
                (true, true) => diagonal(0) - bk[(i, j)],
                (true, false) => diagonal(1),
                (false, true) => diagonal(2) - fast.modes[i][3] * k[(i, j)] - k[(i, j)] * a + kbk[(i, j)],
                (false, false) => diagonal(3) - k[(i, j)] * b,
            }
        });
        let (size_k, size_bk) = (norm::frobenius(&k), norm::frobenius(&bk));
        let root = (m as f64).sqrt();
        // Four roundings of an entry's terms at most, and those of the product.
        let terms = 4.0 * fast.size * (root + 4.0 * size_k);
        let rounding = 1.1 * U * (terms + (m as f64 + 8.0) * size_k * size_bk);
        let true_off = kick_size * (2.0 * kick_off * fast.size + kick_size * fast.off);
        Some((q, 1.01 * (true_off + rounding)))
    }
}

/// About the least friction that is proven to mask what grows at this rate without one, bisected by the rounded spectral radius of an outer step.
pub(super) fn least_masking(
    growth: f64,
    step: f64,
    radius: impl Fn(f64) -> f64,
    proven: impl Fn(f64) -> bool,
) -> Option<f64> {
    let is_damped = |friction: f64| radius(friction) < 1.0;
    let mut hi = 2.0 * growth;
    while hi > 0.0 && !is_damped(hi) {
        hi *= 2.0;
        if hi * step > 1e3 {
            return None;
        }
    }
    let mut lo = 0.0;
    while hi - lo > 1e-4 * hi {
        let middle = lo + (hi - lo) / 2.0;
        *(if is_damped(middle) { &mut hi } else { &mut lo }) = middle;
    }
    [1.0, 1.0003, 1.001, 1.003, 1.01, 1.03].map(|off| off * hi).into_iter().find(|value| proven(*value))
}

/// The Frobenius norm.
fn norm_of(x: &[f64; 4]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// G x.
fn step([a, b, c, d]: &mut [f64; 4], s: f64, decay: f64) {
    let (half, drift) = (-0.5 * s, 0.5 * (1.0 + decay));
    for (x, v) in [(a, c), (b, d)] {
        *v = half.mul_add(*x, *v);
        *x = drift.mul_add(*v, *x);
        *v *= decay;
        *v = half.mul_add(*x, *v);
    }
}
