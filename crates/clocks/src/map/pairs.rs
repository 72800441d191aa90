//! Many pairs made of few quantities: each quantity is read once, so that a pair costs no exact arithmetic as
//! long as doubles decide it.

use std::ops::Range;

use num_traits::ToPrimitive;

use super::work::LANES;
use crate::orbit::strengths::Strengths;
use crate::propagator::Oscillator;
use crate::verdict::{Decision, Limits, decide_steps};
use number::error::Kind;
use number::vector::each;
use number::vector::instructions::{Instructions, Task};
use number::{Error, ExactSign, Laurent, Rational, Real, Result, Sign, Twofold};

/// The quantities' names, and what those must hear that are not positive.
const FIELDS: [(&str, Option<&str>); 4] = [
    ("lambda1", Some("the fast stiffness must be positive")),
    ("lambda2", None),
    ("h1", Some("a step must be positive")),
    ("h2", Some("a step must be positive")),
];

/// Pairs whose Λ1, Λ2 (in 1/time²), h1 and h2 (in time) are picked from four lists.
///
/// ```
/// use kickdrift_clocks::map::{Pairs, Resources};
/// use kickdrift_clocks::number::{Laurent, rational::ratio};
/// let whole = |n| Laurent::from_rational(ratio(n, 1));
/// let steps = (1..200).map(|n| [ratio(2, 5), ratio(n, 60)].map(Laurent::from_rational));
/// let pairs = Pairs::of_steps(whole(10), whole(1), steps)?;
/// let decisions = pairs.verdicts(&Resources::default())?;
/// assert_eq!((decisions.len(), decisions[178].verdict.is_stable()), (199, false));
/// # Ok::<(), kickdrift_clocks::number::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pairs {
    quantities: [Vec<Laurent>; 4],
    /// Their values in doubles: apart, because these are read for every pair.
    known: [Vec<Known>; 4],
    picked: [Vec<usize>; 4],
}

/// A quantity as doubles and machine integers.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// Within 2^-103; 0 of 0 and far from 1.
    near: Twofold,
    /// a, b and k of a/b π^k with 0 < a, b < 2^32; b = 0 of all others.
    monomial: (u32, u32, i32),
}

impl Pairs {
    /// The n-th pair is made of the quantities at the n-th positions: Λ1, Λ2, h1, h2.
    ///
    /// # Errors
    /// Λ1 or a step that is not positive, positions of unequal number, or one beyond its list.
    pub fn new(quantities: [Vec<Laurent>; 4], picked: [Vec<usize>; 4]) -> Result<Pairs> {
        for ((values, picked), (field, positive)) in quantities.iter().zip(&picked).zip(FIELDS) {
            let refused =
                |remedy| values.iter().position(|x| x.sign() != Sign::Positive).map(|n| (n, remedy));
            if let Some((n, remedy)) = positive.and_then(refused) {
                let place = if values.len() > 1 { format!("{field}[{n}]") } else { field.into() };
                return Err(Error::input(&place, &values[n], remedy));
            }
            if let Some(beyond) = picked.iter().find(|&&n| n >= values.len()) {
                return Err(Error::input(
                    field,
                    beyond,
                    format!("there are {} values to pick from", values.len()),
                ));
            }
        }
        let [count, others @ ..] = picked.each_ref().map(Vec::len);
        if others.iter().any(|&other| other != count) {
            return Err(Error::input("pairs", count, "pick as many of each of the four quantities"));
        }
        let known = quantities.each_ref().map(|values| values.iter().map(Known::of).collect());
        Ok(Pairs { quantities, known, picked })
    }

    /// One oscillator under many pairs of steps h1, h2.
    ///
    /// # Errors
    /// As [`Pairs::new`].
    pub fn of_steps(
        lambda1: Laurent,
        lambda2: Laurent,
        steps: impl IntoIterator<Item = [Laurent; 2]>,
    ) -> Result<Pairs> {
        let (first, second): (Vec<Laurent>, Vec<Laurent>) =
            steps.into_iter().map(|[h1, h2]| (h1, h2)).unzip();
        let (one, each) = (vec![0; first.len()], (0..first.len()).collect::<Vec<usize>>());
        Pairs::new([vec![lambda1], vec![lambda2], first, second], [one.clone(), one, each.clone(), each])
    }

    fn known(&self, n: usize) -> [&Known; 4] {
        std::array::from_fn(|k| &self.known[k][self.picked[k][n]])
    }

    fn oscillator(&self, n: usize) -> Result<Oscillator> {
        let [lambda1, lambda2, h1, h2] =
            std::array::from_fn(|k| self.quantities[k][self.picked[k][n]].clone());
        Oscillator::new(lambda1, lambda2, h1, h2)
    }

    /// How many pairs there are.
    pub(super) fn count(&self) -> usize {
        self.picked[0].len()
    }

    /// Hands these pairs on in doubles, in their order and with their numbers, without those that doubles do
    /// not serve.
    pub(super) fn strengths(&self, part: Range<usize>, mut each: impl FnMut(usize, Strengths)) {
        let (instructions, end) = (Instructions::best(), part.end);
        for first in part.step_by(LANES) {
            let count = LANES.min(end - first);
            let known: [_; LANES] = std::array::from_fn(|i| self.known(first + i.min(count - 1)));
            let each = |i: usize, pair| each(first + i, pair);
            instructions.perform(Combine { known: &known, count, each });
        }
    }

    /// The verdict on the n-th pair by the ladder; an error says which pair it is about.
    pub(super) fn decide(&self, n: usize, limits: &Limits) -> Result<Decision> {
        decide_steps(&self.oscillator(n)?, limits).map_err(|error| match error.kind() {
            Kind::Budget if self.count() > 1 => {
                let work = format!("pair {n}: {}", error.field());
                error.at(work)
            }
            _ => error,
        })
    }
}

impl Known {
    fn of(exact: &Laurent) -> Known {
        let small = |x: &Rational| {
            let (a, b) = (x.numer().to_u32()?, x.denom().to_u32()?);
            (a > 0).then_some((a, b))
        };
        let monomial = exact.as_monomial().and_then(|(k, c)| small(c).map(|(a, b)| (a, b, k)));
        let near = match monomial {
            Some((a, b, 0)) => Twofold::quotient(a.into(), b.into()),
            _ => Twofold::near(&exact.enclosure(Twofold::ENCLOSURE_BITS)),
        };
        Known { near: near.unwrap_or(Twofold::ZERO), monomial: monomial.unwrap_or((0, 0, 0)) }
    }
}

/// Λ1, Λ2, h1, h2 of as many pairs as run side by side, to be combined without a branch; `each` is shown
/// those of the first `count` that doubles serve, by number.
struct Combine<'a, F> {
    known: &'a [[&'a Known; 4]; LANES],
    count: usize,
    each: F,
}

impl<F: FnMut(usize, Strengths)> Task for Combine<'_, F> {
    type Output = ();

    /// Strengths are products of three: within 3 2^-103 + 2 2^-101 < 2^-99.
    #[inline(always)]
    fn run(mut self) {
        let mut near = [[[0.0; LANES]; 2]; 4];
        let (mut above, mut below) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
        let mut serves = [false; LANES];
        for (i, known) in self.known.iter().enumerate() {
            for (to, own) in near.iter_mut().zip(known) {
                (to[0][i], to[1][i]) = (own.near.hi, own.near.lo);
            }
            let steps = [known[2].monomial, known[3].monomial];
            for (k, (a, b, _)) in steps.into_iter().enumerate() {
                (above[k][i], below[k][i]) = (f64::from(a), f64::from(b));
            }
            serves[i] = steps[0].2 == steps[1].2;
        }
        // Each step is in lowest terms already: two short common divisors instead of a long one. (Products
        // beyond 2^53 are rounded, and do not serve; nor does what comes of a quantity that is not known.)
        let (over, under) = (gcd(&above), gcd(&below));
        let p: [f64; LANES] = each(|i| (above[1][i] / over[i]) * (below[0][i] / under[i]));
        let q: [f64; LANES] = each(|i| (above[0][i] / over[i]) * (below[1][i] / under[i]));
        let two = |k: usize, i: usize| Twofold { hi: near[k][0][i], lo: near[k][1][i] };
        let nothing = Strengths { s: Twofold::ZERO, kick: 0.0, p: 0.0, q: 0.0 };
        let mut found = [nothing; LANES];
        for i in 0..LANES {
            let ([lambda1, lambda2], [h1, h2]) = ([two(0, i), two(1, i)], [two(2, i), two(3, i)]);
            let both = h1.times(h2);
            let (p, q) = (p[i], q[i]);
            let first = Strengths { s: h1.times(h1).times(lambda1), kick: both.times(lambda2).hi, p, q };
            let second =
                Strengths { s: h2.times(h2).times(lambda2), kick: both.times(lambda1).hi, p: q, q: p };
            let (one, other) = (first.serves(), second.serves());
            serves[i] &= one | other;
            found[i] = Strengths::either(one & ((p >= q) | !other), first, second);
        }
        for i in 0..self.count {
            if serves[i] {
                (self.each)(i, found[i]);
            }
        }
    }
}

/// The greatest common divisors of whole numbers below 2^32, by Euclid with the remainders that are least in
/// size: a quotient rounded to the wrong neighbour, as near a half, leaves half of b all the same, exactly.
#[inline(always)]
fn gcd([a, b]: &[[f64; LANES]; 2]) -> [f64; LANES] {
    let (mut a, mut b) = (*a, *b);
    while b.iter().fold(0, |bits, b| bits | b.to_bits()) != 0 {
        let rest: [f64; LANES] = each(|i| {
            let nearest = (a[i] / b[i]).round_ties_even();
            if b[i] > 0.0 { (-nearest).mul_add(b[i], a[i]).abs() } else { 0.0 }
        });
        a = each(|i| if b[i] > 0.0 { b[i] } else { a[i] });
        b = rest;
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_integer::Integer;
    use proptest::prelude::*;

    proptest! {
        /// Random numbers, and n b and (n + 1/2) b with one more or less: quotients next to a half.
        #[test]
        fn common_divisors_are_the_greatest(
            all in prop::collection::vec((1u32.., 0u32..1 << 16, 0u32..1 << 15, -1i64..=1, any::<bool>()), LANES),
        ) {
            let numbers = |&(a, b, n, more, near): &(u32, u32, u32, i64, bool)| {
                let halves = (i64::from(b) * i64::from(2 * n + 1) / 2 + more).max(0) as u32;
                if near { [halves, b] } else { [a, b] }
            };
            let all: Vec<[u32; 2]> = all.iter().map(numbers).collect();
            let found = gcd(&[0, 1].map(|k| each(|i| f64::from(all[i][k]))));
            for ([a, b], found) in all.into_iter().zip(found) {
                prop_assert_eq!(found, f64::from(a.gcd(&b)));
            }
        }
    }
}
