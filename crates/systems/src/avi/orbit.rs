//! The integrator's own periodic orbit beside an equilibrium.
//!
//! Where the forces of different clocks balance at an equilibrium but do not vanish one by one, the
//! equilibrium is no fixed point of the integrator: each kick displaces, and the others swing back. The map
//! over T has a fixed point (y, 0) nearby. The orbit from (y, 0) is its own mirror image in time iff the
//! momenta are 0 again at T/2 (half of each kick given at both ends), so y solves n equations, p(T/2; y) = 0,
//! by Newton's method with the tangent map, started at the equilibrium. The Hessians that the kicks meet
//! along the orbit form a palindrome, too: half a period of them decides the orbit's stability.

use nalgebra::{DMatrix, DVector};

use super::force::{Bond, Force};
use clocks::schedule::Schedule;
use number::{Error, Result, to_f64};

/// Iterations of Newton's method before it is given up: it converges quadratically from nearby or not at all.
const ITERATIONS: usize = 50;

/// The equilibrium is found to some 10^-14 of its size, and so much of a force is left there.
const VANISHING: f64 = 1e-13;

/// An orbit of period T that is its own mirror image, rounded.
#[derive(Clone, Debug)]
pub struct PeriodicOrbit {
    /// y, the positions at t = 0 in the middle of the kicks there; the momenta are 0.
    pub start: Vec<f64>,
    /// The Hessian of each clock that kicks in each event of the half period, in their order.
    pub hessians: Vec<Vec<DMatrix<f64>>>,
}

/// Bonds with the clocks that they kick by: bond b by clock `clock_of[b]` of the schedule, one degree of
/// freedom a particle.
#[derive(Clone, Debug)]
pub struct Clocked<'a> {
    pub masses: &'a [f64],
    pub bonds: &'a [Bond],
    pub clock_of: &'a [usize],
    pub schedule: &'a Schedule,
}

/// The orbit at half time.
struct Half {
    p: DVector<f64>,
    /// ∂p/∂y.
    tangent: DMatrix<f64>,
    /// Σ |kicks|, the largest entry.
    kicks: f64,
    /// Σ h |K|, the largest entries: a kick over a displacement.
    stiffness: f64,
    hessians: Vec<Vec<DMatrix<f64>>>,
}

impl Clocked<'_> {
    /// The periodic orbit near `start`.
    ///
    /// # Errors
    /// A schedule that is no palindrome; where Newton's method does not converge (at an edge of stability the
    /// tangent map is singular).
    pub fn periodic_orbit(&self, start: &[f64]) -> Result<PeriodicOrbit> {
        if !self.schedule.is_palindrome() {
            return Err(Error::input("phase", "not 0 or 1/2", "other phases have no time reversal"));
        }
        let mut y = DVector::from_column_slice(start);
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let half = self.half(&y);
            // Forces that vanish one by one, but for the roundings of the equilibrium: it is the orbit, at an
            // edge of stability too.
            if last.is_infinite() && half.kicks <= VANISHING * half.stiffness * y.amax().max(1.0) {
                return Ok(PeriodicOrbit { start: start.to_vec(), hessians: half.hessians });
            }
            let Some(step) = half.tangent.clone().lu().solve(&half.p) else { break };
            let size = step.amax();
            // The step is at its rounding level, or has ceased to shrink there (a few hundred roundings
            // of |y|).
            let scale = y.amax().max(1.0);
            if size <= 1e-15 * scale || (size <= 1e-12 * scale && size >= last / 2.0) {
                return Ok(PeriodicOrbit { start: y.iter().copied().collect(), hessians: half.hessians });
            }
            if !size.is_finite() {
                break;
            }
            y -= step;
            last = size;
        }
        let remedy = "Newton's method finds no periodic orbit from there: choose steps farther from an edge of stability";
        Err(Error::input("equilibrium", format!("{start:?}"), remedy))
    }

    fn half(&self, y: &DVector<f64>) -> Half {
        let n = y.len();
        let tick = to_f64(self.schedule.tick());
        let (mut x, mut p) = (y.clone(), DVector::zeros(n));
        let (mut dx, mut dp) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
        let (mut kicks, mut stiffness, mut hessians) = (DVector::zeros(n), 0.0, Vec::new());
        for event in self.schedule.half_period() {
            let time = event.drift as f64 * tick;
            for i in 0..n {
                let factor = time / self.masses[i];
                x[i] += factor * p[i];
                (0..n).for_each(|j| dx[(i, j)] += factor * dp[(i, j)]);
            }
            let mut met = Vec::new();
            for clock in event.clocks() {
                let weight = event.weight.share();
                let step = weight * tick * self.schedule.clocks()[clock].step() as f64;
                let (force, hessian) = self.at(clock, &x);
                p += step * &force;
                kicks += step * force.abs();
                stiffness += step * hessian.amax();
                dp -= step * &hessian * &dx;
                met.push(hessian);
            }
            hessians.push(met);
        }
        Half { p, tangent: dp, kicks: kicks.amax(), stiffness, hessians }
    }

    /// The force and the Hessian of one clock.
    fn at(&self, clock: usize, x: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let n = x.len();
        let (mut force, mut hessian) = (DVector::zeros(n), DMatrix::zeros(n, n));
        for (bond, _) in self.bonds.iter().zip(self.clock_of).filter(|(_, index)| **index == clock) {
            bond.add_to(x.as_slice(), &mut force, &mut hessian);
        }
        (force, hessian)
    }
}

impl Bond {
    /// Adds its force and its Hessian at the positions x of all particles.
    pub(super) fn add_to(&self, x: &[f64], force: &mut DVector<f64>, hessian: &mut DMatrix<f64>) {
        let indexes = self.particles();
        let at: Vec<f64> = indexes.iter().map(|&i| x[i]).collect();
        let mut f = vec![0.0; indexes.len()];
        self.force(&at, &mut f);
        let curvature = self.curvature(&at);
        for (a, &i) in indexes.iter().enumerate() {
            force[i] += f[a];
            for (b, &j) in indexes.iter().enumerate() {
                hessian[(i, j)] += if a == b { curvature } else { -curvature };
            }
        }
    }
}
