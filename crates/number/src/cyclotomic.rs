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
//! use kickdrift_number::{Cyclotomic, ExactSign, Sign, rational::ratio, Ring};
//! // The golden ratio 2cos(π/5) is a root of x² − x − 1.
//! let x = Cyclotomic::two_cos(1, 5);
//! assert_eq!(&(&x * &x) - &x, Cyclotomic::from_rational(&ratio(1, 1)));
//! let difference = &x - &Cyclotomic::from_rational(&ratio(1618, 1000));
//! assert_eq!(difference.sign(), Sign::Positive);
//! ```

mod field;

pub use field::CyclotomicField;

use super::element::{Element, NumberField};
use super::{Polynomial, Rational, Ring};

/// A real number in ℚ(2cos(π/n)).
pub type Cyclotomic = Element<CyclotomicField>;

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
}

impl CyclotomicField {
    /// 2cos(m π/n), exactly: T_m(c), by T_2k = T_k² − 2 and T_{2k+1} = T_k T_{k+1} − c.
    pub fn two_cos(&self, m: i64) -> Cyclotomic {
        let period = 2 * i64::from(self.n());
        let m = m.rem_euclid(period).min((-m).rem_euclid(period));
        let integer = |n: i64| Cyclotomic::from_rational(&Rational::from_integer(n.into()));
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
        let two = Cyclotomic::from_rational(&Rational::from_integer(2.into()));
        &two - &self.two_cos(m)
    }
}
