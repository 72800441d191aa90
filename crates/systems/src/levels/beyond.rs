//! The verdict beyond the first stable region: eigenvalues of S = Bᵀ C in discs and clusters.
//!
//! For symmetric X and X' with spectra in \[−1, 1\] and any unitarily invariant norm ‖T_k(X') − T_k(X)‖ ≤ k²
//! ‖X' − X‖ and ‖U_k(X') − U_k(X)‖ ≤ k (k + 1) (k + 2)/3 ‖X' − X‖, the Lipschitz constants of the polynomials
//! themselves: by their recurrence the difference is a sum of U_i(X') 2 (X' − X) T_j(X) or of U_i(X') 2 (X' −
//! X) U_j(X), and |U_i| ≤ i + 1. So errors of Λ move the fast half period by known amounts, x = 1 − s/2.
//!
//! Where spectra reach beyond \[−1, 1\], to ξ, the constants are T_k'(ξ) and U_k'(ξ): |T_j| ≤ T_j(ξ)
//! and |U_j| ≤ U_j(ξ) there, and for 1 x 1 matrices X = X' = ξ the sums above are these derivatives.

use faer::{Mat, Side, c64};

use super::half::Half;
use super::kernel::{Kernel, Outer};
use super::search::largest;
use crate::half::norm;
use crate::spectrum::discs::Spectrum;
use clocks::verdict::Kind;
use number::Interval;
use number::U;

/// A matrix that is known but for an error: bounds on the norms of the true and the computed one, and on
/// their distance.
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
    /// The enclosures of a, b, c, d.
    near: [Near; 4],
    /// Half an outer kick.
    kick: Mat<f64>,
    near_kick: Near,
}

impl Kernel {
    /// `None` without any mode.
    fn blocks(&self, outer: &Outer, epsilon: f64) -> Option<Blocks> {
        let p = outer.inner_steps;
        let (lowest, highest) = (*self.values.first()?, *self.values.last()?);
        let shifts = self.errors_within(epsilon);
        let shift = shifts[0];
        // |1 − s/2| − 1 at both ends.
        let beyond =
            (outer.scaled_up(highest + shift) / 2.0 - 2.0).max(-outer.scaled_down(lowest - shift) / 2.0);
        let moved = self.moved(outer, shift);
        let halves = self.halves(outer);
        let near = |pick: fn(&Half) -> Interval, lipschitz: f64| {
            let radius = halves.iter().map(|half| pick(half).error()).fold(0.0, f64::max);
            let largest = halves.iter().map(|half| pick(half).middle().abs()).fold(0.0, f64::max);
            let off = radius + lipschitz * moved;
            Near { size: largest + off, off }
        };
        let [a, b, c, d] = match self.method.has_inner_steps() {
            true => lipschitz(p, beyond.max(0.0)),
            false => {
                let [a, b, c, d, _] = self.method.slopes(p, self.below(outer, shift));
                [a, b, c, d]
            }
        };
        let near = [near(|h| h.a, a), near(|h| h.b, b), near(|h| h.c, c), near(|h| h.d, d)];
        let (kick, [size, off]) = self.half_kick(outer, shifts);
        let near_kick = Near { size, off };
        let halves =
            halves.iter().map(|h| [h.a.middle(), h.b.middle(), h.c.middle(), h.d.middle()]).collect();
        Some(Blocks { halves, near, kick, near_kick })
    }

    /// The kind that the eigenvalues of S prove for all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, if
    /// any.
    pub(super) fn beyond(&self, outer: &Outer, epsilon: f64) -> Option<Kind> {
        let blocks = self.blocks(outer, epsilon)?;
        blocks.certified(&self.spectrum_of(outer, &blocks)?)
    }

    /// The kind for the matrices given, where `is_open`, with their eigenvalues.
    pub(super) fn spectrum(&self, outer: &Outer, is_open: bool) -> Option<(Option<Kind>, Spectrum)> {
        let blocks = self.blocks(outer, 0.0)?;
        let spectrum = self.spectrum_of(outer, &blocks)?;
        let kind = is_open.then(|| blocks.certified(&spectrum)).flatten();
        Some((kind, spectrum))
    }

    fn spectrum_of(&self, outer: &Outer, blocks: &Blocks) -> Option<Spectrum> {
        self.real_spectrum(outer, blocks).or_else(|| {
            let (s, error) = blocks.s();
            Spectrum::of(s, Some(error))
        })
    }

    /// The spectrum of S where p θ < π for all modes: with V = 2 b d > 0, 1 + 2 S = V^½ (cos p θ − V^½ M V^½)
    /// V^-½.
    fn real_spectrum(&self, outer: &Outer, blocks: &Blocks) -> Option<Spectrum> {
        let highest = self.values.last().copied()?;
        let top = self.method.half(Interval::point(outer.inner_square * highest), outer.inner_steps);
        if !top.rises() {
            return None;
        }
        let (m, half) = (self.size(), &blocks.halves);
        let root: Vec<f64> = half.iter().map(|[_, b, _, d]| (2.0 * b * d).max(0.0).sqrt()).collect();
        let symmetric = Mat::from_fn(m, m, |i, j| {
            let [a, b, c, d] = half[i];
            (if i == j { a * d + b * c } else { 0.0 }) - root[i] * blocks.kick[(i, j)] * root[j]
        });
        let eigen = symmetric.self_adjoint_eigen(Side::Lower).ok()?;
        let mu = (0..m).map(|i| c64::new((eigen.S()[i] - 1.0) / 2.0, 0.0)).collect();
        let vectors = Mat::from_fn(m, m, |i, j| c64::new(root[i] * eigen.U()[(i, j)], 0.0));
        let (s, error) = blocks.s();
        // Where some V is nearly 0 the basis is not one in doubles.
        Spectrum::with(s, Some(error), mu, vectors).filter(|spectrum| spectrum.radius().is_some())
    }

    /// The largest ε, within a tenth, for which all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, are
    /// proven unstable: by counts where these decide, else by the discs about the eigenvalues at this step.
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
        self.has_real_unstable_mode(outer, epsilon) || self.beyond(outer, epsilon) == Some(Kind::Hyperbolic)
    }
}

/// The Lipschitz constants in s of a, b, c and d, spectra in x being in \[−1 − beyond, 1 + beyond\].
fn lipschitz(p: u64, beyond: f64) -> [f64; 4] {
    // d/ds = (d/dx)/2.
    let [[t0, u0], [t1, u1], [t2, _]] = slopes(p / 2, beyond);
    if p.is_multiple_of(2) {
        // a = d = T_k, b = U_(k−1), c = (T_(k+1) − T_(k−1))/2.
        [t1 / 2.0, u0 / 2.0, (t2 + t0) / 4.0, t1 / 2.0]
    } else {
        // a = (T_k + T_(k+1))/2, b = (U_(k−1) + U_k)/2, c = T_(k+1) − T_k, d = U_k − U_(k−1).
        let (ts, us) = (t1 + t2, u0 + u1);
        [ts / 4.0, us / 4.0, ts / 2.0, us / 2.0]
    }
}

/// T_j'(ξ) and U_j'(ξ) at ξ = 1 + x for j = k − 1, k and k + 1, rounded up (T_(−1)' counts as 0: nobody asks
/// for it).
///
/// By the differences T_(j+1) − T_j = T_j − T_(j−1) + 2 x T_j, and the same of U: no term is negative from
/// the first one on.
pub(super) fn slopes(k: u64, x: f64) -> [[f64; 2]; 3] {
    // T_0 and U_0: values, slopes, and their differences from those before.
    let (mut value, mut slope, mut rise, mut steeper) = ([1.0; 2], [0.0; 2], [-x, 1.0], [-1.0, 0.0]);
    let mut last = [[0.0; 2]; 3];
    for _ in 0..=k {
        for n in [0, 1] {
            steeper[n] += 2.0 * value[n] + 2.0 * x * slope[n];
            rise[n] += 2.0 * x * value[n];
            slope[n] += steeper[n];
            value[n] += rise[n];
        }
        last = [last[1], last[2], slope];
    }
    // Four roundings of positive terms a round, of at most half a million.
    last.map(|values| values.map(|x| 1.001 * x))
}

impl Blocks {
    fn certified(&self, spectrum: &Spectrum) -> Option<Kind> {
        spectrum.certified_with(|| {
            let (y, error) = self.y();
            (y, Some(error))
        })
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_the_polynomials() {
        for k in [1u64, 2, 7, 40] {
            let n = k as f64;
            let [_, [t, u], _] = slopes(k, 0.0);
            let (squares, cubes) = (n * n, n * (n + 1.0) * (n + 2.0) / 3.0);
            assert!(t >= squares && t < 1.01 * squares && u >= cubes && u < 1.01 * cubes);
            // T_k'(cosh a) = k sinh(k a)/sinh a.
            let a = 0.3f64;
            let slope = n * (n * a).sinh() / a.sinh();
            let [_, [t, _], _] = slopes(k, a.cosh() - 1.0);
            assert!(t >= slope && t < 1.01 * slope, "{k}: {t} {slope}");
        }
    }
}
