//! Measured stiffnesses on any clocks: the doubles given, or what is left of them when rigid motions and held distances are projected out.

use std::borrow::Cow;

use faer::{Mat, MatRef};
use nalgebra::DMatrix;

use super::measured::{MeasuredSystem, rational};
use crate::error::Result;
use crate::number::Rational;
use crate::number::rational::{from_f64_exact, to_f64};
use crate::system::friction::{Friction, damped_system};
use crate::system::linear::system::System;
use crate::system::verdict::analysis::Analysis;
use crate::system::verdict::decide::decide_by;
use crate::system::verdict::limits::{Limits, Route};

impl MeasuredSystem {
    /// The verdict on these doubles as a rational system, without margins.
    pub(super) fn decide_projected(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        let hessians = self.hessians()?;
        let (Some(basis), Some(removed)) = (hessians.basis(), hessians.removed()) else {
            self.refuse_constraints()?;
            let mut analysis = decide_by(route, self.system(), limits)?;
            analysis.warnings.push(warning("as they are"));
            return Ok(analysis);
        };
        let mut analysis = decide_by(route, &self.projected(basis), limits)?;
        lift(&mut analysis, basis);
        let what = format!("with {} motions projected out ({}) and rounded", removed.count, removed.found_by);
        analysis.warnings.push(warning(&what));
        Ok(analysis)
    }

    /// The effect of friction on these doubles as a rational system.
    pub(super) fn friction_projected(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        damped_system(self.moving()?.as_ref(), rate, limits)
    }

    /// These doubles as a rational system, rigid motions and held distances projected out where there are any.
    pub(super) fn moving(&self) -> Result<Cow<'_, System>> {
        self.refuse_method("a rational system")?;
        match self.hessians()?.basis() {
            Some(basis) => Ok(Cow::Owned(self.projected(basis))),
            None => self.refuse_constraints().map(|()| Cow::Borrowed(self.system())),
        }
    }

    /// Bᵀ M^-½ K M^-½ B of each stiffness, unit masses.
    fn projected(&self, basis: &Mat<f64>) -> System {
        let project = |(step, own): (Rational, DMatrix<f64>)| {
            let n = own.nrows();
            let image = basis.transpose() * MatRef::from_column_major_slice(own.as_slice(), n, n) * basis;
            (step, DMatrix::from_fn(image.nrows(), image.ncols(), |i, j| image[(i, j)]))
        };
        let potentials: Vec<_> = self.all_weighted().map(project).collect();
        rational(&vec![1.0; basis.ncols()], &potentials)
    }
}

fn warning(how: &str) -> String {
    format!(
        "margins are computed for two levels, the outer step a multiple of the inner one: this verdict is on the doubles given, {how}"
    )
}

/// Degrees of freedom and shapes in the mass-weighted coordinates given, of an analysis in those of the columns of `basis`.
fn lift(analysis: &mut Analysis, basis: &Mat<f64>) {
    let n = basis.nrows();
    let up = |y: &[f64]| -> Vec<f64> {
        (0..n).map(|i| y.iter().enumerate().map(|(k, y)| basis[(i, k)] * y).sum()).collect()
    };
    for part in &mut analysis.parts {
        part.dofs = (0..n).collect();
        for own in &mut part.instabilities {
            (own.shape, own.quadrature) = (up(&own.shape), up(&own.quadrature));
            own.normalize();
        }
    }
    for rigid in &mut analysis.rigid_modes {
        let own = up(&rigid.iter().map(to_f64).collect::<Vec<_>>());
        *rigid = own.into_iter().map(|x| from_f64_exact(x).expect("finite")).collect();
    }
    analysis.size = n;
}
