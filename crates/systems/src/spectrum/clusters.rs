//! Stability in doubles where eigenvalues of S are multiple, as in every symmetric system.
//!
//! S = Bᵀ C is self-adjoint for the symmetric form Y = Aᵀ C (A Bᵀ is symmetric, so Sᵀ Y = Cᵀ (B Aᵀ) C is).
//! Let the eigenvalues fall into clusters about means d_c, orthonormal bases of the computed eigenvectors of
//! each side by side in V, D the means, V⁻¹ S V = D + F with ‖F‖₂ ≤ r as in
//! [`spectrum`](crate::spectrum::discs). For a cluster of k at the distance δ from all others
//!
//! * the columns V (I, P)ᵀ, ‖P‖_F ≤ p = 2 √k r/(δ − 2r), span an invariant subspace if √k r² < (δ − 2r)²/4
//!   (Stewart 1973; D is normal, so the separation in Frobenius's norm is δ), and with δ > r (2 + p) it is
//!   that of the k eigenvalues in the cluster's disc;
//! * on it the form is that of (Vᵀ Y V)_cc up to ‖Vᵀ Y V‖ (2p + p²). If that is definite, S is self-adjoint
//!   there in an inner product: its k eigenvalues are real and semisimple, and with the disc inside (−1, 0)
//!   stable.
//!
//! The sign of the form is Krein's: clusters of one sign cannot be driven off the unit circle, however close.
//! A cluster of both signs is left to exact arithmetic.

use faer::{Mat, c64};

use crate::half::norm;
use crate::signs::inertia;
use crate::spectrum::bauer_fike::{bauer_fike, gamma};
use number::U;

/// The matrices that decide, as computed, and how far from them the true ones can be.
pub(crate) struct Pencil<'a> {
    pub s: &'a Mat<f64>,
    pub s_error: f64,
    pub y: &'a Mat<f64>,
    pub y_error: f64,
}

/// A run of eigenvalues by increasing size: columns of V from `first`, `size` of them, about `mean`.
struct Cluster {
    first: usize,
    size: usize,
    mean: f64,
}

/// How close, relative to the largest entry of D, eigenvalues are taken together; from nothing but roundoff
/// to far beyond what a well-conditioned double eigenvalue splits into.
const CLOSE: [f64; 3] = [1e-13, 1e-11, 1e-9];

/// Whether all eigenvalues are proven to be real, semisimple and in (−1, 0).
pub(crate) fn are_stable(pencil: &Pencil, mu: &[c64], vectors: &Mat<c64>) -> bool {
    let size = mu.iter().fold(1.0, |a: f64, z| a.max(z.norm()));
    CLOSE.iter().any(|close| by_clusters(pencil, mu, vectors, close * size).unwrap_or(false))
}

fn by_clusters(pencil: &Pencil, mu: &[c64], vectors: &Mat<c64>, close: f64) -> Option<bool> {
    if mu.iter().any(|z| z.im.abs() > close) {
        return Some(false);
    }
    let mut order: Vec<usize> = (0..mu.len()).collect();
    order.sort_by(|&i, &j| mu[i].re.total_cmp(&mu[j].re).then(mu[i].im.total_cmp(&mu[j].im)));
    let clusters = clusters(mu, &order, close);
    let v = bases(mu, vectors, &order, &clusters)?;
    let m = mu.len();
    let mut d = Mat::<f64>::zeros(m, m);
    for cluster in &clusters {
        (cluster.first..cluster.first + cluster.size).for_each(|k| d[(k, k)] = cluster.mean);
    }
    let r = 1.01 * bauer_fike(pencil.s, pencil.s_error, &v, &d)?.norm;
    let inside = |c: &Cluster| c.mean + r < 0.0 && c.mean - r > -1.0;
    if !clusters.iter().all(inside) {
        return Some(false);
    }
    let form = Form::new(pencil, &v);
    let certain = |(n, cluster): (usize, &Cluster)| {
        let neighbour =
            |other: Option<&Cluster>| other.map_or(f64::INFINITY, |o| (o.mean - cluster.mean).abs());
        let before = n.checked_sub(1).and_then(|n| clusters.get(n));
        let gap = 0.999 * neighbour(before).min(neighbour(clusters.get(n + 1)));
        is_certain(cluster, gap, r, &form)
    };
    Some(clusters.iter().enumerate().all(certain))
}

fn clusters(mu: &[c64], order: &[usize], close: f64) -> Vec<Cluster> {
    let mut clusters: Vec<Cluster> = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let joins = place > 0 && mu[i].re - mu[order[place - 1]].re <= close;
        match clusters.last_mut().filter(|_| joins) {
            Some(last) => {
                last.mean += (mu[i].re - last.mean) / (last.size + 1) as f64;
                last.size += 1;
            }
            None => clusters.push(Cluster { first: place, size: 1, mean: mu[i].re }),
        }
    }
    clusters
}

/// For each cluster an orthonormal basis of the space of its computed eigenvectors; `None` where they are
/// dependent.
fn bases(mu: &[c64], vectors: &Mat<c64>, order: &[usize], clusters: &[Cluster]) -> Option<Mat<f64>> {
    let m = mu.len();
    let mut v = Mat::<f64>::zeros(m, m);
    for cluster in clusters {
        for place in cluster.first..cluster.first + cluster.size {
            let i = order[place];
            // Re v stands for one of a pair, Im v for the other.
            let part = |z: c64| if mu[i].im < 0.0 { z.im } else { z.re };
            let mut column: Vec<f64> = (0..m).map(|k| part(vectors[(k, i)])).collect();
            let length = |c: &[f64]| c.iter().map(|x| x * x).sum::<f64>().sqrt();
            let before = length(&column);
            // Twice is enough (Kahan, Parlett).
            for _ in 0..2 {
                for other in cluster.first..place {
                    let along: f64 = (0..m).map(|k| column[k] * v[(k, other)]).sum();
                    (0..m).for_each(|k| column[k] -= along * v[(k, other)]);
                }
            }
            let after = length(&column);
            if after.is_nan() || after <= 1e-6 * before {
                return None;
            }
            (0..m).for_each(|k| v[(k, place)] = column[k] / after);
        }
    }
    Some(v)
}

/// Vᵀ Y V with a bound on its norm and on the error of its entries together.
struct Form {
    k: Mat<f64>,
    norm: f64,
    error: f64,
}

impl Form {
    fn new(pencil: &Pencil, v: &Mat<f64>) -> Form {
        let m = v.ncols();
        let k = v.transpose() * pencil.y * v;
        let (nv, ny) = (norm::frobenius(v), norm::frobenius(pencil.y));
        let error = norm::spectral(v).powi(2) * pencil.y_error + 2.1 * gamma(m) * nv * nv * ny;
        let norm = norm::spectral(&k) + error;
        Form { k, norm, error: 1.01 * error }
    }
}

fn is_certain(cluster: &Cluster, gap: f64, r: f64, form: &Form) -> bool {
    let root = (cluster.size as f64).sqrt();
    let room = gap - 2.0 * r;
    if cluster.size == 1 {
        // A real matrix has a real eigenvalue in an isolated disc about a real number.
        return room > 0.0;
    }
    let p = if gap.is_finite() { 2.02 * root * r / room } else { 0.0 };
    let invariant =
        !gap.is_finite() || (room > 0.0 && 4.1 * root * r * r < room * room && gap > r * (2.0 + p));
    invariant && is_definite(cluster, form, form.error + form.norm * (2.0 * p + p * p))
}

/// Whether every matrix within `slack` (2-norm) of the cluster's block is definite.
fn is_definite(cluster: &Cluster, form: &Form, slack: f64) -> bool {
    let k = cluster.size;
    let at = |i: usize, j: usize| form.k[(cluster.first + i, cluster.first + j)];
    let block = Mat::from_fn(k, k, |i, j| (at(i, j) + at(j, i)) / 2.0);
    inertia::proven(&block, 1.01 * slack + U * norm::frobenius(&block)).definite() != 0
}
