//! Power series in the drift A and the kicks B1, B2, which do not commute with A but with each other.

use std::collections::BTreeMap;
use std::ops::{AddAssign, MulAssign, Neg};

use num_bigint::BigInt;
use num_traits::{One, Zero};
use number::{Radical, Rational, Ring};

/// A letter of a monomial. In this order: the kicks come first, so that the Lyndon words of all commutators
/// that vanish for kicks by a potential begin with three kicks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Generator {
    /// The kick by the first force, or by all where the word names none.
    B1,
    /// The kick by the second force.
    B2,
    /// The drift.
    A,
}

const GENERATORS: [Generator; 3] = [Generator::B1, Generator::B2, Generator::A];

/// The lower bit of every generator in a monomial.
const LOWER_BITS: u32 = 0x5555_5555;

/// A product of generators in the order of time, B1 before B2 where they touch: two bits a generator below a
/// leading 1. Monomials of one degree are in lexicographic order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Monomial(u32);

impl Monomial {
    pub(super) const ONE: Monomial = Monomial(1);

    pub(super) fn new(generators: &[Generator]) -> Monomial {
        generators.iter().fold(Monomial::ONE, |product, one| product.times(Monomial(4 | *one as u32)))
    }

    pub(super) fn degree(self) -> usize {
        self.0.ilog2() as usize / 2
    }

    pub(super) fn generators(self) -> Vec<Generator> {
        (0..self.degree()).rev().map(|k| GENERATORS[(self.0 >> (2 * k)) as usize & 3]).collect()
    }

    fn times(self, next: Monomial) -> Monomial {
        let bits = 2 * next.degree();
        let mut product = self.0 << bits | next.0 & ((1 << bits) - 1);
        // A run of kicks may go on across the seam: B2 B1 = B1 B2, from the seam outwards.
        let (b1, b2) = (Generator::B1 as u32, Generator::B2 as u32);
        let end = 2 * self.degree() + bits;
        // Of the generators B2 alone has a lower bit.
        let mut sorted = bits == 0 || (product ^ 1 << end) & LOWER_BITS == 0;
        while !sorted {
            sorted = true;
            for at in (0..end - 2).step_by(2) {
                if product >> at & 15 == b2 << 2 | b1 {
                    product = product & !(15 << at) | (b1 << 2 | b2) << at;
                    sorted = false;
                }
            }
        }
        Monomial(product)
    }
}

/// Numbers that series have: whole ones, or [`Whole`] ones of a field of one root.
pub(super) trait Scalar:
    Clone + PartialEq + Zero + One + Neg<Output = Self> + AddAssign + MulAssign
{
    /// A number of the word that is whole in this sense, in a word whose numbers are of this kind.
    fn of(x: &Radical) -> Self;

    fn whole(x: i64) -> Self;

    /// self += a b.
    fn add_product(&mut self, a: &Self, b: &Self);

    /// Whether |self| < limit.
    fn is_below(&self, limit: &BigInt) -> bool;

    fn radical(&self) -> Radical;
}

impl Scalar for BigInt {
    fn of(x: &Radical) -> BigInt {
        x.polynomial().coefficient(0).to_integer()
    }

    fn whole(x: i64) -> BigInt {
        x.into()
    }

    fn add_product(&mut self, a: &BigInt, b: &BigInt) {
        *self += a * b;
    }

    fn is_below(&self, limit: &BigInt) -> bool {
        self.magnitude() < limit.magnitude()
    }

    fn radical(&self) -> Radical {
        Radical::from_rational(&Rational::from_integer(self.clone()))
    }
}

/// A series up to some degree: at a monomial of n generators n! times its coefficient, so that exponentials
/// of whole multiples of generators, and their products, have whole numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Series<T>(BTreeMap<Monomial, T>);

impl<T: Scalar> Series<T> {
    pub(super) fn zero() -> Series<T> {
        Series(BTreeMap::new())
    }

    pub(super) fn one() -> Series<T> {
        let mut one = Series::zero();
        one.add(Monomial::ONE, &T::one(), &T::one());
        one
    }

    pub(super) fn generator(one: Generator) -> Series<T> {
        let mut series = Series::zero();
        series.add(Monomial::new(&[one]), &T::one(), &T::one());
        series
    }

    /// Adds a b at a monomial.
    fn add(&mut self, at: Monomial, a: &T, b: &T) {
        let value = self.0.entry(at).or_insert_with(T::zero);
        value.add_product(a, b);
        if value.is_zero() {
            self.0.remove(&at);
        }
    }

    pub(super) fn terms(&self) -> impl Iterator<Item = (Monomial, &T)> {
        self.0.iter().map(|(monomial, value)| (*monomial, value))
    }

    /// The first monomial that it has.
    pub(super) fn first(&self) -> Option<(Monomial, T)> {
        self.terms().next().map(|(monomial, value)| (monomial, value.clone()))
    }

    /// The part of one degree.
    pub(super) fn part(&self, degree: usize) -> Series<T> {
        let part = self.terms().filter(|(monomial, _)| monomial.degree() == degree);
        Series(part.map(|(monomial, value)| (monomial, value.clone())).collect())
    }

    /// This + factor · other.
    pub(super) fn sum(mut self, other: &Series<T>, factor: &T) -> Series<T> {
        other.terms().for_each(|(monomial, value)| self.add(monomial, value, factor));
        self
    }

    /// The product, up to `degree`.
    pub(super) fn product(&self, next: &Series<T>, degree: usize) -> Series<T> {
        let mut product = Series::zero();
        // What follows monomials of m generators, times (m + n)!/(m! n!).
        let (mut m, mut following) = (usize::MAX, Vec::new());
        for (left, a) in self.terms() {
            if left.degree() != m {
                m = left.degree();
                let fits = next.terms().take_while(|(right, _)| m + right.degree() <= degree);
                let scaled = fits.map(|(right, b)| {
                    let mut scaled = b.clone();
                    scaled *= T::whole(num_integer::binomial((m + right.degree()) as i64, m as i64));
                    (right, scaled)
                });
                following = scaled.collect();
            }
            for (right, b) in &following {
                product.add(left.times(*right), a, b);
            }
        }
        product
    }

    /// The product of series that hold coefficients as they are, up to `degree`.
    fn plain_product(&self, next: &Series<T>, degree: usize) -> Series<T> {
        let mut product = Series::zero();
        for (left, a) in self.terms() {
            let fits = |right: Monomial| left.degree() + right.degree() <= degree;
            for (right, b) in next.terms().take_while(|(right, _)| fits(*right)) {
                product.add(left.times(right), a, b);
            }
        }
        product
    }

    /// The exponential of a sum of generators and commutators that holds coefficients as they are, up to
    /// `degree`.
    pub(super) fn exp(&self, degree: usize) -> Series<T> {
        let (mut power, mut sum) = (Series::one(), Series::one());
        for k in 1..=degree {
            power = power.plain_product(self, degree);
            // n!/k! for what has n generators.
            let scaled = power.terms().map(|(monomial, value)| {
                let mut value = value.clone();
                (k + 1..=monomial.degree()).for_each(|j| value *= T::whole(j as i64));
                (monomial, value)
            });
            sum = sum.sum(&Series(scaled.collect()), &T::one());
        }
        sum
    }

    /// `multiple` · log(self) for a self whose constant is 1; a multiple that 1 .. `degree` divide.
    pub(super) fn log(&self, multiple: i64, degree: usize) -> Series<T> {
        let rest = self.clone().sum(&Series::one(), &-T::one());
        let (mut power, mut sum) = (rest.clone(), Series::zero());
        for k in (1..).take_while(|k| *k <= degree as i64) {
            if power.0.is_empty() {
                break;
            }
            let sign = if k % 2 == 1 { 1 } else { -1 };
            sum = sum.sum(&power, &T::whole(sign * (multiple / k)));
            power = power.product(&rest, degree);
        }
        sum
    }

    /// `[self, other]`, of sums that hold coefficients as they are.
    pub(super) fn commutator(&self, other: &Series<T>) -> Series<T> {
        let all = usize::MAX >> 1;
        self.plain_product(other, all).sum(&other.plain_product(self, all), &-T::one())
    }

    /// The same in the algebra where `[Bi, [Bj, [Bk, A]]] = 0`: kicks by a potential, the kinetic energy
    /// being quadratic. Three kicks before a drift are rewritten as `b A = Σ over proper parts of (−1)^(2
    /// − |part|) part A rest`, b = Bi Bj Bk; what is left has at most two kicks before each drift, and these
    /// monomials are independent.
    pub(super) fn of_a_potential(&self) -> Series<T> {
        let (mut reduced, mut rest) = (Series::zero(), self.clone());
        while let Some((monomial, value)) = rest.0.pop_first() {
            let generators = monomial.generators();
            let drift = (3..generators.len()).find(|&at| {
                generators[at] == Generator::A && !generators[at - 3..at].contains(&Generator::A)
            });
            let Some(at) = drift else {
                reduced.add(monomial, &value, &T::one());
                continue;
            };
            for part in 0..7_usize {
                let (before, after): (Vec<usize>, Vec<usize>) = (0..3).partition(|k| part >> k & 1 == 1);
                let kicks = |all: &[usize]| all.iter().map(|k| generators[at - 3 + k]).collect::<Vec<_>>();
                let sign = if before.len() % 2 == 0 { T::one() } else { -T::one() };
                let moved = [&generators[..at - 3], &kicks(&before), &[Generator::A], &kicks(&after)];
                let moved = [&moved.concat()[..], &generators[at + 1..]].concat();
                rest.add(Monomial::new(&moved), &value, &sign);
            }
        }
        reduced
    }
}
