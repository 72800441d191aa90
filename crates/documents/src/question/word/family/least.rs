//! The least error of a family of one parameter, proven.
//!
//! A coefficient of the error of degree d is a sum of products of d coefficients of the word, a gradient's
//! standing for three. Where these are polynomials of degree G in the parameter, the sum E of the squares of
//! the error's coefficients is one of degree 2 d G: its values at so many places and one more tell it
//! exactly, and the roots of its derivative are isolated.

use super::asked::Family;
use num_traits::Zero;
use number::polynomial::Sturm;
use number::rational::scale2;
use number::{Ball, Enclosed, Polynomial, Radical, Rational, Ring};
use words::{Item, Letter};

/// Roots are known to this part of the range.
const PLACE_LOG2: i64 = -60;

/// Bits of the error at them, which differs from that at another place by as little as the square of their
/// width.
const BITS: u32 = 512;

/// The largest 2 d G.
const MOST_DEGREE: usize = 60;

/// n of the generators 2^(1/n) and 3^(1/n).
const ROOT: u32 = 64;

impl Family {
    /// The least of the errors of a degree over the whole range of the parameter `at`: two values with the
    /// place between them, or twice an end of the range. `None` where the word is no polynomial in it, has a
    /// number that is not rational, or has two places that are equally good.
    pub(super) fn least_error(&self, at: usize, degree: u64) -> Option<(Rational, Rational)> {
        let (lo, hi) = &self.parameter.0[at].range;
        let bound = 2 * degree as usize * self.degree_in(at)?;
        if bound == 0 || bound > MOST_DEGREE || lo >= hi {
            return None;
        }
        let step = (hi - lo) / Rational::from_integer((bound as i64).into());
        let places = (0..=bound).map(|n| lo + &step * Rational::from_integer((n as i64).into()));
        let known = places.map(|x| self.square_at(at, &x, degree).map(|value| (x, value)));
        let error = Polynomial::through(&known.collect::<Option<Vec<_>>>()?);
        let mut candidates = vec![(lo.clone(), lo.clone()), (hi.clone(), hi.clone())];
        if error.degree().is_some_and(|degree| degree > 1) {
            let chain = Sturm::new(&error.derivative());
            let width = (hi - lo) * scale2(&1.into(), PLACE_LOG2);
            let refined: Vec<_> = chain.isolate().iter().map(|ends| chain.refine(ends, &width)).collect();
            // A root so near to an end is not told apart from it.
            if refined.iter().any(|(a, b)| [lo, hi].iter().any(|end| a <= end && *end <= b)) {
                return None;
            }
            candidates.extend(refined.into_iter().filter(|(a, b)| a > lo && b < hi));
        }
        let enclosed = error.map(Enclosed::<BITS>::from_rational);
        let size = |(lo, hi): &(Rational, Rational)| {
            let x = Ball::from_rational(lo, BITS).union(&Ball::from_rational(hi, BITS), BITS);
            enclosed.eval(&Enclosed(x)).0
        };
        let sizes: Vec<Ball> = candidates.iter().map(size).collect();
        let is_less =
            |n: usize, other: usize| sizes[n].compare(&sizes[other]).is_some_and(|order| order.is_lt());
        let is_least = |&n: &usize| (0..sizes.len()).all(|other| other == n || is_less(n, other));
        (0..sizes.len()).find(is_least).map(|n| candidates.swap_remove(n))
    }

    /// The sum of the squares of the error's coefficients at one value of a parameter; `None` also where an
    /// error of a lower degree is left.
    fn square_at(&self, at: usize, x: &Rational, degree: u64) -> Option<Rational> {
        let mut values = self.values(|parameter| Radical::from_rational(&parameter.range.0));
        values[at] = Radical::from_rational(x);
        let nystrom = self.word_of(&values)?.general_order().ok()?.nystrom;
        match nystrom.order + 1 {
            order if order < degree => None,
            order if order > degree => Some(Rational::zero()),
            _ => {
                let square = |term: &words::ErrorTerm| (&term.coefficient * &term.coefficient).as_rational();
                nystrom.error.iter().map(square).sum()
            }
        }
    }

    fn values(&self, value: impl Fn(&super::asked::Parameter) -> Radical) -> Vec<Radical> {
        self.parameter.0.iter().map(value).collect()
    }

    fn word_of(&self, values: &[Radical]) -> Option<words::Word> {
        let names = self.parameter.0.iter().map(|parameter| parameter.name.as_str());
        let named: Vec<(&str, Radical)> = names.zip(values.iter().cloned()).collect();
        words::Word::with(&self.word, &named).ok()
    }

    /// The degree of the word's coefficients as polynomials in a parameter; `None` where one is a quotient.
    ///
    /// With r = c^(1/64) for the parameter a coefficient is a polynomial p in r below r^64. If it is a
    /// quotient f/g of polynomials below this degree, f - p g is 0 modulo r^64 - c; with the same p for c = 2
    /// and 3 modulo both, whose product has the degree 128: so f = p g.
    fn degree_in(&self, at: usize) -> Option<usize> {
        let name = &self.parameter.0[at].name;
        if self.word.contains('^') || self.word.matches(name.as_str()).count() >= ROOT as usize {
            return None;
        }
        let coefficients = |c: i64| {
            let mut values = self.values(|parameter| Radical::from_rational(&parameter.range.0));
            values[at] = Radical::root(&Rational::from_integer(c.into()), ROOT)?;
            let mut found = Vec::new();
            listed(self.word_of(&values)?.items(), &mut found);
            Some(found)
        };
        let found = coefficients(2)?;
        let degrees = found.iter().map(|c| c.degree().unwrap_or(0));
        (found == coefficients(3)?).then(|| degrees.max().unwrap_or(0))
    }
}

/// The coefficients of all letters, as polynomials in the generator.
fn listed(items: &[Item], found: &mut Vec<Polynomial<Rational>>) {
    for item in items {
        match item {
            Item::Letter(Letter::Friction { .. }) => (),
            Item::Letter(letter) => {
                found.extend(letter.coefficients().iter().map(|c| c.polynomial().clone()))
            }
            Item::Repeat(_, inside) => listed(inside, found),
        }
    }
}
