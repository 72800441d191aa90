//! Numbers of a real field of finite degree, as polynomials in its generator.

use std::fmt;

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::operators::ring_operators;
use super::{Ball, ExactSign, Polynomial, Rational, Real, Ring, Sign};

/// ℚ(g) for a real algebraic integer g; cheap to clone.
pub trait NumberField: Clone + fmt::Debug + PartialEq + Send + Sync + 'static {
    /// The minimal polynomial of g: monic, lowest coefficient first.
    fn minimal(&self) -> &[BigInt];

    /// A ball about g, to about `bits` bits.
    fn generator(&self, bits: u32) -> Ball;

    /// A letter for g, and what g is: `c`, `2cos(pi/7)`.
    fn names(&self) -> (&'static str, String);

    /// The degree of the field over ℚ.
    fn degree(&self) -> usize {
        self.minimal().len() - 1
    }

    /// The minimal polynomial of g.
    fn minimal_polynomial(&self) -> Polynomial<Rational> {
        Polynomial::new(self.minimal().iter().cloned().map(Rational::from_integer).collect())
    }

    /// The number f(g).
    fn element(&self, f: Polynomial<Rational>) -> Element<Self> {
        let (mut rest, degree) = (f.coefficients().to_vec(), self.degree());
        while rest.len() > degree {
            let top = rest.pop().expect("not empty");
            if top.is_zero() {
                continue;
            }
            // g^k = −Σ ψ_j g^(k − degree + j), ψ being monic.
            let at = rest.len() - degree;
            for (value, c) in rest[at..].iter_mut().zip(self.minimal()).filter(|(_, c)| !c.is_zero()) {
                *value -= &top * c;
            }
        }
        Element::made(Some(self.clone()), Polynomial::new(rest))
    }
}

/// A real number in a field ℚ(g).
///
/// Invariant: the degree is below the field's; a rational number has no field, so that equal numbers
/// are equal values, and rationals mix with every field. Mixing two different fields is a bug and **panics**.
#[derive(Clone, Debug)]
pub struct Element<F> {
    field: Option<F>,
    polynomial: Polynomial<Rational>,
}

impl<F: NumberField> Element<F> {
    /// The number as a rational, if it is one.
    pub fn as_rational(&self) -> Option<Rational> {
        self.field.is_none().then(|| self.polynomial.coefficient(0))
    }

    /// The polynomial in g, of least degree, that the number is.
    pub fn polynomial(&self) -> &Polynomial<Rational> {
        &self.polynomial
    }

    /// The field, unless the number is rational.
    pub fn field(&self) -> Option<&F> {
        self.field.as_ref()
    }

    /// 1/self; `None` for 0.
    pub fn inverse(&self) -> Option<Self> {
        let Some(field) = &self.field else {
            let x = self.polynomial.coefficient(0);
            return (!x.is_zero()).then(|| Element::from_rational(&x.recip()));
        };
        // Euclid on (ψ, f) with the cofactor u of f: u f = r mod ψ. ψ is irreducible, so r ends as a
        // constant.
        let (mut r, mut next) = (field.minimal_polynomial(), self.polynomial.clone());
        let (mut u, mut next_u) = (Polynomial::zero(), Polynomial::one());
        while next.degree() > Some(0) {
            let (quotient, rest) = r.div_rem(&next).expect("not 0");
            let cofactor = &u - &(&quotient * &next_u);
            (r, next) = (next, rest);
            (u, next_u) = (next_u, cofactor);
        }
        let unit = next.coefficient(0).recip();
        Some(field.element(next_u.scale(&unit)))
    }

    /// The field of both operands, if one of them has any.
    fn common_field(&self, other: &Self) -> Option<F> {
        if let (Some(a), Some(b)) = (&self.field, &other.field) {
            assert!(a == b, "numbers of ℚ({}) and ℚ({}) mixed", a.names().1, b.names().1);
        }
        self.field.as_ref().or(other.field.as_ref()).cloned()
    }

    fn made(field: Option<F>, polynomial: Polynomial<Rational>) -> Self {
        let field = field.filter(|_| polynomial.degree() > Some(0));
        Element { field, polynomial }
    }

    fn sum(&self, other: &Self) -> Self {
        Element::made(self.common_field(other), &self.polynomial + &other.polynomial)
    }

    fn difference(&self, other: &Self) -> Self {
        Element::made(self.common_field(other), &self.polynomial - &other.polynomial)
    }

    fn times(&self, other: &Self) -> Self {
        let product = &self.polynomial * &other.polynomial;
        match self.common_field(other) {
            Some(field) => field.element(product),
            None => Element::made(None, product),
        }
    }

    fn negated(&self) -> Self {
        Element { field: self.field.clone(), polynomial: -&self.polynomial }
    }

    /// A ball about the value, all steps rounded to `bits` bits.
    fn evaluated(&self, bits: u32) -> Ball {
        let g = self.field.as_ref().map_or_else(Ball::zero, |field| field.generator(bits));
        self.polynomial.coefficients().iter().rev().fold(Ball::zero(), |value, coefficient| {
            value.mul(&g, bits).add(&Ball::from_rational(coefficient, bits), bits)
        })
    }
}

ring_operators!([F: NumberField] Element<F>, |x| Element { field: None, polynomial: Polynomial::constant(x.clone()) });

impl<F: NumberField> PartialEq for Element<F> {
    /// Equality of the real numbers; **panics** on irrational numbers of two different fields.
    fn eq(&self, other: &Self) -> bool {
        self.common_field(other);
        self.polynomial == other.polynomial
    }
}

impl<F: NumberField> Zero for Element<F> {
    fn zero() -> Self {
        Element { field: None, polynomial: Polynomial::zero() }
    }

    fn is_zero(&self) -> bool {
        self.polynomial.is_zero()
    }
}

impl<F: NumberField> One for Element<F> {
    fn one() -> Self {
        Element::from_rational(&Rational::one())
    }
}

impl<F: NumberField> ExactSign for Element<F> {
    /// 0 iff the reduced polynomial is 0; else from balls of doubling precision, which end because the
    /// number is not 0.
    fn sign(&self) -> Sign {
        if let Some(x) = self.as_rational() {
            return x.sign();
        }
        let mut bits = 128;
        loop {
            if let Some(sign) = self.evaluated(bits).sign() {
                return sign;
            }
            bits *= 2;
        }
    }
}

impl<F: NumberField> Real for Element<F> {
    fn enclosure(&self, bits: u32) -> Ball {
        if let Some(x) = self.as_rational() {
            return x.enclosure(bits);
        }
        Ball::to_accuracy(bits, |working| self.evaluated(working))
    }
}

impl<F: NumberField> fmt::Display for Element<F> {
    /// A polynomial in g, with g said where it matters: `c^2 - 2 [c = 2cos(pi/7)]`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.field.as_ref().map(F::names);
        f.write_str(&self.polynomial.text(&[names.as_ref().map_or("", |(letter, _)| letter)]))?;
        names.map_or(Ok(()), |(letter, value)| write!(f, " [{letter} = {value}]"))
    }
}
