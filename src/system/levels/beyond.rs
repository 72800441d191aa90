//! The verdict beyond the first stable region: eigenvalues of S = Bᵀ C in discs and clusters.
//!
//! For symmetric X and X' with spectra in \[−1, 1\] and any unitarily invariant norm ‖T_k(X') − T_k(X)‖ ≤ k² ‖X' − X‖ and
//! ‖U_k(X') − U_k(X)‖ ≤ k (k + 1) (k + 2)/3 ‖X' − X‖, the Lipschitz constants of the polynomials themselves: by their recurrence the
//! difference is a sum of U_i(X') 2 (X' − X) T_j(X) or of U_i(X') 2 (X' − X) U_j(X), and |U_i| ≤ i + 1. So errors of Λ move the
//! fast half period by known amounts, x = 1 − s/2. Where the spectrum reaches below s = 0 by 0.02/p², cosh takes the place of
//! cos, with (j + 1) t ≤ 0.15, and 1.05 times the constants hold.

use faer::Mat;

use super::half::Half;
use super::interval::Interval;
use super::kernel::{Kernel, Outer};
use super::region::largest;
use crate::number::U;
use crate::system::norm;
use crate::system::spectrum::Spectrum;
use crate::verdict::Kind;

/// A matrix that is known but for an error: bounds on the norms of the true and the computed one, and on their distance.
#[derive(Clone, Copy)]
struct Near {
    size: f64,
    off: f64,
}

impl Near {
    fn times(self, other: Near) -> Near {
        Near { size: self.size * other.size, off: 1.01 * (self.off * other.size + self.size * other.off) }
    }

    fn plus(self, other: Near) -> Near {
        Near { size: self.size + other.size, off: 1.01 * (self.off + other.off) }
    }

    fn rounded(self, rounding: f64) -> Near {
        Near { size: self.size + rounding, off: self.off + rounding }
    }
}

/// The half period in the eigenbasis, with the errors of everything in it.
struct Blocks {
    halves: Vec<[f64; 4]>,
    /// Of a, b, c, d.
    near: [Near; 4],
    /// Half an outer kick.
    kick: Mat<f64>,
    near_kick: Near,
}

impl Kernel {
    /// `None` where the fast spectrum leaves the range in which its polynomials are bounded.
    fn blocks(&self, outer: &Outer, epsilon: f64) -> Option<Blocks> {
        let p = outer.inner_steps;
        let (lowest, highest) = (*self.values.first()?, *self.values.last()?);
        let [shift, slow] = self.errors_within(epsilon);
        if outer.scaled_up(highest + shift) > 4.0
            || outer.scaled_down(lowest - shift) < -0.02 / (p as f64).powi(2)
        {
            return None;
        }
        let moved = self.moved(outer, shift);
        let halves: Vec<Half> = self.values.iter().map(|x| Half::new(outer.inner_square * x, p)).collect();
        let near = |pick: fn(&Half) -> Interval, lipschitz: f64| {
            let radius = halves.iter().map(|half| pick(half).radius()).fold(0.0, f64::max);
            let largest = halves.iter().map(|half| pick(half).mid().abs()).fold(0.0, f64::max);
            let off = radius + 1.05 * lipschitz * moved;
            Near { size: largest + off, off }
        };
        let [a, b, c, d] = lipschitz(p);
        let near = [near(|h| h.a, a), near(|h| h.b, b), near(|h| h.c, c), near(|h| h.d, d)];
        let (kick, [size, off]) = self.half_kick(outer, slow);
        let near_kick = Near { size, off };
        let halves = halves.iter().map(|h| [h.a.mid(), h.b.mid(), h.c.mid(), h.d.mid()]).collect();
        Some(Blocks { halves, near, kick, near_kick })
    }

    /// What the eigenvalues of S prove of all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, if anything, and they themselves.
    pub(super) fn beyond(&self, outer: &Outer, epsilon: f64) -> Option<(Option<Kind>, Spectrum)> {
        let blocks = self.blocks(outer, epsilon)?;
        let (s, error) = blocks.s();
        let spectrum = Spectrum::of(s, Some(error))?;
        let kind = spectrum.certified_with(|| {
            let (y, error) = blocks.y();
            (y, Some(error))
        });
        Some((kind, spectrum))
    }

    /// The largest ε, within a tenth, for which all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, are proven unstable: by counts where these
    /// tell, else by the discs about the eigenvalues at this step.
    pub(super) fn unstable_margin(&self, outer: &Outer, spectrum: Option<&Spectrum>) -> Option<f64> {
        let by_discs = |epsilon: f64| {
            let error = self.blocks(outer, epsilon)?.s().1;
            (spectrum?.with_error(error)?.by_discs() == Some(Kind::Hyperbolic)).then_some(())
        };
        if self.has_real_unstable_mode(outer, 0.0) {
            largest(1.1, |epsilon| self.has_real_unstable_mode(outer, epsilon))
        } else {
            largest(1.1, |epsilon| by_discs(epsilon).is_some())
        }
    }

    /// Whether all matrices as in [`Kernel::is_in_first_region`] are proven unstable.
    pub fn is_unstable(&self, outer: &Outer, epsilon: f64) -> bool {
        self.has_real_unstable_mode(outer, epsilon)
            || matches!(self.beyond(outer, epsilon), Some((Some(Kind::Hyperbolic), _)))
    }
}

/// The Lipschitz constants in s of a, b, c and d.
fn lipschitz(p: u64) -> [f64; 4] {
    let k = (p / 2) as f64;
    // d/ds = (d/dx)/2; T_k' ≤ k², U_k' ≤ k (k + 1) (k + 2)/3.
    let (t, u) = (|k: f64| k * k, |k: f64| k * (k + 1.0) * (k + 2.0) / 3.0);
    if p.is_multiple_of(2) {
        // a = d = T_k, b = U_(k−1), c = (T_(k+1) − T_(k−1))/2.
        let c = if k > 0.0 { (t(k + 1.0) + t(k - 1.0)) / 4.0 } else { 0.0 };
        [t(k) / 2.0, u((k - 1.0).max(0.0)) / 2.0, c, t(k) / 2.0]
    } else {
        // a = (T_k + T_(k+1))/2, b = (U_(k−1) + U_k)/2, c = T_(k+1) − T_k, d = U_k − U_(k−1).
        let (ts, us) = (t(k) + t(k + 1.0), u((k - 1.0).max(0.0)) + u(k));
        [ts / 4.0, us / 4.0, ts / 2.0, us / 2.0]
    }
}

impl Blocks {
    /// C = c − d M, with its error.
    fn c(&self) -> (Mat<f64>, Near) {
        let m = self.halves.len();
        let entry = |i: usize, j: usize| {
            let [_, _, c, d] = self.halves[i];
            (if i == j { c } else { 0.0 }) - d * self.kick[(i, j)]
        };
        let [_, _, c, d] = self.near;
        let whole = c.plus(d.times(self.near_kick));
        // Two roundings an entry.
        let rounding = 3.0 * U * (d.size * norm::frobenius(&self.kick) + c.size * (m as f64).sqrt());
        (Mat::from_fn(m, m, entry), whole.rounded(rounding))
    }

    /// S = Bᵀ C = b C, and a bound on its error.
    fn s(&self) -> (Mat<f64>, f64) {
        let m = self.halves.len();
        let (c, near) = self.c();
        let whole = self.near[1].times(near);
        let rounding = 1.1 * U * self.near[1].size * norm::frobenius(&c);
        (Mat::from_fn(m, m, |i, j| self.halves[i][1] * c[(i, j)]), 1.01 * (whole.off + rounding))
    }

    /// Y = Aᵀ C, A = a − b M, and a bound on its error.
    fn y(&self) -> (Mat<f64>, f64) {
        let m = self.halves.len();
        let (c, near_c) = self.c();
        let entry = |i: usize, j: usize| {
            let [a, b, _, _] = self.halves[j];
            (if i == j { a } else { 0.0 }) - self.kick[(i, j)] * b
        };
        let transposed = Mat::from_fn(m, m, entry);
        let [a, b, _, _] = self.near;
        let rounding = 3.0 * U * (b.size * norm::frobenius(&self.kick) + a.size * (m as f64).sqrt());
        let near_a = a.plus(b.times(self.near_kick)).rounded(rounding);
        let product = 1.1 * (m as f64 + 4.0) * U * norm::frobenius(&transposed) * norm::frobenius(&c);
        (&transposed * &c, 1.01 * (near_a.times(near_c).off + product))
    }
}
