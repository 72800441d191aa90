//! Division: with remainder over a field, exactly over a domain; greatest common divisors and resultants.

use num_traits::{One, Zero};

use super::{Polynomial, sturm};
use crate::number::{Rational, Ring};

/// A ring without zero divisors whose exact quotients can be computed.
pub trait ExactDivision: Ring {
    /// The element q with `self = divisor q`.
    ///
    /// **Panics** if there is none or divisor = 0: that is a bug of the caller.
    fn divided_exactly_by(&self, divisor: &Self) -> Self;
}

impl ExactDivision for Rational {
    fn divided_exactly_by(&self, divisor: &Self) -> Self {
        self / divisor
    }
}

impl<R: ExactDivision> ExactDivision for Polynomial<R> {
    fn divided_exactly_by(&self, divisor: &Self) -> Self {
        let leading = divisor.leading().expect("a divisor that is not 0");
        let (mut rest, n) = (self.clone(), divisor.coefficients.len());
        let mut quotient = vec![R::zero(); (self.coefficients.len() + 1).saturating_sub(n)];
        while rest.coefficients.len() >= n {
            let k = rest.coefficients.len() - n;
            let factor = rest.coefficients[k + n - 1].divided_exactly_by(leading);
            rest.subtract_shifted(&factor, k, divisor);
            quotient[k] = factor;
        }
        assert!(rest.is_zero(), "not divisible");
        Polynomial::new(quotient)
    }
}

impl<R: Ring> Polynomial<R> {
    /// `self -= c x^k other`.
    fn subtract_shifted(&mut self, c: &R, k: usize, other: &Self) {
        for (own, d) in self.coefficients[k..].iter_mut().zip(&other.coefficients) {
            own.sub_product(c, d);
        }
        while self.coefficients.last().is_some_and(Zero::is_zero) {
            self.coefficients.pop();
        }
    }

    /// The pseudo-remainder: the remainder of l^(d + 1) self by `divisor`, with l the divisor's leading
    /// coefficient and d ≥ 0 the difference of the degrees.
    fn pseudo_remainder(&self, divisor: &Self) -> Self {
        let leading = divisor.leading().expect("a divisor that is not 0");
        let n = divisor.coefficients.len();
        let mut steps = self.coefficients.len() + 1 - n;
        let mut rest = self.clone();
        while rest.coefficients.len() >= n {
            let k = rest.coefficients.len() - n;
            let factor = rest.coefficients[k + n - 1].clone();
            rest = rest.scale(leading);
            rest.subtract_shifted(&factor, k, divisor);
            steps -= 1;
        }
        (0..steps).fold(rest, |rest, _| rest.scale(leading))
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

/// The resultant of a and b: for a = α Π (x − α_i) and b of degree n it is α^n Π b(α_i), so it is 0 iff
/// a and b share a root in an algebraic closure; also 0 if a = 0 or b = 0.
///
/// By the subresultant sequence (Collins, Brown), whose divisions are exact in the ring.
pub fn resultant<R: ExactDivision>(a: &Polynomial<R>, b: &Polynomial<R>) -> R {
    let (Some(m), Some(n)) = (a.degree(), b.degree()) else { return R::zero() };
    if m < n {
        let swapped = resultant(b, a);
        return if m * n % 2 == 1 { -swapped } else { swapped };
    }
    let (mut a, mut b) = (a.clone(), b.clone());
    let (mut g, mut h, mut negative) = (R::one(), R::one(), false);
    loop {
        let Some(n) = b.degree() else { return R::zero() };
        let m = a.degree().expect("not 0");
        if n == 0 {
            let value = ratio_of_powers(&b.coefficients[0], &h, m);
            return if negative { -value } else { value };
        }
        negative ^= m * n % 2 == 1;
        let divisor = R::product(&g, &power(&h, m - n));
        let rest = a.pseudo_remainder(&b).map(|c| c.divided_exactly_by(&divisor));
        (a, b) = (b, rest);
        g = a.leading().expect("not 0").clone();
        h = ratio_of_powers(&g, &h, m - n);
    }
}

/// g^d h^(1 − d), which is exact in the subresultant sequence.
fn ratio_of_powers<R: ExactDivision>(g: &R, h: &R, d: usize) -> R {
    match d {
        0 => h.clone(),
        1 => g.clone(),
        _ => power(g, d).divided_exactly_by(&power(h, d - 1)),
    }
}

fn power<R: Ring>(x: &R, n: usize) -> R {
    (0..n).fold(R::one(), |power, _| R::product(&power, x))
}
