//! Two sparse levels of thousands of degrees of freedom: what is proven of the first stable region.

use num_traits::One;

use crate::error::{Error, Result};
use crate::number::{Laurent, Rational};
use crate::system::levels::sparse::SparseLevels;
use crate::system::levels::{Method, Outer};
use crate::system::linear::sparse::Symmetric;
use crate::system::linear::system::{Potential, System};
use crate::system::verdict::analysis::{Analysis, Evidence, Part};
use crate::system::verdict::limits::{Limits, degrees_of_freedom};
use crate::system::verdict::measured::{Holds, Measured, Removed, check_accuracy};
use crate::verdict::Kind;

/// Two sparse levels with their steps.
#[derive(Clone, Debug)]
pub struct SparseSystem {
    levels: SparseLevels,
    outer: Outer,
    step: Rational,
    accuracy: f64,
    removed: Option<Removed>,
    /// With the size and the clocks alone.
    clocks: System,
}

/// What is left out of the answer.
const NOTE: &str = "of sparse stiffnesses the first stable region is decided: what lies above it is not looked at, and no growth rate is computed";

/// Factorizations that an answer takes, roughly; a product of theirs, in dense blocks, takes a hundredth of the time that one of an eigenvalue
/// iteration does, as measured on droplets of 500 and 2,000 waters.
const FACTORIZATIONS: f64 = 40.0;
const FASTER: f64 = 100.0;

impl SparseSystem {
    /// From two levels with an inner step and a multiple of it, each stiffness known to `accuracy` times its norm; the motions that were set
    /// apart are told in answers.
    ///
    /// # Errors
    /// An outer step that is no multiple of the inner one, an accuracy that is not in (0, 1/10).
    pub fn new(
        levels: SparseLevels,
        [inner, outer]: [&Rational; 2],
        accuracy: f64,
        removed: Option<Removed>,
    ) -> Result<SparseSystem> {
        check_accuracy(accuracy)?;
        let n = levels.size();
        let steps = [inner, outer].map(|step| Potential::new(Symmetric::zero(n), step.clone()));
        let clocks = System::new(Symmetric::diagonal(&vec![Rational::one(); n]), steps.into())?;
        let at = Outer::of_steps(inner, outer).ok_or_else(|| {
            Error::input(
                "step",
                outer,
                format!("the outer step of sparse stiffnesses is a multiple of the inner one, {inner}"),
            )
        })?;
        Ok(SparseSystem { levels, outer: at, step: outer.clone(), accuracy, removed, clocks })
    }

    /// The same with another accuracy.
    ///
    /// # Errors
    /// One that is not in (0, 1/10).
    pub fn at_accuracy(self, accuracy: f64) -> Result<SparseSystem> {
        check_accuracy(accuracy)?;
        Ok(SparseSystem { accuracy, ..self })
    }

    /// Its size and its clocks, without stiffnesses.
    pub(super) fn system(&self) -> &System {
        &self.clocks
    }

    /// Products, at the pace of eigenvalue iterations.
    pub(super) fn cost(&self) -> u64 {
        (FACTORIZATIONS / FASTER * self.levels.products()).min(1e19) as u64
    }

    fn allow(&self, limits: &Limits) -> Result<()> {
        limits.allow(self.cost(), || format!("factorizations of {}", degrees_of_freedom(self.levels.size())))
    }

    /// The verdict, how far it stands, and where the first region ends.
    pub(super) fn decide(&self, limits: &Limits) -> Result<Analysis> {
        self.allow(limits)?;
        let (levels, outer) = (&self.levels, &self.outer);
        let verdict = levels.verdict(outer, 0.0);
        let (kind, evidence) = match verdict {
            Holds::Stable => (Some(Kind::Elliptic), Evidence::Signs),
            Holds::Unstable => (Some(Kind::Hyperbolic), Evidence::Signs),
            Holds::NotTold => (None, Evidence::Estimate),
        };
        let first_unstable = levels.first_unstable(outer.inner_steps());
        let part = Part::new(
            levels.size(),
            Laurent::from_rational(self.step.clone()),
            (kind, evidence),
            Default::default(),
        );
        let measured = Some(Measured {
            method: Method::default().name(),
            accuracy: self.accuracy,
            holds: levels.verdict(outer, self.accuracy),
            margin: if verdict == Holds::Stable { levels.margin(outer) } else { None },
            first_unstable,
            is_above_unstable: first_unstable.is_some_and(|(_, hi)| outer.step() > hi),
            removed: self.removed.clone(),
        });
        let mut notes = vec![NOTE.into()];
        if let Some(count) = levels.unheld().filter(|&count| count > 0) {
            let s = if count == 1 { "" } else { "s" };
            notes.push(format!(
                "along {count} direction{s}, rigid motions aside, both stiffnesses together are not proven positive, as where positions are no \
                 minimum: the system may fall along them at any step"
            ));
            notes.extend(levels.first_resonance(outer.inner_steps()).map(|(lo, hi)| {
                format!(
                    "apart from such falls nothing grows at any outer step up to {lo:.6} with as many inner steps; at {hi:.6} a resonance grows \
                     (both proven)"
                )
            }));
        }
        Ok(Analysis { measured, ..Analysis::of_part(part, 2, notes) })
    }

    /// What is proven, and nothing else.
    pub(super) fn verdict(&self, limits: &Limits) -> Result<Holds> {
        self.allow(limits)?;
        Ok(self.levels.verdict(&self.outer, 0.0))
    }
}
