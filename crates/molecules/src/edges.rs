//! The unstable intervals of an outer step on any number of clocks, at fixed ratios.
//!
//! Let all steps be t times those of the scheme. Over half a period the four solutions that begin even or odd
//! and end at rest or at 0 belong to four strings of point masses (Krein), whose eigenvalues in t² are the
//! edges. By the negative pivots of the action, that is by the sign changes of two orbits, balls count the
//! eigenvalues below t² for sure:
//!
//! ```text
//!     A: even, x(T/2) = 0     changes of the even orbit          B: odd, x(T/2) = 0     changes of the odd orbit
//!     C: even, v(T/2) = 0     the same, and 1 where v x < 0      D: odd, v(T/2) = 0     the same, and 1 where v x < 0
//! ```
//!
//! (of C without the eigenvalue 0). Counts only grow with t. Interval m = 2 k − 1 lies between the k-th edges
//! of A and D, interval 2 k between those of B and C, so bisection finds every one, and none is missed.
//! Source: Gantmacher, Krein; docs/theory/tongues.md.

use num_traits::Zero;

use super::interval::{Unstable, Worst};
use super::levels::Levels;
use clocks::schedule::{KickDrift, Kicks, Schedule};
use number::rational::enclose_f64;
use number::{Ball, Rational, Real, Sign, bisected, from_f64_exact, to_f64};

const BITS: u32 = 192;

/// Growth is looked for at so many places of an interval, but one, and then between the two beside the best.
const PLACES: u32 = 24;

/// One mass on its clocks, all steps to be scaled.
pub struct Edges<'a> {
    levels: &'a Levels<'a>,
    schedule: Schedule,
    strengths: Vec<Ball>,
}

/// Half a period at one scale.
struct Half {
    /// (x, v) of the even and of the odd orbit at T/2.
    ends: [[Ball; 2]; 2],
    /// Eigenvalues below: of A, B, C, D.
    counts: [u64; 4],
}

impl<'a> Edges<'a> {
    /// `None` where the clocks meet too late to be followed.
    pub fn new(levels: &'a Levels<'a>) -> Option<Edges<'a>> {
        let steps = levels.scheme.steps();
        let schedule = Schedule::new(steps, &vec![Rational::zero(); steps.len()]).ok()?;
        let strength = |(step, stiffness): (&Rational, &number::Laurent)| {
            Ball::from_rational(step, BITS).mul(&stiffness.enclosure(BITS), BITS)
        };
        let strengths = steps.iter().zip(&levels.stiffness).map(strength).collect();
        Some(Edges { levels, schedule, strengths })
    }

    /// `None` where balls cannot decide a sign.
    fn half(&self, t: f64) -> Option<Half> {
        let square = Ball::from_rational(&from_f64_exact(t)?, BITS).square(BITS);
        let kicks = Kicks::of_clocks(self.strengths.iter().map(|k| k.mul(&square, BITS)), |k| {
            [k.clone(), k.scale2(-1)]
        });
        let (zero, one) = (Ball::zero(), Ball::one());
        let mut orbit = Counting {
            states: [[one.clone(), zero.clone()], [zero, one]],
            tick: Ball::from_rational(self.schedule.tick(), BITS),
            last: [Some(Sign::Positive); 2],
            changes: [0; 2],
        };
        kicks.lead(self.schedule.half_period(), &mut orbit);
        let [even, odd] = orbit.changes;
        orbit.last.iter().all(Option::is_some).then_some(())?;
        let turned = |[x, v]: &[Ball; 2]| Some(u64::from(x.sign()? * v.sign()? == Sign::Negative));
        let free = [turned(&orbit.states[0])?, turned(&orbit.states[1])?];
        Some(Half {
            counts: [even, odd, (even + free[0]).saturating_sub(1), odd + free[1]],
            ends: orbit.states,
        })
    }

    /// Neighbouring scales between which the k-th edge of a problem lies, or as close as balls can decide;
    /// `None` above `most`.
    fn edge(&self, problem: usize, k: u64, most: f64) -> Option<(f64, f64)> {
        let below = |t: f64| self.half(t).map(|half| half.counts[problem] < k);
        let (lo, hi) = (most * 1e-6, most);
        if below(lo) != Some(true) || below(hi) != Some(false) {
            return None;
        }
        Some(bisected((lo, hi), 0.0, below))
    }

    /// Interval m, as outer steps; `None` where it is closed or thinner than doubles, or ends above `most`
    /// times the scheme.
    fn get(&self, m: u64, most: f64) -> Option<Unstable> {
        let (problems, k) = if m % 2 == 1 { ([0, 3], m.div_ceil(2)) } else { ([1, 2], m / 2) };
        let [a, b] = problems.map(|problem| self.edge(problem, k, most));
        let (lower, upper) = if a?.0 <= b?.0 { (a?, b?) } else { (b?, a?) };
        if lower.1 >= upper.0 {
            return None;
        }
        let ends = |(lo, hi): (f64, f64)| {
            let of = |t: f64| enclose_f64(&(from_f64_exact(t).expect("finite") * self.levels.scheme.outer()));
            (of(lo).0, of(hi).1)
        };
        Some(Unstable {
            label: m,
            lower: ends(lower),
            upper: Some(ends(upper)),
            worst: self.worst(lower.1, upper.0),
        })
    }

    /// All that begin below `reach` times the scheme, by their label: at most `count` of them.
    pub fn all(&self, reach: f64, count: usize) -> Vec<Unstable> {
        // A step beyond the reach that is given: no edge hides between.
        let Some((most, half)) = (0..60).find_map(|k| {
            let most = 2.0 * reach * (1.0 + 1e-3 * f64::from(k));
            self.half(most).map(|half| (most, half))
        }) else {
            return Vec::new();
        };
        let [a, b, c, d] = half.counts;
        let last = (2 * a.min(d)).saturating_sub(1).max(2 * b.min(c));
        let outer = to_f64(self.levels.scheme.outer());
        let found = (1..=last)
            .filter_map(|m| self.get(m, most))
            .take_while(|unstable| unstable.lower.0 <= reach * outer);
        found.take(count).collect()
    }

    /// ln |λ| per fs at a scale, rounded.
    fn rate(&self, t: f64) -> f64 {
        let Some(Half { ends: [[a, c], [b, d]], .. }) = self.half(t) else { return 0.0 };
        let excess = b.mul(&c, BITS).mid_f64().max(-a.mul(&d, BITS).mid_f64()).max(0.0);
        let period = to_f64(self.schedule.tick()) * self.schedule.period() as f64 * t;
        2.0 * excess.sqrt().asinh() / period
    }

    fn worst(&self, lo: f64, hi: f64) -> Option<Worst> {
        let at = |k: f64| lo + (hi - lo) * k / f64::from(PLACES);
        let rates = (1..PLACES).map(|k| (f64::from(k), self.rate(at(f64::from(k)))));
        let (best, _) = rates.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (mut lo, mut hi) = (at(best - 1.0), at(best + 1.0));
        for _ in 0..30 {
            let [a, b] = [(2.0 * lo + hi) / 3.0, (lo + 2.0 * hi) / 3.0];
            if self.rate(a) < self.rate(b) { lo = a } else { hi = b }
        }
        let t = (lo + hi) / 2.0;
        let rate = self.rate(t);
        let time = std::f64::consts::LN_10 / rate;
        (rate > 0.0).then(|| Worst { rate, steps: time / (t * to_f64(self.levels.scheme.outer())), time })
    }
}

/// The even and the odd orbit with the changes of sign of their positions.
struct Counting {
    states: [[Ball; 2]; 2],
    tick: Ball,
    /// `None` once a sign could not be decided.
    last: [Option<Sign>; 2],
    changes: [u64; 2],
}

impl KickDrift<Ball> for Counting {
    fn drift(&mut self, ticks: u64) {
        let time = self.tick.mul(&Ball::from_integer(&ticks.into()), BITS);
        for (n, [x, v]) in self.states.iter_mut().enumerate() {
            *x = x.add(&v.mul(&time, BITS), BITS);
            let sign = x.sign().filter(|&sign| sign != Sign::Zero);
            self.changes[n] += u64::from(sign.is_some() && self.last[n].is_some() && sign != self.last[n]);
            self.last[n] = self.last[n].and(sign);
        }
    }

    fn kick(&mut self, strength: &Ball) {
        for [x, v] in &mut self.states {
            *v = v.sub(&strength.mul(x, BITS), BITS);
        }
    }
}
