//! A system by the numbers that it is made of. Which route decides it is the model's own affair.
//!
//! | file | what |
//! |---|---|
//! | `oscillator` | one mass, some number of which involves π: its steps may, too |
//! | `measured`, `projected` | dense stiffnesses in doubles: as two levels with margins, or on any clocks |
//! | `intervals` | verdicts and growth rates over the outer step, or over another number |

mod intervals;
mod measured;
mod oscillator;
mod projected;
mod sparse;

use std::borrow::Cow;

use crate::along::Along;
use crate::friction::{Friction, damped_system};
use crate::implicit::{ImplicitExplicit, two_clocks};
use crate::jacobian::Jacobians;
use crate::levels::{Hessians, Method};
use crate::linear::system::{Potential, System};
use crate::lts::{ElementSteps, LocalSteps, Scheme, SchemeSummary};
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::{decide_around, decide_by, exact_kind, verdict_cost};
use crate::verdict::limits::{DENSE, Limits, PACE, Route};
use crate::verdict::measured::Holds;
use clocks::propagator;
use clocks::verdict::Kind;
pub use intervals::Number;
pub use measured::{Body, MeasuredLevels, MeasuredSystem};
use number::error::{Error, Result};
use number::{Laurent, Rational};
pub use oscillator::Oscillator;
pub use sparse::SparseSystem;

/// The kinds of systems.
#[derive(Clone, Debug)]
pub enum Model {
    /// Rational masses, stiffnesses and steps, few entries or many.
    Rational(System),
    /// Several degrees of freedom with π in the stiffnesses, by the rational system beside it
    /// ([`beside_pi`](crate::beside_pi)).
    Pi(System),
    /// One oscillator over ℚ\[π, 1/π\].
    Oscillator(Oscillator),
    /// Stiffnesses in doubles, known to some accuracy.
    Measured(MeasuredSystem),
    /// One clock, some degrees of freedom with substeps of their own while forces on the others stand still.
    LocalSteps(LocalSteps),
    /// Two rational levels, the force of the shorter step by the midpoint rule over the longer one.
    Implicit(Box<ImplicitExplicit>),
    /// Forces that are no gradient: their Jacobians are not symmetric.
    NoGradient(Box<Jacobians>),
    /// AVI of elements in levels, each level a clock of rational stiffness.
    Elements(System, ElementSteps),
    /// Hessians measured along the integrator's own orbit, one for each kick.
    Along(Box<Along>),
    /// Sparse stiffnesses of thousands of degrees of freedom: two levels, or one with local time steps.
    Sparse(Box<SparseSystem>),
}

impl Model {
    /// The rational system that stands for it: itself; with π in the stiffnesses of several degrees of
    /// freedom within 2^-150 of every entry, of one within 2^-60 (where steps are irrational in the unit of
    /// time of the shortest one); of doubles these doubles; of local steps Verlet's with its effective
    /// stiffness, of the midpoint rule Verlet's with its effective masses, both exactly. Forces that are no
    /// gradient, Hessians along an orbit, and sparse stiffnesses, have none: what is returned has their size
    /// and their clocks, no more.
    pub fn system(&self) -> &System {
        match self {
            Model::Rational(system) | Model::Pi(system) | Model::Elements(system, _) => system,
            Model::Oscillator(oscillator) => &oscillator.rounded,
            Model::Measured(measured_system) => measured_system.system(),
            Model::LocalSteps(local_steps) => local_steps.system(),
            Model::Implicit(implicit_explicit) => implicit_explicit.system(),
            Model::NoGradient(jacobians) => jacobians.symmetric(),
            Model::Along(along) => along.clocks(),
            Model::Sparse(sparse_system) => sparse_system.system(),
        }
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        match self {
            Model::Measured(measured_system) => measured_system.size(),
            _ => self.system().size(),
        }
    }

    /// The products of doubles that the verdict costs, roughly, where doubles prove it.
    pub fn cost(&self) -> u64 {
        match self {
            Model::Measured(measured_system) => measured_system.cost(),
            Model::NoGradient(jacobians) => jacobians.cost(),
            Model::Along(along) => along.cost(),
            Model::Sparse(sparse_system) => sparse_system.cost(),
            _ => verdict_cost(self.system()),
        }
    }

    /// The seconds of one core that these take, as measured on two machines: dense products go side by side.
    pub fn seconds(&self) -> f64 {
        self.seconds_of(self.cost() as f64)
    }

    /// Those that so many products take.
    pub fn seconds_of(&self, products: f64) -> f64 {
        self.counted(products) / PACE
    }

    /// How many of these products limits count.
    pub fn counted(&self, products: f64) -> f64 {
        if self.measured().is_some() || self.along().is_some() { products / DENSE as f64 } else { products }
    }

    /// The verdict with everything that is known beside it.
    ///
    /// # Errors
    /// As [`decide_by`]; a budget error where what would decide exceeds the limits.
    pub fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        match self {
            Model::Rational(system) | Model::Elements(system, _) => decide_by(route, system, limits),
            Model::Pi(_) if route == Route::Exact => Err(self.refused("exact arithmetic")),
            Model::Pi(system) => decide_around(system, limits),
            Model::Oscillator(oscillator) => oscillator.decide(limits),
            Model::Measured(measured_system) => measured_system.decide(route, limits),
            Model::LocalSteps(local_steps) => decide_by(route, local_steps.system(), limits),
            Model::Implicit(implicit_explicit) => decide_by(route, implicit_explicit.system(), limits),
            Model::NoGradient(jacobians) => jacobians.decide(route, limits),
            Model::Along(along) => along.decide(route, limits),
            Model::Sparse(_) if route == Route::Exact => Err(self.refused("exact arithmetic")),
            Model::Sparse(sparse_system) => sparse_system.decide(limits),
        }
    }

    /// The verdict and the growth, which is what a scan shows of each point: of sparse levels without the
    /// margin.
    ///
    /// # Errors
    /// As [`Model::decide`].
    pub fn at_point(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        match self {
            Model::Sparse(sparse_system) if route == Route::Cheapest => sparse_system.at_point(limits),
            _ => self.decide(route, limits),
        }
    }

    /// The proven verdict and nothing else: for two measured levels without an eigenbasis, where it is proven
    /// without one.
    ///
    /// # Errors
    /// As [`Model::decide`].
    pub fn verdict(&self, route: Route, limits: &Limits) -> Result<Holds> {
        match self {
            Model::Measured(measured_system) if route == Route::Cheapest => measured_system.verdict(limits),
            Model::Sparse(sparse_system) if route == Route::Cheapest => sparse_system.verdict(limits),
            _ => Ok(self.decide(route, limits)?.holds()),
        }
    }

    /// What is proven of it, of measured stiffnesses for all within their accuracy: as of its stretches.
    ///
    /// # Errors
    /// As [`Model::decide`].
    pub fn holds(&self, limits: &Limits) -> Result<Holds> {
        self.measured().map_or_else(
            || self.verdict(Route::Cheapest, limits),
            |measured_system| measured_system.holds(limits),
        )
    }

    /// The rational system that moves: of measured stiffnesses without rigid motions and held distances.
    ///
    /// # Errors
    /// Where measured stiffnesses have another null space than that of rigid motions.
    pub fn moving(&self) -> Result<Cow<'_, System>> {
        match self {
            Model::Measured(measured_system) => measured_system.moving(),
            Model::NoGradient(_) | Model::Along(_) | Model::Sparse(_) => {
                Err(self.refused("varying another number than outer"))
            }
            _ => Ok(Cow::Borrowed(self.system())),
        }
    }

    /// The kind by exact arithmetic alone: by characteristic polynomials, part by part; of an oscillator with
    /// π by the four signs, of several degrees of freedom with π that of [`Model::system`].
    ///
    /// # Errors
    /// A budget error, before the work on the part that exceeds it.
    pub fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        match self {
            Model::Oscillator(oscillator) => oscillator.exact_kind(limits),
            Model::Rational(system) | Model::Pi(system) | Model::Elements(system, _) => {
                exact_kind(system, limits)
            }
            Model::LocalSteps(local_steps) => exact_kind(local_steps.system(), limits),
            Model::Implicit(implicit_explicit) => exact_kind(implicit_explicit.system(), limits),
            Model::NoGradient(jacobians) => jacobians.exact(limits).map(|(kind, _)| kind),
            Model::Along(along) => along.exact(limits).map(|(kind, _)| kind),
            Model::Sparse(_) => Err(self.refused("exact arithmetic")),
            Model::Measured(measured_system) => exact_kind(measured_system.moving()?.as_ref(), limits),
        }
    }

    /// The effect of friction of a rate per unit time, O in the middle of every drift.
    ///
    /// # Errors
    /// As [`damped_system`]; π in the stiffnesses of several degrees of freedom, irrational steps.
    pub fn friction(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        match self {
            Model::Rational(system) | Model::Elements(system, _) => damped_system(system, rate, limits),
            Model::Pi(_) => {
                let remedy = "with several degrees of freedom write stiffnesses without pi";
                Err(Error::input("friction", rate, remedy))
            }
            Model::LocalSteps(_) => {
                Err(Error::input("friction", rate, "has no place in a scheme of local steps: leave it out"))
            }
            Model::Implicit(_) => {
                Err(Error::input("method", Method::ImplicitExplicit, "friction is for respa: leave it out"))
            }
            Model::NoGradient(_) => {
                let remedy = "leave it out: the answer has the rate that masks what grows";
                Err(Error::input("friction", rate, remedy))
            }
            Model::Along(_) | Model::Sparse(_) => Err(self.refused("friction")),
            Model::Oscillator(oscillator) => oscillator.friction(rate, limits),
            Model::Measured(measured_system) => measured_system.friction(rate, limits),
        }
    }

    /// The error for questions without an answer: about forces that are no gradient, or about sparse
    /// stiffnesses.
    fn refused(&self, what: &str) -> Error {
        match self {
            Model::Sparse(_) => {
                Error::input("stiffness", "sparse", format!("{what} needs dense stiffnesses"))
            }
            Model::Pi(_) => Error::input(
                "stiffness",
                "with pi",
                format!("{what} on several degrees of freedom needs rational numbers: write them without pi"),
            ),
            Model::Along(_) => {
                let remedy =
                    format!("{what} needs Hessians at one place: the orbit is that of these steps alone");
                Error::input("along_orbit", "true", remedy)
            }
            _ => Error::input("symmetric", "false", format!("{what} needs forces that are gradients")),
        }
    }

    /// This system under another integrator of two levels: measured ones as they are; rational ones exactly
    /// where the fast force is solved for, else in doubles, their entries known within the rounding of these.
    ///
    /// # Errors
    /// Where there are not two levels; π, irrational steps, and what is no gradient, sparse or of local
    /// steps.
    pub fn with_method(self, method: Method) -> Result<Model> {
        let refused = |remedy: &str| Err(Error::input("method", method, remedy));
        match self {
            Model::Measured(measured_system) => Ok(Model::Measured(measured_system.with_method(method)?)),
            Model::Rational(_)
            | Model::Pi(_)
            | Model::Oscillator(_)
            | Model::LocalSteps(_)
            | Model::Elements(..)
            | Model::Along(_)
                if method == Method::Respa =>
            {
                Ok(self)
            }
            Model::Implicit(implicit_explicit) => {
                Model::Rational(implicit_explicit.plain().clone()).with_method(method)
            }
            Model::Rational(system) if method == Method::ImplicitExplicit => {
                Ok(Model::Implicit(Box::new(ImplicitExplicit::new(system)?)))
            }
            Model::Rational(system) => {
                two_clocks(&system)?;
                Ok(Model::Measured(MeasuredSystem::rounded(&system)?.with_method(method)?))
            }
            Model::Pi(_) => refused("is for rational stiffnesses: write them without pi"),
            Model::Oscillator(_) => refused(
                "is for rational numbers: of one mass with pi ask kickdrift word --method, or compare --methods",
            ),
            Model::LocalSteps(_) | Model::Elements(..) => {
                refused("has no place in a scheme of local steps: leave it out")
            }
            Model::NoGradient(_) => refused("is for forces that are gradients: leave it out"),
            Model::Sparse(_) => refused("is for dense stiffnesses: give these, or leave it out"),
            Model::Along(_) => refused("is for Hessians at one place: leave it out"),
        }
    }

    /// A sentence on how it differs from a system about its equilibrium under kicks of all its forces.
    pub fn remark(&self) -> Option<&'static str> {
        match self {
            Model::Implicit(_) => Some(
                "by implicit-explicit: Verlet's with masses M + h^2 F/4 and the stiffness F + S, F the fast one",
            ),
            Model::Along(_) => {
                Some("about the integrator's own orbit: each kick has the Hessians where it falls")
            }
            _ => None,
        }
    }

    /// The step of two rational levels whose fast force is solved for.
    pub fn implicit(&self) -> Option<&ImplicitExplicit> {
        if let Model::Implicit(implicit_explicit) = self { Some(implicit_explicit) } else { None }
    }

    /// Jacobians that are not symmetric, where it is made of such.
    pub fn jacobians(&self) -> Option<&Jacobians> {
        if let Model::NoGradient(jacobians) = self { Some(jacobians) } else { None }
    }

    /// Hessians along an orbit, where it is made of such.
    pub fn along(&self) -> Option<&Along> {
        if let Model::Along(along) = self { Some(along) } else { None }
    }

    /// The summary of local time steps, where some degrees of freedom take substeps: computed when it is
    /// asked for, for sparse systems by some dozen factorizations.
    pub fn local_steps_summary(&self) -> Option<SchemeSummary> {
        match self {
            Model::LocalSteps(local_steps) => Some(local_steps.summary()),
            Model::Elements(_, element_steps) => Some(element_steps.summary()),
            Model::Sparse(sparse_system) => sparse_system.summary(),
            _ => None,
        }
    }

    /// The scheme, where some degrees of freedom of a rational system take substeps.
    pub fn local_steps(&self) -> Option<&LocalSteps> {
        if let Model::LocalSteps(local_steps) = self { Some(local_steps) } else { None }
    }

    fn measured(&self) -> Option<&MeasuredSystem> {
        if let Model::Measured(measured_system) = self { Some(measured_system) } else { None }
    }

    /// The measured stiffnesses whose kernel of two levels decides.
    fn levels(&self) -> Option<&MeasuredSystem> {
        self.measured().filter(|measured_system| measured_system.is_of_two_levels())
    }

    /// The levels of measured stiffnesses, whichever kind they are.
    ///
    /// # Errors
    /// Where the stiffnesses are not measured, and where another integrator than kicks and drifts has them.
    pub fn measured_levels(&self) -> Result<MeasuredLevels<'_>> {
        self.of_two()?.levels()
    }

    /// The steps of measured stiffnesses, innermost first.
    ///
    /// # Errors
    /// Where the stiffnesses are not measured.
    pub fn measured_steps(&self) -> Result<Vec<Rational>> {
        self.of_two()?.refuse_method("advice")?;
        Ok(self.steps())
    }

    fn of_two(&self) -> Result<&MeasuredSystem> {
        let scheme = match self {
            Model::NoGradient(_) | Model::Along(_) => return Err(self.refused("advice")),
            Model::Sparse(_) => {
                let remedy =
                    "advice needs dense stiffnesses: `kickdrift system FILE` has the first unstable step";
                return Err(Error::input("stiffness", "sparse", remedy));
            }
            Model::LocalSteps(_) => Some(Scheme::Lts),
            Model::Elements(..) => Some(Scheme::Avi),
            _ => None,
        };
        if let Some(scheme) = scheme {
            let remedy = "advice is for molecules: `kickdrift system FILE --intervals outer=LO..HI` has the unstable steps";
            return Err(Error::input("scheme", scheme.name(), remedy));
        }
        let remedy = "give stiffnesses by reference, as {\"npz\": \"water.npz\", \"array\": \"fast\"}; `kickdrift system` takes numbers in place";
        self.measured().ok_or_else(|| Error::input("stiffness", "given in place", remedy))
    }

    /// The matrices of two measured levels, rigid motions projected out.
    ///
    /// # Errors
    /// As [`Model::measured_levels`]; steps other than an inner and an outer one.
    pub fn hessians(&self) -> Result<Hessians> {
        let measured_system = self.of_two()?;
        measured_system.check_two_steps()?;
        measured_system.hessians()
    }

    /// The largest ln |λ|/T of two levels of measured stiffnesses, or of Hessians along an orbit, by the
    /// dense full period, rounded; `None` of any other system.
    ///
    /// # Errors
    /// As [`Model::decide`]; a budget error before the work.
    pub fn growth_of_period(&self, limits: &Limits) -> Result<Option<f64>> {
        if let Some(along) = self.along() {
            limits.allow_dense(along.cost(), || "the full period, kick by kick,".into())?;
            return Ok(Some(along.growth_of_period()));
        }
        self.measured().map_or(Ok(None), |measured_system| measured_system.growth_of_period(limits))
    }

    /// The system as two clocks on one oscillator, where it is that, without phases.
    pub fn two_clocks(&self) -> Option<propagator::Oscillator> {
        let system = match self {
            Model::Oscillator(oscillator) => return oscillator.as_two_clocks(),
            Model::Rational(system) | Model::Elements(system, _) if system.size() == 1 => system,
            _ => return None,
        };
        let [fast, slow] = system.clocks() else { return None };
        if [fast, slow].iter().any(|clock| clock.phase != Rational::default()) {
            return None;
        }
        let lambda =
            |clock: &Potential| Laurent::from_rational(clock.stiffness.get(0, 0) / system.mass().get(0, 0));
        let step = |clock: &Potential| Laurent::from_rational(clock.step.clone());
        propagator::Oscillator::new(lambda(fast), lambda(slow), step(fast), step(slow)).ok()
    }

    /// All steps, those of potentials of one clock each for itself.
    pub fn steps(&self) -> Vec<Rational> {
        match self {
            Model::Measured(measured_system) => measured_system.steps(),
            _ => self.system().steps(),
        }
    }
}
