//! Division with remainder; greatest common divisors.

use num_traits::{One, Zero};

use super::{Polynomial, sturm};
use crate::{Rational, Ring};

impl<R: Ring> Polynomial<R> {
    /// `self -= c x^k other`.
    fn subtract_shifted(&mut self, c: &R, k: usize, other: &Self) {
        for (number, d) in self.coefficients[k..].iter_mut().zip(&other.coefficients) {
            number.sub_product(c, d);
        }
        while self.coefficients.last().is_some_and(Zero::is_zero) {
            self.coefficients.pop();
        }
    }
}

impl Polynomial<Rational> {
    /// The polynomial divided by its leading coefficient (0 stays 0).
    pub fn monic(&self) -> Self {
        match self.leading() {
            Some(leading) if !leading.is_one() => self.scale(&leading.recip()),
            _ => self.clone(),
        }
    }

    /// A positive multiple with integer coefficients that have no common factor (0 stays 0).
    pub fn primitive(&self) -> Self {
        Polynomial::new(sturm::integers(self).into_iter().map(Rational::from_integer).collect())
    }

    /// (q, r) with self = q divisor + r and deg r < deg divisor; `None` if divisor = 0.
    pub fn div_rem(&self, divisor: &Self) -> Option<(Self, Self)> {
        let inverse = divisor.leading()?.recip();
        let (mut rest, n) = (self.clone(), divisor.coefficients.len());
        let mut quotient = vec![Rational::zero(); (self.coefficients.len() + 1).saturating_sub(n)];
        while rest.coefficients.len() >= n {
            let k = rest.coefficients.len() - n;
            let factor = &rest.coefficients[k + n - 1] * &inverse;
            rest.subtract_shifted(&factor, k, divisor);
            quotient[k] = factor;
        }
        Some((Polynomial::new(quotient), rest))
    }

    /// The greatest common divisor, monic (0 iff both are 0).
    pub fn gcd(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return if self.is_zero() { other.monic() } else { self.monic() };
        }
        let (mut a, mut b) = (sturm::integers(self), sturm::integers(other));
        if a.len() < b.len() {
            std::mem::swap(&mut a, &mut b);
        }
        while !b.is_empty() {
            let rest = sturm::remainder(&a, &b);
            (a, b) = (b, rest);
        }
        Polynomial::new(a.into_iter().map(Rational::from_integer).collect()).monic()
    }

    /// The monic polynomial with the same roots, each simple (0 stays 0).
    pub fn squarefree(&self) -> Self {
        let repeated = self.gcd(&self.derivative());
        self.div_rem(&repeated).map_or_else(Self::zero, |(quotient, _)| quotient.monic())
    }
}
