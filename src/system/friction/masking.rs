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
    for bits in precisions(degree.saturating_mul(degree)) {
        let trace = trace(clocks, bits);
        let side = match sides(&trace, bits) {
            [Some(Sign::Negative), _] => 1,
            [_, Some(Sign::Negative)] => -1,
            [Some(_), Some(_)] => return Ok(None),
            _ => continue,
        };
        let own = Bernstein::of(&trace, side, bits);
        let Some((lo, hi)) = own.last_zero() else { continue };
        let tick = Ball::from_rational(clocks.schedule().tick(), bits);
        let rate = |c: &Ball| c.ln(bits).and_then(|ln| ln.neg().div(&tick, bits));
        let (Some(slow), Some(fast)) = (rate(&hi), rate(&lo)) else { continue };
        let below = |side| Bernstein::of(&trace, side, bits).proves_positive_up_to(&lo);
        return Ok(Some(Masking { rate: slow.union(&fast, bits), stays: below(1) && below(-1) }));
    }
    Err(Error::budget("a resonance this weak", HIGHEST).or("choose steps nearer to its middle"))
}

/// The signs of 2 ∓ Tr Q at c = 1.
fn sides(trace: &[Ball], bits: u32) -> [Option<Sign>; 2] {
    let whole = trace.iter().fold(Ball::zero(), |sum, x| sum.add(x, bits));
    let two = Ball::from_integer(&2.into());
    [two.sub(&whole, bits).sign(), two.add(&whole, bits).sign()]
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
struct Bernstein {
    coefficients: Vec<Ball>,
    lo: Ball,
    hi: Ball,
    bits: u32,
}

impl Bernstein {
    /// 1 + c^N ∓ Tr over \[0, 1\].
    fn of(trace: &[Ball], side: i8, bits: u32) -> Self {
        let n = trace.len() - 1;
        let mut f: Vec<Ball> = trace.iter().map(|x| if side > 0 { x.neg() } else { x.clone() }).collect();
        f[0] = f[0].add(&Ball::one(), bits);
        f[n] = f[n].add(&Ball::one(), bits);
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

    /// The lower and the upper half, by de Casteljau's scheme.
    fn halves(mut self) -> [Self; 2] {
        let bits = self.bits;
        let middle = self.lo.add(&self.hi, bits).scale2(-1);
        let (mut f, mut lower) = (self.coefficients, Vec::new());
        for last in (0..f.len()).rev() {
            lower.push(f[0].clone());
            for j in 0..last {
                f[j] = f[j].add(&f[j + 1], bits).scale2(-1);
            }
        }
        let hi = std::mem::replace(&mut self.hi, middle.clone());
        [
            Bernstein { coefficients: lower, lo: self.lo, hi: middle.clone(), bits },
            Bernstein { coefficients: f, lo: middle, hi, bits },
        ]
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

    /// Whether it is proven positive on (0, c\].
    fn proves_positive_up_to(self, c: &Ball) -> bool {
        let mut open = vec![(self, 0)];
        while let Some((own, depth)) = open.pop() {
            let is_beyond = own.lo.compare(c).is_some_and(std::cmp::Ordering::is_ge);
            if is_beyond
                || own.coefficients.iter().all(|x| matches!(x.sign(), Some(Sign::Zero | Sign::Positive)))
            {
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
