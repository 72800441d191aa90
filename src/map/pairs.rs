//! Many pairs made of few quantities: each quantity is read once, so that a pair costs no exact arithmetic as long as doubles
//! decide it.

use std::ops::Range;

use num_traits::ToPrimitive;

use super::resources::Resources;
use super::scattered::{Source, decide_each};
use super::work::LANES;
use crate::error::{Error, Result};
use crate::number::{ExactSign, Laurent, Ratio, Rational, Real, Sign, Twofold};
use crate::orbit::strengths::Strengths;
use crate::propagator::{Oscillator, TwoClocks};
use crate::vector::each;
use crate::vector::instructions::{Instructions, Task};
use crate::verdict::{Decision, Limits, decide};

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
/// use kickdrift::map::{Pairs, Resources};
/// use kickdrift::number::{Laurent, rational::ratio};
/// let whole = |n| Laurent::from_rational(ratio(n, 1));
/// let steps = (1..200).map(|n| [ratio(2, 5), ratio(n, 60)].map(Laurent::from_rational));
/// let pairs = Pairs::of_steps(whole(10), whole(1), steps)?;
/// let decisions = pairs.verdicts(&Resources::default())?;
/// assert_eq!((decisions.len(), decisions[178].verdict.is_stable()), (199, false));
/// # Ok::<(), kickdrift::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pairs {
    quantities: [Vec<Known>; 4],
    picked: [Vec<usize>; 4],
}

/// A quantity, and what doubles and machine integers hold of it.
#[derive(Clone, Debug)]
struct Known {
    exact: Laurent,
    /// Within 2^-103; `None` for 0 and far from 1.
    near: Option<Twofold>,
    /// c π^k as the numerator and the denominator of c > 0, below 2^32, and k.
    monomial: Option<(u32, u32, i32)>,
}

impl Pairs {
    /// The n-th pair is made of the quantities at the n-th positions: Λ1, Λ2, h1, h2.
    ///
    /// # Errors
    /// Λ1 or a step that is not positive, positions of unequal number, or one beyond its list.
    pub fn new(quantities: [Vec<Laurent>; 4], picked: [Vec<usize>; 4]) -> Result<Pairs> {
        for ((values, picked), (field, positive)) in quantities.iter().zip(&picked).zip(FIELDS) {
            let refused = |remedy| values.iter().find(|x| x.sign() != Sign::Positive).map(|x| (x, remedy));
            if let Some((value, remedy)) = positive.and_then(refused) {
                return Err(Error::input(field, value, remedy));
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
        Ok(Pairs {
            quantities: quantities.map(|values| values.into_iter().map(Known::new).collect()),
            picked,
        })
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

    /// The verdicts in the order of the pairs: those of [`decide`], with pairs of about the same number of updates run side
    /// by side.
    ///
    /// # Errors
    /// A pair whose steps have an irrational ratio, a budget error where one would compose more kicks than the limits allow,
    /// and `Stopped`.
    pub fn verdicts(&self, resources: &Resources) -> Result<Vec<Decision>> {
        decide_each(self, resources)
    }

    fn known(&self, n: usize) -> [&Known; 4] {
        std::array::from_fn(|k| &self.quantities[k][self.picked[k][n]])
    }

    fn clocks(&self, n: usize) -> Result<TwoClocks<Laurent>> {
        let [lambda1, lambda2, h1, h2] = self.known(n).map(|known| known.exact.clone());
        Ok(Oscillator::new(lambda1, lambda2, h1, h2)?.clocks())
    }
}

impl Source for Pairs {
    fn count(&self) -> usize {
        self.picked[0].len()
    }

    fn strengths(&self, part: Range<usize>, mut each: impl FnMut(usize, Strengths)) {
        let (instructions, end) = (Instructions::best(), part.end);
        for first in part.step_by(LANES) {
            let known: [_; LANES] = std::array::from_fn(|i| self.known((first + i).min(end - 1)));
            let found = instructions.perform(Combine(&known));
            (first..end).zip(found).for_each(|(n, pair)| {
                if let Some(pair) = pair {
                    each(n, pair)
                }
            });
        }
    }

    fn decide(&self, n: usize, limits: &Limits) -> Result<Decision> {
        decide(&self.clocks(n)?, limits).map(|answer| answer.decision())
    }
}

impl Known {
    fn new(exact: Laurent) -> Known {
        let small = |x: &Rational| {
            let (p, q) = (x.numer().to_u32()?, x.denom().to_u32()?);
            (p > 0).then_some((p, q))
        };
        let monomial = exact.as_monomial().and_then(|(k, c)| small(c).map(|(p, q)| (p, q, k)));
        let near = match monomial {
            Some((p, q, 0)) => Twofold::quotient(p.into(), q.into()),
            _ => Twofold::near(&exact.enclosure(Twofold::ENCLOSURE_BITS)),
        };
        Known { exact, near, monomial }
    }
}

/// Λ1, Λ2, h1, h2 of as many pairs as run side by side, to be combined without a branch.
struct Combine<'a>(&'a [[&'a Known; 4]; LANES]);

impl Task for Combine<'_> {
    type Output = [Option<Strengths>; LANES];

    /// Strengths are products of three: within 3 2^-103 + 2 2^-101 < 2^-99.
    #[inline(always)]
    fn run(self) -> Self::Output {
        let mut near = [[[0.0; LANES]; 2]; 4];
        let (mut above, mut below) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
        let mut serves = [false; LANES];
        for (i, known) in self.0.iter().enumerate() {
            let (Some(first), Some(second)) = (known[2].monomial, known[3].monomial) else { continue };
            serves[i] = first.2 == second.2 && known.iter().all(|own| own.near.is_some());
            for (to, own) in near.iter_mut().zip(known) {
                let own = own.near.unwrap_or(Twofold::PI);
                (to[0][i], to[1][i]) = (own.hi, own.lo);
            }
            for (k, (p, q, _)) in [first, second].into_iter().enumerate() {
                (above[k][i], below[k][i]) = (f64::from(p), f64::from(q));
            }
        }
        // Each step is in lowest terms already: two short common divisors instead of a long one.
        let (over, under) = (gcd(&above), gcd(&below));
        let p: [f64; LANES] = each(|i| (above[1][i] / over[i]) * (below[0][i] / under[i]));
        let q: [f64; LANES] = each(|i| (above[0][i] / over[i]) * (below[1][i] / under[i]));
        let two = |k: usize, i: usize| Twofold { hi: near[k][0][i], lo: near[k][1][i] };
        let mut products = [[[0.0; LANES]; 4]; 2];
        for i in 0..LANES {
            let ([lambda1, lambda2], [h1, h2]) = ([two(0, i), two(1, i)], [two(2, i), two(3, i)]);
            let both = h1.times(h2);
            let first = (h1.times(h1).times(lambda1), both.times(lambda2));
            let second = (h2.times(h2).times(lambda2), both.times(lambda1));
            for (to, (s, kick)) in products.iter_mut().zip([first, second]) {
                (to[0][i], to[1][i], to[2][i], to[3][i]) = (s.hi, s.lo, kick.hi, kick.lo);
            }
        }
        std::array::from_fn(|i| {
            // What is beyond 2^53 may be rounded.
            let exact = serves[i] && p[i].max(q[i]) < (1u64 << 53) as f64;
            let ratio = exact.then(|| Ratio::of_coprime(p[i] as u64, q[i] as u64)).flatten()?;
            let of = |k: usize| {
                let two = |n: usize| Twofold { hi: products[k][n][i], lo: products[k][n + 1][i] };
                Some([two(0), two(2)])
            };
            Strengths::on_either(ratio, || of(0), || of(1))
        })
    }
}

/// The greatest common divisors of whole numbers below 2^32, by Euclid: their quotients are no integer rounded up, being 1/b below
/// the next one at least.
#[inline(always)]
fn gcd([a, b]: &[[f64; LANES]; 2]) -> [f64; LANES] {
    let (mut a, mut b) = (*a, *b);
    while b.iter().fold(0, |bits, b| bits | b.to_bits()) != 0 {
        let rest: [f64; LANES] = each(|i| {
            let whole = (a[i] / b[i]).floor();
            if b[i] > 0.0 { (-whole).mul_add(b[i], a[i]) } else { 0.0 }
        });
        a = each(|i| if b[i] > 0.0 { b[i] } else { a[i] });
        b = rest;
    }
    a
}
