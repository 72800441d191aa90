//! Integrators of two forces by name or as words, each by its quickest route.

use super::catalogue::method;
use super::enclosed::Enclosed;
use super::letters::Word;
use super::point::{At, at};
use super::product::Forces;
use super::trigonometric::Shape;
use number::{Laurent, Rational, Result};

/// An integrator of x'' + (Λ1 + Λ2) x = 0, Λ1 the fast force.
#[derive(Clone, Debug, PartialEq)]
pub enum Integrator {
    /// Kicks, drifts, midpoints; one that names no forces kicks with both at once.
    Word(Word),
    /// The exact flow of the fast force, filtered kicks of the slow one: all that its trace is made of.
    Trigonometric(Shape),
}

/// The answer at one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounded {
    Stable,
    Unstable,
    /// With one filtered kick beside one exact flow: nearer to an edge than thousands of bits resolve, and no
    /// theorem decides whether it is one; only where h² Λ1 is neither rational nor (r π)² with a rational r.
    /// Other words with flows or filters: on an edge, or nearer than 128 bits resolve.
    Edge,
}

impl Integrator {
    /// The word of a name in the catalogue, or as it is written.
    ///
    /// # Errors
    /// A text that is neither.
    pub fn word(text: &str) -> Result<Word> {
        let text = text.trim();
        match (method(text), text.parse()) {
            (Ok(method), _) => Ok(method.word()),
            (_, Ok(word)) => Ok(word),
            // Letters have coefficients, names have none.
            (_, Err(wrong)) if text.contains('(') => Err(wrong),
            (Err(unknown), _) => Err(unknown.at("methods")),
        }
    }

    /// A word, by the quickest route to its verdicts.
    pub fn of(word: Word) -> Integrator {
        match Shape::of(&word) {
            Some(shape) => Integrator::Trigonometric(shape),
            None => Integrator::Word(word),
        }
    }

    /// The degree of its entries in s; 1 for what has none.
    pub fn degree(&self) -> u64 {
        match self {
            Integrator::Word(word) => word.degree().max(1),
            Integrator::Trigonometric(_) => 1,
        }
    }

    /// The answers at each s = h² Λ1 > 0, with Λ2 = ρ Λ1 > 0; ρ = 0 for a word that names no forces.
    pub fn along(&self, rho: &Rational, all: &[Laurent]) -> Vec<Bounded> {
        let bounded = |stable: bool| if stable { Bounded::Stable } else { Bounded::Unstable };
        match self {
            Integrator::Word(word) if !word.is_algebraic() => {
                let one = Laurent::from_integer(1);
                let at = |s| Enclosed::scaled(word, s, rho).at(&one);
                let answer =
                    |place: At| if place.kind == "edge" { Bounded::Edge } else { bounded(place.is_stable()) };
                all.iter().map(|s| at(s).map_or(Bounded::Edge, answer)).collect()
            }
            Integrator::Word(word) => {
                let product = word.polynomials(&Forces::ratio(rho));
                // At a pole of a midpoint there is no step at all; forces that attract have none.
                all.iter()
                    .map(|s| at(&product, s).map_or(Bounded::Unstable, |place| bounded(place.is_stable())))
                    .collect()
            }
            Integrator::Trigonometric(shape) => {
                all.iter().map(|s| shape.stable_at(s, rho).map_or(Bounded::Edge, bounded)).collect()
            }
        }
    }
}
