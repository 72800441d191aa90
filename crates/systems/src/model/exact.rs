//! Rational numbers as models: clocks, local steps.

use std::sync::Arc;

use num_traits::One;

use super::Model;
use super::measured::MeasuredSystem;
use crate::friction::{Friction, damped_system};
use crate::implicit::{ImplicitExplicit, two_clocks};
use crate::levels::Method;
use crate::linear::system::{Potential, System};
use crate::lts::{ElementSteps, LocalSteps, Scheme, SchemeSummary};
use crate::vary::stretches::Stretch;
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::decide_by;
use crate::verdict::limits::{Limits, Route};
use clocks::propagator;
use number::{Error, Laurent, Rational, Result};

/// Rational masses, stiffnesses and steps, few entries or many.
impl Model for System {
    fn system(&self) -> &System {
        self
    }

    fn plain(&self) -> Option<&System> {
        Some(self)
    }

    fn at_square(&self, square: &Rational) -> Result<System> {
        at_square(self, square)
    }

    fn friction(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        damped_system(self, rate, limits)
    }

    fn with_method(self: Arc<Self>, method: Method) -> Result<Arc<dyn Model>> {
        match method {
            Method::Respa => Ok(self),
            Method::ImplicitExplicit => Ok(Arc::new(ImplicitExplicit::new(Arc::unwrap_or_clone(self))?)),
            _ => {
                two_clocks(&self).and_then(|_| Arc::new(MeasuredSystem::rounded(&self)?).with_method(method))
            }
        }
    }

    fn two_clocks(&self) -> Option<propagator::Oscillator> {
        as_two_clocks(self)
    }
}

/// In the old steps all stiffnesses grow as the square of the step does.
fn at_square(system: &System, square: &Rational) -> Result<System> {
    let outer = system.outer_step();
    system.with(&(square / (&outer * &outer)), &Rational::one())
}

/// One oscillator under two clocks without phases.
fn as_two_clocks(system: &System) -> Option<propagator::Oscillator> {
    let [fast, slow] = system.clocks() else { return None };
    if system.size() > 1 || [fast, slow].iter().any(|clock| clock.phase != Rational::default()) {
        return None;
    }
    let lambda =
        |clock: &Potential| Laurent::from_rational(clock.stiffness.get(0, 0) / system.mass().get(0, 0));
    let step = |clock: &Potential| Laurent::from_rational(clock.step.clone());
    propagator::Oscillator::new(lambda(fast), lambda(slow), step(fast), step(slow)).ok()
}

/// One clock, some degrees of freedom with substeps of their own while forces on the others stand still.
impl Model for LocalSteps {
    fn system(&self) -> &System {
        self.system()
    }

    fn plain(&self) -> Option<&System> {
        Some(self.plain())
    }

    fn refused(&self, what: &str) -> Error {
        of_local_steps(Scheme::Lts, what)
    }

    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        decide_by(Route::Cheapest, self.at(outer)?.system(), limits)
    }

    fn between(&self, range: (f64, f64), _: (f64, f64), limits: &Limits) -> Result<Vec<Stretch>> {
        self.stretches(range, limits)
    }

    fn between_exactly(&self, range: (f64, f64), limits: &Limits) -> Result<Option<Vec<Stretch>>> {
        self.stretches(range, limits).map(Some)
    }

    fn cost_between(&self, _: (f64, f64), _: f64, _: &Limits) -> Result<f64> {
        Ok(self.cost())
    }

    fn local_steps_summary(&self) -> Option<SchemeSummary> {
        Some(self.summary())
    }

    fn local_steps(&self) -> Option<&LocalSteps> {
        Some(self)
    }
}

/// AVI of elements in levels, each level a clock of rational stiffness.
impl Model for ElementSteps {
    fn system(&self) -> &System {
        self.clocks()
    }

    fn plain(&self) -> Option<&System> {
        Some(self.clocks())
    }

    fn refused(&self, what: &str) -> Error {
        of_local_steps(Scheme::Avi, what)
    }

    fn at_square(&self, square: &Rational) -> Result<System> {
        at_square(self.clocks(), square)
    }

    fn friction(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        damped_system(self.clocks(), rate, limits)
    }

    fn two_clocks(&self) -> Option<propagator::Oscillator> {
        as_two_clocks(self.clocks())
    }

    fn local_steps_summary(&self) -> Option<SchemeSummary> {
        Some(self.summary())
    }
}

fn of_local_steps(scheme: Scheme, what: &str) -> Error {
    let remedy = format!(
        "{what} has no place in a scheme of local steps: `kickdrift system FILE --intervals outer=LO..HI` has the unstable steps"
    );
    Error::input("scheme", scheme.name(), remedy)
}
