//! The polynomials whose real roots are all places where the verdict can change: from values modulo primes,
//! exactly.

use std::cmp::Reverse;

use num_bigint::BigInt;
use num_traits::Zero;

use super::half::{At, Eigenspaces, Half, PLACES};
use crate::exact::modular;
use crate::half::compose::Program;
use crate::verdict::limits::Limits;
use number::parallel::try_map;
use number::polynomial::{common, primitive, quotient, squarefree};
use number::{Lift, PrimeField, Result, prime_fields};

/// Products of machine words beyond which cells are cheaper, whatever the limit: some ten seconds.
const MOST_WORK: f64 = 5e9;

/// Properties that almost all systems of the line have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Kind {
    /// The number of distinct μ, or of all where they are known to be real and semisimple.
    count: usize,
    /// Whether 0 and −1 are among them.
    ends: [bool; 2],
}

/// The polynomials to be found, and their size.
pub(super) struct Shape {
    kind: Kind,
    /// Whether no multiplier has a Jordan block.
    is_semisimple: bool,
    /// The degrees of g(0, s), g(−1, s) and disc g, and of two sums of entries that vanish together where no
    /// multiplier has a Jordan block.
    degrees: Vec<usize>,
    /// Places from which kind and semisimplicity follow.
    places: usize,
    /// More than log₂ of twice any coefficient.
    bits: f64,
}

/// One of the polynomials: that with its roots, each simple, and that with its multiple ones.
pub(super) struct Critical {
    pub simple: Vec<BigInt>,
    pub multiple: Vec<BigInt>,
}

/// A half period modulo a prime, and the eigenspaces of its symmetry, if there is one.
struct Residues {
    field: PrimeField,
    program: Program<[u64; 2]>,
    spaces: Option<Eigenspaces>,
}

impl Residues {
    /// Modulo the primes that divide no denominator and have all eigenvalues of the symmetry.
    fn of(half: &Half) -> impl Iterator<Item = Residues> {
        prime_fields()
            .filter_map(|field| {
                Some(Residues { field, program: half.residues(&field)?, spaces: half.eigenspaces(&field) })
            })
            .filter(|residues| residues.spaces.is_some() == half.is_symmetric())
    }
}

/// The polynomials to be found for a half period; `None` where it costs too much.
pub(super) fn shape(half: &Half, limits: &Limits) -> Option<Shape> {
    let Residues { field, program, .. } = Residues::of(half).next().expect("primes enough");
    // Any three places: one has the most distinct μ and none at an end that is not always there, if not all.
    let at = |k| Some(Own::new(half, &field, &half.at(&field, &program, field.of(k))?));
    let found = PLACES.into_iter().filter_map(at);
    let own = found.max_by_key(|found| (found.kind.count, Reverse(found.kind.ends)))?;
    Some(Shape::new(half, &own)).filter(|shape| shape.cost(half) <= MOST_WORK.min(limits.products as f64))
}

/// The polynomials in s, those without a root left out; `None` where the kind turns out to be another.
///
/// # Errors
/// Where the work is stopped.
pub(super) fn critical(half: &Half, shape: &Shape) -> Result<Option<Vec<Critical>>> {
    let count = (shape.bits / 61.0) as usize + 1;
    let modulo: Vec<Residues> = Residues::of(half).take(count).collect();
    let residues = try_map(&modulo, |residues| Ok(shape.residues(half, residues)))?;
    let Some(residues) = residues.into_iter().collect::<Option<Vec<_>>>() else { return Ok(None) };
    let mut found = Vec::new();
    for k in 0..shape.degrees.len() {
        let mut lift = Lift::new(shape.degrees[k] + 1);
        for (Residues { field, .. }, counts) in modulo.iter().zip(&residues) {
            lift.join(field, &counts[k]);
        }
        let polynomial = lift.into_values();
        if polynomial.iter().all(Zero::is_zero) {
            return Ok(None);
        }
        found.push(polynomial);
    }
    let mut found: Vec<Critical> = match &found[..] {
        // Where both vanish something may be stable that is unstable on both sides.
        [a, b] => {
            let simple = squarefree(&common(a, b));
            vec![Critical { multiple: simple.clone(), simple }]
        }
        all => all.iter().map(|integers| Critical::new(integers)).collect(),
    };
    found.retain(|found| found.simple.len() > 1);
    Ok(Some(found))
}

impl Critical {
    pub fn new(polynomial: &[BigInt]) -> Critical {
        let simple = squarefree(polynomial);
        let rest = quotient(&primitive(polynomial.to_vec()), &simple).expect("a divisor");
        Critical { multiple: squarefree(&rest), simple }
    }
}

impl Shape {
    fn new(half: &Half, own: &Own) -> Shape {
        let (n, kind, m, is_semisimple) = (half.size(), own.kind, own.g.len() - 1, own.is_semisimple);
        let [eigenvalue, scale, more] = half.bits();
        let is_multiple = kind.count < n;
        // Factors of χ have no greater degree in s than it, but for their leading coefficient.
        let whole = if is_multiple { 2 * half.degree(n) } else { half.degree(n) };
        // Homogeneous of degree 2k − 2 in the coefficients, of weight k (k − 1): at most with all weights
        // k/2.
        let pair =
            |k: usize, of: &dyn Fn(usize) -> usize| k.saturating_sub(1) * (of(k / 2) + of(k.div_ceil(2)));
        let degree = |k: usize| if is_multiple { whole } else { half.degree(k) };
        let meeting = if half.is_selfadjoint { 0 } else { pair(m, &degree) };
        // Entries of g(S), times S + 1 or S, times A, B, C or D.
        let entry = whole + (m + 2) * half.degree(1);
        // There are no more distinct μ if fewer meet everywhere, or if S, a zero of a polynomial of this
        // degree, has its powers dependent everywhere.
        let powers = kind.count * (kind.count + 1) / 2;
        let counted = match (half.is_selfadjoint || !is_multiple, is_semisimple) {
            (true, _) => 0,
            (false, true) => powers * half.degree(1),
            (false, false) => pair(n, &|k| half.degree(k)),
        };
        let is_plain = kind.ends == [false; 2] && (half.is_selfadjoint || !is_multiple);
        let degrees = if is_semisimple { vec![whole, whole, meeting] } else { vec![entry; 2] };
        let most = degrees.iter().copied().max().unwrap_or(0).max(if is_plain { 0 } else { entry });
        let places = 1 + most.max(counted);
        // Divisors by powers of δ have coefficients up to 2^degree times as long (Mignotte).
        let (count, length) = (n as f64, eigenvalue.max(scale) + 1.0);
        let pairs = |k: f64| k * (k - 1.0) * (eigenvalue + 1.0);
        let mut bits = count * length;
        if !half.is_selfadjoint {
            bits = bits.max(pairs(m as f64));
        }
        if !is_plain {
            // n² entries of at most four matrices, times weights of 16 bits.
            let sum = 18.0 + 2.0 * (count + 1.0).log2();
            let cleared = (half.degree_of_masses() * m) as f64;
            bits = bits.max((2 * m + 1) as f64 * length + eigenvalue + more + sum + cleared);
        }
        if is_multiple && !half.is_selfadjoint {
            bits = bits.max(if is_semisimple {
                powers as f64 * (length + 1.0) + 2.0 * (kind.count + 1) as f64 * (count + 1.0).log2()
            } else {
                pairs(count)
            });
        }
        Shape { kind, is_semisimple, degrees, places, bits: bits + places as f64 + 2.0 }
    }

    /// Evaluations, interpolations, and isolation of the roots: some hundred times the additions of a shift
    /// by 1.
    pub fn cost(&self, half: &Half) -> f64 {
        let primes = self.bits / 61.0 + 1.0;
        let degree = self.degrees.iter().copied().max().unwrap_or(0) as f64;
        let (places, words) = (self.places as f64, (self.bits + degree) / 64.0 + 16.0);
        primes * (places * half.cost() + 4.0 * degree * degree) + 100.0 * degree * degree / 2.0 * words
    }

    /// The coefficients modulo a prime; `None` where the kind proves another and where places run out.
    fn residues(&self, half: &Half, modulo: &Residues) -> Option<Vec<Vec<u64>>> {
        let Residues { field, program, spaces } = modulo;
        let mut places = Vec::new();
        let mut values = vec![Vec::new(); self.degrees.len()];
        let last = 2 * self.places as u64 + 64;
        for place in 1..=last {
            let s = field.of(place);
            let Some(at) = half.at(field, program, s) else { continue };
            let own = Own::new(half, field, &at);
            // D − Aᵀ is 0 at more places than its degree and modulo primes enough, or not for all s.
            if own.kind.count > self.kind.count || half.is_square && !at.is_square() {
                return None;
            }
            if own.kind != self.kind {
                continue;
            }
            if self.is_semisimple && !own.is_semisimple {
                return None;
            }
            let found = if self.is_semisimple {
                let end = field.sub(0, field.of_big(&half.scale()));
                let at_end = own.g.iter().rev().fold(0, |sum, &c| field.add(field.mul(sum, end), c));
                let met = match half.is_selfadjoint || own.g.len() < 2 {
                    true => field.of(1),
                    false => {
                        let power = field.power(at.delta, 2 * (own.g.len() as u64 - 2));
                        field.mul(power, own.meeting(half, field, &at, spaces.as_ref()))
                    }
                };
                vec![field.mul(at.delta, own.g[0]), field.mul(at.delta, at_end), met]
            } else {
                let power = field.power(at.delta, own.g.len() as u64 + 2);
                own.off.iter().map(|&x| field.mul(power, x)).collect()
            };
            places.push(s);
            values.iter_mut().zip(found).for_each(|(all, count)| all.push(count));
            if places.len() == self.places {
                break;
            }
        }
        if places.len() < self.places {
            return None;
        }
        let inverses: Vec<u64> = (0..=last).map(|k| field.invert(field.of(k.max(1)))).collect();
        let object = values.into_iter().zip(&self.degrees).map(|(values, &degree)| {
            interpolated(field, &places[..=degree], values[..=degree].to_vec(), &inverses)
        });
        Some(object.collect())
    }
}

/// A place on the line modulo a prime, looked at.
struct Own {
    kind: Kind,
    /// Monic, with the μ other than 0 and −1 as its roots: each once, or as often as it is one where all are
    /// known to be semisimple.
    g: Vec<u64>,
    /// Whether no multiplier has a Jordan block.
    is_semisimple: bool,
    /// Two sums of the entries of matrices that are all 0 then.
    off: [u64; 2],
}

impl Own {
    /// With f the squarefree polynomial of all μ, z of 0 and z + 1 of −1 divided out of it,
    ///
    /// ```text
    ///     g(S),      C g(S) and B g(Sᵀ) where 0 is among the μ,      A g(S) and D g(Sᵀ) where −1 is,
    /// ```
    ///
    /// where both are with g(S) (S + 1) in the former, g(S) S in the latter.
    fn new(half: &Half, field: &PrimeField, at: &At) -> Own {
        let whole = modular::characteristic(field, at.product.clone());
        let n = half.size();
        let (mut g, mut is_semisimple) = (whole, true);
        if !half.is_selfadjoint {
            g = modular::squarefree(field, g);
        }
        let mut count = g.len() - 1;
        let scale = field.of_big(&half.scale());
        let ends = [0, field.sub(0, scale)].map(|root| {
            let times = divide_out(field, &mut g, root);
            // Where f is χ, multiple ones count once.
            count -= times.saturating_sub(1);
            times > 0
        });
        let mut off = [0; 2];
        // Cayley and Hamilton.
        if ends != [false; 2] || !half.is_selfadjoint && count < n {
            let value = evaluated(field, &g, &at.product);
            let times = |a: &DMatrix, b: &DMatrix| modular::times(field, a, b);
            let shifted = |by: u64| {
                let factor =
                    DMatrix::from_fn(n, n, |i, j| field.add(at.product[(i, j)], if i == j { by } else { 0 }));
                if ends == [true; 2] { times(&value, &factor) } else { value.clone() }
            };
            let [a, b, c, d] = &at.blocks;
            let matrices = match ends {
                [false, false] => vec![value.clone()],
                _ => [(ends[0], scale, c, b), (ends[1], 0, a, d)]
                    .into_iter()
                    .filter(|entries| entries.0)
                    .flat_map(|(_, by, left, right)| {
                        let matrix = shifted(by);
                        [times(left, &matrix), times(right, &matrix.transpose())]
                    })
                    .collect(),
            };
            // Weights below 2^16, powers of two numbers modulo a prime: weights that are linear in the place
            // are lost on [[1, -1], [-1, 1]].
            let mut weights = [1; 2];
            for &x in matrices.iter().flat_map(|matrix| matrix.iter()) {
                is_semisimple &= x == 0;
                for ((sum, weight), factor) in off.iter_mut().zip(&mut weights).zip([40_503, 30_011]) {
                    *weight = *weight * factor % 65_521;
                    *sum = field.add(*sum, field.mul(field.of(*weight), x));
                }
            }
        }
        Own { kind: Kind { count, ends }, g, is_semisimple, off }
    }

    /// The discriminant of g. Of motions of different symmetry μ meet without consequence: each eigenspace
    /// has a discriminant of its own, and their product, in which conjugate ones are together, is one over
    /// ℤ\[s\].
    fn meeting(&self, half: &Half, field: &PrimeField, at: &At, spaces: Option<&Eigenspaces>) -> u64 {
        let Some(spaces) = spaces else { return discriminant(field, &self.g) };
        let end = field.sub(0, field.of_big(&half.scale()));
        let object = spaces.blocks(field, &at.product).into_iter().map(|block| {
            let mut g = modular::squarefree(field, modular::characteristic(field, block));
            for root in [0, end] {
                divide_out(field, &mut g, root);
            }
            if g.len() < 2 { field.of(1) } else { discriminant(field, &g) }
        });
        object.fold(field.of(1), |product, x| field.mul(product, x))
    }
}

/// Divides f by z − root as often as it goes: how often.
fn divide_out(field: &PrimeField, f: &mut Vec<u64>, root: u64) -> usize {
    let factor = [field.sub(0, root), field.of(1)];
    let mut times = 0;
    while f.len() > 1 && f.iter().rev().fold(0, |sum, &c| field.add(field.mul(sum, root), c)) == 0 {
        *f = modular::quotient(field, std::mem::take(f), &factor);
        times += 1;
    }
    times
}

/// f(m).
fn evaluated(field: &PrimeField, f: &[u64], m: &DMatrix) -> DMatrix {
    let n = m.nrows();
    f.iter().rev().fold(DMatrix::from_element(n, n, 0), |value, &c| {
        let mut next = modular::times(field, &value, m);
        (0..n).for_each(|i| next[(i, i)] = field.add(next[(i, i)], c));
        next
    })
}

type DMatrix = nalgebra::DMatrix<u64>;

/// The resultant of a monic f and its derivative, the discriminant up to its sign.
fn discriminant(field: &PrimeField, f: &[u64]) -> u64 {
    field.resultant(f.to_vec(), modular::derivative(field, f))
}

/// The coefficients of the polynomial with these values at some of the places 1, 2, ... (Newton);
/// `inverses[k]` = 1/k.
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
        let f = [10, field.value(field.sub(0, field.of(7))), 1].map(|c| field.of(c));
        for (rows, is_zero) in [([2, 0, 0, 0, 2, 0, 0, 0, 5], true), ([2, 1, 0, 0, 2, 0, 0, 0, 5], false)] {
            let counts = modular::squarefree(&field, modular::characteristic(&field, of(&rows)));
            assert_eq!(counts, f);
            assert_eq!(evaluated(&field, &counts, &of(&rows)).iter().all(|&x| x == 0), is_zero);
        }
    }
}
