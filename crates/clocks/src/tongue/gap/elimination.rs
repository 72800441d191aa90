//! The entries as polynomials, and what they have in common: exact, for short periods.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero, pow};

use crate::propagator::{HalfPeriod, TwoClocks, half_period};
use crate::tongue::string::Entry;
use number::polynomial::{RootInterval, residues, roots_within, squarefree};
use number::{Lift, Polynomial, PrimeField, Ratio, Rational, prime_fields};

/// Q\[s\].
type InS = Polynomial<Rational>;

/// A, B, C, D as polynomials in s, for fixed ρ; C without its factor s.
pub fn entries(ratio: Ratio, rho: &Rational) -> [InS; 4] {
    let clocks = TwoClocks::with_rho(ratio, InS::variable(), InS::constant(rho.clone()));
    let [a, b, c, d] = of_half(&half_period(&clocks));
    [a, b, without_zero(&c), d]
}

fn of_half<R: number::Ring>(half: &HalfPeriod<R>) -> [R; 4] {
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

/// How many ρ in \[lo, hi\], 0 < lo, let two entries share a zero; `None` where an entry has no zeros, so
/// none.
pub fn count_closings(ratio: Ratio, pair: [Entry; 2], lo: &Rational, hi: &Rational) -> Option<usize> {
    Some(crossings(ratio, pair, lo, hi)?.len())
}

/// Where two entries share a zero: brackets of one such ρ each within \[lo, hi\], 0 < lo, increasing; `None`
/// as above.
///
/// The resultant in s vanishes at ρ iff they share a zero or both degrees fall, and for ρ > 0 the degrees are
/// what the string has masses: they do not fall.
pub fn crossings(ratio: Ratio, pair: [Entry; 2], lo: &Rational, hi: &Rational) -> Option<Vec<RootInterval>> {
    Some(roots_within(&squarefree(&eliminant(ratio, pair)?), lo, hi))
}

/// Z\[ρ\]\[s\]: of each power of s the coefficients of the powers of ρ.
type InRho = Vec<Vec<BigInt>>;

/// The resultant in s of two entries made integer by a factor, a polynomial in ρ, without its factors ρ;
/// `None` where an entry is constant in s.
///
/// Put together from its values modulo primes. It is a determinant whose rows hold the coefficients of one
/// entry each, so the sum of its |coefficients| is at most |X|^(deg Y) |Y|^(deg X), |X| that sum for X:
/// primes beyond twice that determine it.
fn eliminant(ratio: Ratio, pair: [Entry; 2]) -> Option<Vec<BigInt>> {
    let s = Polynomial::<Polynomial<Rational>>::variable();
    let rho = Polynomial::constant(Polynomial::variable());
    let [a, b, c, d] = of_half(&half_period(&TwoClocks::with_rho(ratio, s, rho)));
    let c = Polynomial::new(c.coefficients()[1..].to_vec());
    let entries = [a, b, c, d];
    let [x, y] = pair.map(|entry| integers(&entries[entry as usize]));
    let (m, n) = (x.len().checked_sub(1)?, y.len().checked_sub(1)?);
    if m == 0 || n == 0 {
        return None;
    }
    let size = |f: &InRho| f.iter().flatten().map(Signed::abs).sum::<BigInt>();
    let bound = pow(size(&x), n) * pow(size(&y), m) * 2;
    let longest = |f: &InRho| f.iter().map(Vec::len).max().unwrap_or(1) - 1;
    let degree = n * longest(&x) + m * longest(&y);
    let mut lift = Lift::new(degree + 1);
    for field in prime_fields() {
        lift.join(&field, &eliminant_modulo(&field, [&x, &y], degree));
        if *lift.product() > bound {
            break;
        }
    }
    Some(lift.into_values().into_iter().skip_while(Zero::is_zero).collect())
}

/// The coefficients of the resultant modulo a prime: from its values at ρ = 1, 2, ..., but for those at which
/// an entry loses degree.
fn eliminant_modulo(field: &PrimeField, pair: [&InRho; 2], degree: usize) -> Vec<u64> {
    let [x, y] = pair.map(|f| f.iter().map(|c| residues(field, c)).collect::<Vec<_>>());
    let mut nodes = Vec::with_capacity(degree + 1);
    for rho in (1..).map(|rho| field.of(rho)) {
        let at = |f: &Vec<Vec<u64>>| f.iter().map(|c| horner(field, c, rho)).collect::<Vec<u64>>();
        let (x, y) = (at(&x), at(&y));
        if x.last() != Some(&0) && y.last() != Some(&0) {
            nodes.push((rho, field.resultant(x, y)));
        }
        if nodes.len() > degree {
            break;
        }
    }
    interpolated(field, &nodes)
}

/// f(x), lowest coefficient first.
fn horner(field: &PrimeField, f: &[u64], x: u64) -> u64 {
    f.iter().rev().fold(0, |value, &c| field.add(field.mul(value, x), c))
}

/// The polynomial of least degree through (x, f(x)), by Newton's divided differences.
fn interpolated(field: &PrimeField, nodes: &[(u64, u64)]) -> Vec<u64> {
    let (mut f, mut basis) = (vec![0; nodes.len()], vec![field.of(1)]);
    for &(x, value) in nodes {
        let off = field.sub(value, horner(field, &f, x));
        let factor = field.mul(off, field.invert(horner(field, &basis, x)));
        f.iter_mut().zip(&basis).for_each(|(f, &b)| *f = field.add(*f, field.mul(factor, b)));
        // basis ← basis (z − x).
        basis.insert(0, 0);
        (0..basis.len() - 1).for_each(|k| basis[k] = field.sub(basis[k], field.mul(x, basis[k + 1])));
    }
    f
}

/// The polynomial times a positive integer that clears its denominators.
fn integers(f: &Polynomial<Polynomial<Rational>>) -> InRho {
    let rows = || f.coefficients().iter().map(Polynomial::coefficients);
    let common = rows().flatten().fold(BigInt::one(), |lcm, c| lcm.lcm(c.denom()));
    rows().map(|row| row.iter().map(|c| c.numer() * (&common / c.denom())).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    /// By Euclid's algorithm over ℚ.
    fn resultant(a: &Polynomial<Rational>, b: &Polynomial<Rational>) -> Rational {
        let (m, n) = (a.degree().unwrap(), b.degree().unwrap());
        let leading = b.coefficients()[n].clone();
        if n == 0 {
            return leading.pow(m as i32);
        }
        let (_, rest) = a.div_rem(b).unwrap();
        let Some(d) = rest.degree() else { return Rational::zero() };
        let sign = ratio(if m * n % 2 == 1 { -1 } else { 1 }, 1);
        sign * leading.pow((m - d) as i32) * resultant(b, &rest)
    }

    #[test]
    fn eliminants_are_resultants() {
        for (p, q) in [(1, 2), (3, 2), (2, 5), (5, 3), (1, 6), (4, 3)] {
            for odd in [true, false] {
                let (own, pair) = (Ratio::new(p, q).unwrap(), Entry::of_tongue(odd));
                let Some(found) = eliminant(own, pair) else { continue };
                let found = Polynomial::new(found.into_iter().map(Rational::from_integer).collect());
                let slow = |rho: i64| {
                    let s = Polynomial::<Rational>::variable();
                    let rho = Polynomial::constant(ratio(rho, 1));
                    let [a, b, c, d] = of_half(&half_period(&TwoClocks::with_rho(own, s, rho)));
                    let entries = [a, b, Polynomial::new(c.coefficients()[1..].to_vec()), d];
                    resultant(&entries[pair[0] as usize], &entries[pair[1] as usize])
                };
                // A power of ρ and a factor are left out: both follow from two values.
                let share = |rho: i64| slow(rho) / found.eval(&ratio(rho, 1));
                let (factor, power) = (share(1), share(2) / share(1));
                let shift = (0..99).find(|&k| ratio(2, 1).pow(k) == power).expect("a power of 2");
                for rho in 3..40 {
                    let fast = &factor * ratio(rho, 1).pow(shift) * found.eval(&ratio(rho, 1));
                    assert_eq!(slow(rho), fast, "{own} {odd} {rho}");
                }
            }
        }
    }
}
