//! The product of the letters, over any ring that holds the coefficients.

use nalgebra::Matrix2;
use num_traits::Zero;

use super::letters::{Force, Item, Letter, Word};
use crate::number::{Polynomial, Radical, Rational, Ring};
use crate::propagator::methods::respa::power;
use crate::propagator::{apply_drift, apply_kick};

/// h² Λ1 and h² Λ2 in a ring, and how a coefficient is embedded there.
pub struct Forces<S> {
    pub of: [S; 2],
    pub embed: fn(&Radical) -> S,
}

/// A product of letters in the coordinates (x, h v): the matrix divided by the denominator. The matrix's determinant is the
/// square of the denominator; the latter is 1 without midpoints.
#[derive(Clone, Debug, PartialEq)]
pub struct Product<S> {
    pub matrix: Matrix2<S>,
    pub denominator: S,
}

/// The entries as polynomials in s = h² Λ1.
pub type Polynomials = Product<Polynomial<Radical>>;

impl Forces<Polynomial<Radical>> {
    /// Λ2 = 0: the whole force is s.
    pub fn one() -> Self {
        Forces::ratio(&Rational::zero())
    }

    /// Λ2 = ρ Λ1, as polynomials in s.
    pub fn ratio(rho: &Rational) -> Self {
        let s = Polynomial::variable();
        let second = s.scale(&Radical::from_rational(rho));
        Forces { of: [s, second], embed: |c| Polynomial::constant(c.clone()) }
    }
}

impl<S: Ring> Forces<S> {
    fn of(&self, force: Force) -> S {
        match force {
            Force::All => self.of[0].clone() + self.of[1].clone(),
            Force::First => self.of[0].clone(),
            Force::Second => self.of[1].clone(),
        }
    }
}

impl<S: Ring> Product<S> {
    fn identity() -> Self {
        Product { matrix: Matrix2::new(S::one(), S::zero(), S::zero(), S::one()), denominator: S::one() }
    }

    fn times(&mut self, letter: &Letter, forces: &Forces<S>) {
        match letter {
            Letter::Drift(time) => apply_drift(&mut self.matrix, &(forces.embed)(time)),
            Letter::Kick { force, powers } => {
                let force = forces.of(*force);
                // (c + d F + ...) F by Horner's rule.
                let strength = powers
                    .iter()
                    .rev()
                    .fold(S::zero(), |sum, c| S::product(&(sum + (forces.embed)(c)), &force));
                apply_kick(&mut self.matrix, &strength);
            }
            Letter::Midpoint { force, time } => {
                let (force, time) = (forces.of(*force), (forces.embed)(time));
                let kick = S::product(&time, &force);
                let quarter = S::from_rational(&Rational::new(1.into(), 4.into()));
                let part = S::product(&S::product(&kick, &time), &quarter);
                let (mut below, mut above) = (S::one(), S::one());
                below += part.clone();
                above -= part;
                let cayley = Matrix2::new(above.clone(), time, -kick, above);
                self.matrix = cayley * &self.matrix;
                self.denominator *= below;
            }
        }
    }

    fn items(items: &[Item], forces: &Forces<S>) -> Self {
        let mut product = Product::identity();
        for item in items {
            match item {
                Item::Letter(letter) => product.times(letter, forces),
                Item::Repeat(times, inside) => {
                    let Product { matrix, denominator } = Product::items(inside, forces);
                    product.matrix = power(matrix, *times) * &product.matrix;
                    let scalar = power(Matrix2::new(denominator, S::zero(), S::zero(), S::zero()), *times);
                    product.denominator *= scalar[(0, 0)].clone();
                }
            }
        }
        product
    }

    /// The trace times the denominator.
    pub fn trace(&self) -> S {
        self.matrix[(0, 0)].clone() + self.matrix[(1, 1)].clone()
    }
}

impl Word {
    /// The product of all letters.
    pub fn product<S: Ring>(&self, forces: &Forces<S>) -> Product<S> {
        Product::items(self.items(), forces)
    }

    /// The product with entries in ℚ(c^(1/n))\[s\].
    pub fn polynomials(&self, forces: &Forces<Polynomial<Radical>>) -> Polynomials {
        self.product(forces)
    }

    /// Kicks and midpoints when nothing is abbreviated, each counted by its powers of the force: the degree of the entries in s, and a
    /// measure of what they cost.
    pub fn degree(&self) -> u64 {
        fn of(items: &[Item]) -> u64 {
            let one = |item: &Item| match item {
                Item::Letter(Letter::Drift(_)) => 0,
                Item::Letter(Letter::Kick { powers, .. }) => powers.len() as u64,
                Item::Letter(Letter::Midpoint { .. }) => 1,
                Item::Repeat(times, inside) => of(inside).saturating_mul(*times),
            };
            items.iter().map(one).fold(0, u64::saturating_add)
        }
        of(self.items())
    }
}
