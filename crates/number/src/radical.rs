//! The fields ℚ(c^(1/n)) of one real root: the coefficients of integrators, as (3 − √3)/6 and 1/(2 − ∛2).
//!
//! With c > 0 an integer that is no p-th power for any prime p | n, xⁿ − c is irreducible (Vahlen, Capelli),
//! so that every root of a rational number lies in one such field, and whether a number is 0 is decided.
//!
//! ```
//! use kickdrift_number::{ExactSign, Radical, Ring, Sign, rational::ratio};
//! let root = |n: u32, of: i64| Radical::root(&ratio(of, 1), n).unwrap();
//! assert_eq!(root(2, 12), &root(2, 3) + &root(2, 3));
//! assert_eq!(root(3, 8), Radical::from_rational(&ratio(2, 1)));
//! assert_eq!((&root(2, 2) - &Radical::from_rational(&ratio(1414, 1000))).sign(), Sign::Positive);
//! // ∛4 = (∛2)²; √2 lies in another field.
//! let (a, b) = Radical::together(&root(3, 2), &root(3, 4)).unwrap();
//! assert_eq!(&a * &a, b);
//! assert!(Radical::together(&root(3, 2), &root(2, 2)).is_none());
//! ```

use std::sync::Arc;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::element::{Element, NumberField};
use super::{Ball, Polynomial, Rational, Ring};

/// The field ℚ(c^(1/n)), n ≥ 2.
#[derive(Clone, Debug, PartialEq)]
pub struct RadicalField {
    radicand: BigInt,
    n: u32,
    minimal: Arc<[BigInt]>,
}

/// A real number in ℚ(c^(1/n)).
pub type Radical = Element<RadicalField>;

/// The largest n of an n-th root.
pub const MAX_ROOT: u32 = 64;

impl NumberField for RadicalField {
    fn minimal(&self) -> &[BigInt] {
        &self.minimal
    }

    fn generator(&self, bits: u32) -> Ball {
        let floor = (&self.radicand << (u64::from(self.n) * u64::from(bits))).nth_root(self.n);
        let (lower, upper) = (Ball::from_integer(&floor), Ball::from_integer(&(&floor + 1)));
        lower.union(&upper, bits + self.radicand.bits() as u32 + 2).scale2(-i64::from(bits))
    }

    fn names(&self) -> (&'static str, String) {
        ("r", self.name())
    }
}

impl RadicalField {
    fn new(radicand: BigInt, n: u32) -> RadicalField {
        let mut minimal = vec![BigInt::zero(); n as usize + 1];
        (minimal[0], minimal[n as usize]) = (-&radicand, BigInt::one());
        RadicalField { radicand, n, minimal: minimal.into() }
    }

    fn name(&self) -> String {
        if self.n == 2 {
            format!("sqrt({})", self.radicand)
        } else {
            format!("({}^(1/{}))", self.radicand, self.n)
        }
    }

    /// The text of an element, its powers of the root in one: `2^(2/3)` for `(2^(1/3))^2`.
    fn plain(&self, text: String) -> String {
        // Powers of two digits begin as others do.
        if !(3..10).contains(&self.n) {
            return text;
        }
        let (name, c, n) = (self.name(), &self.radicand, self.n);
        // A power that has a factor in common with n is one of another root.
        let powers = (2..n).rev().filter(|k| k.gcd(&n) == 1);
        let text =
            powers.fold(text, |text, k| text.replace(&format!("{name}^{k}"), &format!("{c}^({k}/{n})")));
        if text.contains(&format!("{name}^")) { text } else { text.replace(&name, &format!("{c}^(1/{n})")) }
    }

    /// The root d^(1/m) of this field's kind, where it lies in it: a rational times a power of the generator.
    fn hold(&self, other: &RadicalField) -> Option<Radical> {
        // d^(1/m) = e c^(k/n) iff d^n = e^(mn) c^(km).
        (0..self.n).find_map(|k| {
            let power = Rational::new(other.radicand.pow(self.n), self.radicand.pow(k * other.n));
            let e = exact_root(&power, other.n * self.n)?;
            Some(self.element(Polynomial::monomial(e, k as usize)))
        })
    }
}

/// The n-th root of a rational number ≥ 0, where it is rational.
fn exact_root(x: &Rational, n: u32) -> Option<Rational> {
    let root = |whole: &BigInt| Some(whole.nth_root(n)).filter(|root| root.pow(n) == *whole);
    Some(Rational::new(root(x.numer())?, root(x.denom())?))
}

impl Radical {
    /// x^(1/n), exactly. `None` where it is not real, and where n is 0 or more than [`MAX_ROOT`].
    pub fn root(x: &Rational, n: u32) -> Option<Radical> {
        if n == 0 || n > MAX_ROOT || x.is_negative() {
            return None;
        }
        // The largest d | n of which x is a power leaves no p-th power for a prime p | n/d.
        let (e, degree) =
            (1..=n).rev().filter(|d| n.is_multiple_of(*d)).find_map(|d| Some((exact_root(x, d)?, n / d)))?;
        if degree == 1 || e.is_zero() {
            return Some(Radical::from_rational(&e));
        }
        // (p/q)^(1/n) = (p q^(n−1))^(1/n)/q; small n-th powers come out of the radicand.
        let (mut c, mut factor) =
            (e.numer() * e.denom().pow(degree - 1), Rational::new(BigInt::one(), e.denom().clone()));
        for prime in [2u32, 3, 5, 7, 11, 13] {
            let power = BigInt::from(prime).pow(degree);
            while c.is_multiple_of(&power) {
                c /= &power;
                factor *= BigInt::from(prime);
            }
        }
        // 4^(1/3) = (2^(1/3))²: the generator is the root of no power.
        let power = (2..=c.bits() as u32)
            .rev()
            .find_map(|k| Some((exact_root(&Rational::from_integer(c.clone()), k)?, k)));
        let (c, k) = power.map_or((c, 1), |(e, k)| (e.to_integer(), k));
        Some(RadicalField::new(c, degree).element(Polynomial::monomial(factor, k as usize)))
    }

    /// Both numbers in one field; `None` where that is not one that a single root generates which either of
    /// them is written in.
    pub fn together(a: &Radical, b: &Radical) -> Option<(Radical, Radical)> {
        let (Some(f), Some(g)) = (a.field(), b.field()) else { return Some((a.clone(), b.clone())) };
        if f == g {
            return Some((a.clone(), b.clone()));
        }
        if let Some(root) = f.hold(g) {
            return Some((a.clone(), b.at(&root)));
        }
        g.hold(f).map(|root| (a.at(&root), b.clone()))
    }

    /// This number with `root` as its generator.
    fn at(&self, root: &Radical) -> Radical {
        self.polynomial().map(Radical::from_rational).eval(root)
    }

    /// The number in the notation of words: `1/2 - 1/6*sqrt(3)`, `1/12*2^(2/3) + 1/3`.
    pub fn text(&self, rational: impl Fn(&Rational) -> String) -> String {
        match (self.as_rational(), self.field()) {
            (Some(x), _) => rational(&x),
            (None, None) => self.polynomial().text(&[""]),
            (None, Some(field)) => field.plain(self.polynomial().text(&[&field.name()])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rational::ratio;

    #[test]
    fn powers_of_a_root_are_written_as_one_power() {
        let text = |x: &Radical| x.text(ToString::to_string);
        let root = Radical::root(&ratio(2, 1), 3).unwrap();
        let sum = &(&root * &root) + &root;
        assert_eq!(text(&sum), "2^(2/3) + 2^(1/3)");
        // The square of a fourth root is the root of another field.
        let fourth = Radical::root(&ratio(2, 1), 4).unwrap();
        assert_eq!(text(&(&(&fourth * &fourth) + &fourth)), "(2^(1/4))^2 + (2^(1/4))");
        assert_eq!(text(&Radical::root(&ratio(3, 1), 2).unwrap()), "sqrt(3)");
    }
}
