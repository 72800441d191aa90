//! Friction on two levels: where the spectral radius of the period lies, proven, for all stiffnesses within
//! their errors.
//!
//! With γ the friction and c = exp(−γ h), an inner step in (x, h v) is half a fast kick, the drift with v → c
//! v in its middle, and half a kick: G = H D H, for each mode of Λ
//!
//! ```text
//!     H = [[1, 0], [−s/2, 1]],     D = [[1, (1 + c)/2], [0, c]],     ‖H‖ ≤ 1 + |s|/2,  ‖D‖ ≤ √3.
//! ```
//!
//! Let X_k be the computed k-th power, X_(k+1) = G X_k + ρ_k with ‖ρ_k‖ ≤ η ‖X_k‖, and T the true step, no
//! longer mode by mode, ‖T − G‖ ≤ δ. Then Z_k = T^k − X_k obeys Z_(k+1) = T Z_k + (T − G) X_k − ρ_k, so that
//!
//! ```text
//!     ‖Z_p‖ ≤ (δ + η) Σ_(k<p) (‖X_(p−1−k)‖ + ‖Z_(p−1−k)‖) ‖X_k‖:
//! ```
//!
//! sums of products of two powers' norms instead of powers of norms. Between two halves of the slow kick that
//! is the period; its eigenvalues lie in discs about the computed ones (Bauer and Fike), or it shrinks a form
//! (Stein).

use faer::Mat;

use super::kernel::{Kernel, Outer};
use super::search::Search;
use crate::friction::{Damping, Friction, Mask, Radius, damping, from_edge, proven_down, shrink_one_form};
use crate::half::norm;
use crate::half::period::decayed;
use number::{Rational, U, from_f64_exact, to_f64};

/// The sums take a step for each pair of inner steps.
const MOST_INNER_STEPS: u64 = 1 << 12;

/// Products of doubles that a range of frictions may cost: seconds.
const MAX_PRODUCTS: f64 = 5e9;

/// Cells of frictions that are halved.
const MAX_HALVINGS: f64 = 2000.0;

/// Fewer lead nowhere.
const FEW: usize = 20;

/// √3, from above.
const DRIFT: f64 = 1.7321;

/// The fast modes.
type Modes = Vec<[f64; 4]>;

/// The fast modes over an outer step, (x, h v) → (a x + b h v, c x + d h v), and bounds on the norm of all of
/// them together and on their distance from the true ones. Where frictions fill a cell, coefficients in
/// Bernstein's basis: the true ones are means of these.
struct Fast {
    all: Vec<Modes>,
    size: f64,
    off: f64,
}

impl Kernel {
    /// The effect of friction of the rate γ per unit time, and the friction that masks the growth without it:
    /// both proven.
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
        let at = self.at(outer);
        let damping = |friction: f64| at.damping(outer.step, friction);
        // A friction that is next to none: does anything grow?
        match damping(1e-6 / outer.step) {
            Some(Damping::Growing) => {}
            None if !self.is_stable(outer, 0.0) => return Mask::Undecided,
            _ => return Mask::NotNeeded,
        }
        let Some(least) = at.masking_friction(outer.step) else { return Mask::Undecided };
        let grows = |friction: &f64| damping(*friction) == Some(Damping::Growing);
        let Some(below) = [0.9995, 0.998, 0.99].map(|part| part * least).into_iter().find(grows) else {
            return Mask::Undecided;
        };
        Mask::found(below, vec![from_edge(least, |from| self.masked_up(outer, from))])
    }

    /// Up to where all frictions from this one on are proven to mask.
    fn masked_up(&self, outer: &Outer, from: f64) -> f64 {
        let (rows, terms) = (2.0 * self.size() as f64, outer.inner_steps as f64 + 1.0);
        // A cell: polynomials of all modes, eigenvalues and a form (some 100 products), and three products
        // and a factorization for each coefficient.
        let cost = 20.0 * rows * terms.powi(2) + rows.powi(3) * (100.0 + 5.0 * terms);
        let halvings = (MAX_PRODUCTS / cost).min(MAX_HALVINGS) as usize;
        if halvings < FEW {
            return from;
        }
        let inner = outer.step / outer.inner_steps as f64;
        let top = (-from * inner).exp();
        let least = proven_down((), halvings, |(), lo, hi| {
            // Products of rounded numbers, and an exponential, x exp(−x) < 1/2.
            let all = self.periods_within(outer, [lo * top, hi * top], 8.0 * U);
            let masks = all.is_some_and(|(all, error)| {
                let middle = self.periods_within(outer, [(lo + hi) / 2.0 * top; 2], 0.0);
                middle.is_some_and(|(middle, _)| shrink_one_form(&middle[0], &all, error))
            });
            (!masks).then_some([(), ()])
        });
        // Less than that by more than roundings, so that its c is no less than the last cell's.
        let end = from - least.ln() / inner;
        if end.is_finite() { (end * (1.0 - 1e-12)).max(from) } else { end }
    }

    /// Velocities are multiplied by c in an inner step: one between two ends, which are known to
    /// `decay_error`.
    fn damped_modes(&self, outer: &Outer, ends: [f64; 2], decay_error: f64) -> Option<Fast> {
        let p = outer.inner_steps;
        if p > MOST_INNER_STEPS {
            return None;
        }
        let [fast_norm, _] = self.norms();
        let moved = self.moved(outer, self.fast_error);
        let kick = 1.01 * (1.0 + outer.scaled_up(fast_norm) / 2.0 + moved);
        // Two half kicks that are off by moved/2, a drift by 1.12 of what c is.
        let delta = 1.01 * (kick * DRIFT * moved + 1.2 * kick * kick * decay_error);
        // A rounding for each of two fused half kicks, three for the drift, on two columns; six for a mean of
        // two, of norm √3 each.
        let means = if ends[0] < ends[1] { 12.0 } else { 0.0 };
        let eta = (20.0 + means) * U * kick * kick;
        let stiffness: Vec<f64> = self.values.iter().map(|value| outer.inner_square * value).collect();
        let mut all = vec![vec![[1.0, 0.0, 0.0, 1.0]; self.size()]];
        let (mut sizes, mut offs) = (Vec::new(), Vec::<f64>::new());
        for _ in 0..=p {
            let products =
                offs.iter().zip(&sizes).rev().zip(&sizes).map(|((off, size), other)| (off + size) * other);
            offs.push(1.01 * (delta + eta) * products.sum::<f64>());
            sizes.push(1.01 * all.iter().flatten().map(norm_of).fold(0.0, f64::max));
            if offs.len() as u64 <= p {
                all = stepped(&all, &stiffness, ends);
            }
        }
        let (size, off) = (*sizes.last()?, *offs.last()?);
        (size + off).is_finite().then_some(Fast { all, size: size + off, off })
    }

    /// The period, and a bound on its error (2-norm).
    pub(super) fn damped_period(&self, outer: &Outer, friction: f64) -> Option<(Mat<f64>, f64)> {
        let exponent = from_f64_exact(friction * (outer.step / outer.inner_steps as f64));
        let c = decayed(&exponent.filter(|x| *x >= Default::default())?, 1);
        // The friction and the step are within 4u each, and x exp(−x) < 1/2.
        let (mut all, error) = self.periods_within(outer, [c; 2], 6.0 * U)?;
        Some((all.pop()?, error))
    }

    /// Periods whose means are those with velocities multiplied by any c between two ends in an inner step,
    /// and a bound on the distance (2-norm) of all within `off` of it.
    fn periods_within(&self, outer: &Outer, ends: [f64; 2], off: f64) -> Option<(Vec<Mat<f64>>, f64)> {
        let fast = self.damped_modes(outer, ends, off)?;
        let m = self.size();
        let (k, [kick_size, kick_off]) = self.half_kick(outer, self.errors_within(0.0));
        let kick_size = 1.01 * (1.0 + kick_size);
        let size_k = norm::frobenius(&k);
        let root = (m as f64).sqrt();
        // Four roundings of an entry's terms at most.
        let terms = 4.0 * fast.size * (root + 4.0 * size_k);
        let true_off = kick_size * (2.0 * kick_off * fast.size + kick_size * fast.off);
        let mut most = 0.0_f64;
        let period = |modes: &Modes| {
            let bk = Mat::from_fn(m, m, |i, j| modes[i][1] * k[(i, j)]);
            // Those, and those of the product.
            let rounding = 1.1 * U * (terms + (m as f64 + 8.0) * size_k * norm::frobenius(&bk));
            most = most.max(1.01 * (true_off + rounding));
            kicked(modes, &k, &bk)
        };
        let all = fast.all.iter().map(period).collect();
        Some((all, most))
    }
}

/// Half a slow kick, the modes, and half a kick; `bk` is b K.
fn kicked(modes: &Modes, k: &Mat<f64>, bk: &Mat<f64>) -> Mat<f64> {
    let (m, kbk) = (modes.len(), k * bk);
    Mat::from_fn(2 * m, 2 * m, |row, column| {
        let (i, j) = (row % m, column % m);
        let diagonal = |n: usize| if i == j { modes[i][n] } else { 0.0 };
        let [a, b, _, _] = modes[j];
        match (row < m, column < m) {
            (true, true) => diagonal(0) - bk[(i, j)],
            (true, false) => diagonal(1),
            (false, true) => diagonal(2) - modes[i][3] * k[(i, j)] - k[(i, j)] * a + kbk[(i, j)],
            (false, false) => diagonal(3) - k[(i, j)] * b,
        }
    })
}

/// The Frobenius norm.
fn norm_of(x: &[f64; 4]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// G of every mode more: a polynomial of the next degree where c is one between two ends, for 1 − w and w of
/// its places are those with c at an end.
fn stepped(all: &[Modes], stiffness: &[f64], [lo, hi]: [f64; 2]) -> Vec<Modes> {
    let with = |c: f64| -> Vec<Modes> {
        all.iter().map(|own| own.iter().zip(stiffness).map(|(x, s)| step(*x, *s, c)).collect()).collect()
    };
    if lo == hi {
        return with(lo);
    }
    let (lower, upper, terms) = (with(lo), with(hi), all.len());
    let mean = |j: usize| {
        let weight = j as f64 / terms as f64;
        let ends = lower[j.min(terms - 1)].iter().zip(&upper[j.saturating_sub(1)]);
        let mean =
            |(a, b): (&[f64; 4], &[f64; 4])| std::array::from_fn(|n| (1.0 - weight) * a[n] + weight * b[n]);
        ends.map(mean).collect()
    };
    (0..=terms).map(mean).collect()
}

/// G x.
fn step([mut a, mut b, mut c, mut d]: [f64; 4], s: f64, decay: f64) -> [f64; 4] {
    let (half, drift) = (-0.5 * s, 0.5 * (1.0 + decay));
    for (x, v) in [(&mut a, &mut c), (&mut b, &mut d)] {
        *v = half.mul_add(*x, *v);
        *x = drift.mul_add(*v, *x);
        *v *= decay;
        *v = half.mul_add(*x, *v);
    }
    [a, b, c, d]
}
