//! The bias of normal modes by the dense full period: that each pair of x and p turns into itself, and what
//! follows of it, drift by drift. No half period, no symmetry, no eigenvalue.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::input::SystemScene;
use crate::verify::context::{Checked, holds, same};
use clocks::verdict::Kind;
use number::to_f64;
use systems::{Analysis, BiasedMode, Model, NoBias, Symmetric, System, full_period};

/// Eigenvectors of multipliers that lie together are right to half the digits of doubles.
const ROUNDED: f64 = 1e-7;

/// Where it is told, that it is right; that it is told of what is elliptic, or refused for a reason.
pub fn check(
    scene: &SystemScene,
    analysis: &Analysis,
    bias: Option<&Result<Vec<BiasedMode>, NoBias>>,
) -> Checked {
    let is_stable = analysis.kind.is_some_and(Kind::is_stable);
    same("whether there is a bias", bias.is_some(), is_stable)?;
    let Some(Ok(modes)) = bias else { return Ok(()) };
    same("kind", analysis.kind_name(), Kind::Elliptic.name())?;
    let system = scene.model().moving()?;
    // Steps that are irrational have the shortest one as their unit.
    let unit = analysis.period.to_f64() / to_f64(&system.period());
    Dense::new(&system, unit).check(modes, &scene.model().full_period()?)
}

/// R at the kicks of the mode that is most off, all modes being held against the dense full period; `None`
/// where it is not computed.
pub fn most_off(system: &System) -> Checked<Option<f64>> {
    let Ok(modes) = system.biased_modes()? else { return Ok(None) };
    Dense::new(system, 1.0).check(&modes, &full_period(system))?;
    Ok(modes.iter().map(|mode| mode.bias.at_kicks).max_by(|a, b| a.ln().abs().total_cmp(&b.ln().abs())))
}

/// Whether two rounded values may be one.
pub fn agree(told: f64, truth: f64) -> bool {
    (told - truth).abs() <= ROUNDED * truth.abs()
}

/// Masses and stiffnesses in doubles, momenta and kicks in ticks.
struct Dense {
    mass: DMatrix<f64>,
    inverse_mass: DMatrix<f64>,
    /// Each with its step in ticks.
    stiffnesses: Vec<(DMatrix<f64>, f64)>,
    /// Drifts, and the clocks that kick after them with their shares.
    events: Vec<(f64, Vec<(usize, f64)>)>,
    rigid: usize,
    tick: f64,
}

impl Dense {
    /// `unit` is that of the system's time.
    fn new(system: &System, unit: f64) -> Dense {
        let dense = |matrix: &Symmetric| {
            let n = system.size();
            DMatrix::from_fn(n, n, |i, j| to_f64(&matrix.get(i, j)))
        };
        let (schedule, mass) = (system.schedule(), dense(system.mass()));
        let inverse_mass = mass.clone().try_inverse().expect("a mass is positive definite");
        let square = to_f64(system.tick()).powi(2);
        let clocks = system.clocks().iter().zip(schedule.clocks());
        let stiffnesses =
            clocks.map(|(potential, clock)| (square * dense(&potential.stiffness), clock.step() as f64));
        let events = schedule.symmetric_period().map(|event| {
            let share = event.weight.share();
            (event.drift as f64, event.clocks().map(|clock| (clock, share)).collect())
        });
        Dense {
            mass,
            inverse_mass,
            stiffnesses: stiffnesses.collect(),
            events: events.collect(),
            rigid: system.rigid_modes().len(),
            tick: unit * to_f64(system.tick()),
        }
    }

    fn check(&self, modes: &[BiasedMode], q: &DMatrix<f64>) -> Checked {
        let n = self.mass.nrows();
        same("the number of modes", modes.len(), n - self.rigid)?;
        // All of them: each multiplier once.
        let turns: f64 = modes.iter().map(|mode| 2.0 * (2.0 * PI * mode.turn).cos()).sum();
        let sum = turns + 2.0 * self.rigid as f64;
        holds((sum - q.trace()).abs() <= ROUNDED * (n as f64 + q.norm()), || {
            format!("the turns of its modes give a trace of {sum}, the full period has {}", q.trace())
        })?;
        let columns = |k: usize| {
            DMatrix::from_fn(n, modes.len(), |i, mode| modes[mode].pair.get(k).map_or(0.0, |side| side[i]))
        };
        let (x, p) = (columns(0), columns(1));
        let spread = self.spread(&x, &p);
        let total: DMatrix<f64> =
            self.stiffnesses.iter().fold(DMatrix::zeros(n, n), |sum, (matrix, _)| sum + matrix);
        for (k, mode) in modes.iter().enumerate() {
            let (x, p) = (x.column(k).into_owned(), p.column(k).into_owned());
            self.turns(q, mode.turn, &x, &p)?;
            let (potential, kinetic) = (x.dot(&(&total * &x)), p.dot(&(&self.inverse_mass * &p)));
            let period = 2.0 * PI * self.tick * (x.dot(&(&self.mass * &x)) / potential).sqrt();
            let values = [
                ("period", mode.period, period),
                ("at_kicks", mode.bias.at_kicks, potential / kinetic),
                ("in_drifts", mode.bias.in_drifts, potential * spread[k] / x.dot(&p).powi(2)),
            ];
            for (name, told, truth) in values {
                holds(agree(told, truth), || {
                    format!("{name} of the mode with T = {period} is {truth}, not {told}")
                })?;
            }
        }
        Ok(())
    }

    /// Q (x, 0) = (x cos φ, −p sin φ), Q (0, p) = (x sin φ, p cos φ).
    fn turns(&self, q: &DMatrix<f64>, turn: f64, x: &DVector<f64>, p: &DVector<f64>) -> Checked {
        let n = x.len();
        let (sine, cosine) = (2.0 * PI * turn).sin_cos();
        let state =
            |a: f64, b: f64| DVector::from_fn(2 * n, |i, _| if i < n { a * x[i] } else { b * p[i - n] });
        let size = ROUNDED * q.norm() * state(1.0, 1.0).norm();
        let off = (q * state(1.0, 0.0) - state(cosine, -sine)).norm()
            + (q * state(0.0, 1.0) - state(sine, cosine)).norm();
        holds(off <= size, || format!("a pair that turns by {turn} of a turn is off by {off}"))
    }

    /// The mean of ξᵀ M ξ + ηᵀ M η in the middles of all drifts.
    fn spread(&self, x: &DMatrix<f64>, p: &DMatrix<f64>) -> Vec<f64> {
        let (mass, inverse_mass) = (Entries::of(&self.mass), Entries::of(&self.inverse_mass));
        let stiffnesses: Vec<Entries> =
            self.stiffnesses.iter().map(|(matrix, _)| Entries::of(matrix)).collect();
        let nothing = DMatrix::zeros(x.nrows(), x.ncols());
        let mut both = [(x.clone(), nothing.clone()), (nothing, p.clone())];
        let (mut sums, mut time) = (vec![0.0; x.ncols()], 0.0);
        for (drift, kicks) in &self.events {
            time += drift;
            for (x, p) in &mut both {
                let half = 0.5 * *drift * inverse_mass.times(p);
                let middle = &*x + &half;
                let weighted = mass.times(&middle);
                for (k, sum) in sums.iter_mut().enumerate() {
                    *sum += drift * middle.column(k).dot(&weighted.column(k));
                }
                *x = middle + half;
                for &(clock, share) in kicks {
                    *p -= share * self.stiffnesses[clock].1 * stiffnesses[clock].times(x);
                }
            }
        }
        sums.into_iter().map(|sum| sum / time).collect()
    }
}

/// The entries of a matrix that are not 0, row by row.
struct Entries(Vec<Vec<(usize, f64)>>);

impl Entries {
    fn of(matrix: &DMatrix<f64>) -> Entries {
        let row = |i: usize| {
            let entries = (0..matrix.ncols()).map(|j| (j, matrix[(i, j)]));
            entries.filter(|(_, entry)| *entry != 0.0).collect()
        };
        Entries((0..matrix.nrows()).map(row).collect())
    }

    fn times(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
            self.0[i].iter().map(|&(j, entry)| entry * matrix[(j, k)]).sum::<f64>()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use systems::{Limits, Route};

    #[test]
    fn the_dense_period_agrees_on_molecules_and_finds_what_is_wrong_from_the_start() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes"));
        // Rounded: of the mode that is most off, by the same file's Hessians in other programs, too.
        for (file, size, most) in [("water4-levels", 30, 0.749), ("water4", 30, 0.715), ("fpu", 6, 1.143)] {
            let text = std::fs::read_to_string(folder.join(format!("{file}.json"))).unwrap();
            let scene = SystemScene::from_json_in(folder, serde_json::from_str(&text).unwrap()).unwrap();
            let limits = Limits::default();
            let analysis = scene.model().decide(Route::Cheapest, &limits).unwrap();
            let modes = scene.model().biased_modes().unwrap().unwrap();
            let farthest = modes.iter().map(|mode| mode.bias.at_kicks);
            let farthest = farthest.max_by(|a, b| a.ln().abs().total_cmp(&b.ln().abs())).unwrap();
            assert_eq!((modes.len(), (farthest * 1000.0).round() / 1000.0), (size, most), "{file}");
            let is_right = |modes: Vec<BiasedMode>| check(&scene, &analysis, Some(&Ok(modes))).is_ok();
            assert!(is_right(modes.clone()), "{file}");
            let forgeries: [fn(&mut BiasedMode); 4] = [
                |mode| mode.bias.at_kicks *= 1.0 + 1e-6,
                |mode| mode.bias.in_drifts *= 1.0 + 1e-6,
                |mode| mode.period *= 1.0 + 1e-6,
                |mode| mode.pair[1][0] += 1e-3,
            ];
            for (n, forge) in forgeries.into_iter().enumerate() {
                let mut forged = modes.clone();
                forge(&mut forged[size - 1]);
                assert!(!is_right(forged), "{file}: forgery {n}");
            }
            assert!(check(&scene, &analysis, None).is_err(), "{file}");
        }
    }
}
