//! Whole combinations of the powers of one root: no fraction is reduced, which is most of the work with
//! numbers of its field.

use std::ops::{AddAssign, MulAssign, Neg};
use std::sync::Arc;

use num_bigint::BigInt;
use num_traits::{One, Zero};
use number::{NumberField, Polynomial, Radical, RadicalField, Rational, Real, Ring};

use super::series::Scalar;

/// Σ cⱼ rʲ, r being the root of a field; without a field c₀ alone. No last coefficient is 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Whole {
    field: Option<Arc<RadicalField>>,
    coefficients: Vec<BigInt>,
}

impl Whole {
    fn integer(x: BigInt) -> Whole {
        Whole { field: None, coefficients: vec![x] }.trimmed()
    }

    fn trimmed(mut self) -> Whole {
        self.trim();
        self
    }

    fn trim(&mut self) {
        while self.coefficients.last().is_some_and(Zero::is_zero) {
            self.coefficients.pop();
        }
        if self.coefficients.len() < 2 {
            self.field = None;
        }
    }

    fn add_at(&mut self, j: usize, value: BigInt) {
        if self.coefficients.len() <= j {
            self.coefficients.resize(j + 1, BigInt::zero());
        }
        self.coefficients[j] += value;
    }
}

impl Zero for Whole {
    fn zero() -> Whole {
        Whole { field: None, coefficients: Vec::new() }
    }

    fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }
}

impl One for Whole {
    fn one() -> Whole {
        Whole::integer(BigInt::one())
    }
}

impl Neg for Whole {
    type Output = Whole;

    fn neg(mut self) -> Whole {
        self.coefficients.iter_mut().for_each(|c| *c = -std::mem::take(c));
        self
    }
}

impl std::ops::Add for Whole {
    type Output = Whole;

    fn add(mut self, other: Whole) -> Whole {
        self += other;
        self
    }
}

impl AddAssign for Whole {
    fn add_assign(&mut self, other: Whole) {
        self.field = self.field.take().or(other.field);
        other.coefficients.into_iter().enumerate().for_each(|(j, c)| self.add_at(j, c));
        self.trim();
    }
}

impl std::ops::Mul for Whole {
    type Output = Whole;

    fn mul(self, other: Whole) -> Whole {
        let mut product = Whole::zero();
        product.add_product(&self, &other);
        product
    }
}

impl MulAssign for Whole {
    fn mul_assign(&mut self, other: Whole) {
        *self = std::mem::take(self) * other;
    }
}

impl Default for Whole {
    fn default() -> Whole {
        Whole::zero()
    }
}

impl Scalar for Whole {
    fn of(x: &Radical) -> Whole {
        let coefficients = x.polynomial().coefficients().iter().map(Rational::to_integer).collect();
        Whole { field: x.field().cloned().map(Arc::new), coefficients }.trimmed()
    }

    fn whole(x: i64) -> Whole {
        Whole::integer(x.into())
    }

    fn add_product(&mut self, a: &Whole, b: &Whole) {
        if self.field.is_none() {
            self.field = a.field.as_ref().or(b.field.as_ref()).cloned();
        }
        let field = self.field.clone();
        for (i, x) in a.coefficients.iter().enumerate() {
            for (j, y) in b.coefficients.iter().enumerate() {
                match &field {
                    // The minimal polynomial is rⁿ − c.
                    Some(field) if i + j >= field.degree() => {
                        self.add_at(i + j - field.degree(), -(x * y * &field.minimal()[0]));
                    }
                    _ => self.add_at(i + j, x * y),
                }
            }
        }
        self.trim();
    }

    fn is_below(&self, limit: &BigInt) -> bool {
        // Within 2^-32 of a number that lies near the limit either answer will do.
        self.is_zero() || self.radical().enclosure(32).abs().upper() < Rational::from_integer(limit.clone())
    }

    fn radical(&self) -> Radical {
        let polynomial =
            Polynomial::new(self.coefficients.iter().cloned().map(Rational::from_integer).collect());
        match &self.field {
            Some(field) => field.element(polynomial),
            None => Radical::from_rational(&polynomial.coefficient(0)),
        }
    }
}
