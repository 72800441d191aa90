//! ℤ\[π\]: exact elimination without fractions.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use super::Laurent;
use crate::number::operators::ring_operators;
use crate::number::{Domain, ExactSign, Rational, Sign};

/// An element Σ c_k π^k of ℤ\[π\], k ≥ 0.
///
/// Invariant: the last coefficient is not 0; the number 0 has none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct PiInteger {
    coefficients: Vec<BigInt>,
}

impl PiInteger {
    fn new(mut coefficients: Vec<BigInt>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        PiInteger { coefficients }
    }

    /// Numbers of ℚ\[π, 1/π\] times the least c π^k, c > 0 and k ≥ 0, that brings all of
    /// them to ℤ\[π\]; and that multiple.
    pub fn common<'a>(numbers: impl Iterator<Item = &'a Laurent> + Clone) -> (Vec<PiInteger>, PiInteger) {
        let terms = numbers.clone().flat_map(Laurent::terms);
        let (mut multiple, mut lowest) = (BigInt::one(), 0);
        for (k, c) in terms {
            multiple = multiple.lcm(c.denom());
            lowest = lowest.min(*k);
        }
        let lifted = |x: &Laurent| {
            let top = x.terms().last().map_or(0, |(k, _)| (k - lowest) as usize + 1);
            let mut coefficients = vec![BigInt::zero(); top];
            for (k, c) in x.terms() {
                coefficients[(k - lowest) as usize] = c.numer() * (&multiple / c.denom());
            }
            PiInteger::new(coefficients)
        };
        (numbers.map(lifted).collect(), lifted(&Laurent::one()))
    }

    fn sum(&self, other: &Self) -> Self {
        let (longer, shorter) =
            if self.coefficients.len() >= other.coefficients.len() { (self, other) } else { (other, self) };
        let mut coefficients = longer.coefficients.clone();
        coefficients.iter_mut().zip(&shorter.coefficients).for_each(|(own, c)| *own += c);
        PiInteger::new(coefficients)
    }

    fn difference(&self, other: &Self) -> Self {
        let mut coefficients = self.coefficients.clone();
        coefficients.resize(self.coefficients.len().max(other.coefficients.len()), BigInt::zero());
        coefficients.iter_mut().zip(&other.coefficients).for_each(|(own, c)| *own -= c);
        PiInteger::new(coefficients)
    }

    fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return PiInteger::default();
        }
        let mut coefficients = vec![BigInt::zero(); self.coefficients.len() + other.coefficients.len() - 1];
        for (j, c) in self.coefficients.iter().enumerate() {
            for (k, d) in other.coefficients.iter().enumerate() {
                coefficients[j + k] += c * d;
            }
        }
        PiInteger { coefficients }
    }

    fn negated(&self) -> Self {
        PiInteger { coefficients: self.coefficients.iter().map(|c| -c).collect() }
    }
}

ring_operators!([] PiInteger);

impl Zero for PiInteger {
    fn zero() -> Self {
        PiInteger::default()
    }

    fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }
}

impl One for PiInteger {
    fn one() -> Self {
        PiInteger { coefficients: vec![BigInt::one()] }
    }
}

impl Domain for PiInteger {
    fn from_integer(n: i64) -> Self {
        PiInteger::new(vec![n.into()])
    }

    fn product(&self, other: &Self) -> Self {
        self.times(other)
    }

    fn divided_exactly_by(&self, divisor: &Self) -> Self {
        let n = divisor.coefficients.len();
        let leading = divisor.coefficients.last().expect("a divisor that is not 0");
        let mut rest = self.coefficients.clone();
        let mut quotient = vec![BigInt::zero(); (rest.len() + 1).saturating_sub(n)];
        for k in (0..quotient.len()).rev() {
            // The quotient is in ℤ[π], so its coefficients are whole, highest first.
            let factor = &rest[k + n - 1] / leading;
            rest[k..].iter_mut().zip(&divisor.coefficients).for_each(|(own, c)| *own -= &factor * c);
            quotient[k] = factor;
        }
        debug_assert!(rest.iter().all(Zero::is_zero), "not divisible");
        PiInteger::new(quotient)
    }

    fn sign(&self) -> Sign {
        let terms = self.coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero());
        let terms = terms.map(|(k, c)| (k as i32, Rational::from_integer(c.clone())));
        Laurent { terms: terms.collect() }.sign()
    }

    fn length(&self) -> u64 {
        self.coefficients.iter().map(|c| c.bits() + 1).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse::parse;
    use proptest::prelude::*;

    fn number(coefficients: &[i64]) -> PiInteger {
        PiInteger::new(coefficients.iter().map(|&c| c.into()).collect())
    }

    proptest! {
        #[test]
        fn products_are_divided_exactly(
            a in prop::collection::vec(-50i64..50, 0..6), b in prop::collection::vec(-50i64..50, 1..5),
        ) {
            let (a, b) = (number(&a), number(&b));
            prop_assume!(!b.is_zero());
            prop_assert_eq!(a.product(&b).divided_exactly_by(&b), a.clone());
            prop_assert_eq!(&(&a + &b) - &b, a.clone());
            prop_assert_eq!(a.product(&b).sign().to_i8(), a.sign().to_i8() * b.sign().to_i8());
        }
    }

    #[test]
    fn a_common_multiple_brings_all_numbers_to_integers() {
        let numbers = ["22/7 - pi", "3/(2*pi)", "0"].map(|text| parse("x", text).unwrap());
        let (lifted, multiple) = PiInteger::common(numbers.iter());
        // 14 pi.
        assert_eq!(multiple, number(&[0, 14]));
        assert_eq!(lifted, [number(&[0, 44, -14]), number(&[21]), number(&[])]);
        assert_eq!(lifted[0].sign(), Sign::Positive);
    }
}
