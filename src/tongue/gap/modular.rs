//! Do two entries share a zero at all? Decided modulo a prime.
//!
//! For fixed p/q and ρ the entries are polynomials in κ. **Lemma.** If a prime does not divide the denominators of
//! ρ p/q, the degrees of X and Y survive modulo it, and X and Y have no common factor there, they have none over Q:
//! their resultant is an integer (up to powers of the denominator) that is not 0 modulo the prime. So B and C without
//! a common factor mean that no tongue of even m is closed, however thin; A and D likewise for odd m. The other
//! answer, a common factor, may be an accident of the prime and is left to exact arithmetic.

use std::sync::OnceLock;

use num_bigint::BigInt;
use num_traits::{ToPrimitive, Zero};

use crate::error::Result;
use crate::number::{Ratio, Rational};
use crate::schedule::{Schedule, Weight};
use crate::tongue::edge::Edges;
use crate::tongue::string::Entry;

/// 2^61 − 1, a Mersenne prime.
const PRIME: u64 = (1 << 61) - 1;

fn times(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

fn minus(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + PRIME - b }
}

fn plus(a: u64, b: u64) -> u64 {
    minus(a, if b == 0 { 0 } else { PRIME - b })
}

fn power(a: u64, n: u64) -> u64 {
    let square = |half: u64| times(half, half);
    match n {
        0 => 1,
        _ if n % 2 == 1 => times(a, square(power(a, n / 2))),
        _ => square(power(a, n / 2)),
    }
}

/// a/b; `None` where the prime divides b.
fn over(a: u64, b: u64) -> Option<u64> {
    (b != 0).then(|| times(a, power(b, PRIME - 2)))
}

fn residue(x: &Rational) -> Option<u64> {
    let reduce = |n: &BigInt| {
        let prime = BigInt::from(PRIME);
        (((n % &prime) + &prime) % &prime).to_u64().expect("below the prime")
    };
    over(reduce(x.numer()), reduce(x.denom()))
}

/// c_0, c_1, ..., the last one not 0.
type Coefficients = Vec<u64>;

fn trim(mut f: Coefficients) -> Coefficients {
    while f.last() == Some(&0) {
        f.pop();
    }
    f
}

/// x += c y.
fn add_multiple(x: &mut Coefficients, c: u64, y: &[u64]) {
    x.resize(x.len().max(y.len()), 0);
    x.iter_mut().zip(y).for_each(|(x, y)| *x = plus(*x, times(c, *y)));
}

/// x and v at T/2 as polynomials in 2κ; `None` where the prime divides a denominator.
fn ends(ratio: Ratio, rho: &Rational, even: bool) -> Result<Option<(Coefficients, Coefficients)>> {
    let Some(slow) = residue(&(rho * Rational::from(ratio))) else { return Ok(None) };
    let half = [0, 1, slow, plus(1, slow)];
    let (mut x, mut v) = if even { (vec![1], vec![]) } else { (vec![], vec![1]) };
    let schedule = Schedule::two_clocks(ratio)?;
    for event in schedule.half_period() {
        add_multiple(&mut x, event.drift % PRIME, &v);
        let mass = half[event.kicks as usize];
        let mass = if event.weight == Weight::Half { mass } else { plus(mass, mass) };
        let raised: Coefficients = std::iter::once(0).chain(x.iter().copied()).collect();
        add_multiple(&mut v, minus(0, mass), &raised);
    }
    Ok(Some((trim(x), trim(v))))
}

/// The degree of the greatest common divisor.
fn common_degree(mut a: Coefficients, mut b: Coefficients) -> usize {
    while !b.is_empty() {
        let inverse = power(*b.last().expect("not empty"), PRIME - 2);
        while a.len() >= b.len() {
            let (shift, factor) = (a.len() - b.len(), times(*a.last().expect("not empty"), inverse));
            for (a, b) in a[shift..].iter_mut().zip(&b) {
                *a = minus(*a, times(factor, *b));
            }
            a = trim(a);
        }
        std::mem::swap(&mut a, &mut b);
    }
    a.len().saturating_sub(1)
}

/// Whether both edges of every tongue of the given parity of m are proven different, for ρ > 0.
///
/// `degrees` are the numbers of positive zeros of (B, C) for even m, of (A, D) for odd m.
fn all_open(ratio: Ratio, rho: &Rational, odd: bool, degrees: [usize; 2]) -> Result<bool> {
    debug_assert!(!rho.is_zero());
    let (Some(even_start), Some(odd_start)) = (ends(ratio, rho, true)?, ends(ratio, rho, false)?) else {
        return Ok(false);
    };
    let (first, second) = if odd { (even_start.0, odd_start.1) } else { (odd_start.0, even_start.1) };
    // C = κ times the polynomial of its positive zeros.
    let second = if odd { second } else { second[1..].to_vec() };
    let survived = first.len() == degrees[0] + 1 && second.len() == degrees[1] + 1;
    Ok(survived && common_degree(first, second) == 0)
}

/// What is known of all tongues of even and of all of odd m; asked for once each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Openness([OnceLock<bool>; 2]);

impl Openness {
    /// Whether all tongues of one parity of m are proven open, ρ being positive.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn is_proven(&self, edges: &Edges, odd: bool) -> Result<bool> {
        let known = &self.0[usize::from(odd)];
        if let Some(&open) = known.get() {
            return Ok(open);
        }
        let degrees = Entry::of_tongue(odd).map(|entry| edges.string().dimension(entry));
        let open = all_open(edges.ratio(), edges.rho(), odd, degrees)?;
        Ok(*known.get_or_init(|| open))
    }
}
