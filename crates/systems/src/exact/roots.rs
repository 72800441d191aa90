//! Integer polynomials exactly: characteristic polynomials, and how many real roots lie where.
//!
//! Polynomials are vectors of integers, lowest coefficient first.

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_integer::{Integer, binomial};
use num_traits::{One, Signed, Zero};

use crate::exact::modular;
use number::polynomial::in_unit_interval;
use number::{Lift, PrimeField, prime_fields};

/// det(z − m), monic: from its residues modulo primes, as many as the bound on its coefficients asks for.
pub(crate) fn characteristic(m: &DMatrix<BigInt>) -> Vec<BigInt> {
    let n = m.nrows();
    let bound = coefficient_bound(m);
    let mut lift = Lift::new(n + 1);
    for field in prime_fields() {
        lift.join(&field, &modular::characteristic(&field, modular::matrix(&field, m)));
        if *lift.product() > bound {
            break;
        }
    }
    lift.into_values()
}

/// More than twice any coefficient: C(n, k) r^k, r the largest sum of |entries| of a row, which no eigenvalue
/// exceeds.
fn coefficient_bound(m: &DMatrix<BigInt>) -> BigInt {
    let n = m.nrows();
    let r = row_sum(m).max(BigInt::one());
    BigInt::from(binomial(n as u128, n as u128 / 2)) * num_traits::pow(r, n) * 2 + 1
}

/// The largest sum of |entries| of a row.
pub(crate) fn row_sum(m: &DMatrix<BigInt>) -> BigInt {
    m.row_iter().map(|row| row.iter().map(Signed::abs).sum::<BigInt>()).max().unwrap_or_default()
}

/// Divides f by z − root as often as it goes: how often, and what is left.
pub(crate) fn divided_out(mut f: Vec<BigInt>, root: &BigInt) -> (usize, Vec<BigInt>) {
    let mut times = 0;
    while f.len() > 1 {
        // Synthetic division, highest coefficient first.
        let mut value = BigInt::zero();
        let mut quotient: Vec<_> = f
            .iter()
            .rev()
            .map(|c| {
                value = &value * root + c;
                value.clone()
            })
            .collect();
        if !quotient.pop().expect("not empty").is_zero() {
            break;
        }
        quotient.reverse();
        f = quotient;
        times += 1;
    }
    (times, f)
}

/// How many distinct roots of f lie where, f squarefree with neither 0 nor −d among its roots, d > 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RootCount {
    /// In (−d, 0).
    pub inside: usize,
    /// Above 0.
    pub above: usize,
    /// Below −d.
    pub below: usize,
    /// Not real.
    pub complex: usize,
}

/// Counts the roots of f about [−d, 0].
pub fn count(f: &[BigInt], d: &BigInt) -> RootCount {
    // z = −d t.
    let mut power = BigInt::one();
    let mut scaled = Vec::new();
    for c in f {
        scaled.push(c * &power);
        power *= -d;
    }
    let mirrored: Vec<_> =
        scaled.iter().enumerate().map(|(k, c)| if k.is_odd() { -c } else { c.clone() }).collect();
    let reversed = |f: &[BigInt]| f.iter().rev().cloned().collect::<Vec<_>>();
    let inside = in_unit_interval(scaled.clone()).len();
    let below = in_unit_interval(reversed(&scaled)).len();
    let at_one = usize::from(mirrored.iter().sum::<BigInt>().is_zero());
    let above =
        in_unit_interval(mirrored.clone()).len() + in_unit_interval(reversed(&mirrored)).len() + at_one;
    RootCount { inside, above, below, complex: f.len() - 1 - inside - above - below }
}

/// The rank over ℚ of an integer matrix given by its residues, whose entries do not exceed `bound`.
///
/// A rank modulo p is at most the true one. If it is r for primes whose product exceeds every minor of size
/// r + 1 (Hadamard), all these minors are 0.
pub fn rank(rows: usize, bound: &BigInt, residues: impl Fn(&PrimeField) -> DMatrix<u64>) -> usize {
    // A row of a minor has at most `rows` entries: its length is at most √rows bound.
    let entry_bits = bound.bits() + rows.ilog2() as u64 / 2 + 1;
    let (mut rank, mut bits) = (0, 0);
    for field in prime_fields() {
        let found = modular::rank(&field, residues(&field));
        rank = rank.max(found);
        bits += 61;
        if rank == rows || bits > entry_bits * (rank as u64 + 1) {
            break;
        }
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::polynomial::squarefree;
    use number::{Polynomial, Rational};
    use proptest::prelude::*;

    fn product(factors: &[Vec<i64>]) -> Vec<BigInt> {
        factors.iter().fold(vec![BigInt::one()], |f, g| {
            let mut product = vec![BigInt::zero(); f.len() + g.len() - 1];
            for (i, a) in f.iter().enumerate() {
                for (j, b) in g.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            product
        })
    }

    proptest! {
        #[test]
        fn descartes_and_sturm_count_the_same(
            roots in prop::collection::vec(-30i64..20, 0..5),
            quadratics in prop::collection::vec((-20i64..20, -40i64..90), 0..4),
            d in 1i64..15,
        ) {
            let linear = roots.iter().filter(|&&r| r != 0 && r != -d).map(|&r| vec![-r, 1]);
            let quadratic = quadratics
                .iter()
                .filter(|(b, c)| *c != 0 && d * d - b * d + c != 0)
                .map(|&(b, c)| vec![c, b, 1]);
            let f = product(&linear.chain(quadratic).collect::<Vec<_>>());
            let reduced = squarefree(&f);
            let polynomial = Polynomial::new(f.into_iter().map(Rational::from_integer).collect());
            let monic = polynomial.squarefree();
            let as_rational: Vec<_> = reduced.iter().cloned().map(Rational::from_integer).collect();
            prop_assert_eq!(monic.coefficients(), as_rational.as_slice());
            let counted = count(&reduced, &d.into());
            let at = |x: i64| Rational::from_integer(x.into());
            prop_assert_eq!(counted.inside, polynomial.count_roots(&at(-d), &at(0)));
            prop_assert_eq!(counted.above, polynomial.count_roots(&at(0), &at(1000)));
            prop_assert_eq!(counted.below, polynomial.count_roots(&at(-1000), &at(-d)));
        }

        #[test]
        fn the_characteristic_polynomial_annihilates(entries in prop::collection::vec(-9i64..9, 16)) {
            let m = DMatrix::from_fn(4, 4, |i, j| BigInt::from(entries[4 * i + j]));
            let f = characteristic(&m);
            let identity = DMatrix::from_fn(4, 4, |i, j| BigInt::from(i64::from(i == j)));
            let value = f.iter().rev().fold(DMatrix::from_element(4, 4, BigInt::zero()), |value, c| {
                value * &m + identity.map(|x| x * c)
            });
            prop_assert!(value.iter().all(Zero::is_zero));
            prop_assert!(f[4].is_one());
        }
    }
}
