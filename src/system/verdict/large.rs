//! Large sparse systems: the signs of the action decide, and a Krylov space of the period finds the mode that grows.
//!
//! All eigenvalues of n degrees of freedom cost 25 n³ and are asked for by nobody where n is in the thousands. Where the signs
//! prove instability all μ are real (one end's action is definite, so that one of the forms is), and a few thousand sparse periods
//! find the fastest.

use faer::Mat;
use faer::c64;

use crate::number::Laurent;
use crate::schedule::Weight;
use crate::system::half::compose::{Program, Row, State};
use crate::system::half::float::scaled_program;
use crate::system::linear::frame::Frame;
use crate::system::linear::system::System;
use crate::system::signs::action;
use crate::system::spectrum::modes::Origin;
use crate::system::spectrum::rate::Multiplier;
use crate::system::verdict::analysis::{Evidence, Instability, Part};
use crate::verdict::Kind;

/// From so many degrees of freedom on.
pub(in crate::system) const LARGE: usize = 600;

/// The note on results left out of the answer.
pub(in crate::system) const NOTE: &str = "of so many degrees of freedom only the multiplier that grows fastest is computed, if any does, rounded: no growth rate is enclosed";

/// Periods of one power iteration, dimensions of a Krylov space, rounds of both.
const POWER: usize = 400;
const KRYLOV: usize = 24;
const ROUNDS: usize = 12;

/// A residual |Q z − λ z|/|z| at which a mode is found: its growth has six digits then.
const FOUND: f64 = 1e-9;

/// The verdict on a large system, where two signs decide; `None` where they do not.
pub(in crate::system) fn decide(system: &System, frame: &Frame) -> Option<Part> {
    if system.size() < LARGE {
        return None;
    }
    let is_stable = action::is_stable(system, frame)?;
    let period = Laurent::from_rational(system.period());
    let part = |kind, growing| Part::new(frame.kept.len(), period, (Some(kind), Evidence::Signs), growing);
    if is_stable {
        return Some(part(Kind::Elliptic, Default::default()));
    }
    let (lambda, v) = dominant(system, frame)?;
    let mu = c64::new((lambda + 1.0 / lambda - 2.0) / 4.0, 0.0);
    let multiplier = Multiplier::new(mu, None, None);
    let mut mode = Instability {
        multiplier,
        origin: Origin::RealPair,
        growth_rate: None,
        quadrature: vec![0.0; v.len()],
        shape: v,
        resonance: None,
    };
    mode.normalize();
    Some(part(Kind::Hyperbolic, (vec![multiplier], vec![mode])))
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

/// The real multiplier farthest outside the unit circle, in doubles, and the positions of its mode; `None` where the
/// iteration finds none.
fn dominant(system: &System, frame: &Frame) -> Option<(f64, Vec<f64>)> {
    let (program, scales) = scaled_program(system, frame);
    let n = system.size();
    let period = |z: &[f64]| {
        let mut column = Column { x: z[..n].to_vec(), p: z[n..].to_vec() };
        program.run(system.schedule().symmetric_period(), &mut column);
        column.x.extend(column.p);
        column.x
    };
    let mut z: Vec<f64> = unit(start(2 * n))?;
    for _ in 0..ROUNDS {
        for _ in 0..POWER {
            z = unit(period(&z))?;
        }
        let (lambda, next, residual) = ritz(&period, z)?;
        z = next;
        if residual < FOUND * lambda.abs() && lambda.abs() > 1.0 {
            return Some((lambda, z.iter().zip(&scales).map(|(x, a)| x / a).collect()));
        }
    }
    None
}

/// Where a recursion for eigenvectors begins: numbers without a pattern (Weyl's sequence), some part of every mode.
pub(in crate::system) fn start(n: usize) -> Vec<f64> {
    (1..=n).map(|i| (i as f64 * 0.754_877_666_246_692_7).fract() - 0.5).collect()
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
