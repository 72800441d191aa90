//! How far a verdict on measured stiffnesses stands.

use clocks::verdict::Kind;
use number::{Error, Result, named};

/// Rigid motions that were projected out of every potential.
#[derive(Clone, Debug, PartialEq)]
pub struct Removed {
    /// How many.
    pub count: usize,
    /// "positions", "periodic box", "common null space" or "constraints".
    pub found_by: &'static str,
    /// ‖K r‖₂/‖K‖₂ for the orthonormal rigid motions r, rounded: what was removed of the stiffness of each
    /// potential, by increasing step.
    pub held: Vec<f64>,
    /// ‖Σ K r‖₂/Σ ‖K‖₂: 0 at a minimum.
    pub total: f64,
}

impl Removed {
    /// A warning where the sum of the stiffnesses holds what was set apart.
    pub fn warning(&self, accuracy: f64) -> Option<String> {
        let Removed { found_by, total, .. } = self;
        (*total > accuracy).then(|| {
            format!(
                "the sum of the stiffnesses holds {total:.1e} of their norms along the rigid motions found by {found_by}: the positions are at no \
                 minimum, or an outer force turns the atoms, which then are held; say \"keep_rigid\": true"
            )
        })
    }
}

/// That an accuracy of measured matrices, relative to their norms, is in (0, 1/10).
///
/// # Errors
/// Where it is not.
pub(crate) fn check_accuracy(accuracy: f64) -> Result<()> {
    if accuracy > 0.0 && accuracy < 0.1 {
        return Ok(());
    }
    Err(Error::input("accuracy", accuracy, "give a positive number below 1/10, as 1e-6"))
}

/// That all masses of doubles are positive.
///
/// # Errors
/// Names the first that is not, or not finite.
pub(crate) fn check_masses(masses: &[f64]) -> Result<()> {
    match masses.iter().position(|m| !(m.is_finite() && *m > 0.0)) {
        None => Ok(()),
        Some(i) => Err(Error::input(&format!("masses[{i}]"), masses[i], "a mass must be positive")),
    }
}

named! {
    /// Whether a verdict holds for every matrix within the accuracy of the data.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Holds {
        /// Stable for all of them.
        Stable = "stable",
        /// Unstable for all of them.
        Unstable = "unstable",
        /// The data cannot decide: some matrices are stable and some are not, or no verdict was proven for
        /// all.
        Undecided = "the data do not tell",
    }
}

impl From<Option<Kind>> for Holds {
    fn from(proven: Option<Kind>) -> Holds {
        match proven {
            Some(kind) if kind.is_stable() => Holds::Stable,
            Some(_) => Holds::Unstable,
            None => Holds::Undecided,
        }
    }
}

impl Holds {
    /// Whether it is stable, where that is decided.
    pub fn is_stable(self) -> Option<bool> {
        (self != Holds::Undecided).then_some(self == Holds::Stable)
    }
}

/// How far a verdict on measured stiffnesses stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The integrator: "respa", kicks and drifts, or the name of another.
    pub method: &'static str,
    /// The stated accuracy: every stiffness is known to this times its norm (2-norm, mass-weighted), along an
    /// orbit times the largest norm of its clock's kicks.
    pub accuracy: f64,
    /// The verdict on all matrices within it.
    pub holds: Holds,
    /// The largest ε, rounded down, for which the verdict is proven of all stiffnesses within ε times their
    /// norms: stable or unstable; `None` where it is not proven by the region, counts, or discs.
    pub margin: Option<f64>,
    /// \[lo, hi\]: every outer step in (0, lo] at this number of inner steps is proven stable, hi is proven
    /// unstable.
    pub first_unstable: Option<(f64, f64)>,
    /// Whether the step lies above an unstable one, on an island that no advice should rest on.
    pub is_above_unstable: bool,
    /// The rigid motions projected out.
    pub removed: Option<Removed>,
}
