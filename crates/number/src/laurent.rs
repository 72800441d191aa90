//! ℚ[π, 1/π]: the exact numbers that people write for steps and stiffnesses.
//!
//! An element is Σ c_k π^k with rational c_k. Since π is transcendental, it is 0 iff all c_k are, so
//! equality is equality of coefficients and every sign is decidable.
//!
//! ```
//! use kickdrift_number::{ExactSign, Laurent, Sign, parse};
//! let x = parse::parse("x", "22/7 - pi").unwrap();
//! assert_eq!(x.sign(), Sign::Positive);
//! assert_eq!((&x * &Laurent::pi_power(-1)).to_string(), "22/(7*pi) - 1");
//! ```

mod display;
mod enclose;

use std::cmp::Ordering;
use std::collections::BTreeMap;

use num_traits::{One, Zero};

use super::operators::ring_operators;
use super::{ExactSign, Rational, Sign, reduced};

/// An element Σ c_k π^k of ℚ[π, 1/π].
///
/// Invariant: the exponents increase and no coefficient is 0, so equal numbers have equal terms.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Laurent {
    terms: Vec<(i32, Rational)>,
}

impl Laurent {
    /// The rational x.
    pub fn from_rational(x: Rational) -> Laurent {
        Laurent::monomial(x, 0)
    }

    /// The integer n.
    pub fn from_integer(n: i64) -> Laurent {
        Laurent::from_rational(Rational::from_integer(n.into()))
    }

    /// π^k.
    pub fn pi_power(k: i32) -> Laurent {
        Laurent::monomial(Rational::one(), k)
    }

    /// c π^k.
    #[inline]
    pub fn monomial(c: Rational, k: i32) -> Laurent {
        Laurent { terms: if c.is_zero() { Vec::new() } else { vec![(k, c)] } }
    }

    /// The terms (k, c_k), c_k ≠ 0, by increasing k.
    pub fn terms(&self) -> &[(i32, Rational)] {
        &self.terms
    }

    /// The value with π replaced by x: Σ c_k x^k.
    ///
    /// **Panics** for x = 0 where there are negative powers.
    pub fn at(&self, x: &Rational) -> Rational {
        self.terms.iter().fold(Rational::zero(), |sum, (k, c)| sum + c * x.pow(*k))
    }

    /// The number as a rational, if it is one: zero, or the term k = 0 alone.
    pub fn as_rational(&self) -> Option<Rational> {
        match self.terms.as_slice() {
            [] => Some(Rational::zero()),
            [(0, c)] => Some(c.clone()),
            _ => None,
        }
    }

    /// (k, c) if the number is c π^k with c ≠ 0.
    pub fn as_monomial(&self) -> Option<(i32, &Rational)> {
        match self.terms.as_slice() {
            [(k, c)] => Some((*k, c)),
            _ => None,
        }
    }

    /// self / divisor in ℚ[π, 1/π], for divisors c π^k; `None` for 0 and for sums of several powers of π.
    ///
    /// **Panics** if an exponent of π leaves the range of `i32`.
    pub fn checked_div(&self, divisor: &Laurent) -> Option<Laurent> {
        let (k, c) = divisor.as_monomial()?;
        let lowered = |j: i32| j.checked_sub(k).expect("exponent of π");
        let terms = self.terms.iter().map(|(j, d)| (lowered(*j), d / c)).collect();
        Some(Laurent { terms })
    }

    /// self^n; `None` if n < 0 and self is not c π^k with c ≠ 0.
    ///
    /// **Panics** if an exponent of π leaves the range of `i32`.
    pub fn pow(&self, n: i32) -> Option<Laurent> {
        if let Some((k, c)) = self.as_monomial() {
            return Some(Laurent::monomial(c.pow(n), k.checked_mul(n).expect("exponent of π")));
        }
        let n = u32::try_from(n).ok()?;
        Some((0..32 - n.leading_zeros()).rev().fold(Laurent::one(), |power, bit| {
            let square = &power * &power;
            if n >> bit & 1 == 1 { &square * self } else { square }
        }))
    }

    /// a / b if that is rational (b ≠ 0 and the coefficients of a and b are proportional), else `None`.
    pub fn ratio(a: &Laurent, b: &Laurent) -> Option<Rational> {
        let (_, leading) = b.terms.first()?;
        let Some((_, value)) = a.terms.first() else { return Some(Rational::zero()) };
        let ratio = reduced::product(value, &leading.recip());
        let proportional = a.terms.len() == b.terms.len()
            && a.terms.iter().zip(&b.terms).all(|((j, _), (k, _))| j == k)
            && a.terms.iter().zip(&b.terms).skip(1).all(|((_, c), (_, d))| *c == &ratio * d);
        proportional.then_some(ratio)
    }

    /// The bits of all numerators and denominators.
    pub fn size(&self) -> u64 {
        self.terms.iter().map(|(_, c)| c.numer().bits() + c.denom().bits()).sum()
    }

    fn sum(&self, other: &Laurent) -> Laurent {
        self.merged(other, |value, c| *value += c)
    }

    fn difference(&self, other: &Laurent) -> Laurent {
        self.merged(other, |value, c| *value -= c)
    }

    /// The terms of both, those of `other` entered by `combine` (which starts from 0 where self has none).
    fn merged(&self, other: &Laurent, combine: impl Fn(&mut Rational, &Rational)) -> Laurent {
        let mut terms = self.terms.clone();
        for (k, c) in &other.terms {
            match terms.binary_search_by_key(k, |(k, _)| *k) {
                Ok(at) => combine(&mut terms[at].1, c),
                Err(at) => {
                    terms.insert(at, (*k, Rational::zero()));
                    combine(&mut terms[at].1, c);
                }
            }
        }
        terms.retain(|(_, c)| !c.is_zero());
        Laurent { terms }
    }

    fn times(&self, other: &Laurent) -> Laurent {
        if let (Some((j, c)), Some((k, d))) = (self.as_monomial(), other.as_monomial()) {
            return Laurent::monomial(reduced::product(c, d), j.checked_add(k).expect("exponent of π"));
        }
        let mut products: BTreeMap<i32, Rational> = BTreeMap::new();
        for (j, c) in &self.terms {
            for (k, d) in &other.terms {
                let exponent = j.checked_add(*k).expect("exponent of π");
                *products.entry(exponent).or_insert_with(Rational::zero) += c * d;
            }
        }
        Laurent { terms: products.into_iter().filter(|(_, c)| !c.is_zero()).collect() }
    }

    fn negated(&self) -> Laurent {
        Laurent { terms: self.terms.iter().map(|(k, c)| (*k, -c)).collect() }
    }
}

ring_operators!([] Laurent, |x| Laurent::from_rational(x.clone()));

impl Zero for Laurent {
    fn zero() -> Laurent {
        Laurent::default()
    }

    fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }
}

impl One for Laurent {
    fn one() -> Laurent {
        Laurent::pi_power(0)
    }
}

impl PartialOrd for Laurent {
    fn partial_cmp(&self, other: &Laurent) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Laurent {
    /// The order of the real numbers, decided by the sign of the difference.
    fn cmp(&self, other: &Laurent) -> Ordering {
        match (self - other).sign() {
            Sign::Negative => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Positive => Ordering::Greater,
        }
    }
}
