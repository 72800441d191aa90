//! The polynomials whose real roots are all places where the verdict can change: from values modulo primes, exactly.

use num_bigint::BigInt;
use num_traits::Zero;

use super::half::Half;
use crate::error::Result;
use crate::number::polynomial::{primitive, quotient, squarefree};
use crate::number::{Lift, PrimeField, prime_fields};
use crate::parallel::try_map;
use crate::system::exact::modular;
use crate::system::verdict::limits::Limits;

/// Products of machine words beyond which cells are cheaper, whatever the limit: some ten seconds.
const MOST_WORK: f64 = 5e9;

/// What is to be found, and how large.
struct Shape {
    /// The degree of f in z.
    m: usize,
    /// Of f(0, s), f(−1, s) and disc f.
    degrees: [usize; 3],
    /// More than log₂ of twice any coefficient.
    bits: f64,
}

/// One of the polynomials: that with its roots, each simple, and that with its multiple ones.
pub(super) struct Critical {
    pub simple: Vec<BigInt>,
    pub multiple: Vec<BigInt>,
}

/// f(0, s), f(−1, s) and the discriminant of f as integer polynomials in s, those without a root left out; `None` where they cost too much,
/// where one vanishes, and where multiple μ are not seen to be semisimple.
///
/// # Errors
/// Where the work is stopped.
pub(super) fn critical(half: &Half, limits: &Limits) -> Result<Option<Vec<Critical>>> {
    let first = PrimeField::LARGEST;
    let Some(m) = half.residues(&first).and_then(|program| {
        // Any three places: one has the most distinct μ, if not all.
        let at =
            |k| half.product(&first, &program, first.of(k)).map(|(s, _)| own(half, &first, s).0.len() - 1);
        [0x9e37_79b9, 0x7f4a_7c15, 0x85eb_ca6b].into_iter().filter_map(at).max()
    }) else {
        return Ok(None);
    };
    let shape = Shape::new(half, m);
    if shape.cost(half) > MOST_WORK.min(limits.products as f64) {
        return Ok(None);
    }
    let count = (shape.bits / 61.0) as usize + 1;
    let fields: Vec<PrimeField> =
        prime_fields().filter(|field| half.residues(field).is_some()).take(count).collect();
    let residues = try_map(&fields, |field| Ok(shape.residues(half, field)))?;
    let Some(residues) = residues.into_iter().collect::<Option<Vec<_>>>() else { return Ok(None) };
    let mut found = Vec::new();
    for k in 0..3 {
        let mut lift = Lift::new(shape.degrees[k] + 1);
        for (field, own) in fields.iter().zip(&residues) {
            lift.join(field, &own[k]);
        }
        let polynomial = lift.into_values();
        if polynomial.iter().all(Zero::is_zero) {
            return Ok(None);
        }
        let simple = squarefree(&polynomial);
        let rest = quotient(&primitive(polynomial), &simple).expect("a divisor");
        found.push(Critical { multiple: squarefree(&rest), simple });
    }
    found.retain(|own| own.simple.len() > 1);
    Ok(Some(found))
}

impl Shape {
    fn new(half: &Half, m: usize) -> Shape {
        let n = half.size();
        let [eigenvalue, scale] = half.bits();
        // Factors of χ have no greater degree in s than it, but for their leading coefficient.
        let whole = if m < n { 2 * half.degree(n) } else { half.degree(n) };
        let of = |k: usize| if m < n { whole } else { half.degree(k) };
        // Homogeneous of degree 2m − 2 in the coefficients, of weight m (m − 1): at most with all weights m/2.
        let mut pair = m.saturating_sub(1) * (of(m / 2) + of(m.div_ceil(2)));
        if half.is_selfadjoint {
            pair = 0;
        } else if m < n {
            // f(S) = 0 is seen at as many places as its entries' degree asks for.
            pair = pair.max(m * half.degree(1) + whole);
        }
        let (m_bits, size) = (m as f64, eigenvalue.max(scale));
        // Divisors by powers of δ have coefficients up to 2^degree times as long (Mignotte).
        let met = if half.is_selfadjoint { 0.0 } else { m_bits * (m_bits - 1.0) * (eigenvalue + 1.0) };
        let bits = (m_bits * (size + 1.0)).max(met);
        Shape { m, degrees: [whole, whole, pair], bits: bits + pair.max(whole) as f64 + 2.0 }
    }

    /// Evaluations, interpolations, and isolation of the roots: some hundred times the additions of a shift by 1.
    fn cost(&self, half: &Half) -> f64 {
        let primes = self.bits / 61.0 + 1.0;
        let degree = self.degrees.into_iter().max().unwrap_or(0) as f64;
        let words = (self.bits + degree) / 64.0 + 16.0;
        primes * (degree * half.cost() + 4.0 * degree * degree) + 100.0 * degree * degree / 2.0 * words
    }

    /// The coefficients modulo a prime; `None` where f(S) is not 0 or places run out.
    fn residues(&self, half: &Half, field: &PrimeField) -> Option<[Vec<u64>; 3]> {
        let program = half.residues(field)?;
        let count = 1 + self.degrees.into_iter().max().unwrap_or(0);
        let (mut places, mut values) = (Vec::new(), [Vec::new(), Vec::new(), Vec::new()]);
        for place in 1..=2 * count as u64 + 64 {
            let s = field.of(place);
            let Some((matrix, delta)) = half.product(field, &program, s) else { continue };
            let (f, semisimple) = own(half, field, matrix);
            if f.len() != self.m + 1 {
                continue;
            }
            if !semisimple {
                return None;
            }
            let end = field.sub(0, field.of_big(&half.scale));
            let at_end = f.iter().rev().fold(0, |sum, &c| field.add(field.mul(sum, end), c));
            let own = [
                field.mul(delta, f[0]),
                field.mul(delta, at_end),
                match half.is_selfadjoint {
                    true => field.of(1),
                    false => field.mul(field.power(delta, 2 * (self.m as u64 - 1)), discriminant(field, &f)),
                },
            ];
            places.push(s);
            values.iter_mut().zip(own).for_each(|(all, own)| all.push(own));
            if places.len() == count {
                break;
            }
        }
        if places.len() < count {
            return None;
        }
        let inverses: Vec<u64> =
            (0..2 * count as u64 + 65).map(|k| field.invert(field.of(k.max(1)))).collect();
        let mut own = values.into_iter().zip(self.degrees).map(|(values, degree)| {
            interpolated(field, &places[..=degree], values[..=degree].to_vec(), &inverses)
        });
        Some(std::array::from_fn(|_| own.next().expect("three")))
    }
}

/// f and whether f(S) = 0; the characteristic polynomial itself where S is diagonalizable with real μ for all s.
fn own(half: &Half, field: &PrimeField, matrix: DMatrix) -> (Vec<u64>, bool) {
    match half.is_selfadjoint {
        true => (modular::characteristic(field, matrix), true),
        false => simple(field, matrix),
    }
}

/// The squarefree part f of the characteristic polynomial, monic, and whether f(matrix) = 0.
fn simple(field: &PrimeField, matrix: DMatrix) -> (Vec<u64>, bool) {
    let whole = modular::characteristic(field, matrix.clone());
    let derivative: Vec<u64> =
        whole.iter().enumerate().skip(1).map(|(k, &c)| field.mul(field.of(k as u64), c)).collect();
    let common = field.gcd(whole.clone(), derivative);
    if common.len() == 1 {
        // Cayley and Hamilton.
        return (whole, true);
    }
    let f = quotient_modulo(field, whole, &common);
    let n = matrix.nrows();
    let value = f.iter().rev().fold(DMatrix::from_element(n, n, 0), |value, &c| {
        let mut next = modular::times(field, &value, &matrix);
        (0..n).for_each(|i| next[(i, i)] = field.add(next[(i, i)], c));
        next
    });
    let is_zero = value.iter().all(|&x| x == 0);
    (f, is_zero)
}

type DMatrix = nalgebra::DMatrix<u64>;

/// a / b, both monic, b a divisor.
fn quotient_modulo(field: &PrimeField, mut a: Vec<u64>, b: &[u64]) -> Vec<u64> {
    let mut quotient = vec![0; a.len() + 1 - b.len()];
    for k in (0..quotient.len()).rev() {
        let factor = a[k + b.len() - 1];
        a[k..].iter_mut().zip(b).for_each(|(x, &c)| *x = field.sub(*x, field.mul(factor, c)));
        quotient[k] = factor;
    }
    quotient
}

/// The resultant of a monic f and its derivative, the discriminant up to its sign.
fn discriminant(field: &PrimeField, f: &[u64]) -> u64 {
    let derivative: Vec<u64> =
        f.iter().enumerate().skip(1).map(|(k, &c)| field.mul(field.of(k as u64), c)).collect();
    field.resultant(f.to_vec(), derivative)
}

/// The coefficients of the polynomial with these values at some of the places 1, 2, ... (Newton); `inverses[k]` = 1/k.
fn interpolated(field: &PrimeField, places: &[u64], mut values: Vec<u64>, inverses: &[u64]) -> Vec<u64> {
    let n = places.len();
    for k in 1..n {
        for i in (k..n).rev() {
            let apart = field.value(field.sub(places[i], places[i - k]));
            let slope = field.sub(values[i], values[i - 1]);
            values[i] = field.mul(slope, inverses[apart as usize]);
        }
    }
    let mut coefficients: Vec<u64> = Vec::with_capacity(n);
    for i in (0..n).rev() {
        // c ← c (s − place) + value.
        coefficients.push(0);
        for k in (0..coefficients.len()).rev() {
            let below = if k > 0 { coefficients[k - 1] } else { values[i] };
            coefficients[k] = field.sub(below, field.mul(coefficients[k], places[i]));
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_found_again_from_its_values_with_places_left_out() {
        let field = PrimeField::LARGEST;
        let f: Vec<u64> = [5, 0, 7, 11, 3].map(|c| field.of(c)).into();
        let places: Vec<u64> = [1, 2, 4, 7, 8].map(|s| field.of(s)).into();
        let value = |&s: &u64| f.iter().rev().fold(0, |sum, &c| field.add(field.mul(sum, s), c));
        let inverses: Vec<u64> = (0..10).map(|k: u64| field.invert(field.of(k.max(1)))).collect();
        assert_eq!(interpolated(&field, &places, places.iter().map(value).collect(), &inverses), f);
    }

    #[test]
    fn the_squarefree_part_annihilates_what_is_diagonalizable_only() {
        let field = PrimeField::LARGEST;
        let of = |rows: &[u64]| DMatrix::from_row_slice(3, 3, rows).map(|x| field.of(x));
        let twice = simple(&field, of(&[2, 0, 0, 0, 2, 0, 0, 0, 5]));
        let f = [10, field.value(field.sub(0, field.of(7))), 1].map(|c| field.of(c));
        assert_eq!(twice, (f.to_vec(), true));
        assert_eq!(simple(&field, of(&[2, 1, 0, 0, 2, 0, 0, 0, 5])), (f.to_vec(), false));
    }
}
