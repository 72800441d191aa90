//! A word of a family, and how good it is.

use super::super::linted::{BITS, Linted};
use super::asked::{Family, Goal};
use crate::question::asking::{Question, Work};
use num_traits::{One, Zero};
use number::polynomial::Sturm;
use number::{Ball, Enclosed, Polynomial, Radical, Rational, Real, Result, Sign, rational};
use words::{ErrorTerm, Forces};

/// A word of a family.
#[derive(Clone, Debug)]
pub struct Member {
    /// The values of all parameters.
    pub values: Vec<Rational>,
    pub linted: Linted,
    /// (R + 1/R)/2 − 1 at the worst step up to a length, R the bias; `None` where one of them is unstable, or
    /// the word has no bias.
    pub bias: Option<Ball>,
}

/// Bits of squares of errors: two of them are told apart where their parameters differ by 2^-60.
const ERROR_BITS: u32 = 256;

/// Places of the largest bias are known to this part of the range.
const PLACE_LOG2: i64 = -60;

impl Family {
    /// √Λ1 h up to which the bias counts: as many as Verlet steps of length 1 cost as much.
    pub(crate) fn up_to(&self, linted: &Linted) -> Rational {
        let evaluations = || Rational::from_integer(linted.cost.evaluations[0].max(1).into());
        self.up_to.clone().unwrap_or_else(evaluations)
    }

    /// The word at some values of all parameters, and what is known of it.
    pub(super) fn member(&self, values: &[Rational], work: &Work) -> Result<Member> {
        let linted = self.asked_at(values)?.answer(work)?;
        let bias = worst_bias(&linted, &self.up_to(&linted));
        Ok(Member { values: values.to_vec(), linted, bias })
    }
}

impl Member {
    /// The order where the kinetic energy is quadratic.
    pub fn nystrom_order(&self) -> Option<u64> {
        self.linted.general.as_ref().ok().map(|orders| orders.nystrom.order)
    }

    /// The error of one degree, in commutators; none where the order is higher.
    pub fn terms(&self, degree: u64) -> Option<&[ErrorTerm]> {
        let nystrom = &self.linted.general.as_ref().ok()?.nystrom;
        Some(if nystrom.order + 1 == degree { &nystrom.error } else { &[] })
    }

    /// The sum of the squares of its coefficients.
    pub fn square(&self, degree: u64) -> Option<Radical> {
        let sum = |sum: Radical, term: &ErrorTerm| &sum + &(&term.coefficient * &term.coefficient);
        Some(self.terms(degree)?.iter().fold(Radical::zero(), sum))
    }

    /// How good it is: the greater the better. Edges leave out unstable intervals that rounded numbers open.
    pub(super) fn score(&self, goal: Goal, degree: Option<u64>) -> Option<Ball> {
        self.score_by(goal, degree, Linted::nominal_edge)
    }

    /// The same with edges as they are.
    pub(super) fn strict_score(&self, goal: Goal, degree: Option<u64>) -> Option<Ball> {
        self.score_by(goal, degree, Linted::edge_omega_h)
    }

    fn score_by(&self, goal: Goal, degree: Option<u64>, edge: fn(&Linted) -> Option<Ball>) -> Option<Ball> {
        let edge = || edge(&self.linted);
        match goal {
            Goal::Edge => edge(),
            Goal::Efficiency => edge()?.div(&Ball::from_integer(&self.linted.cost.total().into()), BITS),
            Goal::Error => self.square(degree?).map(|square| square.enclosure(ERROR_BITS).neg()),
            Goal::Bias => self.bias.as_ref().map(Ball::neg),
        }
    }

    /// Less the width of the first unstable interval that ends, as a part of where it begins.
    pub(super) fn closeness(&self) -> Option<Ball> {
        let gap = self.linted.stability.as_ref()?.intervals.get(1).filter(|gap| !gap.stable)?;
        let [lower, upper] = [gap.lower.as_ref()?.s(), gap.upper.as_ref()?.s()];
        lower.sub(&upper, BITS).div(&lower, BITS)
    }
}

/// f(x).
fn value(f: &Polynomial<Radical>, x: &Ball) -> Ball {
    f.map(|c| Enclosed::<BITS>(c.enclosure(BITS))).eval(&Enclosed(x.clone())).0
}

/// The largest (R + 1/R)/2 − 1 over all steps up to √Λ1 h = `up_to`: R = −(1 + ρ) s B/C is a rational
/// function of s, so it is found at the end or where its derivative vanishes.
fn worst_bias(linted: &Linted, up_to: &Rational) -> Option<Ball> {
    let (rho, square) = (linted.rho.as_ref()?, up_to * up_to);
    let first = linted.stability.as_ref()?.intervals.first().filter(|first| first.stable)?;
    if first.upper.as_ref().is_some_and(|edge| edge.compare(&square) != Sign::Positive) {
        return None;
    }
    let product = linted.word.polynomials(&Forces::ratio(rho));
    let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|at| &product.matrix[at]);
    if a != d || !c.coefficient(0).is_zero() {
        return None;
    }
    let c = Polynomial::new(c.coefficients().get(1..)?.to_vec());
    // Both vanish where an unstable interval has closed, the propagator being ±I; R goes on there.
    let common = b.gcd(&c);
    let [b, c] = [b, &c].map(|f| f.div_rem(&common).map(|(quotient, _)| quotient));
    let (b, c) = (b?, c?);
    let slope = &(&b.derivative() * &c) - &(&b * &c.derivative());
    let mut places = vec![Ball::from_rational(&square, BITS)];
    if slope.degree().is_some_and(|degree| degree > 0) {
        let chain = Sturm::over_field(&slope.squarefree());
        let width = &square * rational::scale2(&1.into(), PLACE_LOG2);
        let inside = |ends: &(Rational, Rational)| ends.0 > Rational::zero() && ends.1 < square;
        let refined = chain.isolate().into_iter().map(|ends| chain.refine(&ends, &width)).filter(inside);
        let ball = |(lo, hi): (Rational, Rational)| {
            Ball::from_rational(&lo, BITS).union(&Ball::from_rational(&hi, BITS), BITS)
        };
        places.extend(refined.map(ball));
    }
    let factor = Ball::from_rational(&-(Rational::one() + rho), BITS);
    let worst = |s: &Ball| {
        let bias = factor.mul(&value(&b, s), BITS).div(&value(&c, s), BITS)?;
        let sum = bias.add(&Ball::one().div(&bias, BITS)?, BITS);
        Some(sum.scale2(-1).sub(&Ball::one(), BITS))
    };
    places.iter().map(worst).collect::<Option<Vec<_>>>()?.into_iter().max_by_key(Ball::lower)
}
