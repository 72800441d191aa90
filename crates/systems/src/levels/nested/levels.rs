//! Stiffnesses of any number of levels, and with their steps.

use std::sync::OnceLock;

use faer::Mat;
use nalgebra::DMatrix;

use crate::half::norm;
use crate::levels::rigid::Hessians;
use crate::signs::inertia::{is_definite, lack_beside, orthogonality, spectral_norm};
use crate::verdict::measured::Removed;
use clocks::schedule::{Event, Schedule};
use number::{Error, Rational, Result, U, to_f64};

/// The stiffness of one clock, in coordinates without the rigid motions.
#[derive(Clone, Debug)]
pub(in crate::levels) struct Level {
    pub(in crate::levels) stiffness: Mat<f64>,
    /// How far (2-norm) it is from the exact restriction of what was given.
    pub(super) error: f64,
    /// No less than what it is known relative to: its norm, or the sum of those of the potentials on its
    /// clock.
    pub(super) size: f64,
    pub(super) frobenius: f64,
}

/// Stiffnesses of any number of levels, innermost first.
#[derive(Clone, Debug)]
pub struct Nested {
    pub(in crate::levels) levels: Vec<Level>,
    /// λ of the innermost one, increasing, and its modes as columns in the coordinates given, rounded.
    pub(in crate::levels) squares: Vec<f64>,
    pub(in crate::levels) modes: Mat<f64>,
    /// No less than how far the innermost one reaches below 0.
    pub(super) lack: f64,
    pub(in crate::levels) basis: Option<Mat<f64>>,
    pub(super) is_total_definite: OnceLock<bool>,
    pub(super) modes_of_all: OnceLock<Modes>,
    /// What was projected out before.
    pub removed: Option<Removed>,
}

/// The stiffnesses in a basis V of eigenvectors of their sum, rounded.
#[derive(Clone, Debug)]
pub(super) struct Modes {
    /// √|λ| of the sum.
    pub(super) frequencies: Vec<f64>,
    /// Vᵀ K_k V, and more than its rounding (2-norm).
    pub(super) stiffnesses: Vec<(Mat<f64>, f64)>,
    /// More than ‖Vᵀ V − 1‖.
    pub(super) defect: f64,
}

/// Roundings in a term of the action: of the step's quotient and its square, the tick's product, a factor, a
/// shift, products.
pub(super) const ROUNDINGS: usize = 12;

/// Times a step may have in half a period: beyond that no matrix of the action fits.
const MOST_NODES: u64 = 1 << 12;

impl Nested {
    /// From the mass-weighted stiffness of each potential, those of one clock together, the clocks by
    /// increasing step; `whole` is their sum with what is projected out.
    pub fn new(whole: &Hessians, clocks: &[Vec<DMatrix<f64>>]) -> Result<Nested> {
        let level = |matrixes: &Vec<DMatrix<f64>>| {
            let each: Vec<(Mat<f64>, f64)> = matrixes.iter().map(|k| whole.restricted(k)).collect();
            let n = each[0].0.nrows();
            let stiffness = each.iter().fold(Mat::zeros(n, n), |sum, (k, _)| sum + k);
            let frobenius = norm::frobenius(&stiffness);
            let size = 1.01 * each.iter().map(|(k, error)| spectral_norm(k, *error)).sum::<f64>();
            // A sum of so many has as many roundings.
            let sums = each.iter().map(|(k, _)| norm::frobenius(k)).sum::<f64>() * matrixes.len() as f64 * U;
            let error = 1.01 * (each.iter().map(|pair| pair.1).sum::<f64>() + sums);
            Level { stiffness, error, size, frobenius }
        };
        let levels: Vec<Level> = clocks.iter().map(level).collect();
        let failed = || {
            Error::input("fast", "its eigenvalues", "the iteration does not converge: is the matrix sound?")
        };
        let eigen = levels[0].stiffness.self_adjoint_eigen(faer::Side::Lower).map_err(|_| failed())?;
        let squares: Vec<f64> = (0..levels[0].stiffness.nrows()).map(|i| eigen.S()[i]).collect();
        let lack = lack_beside(&squares, &levels[0].stiffness, 0.0);
        let basis = whole.basis().cloned();
        let modes = basis.as_ref().map_or_else(|| eigen.U().to_owned(), |basis| basis * eigen.U());
        let (is_total_definite, modes_of_all) = (OnceLock::new(), OnceLock::new());
        let removed = whole.removed().cloned();
        Ok(Nested { levels, squares, modes, lack, basis, is_total_definite, modes_of_all, removed })
    }

    /// The number of degrees of freedom that move.
    pub fn size(&self) -> usize {
        self.squares.len()
    }

    /// These levels with their steps, innermost first, in the stiffnesses' unit of time. The steps are scaled
    /// together.
    ///
    /// # Errors
    /// As many steps as levels; steps that meet too late for the action's matrix.
    pub fn at<'a>(&'a self, steps: &[Rational]) -> Result<Steps<'a>> {
        if steps.len() != self.levels.len() {
            let remedy =
                format!("there are {} levels: give as many steps, innermost first", self.levels.len());
            return Err(Error::input("steps", format!("{} of them", steps.len()), remedy));
        }
        let schedule = Schedule::new(steps, &vec![Rational::default(); steps.len()])?;
        if schedule.strikes() > MOST_NODES {
            let work = format!("a period of {} kicks", schedule.strikes());
            return Err(Error::too_much(&work, "choose steps with simpler ratios"));
        }
        let kicks = steps.iter().map(|step| to_f64(&(schedule.tick() * step))).collect();
        let outer = steps.iter().max().expect("as many as levels");
        Ok(Steps {
            nested: self,
            outer: to_f64(outer),
            events: schedule.half_period().collect(),
            kicks,
            schedule,
        })
    }

    /// How far (2-norm) the k-th stiffness is from all within ε of its size.
    pub(super) fn error_within(&self, k: usize, epsilon: f64) -> f64 {
        1.01 * (self.levels[k].error + epsilon * self.levels[k].size)
    }

    pub(super) fn total(&self) -> Mat<f64> {
        self.levels.iter().fold(Mat::zeros(self.size(), self.size()), |sum, level| sum + &level.stiffness)
    }

    pub(super) fn modes_of_all(&self) -> &Modes {
        self.modes_of_all.get_or_init(|| {
            let (n, total) = (self.size(), self.total());
            let eigen = total.self_adjoint_eigen(faer::Side::Lower).ok();
            let found = eigen.and_then(|eigen| Some((orthogonality(&eigen.U().to_owned())?, eigen)));
            let (defect, v, values) = match &found {
                Some((defect, self_adjoint_eigen)) => (
                    *defect,
                    self_adjoint_eigen.U().to_owned(),
                    self_adjoint_eigen.S().column_vector().iter().copied().collect(),
                ),
                None => (0.0, Mat::identity(n, n), (0..n).map(|i| total[(i, i)]).collect::<Vec<f64>>()),
            };
            let rounding = 2.2 * (n as f64 + 4.0) * U * norm::frobenius(&v) * (1.0 + defect);
            // Symmetric as what they round, so that all between them have a half period that is symplectic.
            let turned = |level: &Level| {
                let turned = v.transpose() * &level.stiffness * &v;
                let mean = |i: usize, j: usize| (turned[(i, j)] + turned[(j, i)]) / 2.0;
                (Mat::from_fn(n, n, mean), rounding * level.frobenius)
            };
            Modes {
                frequencies: values.iter().map(|value: &f64| value.abs().sqrt()).collect(),
                stiffnesses: self.levels.iter().map(turned).collect(),
                defect,
            }
        })
    }

    pub(super) fn is_definite_within(&self, epsilon: f64) -> bool {
        let found = |epsilon: f64| {
            let off: f64 = (0..self.levels.len()).map(|k| self.error_within(k, epsilon)).sum();
            let sizes: f64 = self.levels.iter().map(|level| level.frobenius).sum();
            is_definite(self.total(), 1.01 * (off + self.levels.len() as f64 * U * sizes))
        };
        if epsilon == 0.0 { *self.is_total_definite.get_or_init(|| found(0.0)) } else { found(epsilon) }
    }
}

/// Levels with their steps; outer steps are scaled, all others with them.
#[derive(Clone, Debug)]
pub struct Steps<'a> {
    pub(super) nested: &'a Nested,
    pub(super) schedule: Schedule,
    pub(super) events: Vec<Event>,
    /// The tick times each step.
    pub(super) kicks: Vec<f64>,
    pub(super) outer: f64,
}

impl Steps<'_> {
    /// The terms of an entry: two drifts meet in it, and each clock once.
    pub(super) fn terms(&self) -> usize {
        2 + self.kicks.len()
    }

    /// t² with the outer step `step`.
    pub(super) fn square(&self, step: f64) -> f64 {
        let factor = step / self.outer;
        factor * factor
    }
}
