//! The entries as polynomials, and what they have in common: exact, for short periods.

use num_traits::Zero;

use crate::number::polynomial::resultant;
use crate::number::{Polynomial, Ratio, Rational};
use crate::propagator::{HalfPeriod, TwoClocks, half_period};
use crate::tongue::string::Entry;

/// Q\[s\].
type InS = Polynomial<Rational>;

/// A, B, C, D as polynomials in s, for fixed ρ; C without its factor s.
pub fn entries(ratio: Ratio, rho: &Rational) -> [InS; 4] {
    let clocks = TwoClocks::with_rho(ratio, InS::variable(), InS::constant(rho.clone()));
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
pub(crate) fn common_factor(ratio: Ratio, rho: &Rational, pair: [Entry; 2]) -> InS {
    let entries = entries(ratio, rho);
    entries[pair[0] as usize].gcd(&entries[pair[1] as usize])
}

/// Q\[ρ\]\[s\].
type InRho = Polynomial<Polynomial<Rational>>;

/// How many ρ in \[lo, hi\], 0 < lo, let two entries share a zero; `None` where an entry has no zeros, so none.
///
/// The resultant in s vanishes at ρ iff they share a zero or both degrees fall, and for ρ > 0 the degrees are what
/// the string has masses: they do not fall.
pub fn count_closings(ratio: Ratio, pair: [Entry; 2], lo: &Rational, hi: &Rational) -> Option<usize> {
    let s = InRho::variable();
    let rho = InRho::constant(Polynomial::variable());
    let [a, b, c, d] = of_half(&half_period(&TwoClocks::with_rho(ratio, s, rho)));
    let c = Polynomial::new(c.coefficients()[1..].to_vec());
    let entries = [a, b, c, d];
    let [x, y] = pair.map(|entry| primitive(&entries[entry as usize]));
    if x.degree()? == 0 || y.degree()? == 0 {
        return None;
    }
    Some(resultant(&x, &y).count_roots(lo, hi))
}

/// The polynomial with integer coefficients: a positive rational factor taken out, which keeps the zeros.
fn primitive(f: &InRho) -> InRho {
    use num_integer::Integer;
    let denominators =
        f.coefficients().iter().flat_map(|c| c.coefficients().iter().map(|c| c.denom().clone()));
    let common = denominators.fold(num_bigint::BigInt::from(1), |lcm, d| lcm.lcm(&d));
    f.map(|c| c.scale(&Rational::from_integer(common.clone())))
}
