//! Eigenvalues of S = Bᵀ C in doubles, each with a disc that is proven to hold it.
//!
//! For the computed eigenvectors V, an approximate inverse W of V, and D the computed eigenvalues,
//! V⁻¹ S V = D + (I − Y)⁻¹ W (S V − V D) with Y = I − W V. Gershgorin's discs of that matrix hold the
//! eigenvalues, as many in each connected component as it has discs. Since S is real, an isolated disc about a
//! real number holds one real eigenvalue. So
//!
//! * a component of discs that does not meet the segment [−1, 0] proves instability;
//! * isolated discs about real numbers, all inside (−1, 0), prove stability: all multipliers are distinct and lie
//!   on the unit circle.
//!
//! Double eigenvalues, of symmetric systems say, are beyond it: they need exact arithmetic.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, c64};

use super::float::FloatBlocks;
use crate::verdict::Kind;

const U: f64 = f64::EPSILON / 2.0;

/// The eigenvalues μ of Bᵀ C with their vectors.
#[derive(Clone, Debug)]
pub(super) struct Spectrum {
    pub mu: Vec<c64>,
    /// The radius of the disc about each; `None` where the bound's conditions fail.
    pub radii: Option<Vec<f64>>,
    /// One column for each, in the coordinates of [`FloatBlocks`].
    pub vectors: Mat<c64>,
}

impl Spectrum {
    /// `None` where the eigenvalue iteration fails: never seen, but not excluded.
    pub fn new(blocks: &FloatBlocks) -> Option<Spectrum> {
        let m = blocks.m;
        let b = Mat::from_fn(m, m, |i, j| blocks.y[i][m + j]);
        let c = Mat::from_fn(m, m, |i, j| blocks.p[i][j]);
        let s = b.transpose() * &c;
        let eigen = s.eigen().ok()?;
        let mu: Vec<c64> = (0..m).map(|i| eigen.S()[i]).collect();
        let vectors = eigen.U().to_owned();
        let finite = mu.iter().all(|z| z.re.is_finite() && z.im.is_finite());
        let radii = blocks.error.filter(|_| finite).and_then(|e| {
            let (nb, nc) = (norm(&b), norm(&c));
            let delta = e * (nb + nc + e) + gamma(m) * nb * nc;
            radii(&s, delta, &mu, &vectors)
        });
        finite.then_some(Spectrum { mu, radii, vectors })
    }

    /// What the discs prove, if anything.
    pub fn certified(&self) -> Option<Kind> {
        let radii = self.radii.as_ref()?;
        let components = components(&self.mu, radii);
        let off = |component: &Vec<usize>| component.iter().all(|&i| from_segment(self.mu[i]) > 1.01 * radii[i]);
        if components.iter().any(off) {
            return Some(Kind::Hyperbolic);
        }
        let inside = |component: &Vec<usize>| match component.as_slice() {
            [i] => {
                let (z, r) = (self.mu[*i], 1.01 * radii[*i]);
                z.im == 0.0 && z.re + r < 0.0 && z.re - r > -1.0
            }
            _ => false,
        };
        components.iter().all(inside).then_some(Kind::Elliptic)
    }
}

/// The distance from the segment [−1, 0], rounded.
pub(super) fn from_segment(z: c64) -> f64 {
    let nearest = z.re.clamp(-1.0, 0.0);
    (z.re - nearest).hypot(z.im)
}

/// γ: a product of m terms, complex or real, in any order, has a relative error of at most this.
fn gamma(m: usize) -> f64 {
    4.0 * (m as f64 + 4.0) * U
}

fn radii(s: &Mat<f64>, delta: f64, mu: &[c64], v: &Mat<c64>) -> Option<Vec<f64>> {
    let (m, root) = (mu.len(), (mu.len() as f64).sqrt());
    let w = v.partial_piv_lu().inverse();
    let s_complex = Mat::from_fn(m, m, |i, j| c64::new(s[(i, j)], 0.0));
    let vd = Mat::from_fn(m, m, |i, j| v[(i, j)] * mu[j]);
    let residual = &s_complex * v - &vd;
    let (ns, nv, nw) = (norm(s), complex_norm(v), complex_norm(&w));
    // What the residual may be off by, S itself included.
    let off = gamma(m) * (ns * nv + complex_norm(&vd)) + delta * nv;
    let identity = &w * v;
    let y = Mat::from_fn(m, m, |i, j| c64::new(f64::from(u8::from(i == j)), 0.0) - identity[(i, j)]);
    let y = root * (complex_norm(&y) + gamma(m) * (nw * nv + root));
    if y.is_nan() || y >= 0.5 {
        return None;
    }
    let image = &w * &residual;
    let slack = gamma(m) * complex_norm(&residual) + off;
    let row = |i: usize| {
        let length = (0..m).map(|j| w[(i, j)].norm_sqr()).sum::<f64>().sqrt();
        (0..m).map(|j| image[(i, j)].norm()).sum::<f64>() + root * 1.01 * length * slack
    };
    let rows: Vec<f64> = (0..m).map(row).collect();
    let spread = y / (1.0 - y) * rows.iter().copied().fold(0.0, f64::max);
    // 1.01: the roundings of these sums of fewer than 10^6 terms.
    let radii: Vec<f64> = rows.iter().map(|r| 1.01 * (r + spread)).collect();
    radii.iter().all(|r| r.is_finite()).then_some(radii)
}

/// Frobenius's norm, rounded up by more than its rounding errors.
fn norm(m: &Mat<f64>) -> f64 {
    let squares = (0..m.ncols()).flat_map(|j| (0..m.nrows()).map(move |i| m[(i, j)] * m[(i, j)]));
    1.01 * squares.sum::<f64>().sqrt()
}

fn complex_norm(m: &Mat<c64>) -> f64 {
    let squares = (0..m.ncols()).flat_map(|j| (0..m.nrows()).map(move |i| m[(i, j)].norm_sqr()));
    1.01 * squares.sum::<f64>().sqrt()
}

/// The connected components of the union of the discs, in the order of the real parts of their centres.
fn components(mu: &[c64], radii: &[f64]) -> Vec<Vec<usize>> {
    let mut open: Vec<usize> = (0..mu.len()).collect();
    let mut components = Vec::new();
    while let Some(first) = open.pop() {
        let (mut component, mut next) = (vec![first], 0);
        while let Some(&i) = component.get(next) {
            next += 1;
            let meets = |j: &usize| (mu[i] - mu[*j]).norm() <= 1.01 * (radii[i] + radii[*j]);
            let (joined, rest) = open.into_iter().partition::<Vec<_>, _>(|j| meets(j));
            component.extend(joined);
            open = rest;
        }
        components.push(component);
    }
    components
}
