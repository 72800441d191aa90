//! Large sparse systems: the signs of the action decide, and a Krylov space of the period finds the mode that
//! grows.
//!
//! All eigenvalues of n degrees of freedom cost 25 n³ and are asked for by nobody where n is in the
//! thousands. Where the signs prove instability all μ are real (one end's action is definite, so that one of
//! the forms is), and a few thousand sparse periods find the fastest.

use faer::Mat;
use faer::c64;

use crate::half::compose::{Program, Row, State};
use crate::half::float::scaled_program;
use crate::linear::frame::Frame;
use crate::linear::system::System;
use crate::signs::action;
use crate::spectrum::modes::Origin;
use crate::spectrum::rate::Multiplier;
use crate::verdict::analysis::{Evidence, Instability, Part};
use clocks::schedule::Weight;
use clocks::verdict::Kind;
use number::parallel::go_on;
use number::{Laurent, Result};

/// From so many degrees of freedom on.
pub(crate) const LARGE: usize = 600;

/// The note on results left out of the answer.
pub(crate) const NOTE: &str = "of so many degrees of freedom only the multiplier that grows fastest is computed, if any does, rounded: no growth rate is enclosed";

/// Periods of one power iteration, dimensions of a Krylov space, rounds of both.
const POWER: usize = 400;
const KRYLOV: usize = 24;
const ROUNDS: usize = 12;

/// A residual |Q z − λ z|/|z| at which a mode is found: its growth has six digits then.
const FOUND: f64 = 1e-9;

/// The verdict on a large system, where two signs decide; `None` where they do not.
///
/// # Errors
/// Where the work was stopped.
pub fn decide(system: &System, frame: &Frame) -> Result<Option<Part>> {
    if system.size() < LARGE {
        return Ok(None);
    }
    let Some(is_stable) = action::is_stable(system, frame) else { return Ok(None) };
    let period = Laurent::from_rational(system.period());
    let part = |kind, growing| Part::new(frame.kept.len(), period, (Some(kind), Evidence::Signs), growing);
    if is_stable {
        return Ok(Some(part(Kind::Elliptic, Default::default())));
    }
    let (program, scales) = scaled_program(system, frame);
    let n = system.size();
    let period = |z: &[f64]| {
        let mut column = Column { x: z[..n].to_vec(), p: z[n..].to_vec() };
        program.run(system.schedule().symmetric_period(), &mut column);
        column.x.extend(column.p);
        column.x
    };
    let found = dominant(2 * n, period, 0.0)?;
    Ok(found.map(|mode| part(Kind::Hyperbolic, growing(mode, |i| 1.0 / scales[i]))))
}

/// A multiplier λ off the circle and its mode z, both rounded.
pub(crate) struct Dominant {
    lambda: c64,
    z: Vec<c64>,
}

/// The mode as answers have it: the first half of z, the positions, each by its own scale.
pub fn growing(
    Dominant { lambda, z }: Dominant,
    scale: impl Fn(usize) -> f64,
) -> (Vec<Multiplier>, Vec<Instability>) {
    let multiplier = Multiplier::new((lambda + lambda.inv() - 2.0) / 4.0, None, None);
    let positions = || z[..z.len() / 2].iter().enumerate().map(|(i, x)| x * scale(i));
    let mut mode = Instability {
        multiplier,
        origin: if lambda.im == 0.0 { Origin::RealPair } else { Origin::Collision },
        growth_rate: None,
        shape: positions().map(|x| x.re).collect(),
        quadrature: positions().map(|x| x.im).collect(),
        resonance: None,
    };
    mode.normalize();
    (vec![multiplier], vec![mode])
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
        self.p[i] -= weight.share() * force;
    }
}

/// The eigenvalue farthest outside the unit circle of a linear map of `size` numbers, by more than `least`
/// and its residual; `None` where the iteration finds none.
///
/// # Errors
/// Where the work was stopped.
pub fn dominant(size: usize, period: impl Fn(&[f64]) -> Vec<f64>, least: f64) -> Result<Option<Dominant>> {
    let mut values = unit(start(size));
    for _ in 0..ROUNDS {
        for _ in 0..POWER {
            go_on()?;
            values = values.and_then(|z| unit(period(&z)));
        }
        let Some((found, residual)) = values.and_then(|z| ritz(&period, z)) else { break };
        let length = found.lambda.norm();
        if residual < FOUND * length && length > 1.0 + least {
            return Ok(Some(found));
        }
        values = unit(found.z.iter().map(|z| z.re).collect());
    }
    Ok(None)
}

/// Where a recursion for eigenvectors begins: numbers without a pattern (Weyl's sequence), some part of every
/// mode.
pub fn start(n: usize) -> Vec<f64> {
    (1..=n).map(|i| (i as f64 * 0.754_877_666_246_692_7).fract() - 0.5).collect()
}

fn unit(z: Vec<f64>) -> Option<Vec<f64>> {
    let length = z.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length.is_normal()).then(|| z.into_iter().map(|x| x / length).collect())
}

/// The Ritz value of largest size over the Krylov space of z, its vector of length 1, and |Q z − λ z|.
fn ritz(period: &impl Fn(&[f64]) -> Vec<f64>, z: Vec<f64>) -> Option<(Dominant, f64)> {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(a, b)| a * b).sum::<f64>();
    let (mut basis, mut h) = (vec![z], Mat::<f64>::zeros(KRYLOV, KRYLOV));
    for k in 0..KRYLOV {
        let mut next = period(&basis[k]);
        // Twice: once does not leave it orthogonal where it nearly lies in the space.
        for _ in 0..2 {
            for (i, values) in basis.iter().enumerate() {
                let part = dot(values, &next);
                h[(i, k)] += part;
                next.iter_mut().zip(values).for_each(|(x, y)| *x -= part * y);
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
    let best = (0..size).max_by(|&i, &j| eigen.S()[i].norm().total_cmp(&eigen.S()[j].norm()))?;
    let (lambda, weights) = (eigen.S()[best], eigen.U().col(best));
    let part = |of: fn(&c64) -> f64| {
        let mut z = vec![0.0; basis[0].len()];
        for (values, weight) in basis.iter().zip(weights.iter().map(of)) {
            z.iter_mut().zip(values).for_each(|(x, y)| *x += weight * y);
        }
        z
    };
    let (re, im) = (part(|weight| weight.re), part(|weight| weight.im));
    let length = (dot(&re, &re) + dot(&im, &im)).sqrt();
    if !length.is_normal() {
        return None;
    }
    let paired = |re: Vec<f64>, im: Vec<f64>| re.into_iter().zip(im).map(|(x, y)| c64::new(x, y) / length);
    let image: Vec<c64> = paired(period(&re), period(&im)).collect();
    let z: Vec<c64> = paired(re, im).collect();
    let residual = image.iter().zip(&z).map(|(a, b)| (a - lambda * b).norm_sqr()).sum::<f64>().sqrt();
    Some((Dominant { lambda, z }, residual))
}
