//! Doubles as models that are no dense stiffnesses at one place.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::Model;
use super::sparse::{SparseKind, SparseSystem};
use crate::along::Along;
use crate::friction::Friction;
use crate::jacobian::Jacobians;
use crate::linear::system::System;
use crate::lts::{SchemeSummary, SparseSteps};
use crate::verdict::analysis::Analysis;
use crate::verdict::limits::{DENSE, Limits, Route};
use crate::verdict::measured::Holds;
use clocks::verdict::Kind;
use number::{Error, Rational, Result, to_f64};

/// Forces that are no gradient: their Jacobians are not symmetric.
impl Model for Jacobians {
    fn system(&self) -> &System {
        self.symmetric()
    }

    fn refused(&self, what: &str) -> Error {
        Error::input("symmetric", "false", format!("{what} needs forces that are gradients"))
    }

    fn no_intervals(&self) -> Option<(&'static str, &'static str)> {
        Some((
            "of kicks that are no gradients",
            "are not told: decide steps one by one, as --scan outer=LO..HI:BY does",
        ))
    }

    fn cost(&self) -> u64 {
        self.cost()
    }

    fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        self.decide(route, limits)
    }

    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        self.slowed(&(outer / self.outer_step()))?.decide(Route::Cheapest, limits)
    }

    fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        self.exact(limits).map(|(kind, _)| kind)
    }

    fn has_system(&self) -> bool {
        false
    }

    fn full_period(&self) -> Result<DMatrix<f64>> {
        Ok(self.full_period())
    }

    fn friction(&self, rate: &Rational, _: &Limits) -> Result<Friction> {
        let remedy = "leave it out: the answer has the friction that masks the growth";
        Err(Error::input("friction", rate, remedy))
    }

    fn at_accuracy(self: Arc<Self>, accuracy: f64) -> Result<Arc<dyn Model>> {
        Ok(Arc::new(Arc::unwrap_or_clone(self).at_accuracy(accuracy)?))
    }

    fn jacobians(&self) -> Option<&Jacobians> {
        Some(self)
    }
}

/// Hessians measured along the integrator's own orbit, one for each kick.
impl Model for Along {
    fn system(&self) -> &System {
        self.clocks()
    }

    fn refused(&self, what: &str) -> Error {
        let remedy = format!("{what} needs Hessians at one place: the orbit belongs to these steps alone");
        Error::input("along_orbit", "true", remedy)
    }

    fn no_intervals(&self) -> Option<(&'static str, &'static str)> {
        Some(("along an orbit", "are for Hessians at one place: another step has another orbit"))
    }

    fn is_at_one_place(&self) -> bool {
        false
    }

    fn remark(&self) -> Option<&'static str> {
        Some("about the integrator's own orbit: each kick has the Hessians where it falls")
    }

    fn cost(&self) -> u64 {
        self.cost() / DENSE
    }

    fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        self.decide(route, limits)
    }

    fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        self.exact(limits).map(|(kind, _)| kind)
    }

    fn has_system(&self) -> bool {
        false
    }

    fn growth_of_period(&self, limits: &Limits) -> Result<Option<f64>> {
        limits.allow_dense(self.cost(), || "the full period, kick by kick,".into())?;
        Ok(Some(self.growth_of_period()))
    }

    fn at_accuracy(self: Arc<Self>, accuracy: f64) -> Result<Arc<dyn Model>> {
        Ok(Arc::new(Arc::unwrap_or_clone(self).at_accuracy(accuracy)?))
    }
}

/// Sparse stiffnesses of thousands of degrees of freedom: two levels, or one with local time steps.
impl Model for SparseSystem {
    fn system(&self) -> &System {
        &self.clocks
    }

    fn has_system(&self) -> bool {
        false
    }

    fn refused(&self, what: &str) -> Error {
        let remedy = format!(
            "{what} needs dense stiffnesses: `kickdrift system FILE` has the verdict on these and the first unstable step"
        );
        Error::input("stiffness", "sparse", remedy)
    }

    fn no_intervals(&self) -> Option<(&'static str, &'static str)> {
        Some(("of this file", "are for dense stiffnesses: give these, or --scan the steps of these"))
    }

    fn cost(&self) -> u64 {
        self.products()
    }

    fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        if route == Route::Exact { Err(self.refused("exact arithmetic")) } else { self.decided(limits) }
    }

    /// Of two levels without the margin.
    fn at_point(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        let SparseKind::Levels { levels, outer, .. } = &self.kind else { return self.decide(route, limits) };
        if route == Route::Exact {
            return self.decide(route, limits);
        }
        self.allow(limits)?;
        levels.look(outer.inner_steps());
        Ok(Analysis::of_part(self.of_levels_part(levels.verdict(outer, 0.0)), 2, Vec::new()))
    }

    fn verdict(&self, times: f64, limits: &Limits) -> Result<Holds> {
        self.allow(limits)?;
        Ok(match &self.kind {
            SparseKind::Levels { levels, outer, accuracy, .. } => levels.verdict(outer, times * accuracy),
            SparseKind::Steps(sparse_steps) => sparse_steps.verdict(to_f64(&self.step)),
        })
    }

    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        match &self.kind {
            SparseKind::Levels { .. } => Err(self.refused("the verdict at another step")),
            kind => SparseSystem::of_one(self.clocks.size(), kind.clone(), outer)?.decided(limits),
        }
    }

    fn at_accuracy(self: Arc<Self>, accuracy: f64) -> Result<Arc<dyn Model>> {
        Ok(Arc::new(Arc::unwrap_or_clone(self).at_accuracy(accuracy)?))
    }

    fn copy_settings_from(&mut self, other: &dyn Model) {
        other.sparse().into_iter().for_each(|other| self.copy_settings_from(other));
    }

    fn local_steps_summary(&self) -> Option<SchemeSummary> {
        self.local_steps().map(SparseSteps::summary)
    }

    fn sparse(&self) -> Option<&SparseSystem> {
        Some(self)
    }
}
