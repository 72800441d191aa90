//! The order of a word on all problems, exactly.
//!
//! A drift is exp(c A), a kick exp(c B), A = v ∂x and B = f(x) ∂v being derivations along the motion, in the
//! order of time. A kick by c F + d F² is exp(c B − (d/2) \[B, \[A, B\]\]). So a word is a series in
//! monomials of A and B, and has order N on all problems iff its series is that of exp(A + B) up to degree N.
//! Where the kinetic energy is quadratic and the forces are those of a potential, \[B, \[B, \[B, A\]\]\] = 0:
//! the Nyström order, which may be higher. Two forces are B1 and B2 with B1 B2 = B2 B1.
//!
//! A word is exp(F) exp(A + B), and F a sum of commutators: those of the least degree are the leading error.

mod commutator;
#[cfg(test)]
mod perturbed;
mod series;
mod whole;

use std::fmt;
use std::marker::PhantomData;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use super::letters::{Force, Item, Letter, Word};
pub use commutator::ErrorTerm;
use commutator::{Algebra, in_commutators};
use number::{Radical, Rational, Ring, rational};
use series::{Generator, Monomial, Scalar, Series};
use whole::Whole;

/// An order with what is in its way.
#[derive(Clone, Debug, PartialEq)]
pub struct FormalOrder {
    /// The word is exp(A + B) up to this degree; 0 where it is not consistent.
    pub order: u64,
    /// The terms of degree `order` + 1; none where `order` is the largest that is looked for.
    pub error: Vec<ErrorTerm>,
    /// The order when coefficients below 2^-30 count as 0, as rounded coefficients leave them.
    pub nominal: u64,
    /// The terms of degree `nominal` + 1.
    pub nominal_error: Vec<ErrorTerm>,
}

/// The orders of a word on all problems.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneralOrder {
    /// For any two motions A and B that can be followed apart.
    pub general: FormalOrder,
    /// For a quadratic kinetic energy and forces of a potential.
    pub nystrom: FormalOrder,
    /// An order of this size is this one or a higher one.
    pub most: u64,
}

/// Why a word has no order on all problems.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoGeneralOrder {
    /// The midpoint rule is no exponential of drifts and kicks.
    Midpoint,
    /// A filter is a function of the linear fast force.
    Filter,
    /// F³ and higher powers stand for several commutators.
    Powers,
    /// Each letter costs a product of series.
    Long,
}

impl fmt::Display for NoGeneralOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NoGeneralOrder::Midpoint => "the midpoint rule C is no product of drifts and kicks",
            NoGeneralOrder::Filter => "a filter is a function of the linear fast force",
            NoGeneralOrder::Powers => "the third power of a force stands for several commutators",
            NoGeneralOrder::Long => "the word has more than 1,000 letters: write n*(...) where some repeat",
        })
    }
}

/// The largest degree that series are followed to: of one force, and of two, whose monomials are more.
const MAX_DEGREE: [usize; 2] = [9, 7];

/// The most letters of a word as it is written, repeated ones counted once.
const MAX_LETTERS: usize = 1000;

/// 1 .. 9 divide it: the logarithm's coefficients are whole with this factor.
const LOG_MULTIPLE: i64 = 2520;

/// A coefficient below 2^-30 counts as 0 for a nominal order.
const SMALL_LOG2: usize = 30;

impl Word {
    /// The order on all problems. Friction is left out, as in [`Word::order`].
    ///
    /// # Errors
    /// Letters that are no exponentials of commutators.
    pub fn general_order(&self) -> Result<GeneralOrder, NoGeneralOrder> {
        if written(self.items()) > MAX_LETTERS {
            return Err(NoGeneralOrder::Long);
        }
        let letters = self.letters();
        let mut numbers = letters.iter().flat_map(|letter| letter.coefficients());
        if numbers.all(|number| number.field().is_none()) {
            Expansion::<BigInt>::new(self).orders()
        } else {
            Expansion::<Whole>::new(self).orders()
        }
    }
}

/// The expansion of a word in generators times 1/`unit`, in which all coefficients are whole.
struct Expansion<'a, T> {
    word: &'a Word,
    two_forces: bool,
    unit: BigInt,
    scalars: PhantomData<T>,
}

impl<'a, T: Scalar> Expansion<'a, T> {
    fn new(word: &'a Word) -> Expansion<'a, T> {
        // Half the strength of a gradient is whole, too.
        let mut unit = BigInt::from(2);
        for letter in word.letters() {
            for number in letter.coefficients() {
                number.polynomial().coefficients().iter().for_each(|c| unit = unit.lcm(c.denom()));
            }
        }
        Expansion { word, two_forces: word.names_forces(), unit, scalars: PhantomData }
    }

    fn orders(&self) -> Result<GeneralOrder, NoGeneralOrder> {
        let most = MAX_DEGREE[usize::from(self.two_forces)];
        let mut degree = 3;
        loop {
            let error = self.error(degree)?;
            let orders = [false, true].map(|of_a_potential| {
                let algebra = Algebra { two_forces: self.two_forces, of_a_potential };
                self.order(&algebra.reduced(error.clone()), algebra, degree)
            });
            // Most words are of a low order, and the monomials of high degrees are many.
            if degree == most || orders[1].nominal < degree as u64 {
                let [general, nystrom] = orders;
                return Ok(GeneralOrder { general, nystrom, most: most as u64 });
            }
            degree += 2;
        }
    }

    /// F, with word = exp(F) exp(A + B), times [`LOG_MULTIPLE`].
    fn error(&self, degree: usize) -> Result<Series<T>, NoGeneralOrder> {
        let backwards = Series::zero().sum(&self.forces(), &-self.scaled(&Radical::one(), 1));
        let flow_back = backwards.exp(degree);
        Ok(self.product(self.word.items(), degree)?.product(&flow_back, degree).log(LOG_MULTIPLE, degree))
    }

    fn product(&self, items: &[Item], degree: usize) -> Result<Series<T>, NoGeneralOrder> {
        items.iter().try_fold(Series::one(), |before, item| {
            let next = match item {
                Item::Letter(letter) => self.exponent(letter)?.exp(degree),
                Item::Repeat(times, inside) => power(self.product(inside, degree)?, *times, degree),
            };
            Ok(before.product(&next, degree))
        })
    }

    /// x · unitᵏ.
    fn scaled(&self, x: &Radical, k: u32) -> T {
        T::of(&(x * &Radical::from_rational(&Rational::from_integer(self.unit.pow(k)))))
    }

    /// B, B1 or B2, or B1 + B2.
    fn kick(&self, force: Force) -> Series<T> {
        let [first, second] = [Generator::B1, Generator::B2].map(Series::generator);
        match force {
            Force::All if self.two_forces => first.sum(&second, &T::one()),
            Force::All | Force::First => first,
            Force::Second => second,
        }
    }

    /// A and all kicks.
    fn forces(&self) -> Series<T> {
        self.kick(Force::All).sum(&Series::generator(Generator::A), &T::one())
    }

    /// The logarithm of a letter.
    fn exponent(&self, letter: &Letter) -> Result<Series<T>, NoGeneralOrder> {
        let times =
            |series: Series<T>, factor: &Radical| Series::zero().sum(&series, &self.scaled(factor, 1));
        let drift = Series::generator(Generator::A);
        Ok(match letter {
            Letter::Drift(time) => times(drift, time),
            Letter::Friction { .. } => Series::zero(),
            Letter::Flow { force, time } => times(self.kick(*force).sum(&drift, &T::one()), time),
            Letter::Midpoint { .. } => return Err(NoGeneralOrder::Midpoint),
            Letter::Kick { filter, .. } if filter.zero => Series::zero(),
            Letter::Kick { filter, .. } if !filter.is_one() => return Err(NoGeneralOrder::Filter),
            Letter::Kick { powers, .. } if powers.iter().skip(2).any(|c| !c.is_zero()) => {
                return Err(NoGeneralOrder::Powers);
            }
            Letter::Kick { force, powers, .. } => {
                let kick = self.kick(*force);
                let half = Radical::from_rational(&rational::ratio(-1, 2));
                let gradient =
                    powers.get(1).map_or_else(T::zero, |strength| self.scaled(&(strength * &half), 3));
                let commutator = kick.commutator(&drift.commutator(&kick));
                times(kick, &powers[0]).sum(&commutator, &gradient)
            }
        })
    }

    /// What coefficients of a degree are multiplied by in [`Expansion::error`].
    fn scale(&self, degree: usize) -> BigInt {
        let factorial = (1..=degree as i64).fold(BigInt::one(), |product, k| product * k);
        factorial * self.unit.pow(degree as u32) * LOG_MULTIPLE
    }

    fn order(&self, error: &Series<T>, algebra: Algebra, degree: usize) -> FormalOrder {
        let limits: Vec<BigInt> = (0..=degree).map(|n| self.scale(n) >> SMALL_LOG2).collect();
        let before =
            |found: Option<(Monomial, &T)>| found.map_or(degree, |(monomial, _)| monomial.degree() - 1);
        let order = before(error.terms().next());
        let nominal =
            before(error.terms().find(|(monomial, value)| !value.is_below(&limits[monomial.degree()])));
        let terms = |order: usize| {
            let scale = Radical::from_rational(&Rational::new(BigInt::one(), self.scale(order + 1)));
            in_commutators(error.part(order + 1), &scale, algebra)
        };
        let error = terms(order);
        let nominal_error = if nominal == order { error.clone() } else { terms(nominal) };
        FormalOrder { order: order as u64, error, nominal: nominal as u64, nominal_error }
    }
}

/// The letters that are written, each once.
fn written(items: &[Item]) -> usize {
    let count = |item: &Item| match item {
        Item::Letter(_) => 1,
        Item::Repeat(_, inside) => written(inside),
    };
    items.iter().map(count).sum()
}

/// seriesᵗⁱᵐᵉˢ by squaring.
fn power<T: Scalar>(series: Series<T>, times: u64, degree: usize) -> Series<T> {
    let (mut square, mut rest, mut result) = (series, times, Series::one());
    while rest > 0 {
        if rest % 2 == 1 {
            result = result.product(&square, degree);
        }
        rest /= 2;
        if rest > 0 {
            square = square.product(&square, degree);
        }
    }
    result
}
