//! The smallest friction that masks a resonance of one oscillator.
//!
//! With c the factor of the velocity over one tick, det Q = c^N for N = T/tick, and Tr Q is a polynomial in c of degree N.
//! Where the frictionless period grows, one of f± = 1 + c^N ∓ Tr Q(c) is negative at c = 1; ρ(Q) ≥ 1 until its first zero c*
//! on the way down, and there the other one is 2 (1 + c^N) > 0, so just below c* both are positive and ρ(Q) < 1 (Jury). No zero
//! lies where all Bernstein coefficients over an interval have one sign; one alone where they change it once. The
//! coefficients are balls, so c* and γ* = −ln c*/tick are enclosed.

use super::scalar::precisions;
use crate::error::{Error, Result};
use crate::number::{Ball, Real, Sign};
use crate::schedule::{KickDrift, Kicks};
use crate::system::ManyClocks;

/// The friction that masks a resonance.
#[derive(Clone, Debug)]
pub struct Masking {
    /// γ* h_1: at every smaller rate ρ(Q) ≥ 1, and just above it ρ(Q) < 1.
    pub rate: Ball,
    /// Whether ρ(Q) < 1 is proven for all larger rates, too.
    pub stays: bool,
}

/// The highest degree in c: the work grows with its square.
const HIGHEST: u64 = 4096;

/// Halvings of \[0, 1\] before more bits are tried.
const DEEPEST: u32 = 60;

/// The smallest friction that masks the growth of K clocks on one oscillator; `None` where |Tr Q| ≤ 2 without friction, so
/// that nothing grows exponentially.
///
/// # Errors
/// A budget error where the period is longer than 4096 ticks, or where balls cannot decide.
pub fn masking<S: Real>(clocks: &ManyClocks<S>) -> Result<Option<Masking>> {
    let degree = clocks.schedule().period();
    if degree > HIGHEST {
        let work = format!("the masking friction of a period of {degree} ticks");
        return Err(Error::budget(work, degree).or("choose steps with a simpler ratio"));
    }
    // A tenth of a second where bits are few, some seconds where they are many.
    for bits in precisions(degree.saturating_mul(degree) / 4) {
        let trace = trace(clocks, bits);
        let side = match sides(&trace, bits) {
            [Some(Sign::Negative), _] => 1,
            [_, Some(Sign::Negative)] => -1,
            [Some(_), Some(_)] => return Ok(None),
            _ => continue,
        };
        let f = polynomial(&trace, side, bits);
        let Some(near) = bracket(&f, bits) else { continue };
        let own = Bernstein::of(f, bits);
        // Most often the zero that values find is the last one: one change of signs behind it.
        let changes = own.clone().split(&near.0)[1].changes();
        let last = match changes {
            None => continue,
            Some(1) if near.0.sign() == Some(Sign::Positive) => Some(near),
            Some(_) => own.clone().last_zero(),
        };
        let Some((lo, hi)) = last else { continue };
        let tick = Ball::from_rational(clocks.schedule().tick(), bits);
        let rate = |c: &Ball| c.ln(bits).and_then(|ln| ln.neg().div(&tick, bits));
        let (Some(slow), Some(fast)) = (rate(&hi), rate(&lo)) else { continue };
        let other = Bernstein::of(polynomial(&trace, -side, bits), bits);
        let stays = [own, other].into_iter().all(|f| {
            let [below, _] = f.split(&lo);
            below.proves_positive()
        });
        return Ok(Some(Masking { rate: slow.union(&fast, bits), stays }));
    }
    Err(Error::budget("a resonance this weak", HIGHEST).or("choose steps nearer to its middle"))
}

/// The signs of 2 ∓ Tr Q at c = 1.
fn sides(trace: &[Ball], bits: u32) -> [Option<Sign>; 2] {
    let whole = trace.iter().fold(Ball::zero(), |sum, x| sum.add(x, bits));
    let two = Ball::from_integer(&2.into());
    [two.sub(&whole, bits).sign(), two.add(&whole, bits).sign()]
}

/// 1 + c^N ∓ Tr Q, lowest coefficient first.
fn polynomial(trace: &[Ball], side: i8, bits: u32) -> Vec<Ball> {
    let mut f: Vec<Ball> = trace.iter().map(|x| if side > 0 { x.neg() } else { x.clone() }).collect();
    for end in [0, trace.len() - 1] {
        f[end] = f[end].add(&Ball::one(), bits);
    }
    f
}

/// Two places next to each other between which a polynomial that is negative at 1 changes its sign, the nearest to 1 of those that places
/// 1 − 2^-k see: it is positive at the first. \[0, 1\] where none is; `None` where the balls cannot decide.
fn bracket(f: &[Ball], bits: u32) -> Option<(Ball, Ball)> {
    let sign = |c: &Ball| f.iter().rev().fold(Ball::zero(), |sum, a| sum.mul(c, bits).add(a, bits)).sign();
    let (mut lo, mut hi) = (Ball::zero(), Ball::one());
    for k in (1..=i64::from(DEEPEST)).rev() {
        let place = Ball::one().sub(&Ball::one().scale2(-k), bits);
        if sign(&place)? == Sign::Positive {
            lo = place;
            break;
        }
        hi = place;
    }
    if lo.sign() == Some(Sign::Zero) {
        return Some((lo, Ball::one()));
    }
    for _ in 0..DEEPEST - 4 {
        let middle = lo.add(&hi, bits).scale2(-1);
        if sign(&middle)? == Sign::Positive { lo = middle } else { hi = middle }
    }
    Some((lo, hi))
}

/// The coefficients of Tr Q in c.
fn trace<S: Real>(clocks: &ManyClocks<S>, bits: u32) -> Vec<Ball> {
    let kicks = Kicks::of_clocks(clocks.strengths().iter().map(|k| k.enclosure(bits)), |k| [k.clone(), k]);
    let tick = Ball::from_rational(clocks.schedule().tick(), bits);
    let unit = |n: u8| if n == 1 { vec![Ball::one()] } else { Vec::new() };
    let mut orbit = Polynomials { x: [1, 0].map(unit), v: [0, 1].map(unit), tick, bits };
    kicks.lead(clocks.schedule().staggered_period(), &mut orbit);
    let [mut trace, _] = orbit.x;
    add(&mut trace, &orbit.v[1], None, bits);
    trace
}

/// The rows of the propagator as polynomials in c, lowest coefficient first.
struct Polynomials {
    x: [Vec<Ball>; 2],
    v: [Vec<Ball>; 2],
    tick: Ball,
    bits: u32,
}

/// sum += factor f, or f itself.
fn add(sum: &mut Vec<Ball>, f: &[Ball], factor: Option<&Ball>, bits: u32) {
    sum.resize(sum.len().max(f.len()), Ball::zero());
    for (own, x) in sum.iter_mut().zip(f) {
        *own = match factor {
            Some(factor) => own.add(&factor.mul(x, bits), bits),
            None => own.add(x, bits),
        };
    }
}

impl KickDrift<Ball> for Polynomials {
    fn drift(&mut self, ticks: u64) {
        let half = self.tick.mul(&Ball::from_integer(&ticks.into()), self.bits).scale2(-1);
        for (x, v) in self.x.iter_mut().zip(&mut self.v) {
            add(x, v, Some(&half), self.bits);
            v.splice(0..0, std::iter::repeat_n(Ball::zero(), ticks as usize));
            add(x, v, Some(&half), self.bits);
        }
    }

    fn kick(&mut self, strength: &Ball) {
        let minus = strength.neg();
        self.x.iter().zip(&mut self.v).for_each(|(x, v)| add(v, x, Some(&minus), self.bits));
    }
}

/// A polynomial over an interval \[lo, hi\] by its Bernstein coefficients, f(lo) first.
#[derive(Clone)]
struct Bernstein {
    coefficients: Vec<Ball>,
    lo: Ball,
    hi: Ball,
    bits: u32,
}

impl Bernstein {
    /// Over \[0, 1\].
    fn of(mut f: Vec<Ball>, bits: u32) -> Self {
        let n = f.len() - 1;
        // Σ_i C(j, i)/C(n, i) a_i: with a_i/C(n, i), n additions each.
        let mut choose = num_bigint::BigInt::from(1);
        for (i, a) in f.iter_mut().enumerate() {
            *a = a.div(&Ball::from_integer(&choose), bits).expect("a binomial coefficient");
            choose = choose * (n - i) / (i + 1);
        }
        for first in 0..n {
            for j in (first + 1..=n).rev() {
                f[j] = f[j].add(&f[j - 1], bits);
            }
        }
        Bernstein { coefficients: f, lo: Ball::zero(), hi: Ball::one(), bits }
    }

    /// Below and above the place lo + t (hi − lo), by de Casteljau's scheme.
    fn split(self, t: &Ball) -> [Self; 2] {
        let Bernstein { coefficients: mut f, lo, hi, bits } = self;
        let place = lo.add(&hi.sub(&lo, bits).mul(t, bits), bits);
        // A mean of two is as uncertain as both, their difference is more so.
        let (rest, mut lower) = (Ball::one().sub(t, bits), Vec::new());
        for last in (0..f.len()).rev() {
            lower.push(f[0].clone());
            for j in 0..last {
                f[j] = rest.mul(&f[j], bits).add(&t.mul(&f[j + 1], bits), bits);
            }
        }
        [
            Bernstein { coefficients: lower, lo, hi: place.clone(), bits },
            Bernstein { coefficients: f, lo: place, hi, bits },
        ]
    }

    fn halves(self) -> [Self; 2] {
        self.split(&Ball::one().scale2(-1))
    }

    /// Sign changes of the coefficients; `None` where a sign is not decided.
    fn changes(&self) -> Option<usize> {
        let signs = self.coefficients.iter().map(Ball::sign).collect::<Option<Vec<_>>>()?;
        let signs: Vec<_> = signs.into_iter().filter(|&sign| sign != Sign::Zero).collect();
        Some(signs.windows(2).filter(|pair| pair[0] != pair[1]).count())
    }

    /// An interval with the largest zero below 1 of a polynomial that is negative at 1, positive at its lower end; `None`
    /// where the balls cannot decide.
    fn last_zero(self) -> Option<(Ball, Ball)> {
        let mut open = vec![(self, 0)];
        while let Some((own, depth)) = open.pop() {
            let first = own.coefficients[0].sign();
            match own.changes() {
                Some(0) => continue,
                Some(1) if depth >= DEEPEST - 4 && first == Some(Sign::Positive) => {
                    return Some((own.lo, own.hi));
                }
                _ if depth == DEEPEST => return None,
                _ => {}
            }
            let [lower, upper] = own.halves();
            open.extend([(lower, depth + 1), (upper, depth + 1)]);
        }
        None
    }

    /// Whether it is proven to have no zero inside and no negative value.
    fn proves_positive(self) -> bool {
        let mut open = vec![(self, 0)];
        while let Some((own, depth)) = open.pop() {
            if own.coefficients.iter().all(|x| matches!(x.sign(), Some(Sign::Zero | Sign::Positive))) {
                continue;
            }
            if depth == DEEPEST {
                return false;
            }
            let [lower, upper] = own.halves();
            open.extend([(upper, depth + 1), (lower, depth + 1)]);
        }
        true
    }
}
