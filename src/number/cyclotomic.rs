//! The real cyclotomic fields ℚ(2cos(π/n)): exact numbers at the resonances.
//!
//! At p θ = m π the stiffness is s = 4 sin²(θ/2) = 2 − 2cos(m π/p), which lies in ℚ(2cos(π/p)); the
//! propagator there has entries in that field, and whether one of them is 0 is decided.
//!
//! With c = 2cos(π/n), an element is a polynomial in c of degree below that of c's minimal polynomial ψ;
//! it is 0 iff this reduced polynomial is. ψ comes from the cyclotomic polynomial Φ_2n of the root of unity
//! z = e^{iπ/n}, c = z + 1/z: Φ_2n is palindromic of even degree 2d (n ≥ 2), and
//! z^−d Φ_2n(z) = a_d + Σ_k a_{d−k} (z^k + z^−k), where z^k + z^−k = T_k(c) with
//! T_0 = 2, T_1 = c, T_{k+1} = c T_k − T_{k−1}.
//!
//! ```
//! use kickdrift::number::{Cyclotomic, ExactSign, Sign, rational::ratio, Ring};
//! // The golden ratio 2cos(π/5) is a root of x² − x − 1.
//! let x = Cyclotomic::two_cos(1, 5);
//! assert_eq!(&(&x * &x) - &x, Cyclotomic::from_rational(&ratio(1, 1)));
//! let difference = &x - &Cyclotomic::from_rational(&ratio(1618, 1000));
//! assert_eq!(difference.sign(), Sign::Positive);
//! ```

mod field;

pub use field::CyclotomicField;

use std::fmt;

use num_traits::{One, Zero};

use super::operators::ring_operators;
use super::{Ball, ExactSign, Polynomial, Rational, Real, Ring, Sign};

/// A real number in ℚ(2cos(π/n)).
///
/// Invariant: the degree is below the field's; a rational number has no field, so that equal numbers
/// are equal values, and rationals mix with every field. Mixing two different fields is a bug and **panics**.
#[derive(Clone, Debug)]
pub struct Cyclotomic {
    field: Option<CyclotomicField>,
    polynomial: Polynomial<Rational>,
}

impl Cyclotomic {
    /// 2cos(m π/n), exactly. To make many numbers of one field, make the [`CyclotomicField`] once.
    ///
    /// **Panics** if n = 0.
    pub fn two_cos(m: i64, n: u32) -> Cyclotomic {
        CyclotomicField::new(n).two_cos(m)
    }

    /// s = 2 − 2cos(m π/p) = 4 sin²(m π/(2p)): the dimensionless stiffness at which p θ = m π.
    ///
    /// **Panics** if p = 0.
    pub fn resonant_s(m: i64, p: u32) -> Cyclotomic {
        CyclotomicField::new(p).resonant_s(m)
    }

    /// The number as a rational, if it is one.
    pub fn as_rational(&self) -> Option<Rational> {
        self.field.is_none().then(|| self.polynomial.coefficient(0))
    }

    /// The polynomial in 2cos(π/n), of least degree, that the number is.
    pub fn polynomial(&self) -> &Polynomial<Rational> {
        &self.polynomial
    }

    /// The field, unless the number is rational.
    pub fn field(&self) -> Option<&CyclotomicField> {
        self.field.as_ref()
    }

    /// 1/self; `None` for 0.
    pub fn inverse(&self) -> Option<Cyclotomic> {
        let Some(field) = &self.field else {
            let x = self.polynomial.coefficient(0);
            return (!x.is_zero()).then(|| Cyclotomic::from_rational(&x.recip()));
        };
        // Euclid on (ψ, f) with the cofactor u of f: u f = r mod ψ. ψ is irreducible, so r ends as a constant.
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
    fn common_field(&self, other: &Cyclotomic) -> Option<CyclotomicField> {
        if let (Some(a), Some(b)) = (&self.field, &other.field) {
            assert!(a.n() == b.n(), "numbers of ℚ(2cos(π/{})) and ℚ(2cos(π/{})) mixed", a.n(), b.n());
        }
        self.field.as_ref().or(other.field.as_ref()).cloned()
    }

    fn made(field: Option<CyclotomicField>, polynomial: Polynomial<Rational>) -> Cyclotomic {
        let field = field.filter(|_| polynomial.degree() > Some(0));
        Cyclotomic { field, polynomial }
    }

    fn sum(&self, other: &Cyclotomic) -> Cyclotomic {
        Cyclotomic::made(self.common_field(other), &self.polynomial + &other.polynomial)
    }

    fn difference(&self, other: &Cyclotomic) -> Cyclotomic {
        Cyclotomic::made(self.common_field(other), &self.polynomial - &other.polynomial)
    }

    fn times(&self, other: &Cyclotomic) -> Cyclotomic {
        let product = &self.polynomial * &other.polynomial;
        match self.common_field(other) {
            Some(field) => field.element(product),
            None => Cyclotomic::made(None, product),
        }
    }

    fn negated(&self) -> Cyclotomic {
        Cyclotomic { field: self.field.clone(), polynomial: -&self.polynomial }
    }

    /// A ball about the value, all steps rounded to `bits` bits.
    fn evaluated(&self, bits: u32) -> Ball {
        let c = self.field.as_ref().map_or_else(Ball::zero, |field| field.generator(bits));
        self.polynomial.coefficients().iter().rev().fold(Ball::zero(), |value, coefficient| {
            value.mul(&c, bits).add(&Ball::from_rational(coefficient, bits), bits)
        })
    }
}

impl CyclotomicField {
    /// The number f(2cos(π/n)).
    pub fn element(&self, f: Polynomial<Rational>) -> Cyclotomic {
        Cyclotomic::made(Some(self.clone()), self.reduce(f))
    }

    /// 2cos(m π/n), exactly: T_m(c), by T_2k = T_k² − 2 and T_{2k+1} = T_k T_{k+1} − c.
    pub fn two_cos(&self, m: i64) -> Cyclotomic {
        let period = 2 * i64::from(self.n());
        let m = m.rem_euclid(period).min((-m).rem_euclid(period));
        let integer = |n: i64| Cyclotomic::made(None, Polynomial::constant(Rational::from_integer(n.into())));
        let (two, c) = (integer(2), self.element(Polynomial::variable()));
        let (mut low, mut high) = (two.clone(), c.clone()); // T_k, T_{k+1}
        for bit in (0..64 - m.leading_zeros()).rev() {
            let middle = &(&low * &high) - &c;
            if m >> bit & 1 == 1 {
                (low, high) = (middle, &(&high * &high) - &two);
            } else {
                (low, high) = (&(&low * &low) - &two, middle);
            }
        }
        low
    }

    /// s = 2 − 2cos(m π/n) = 4 sin²(m π/(2n)): the dimensionless stiffness at which n θ = m π.
    pub fn resonant_s(&self, m: i64) -> Cyclotomic {
        let two = Cyclotomic::made(None, Polynomial::constant(Rational::from_integer(2.into())));
        &two - &self.two_cos(m)
    }
}

ring_operators!([] Cyclotomic);

impl PartialEq for Cyclotomic {
    /// Equality of the real numbers; **panics** on irrational numbers of two different fields.
    fn eq(&self, other: &Cyclotomic) -> bool {
        self.common_field(other);
        self.polynomial == other.polynomial
    }
}

impl Zero for Cyclotomic {
    fn zero() -> Cyclotomic {
        Cyclotomic { field: None, polynomial: Polynomial::zero() }
    }

    fn is_zero(&self) -> bool {
        self.polynomial.is_zero()
    }
}

impl One for Cyclotomic {
    fn one() -> Cyclotomic {
        Cyclotomic::from_rational(&Rational::one())
    }
}

impl Ring for Cyclotomic {
    fn from_rational(x: &Rational) -> Cyclotomic {
        Cyclotomic { field: None, polynomial: Polynomial::constant(x.clone()) }
    }

    fn add_product(&mut self, a: &Self, b: &Self) {
        *self += a * b;
    }

    fn sub_product(&mut self, a: &Self, b: &Self) {
        *self -= a * b;
    }

    fn product(a: &Self, b: &Self) -> Self {
        a * b
    }
}

impl ExactSign for Cyclotomic {
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

impl Real for Cyclotomic {
    fn enclosure(&self, bits: u32) -> Ball {
        if let Some(x) = self.as_rational() {
            return x.enclosure(bits);
        }
        let mut working = bits + 32;
        loop {
            let ball = self.evaluated(working);
            if ball.relative_accuracy_bits() > i64::from(bits) {
                return ball.round(bits + 2);
            }
            working *= 2;
        }
    }
}

impl fmt::Display for Cyclotomic {
    /// A polynomial in c = 2cos(π/n), with n said where it matters: `c^2 - 2 [c = 2cos(pi/7)]`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.polynomial.text(&["c"]))?;
        self.field.as_ref().map_or(Ok(()), |field| write!(f, " [c = 2cos(pi/{})]", field.n()))
    }
}
