//! The entries as polynomials, and what they have in common: exact, for short periods.

use num_traits::Zero;

use super::string::Entry;
use crate::number::{Polynomial, Rational};
use crate::propagator::{HalfPeriod, TwoClocks, half_period};

/// Q\[s\].
type InS = Polynomial<Rational>;

/// A, B, C, D as polynomials in s, for fixed ρ; C without its factor s.
pub fn entries(p: u64, q: u64, rho: &Rational) -> [InS; 4] {
    let clocks = TwoClocks::with_rho(p, q, InS::variable(), InS::constant(rho.clone()));
    let [a, b, c, d] = of_half(&half_period(&clocks));
    [a, b, without_zero(&c), d]
}

fn of_half<R: crate::number::Ring>(half: &HalfPeriod<R>) -> [R; 4] {
    [half.a().clone(), half.b().clone(), half.c().clone(), half.d().clone()]
}

/// f/s for an f with f(0) = 0.
fn without_zero(f: &InS) -> InS {
    debug_assert!(f.coefficient(0).is_zero());
    Polynomial::new(f.coefficients()[1..].to_vec())
}

/// The greatest common divisor of two entries.
pub(super) fn common_factor(p: u64, q: u64, rho: &Rational, pair: [Entry; 2]) -> InS {
    let entries = entries(p, q, rho);
    entries[pair[0] as usize].gcd(&entries[pair[1] as usize])
}
