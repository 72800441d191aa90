//! The half period in doubles: discs about its eigenvalues, what grows and how fast, friction.

use faer::Mat;
use num_complex::Complex64;

use super::levels::{ROUNDINGS, Steps};
use crate::columns::combined;
use crate::half::float::FloatBlocks;
use crate::half::norm;
use crate::half::period::{Drifts, Propagated, Stiff, Stiffness, follow, follow_looking};
use crate::levels::counts::between_signs;
use crate::spectrum::bauer_fike::{Term, gamma};
use crate::spectrum::discs::{Spectrum, product};
use crate::spectrum::rate::exponent;
use clocks::schedule::Event;
use clocks::verdict::Kind;
use number::{Rational, U, from_f64_exact, to_f64};

/// Coordinates at a step: x = V D⁻¹ y, p = V⁻ᵀ D q. A drift and a kick turn y by about as much in them, so
/// that products stay near 1. What is soft drifts by one in a period: less would let errors of stiffnesses
/// move it far.
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
    /// The period with friction γ per unit time, v → exp(−γ t) v in the middle of every drift, and a bound on
    /// its error.
    pub(super) fn whole_damped_period(&self, step: f64, friction: f64) -> Option<(Mat<f64>, f64)> {
        let ticks = step / self.outer * to_f64(self.schedule.tick());
        let decay = from_f64_exact(friction * ticks).filter(|value| *value >= Rational::default())?;
        let turning = self.turning(step);
        let kicks = self.rounded_kicks(step, &turning);
        let drifts = Drifts { inverse_mass: &turning.drifts, decay: &decay, off: turning.off };
        let found = follow(&drifts, self.schedule.symmetric_period(), |_, clock| &kicks[clock]);
        found.error.map(|error| (found.matrix(), error))
    }

    /// The coordinates at a step.
    fn turning(&self, step: f64) -> Turning {
        let modes = self.nested.modes_of_all();
        let tick = to_f64(self.schedule.tick()) * self.square(step).sqrt();
        let slowest = 1.0 / self.schedule.period() as f64;
        let roots: Vec<f64> =
            modes.frequencies.iter().map(|frequency| (frequency * tick).max(slowest).sqrt()).collect();
        let squares = || roots.iter().map(|root| root * root);
        let (least, most) = (squares().fold(f64::INFINITY, f64::min), squares().fold(0.0, f64::max));
        let drifts = squares().enumerate().map(|pair| vec![pair]).collect();
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
        self.kicks_at(step, turning).into_iter().map(|matrix| stiff(matrix, 0.0, 0.0)).collect()
    }

    /// How far (2-norm) h t² Vᵀ K V of each clock is from that of all stiffnesses within ε; a kick divides
    /// its entries by roots.
    fn kick_errors(&self, step: f64, epsilon: f64) -> Vec<f64> {
        let modes = self.nested.modes_of_all();
        let error = |k: usize| {
            let error = (1.0 + modes.defect) * self.nested.error_within(k, epsilon) + modes.stiffnesses[k].1;
            1.01 * self.square(step) * self.kicks[k] * error
        };
        (0..self.kicks.len()).map(error).collect()
    }

    /// `look` is shown every event, and the rows of positions there.
    fn followed(
        &self,
        kicks: &[Stiff],
        turning: &Turning,
        look: impl FnMut(&Event, &[f64]),
    ) -> Option<Propagated> {
        let drifts = Drifts { inverse_mass: &turning.drifts, decay: &Rational::default(), off: turning.off };
        follow_looking(&drifts, self.events.iter().copied(), |_, clock| &kicks[clock], look)
    }

    /// The half period at a step with a bound for all stiffnesses within ε.
    pub(super) fn half_period(&self, step: f64, epsilon: f64) -> Option<FloatBlocks> {
        let turning = self.turning(step);
        let kicks = self.kicks_at(step, &turning).into_iter().zip(self.kick_errors(step, epsilon));
        let kicks: Vec<Stiff> =
            kicks.map(|(matrix, error)| stiff(matrix, error / turning.least, 0.0)).collect();
        Some(self.followed(&kicks, &turning, |_, _| ())?.blocks(vec![1.0; self.nested.size()]))
    }

    /// The kind that discs prove at all outer steps between two, or at one, of all stiffnesses within ε.
    ///
    /// With kicks (1 + η) (F + ζ E), ζ E within the errors at ζ = 1, S = Bᵀ C is a polynomial in η and ζ,
    /// within r of what is computed of F where kicks are off by at most t of their sizes. So Cauchy's bounds
    /// on its coefficients leave little beyond S(0, 0) + S_E + S₁ η + S₂ η² (`proofs/REGION.md`, section 10),
    /// and S of F in the middle and at both ends has S₁ and S₂; S_E, linear in E, is a sum of products about
    /// it. Where a cell is too narrow for these differences, S(0, 1) alone is kept.
    pub(super) fn by_discs_between(&self, ends: [f64; 2], epsilon: f64) -> Option<Kind> {
        let (spectrum, change) = self.discs_between(ends, epsilon)?;
        match change {
            Some(change) => spectrum.certified_along(&change),
            None => spectrum.by_discs(),
        }
    }

    /// The discs of S in the middle of all stiffnesses within ε, and C: of the others S is within x C of
    /// these, |x| ≤ 1.
    fn discs_between(&self, [lo, hi]: [f64; 2], epsilon: f64) -> Option<(Spectrum, Option<Mat<f64>>)> {
        let middle = lo / 2.0 + hi / 2.0;
        let turning = self.turning(middle);
        let rounded = |step: f64| {
            let kicks = self.rounded_kicks(step, &turning);
            let (s, error) = product(&self.followed(&kicks, &turning, |_, _| ())?.blocks(Vec::new()));
            Some((s, error?))
        };
        let of = |step: f64| self.square(step) / self.square(middle);
        let (below, above) = (1.0 - of(lo), of(hi) - 1.0);
        let eta = 1.01 * below.max(above) + 8.0 * U;
        let is_narrow = below.min(above) < NARROW;
        let Near { s, off: s_off, terms, rest: [of_eta, of_errors, of_both] } =
            self.near(middle, &turning, eta, if is_narrow { 1 } else { 3 }, epsilon)?;
        let rest = s_off + of_eta + of_errors + of_both;
        if is_narrow {
            return Some((Spectrum::of(s, Some(1.01 * rest))?.with_terms(&terms)?, None));
        }
        let ((left, left_off), (right, right_off)) = (rounded(lo)?, rounded(hi)?);
        // Both ends' differences from the middle are S₁ η + S₂ η² within this.
        let known = left_off + right_off + 2.0 * s_off + 2.0 * of_eta;
        let bend = faer::Scale(below) * (&right - &s) + faer::Scale(above) * (&left - &s);
        let whole = below + above;
        let second = eta / below * (eta / above) * (norm::frobenius(&bend) / whole + known);
        let change = faer::Scale(1.01 * eta / whole) * (right - left);
        let first = eta / whole * known + (above - below).abs() / eta * second;
        let spectrum = Spectrum::of(s, Some(1.02 * (rest + first + second)))?;
        Some((spectrum.with_terms(&terms)?, Some(change)))
    }

    /// S at a step, and what is near it: see [`Steps::by_discs_between`]; of η what is of this order and
    /// beyond it is in the rest, |η| ≤ `eta`.
    fn near(&self, step: f64, turning: &Turning, eta: f64, order: i32, epsilon: f64) -> Option<Near> {
        let (n, kicks) = (self.nested.size(), self.kicks_at(step, turning));
        let errors = self.kick_errors(step, epsilon);
        let sizes: Vec<f64> = kicks.iter().map(norm::spectral).collect();
        let error = |k: usize| errors[k] / turning.least;
        let ratio = (0..sizes.len()).map(|k| sizes[k] / error(k)).fold(4e6, f64::min);
        let stiff = |(matrix, size): (Mat<f64>, &f64)| stiff(matrix, 0.0, 1.01 * size);
        let kicks: Vec<Stiff> = kicks.into_iter().zip(&sizes).map(stiff).collect();
        // What meets E at each event, and the positions there.
        let mut nodes: Vec<(f64, [Mat<f64>; 2])> = Vec::new();
        let state = self.followed(&kicks, turning, |event, x| {
            let weight = event.weight.share();
            let size = event.clocks().map(|k| weight * errors[k]).sum();
            let block = |first: usize| Mat::from_fn(n, n, |i, j| x[2 * n * i + first + j]);
            nodes.push((size, [block(0), block(n)]));
        })?;
        let blocks = state.blocks(Vec::new());
        // Kicks off by t of their sizes: by η alone, by E alone, or half by each, (1 + t/2) t/3 ≤ t/2.
        let rests = |t: f64| {
            let error = Some(state.error_within(t)?);
            let r = 1.01 * product(&FloatBlocks { error, ..blocks.clone() }).1?;
            let powers = |x: f64, order: i32| if x < 1.0 { x.powi(order) / (1.0 - x) } else { f64::INFINITY };
            let (x, y) = (eta / t, 1.0 / (t * ratio));
            Some(
                [powers(x, order), powers(y, 2), powers(2.0 * x, 1) * powers(3.0 * y, 1)]
                    .map(|value| r * value),
            )
        };
        let least = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k].min(b[k]));
        let rest = (0..16).filter_map(|k| rests(0.5f64.powi(k))).reduce(least)?;
        let (s, off) = product(&blocks);
        Some(Near { s, off: off?, terms: terms(&state, &nodes, &turning.roots), rest })
    }

    /// (A B) and (C D) of the half period, rounded, by products of whole matrices.
    fn rounded_half(&self, step: f64) -> [Mat<f64>; 2] {
        let (n, square) = (self.nested.size(), self.square(step));
        let one = |first: usize| Mat::from_fn(n, 2 * n, |i, j| f64::from(u8::from(j == first + i)));
        let (mut x, mut p) = (one(0), one(n));
        for event in &self.events {
            x += faer::Scale(event.drift as f64) * &p;
            let weight = event.weight.share();
            let kick = event.clocks().fold(Mat::<f64>::zeros(n, n), |sum, k| {
                sum + faer::Scale(weight * square * self.kicks[k]) * &self.nested.levels[k].stiffness
            });
            p -= kick * &x;
        }
        [x, p]
    }

    /// Values of s = 1 + μ between modes of one of Krein's signs and of the other, the sign that of vᵀ Aᵀ C
    /// v; `None` where some μ are off \[−1, 0\], or where signs change too often. Rounded: whatever they are,
    /// counts at them prove what they prove.
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
        let values = spectrum.shape(fastest, &vec![1.0; self.nested.size()]);
        let lifted = |part: fn(&Complex64) -> f64| -> Vec<f64> {
            let values: Vec<f64> = values.iter().map(part).collect();
            match &self.nested.basis {
                Some(basis) => combined(basis, &values),
                None => values,
            }
        };
        Some((rate, [lifted(|z| z.re), lifted(|z| z.im)]))
    }
}

/// S of F in doubles within `off`; what it moves by to first order in the errors of the stiffnesses; more
/// than the rest: of η alone, of the errors alone, of both.
struct Near {
    s: Mat<f64>,
    off: f64,
    terms: Vec<Term>,
    rest: [f64; 3],
}

/// Σ_j B_jᵀ E (B_j Aᵀ − A_j Bᵀ) C + Bᵀ (C B_jᵀ − D A_jᵀ) E A_j, E = D⁻¹ E_j D⁻¹ with the roots D, of the
/// nodes' sizes of E_j and positions (A_j B_j).
fn terms(state: &Propagated, nodes: &[(f64, [Mat<f64>; 2])], roots: &[f64]) -> Vec<Term> {
    let (n, h) = (roots.len(), state.matrix());
    let block = |i: usize, j: usize| h.submatrix(i * n, j * n, n, n);
    let (a, b, c, d) = (block(0, 0), block(0, 1), block(1, 0), block(1, 1));
    // Of true matrices within e and of norms up to g: those of products, and their roundings.
    let e = state.error_on_the_way();
    let g = nodes.iter().flat_map(|node| &node.1).map(norm::frobenius).fold(norm::frobenius(&h), f64::max);
    let (gamma, least) = (gamma(n), roots.iter().fold(f64::INFINITY, |a: f64, x| a.min(*x)));
    let once = 1.01 * (e + U * g) / least;
    let twice = 4.0 * g * e + 2.0 * e * e + 3.0 * gamma * g * g;
    let thrice = 1.01 * (twice * (g + e) + 2.0 * g * g * e + 4.0 * gamma * g * g * g) / least;
    let columns = |m: Mat<f64>| Mat::from_fn(n, n, |i, j| m[(i, j)] / roots[j]);
    let rows = |m: Mat<f64>| Mat::from_fn(n, n, |i, j| m[(i, j)] / roots[i]);
    let term = |(size, [x, y]): &(f64, [Mat<f64>; 2])| {
        let first = [columns(y.transpose().to_owned()), rows((y * a.transpose() - x * b.transpose()) * c)];
        let second = [columns(b.transpose() * (c * y.transpose() - d * x.transpose())), rows(x.clone())];
        [(first, [once, thrice]), (second, [thrice, once])].map(|(sides, off)| Term {
            size: *size,
            sides,
            off,
        })
    };
    nodes.iter().flat_map(term).collect()
}

/// Where cells are narrower, relatively, four roundings are not far below their width.
const NARROW: f64 = 1e-10;

/// A kick in doubles, off by its roundings, too.
fn stiff(kick: Mat<f64>, error: f64, known: f64) -> Stiff {
    let off = error + ROUNDINGS as f64 * U * norm::frobenius(&kick);
    Stiff { stiffness: Stiffness::Whole(kick), off, known }
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use nalgebra::DMatrix;

    use super::*;
    use crate::levels::search::Search;
    use crate::levels::{Hessians, Nested};
    use crate::numbers::Numbers;
    use number::ratio;

    fn symmetric(numbers: &mut Numbers, n: usize) -> DMatrix<f64> {
        let g = DMatrix::from_fn(n, n, |_, _| numbers.signed());
        (&g + g.transpose()) / 2.0
    }

    fn size(k: &DMatrix<f64>) -> f64 {
        k.clone().symmetric_eigen().eigenvalues.amax()
    }

    /// Hundreds of errors of the stiffnesses as large as the accuracy: no row of V⁻¹ S V − D is longer than
    /// the discs say, and none is so by far. Errors of rank 1 that pull at one mode come nearest to it.
    #[test]
    fn no_error_of_the_data_within_the_accuracy_leaves_the_discs() {
        let (n, epsilon, mut numbers) = (6, 1e-6, Numbers(7));
        let steps = [ratio(1, 4), ratio(1, 2), ratio(1, 1)];
        let mut nearest = 0.0_f64;
        for _ in 0..4 {
            let squares = [1.0, 0.1, 0.04].map(|value| {
                let g = symmetric(&mut numbers, n);
                let k = &g * &g;
                &k * (value / size(&k))
            });
            let whole = Hessians::new(&squares[0], &(&squares[1] + &squares[2]), epsilon).unwrap();
            let nested = Nested::new(&whole, &squares.each_ref().map(|k| vec![k.clone()])).unwrap();
            let own = nested.at(&steps).unwrap();
            let first = own.first_unstable().unwrap().0;
            for step in [0.7, 1.3, 1.9, 2.6].map(|factor| factor * first) {
                let (spectrum, change) = own.discs_between([step; 2], epsilon).unwrap();
                assert!(change.is_none());
                let turning = own.turning(step);
                for trial in 0..60 {
                    let mut modes = nested.modes_of_all().clone();
                    for (k, square) in squares.iter().enumerate() {
                        let e = match trial % 2 {
                            0 => symmetric(&mut numbers, n),
                            _ => DMatrix::from_fn(n, n, |i, j| {
                                f64::from(u8::from(i == j && i == trial / 2 % n))
                            }),
                        };
                        let e = &e * (epsilon * size(square) / size(&e));
                        modes.stiffnesses[k].0 += Mat::from_fn(n, n, |i, j| e[(i, j)]);
                    }
                    let moved = Nested { modes_of_all: OnceLock::from(modes), ..nested.clone() };
                    let moved = moved.at(&steps).unwrap();
                    let kicks = moved.rounded_kicks(step, &turning);
                    let blocks = moved.followed(&kicks, &turning, |_, _| ()).unwrap().blocks(Vec::new());
                    for part in spectrum.lengths_of(&product(&blocks).0) {
                        assert!(part <= 1.0, "{step}: {part}");
                        nearest = nearest.max(part);
                    }
                }
            }
        }
        assert!(nearest > 0.2, "{nearest}");
    }
}
