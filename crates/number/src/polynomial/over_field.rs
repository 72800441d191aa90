//! Polynomials over a number field: division, greatest common divisors, Sturm chains.

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::Polynomial;
use super::sturm::{SignAt, Sturm};
use crate::{Element, ExactSign, NumberField, Rational, Real, Ring, Sign};

impl<F: NumberField> SignAt for Element<F> {
    fn sign_at(f: &[Self], x: &Rational) -> Sign {
        let x = Element::from_rational(x);
        f.iter().rev().fold(Element::zero(), |value, c| &(&value * &x) + c).sign()
    }
}

impl<F: NumberField> Polynomial<Element<F>> {
    /// The polynomial divided by its leading coefficient (0 stays 0).
    pub fn monic(&self) -> Self {
        self.leading().and_then(Element::inverse).map_or_else(Self::zero, |inverse| self.scale(&inverse))
    }

    /// (q, r) with self = q divisor + r and deg r < deg divisor; `None` if divisor = 0.
    pub fn div_rem(&self, divisor: &Self) -> Option<(Self, Self)> {
        let inverse = divisor.leading()?.inverse()?;
        let (mut rest, mut quotient) = (self.clone(), Self::zero());
        while let Some(k) = rest.degree().and_then(|degree| degree.checked_sub(divisor.degree()?)) {
            let term = Polynomial::monomial(rest.leading()? * &inverse, k);
            rest = &rest - &(&term * divisor);
            quotient = &quotient + &term;
        }
        Some((quotient, rest))
    }

    /// The greatest common divisor, monic (0 iff both are 0).
    pub fn gcd(&self, other: &Self) -> Self {
        if let (Some(a), Some(b)) = (self.rational(), other.rational()) {
            return a.gcd(&b).map(Element::from_rational);
        }
        let (mut a, mut b) = (self.clone(), other.monic());
        while let Some((_, rest)) = a.div_rem(&b) {
            (a, b) = (b, rest.monic());
        }
        a.monic()
    }

    /// The monic polynomial with the same roots, each simple (0 stays 0).
    pub fn squarefree(&self) -> Self {
        let repeated = self.gcd(&self.derivative());
        self.div_rem(&repeated).map_or_else(Self::zero, |(quotient, _)| quotient.monic())
    }

    /// The polynomial over ℚ, where all coefficients are rational.
    pub fn rational(&self) -> Option<Polynomial<Rational>> {
        Some(Polynomial::new(self.coefficients().iter().map(Element::as_rational).collect::<Option<_>>()?))
    }
}

impl<F: NumberField> Sturm<Element<F>> {
    /// The chain of f ≠ 0 over a number field, as [`Sturm::new`] makes it over ℚ. Remainders are divided by
    /// the size of their leading coefficients.
    ///
    /// **Panics** if f = 0, whose roots cannot be counted.
    pub fn over_field(f: &Polynomial<Element<F>>) -> Self {
        let f = f.squarefree();
        let mut chain = vec![f.clone(), f.derivative()];
        while let Some((_, rest)) = chain[chain.len() - 2].div_rem(&chain[chain.len() - 1]) {
            let positive = rest.leading().is_none_or(|leading| leading.sign() == Sign::Positive);
            chain.push(if positive { -&rest.monic() } else { rest.monic() });
        }
        chain.retain(|f| !f.is_zero());
        // 1 + max |c_k|, f being monic (Cauchy).
        let size = |c: &Element<F>| c.enclosure(32).abs().upper();
        let largest = f.coefficients().iter().map(size).max().unwrap_or_default();
        let bound =
            Rational::from_integer(BigInt::one() << (largest + Rational::one()).ceil().to_integer().bits());
        Sturm { chain: chain.into_iter().map(|f| f.coefficients().to_vec()).collect(), bound }
    }
}
