//! Polynomials in one variable over any [`Ring`]; nested, in several: `Polynomial<Polynomial<Rational>>`
//! is ℚ\[ρ\]\[s\].
//!
//! ```
//! use kickdrift_number::polynomial::Sturm;
//! use kickdrift_number::{Polynomial, Rational, ratio};
//! // (s − 1)² (s² − 2) has the real roots −√2, 1, √2.
//! let s = Polynomial::<Rational>::variable();
//! let shifted = &s - &Polynomial::constant(ratio(1, 1));
//! let f = &(&shifted * &shifted) * &(&(&s * &s) - &Polynomial::constant(ratio(2, 1)));
//! assert_eq!(f.text(&["s"]), "s^4 - 2*s^3 - s^2 + 4*s - 2");
//! assert_eq!(f.count_roots(&ratio(0, 1), &ratio(2, 1)), 2);
//! assert_eq!(Sturm::new(&f).isolate().len(), 3);
//! ```

mod display;
mod divide;
mod integer;
mod over_field;
mod sturm;

pub use display::Text;
pub use integer::common;
pub use integer::in_unit_interval;
pub use integer::quotient;
pub use integer::{residues, roots_within, squarefree};
pub use sturm::RootInterval;
pub use sturm::Sturm;
pub use sturm::sign_at;
pub use sturm::{integers, primitive};

use num_traits::{One, Zero};

use super::operators::ring_operators;
use super::{Rational, Ring};

/// Σ c_k x^k.
///
/// Invariant: the last coefficient is not 0; the polynomial 0 has none.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Polynomial<R> {
    coefficients: Vec<R>,
}

impl<R: Ring> Polynomial<R> {
    /// Σ c_k x^k from c_0, c_1, ...
    pub fn new(mut coefficients: Vec<R>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Polynomial { coefficients }
    }

    /// The constant polynomial c.
    pub fn constant(c: R) -> Self {
        Polynomial::new(vec![c])
    }

    /// The polynomial x.
    pub fn variable() -> Self {
        Polynomial::monomial(R::one(), 1)
    }

    /// c x^k.
    pub fn monomial(c: R, k: usize) -> Self {
        let mut coefficients = vec![R::zero(); k];
        coefficients.push(c);
        Polynomial::new(coefficients)
    }

    /// c_0, c_1, ..., the last one not 0.
    pub fn coefficients(&self) -> &[R] {
        &self.coefficients
    }

    /// c_k, zero beyond the degree.
    pub fn coefficient(&self, k: usize) -> R {
        self.coefficients.get(k).cloned().unwrap_or_else(R::zero)
    }

    /// The degree; `None` for the polynomial 0.
    pub fn degree(&self) -> Option<usize> {
        self.coefficients.len().checked_sub(1)
    }

    /// The leading coefficient; `None` for the polynomial 0.
    pub fn leading(&self) -> Option<&R> {
        self.coefficients.last()
    }

    /// The value at x, by Horner's rule.
    pub fn eval(&self, x: &R) -> R {
        self.coefficients.iter().rev().fold(R::zero(), |mut value, c| {
            value = R::product(&value, x);
            value += c.clone();
            value
        })
    }

    /// The derivative Σ k c_k x^(k−1).
    pub fn derivative(&self) -> Self {
        let scaled =
            |(k, c): (usize, &R)| R::product(&R::from_rational(&Rational::from_integer(k.into())), c);
        Polynomial::new(self.coefficients.iter().enumerate().skip(1).map(scaled).collect())
    }

    /// c times the polynomial.
    pub fn scale(&self, c: &R) -> Self {
        self.map(|number| R::product(number, c))
    }

    /// The polynomial with each coefficient c replaced by f(c).
    pub fn map<S: Ring>(&self, f: impl Fn(&R) -> S) -> Polynomial<S> {
        Polynomial::new(self.coefficients.iter().map(f).collect())
    }

    /// x^k times the polynomial.
    pub fn shift(&self, k: usize) -> Self {
        let mut coefficients = vec![R::zero(); k];
        coefficients.extend_from_slice(&self.coefficients);
        Polynomial::new(coefficients)
    }

    fn sum(&self, other: &Self) -> Self {
        let (mut longer, shorter) =
            if self.degree() >= other.degree() { (self.clone(), other) } else { (other.clone(), self) };
        for (number, c) in longer.coefficients.iter_mut().zip(&shorter.coefficients) {
            *number += c.clone();
        }
        Polynomial::new(longer.coefficients)
    }

    fn difference(&self, other: &Self) -> Self {
        let mut coefficients = self.coefficients.clone();
        coefficients.resize_with(self.coefficients.len().max(other.coefficients.len()), R::zero);
        for (number, c) in coefficients.iter_mut().zip(&other.coefficients) {
            *number -= c.clone();
        }
        Polynomial::new(coefficients)
    }

    fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::zero();
        }
        let mut coefficients = vec![R::zero(); self.coefficients.len() + other.coefficients.len() - 1];
        for (i, a) in self.coefficients.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (number, b) in coefficients[i..].iter_mut().zip(&other.coefficients) {
                number.add_product(a, b);
            }
        }
        Polynomial::new(coefficients)
    }

    fn negated(&self) -> Self {
        self.map(|c| -c.clone())
    }
}

impl Polynomial<Rational> {
    /// The polynomial of least degree through the points (x, f(x)), by Newton's divided differences.
    ///
    /// ```
    /// use kickdrift_number::{Polynomial, rational::ratio};
    /// let f = Polynomial::through(&[(0, 1), (1, 3), (3, 13)].map(|(x, y)| (ratio(x, 1), ratio(y, 1))));
    /// assert_eq!(f.text(&["x"]), "x^2 + x + 1");
    /// ```
    ///
    /// # Panics
    /// Two points with one x.
    pub fn through(points: &[(Rational, Rational)]) -> Self {
        let mut differences: Vec<Rational> = points.iter().map(|(_, y)| y.clone()).collect();
        for order in 1..points.len() {
            for n in (order..points.len()).rev() {
                let apart = &points[n].0 - &points[n - order].0;
                differences[n] = (&differences[n] - &differences[n - 1]) / apart;
            }
        }
        let step = |sum: Self, ((x, _), difference): (&(Rational, Rational), &Rational)| {
            let factor = Polynomial::new(vec![-x.clone(), Rational::one()]);
            &(&sum * &factor) + &Polynomial::constant(difference.clone())
        };
        points.iter().zip(&differences).rev().fold(Polynomial::zero(), step)
    }
}

ring_operators!([R: Ring] Polynomial<R>, |x| Polynomial::constant(R::from_rational(x)));

impl<R: Ring> Zero for Polynomial<R> {
    fn zero() -> Self {
        Polynomial { coefficients: Vec::new() }
    }

    fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }
}

impl<R: Ring> One for Polynomial<R> {
    fn one() -> Self {
        Polynomial::constant(R::one())
    }
}
