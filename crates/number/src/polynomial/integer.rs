//! Polynomials with integer coefficients as vectors, lowest coefficient first: squarefree parts put together
//! from prime fields, and real roots by Descartes' rule and bisection (Vincent, Collins, Akritas).
//!
//! Additions only, where the remainders of a Sturm chain of a polynomial with coefficients of 10^5 bits would
//! grow past 10^6.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::sturm::{RootInterval, primitive, sign_at};
use crate::{Lift, PrimeField, Rational, Sign, prime_fields, rational};

/// The primitive polynomial with the roots of f ≠ 0, each simple; its leading coefficient has the sign of
/// f's.
pub fn squarefree(f: &[BigInt]) -> Vec<BigInt> {
    let f = primitive(f.to_vec());
    let derivative: Vec<BigInt> = f.iter().enumerate().skip(1).map(|(k, c)| c * k).collect();
    match common(&f, &derivative) {
        divisor if divisor.len() == 1 => f,
        divisor => quotient(&f, &divisor).expect("a divisor"),
    }
}

/// The primitive greatest common divisor of f ≠ 0 and g, its leading coefficient positive.
///
/// A divisor modulo p has at least the degree of the true one, and the latter times l/(its leading
/// coefficient), l that of f, has integer coefficients (Gauss): that is what the residues of least degree,
/// scaled, lift to.
pub fn common(f: &[BigInt], g: &[BigInt]) -> Vec<BigInt> {
    let f = primitive(f.to_vec());
    let leading = f.last().expect("not 0");
    let mut lift: Option<Lift> = None;
    let mut degree = usize::MAX;
    for field in prime_fields().filter(|field| field.of_big(leading) != 0) {
        let gcd = field.gcd(residues(&field, &f), residues(&field, g));
        if gcd.len() == 1 {
            return vec![BigInt::one()];
        }
        if gcd.len() > degree {
            continue;
        }
        if gcd.len() < degree {
            degree = gcd.len();
            lift = None;
        }
        let scale = field.of_big(leading);
        let scaled: Vec<u64> = gcd.iter().map(|&c| field.mul(c, scale)).collect();
        let known = lift.get_or_insert_with(|| Lift::new(degree));
        if known.join(&field, &scaled) {
            continue;
        }
        let mut divisor = primitive(lift.take().expect("just lifted").into_values());
        if divisor.last().is_some_and(Signed::is_negative) {
            divisor.iter_mut().for_each(|c| *c = -&*c);
        }
        if [&f[..], g].iter().all(|integers| quotient(integers, &divisor).is_some()) {
            return divisor;
        }
    }
    unreachable!("there are primes enough")
}

/// f modulo the prime.
pub fn residues(field: &PrimeField, f: &[BigInt]) -> Vec<u64> {
    f.iter().map(|c| field.of_big(c)).collect()
}

/// f / divisor for a primitive divisor; `None` where it is no polynomial with integer coefficients.
pub fn quotient(f: &[BigInt], divisor: &[BigInt]) -> Option<Vec<BigInt>> {
    let (mut rest, leading) = (f.to_vec(), divisor.last()?);
    let mut quotient = vec![BigInt::zero(); (f.len() + 1).saturating_sub(divisor.len())];
    for k in (0..quotient.len()).rev() {
        let (factor, left) = rest[k + divisor.len() - 1].div_rem(leading);
        if !left.is_zero() {
            return None;
        }
        for (integer, c) in rest[k..].iter_mut().zip(divisor) {
            *integer -= &factor * c;
        }
        quotient[k] = factor;
    }
    rest.iter().all(Zero::is_zero).then_some(quotient)
}

/// The roots of a squarefree f in the closed interval [lo, hi], 0 < lo, increasing.
pub fn roots_within(f: &[BigInt], lo: &Rational, hi: &Rational) -> Vec<RootInterval> {
    let one = Rational::one();
    let mut roots = in_unit_interval(f.to_vec());
    if sign_at(f, &one) == Sign::Zero {
        roots.push((one.clone(), one));
    }
    let beyond = in_unit_interval(f.iter().rev().cloned().collect());
    // Zero is no end: a bracket that begins there is narrowed first.
    let turned = beyond.into_iter().map(|bracket| {
        let (a, b) = away_from_zero(&f.iter().rev().cloned().collect::<Vec<_>>(), bracket);
        (b.recip(), a.recip())
    });
    roots.extend(turned);
    roots.sort();
    roots.into_iter().filter_map(|bracket| clipped(f, bracket, lo, hi)).collect()
}

/// An interval of the same root with a positive lower end.
fn away_from_zero(f: &[BigInt], (mut a, mut b): RootInterval) -> RootInterval {
    let above = sign_at(f, &b);
    while a.is_zero() {
        let middle = &b / Rational::from_integer(2.into());
        match sign_at(f, &middle) {
            Sign::Zero => (a, b) = (middle.clone(), middle),
            sign if sign == above => b = middle,
            _ => a = middle,
        }
    }
    (a, b)
}

/// The part of a bracket within [lo, hi], if the root is in it.
fn clipped(f: &[BigInt], (a, b): RootInterval, lo: &Rational, hi: &Rational) -> Option<RootInterval> {
    let (from, upto) = (lo.max(&a), hi.min(&b));
    if from > upto || a == b {
        return (from <= upto).then_some((a, b));
    }
    match (sign_at(f, from), sign_at(f, upto)) {
        (Sign::Zero, _) => Some((from.clone(), from.clone())),
        (_, Sign::Zero) => Some((upto.clone(), upto.clone())),
        (below, above) => (below != above).then(|| (from.clone(), upto.clone())),
    }
}

/// The roots of a squarefree f in the open interval (0, 1), in no order: points, or brackets with a root at
/// no end.
pub fn in_unit_interval(f: Vec<BigInt>) -> Vec<RootInterval> {
    let (mut roots, mut open) = (Vec::new(), vec![(f, 0, BigInt::zero())]);
    while let Some((f, depth, place)) = open.pop() {
        let point = |n: BigInt, depth: i64| rational::scale2(&n, -depth);
        let variations = variations_in_unit_interval(&f);
        let simple = variations == 1 && !f[0].is_zero() && !f.iter().sum::<BigInt>().is_zero();
        if simple {
            roots.push((point(place.clone(), depth), point(place + 1, depth)));
        } else if variations > 0 {
            let n = f.len() - 1;
            // 2^n f(z/2), and the same about 1/2.
            let left: Vec<_> = f.iter().enumerate().map(|(k, c)| c << (n - k)).collect();
            let mut right = left.clone();
            shift_by_one(&mut right);
            let middle: BigInt = 2 * place + 1;
            if right[0].is_zero() {
                let middle = point(middle.clone(), depth + 1);
                roots.push((middle.clone(), middle));
            }
            open.push((left, depth + 1, &middle - 1));
            open.push((right, depth + 1, middle));
        }
    }
    roots
}

/// Descartes' bound on the roots in (0, 1): sign changes of (1 + z)^n f(1/(1 + z)).
fn variations_in_unit_interval(f: &[BigInt]) -> usize {
    let mut g: Vec<_> = f.iter().rev().cloned().collect();
    shift_by_one(&mut g);
    let signs: Vec<bool> = g.iter().filter(|c| !c.is_zero()).map(Signed::is_negative).collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// f(z + 1).
fn shift_by_one(f: &mut [BigInt]) {
    let n = f.len();
    for k in 0..n.saturating_sub(1) {
        for j in (k..n - 1).rev() {
            let [integer, next] = &mut f[j..j + 2] else { unreachable!("two neighbours") };
            *integer += &*next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Polynomial;
    use proptest::prelude::*;

    proptest! {
        /// Linear and quadratic factors with repetitions, leading coefficients beyond 1 among them.
        #[test]
        fn descartes_and_sturm_find_the_same_roots(
            linear in prop::collection::vec((-40i64..9, 1i64..7), 0..5),
            quadratic in prop::collection::vec((1i64..5, -20i64..20, -40i64..90), 0..4),
            (lo, more) in (1i64..30, 0i64..300),
        ) {
            let factors = linear.iter().map(|&(a, b)| vec![a, b]).chain(quadratic.iter().map(|&(a, b, c)| vec![c, b, a]));
            let f = factors.fold(Polynomial::constant(Rational::one()), |f, g| {
                &f * &Polynomial::new(g.into_iter().map(|c| Rational::from_integer(c.into())).collect())
            });
            let integers: Vec<BigInt> = f.coefficients().iter().map(|c| c.to_integer()).collect();
            let simple = squarefree(&integers);
            let back = Polynomial::new(simple.iter().cloned().map(Rational::from_integer).collect());
            prop_assert_eq!(back.monic(), f.squarefree());
            let (lo, hi) = (rational::ratio(lo, 10), rational::ratio(lo + more, 10));
            let roots = roots_within(&simple, &lo, &hi);
            prop_assert_eq!(roots.len(), f.count_roots(&lo, &hi));
            for (a, b) in &roots {
                prop_assert!(*a >= lo && *b <= hi);
                prop_assert_eq!(f.count_roots(a, b), 1);
                prop_assert!(a == b || f.eval(a) != Rational::zero() && f.eval(b) != Rational::zero());
            }
        }
    }
}
