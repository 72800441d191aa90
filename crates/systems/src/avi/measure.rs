//! Measurements of a run: energy, momentum and amplitude over time, growth, reversibility.

use super::force::{Bond, Force};
use super::simulation::{Ends, Simulation};
use number::parallel::go_on;
use number::{Error, Result, to_f64};

/// One line of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time.
    pub time: f64,
    /// Σ p²/2m + Σ V.
    pub energy: f64,
    /// Σ p.
    pub momentum: f64,
    /// The largest |x_i − c_i| from a centre c.
    pub amplitude: f64,
}

/// The measurements of a run.
#[derive(Clone, Debug)]
pub struct Run {
    pub series: Vec<Sample>,
    /// Measured growth rate of small deviations, per unit time.
    pub measured: f64,
    /// Predicted by the system's multipliers.
    pub predicted: f64,
    /// The largest difference after running forward and back, relative to the start.
    pub irreversibility: f64,
    /// How far the integrator's own orbit, about which growth is predicted and measured, lies from the
    /// equilibrium; `None` where the equilibrium is one.
    pub displacement: Option<f64>,
    /// Whether deviations of any size move like small ones.
    pub linear: bool,
}

impl Run {
    /// Measured growth rates below this are none: a bounded solution returns to its size only after a beat,
    /// and over half the run that looks like growth.
    pub fn resolution(&self) -> f64 {
        self.series.last().filter(|s| s.time > 0.0).map_or(f64::INFINITY, |s| 2.0 / s.time)
    }
}

/// The state's line, the amplitude measured from `centre`.
fn sample<F: Force<f64>>(simulation: &Simulation<f64, F>, centre: &[f64]) -> Sample {
    let x = &simulation.state().x;
    Sample {
        time: to_f64(simulation.clocks().tick()) * simulation.now() as f64,
        energy: simulation.energy(),
        momentum: simulation.momentum(),
        amplitude: x.iter().zip(centre).fold(0.0, |a, (x, c)| (x - c).abs().max(a)),
    }
}

/// The state now and after each of `samples` runs of `ticks`, amplitudes measured from `centre`. Where a run
/// overflows, or is stopped, the series ends.
pub fn series<F: Force<f64>>(
    simulation: &mut Simulation<f64, F>,
    centre: &[f64],
    samples: usize,
    (ticks, ends): (u64, Ends),
) -> Vec<Sample> {
    let mut series = vec![sample(simulation, centre)];
    for _ in (0..samples).take_while(|_| go_on().is_ok()) {
        simulation.run(ticks, ends);
        let next = sample(simulation, centre);
        if !(next.energy.is_finite() && next.amplitude.is_finite()) {
            break;
        }
        series.push(next);
    }
    series
}

/// The length of the deviation (x − centre, p).
fn deviation<F: Force<f64>>(simulation: &Simulation<f64, F>, centre: &[f64]) -> f64 {
    let state = simulation.state();
    let shifts = state.x.iter().zip(centre).map(|(x, c)| x - c);
    shifts.chain(state.p.iter().copied()).fold(0.0, f64::hypot)
}

/// Scales the deviation by a power of two to near `size`; ln of the factor.
fn rescale<F: Force<f64>>(simulation: &mut Simulation<f64, F>, centre: &[f64], size: f64) -> f64 {
    let scale = (size / deviation(simulation, centre)).log2().round().clamp(-900.0, 900.0).exp2();
    let state = simulation.state();
    let x = state.x.iter().zip(centre).map(|(x, c)| c + (x - c) * scale).collect();
    let p = state.p.iter().map(|p| p * scale).collect();
    simulation.set(x, p);
    scale.ln()
}

/// The measured growth rate of small deviations z from `centre`, an equilibrium, per unit time: ln |z|/|z_0|
/// over the second half of `periods` synchronization periods, z scaled back to near `size` after each by a
/// power of two. Near 0 where it is stable, to about 1/(periods T). Of no meaning where it is stopped.
///
/// For a linear system about 0 scaling is exact and any size will do. Else the motion is that of the Hessians
/// up to terms of the order z²: `size` makes them small, and has to stay well above the roundoff of x.
pub fn growth_rate<F: Force<f64>>(
    simulation: &mut Simulation<f64, F>,
    centre: &[f64],
    size: f64,
    (periods, ends): (u32, Ends),
) -> f64 {
    let ticks = simulation.clocks().period();
    let mut log = -rescale(simulation, centre, size);
    let mut middle = 0.0;
    for period in (0..periods).take_while(|_| go_on().is_ok()) {
        if period == periods / 2 {
            middle = log + deviation(simulation, centre).ln();
        }
        simulation.run(ticks, ends);
        log -= rescale(simulation, centre, size);
    }
    let half = f64::from(periods - periods / 2) * ticks as f64 * to_f64(simulation.clocks().tick());
    (log + deviation(simulation, centre).ln() - middle) / half
}

/// Runs `ticks` forward in the time-symmetric form, turns the momenta round, runs back: the largest
/// difference to the start over the largest entry of it. 0 in exact arithmetic, where `ticks` is a multiple
/// of half the period.
pub fn irreversibility<F: Force<f64>>(simulation: &mut Simulation<f64, F>, ticks: u64) -> f64 {
    let start = simulation.state().clone();
    simulation.run(ticks, Ends::Symmetric);
    simulation.reverse();
    simulation.run(ticks, Ends::Symmetric);
    simulation.reverse();
    let both = |s: &super::State<f64>| s.x.iter().chain(&s.p).copied().collect::<Vec<_>>();
    let (before, after) = (both(&start), both(simulation.state()));
    let largest = before.iter().fold(0.0, |a: f64, z| a.max(z.abs()));
    let off = before.iter().zip(&after).fold(0.0, |a: f64, (z, w)| a.max((z - w).abs()));
    off / largest
}

/// Iterations of Newton's method before it is given up.
const ITERATIONS: usize = 200;

/// Positions near `start` at which no bond's forces are left, by Newton's method; rounded.
///
/// # Errors
/// Where it does not converge, or the Hessian is singular on the way (a free molecule: tie it to a wall).
pub fn equilibrium(bonds: &[Bond], start: &[f64]) -> Result<Vec<f64>> {
    let (n, mut x) = (start.len(), start.to_vec());
    for _ in 0..ITERATIONS {
        let (mut force, mut hessian) = (nalgebra::DVector::zeros(n), nalgebra::DMatrix::zeros(n, n));
        bonds.iter().for_each(|bond| bond.add_to(&x, &mut force, &mut hessian));
        let singular = || {
            Error::input(
                "near",
                format!("{x:?}"),
                "the Hessian is singular there: start elsewhere, or tie it to a wall",
            )
        };
        let step: nalgebra::DVector<f64> = hessian.lu().solve(&force).ok_or_else(singular)?;
        x.iter_mut().zip(step.iter()).for_each(|(x, s)| *x += s);
        let scale = x.iter().fold(1.0, |a: f64, x| a.max(x.abs()));
        if step.amax() <= 1e-14 * scale {
            return Ok(x);
        }
        if !step.amax().is_finite() {
            break;
        }
    }
    let remedy = "Newton's method finds no equilibrium from there: start nearer to one";
    Err(Error::input("near", format!("{start:?}"), remedy))
}
