//! Eigenvalues of S = Bᵀ C in doubles, each with a disc that is proven to hold it.
//!
//! For the computed eigenvectors V (Re v and Im v of pairs), an approximate inverse W of V, and D the
//! computed eigenvalues (real 2 x 2 blocks for pairs, so that D is normal), V⁻¹ S V = D + F, F = (I − Y)⁻¹ W
//! (S V − V D) with Y = I − W V. The discs of radius ‖F‖₂ about the entries of D hold the eigenvalues (Bauer
//! and Fike), as many in each connected component as it has discs, since no eigenvalue of D + tF leaves them
//! for 0 ≤ t ≤ 1. Since S is real, an isolated disc about a real number holds one real eigenvalue. So
//!
//! * a component of discs that does not meet the segment [−1, 0] proves instability;
//! * isolated discs about real numbers, all inside (−1, 0), prove stability: all multipliers are distinct and
//!   lie on the unit circle.
//!
//! Multiple eigenvalues, of symmetric systems say, are taken together in
//! [`clusters`](crate::spectrum::clusters).

use faer::linalg::solvers::Solve;
use faer::{Mat, Scale, c64};

use crate::half::float::FloatBlocks;
use crate::half::norm;
use crate::spectrum::bauer_fike::{Residual, Term, bauer_fike};
use crate::spectrum::clusters::{self, Pencil};
use crate::spectrum::rate;
use crate::spectrum::rate::Multiplier;
use clocks::verdict::Kind;
use number::U;

/// The eigenvalues μ of Bᵀ C with their vectors.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    pub mu: Vec<c64>,
    /// The bounds on F; `None` where their conditions fail.
    residual: Option<Residual>,
    /// One column for each, in the coordinates of [`FloatBlocks`].
    pub vectors: Mat<c64>,
    /// S, and how far the true one can be.
    s: Mat<f64>,
    s_error: Option<f64>,
}

impl Spectrum {
    /// The spectrum of the half period; `None` where the eigenvalue iteration fails: never seen, but not
    /// excluded.
    pub fn new(blocks: &FloatBlocks) -> Option<Spectrum> {
        let (s, s_error) = product(blocks);
        Spectrum::of(s, s_error)
    }

    /// The i-th solution's positions, from coordinates that are scaled by `scales`.
    pub fn shape(&self, i: usize, scales: &[f64]) -> Vec<c64> {
        scales.iter().enumerate().map(|(k, scale)| self.vectors[(k, i)] / scale).collect()
    }

    /// The spectrum of S, which is within `s_error` (2-norm) of the true one; `None` as of [`Spectrum::new`].
    pub fn of(s: Mat<f64>, s_error: Option<f64>) -> Option<Spectrum> {
        let m = s.nrows();
        if (0..m).any(|j| (0..m).any(|i| !s[(i, j)].is_finite())) {
            return None;
        }
        let eigen = s.eigen().ok()?;
        let mu: Vec<c64> = (0..m).map(|i| eigen.S()[i]).collect();
        let vectors = improved(&s, &mu, eigen.U().to_owned());
        Spectrum::with(s, s_error, mu, vectors)
    }

    /// The discs where eigenvalues and vectors are known, rounded.
    pub fn with(s: Mat<f64>, s_error: Option<f64>, mu: Vec<c64>, vectors: Mat<c64>) -> Option<Spectrum> {
        let finite = mu.iter().all(|z| z.re.is_finite() && z.im.is_finite());
        let residual = s_error.filter(|_| finite).and_then(|delta| residual(&s, delta, &mu, &vectors));
        finite.then_some(Spectrum { mu, residual, vectors, s, s_error })
    }

    /// The radius of the discs, but for rounding; `None` where there are none.
    pub fn radius(&self) -> Option<f64> {
        self.residual.as_ref().map(|residual| residual.norm)
    }

    /// The discs for matrices within another distance of S.
    pub fn with_error(&self, s_error: f64) -> Option<Spectrum> {
        let residual = Some(residual(&self.s, s_error, &self.mu, &self.vectors)?);
        Some(Spectrum { residual, s_error: Some(s_error), ..self.clone() })
    }

    /// The discs where the half period is known as well as these blocks, which differ from its own in their
    /// error alone. There are none where the error of the blocks is unbounded.
    pub fn known_to(&self, blocks: &FloatBlocks) -> Spectrum {
        let found = product(blocks).1.and_then(|error| self.with_error(error));
        found.unwrap_or_else(|| Spectrum { residual: None, s_error: None, ..self.clone() })
    }

    /// Every multiplier with an enclosure of its growth: that of all discs which meet its own, and of the
    /// largest one no more than the rows of F allow.
    pub fn multipliers(&self) -> Vec<Multiplier> {
        let Some(Residual { norm, rows }) = &self.residual else {
            return self.mu.iter().map(|&mu| Multiplier::new(mu, None, None)).collect();
        };
        let radius = 1.01 * norm;
        let pairs: Vec<_> = self.mu.iter().map(|&mu| rate::about(mu, radius)).collect();
        let above = self.largest_growth(rows);
        let mut growth = pairs.clone();
        for component in components(&self.mu, radius) {
            let lo = component.iter().map(|&i| pairs[i].0).fold(f64::INFINITY, f64::min);
            let hi = component.iter().map(|&i| pairs[i].1).fold(0.0, f64::max);
            component.iter().for_each(|&i| growth[i] = (lo, hi.min(above)));
        }
        let multiplier = |(&mu, growth)| Multiplier::new(mu, Some(*norm), Some(growth));
        self.mu.iter().zip(growth).map(multiplier).collect()
    }

    /// No ln |λ| is larger: as (D − z) y = −F y has |d_j − z| |y_j| ≤ ρ_j, each eigenvalue z is within √m ρ_j
    /// of some d_j.
    fn largest_growth(&self, rows: &[f64]) -> f64 {
        let root = (self.mu.len() as f64).sqrt();
        let of = |(&mu, row): (&c64, &f64)| rate::about(mu, 1.01 * root * row).1;
        self.mu.iter().zip(rows).map(of).fold(0.0, f64::max)
    }

    /// The kind that the discs of all S' with |S' − S| ≤ `off`, entry by entry, prove, if any.
    pub fn certified_around(&self, off: &Mat<f64>) -> Option<Kind> {
        self.with_residual(|residual, v| residual.widened(v, off))?.by_discs()
    }

    /// The kind that the discs of all S + x C, |x| ≤ 1, prove, if any.
    pub fn certified_along(&self, change: &Mat<f64>) -> Option<Kind> {
        self.with_residual(|residual, v| residual.along(v, change))?.by_discs()
    }

    /// The discs of all S + Σ L E R, too.
    pub fn with_terms(&self, terms: &[Term]) -> Option<Spectrum> {
        self.with_residual(|residual, v| residual.with_terms(v, terms))
    }

    /// The rows of V⁻¹ S' V − D for another S', in parts of their bounds.
    #[cfg(test)]
    pub fn lengths_of(&self, other: &Mat<f64>) -> Vec<f64> {
        use faer::linalg::solvers::DenseSolveCore;
        let (v, d) = real_form(&self.mu, &self.vectors).unwrap();
        let f = v.partial_piv_lu().inverse() * other * &v - d;
        let length = |i: usize| (0..v.ncols()).map(|j| f[(i, j)] * f[(i, j)]).sum::<f64>().sqrt();
        let rows = self.residual.iter().flat_map(|residual| &residual.rows);
        rows.enumerate().map(|(i, row)| length(i) / row).collect()
    }

    /// The discs with other bounds, made of the own ones and of V.
    fn with_residual(&self, of: impl FnOnce(&Residual, &Mat<f64>) -> Option<Residual>) -> Option<Spectrum> {
        let residual = Some(of(self.residual.as_ref()?, &real_form(&self.mu, &self.vectors)?.0)?);
        Some(Spectrum { residual, ..self.clone() })
    }

    /// The kind that the discs or the clusters prove, if any.
    pub fn certified(&self, blocks: &FloatBlocks) -> Option<Kind> {
        self.certified_with(|| times_c(blocks, &blocks.matrices[0]))
    }

    /// As [`Spectrum::certified`], with Y = Aᵀ C and a bound on its error (2-norm), which only clusters ask
    /// for.
    pub fn certified_with(&self, form: impl FnOnce() -> (Mat<f64>, Option<f64>)) -> Option<Kind> {
        self.by_discs().or_else(|| self.by_clusters(form()).then_some(Kind::Elliptic))
    }

    fn by_clusters(&self, (y, y_error): (Mat<f64>, Option<f64>)) -> bool {
        let (Some(s_error), Some(y_error)) = (self.s_error, y_error) else { return false };
        clusters::are_stable(&Pencil { s: &self.s, s_error, y: &y, y_error }, &self.mu, &self.vectors)
    }

    /// The kind that the discs prove, if any.
    pub fn by_discs(&self) -> Option<Kind> {
        let Residual { norm, rows } = self.residual.as_ref()?;
        let radius = 1.01 * norm;
        let components = components(&self.mu, radius);
        let off = |component: &Vec<usize>| component.iter().all(|&i| from_segment(self.mu[i]) > radius);
        if components.iter().any(off) || (0..self.mu.len()).any(|i| self.is_encircled(i, rows)) {
            return Some(Kind::Hyperbolic);
        }
        // Real, within (−1, 0) and simple.
        let inside = |component: &&Vec<usize>| match component.as_slice() {
            [i] => {
                let z = self.mu[*i];
                z.im == 0.0 && z.re + radius < 0.0 && z.re - radius > -1.0
            }
            _ => false,
        };
        // Up to the first: circles about all of them cost as much as the products where matrices are small.
        let mut untold = components
            .iter()
            .filter(|component| !inside(component))
            .flatten()
            .filter(|&&i| !self.is_alone(i, rows));
        untold.next().is_none().then_some(Kind::Elliptic)
    }

    /// Whether some circle about a real μ_i, within (−1, 0) and at most half as wide as the nearest other μ
    /// is far, is free of eigenvalues as in [`Spectrum::is_encircled`]: one eigenvalue of S is in it, real,
    /// and in no other such circle.
    fn is_alone(&self, i: usize, rows: &[f64]) -> bool {
        let z = self.mu[i];
        let others =
            self.mu.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| (other - z).norm() / 2.0);
        let room = 0.99 * others.fold((-z.re).min(1.0 + z.re), f64::min);
        z.im == 0.0 && room > 0.0 && self.is_free(i, room, rows)
    }

    /// Whether some circle about μ_i that does not meet \[−1, 0\] is free of eigenvalues of D + tF, 0 ≤ t ≤
    /// 1, so that it holds as many of S as of D.
    ///
    /// (D − z) y = −F y with |y| = 1 gives |d_j − z| |y_j| ≤ ρ_j, so an eigenvalue z has Σ (ρ_j/|d_j − z|)² ≥
    /// 1 (for both rows of a conjugate pair the nearer of the two). Rows differ where some eigenvectors are
    /// nearly dependent: those that are not keep their small discs. The radii tried go down by fifths, to a
    /// hundredth of the distance.
    fn is_encircled(&self, i: usize, rows: &[f64]) -> bool {
        let off = 0.99 * from_segment(self.mu[i]);
        rows[i] < off && self.is_free(i, off, rows)
    }

    /// Whether one of some circles about μ_i, of at most this radius, holds no eigenvalue of D + tF.
    fn is_free(&self, i: usize, largest: f64, rows: &[f64]) -> bool {
        let distances = |z: &c64| {
            let own = (z - self.mu[i]).norm();
            [own, if z.im == 0.0 { own } else { (z.conj() - self.mu[i]).norm() }]
        };
        let all: Vec<_> = self.mu.iter().map(distances).zip(rows).collect();
        let escape = |radius: f64| {
            let term = |([value, other], row): &([f64; 2], &f64)| {
                (*row / (value - radius).abs().min((other - radius).abs())).powi(2)
            };
            all.iter().map(term).sum::<f64>() < 0.99
        };
        (0..20).map(|k| largest * 0.8f64.powi(k)).any(escape)
    }
}

/// S = Bᵀ C of the half period, and a bound on its distance from the true one.
pub fn product(blocks: &FloatBlocks) -> (Mat<f64>, Option<f64>) {
    times_c(blocks, &blocks.matrices[1])
}

/// Zᵀ C for a block Z of the half period, and a bound on its distance from the true one.
fn times_c(blocks: &FloatBlocks, z: &Mat<f64>) -> (Mat<f64>, Option<f64>) {
    let (m, [_, _, c, _]) = (blocks.size(), &blocks.matrices);
    // In the 2-norm that of |Z| and |C|, too.
    let [size_z, size_c] = [z, c].map(norm::absolute);
    let error = blocks.error.map(|e| {
        // The rounding of the product: (m + 2) u |Z|ᵀ |C|.
        let rounding = 1.01 * (m as f64 + 2.0) * U * size_z * size_c;
        e * (size_z.min(blocks.norm) + size_c.min(blocks.norm) + e) + rounding
    });
    (z.transpose() * c, error)
}

/// The distance from the segment [−1, 0], rounded.
pub(crate) fn from_segment(z: c64) -> f64 {
    let nearest = z.re.clamp(-1.0, 0.0);
    (z.re - nearest).hypot(z.im)
}

/// Eigenvectors as real columns, Re v and Im v for a conjugate pair, and the real normal D with S V ≈ V D:
/// the numbers themselves and the blocks ((a, b), (−b, a)).
pub(crate) fn real_form(mu: &[c64], v: &Mat<c64>) -> Option<(Mat<f64>, Mat<f64>)> {
    let m = mu.len();
    let (mut real, mut d) = (Mat::<f64>::zeros(m, m), Mat::<f64>::zeros(m, m));
    let mut k = 0;
    while k < m {
        d[(k, k)] = mu[k].re;
        (0..m).for_each(|i| real[(i, k)] = v[(i, k)].re);
        if mu[k].im != 0.0 {
            // Pairs stand side by side.
            mu.get(k + 1).filter(|next| **next == mu[k].conj())?;
            (0..m).for_each(|i| real[(i, k + 1)] = v[(i, k)].im);
            d[(k + 1, k + 1)] = mu[k].re;
            (d[(k, k + 1)], d[(k + 1, k)]) = (mu[k].im, -mu[k].im);
            k += 1;
        }
        k += 1;
    }
    Some((real, d))
}

/// Up to this many times m u ‖S‖, what S v − μ v is comes from rounding.
const ROUNDED: f64 = 1e3;

/// Eigenvectors improved: their factorizations cost no more than the eigenvalues.
const MOST_IMPROVED: usize = 16;

/// Two steps of inverse iteration for each complex eigenvector that is off by more than rounding: where two
/// pairs nearly meet, as in symmetric systems, faer's S v − μ v was seen to be 4e-3. The shift is off the
/// eigenvalue by m u ‖S‖: it favours all of a cluster alike, so that independent vectors stay independent.
/// Nothing rests on this: the bound on F takes whatever vectors come.
fn improved(s: &Mat<f64>, mu: &[c64], mut vectors: Mat<c64>) -> Mat<c64> {
    let (m, off) = (s.nrows(), s.nrows() as f64 * U * norm::frobenius(s));
    let s = Mat::from_fn(m, m, |i, j| c64::new(s[(i, j)], 0.0));
    let residual = |z: c64, v: &Mat<c64>| (&s * v - v * Scale(z)).norm_l2();
    let column = |vectors: &Mat<c64>, k: usize| vectors.subcols(k, 1).to_owned();
    let is_pair = |k: &usize| mu[*k].im > 0.0 && mu.get(k + 1) == Some(&mu[*k].conj());
    let is_rough = |k: &usize| residual(mu[*k], &column(&vectors, *k)) > ROUNDED * off;
    let rough: Vec<usize> = (0..m).filter(is_pair).filter(is_rough).take(MOST_IMPROVED).collect();
    for k in rough {
        let (z, matrix) = (mu[k], column(&vectors, k));
        let before = residual(z, &matrix);
        let shifted = Mat::from_fn(m, m, |i, j| if i == j { s[(i, j)] - z - off } else { s[(i, j)] });
        let factors = shifted.partial_piv_lu();
        let step = |v: Mat<c64>| {
            let next = factors.solve(&v);
            let size = c64::new(1.0 / next.norm_l2(), 0.0);
            next * Scale(size)
        };
        let next = step(step(matrix));
        if residual(z, &next) < before {
            (0..m).for_each(|i| {
                (vectors[(i, k)], vectors[(i, k + 1)]) = (next[(i, 0)], next[(i, 0)].conj());
            });
        }
    }
    vectors
}

/// Bounds on F with the computed eigenvectors; see [`bauer_fike`].
pub(crate) fn residual(s: &Mat<f64>, delta: f64, mu: &[c64], v: &Mat<c64>) -> Option<Residual> {
    let (v, d) = real_form(mu, v)?;
    bauer_fike(s, delta, &v, &d)
}

/// The connected components of the union of the discs of one radius.
pub(crate) fn components(mu: &[c64], radius: f64) -> Vec<Vec<usize>> {
    let mut open: Vec<usize> = (0..mu.len()).collect();
    let mut components = Vec::new();
    while let Some(first) = open.pop() {
        let (mut component, mut next) = (vec![first], 0);
        while let Some(&i) = component.get(next) {
            next += 1;
            let meets = |j: &usize| (mu[i] - mu[*j]).norm() <= 2.01 * radius;
            let (joined, rest) = open.into_iter().partition::<Vec<_>, _>(meets);
            component.extend(joined);
            open = rest;
        }
        components.push(component);
    }
    components
}
