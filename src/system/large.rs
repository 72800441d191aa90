//! Large sparse systems: signs of two forms by Cholesky, and the modes that grow by a Krylov space of the period.
//!
//! All eigenvalues of n degrees of freedom cost 25 n³ and are asked for by nobody where n is in the thousands. The forms
//! P = A Bᵀ and R = −C Dᵀ of the half period cost two products and two factorizations. If both are positive definite, so it is
//! stable. Else let v be the positions of a real mode of the period with the multiplier λ, μ = (λ + 1/λ − 2)/4. Then
//!
//! ```text
//!     (C v)ᵀ P (C v) = μ ζ,     (A v)ᵀ R (A v) = −(1 + μ) ζ,     ζ = vᵀ Aᵀ C v,
//! ```
//!
//! (from Bᵀ C v = μ v and Dᵀ A v = (1 + μ) v), so outside \[−1, 0\] one of them is negative where the other form is
//! positive definite: a number, computed with a bound, that proves instability whatever v is. A few thousand
//! sparse periods find v.

use faer::Mat;
use faer::c64;

use super::analysis::{Evidence, Instability, Multiplier, Part};
use super::compose::{Program, Row, State};
use super::float::{self, FloatBlocks, scaled_program};
use super::frame::Frame;
use super::inertia::is_definite;
use super::model::System;
use super::modes::Origin;
use super::norm;
use crate::number::rational::to_f64;
use crate::number::{Laurent, U};
use crate::schedule::Weight;
use crate::verdict::Kind;

/// From so many degrees of freedom on.
pub(super) const LARGE: usize = 600;

/// What is left out of the answer.
pub(super) const NOTE: &str =
    "of so many degrees of freedom only the multiplier that grows fastest is computed, if any does";

/// Periods of one power iteration, dimensions of a Krylov space, rounds of both.
const POWER: usize = 400;
const KRYLOV: usize = 24;
const ROUNDS: usize = 12;

/// A residual |Q z − λ z|/|z| at which a mode is found: its growth is told to six digits.
const FOUND: f64 = 1e-9;

/// The verdict on a large system without rigid modes, where two signs tell; `None` where they do not.
pub(super) fn decide(system: &System, frame: &Frame) -> Option<Part> {
    if system.size() < LARGE || !frame.rigid.is_empty() {
        return None;
    }
    let blocks = float::half_period(system, frame);
    let forms = Forms::new(&blocks)?;
    let (p, r) = (forms.is_positive(&forms.p), forms.is_positive(&forms.r));
    let part = |kind, multipliers, instabilities| Part {
        dofs: Vec::new(),
        size: system.size(),
        period: Laurent::from_rational(system.period()),
        kind,
        evidence: Evidence::Signs,
        multipliers,
        instabilities,
        roots: None,
        oscillator: None,
    };
    if p && r {
        return Some(part(Kind::Elliptic, Vec::new(), Vec::new()));
    }
    if !p && !r {
        return None;
    }
    let (lambda, z) = dominant(system, frame)?;
    let v = &z[..blocks.m];
    let is_negative = if p {
        forms.is_negative(&forms.r, &forms.times(&forms.a, v))
    } else {
        forms.is_negative(&forms.p, &forms.times(&forms.c, v))
    };
    if !is_negative {
        return None;
    }
    let mu = c64::new((lambda + 1.0 / lambda - 2.0) / 4.0, 0.0);
    let multiplier = Multiplier::new(mu, None);
    let mut mode = Instability {
        multiplier,
        origin: Origin::RealPair,
        growth_rate: lambda.abs().ln() / to_f64(&system.period()),
        shape: v.iter().zip(&blocks.scales).map(|(x, a)| x / a).collect(),
        quadrature: vec![0.0; blocks.m],
        resonance: None,
    };
    mode.normalize();
    Some(part(Kind::Hyperbolic, vec![multiplier], vec![mode]))
}

/// P and R with what they are made of.
struct Forms {
    a: Mat<f64>,
    c: Mat<f64>,
    p: Symmetrized,
    r: Symmetrized,
}

/// A symmetric matrix in doubles, and how far (2-norm) the true one may be.
struct Symmetrized {
    matrix: Mat<f64>,
    slack: f64,
}

impl Forms {
    fn new(blocks: &FloatBlocks) -> Option<Self> {
        let (m, error) = (blocks.m, blocks.error?);
        let block = |rows: &[Vec<f64>], first: usize| Mat::from_fn(m, m, |i, j| rows[i][first + j]);
        let (a, b) = (block(&blocks.y, 0), block(&blocks.y, m));
        let (c, d) = (block(&blocks.p, 0), block(&blocks.p, m));
        let form = |x: &Mat<f64>, y: &Mat<f64>, sign: f64| {
            let product = x * y.transpose();
            let (size_x, size_y) = (norm::frobenius(x), norm::frobenius(y));
            let rounding = 1.01 * (m as f64 + 4.0) * U * size_x * size_y;
            let slack = error * (size_x.min(blocks.norm) + size_y.min(blocks.norm) + error) + rounding;
            let matrix = Mat::from_fn(m, m, |i, j| sign * (product[(i, j)] + product[(j, i)]) / 2.0);
            Symmetrized { matrix, slack: 1.01 * slack }
        };
        let (p, r) = (form(&a, &b, 1.0), form(&c, &d, -1.0));
        Some(Forms { a, c, p, r })
    }

    fn is_positive(&self, form: &Symmetrized) -> bool {
        is_definite(&form.matrix, form.slack)
    }

    fn times(&self, m: &Mat<f64>, v: &[f64]) -> Vec<f64> {
        (0..m.nrows()).map(|i| v.iter().enumerate().map(|(j, x)| m[(i, j)] * x).sum()).collect()
    }

    /// Whether zᵀ M z < 0 is proven of all M within the slack: two sums of n products, each off by (n + 2) u of the sum of their
    /// sizes, which Cauchy and Schwarz bound by ‖M‖_F |z|².
    fn is_negative(&self, form: &Symmetrized, z: &[f64]) -> bool {
        let n = z.len() as f64;
        let square: f64 = z.iter().map(|x| x * x).sum();
        let value: f64 = self.times(&form.matrix, z).iter().zip(z).map(|(x, y)| x * y).sum();
        let rounding = 2.02 * (n + 4.0) * U * norm::frobenius(&form.matrix);
        value < -1.01 * square * (form.slack + rounding)
    }
}

/// One column of positions and momenta.
struct Column {
    x: Vec<f64>,
    p: Vec<f64>,
}

impl State<f64> for Column {
    fn drift(&mut self, program: &Program<f64>, island: usize, ticks: u64) {
        for &i in &program.islands[island] {
            let speed: f64 = program.inverse_mass[i].iter().map(|(j, a)| a * self.p[*j]).sum();
            self.x[i] += ticks as f64 * speed;
        }
    }

    fn kick(&mut self, i: usize, row: &Row<f64>, weight: Weight) {
        let force: f64 = row.iter().map(|(j, a)| a * self.x[*j]).sum();
        self.p[i] -= if weight == Weight::Full { force } else { force / 2.0 };
    }
}

/// The real multiplier farthest outside the unit circle, in doubles, and its (x, p) in scaled coordinates; `None` where the
/// iteration finds none.
fn dominant(system: &System, frame: &Frame) -> Option<(f64, Vec<f64>)> {
    let (program, _) = scaled_program(system, frame);
    let n = system.size();
    let period = |z: &[f64]| {
        let mut column = Column { x: z[..n].to_vec(), p: z[n..].to_vec() };
        program.run(system.schedule().symmetric_period(), &mut column);
        column.x.extend(column.p);
        column.x
    };
    // Numbers without a pattern (Weyl's sequence): some part of every mode.
    let start = (1..=2 * n).map(|i| (i as f64 * 0.754_877_666_246_692_7).fract() - 0.5).collect();
    let mut z: Vec<f64> = unit(start)?;
    for _ in 0..ROUNDS {
        for _ in 0..POWER {
            z = unit(period(&z))?;
        }
        let (lambda, next, residual) = ritz(&period, z)?;
        z = next;
        if residual < FOUND * lambda.abs() && lambda.abs() > 1.0 {
            return Some((lambda, z));
        }
    }
    None
}

fn unit(z: Vec<f64>) -> Option<Vec<f64>> {
    let length = z.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length.is_normal()).then(|| z.into_iter().map(|x| x / length).collect())
}

/// The real Ritz value of largest size over the Krylov space of z, its vector of length 1, and |Q z − λ z|.
fn ritz(period: &impl Fn(&[f64]) -> Vec<f64>, z: Vec<f64>) -> Option<(f64, Vec<f64>, f64)> {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(a, b)| a * b).sum::<f64>();
    let (mut basis, mut h) = (vec![z], Mat::<f64>::zeros(KRYLOV, KRYLOV));
    for k in 0..KRYLOV {
        let mut next = period(&basis[k]);
        // Twice: once does not leave it orthogonal where it nearly lies in the space.
        for _ in 0..2 {
            for (i, own) in basis.iter().enumerate() {
                let part = dot(own, &next);
                h[(i, k)] += part;
                next.iter_mut().zip(own).for_each(|(x, y)| *x -= part * y);
            }
        }
        let length = dot(&next, &next).sqrt();
        if k + 1 == KRYLOV || length < 1e-13 {
            break;
        }
        h[(k + 1, k)] = length;
        basis.push(next.into_iter().map(|x| x / length).collect());
    }
    let size = basis.len();
    let small = Mat::from_fn(size, size, |i, j| h[(i, j)]);
    let eigen = small.eigen().ok()?;
    let real = (0..size).filter(|&i| eigen.S()[i].im == 0.0);
    let best = real.max_by(|&i, &j| eigen.S()[i].re.abs().total_cmp(&eigen.S()[j].re.abs()))?;
    let mut z = vec![0.0; basis[0].len()];
    for (k, own) in basis.iter().enumerate() {
        let weight = eigen.U()[(k, best)].re;
        z.iter_mut().zip(own).for_each(|(x, y)| *x += weight * y);
    }
    let (lambda, z) = (eigen.S()[best].re, unit(z)?);
    let image = period(&z);
    let residual = image.iter().zip(&z).map(|(a, b)| (a - lambda * b).powi(2)).sum::<f64>().sqrt();
    Some((lambda, z, residual))
}
