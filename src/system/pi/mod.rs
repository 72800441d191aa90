//! Systems whose stiffnesses involve π: M x'' + Σ_k (Σ_j π^j K_kj) x = 0, decided over ℚ\[π\].
//!
//! π is transcendental, so a rational statement about Σ_j π^j K_kj is one about all K_kj: rigid modes, connected parts and
//! rational invariant subspaces are those that the *coefficients* K_kj have in common, and found over ℚ.
//!
//! Doubles decide as ever, at a rational ϖ in the place of π. It is so near that every entry is within 2^-150 of itself of the true one, while
//! the bounds' constants leave a hundredth of u = 2^-53 for what is of second order: what they prove at ϖ they prove at π.
//! Where they cannot decide, the half period is composed over ℚ\[π\] and brought to ℤ\[π\], where forms have exact inertias and
//! [`moments`] count the multipliers: nothing is left open. Proofs: section 6 of `proofs/SIGNS.md`.
//!
//! | file | what |
//! |---|---|
//! | `coefficients` | a system by its coefficients: at ϖ, as clocks on one oscillator, its half period |
//! | `moments` | the exact verdict without polynomials: inertias of power sums |

mod coefficients;
pub(super) mod moments;

use std::collections::BTreeMap;

pub use coefficients::PiSystem;
use coefficients::Term;

use crate::error::{Error, Result};
use crate::number::Rational;
use crate::system::linear::sparse::Symmetric;
use crate::system::linear::system::{Potential, System, check_mass, check_potential};
use crate::system::verdict::analysis::Analysis;
use crate::system::verdict::decide::{Structure, decided, exact_kind_of};
use crate::system::verdict::limits::{Limits, Route};
use crate::system::verdict::piece::Piece;
use crate::verdict::Kind;

/// The highest power of π, and of 1/π: numbers at ϖ, and degrees in π, grow with it.
const HIGHEST: u32 = 64;

/// One potential xᵀ K x/2 with K = Σ π^j K_j, its force applied as kicks at the times (n + phase) step.
#[derive(Clone, Debug)]
pub struct PiPotential {
    /// K_j by j, force/length.
    pub stiffness: BTreeMap<i32, Symmetric>,
    /// The time between two kicks, positive.
    pub step: Rational,
    /// 0 or 1/2.
    pub phase: Rational,
}

impl PiSystem {
    /// From a rational mass matrix and potentials of its size.
    ///
    /// # Errors
    /// As [`System::new`]; a power of π beyond ±64.
    pub fn new(mass: Symmetric, potentials: Vec<PiPotential>) -> Result<Self> {
        check_mass(&mass)?;
        let (mut coefficients, mut terms) = (Vec::new(), Vec::new());
        for (k, own) in potentials.into_iter().enumerate() {
            for (power, stiffness) in own.stiffness {
                if power.unsigned_abs() > HIGHEST {
                    let remedy = format!("powers of pi may be -{HIGHEST} to {HIGHEST}: choose other units");
                    return Err(Error::input(
                        &format!("potentials[{k}].stiffness"),
                        format!("pi^{power}"),
                        remedy,
                    ));
                }
                let own = Potential { stiffness, step: own.step.clone(), phase: own.phase.clone() };
                check_potential(k, &own, mass.size())?;
                coefficients.push(own);
                terms.push(Term { potential: k, power });
            }
        }
        if coefficients.is_empty() {
            return Err(Error::input("potentials", "none", "give at least one stiffness"));
        }
        PiSystem::of(System::new(mass, coefficients)?, terms.into())
    }

    /// The verdict, as [`decide_by`](crate::system::decide_by): multipliers and growth rates are rounded ones of [`PiSystem::near`].
    ///
    /// # Errors
    /// As [`decide_by`](crate::system::decide_by); a common null vector of all potentials that is not rational.
    pub fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        decided(self.structure(), self.near(), |piece| self.over_pi(piece), (route, limits))
    }

    /// The kind by exact arithmetic alone, part by part.
    ///
    /// # Errors
    /// A budget error, before the work on the part that exceeds it; as [`PiSystem::decide`].
    pub fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        exact_kind_of(self.structure(), |piece| self.over_pi(piece), limits)
    }

    /// Each coefficient is to leave a subspace invariant.
    fn structure(&self) -> Structure<'_> {
        (self.system(), System::single_stiffnesses)
    }

    /// A part of the coefficients as one of the system.
    fn over_pi(&self, piece: Piece) -> Result<Piece> {
        let own = self.of_part(piece.system)?;
        if own.near().rigid_modes().len() > piece.frame.rigid.len() {
            let remedy = "choose coordinates in which the vector that no potential sees is rational";
            return Err(Error::input(
                "stiffness",
                "all potentials have a null vector that involves pi",
                remedy,
            ));
        }
        Ok(Piece { system: own.near().clone(), coefficients: Some(own), ..piece })
    }
}
