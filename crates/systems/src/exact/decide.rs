//! The verdict over ℚ: characteristic polynomial, root counts, diagonalizability; nothing is left open.
//!
//! With S = Bᵀ C the multipliers satisfy λ + 1/λ = 2 + 4 μ, μ the eigenvalues of S.
//!
//! * Spectrally stable iff all μ lie in [−1, 0]: a count of real roots.
//! * At an interior μ, where λ ≠ 1/λ: (Q + 1/Q) = 2 + 4 diag(S, Sᵀ) makes Q semisimple iff S is. With f the
//!   squarefree polynomial of the interior roots that is rank f(S) = the multiplicities of 0 and −1 together.
//! * At λ = ±1: Q = R H⁻¹ R H with R = diag(I, −I), so Q v = v iff H v commutes with R: ker(Q − I) =
//!   ker C ⊕ ker B, and ker(Q + I) = ker A ⊕ ker D. A root μ = 0 of multiplicity a (λ = 1 of multiplicity 2a)
//!   is semisimple iff null B + null C = 2a; μ = −1 likewise with A and D. For one degree of freedom this is
//!   the table of four signs.

use std::ops::AddAssign;

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_complex::Complex64;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use crate::exact::integers::{IntegerBlocks, IntegerProgram};
use crate::exact::modular;
use crate::exact::refined;
use crate::exact::roots::{self, RootCount};
use crate::linear::frame::Frame;
use crate::linear::system::System;
use crate::spectrum::rate::Multiplier;
use crate::verdict::limits::{Limits, degrees_of_freedom};
use clocks::verdict::Kind;
use number::polynomial::{quotient, squarefree};
use number::{Rational, Result};

/// The result of exact arithmetic for a system without rigid modes.
#[derive(Clone, Debug)]
pub struct ExactVerdict {
    /// Elliptic: stable. Coexistence: stable with a multiplier ±1. Parabolic: all |λ| = 1, with a Jordan
    /// block. Hyperbolic: some |λ| > 1.
    pub kind: Kind,
    /// The eigenvalues μ of Bᵀ C by place.
    pub roots: MuCount,
}

/// The eigenvalues μ of Bᵀ C by place, each as often as it is one: λ + 1/λ = 2 + 4 μ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MuCount {
    /// μ in (−1, 0): λ on the unit circle.
    pub inside: usize,
    /// μ = 0: λ = 1.
    pub at_zero: usize,
    /// μ = −1: λ = −1.
    pub at_minus_one: usize,
    /// μ > 0: real λ > 1.
    pub above: usize,
    /// μ < −1: real λ < −1.
    pub below: usize,
    /// μ that are not real: quadruples λ, 1/λ and their conjugates.
    pub complex: usize,
}

/// The exact verdict on a system as one, over its whole period; its rigid modes are set apart. Parts that its
/// other clocks leave alone have shorter periods: what is elliptic over one of these may be coexistence over
/// the whole (see [`Part`](crate::Part)).
///
/// # Errors
/// A budget error with the estimated cost, before any work.
pub fn decide_exact(system: &System, limits: &Limits) -> Result<ExactVerdict> {
    decide_beside(system, &Frame::new(system), limits)
}

/// The exact verdict beside the rigid modes of `frame`. Potentials of one clock, restricted to a subspace
/// that their sum alone leaves invariant, do not tell any more what is rigid.
///
/// # Errors
/// As [`decide_exact`].
pub(crate) fn decide_beside(system: &System, frame: &Frame, limits: &Limits) -> Result<ExactVerdict> {
    let program = IntegerProgram::new(system);
    let cost = estimate(system, frame, &program);
    limits.allow(cost, || {
        let (size, kicks) = (frame.kept.len(), system.schedule().strikes() / 2);
        format!("exact arithmetic on {} with {kicks} kicks in half a period", degrees_of_freedom(size))
    })?;
    Ok(judge(&program.half_period(system, frame)))
}

/// Roots may cost so many times what the polynomial may: corrections of long roots are most of it.
const TIMES_TO_REFINE: u64 = 8;

/// Roots are refined where there are no more of them.
const MOST_REFINED: usize = 24;

/// All μ with their growth, the largest to a double's digits, from the roots of the characteristic
/// polynomial; `None` where that costs much.
pub fn multipliers(system: &System, frame: &Frame, limits: &Limits) -> Option<Vec<Multiplier>> {
    let program = IntegerProgram::new(system);
    let most = limits.refining.min(limits.products);
    if frame.kept.len() > MOST_REFINED || estimate(system, frame, &program) > most {
        return None;
    }
    let blocks = program.half_period(system, frame);
    let (at_zero, rest) = roots::divided_out(roots::characteristic(&blocks.product()), &BigInt::zero());
    let (at_minus_one, mut rest) = roots::divided_out(rest, &-&blocks.scale);
    let edge = |mu: f64| Multiplier::new(Complex64::new(mu, 0.0), Some(0.0), Some((0.0, 0.0)));
    let mut found = vec![edge(-1.0); at_minus_one];
    found.extend(vec![edge(0.0); at_zero]);
    // Each round finds the roots that are left as often as that.
    while rest.len() > 1 {
        let simple = squarefree(&rest);
        found.extend(refined::multipliers(&simple, &blocks.scale, TIMES_TO_REFINE.saturating_mul(most))?);
        rest = quotient(&rest, &simple).expect("a divisor");
    }
    Some(found)
}

/// Whether the trace of S = Bᵀ C proves growth, within the limits; the rigid modes of `frame` are set apart.
///
/// Stable motion has all n eigenvalues μ in \[−1, 0\], so a trace outside \[−n, 0\] is growth. It costs n²
/// products and decides growth beyond the range of doubles, where a characteristic polynomial takes minutes.
pub(crate) fn grows_by_trace(system: &System, frame: &Frame, limits: &Limits) -> bool {
    let program = IntegerProgram::new(system);
    let (words, compose) = composing(system, frame, &program);
    if compose + (frame.kept.len() as f64 * words).powi(2) > limits.products as f64 {
        return false;
    }
    let blocks = program.half_period(system, frame);
    let trace: BigInt = blocks.b.iter().zip(blocks.c.iter()).map(|(b, c)| b * c).sum();
    trace.is_positive() || trace < -&blocks.scale * BigInt::from(blocks.b.nrows())
}

/// The words of the half period's numbers, and the products of 64-bit words of composing it, in which they
/// grow by the bits of f with each kick.
fn composing(system: &System, frame: &Frame, program: &IntegerProgram) -> (f64, f64) {
    let kicks = (system.schedule().strikes() / 2 + 1) as f64;
    let words = kicks * program.bits() as f64 / 64.0 + 1.0;
    let entries: usize = system.clocks().iter().map(|c| c.stiffness.support().len()).max().unwrap_or(0);
    (words, kicks * 2.0 * frame.kept.len() as f64 * 3.0 * entries as f64 * words / 2.0)
}

/// Products of 64-bit words, roughly: composing, and n³ operations for each of the primes of which the
/// coefficients consist.
fn estimate(system: &System, frame: &Frame, program: &IntegerProgram) -> u64 {
    let n = frame.kept.len() as f64;
    let (words, compose) = composing(system, frame, program);
    let primes = 2.0 * n * words + 1.0;
    let characteristic = primes * (2.0 * n * n * words + 2.0 * n * n * n + n * primes);
    (compose + characteristic).min(1e19) as u64
}

fn judge(blocks: &IntegerBlocks) -> ExactVerdict {
    let (product, d) = (blocks.product(), &blocks.scale);
    let (kind, roots) = judged(&product, d, [&blocks.a, &blocks.b, &blocks.c, &blocks.d]);
    ExactVerdict { kind, roots }
}

/// That [`judged_blocks`] and the half period itself are within the limits, for n degrees of freedom and
/// kicks whose entries have so many bits: numbers gain those of a kick's with each, and products of n of
/// them.
///
/// # Errors
/// A budget error.
pub(crate) fn allow_blocks(n: usize, (kicks, bits): (f64, f64), limits: &Limits) -> Result<()> {
    let (size, words) = (n as f64, 1.0 + kicks * bits / 64.0);
    let cost = 1.5 * kicks * size.powi(3) * words.powi(2)
        + size.powi(4) * words * 4.0
        + size.powi(3) * words.powi(2);
    limits.allow(cost.min(1e19) as u64, || format!("exact arithmetic on {}", degrees_of_freedom(n)))
}

/// Positions and momenta over ℚ, a column a solution, led through events, each the time of the drift before
/// it and the F of all its kicks together: x ← x + t M⁻¹ p, then p ← p − F x. M is diagonal.
pub(crate) fn led(
    start: [DMatrix<Rational>; 2],
    inverse_mass: &[Rational],
    events: impl Iterator<Item = (Rational, DMatrix<Rational>)>,
) -> [DMatrix<Rational>; 2] {
    events.fold(start, |[mut x, mut p], (time, kick)| {
        for (i, inverse) in inverse_mass.iter().enumerate() {
            let moved = p.row(i) * (&time * inverse);
            x.row_mut(i).add_assign(&moved);
        }
        p -= kick * &x;
        [x, p]
    })
}

/// The kind from S and the blocks A, B, C, D of the half period over ℚ.
pub(crate) fn judged_blocks(product: &DMatrix<Rational>, blocks: [&DMatrix<Rational>; 4]) -> (Kind, MuCount) {
    let (product, d) = whole(product);
    let blocks = blocks.map(|block| whole(block).0);
    judged(&product, &d, blocks.each_ref())
}

/// d m in integers, and d > 0.
fn whole(m: &DMatrix<Rational>) -> (DMatrix<BigInt>, BigInt) {
    let d = m.iter().fold(BigInt::one(), |lcm, x| lcm.lcm(x.denom()));
    (m.map(|x| x.numer() * (&d / x.denom())), d)
}

/// The kind from d S in integers, d > 0, and multiples of the blocks A, B, C, D of the half period.
fn judged(product: &DMatrix<BigInt>, scale: &BigInt, [a, b, c, d]: [&DMatrix<BigInt>; 4]) -> (Kind, MuCount) {
    let polynomial = roots::characteristic(product);
    let (at_zero, rest) = roots::divided_out(polynomial, &BigInt::zero());
    let (at_minus_one, rest) = roots::divided_out(rest, &-scale);
    let simple = squarefree(&rest);
    let [mut inside, mut above, mut below, mut complex] = [0; 4];
    // Each round counts the roots that are left as often as that.
    let (mut left, mut round) = (rest.clone(), simple.clone());
    while left.len() > 1 {
        let root_count: RootCount = roots::count(&round, scale);
        inside += root_count.inside;
        above += root_count.above;
        below += root_count.below;
        complex += root_count.complex;
        left = quotient(&left, &round).expect("a divisor");
        round = squarefree(&left);
    }
    let mu = MuCount { inside, at_zero, at_minus_one, above, below, complex };
    let semisimple = || {
        (at_zero == 0 || nullity(b) + nullity(c) == 2 * at_zero)
            && (at_minus_one == 0 || nullity(a) + nullity(d) == 2 * at_minus_one)
            && (simple.len() == rest.len() || rank_at(product, &simple) == at_zero + at_minus_one)
    };
    let kind = if above + below + complex > 0 {
        Kind::Hyperbolic
    } else if !semisimple() {
        Kind::Parabolic
    } else if at_zero + at_minus_one > 0 {
        Kind::Coexistence
    } else {
        Kind::Elliptic
    };
    (kind, mu)
}

fn nullity(m: &DMatrix<BigInt>) -> usize {
    let bound = m.iter().map(Signed::abs).max().unwrap_or_default();
    m.nrows() - roots::rank(m.nrows(), &bound, |field| modular::matrix(field, m))
}

/// rank f(m).
fn rank_at(m: &DMatrix<BigInt>, f: &[BigInt]) -> usize {
    let n = m.nrows();
    let norm = roots::row_sum(m);
    let bound = f.iter().rev().fold(BigInt::zero(), |value, c| value * &norm + c.abs()) + BigInt::one();
    roots::rank(n, &bound, |field| {
        let m = modular::matrix(field, m);
        f.iter().rev().fold(DMatrix::from_element(n, n, 0), |value, c| {
            let mut next = modular::times(field, &value, &m);
            let c = field.of_big(c);
            (0..n).for_each(|i| next[(i, i)] = field.add(next[(i, i)], c));
            next
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::Numbers;
    use crate::{Potential, Symmetric, decide_system, exact_kind};
    use number::ratio;

    /// Random entries, or (so that edges are met exactly) diagonal stiffnesses of 0 to 5, turned by (3,
    /// 4, 5); of these a third with two modes alike (multiple multipliers, of both of Krein's signs where
    /// single stiffnesses differ), a third with a rigid mode.
    fn system(numbers: &mut Numbers) -> System {
        let n = 1 + numbers.below(3) as usize;
        let edges = numbers.below(2) == 0;
        let special = numbers.below(3);
        let turn: Vec<Vec<Rational>> = (0..n)
            .map(|i| {
                let entry = |j: usize| match (i, j) {
                    (0, 0) | (1, 1) if n > 1 => ratio(3, 5),
                    (0, 1) => ratio(4, 5),
                    (1, 0) => ratio(-4, 5),
                    _ => ratio(i64::from(i == j), 1),
                };
                (0..n).map(entry).collect()
            })
            .collect();
        let mut potential = |step: i64| {
            let (mut stiffness, mut last) = (Symmetric::zero(n), 0);
            for i in 0..n {
                for j in 0..=i {
                    let x = match (edges, i == j) {
                        (true, false) => 0,
                        (true, true) if n > 1 && i == 1 && special == 0 => last,
                        (true, true) if n > 1 && i == 1 && special == 1 => 0,
                        _ => numbers.below(6) - i64::from(!edges),
                    };
                    last = x;
                    stiffness.add(i, j, &if edges { ratio(x, step) } else { ratio(x, 4) });
                }
            }
            Potential { stiffness: stiffness.congruent(&turn), step: ratio(step, 1), phase: ratio(0, 1) }
        };
        let potentials = vec![potential(1), potential(2), potential(3)];
        System::new(Symmetric::diagonal(&vec![ratio(1, 1); n]), potentials).unwrap()
    }

    /// Decides by doubles, by characteristic polynomials and by the trace where that tells, which must agree:
    /// how often each kind was found.
    fn agreed(count: usize) -> std::collections::BTreeMap<&'static str, usize> {
        let (mut numbers, limits) = (Numbers(7), Limits::default());
        let mut decided = std::collections::BTreeMap::new();
        for _ in 0..count {
            let system = system(&mut numbers);
            let frame = Frame::new(&system);
            let exact = decide_exact(&system, &limits).unwrap();
            let kind = exact.kind;
            let parts = exact_kind(&system, &limits).unwrap();
            let analysis = decide_system(&system, &limits).unwrap();
            assert!(
                analysis.is_proof() && analysis.kind.unwrap() == parts,
                "{:?} {parts:?} {system:?}",
                analysis.kind.unwrap()
            );
            let MuCount { inside, at_zero, at_minus_one, above, below, complex } = exact.roots;
            assert_eq!(inside + at_zero + at_minus_one + above + below + complex, frame.kept.len());
            let mut seen = vec![kind.name()];
            if grows_by_trace(&system, &frame, &limits) {
                assert_eq!(kind, Kind::Hyperbolic, "{system:?}");
                seen.push("trace");
            }
            if !frame.rigid.is_empty() {
                seen.push("rigid");
            }
            seen.into_iter().for_each(|way| *decided.entry(way).or_insert(0) += 1);
        }
        decided
    }

    #[test]
    fn doubles_and_traces_agree_with_characteristic_polynomials() {
        let decided = agreed(300);
        let ways = ["elliptic", "parabolic", "hyperbolic", "rigid", "trace"];
        let seen = ways.iter().all(|kind| decided.get(kind).is_some_and(|count| *count > 5));
        assert!(seen, "{decided:?}");
    }

    #[test]
    #[ignore = "some minutes"]
    fn doubles_and_traces_agree_with_characteristic_polynomials_of_10_000_systems() {
        println!("10,000 systems of 1 to 3 degrees of freedom, all equal: {:?}", agreed(10_000));
    }
}
