//! What moves of measured stiffnesses: rigid motions and held distances projected out. On any clocks the
//! doubles that are left decide, and the action says how far that stands.

use std::borrow::Cow;

use faer::{Mat, MatRef};
use nalgebra::DMatrix;

use super::Model;
use super::measured::{Body, MeasuredSystem, rational};
use crate::columns::combined;
use crate::friction::{Friction, damped_system};
use crate::levels::apart::{Given, common_null_space, of_particles};
use crate::levels::{Hessians, Motions, Search, Shares};
use crate::linear::system::System;
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::decide_by;
use crate::verdict::limits::{Limits, Route};
use crate::verdict::measured::{Holds, Measured};
use number::error::Kind as Reason;
use number::{Rational, Result, from_f64_exact, to_f64};

/// The note where a verdict does not outlast the rounding of what was projected.
const ON_AN_EDGE: &str = "the doubles decided are rounded, and the verdict does not stand that: it is not decided, as on an edge or of rigid motions that are kept; choose another step";

/// A margin and the first unstable step cost about as much as so many cells of a range: some hundred signs.
const MARGIN_CELLS: f64 = 40.0;

/// By which motions without positions are found.
const COMMON: &str = "common null space";

impl MeasuredSystem {
    /// What moves: rigid motions set apart where no potential holds them, distances that are held.
    pub(super) fn without_rigid(&self, whole: Hessians) -> Result<Hessians> {
        let Body { is_periodic, held, rigid, .. } = &self.body;
        if let Some(rigid) = rigid {
            if rigid.is_empty() {
                return Ok(whole);
            }
            let columns = Mat::from_fn(rigid.nrows(), rigid.ncols(), |i, k| rigid[(i, k)]);
            return Ok(whole.without(&columns.qr().compute_thin_Q(), COMMON));
        }
        let motions = self.motions();
        if let Some(held) = held {
            let columns = motions.as_ref().map_or_else(Mat::new, |(motions, _)| motions.columns.clone());
            let all = |i: usize, j: usize| match j.checked_sub(held.ncols()) {
                None => held[(i, j)],
                Some(j) => columns[(i, j)],
            };
            let all = Mat::from_fn(held.nrows(), held.ncols() + columns.ncols(), all);
            let (by, shares) = match &motions {
                Some((motions, particles)) => {
                    ("positions and constraints", self.shares_of(motions, particles)?)
                }
                None => ("constraints", Shares { each: Vec::new(), total: 0.0 }),
            };
            return Ok(whole.set_apart(&all.qr().compute_thin_Q(), by, shares));
        }
        match motions {
            _ if self.keeps_rigid => Ok(whole),
            Some((motions, particles)) => {
                let by = if *is_periodic { "periodic box" } else { "positions" };
                Ok(whole.set_apart(&motions.columns, by, self.shares_of(&motions, &particles)?))
            }
            None => {
                let found =
                    common_null_space(&self.given(), self.accuracy, if *is_periodic { 3 } else { 6 })?;
                Ok(match found {
                    Some((columns, shares)) => whole.set_apart(&columns, COMMON, shares),
                    None => whole,
                })
            }
        }
    }

    /// What positions say is rigid, or a box, with the mass of each particle; `None` where neither does, and
    /// where rigid motions are kept.
    fn motions(&self) -> Option<(Motions, Vec<f64>)> {
        let masses =
            self.body.masses.as_ref().filter(|_| !self.keeps_rigid && self.size().is_multiple_of(3))?;
        let particles: Vec<f64> = masses.iter().step_by(3).copied().collect();
        let motions = match &self.body.positions {
            _ if self.body.is_periodic => Motions::of_box(&particles),
            Some(positions) => Motions::of_particles(positions, &particles),
            None => return None,
        };
        // Of one particle all there is.
        (motions.columns.ncols() < self.size()).then_some((motions, particles))
    }

    fn given(&self) -> Vec<Given> {
        let each = |(step, matrixes): (&Rational, &[DMatrix<f64>])| -> Vec<Given> {
            matrixes.iter().map(|k| Given::new(step.clone(), &self.weighted(k))).collect()
        };
        self.clocks().flat_map(each).collect()
    }

    fn shares_of(&self, motions: &Motions, particles: &[f64]) -> Result<Shares> {
        of_particles(motions, particles, &self.given(), self.accuracy)
    }

    /// The verdict on these doubles as a rational system, and what they are.
    pub(super) fn decide_projected(&self, route: Route, limits: &Limits) -> Result<(Analysis, String)> {
        let hessians = self.hessians()?;
        let (Some(basis), Some(removed)) = (hessians.basis(), hessians.removed()) else {
            self.refuse_constraints()?;
            let mut analysis = decide_by(route, self.system(), limits)?;
            // Rigid motions that are kept are on an edge, and weighted by roots of masses, which are rounded.
            if self.keeps_rigid {
                self.outlast_rounding(&mut analysis)?;
            }
            return Ok((analysis, "as they are".into()));
        };
        let mut analysis = decide_by(route, &self.projected(basis), limits)?;
        lift(&mut analysis, basis);
        self.outlast_rounding(&mut analysis)?;
        analysis.warnings.extend(removed.warning(self.accuracy));
        let how = format!("with {} motions projected out ({}) and rounded", removed.count, removed.found_by);
        Ok((analysis, how))
    }

    /// The verdict on levels that are not two of an inner and an outer step: of these doubles, and how far it
    /// stands, as advice on them has it.
    pub(super) fn decide_levels(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        let (mut analysis, how) = self.decide_projected(route, limits)?;
        let why = match route {
            Route::Exact => "exact arithmetic knows none; leave --exact out".into(),
            Route::Cheapest => match self.how_far(limits) {
                Ok(found) => {
                    let margin = found.margin.filter(|_| analysis.is_proof());
                    return Ok(Analysis { measured: Some(Measured { margin, ..found }), ..analysis });
                }
                Err(error) if error.kind() == Reason::Budget => error.to_string(),
                Err(error) => return Err(error),
            },
        };
        analysis
            .warnings
            .push(format!("this verdict is on the doubles given, {how}; their accuracy is not used: {why}"));
        Ok(analysis)
    }

    /// How far the verdict stands, proven by the action, as two levels have it by their eigenbasis.
    fn how_far(&self, limits: &Limits) -> Result<Measured> {
        self.over_steps(|levels, steps| {
            let (at, outer) = (levels.at(steps)?, to_f64(steps.last().expect("at least one")));
            limits
                .allow_dense(at.cost_of_cells(MARGIN_CELLS) as u64, || "how far the verdict stands".into())?;
            let first_unstable = at.first_unstable();
            Ok(Measured {
                method: self.method().name(),
                accuracy: self.accuracy,
                holds: at.verdict_within(outer, self.accuracy),
                margin: at.margin(outer),
                first_unstable,
                is_above_unstable: first_unstable.is_some_and(|(_, hi)| outer > hi),
                removed: levels.removed.clone(),
            })
        })
    }

    /// Takes a verdict back that not all stiffnesses share which round to those decided.
    fn outlast_rounding(&self, analysis: &mut Analysis) -> Result<()> {
        if analysis.is_proof() && self.stands()? != analysis.holds() {
            analysis.kind = None;
            analysis.parts.iter_mut().for_each(|part| part.kind = None);
            analysis.warnings.push(ON_AN_EDGE.into());
        }
        Ok(())
    }

    /// What is proven of all stiffnesses that round to those decided.
    fn stands(&self) -> Result<Holds> {
        match self.outer() {
            Some((outer, _)) => Ok(self.kernel()?.verdict_within(&outer, 0.0)),
            None => self.over_steps(|levels, steps| {
                let outer = to_f64(steps.last().expect("at least one"));
                Ok(levels.at(steps)?.verdict_within(outer, 0.0))
            }),
        }
    }

    /// The effect of friction on these doubles as a rational system.
    pub(super) fn friction_projected(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        damped_system(self.moving()?.as_ref(), rate, limits)
    }

    /// These doubles as a rational system, rigid motions and held distances projected out where there are
    /// any.
    pub(super) fn moving(&self) -> Result<Cow<'_, System>> {
        self.refuse_method("a rational system")?;
        match self.hessians()?.basis() {
            Some(basis) => Ok(Cow::Owned(self.projected(basis))),
            None => self.refuse_constraints().map(|()| Cow::Borrowed(self.system())),
        }
    }

    /// Bᵀ M^-½ K M^-½ B of each stiffness, unit masses.
    fn projected(&self, basis: &Mat<f64>) -> System {
        let project = |(step, matrix): (Rational, DMatrix<f64>)| {
            let n = matrix.nrows();
            let image = basis.transpose() * MatRef::from_column_major_slice(matrix.as_slice(), n, n) * basis;
            (step, DMatrix::from_fn(image.nrows(), image.ncols(), |i, j| image[(i, j)]))
        };
        let potentials: Vec<_> = self.all_weighted().map(project).collect();
        rational(&vec![1.0; basis.ncols()], &potentials)
    }
}

/// Degrees of freedom and shapes in the mass-weighted coordinates given, of an analysis in those of the
/// columns of `basis`.
fn lift(analysis: &mut Analysis, basis: &Mat<f64>) {
    let n = basis.nrows();
    let up = |y: &[f64]| combined(basis, y);
    for part in &mut analysis.parts {
        part.dofs = (0..n).collect();
        part.instabilities.iter_mut().for_each(|instability| instability.lift(up));
    }
    for rigid in &mut analysis.rigid_modes {
        let values = up(&rigid.iter().map(to_f64).collect::<Vec<_>>());
        *rigid = values.into_iter().map(|x| from_f64_exact(x).expect("finite")).collect();
    }
    analysis.size = n;
}
