//! The fast stiffness by the midpoint rule over the whole step, the slow one by kicks: Verlet with other
//! masses.
//!
//! Successive positions of the step have (theorem `twice` in proofs/ImplicitExplicitModes.v)
//!
//! ```text
//!     (M + h² F/4) (x₊ − 2 x + x₋) = −h² (F + S) x
//! ```
//!
//! so **the step is Verlet's with masses M + h² F/4 and the stiffness F + S**, and every route of a system of
//! one clock decides it exactly. With h² taken into the stiffness both are linear in h², which is all that
//! the intervals of a step need.

use std::sync::Arc;

use num_traits::One;

use crate::levels::Method;
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::model::Model;
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::decide_by;
use crate::verdict::limits::{Limits, Route};
use number::{Error, Rational, Result, ratio};

/// Two rational levels, the fast one solved for.
#[derive(Clone, Debug)]
pub struct ImplicitExplicit {
    plain: System,
    effective: System,
}

impl ImplicitExplicit {
    /// From a system of two clocks without phases; the force of the shorter step is solved for over the
    /// longer one.
    ///
    /// # Errors
    /// Other clocks; M + h² F/4 that is not positive definite: the fast stiffness is so negative that the
    /// rule has no solution.
    pub fn new(plain: System) -> Result<ImplicitExplicit> {
        let [_, slow] = two_clocks(&plain)?;
        let step = slow.step.clone();
        Ok(ImplicitExplicit { effective: of_step(&plain, &step)?, plain })
    }
}

/// Two rational levels, the force of the shorter step by the midpoint rule over the longer one.
impl Model for ImplicitExplicit {
    /// Verlet's: masses M + h² F/4, the stiffness F + S, the step h.
    fn system(&self) -> &System {
        &self.effective
    }

    fn plain(&self) -> Option<&System> {
        Some(&self.plain)
    }

    fn refused(&self, what: &str) -> Error {
        Error::input("method", Method::ImplicitExplicit, format!("{what} is for respa: leave it out"))
    }

    fn method(&self) -> Method {
        Method::ImplicitExplicit
    }

    fn remark(&self) -> Option<&'static str> {
        Some("by implicit-explicit: Verlet's with masses M + h^2 F/4 and the stiffness F + S, F the fast one")
    }

    /// In the unit of time in which the step is 1.
    fn at_square(&self, square: &Rational) -> Result<System> {
        let [fast, slow] = two_clocks(&self.plain)?;
        let (mass, stiffness) = parts(&self.plain, fast, slow, square);
        of_stiffness(&self.plain, mass, stiffness.scaled(square), Rational::one())
    }

    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        decide_by(Route::Cheapest, &of_step(&self.plain, outer)?, limits)
    }

    fn to_run(&self) -> Result<&System> {
        Err(self.refused("a run"))
    }

    fn with_method(self: Arc<Self>, method: Method) -> Result<Arc<dyn Model>> {
        Arc::new(self.plain.clone()).with_method(method)
    }
}

/// The fast and the slow clock.
///
/// # Errors
/// Other than two, or phases.
pub(super) fn two_clocks(plain: &System) -> Result<[&Potential; 2]> {
    match plain.clocks() {
        [fast, slow] if [fast, slow].iter().all(|potential| potential.phase == Rational::default()) => {
            Ok([fast, slow])
        }
        all => Err(Error::input(
            "method",
            format!("{} clock{}", all.len(), if all.len() == 1 { "" } else { "s" }),
            "is for two levels: give two potentials with different steps and no phases, the shorter one's force is the fast one",
        )),
    }
}

fn parts(plain: &System, fast: &Potential, slow: &Potential, square: &Rational) -> (Symmetric, Symmetric) {
    let (mut mass, mut stiffness) = (plain.mass().clone(), fast.stiffness.clone());
    mass.add_all(&fast.stiffness.scaled(&(square * ratio(1, 4))));
    stiffness.add_all(&slow.stiffness);
    (mass, stiffness)
}

fn of_step(plain: &System, step: &Rational) -> Result<System> {
    let [fast, slow] = two_clocks(plain)?;
    let (mass, stiffness) = parts(plain, fast, slow, &(step * step));
    of_stiffness(plain, mass, stiffness, step.clone())
}

/// Where F and S cancel along a motion it drifts and is not rigid, unless neither holds it.
fn of_stiffness(plain: &System, mass: Symmetric, stiffness: Symmetric, step: Rational) -> Result<System> {
    let step = System::new(mass, vec![Potential::new(stiffness, step)]).map_err(unsolvable)?;
    Ok(step.held_by(plain))
}

fn unsolvable(_: Error) -> Error {
    let remedy = "the fast stiffness is so negative that M + h^2 F/4 is not positive definite: give that force to the other potential";
    Error::input("method", "implicit-explicit", remedy)
}
