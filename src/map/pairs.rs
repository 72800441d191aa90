//! Many pairs made of few quantities: each quantity is read once, so that a pair costs no exact arithmetic as long as doubles
//! decide it.

use num_traits::ToPrimitive;

use super::resources::Resources;
use super::scattered::{Source, decide_each};
use crate::error::{Error, Result};
use crate::number::{ExactSign, Laurent, Ratio, Rational, Real, Sign, Twofold};
use crate::orbit::floquet::Floquet;
use crate::propagator::{Oscillator, TwoClocks};
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
    monomial: Option<(u64, u64, i32)>,
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

    /// The strengths are products of three: within 3 2^-103 + 2 2^-101 < 2^-99.
    fn in_doubles(&self, n: usize) -> Option<Floquet> {
        let [lambda1, lambda2, h1, h2] = self.known(n);
        let ratio = h1.below(h2)?;
        let [lambda1, lambda2, h1, h2] = [lambda1.near?, lambda2.near?, h1.near?, h2.near?];
        let both = h1.times(h2);
        let own = || Floquet::in_doubles(ratio, h1.times(h1).times(lambda1), both.times(lambda2));
        let other = || Floquet::in_doubles(ratio.inverse(), h2.times(h2).times(lambda2), both.times(lambda1));
        if ratio.p() >= ratio.q() { own().or_else(other) } else { other().or_else(own) }
    }
}

impl Source for Pairs {
    fn count(&self) -> usize {
        self.picked[0].len()
    }

    fn floquet(&self, n: usize) -> Result<Option<Floquet>> {
        let quick = self.in_doubles(n);
        if quick.is_some() { Ok(quick) } else { Ok(Floquet::new(&self.clocks(n)?)) }
    }

    fn decide(&self, n: usize, limits: &Limits) -> Result<Decision> {
        let clocks = self.clocks(n)?;
        match clocks.as_rational() {
            Some(rational) => decide(&rational, limits).map(|answer| answer.decision()),
            None => decide(&clocks, limits).map(|answer| answer.decision()),
        }
    }
}

impl Known {
    fn new(exact: Laurent) -> Known {
        let small = |x: &Rational| {
            let (p, q) = (x.numer().to_u32()?, x.denom().to_u32()?);
            (p > 0).then_some((u64::from(p), u64::from(q)))
        };
        let monomial = exact.as_monomial().and_then(|(k, c)| small(c).map(|(p, q)| (p, q, k)));
        let near = match monomial {
            Some((p, q, 0)) => Twofold::quotient(p, q),
            _ => Twofold::near(&exact.enclosure(Twofold::ENCLOSURE_BITS)),
        };
        Known { exact, near, monomial }
    }

    /// `other`/self in lowest terms, where both are small.
    fn below(&self, other: &Known) -> Option<Ratio> {
        let ((p1, q1, k1), (p2, q2, k2)) = (self.monomial?, other.monomial?);
        if k1 == k2 { Ratio::new(p2 * q1, q2 * p1).ok() } else { None }
    }
}
