//! A system by the numbers that it is made of. Which route decides it is the model's own affair.
//!
//! | file | what |
//! |---|---|
//! | `exact` | rational numbers: clocks, local steps |
//! | `oscillator` | one mass, some number of which involves π: its steps may, too |
//! | `measured`, `projected` | dense stiffnesses in doubles: what they are made of, what of them moves |
//! | `dense`, `doubles` | dense stiffnesses as a model; Jacobians, Hessians along an orbit, sparse ones |
//! | `intervals` | verdicts and growth rates over the outer step, or over another number |

mod dense;
mod doubles;
mod exact;
mod intervals;
mod measured;
mod oscillator;
mod projected;
mod sparse;

use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

use crate::bias::{self, BiasedMode, NoBias};
use crate::friction::Friction;
use crate::half::compose::full_period;
use crate::jacobian::Jacobians;
use crate::levels::Method;
use crate::linear::system::System;
use crate::lts::{LocalSteps, SchemeSummary};
use crate::vary::edges::{Family, Linear};
use crate::vary::nearest::Nearest;
use crate::vary::stretches::Stretch;
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::{decide_by, exact_kind, verdict_cost};
use crate::verdict::limits::{Limits, Route};
use crate::verdict::measured::Holds;
use clocks::propagator::Oscillator as TwoClocks;
use clocks::verdict::Kind;
pub use intervals::Number;
pub use measured::{Body, MeasuredLevels, MeasuredSystem};
use nalgebra::DMatrix;
use number::{Error, Rational, Result, from_f64_exact, to_f64};
pub use oscillator::Oscillator;
pub use sparse::SparseSystem;

/// A kind of system. It answers by its own route what it can; the rest is refused, with what to do instead.
pub trait Model: Debug + Send + Sync {
    /// The rational system that stands for it: itself; with π in the stiffnesses of several degrees of
    /// freedom within 2^-150 of every entry, of one within 2^-60 (where steps are irrational in the unit of
    /// time of the shortest one); of doubles these doubles; of local steps Verlet's with its effective
    /// stiffness, of the midpoint rule Verlet's with its effective masses, both exactly. Forces that are no
    /// gradient, Hessians along an orbit, and sparse stiffnesses, have none: what is returned has their size
    /// and their clocks, no more.
    fn system(&self) -> &System;

    /// The error for a question that it has no answer to.
    fn refused(&self, what: &str) -> Error {
        let remedy = format!(
            "{what} needs stiffnesses by reference, as {{\"npz\": \"water.npz\", \"array\": \"fast\"}} (in Python System.from_hessians makes them); `kickdrift system` takes numbers in place"
        );
        Error::input("stiffness", "given in place", remedy)
    }

    /// The number of degrees of freedom.
    fn size(&self) -> usize {
        self.system().size()
    }

    /// All steps, those of potentials of one clock each for itself.
    fn steps(&self) -> Vec<Rational> {
        self.system().steps()
    }

    /// The longest step.
    fn outer_step(&self) -> Rational {
        self.steps().into_iter().max().unwrap_or_default()
    }

    /// The products that the verdict costs, roughly, as limits count them.
    fn cost(&self) -> u64 {
        verdict_cost(self.system())
    }

    /// Whether its numbers are those that are meant, or stand beside them within a bound.
    fn is_exact(&self) -> bool {
        true
    }

    /// Whether [`Model::system`] has its stiffnesses, or its size and its clocks alone.
    fn has_system(&self) -> bool {
        true
    }

    /// Whether it is about an equilibrium and not along an orbit, which is that of its steps alone.
    fn is_at_one_place(&self) -> bool {
        true
    }

    /// The verdict with everything that is known beside it.
    ///
    /// # Errors
    /// As [`decide_by`]; a budget error where what would decide exceeds the limits.
    fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        decide_by(route, self.system(), limits)
    }

    /// The verdict and the growth, which is what a scan shows of each point.
    ///
    /// # Errors
    /// As [`Model::decide`].
    fn at_point(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        self.decide(route, limits)
    }

    /// The verdict that is proven of all stiffnesses within `times` their accuracy, 0 of those given, and
    /// nothing else.
    ///
    /// # Errors
    /// As [`Model::decide`].
    fn verdict(&self, times: f64, limits: &Limits) -> Result<Holds> {
        Ok(self.decide(Route::Cheapest, limits)?.within(times))
    }

    /// The verdict with the outer step `outer` > 0, all steps in their ratios.
    ///
    /// # Errors
    /// As [`Model::decide`].
    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        decide_slower(&*self.moving()?, &(outer / self.outer_step()), limits)
    }

    /// The kind by exact arithmetic alone: by characteristic polynomials, part by part; of an oscillator with
    /// π by the four signs, of several degrees of freedom with π that of [`Model::system`].
    ///
    /// # Errors
    /// A budget error, before the work on the part that exceeds it.
    fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        exact_kind(self.moving()?.as_ref(), limits)
    }

    /// The rational system that moves: of measured stiffnesses without rigid motions and held distances.
    ///
    /// # Errors
    /// Where [`Model::system`] stands for no more than clocks; where measured stiffnesses have another null
    /// space than that of rigid motions.
    fn moving(&self) -> Result<Cow<'_, System>> {
        let what = "varying another number than outer";
        if self.has_system() { Ok(Cow::Borrowed(self.system())) } else { Err(self.refused(what)) }
    }

    /// The system that Algorithm 1 runs.
    ///
    /// # Errors
    /// Where a run needs something else.
    fn to_run(&self) -> Result<&System> {
        if self.has_system() { Ok(self.system()) } else { Err(self.refused("a run")) }
    }

    /// The full period in doubles, kick by kick.
    ///
    /// # Errors
    /// As [`Model::moving`].
    fn full_period(&self) -> Result<DMatrix<f64>> {
        Ok(full_period(self.moving()?.as_ref()))
    }

    /// The largest ln |λ|/T of measured stiffnesses, or of Hessians along an orbit, by the dense full period,
    /// rounded; `None` of any other system.
    ///
    /// # Errors
    /// As [`Model::decide`]; a budget error before the work.
    fn growth_of_period(&self, _: &Limits) -> Result<Option<f64>> {
        Ok(None)
    }

    /// The largest growth rate at an outer step, all steps in their ratios, per unit time, rounded; `None`
    /// where it is not known.
    ///
    /// # Errors
    /// As [`Model::decide`].
    fn growth_at(&self, outer: f64, limits: &Limits) -> Result<Option<f64>> {
        growth_of_decision(self, outer, limits)
    }

    /// The bias of each normal mode of a system that is elliptic.
    ///
    /// # Errors
    /// As [`Model::moving`].
    fn biased_modes(&self) -> Result<std::result::Result<Vec<BiasedMode>, NoBias>> {
        if !self.has_system() || self.method() != Method::Respa || self.local_steps().is_some() {
            return Ok(Err(NoBias::Kind));
        }
        Ok(bias::of_system(self.moving()?.as_ref()))
    }

    /// The effect of friction of a rate per unit time, O in the middle of every drift.
    ///
    /// # Errors
    /// As [`damped_system`](crate::friction::damped_system); irrational steps.
    fn friction(&self, _: &Rational, _: &Limits) -> Result<Friction> {
        Err(self.refused("friction"))
    }

    /// The integrator: kicks and drifts, unless two levels have another.
    fn method(&self) -> Method {
        Method::Respa
    }

    /// The inner steps in an outer one of two measured levels.
    fn inner_steps(&self) -> Option<u64> {
        None
    }

    /// A sentence on how it differs from a system about its equilibrium under kicks of all its forces.
    fn remark(&self) -> Option<&'static str> {
        None
    }

    /// What it is, and what to do, where the unstable steps of a range are not told.
    fn no_intervals(&self) -> Option<(&'static str, &'static str)> {
        None
    }

    /// The rational system with the outer step whose square is given, all steps in their ratios, in a unit of
    /// time in which masses and stiffnesses are linear in it.
    ///
    /// # Errors
    /// As [`System::new`]; where there is none.
    fn at_square(&self, _: &Rational) -> Result<System> {
        let (what, remedy) =
            self.no_intervals().unwrap_or(("of this file", "are for systems of rational numbers"));
        Err(Error::input("intervals", what, remedy))
    }

    /// What is proven on all outer steps in a range, all steps in their ratios, of all stiffnesses within
    /// `times` their accuracy; no interval wider than `width` times its larger end is missed.
    ///
    /// # Errors
    /// As [`Family::stretches`].
    fn between(
        &self,
        range: (f64, f64),
        (width, _times): (f64, f64),
        limits: &Limits,
    ) -> Result<Vec<Stretch>> {
        let at = |square: &Rational| self.at_square(square);
        Family { linear: Linear::Square, at: &at }.stretches(range, width, limits)
    }

    /// That with nothing left open; `None` where this is beyond the limits.
    ///
    /// # Errors
    /// As [`Family::exactly`].
    fn between_exactly(&self, range: (f64, f64), limits: &Limits) -> Result<Option<Vec<Stretch>>> {
        let at = |square: &Rational| self.at_square(square);
        Family { linear: Linear::Square, at: &at }.exactly(range, limits)
    }

    /// The products that [`Model::between`] takes with so many cells, as limits count them.
    ///
    /// # Errors
    /// As [`Family::cost`].
    fn cost_between(&self, range: (f64, f64), cells: f64, limits: &Limits) -> Result<f64> {
        let at = |square: &Rational| self.at_square(square);
        Family { linear: Linear::Square, at: &at }.cost(range, cells, limits)
    }

    /// Those that the intervals next to its own step take.
    ///
    /// # Errors
    /// As [`Family::cost`].
    fn cost_of_nearest(&self, width: f64, limits: &Limits) -> Result<f64> {
        let step = to_f64(&self.outer_step());
        self.cost_between(Nearest::reach(step), Nearest::most_cells(step, width), limits)
    }

    /// This system with every stiffness known to this times its norm.
    ///
    /// # Errors
    /// Exact numbers; an accuracy that is not in (0, 1/10).
    fn at_accuracy(self: Arc<Self>, accuracy: f64) -> Result<Arc<dyn Model>> {
        Err(Error::input("accuracy", accuracy, "is for stiffnesses by reference: these are exact"))
    }

    /// This system with its rigid motions left in.
    ///
    /// # Errors
    /// Where they are not looked for.
    fn keeping_rigid(self: Arc<Self>) -> Result<Arc<dyn Model>> {
        let remedy = "is for dense stiffnesses of forces that are gradients, by reference; of others by reference say \"keep_rigid\": true in the file";
        Err(Error::input("rigid motions", "kept", remedy))
    }

    /// This system under another integrator of two levels: measured ones as they are; rational ones exactly
    /// where the fast force is solved for, else in doubles, their entries known within the rounding of these.
    ///
    /// # Errors
    /// Where there are not two levels; π, irrational steps, and what is no gradient, sparse or of local
    /// steps.
    fn with_method(self: Arc<Self>, method: Method) -> Result<Arc<dyn Model>> {
        Err(Error::input("method", method, "this kind of system has a method of its own: leave it out"))
    }

    /// Copies what was asked beside the file from the model of the same file with another number.
    fn copy_settings_from(&mut self, _: &dyn Model) {}

    /// The system as two clocks on one oscillator, where it is that, without phases.
    fn two_clocks(&self) -> Option<TwoClocks> {
        None
    }

    /// The summary of local time steps, where some degrees of freedom take substeps: computed when it is
    /// asked for, for sparse systems by some dozen factorizations.
    fn local_steps_summary(&self) -> Option<SchemeSummary> {
        None
    }

    /// The rational system as it was given, without effective masses and stiffnesses.
    fn plain(&self) -> Option<&System> {
        None
    }

    /// The scheme, where some degrees of freedom of a rational system take substeps.
    fn local_steps(&self) -> Option<&LocalSteps> {
        None
    }

    /// Jacobians that are not symmetric, where it is made of such.
    fn jacobians(&self) -> Option<&Jacobians> {
        None
    }

    /// Sparse stiffnesses, where it is made of such.
    fn sparse(&self) -> Option<&SparseSystem> {
        None
    }

    /// Measured dense stiffnesses, which advice is for.
    ///
    /// # Errors
    /// Where it is made of something else.
    fn measured(&self) -> Result<&MeasuredSystem> {
        Err(self.refused("advice"))
    }
}

/// The verdict with all steps times `slower`.
fn decide_slower(system: &System, slower: &Rational, limits: &Limits) -> Result<Analysis> {
    decide_by(Route::Cheapest, &system.with(&Rational::from_integer(1.into()), slower)?, limits)
}

/// The growth rate that the verdict at an outer step has.
fn growth_of_decision(model: &(impl Model + ?Sized), outer: f64, limits: &Limits) -> Result<Option<f64>> {
    let exact = from_f64_exact(outer).expect("a finite step");
    Ok(model.decide_at(&exact, limits)?.rounded_rate(outer))
}
