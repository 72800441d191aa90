//! Exact signs: of the half period at rational s, and of the trace over the full period.

use num_traits::One;

use super::context::{Checked, Fault, holds};
use clocks::propagator::TwoClocks;
use clocks::propagator::methods::avi;
use clocks::schedule::Schedule;
use clocks::tongue::Entry;
use clocks::verdict::{
    Decidable, Decision, HalfSigns, Kind, Limits, Tier, Verdict, decide_from, exact_trace,
};
use number::{Ball, Error, ExactSign, Laurent, Ratio, Rational, Real, Result, Sign, rational};

/// p/q, in lowest terms as it has to be written.
pub fn lowest(p: u64, q: u64) -> Checked<Ratio> {
    let ratio = Ratio::new(p, q).ok().filter(|ratio| ratio.terms() == (p, q));
    ratio.ok_or_else(|| Fault::Wrong(format!("{p}/{q} is no ratio in lowest terms")))
}

/// p/q, and that exact signs of it are within the limits.
pub fn check_ratio(p: u64, q: u64, limits: &Limits) -> Checked<Ratio> {
    let ratio = lowest(p, q)?;
    Schedule::two_clocks(ratio)?;
    let kicks = ratio.kicks();
    let cost = kicks.saturating_mul(kicks) / 100;
    if kicks <= limits.kicks && cost <= limits.kicks {
        return Ok(ratio);
    }
    let work = format!("exact signs at {ratio} cost as much as {cost} kicks");
    Err(Fault::Error(Error::budget(work, cost)))
}

/// The signs of A, B, C, D at s.
pub fn signs(ratio: Ratio, rho: &Rational, s: &Rational) -> HalfSigns {
    Decidable::half_signs(&TwoClocks::with_rho(ratio, s.clone(), rho.clone()))
}

/// The zero of an entry between two rationals.
#[derive(Clone, Debug)]
pub struct ZeroOf<'a> {
    pub ratio: Ratio,
    pub rho: &'a Rational,
    pub entry: Entry,
    pub lo: Rational,
    pub hi: Rational,
    below: Sign,
}

impl<'a> ZeroOf<'a> {
    /// That the entry changes its sign between lo and hi, or vanishes at one of them.
    pub fn new(
        (ratio, rho): (Ratio, &'a Rational),
        entry: Entry,
        (lo, hi): (Rational, Rational),
        name: &str,
    ) -> Checked<Self> {
        let at = |s: &Rational| signs(ratio, rho, s).all()[entry as usize];
        let (below, above) = (at(&lo), at(&hi));
        holds(below * above != Sign::Positive, || {
            format!("{name}: {} does not vanish between {lo} and {hi}", entry.name())
        })?;
        Ok(ZeroOf { ratio, rho, entry, lo, hi, below })
    }

    /// The clocks at s.
    pub fn clocks(&self, s: Rational) -> TwoClocks<Rational> {
        TwoClocks::with_rho(self.ratio, s, self.rho.clone())
    }

    /// Whether the entry vanishes exactly at s.
    pub fn vanishes(&self, s: &Rational) -> bool {
        signs(self.ratio, self.rho, s).all()[self.entry as usize] == Sign::Zero
    }

    /// Halves the interval; an end that is the zero stays.
    pub fn halve(&mut self) {
        if self.lo == self.hi {
            return;
        }
        let middle = (&self.lo + &self.hi) / Rational::from_integer(2.into());
        let sign = signs(self.ratio, self.rho, &middle).all()[self.entry as usize];
        match (self.below, sign) {
            (Sign::Zero, _) => self.hi = self.lo.clone(),
            (_, Sign::Zero) => (self.lo, self.hi) = (middle.clone(), middle),
            (below, sign) if below == sign => self.lo = middle,
            _ => self.hi = middle,
        }
    }
}

/// Halvings before two zeros are taken for one: more than any tongue of a table needs (2^-4000 of its s).
const PATIENCE: u32 = 4000;

/// Halves both until one lies below the other: which is below, if they part.
pub fn part(a: &mut ZeroOf, b: &mut ZeroOf) -> Option<std::cmp::Ordering> {
    for _ in 0..PATIENCE {
        if a.hi < b.lo {
            return Some(std::cmp::Ordering::Less);
        }
        if b.hi < a.lo {
            return Some(std::cmp::Ordering::Greater);
        }
        if a.lo == a.hi && b.lo == b.hi {
            return None;
        }
        a.halve();
        b.halve();
    }
    None
}

/// Verdict and trace by the full period, kick by kick, in exact arithmetic.
pub struct FullPeriod<S> {
    pub verdict: Verdict,
    pub trace: S,
}

/// The staggered form over the whole period: it shares neither the half period nor its signs.
pub fn full_period<S: ExactSign>(clocks: &TwoClocks<S>) -> FullPeriod<S> {
    let q = avi::staggered(clocks);
    let mut trace = q[(0, 0)].clone();
    trace += q[(1, 1)].clone();
    let beyond = |n: i64| {
        let mut difference = trace.clone();
        difference -= S::from_rational(&Rational::from_integer(n.into()));
        difference.sign()
    };
    let plain = q[(0, 1)].sign() == Sign::Zero && q[(1, 0)].sign() == Sign::Zero;
    let edge = if plain { Kind::Coexistence } else { Kind::Parabolic };
    let (kind, side) = match (beyond(2), beyond(-2)) {
        (Sign::Positive, _) => (Kind::Hyperbolic, 1),
        (_, Sign::Negative) => (Kind::Hyperbolic, -1),
        (Sign::Zero, _) => (edge, 1),
        (_, Sign::Zero) => (edge, -1),
        _ => (Kind::Elliptic, 0),
    };
    let verdict = Verdict::ALL.into_iter().find(|verdict| (verdict.kind(), verdict.side()) == (kind, side));
    FullPeriod { verdict: verdict.expect("one of seven"), trace }
}

/// Kicks up to which the full period is composed exactly: numbers grow with every kick, over Q\[π\] much
/// faster.
pub fn affordable(clocks: &TwoClocks<Laurent>) -> bool {
    let kicks = clocks.p().saturating_add(clocks.q());
    kicks <= if clocks.as_rational().is_some() { 1000 } else { 60 }
}

/// ln μ of a trace beyond ±2: ln((|Tr| + √(Tr² − 4))/2).
pub fn ln_multiplier<S: Real>(trace: &S, bits: u32) -> Option<Ball> {
    let mut square = S::product(trace, trace);
    square -= S::from_rational(&Rational::from_integer(4.into()));
    let root = square.enclosure(bits).sqrt(bits)?;
    trace.enclosure(bits).abs().add(&root, bits).scale2(-1).ln(bits)
}

/// Whether two enclosures can be of one value.
pub fn meets(a: &Ball, b: &Ball) -> bool {
    a.compare(b).is_none_or(std::cmp::Ordering::is_eq)
}

/// Whether doubles can enclose the ball's value; an infinite end encloses all.
pub fn encloses((lo, hi): (f64, f64), ball: &Ball) -> bool {
    let (lo, hi) = (rational::from_f64_exact(lo), rational::from_f64_exact(hi));
    lo.is_none_or(|lo| lo <= ball.upper()) && hi.is_none_or(|hi| ball.lower() <= hi)
}

/// Two doubles exactly, as an interval.
pub fn between(lo: f64, hi: f64) -> Checked<(Rational, Rational)> {
    let ends = rational::from_f64_exact(lo).zip(rational::from_f64_exact(hi)).filter(|(lo, hi)| lo <= hi);
    ends.ok_or_else(|| Fault::Wrong(format!("{lo}..{hi} is no enclosure")))
}

/// The rational n/d.
pub fn fraction(n: u64, d: u64) -> Rational {
    Rational::new(n.into(), d.into())
}

/// 4 sin²(m π/(2 p)).
pub fn resonance(p: u64, m: u64, bits: u32) -> Ball {
    // By the double angle, 2 − 2 cos(m π/p).
    let angle = Ball::pi(bits + 32).mul(&Ball::from_rational(&fraction(m, p), bits + 32), bits + 32);
    let two = Ball::from_rational(&(Rational::one() + Rational::one()), bits);
    two.sub(&angle.cos(bits + 16).scale2(1), bits + 16)
}

/// ln μ of a rational pair, by the trace of the full period; `None` unless it grows exponentially.
pub fn ln_multiplier_at(clocks: &TwoClocks<Rational>, bits: u32) -> Option<Ball> {
    ln_multiplier(&exact_trace(clocks), bits)
}

/// The verdict without the tiers below `first`.
pub fn again(first: Tier, clocks: &TwoClocks<Laurent>, limits: &Limits) -> Result<Decision> {
    decide_from(first, clocks, limits).map(|answer| answer.decision())
}
