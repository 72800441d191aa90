//! Integrators of two forces by name: words of the catalogue, and trigonometric ones.

use num_traits::Zero;

use super::catalogue::{METHODS, method};
use super::letters::Word;
use super::point::at;
use super::product::Forces;
use super::trigonometric::Trigonometric;
use crate::error::{Error, Result};
use crate::number::{Laurent, Rational};

/// An integrator of x'' + (Λ1 + Λ2) x = 0, Λ1 the fast force.
#[derive(Clone, Debug, PartialEq)]
pub enum Integrator {
    /// Kicks, drifts, midpoints; one that names no forces kicks with both at once.
    Word(Word),
    /// The exact flow of the fast force, filtered kicks of the slow one.
    Trigonometric(Trigonometric),
}

/// The answer at one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounded {
    Stable,
    Unstable,
    /// Nearer to an edge of a trigonometric integrator than thousands of bits tell, and no theorem says whether it is one: only where h² Λ1 is neither
    /// rational nor (r π)² with a rational r.
    Edge,
}

impl Integrator {
    /// The integrator of a name in the catalogue, of [`Trigonometric::ALL`], or as a word.
    ///
    /// # Errors
    /// A text that is neither.
    pub fn named(text: &str) -> Result<Integrator> {
        let text = text.trim();
        if let Some(own) = Trigonometric::ALL.into_iter().find(|own| own.name() == text) {
            return Ok(Integrator::Trigonometric(own));
        }
        if let Ok(own) = method(text) {
            return Ok(Integrator::Word(own.word()));
        }
        text.parse().map(Integrator::Word).map_err(|_| {
            let own = Trigonometric::ALL.map(Trigonometric::name).join(", ");
            let names: Vec<&str> = METHODS.iter().map(|method| method.name).collect();
            Error::input(
                "methods",
                text,
                format!("write a word, or choose among {own}, {}", names.join(", ")),
            )
        })
    }

    /// The degree of its entries in s; 1 for what has none.
    pub fn degree(&self) -> u64 {
        match self {
            Integrator::Word(word) => word.degree().max(1),
            Integrator::Trigonometric(_) => 1,
        }
    }

    /// The answers at each s = h² Λ1 > 0, with Λ2 = ρ Λ1 > 0.
    pub fn along(&self, rho: &Rational, all: &[Laurent]) -> Vec<Bounded> {
        let told = |stable: bool| if stable { Bounded::Stable } else { Bounded::Unstable };
        match self {
            Integrator::Word(word) => {
                let product = word.polynomials(&Forces::ratio(rho));
                // At a pole of a midpoint there is no step at all; forces that attract have none.
                all.iter()
                    .map(|s| at(&product, s).map_or(Bounded::Unstable, |own| told(own.is_stable())))
                    .collect()
            }
            Integrator::Trigonometric(own) => {
                all.iter().map(|s| own.at(s, rho).map_or(Bounded::Edge, told)).collect()
            }
        }
    }
}

impl Trigonometric {
    /// Whether the step with h² Λ1 = s is stable; `None` where that is not decided ([`Bounded::Edge`]).
    pub fn at(self, s: &Laurent, rho: &Rational) -> Option<bool> {
        if s.is_zero() {
            return None;
        }
        self.stable_at(s, rho)
    }
}
