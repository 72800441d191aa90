//! The schedule: which clocks kick when, over the synchronization period or its first half.
//!
//! Times are whole numbers of *ticks*, the greatest common measure of all steps (and phases), so
//! coincidences are decided by integer equality. The kick pattern of clocks with phases 0 and 1/2
//! is a palindrome over the period (theorem `two_clocks_palindrome` in proofs/).
//!
//! ```
//! use kickdrift::schedule::{Schedule, Weight};
//! // h2/h1 = 3/2: one tick is h1/2 = h2/3, so the steps are 2 and 3 ticks and the period is 6.
//! let schedule = Schedule::two_clocks("3/2".parse().unwrap()).unwrap();
//! let events: Vec<_> = schedule.half_period().map(|e| (e.drift, e.kicks, e.weight)).collect();
//! // Both clocks at 0 (half a kick each), the first at 2, the second at T/2 = 3 (half a kick).
//! assert_eq!(events, [(0, 0b11, Weight::Half), (2, 0b01, Weight::Full), (1, 0b10, Weight::Half)]);
//! ```

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};

use crate::error::{Error, Result};
use crate::number::{Ratio, Rational};

/// As many clocks as the bit set of an [`Event`] holds.
const MAX_CLOCKS: usize = 64;

/// A clock in ticks: it strikes at `offset + n · step`, n = 0, 1, 2, ..., with `offset < step`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    step: u64,
    offset: u64,
}

/// How much of each kick an event carries: half of it where a half period begins or ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    Half,
    Full,
}

/// One kick time: drift `drift` ticks since the event before, then let the clocks in `kicks`
/// (bit i for clock i) kick. The last event may carry no kick and only bring the time to the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    pub drift: u64,
    pub kicks: u64,
    pub weight: Weight,
}

/// Clocks with commensurable steps, and their synchronization period.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    clocks: Vec<Clock>,
    /// T in ticks: the least common multiple of the steps, even.
    period: u64,
}

impl Schedule {
    /// The paper's pair, h2/h1 = p/q, phases 0: the steps are to each other as q to p
    /// and the period is T = q h2 = p h1. One tick is h1/q = h2/p, or half of it where p and q are both odd.
    ///
    /// # Errors
    /// Where the period reaches 2^63 ticks.
    pub fn two_clocks(ratio: Ratio) -> Result<Self> {
        let (p, q) = ratio.terms();
        Schedule::from_ticks(vec![Clock { step: q, offset: 0 }, Clock { step: p, offset: 0 }])
    }

    /// Clocks with the given steps (any common unit, all positive) and phases in [0, 1): clock i strikes
    /// at the times (n + phase_i) step_i.
    ///
    /// # Errors
    /// No clock or more than 64, a step that is not positive, a phase outside [0, 1), or a period of 2^63
    /// ticks and more.
    pub fn new(steps: &[Rational], phases: &[Rational]) -> Result<Self> {
        check(steps, phases)?;
        let offsets: Vec<Rational> = steps.iter().zip(phases).map(|(h, phase)| h * phase).collect();
        let tick = steps.iter().chain(&offsets).fold(Rational::zero(), |g, x| common_measure(&g, x));
        let ticks = |x: &Rational| (x / &tick).to_integer().to_u64().ok_or_else(too_long);
        let clock = |(h, o)| Ok(Clock { step: ticks(h)?, offset: ticks(o)? });
        Schedule::from_ticks(steps.iter().zip(&offsets).map(clock).collect::<Result<_>>()?)
    }

    /// The schedule of clocks given in ticks; the tick is halved where T would be odd, so that T/2 is whole.
    fn from_ticks(mut clocks: Vec<Clock>) -> Result<Self> {
        let lcm = |t: u64, clock: &Clock| (t / t.gcd(&clock.step)).checked_mul(clock.step);
        let mut period = clocks.iter().try_fold(1, lcm).filter(|&t| t < 1 << 62).ok_or_else(too_long)?;
        if period % 2 == 1 {
            period *= 2;
            clocks.iter_mut().for_each(|c| *c = Clock { step: 2 * c.step, offset: 2 * c.offset });
        }
        Ok(Schedule { clocks, period })
    }

    /// T in ticks, an even number.
    pub fn period(&self) -> u64 {
        self.period
    }

    /// The clocks in ticks.
    pub fn clocks(&self) -> &[Clock] {
        &self.clocks
    }

    /// The sum of all clocks' strikes in one period: the number of kick times, coincidences counted apart.
    pub fn strikes(&self) -> u64 {
        self.clocks.iter().map(|clock| self.period / clock.step).fold(0, u64::saturating_add)
    }

    /// Whether kicks(T − t) = kicks(t): each phase is 0 or 1/2 (theorem `many_clocks_palindrome` in proofs/).
    pub fn is_palindrome(&self) -> bool {
        self.clocks.iter().all(|clock| clock.offset == 0 || 2 * clock.offset == clock.step)
    }

    /// One period of the staggered form: whole kicks at t = 0, none at T.
    pub fn staggered_period(&self) -> Events<'_> {
        Events::new(&self.clocks, self.period, Ends::Staggered)
    }

    /// One period of the time-symmetric form: half of each kick at t = 0 and at T.
    pub fn symmetric_period(&self) -> Events<'_> {
        Events::new(&self.clocks, self.period, Ends::Halved)
    }

    /// The first half of the time-symmetric period: half of each kick at t = 0 and at T/2.
    /// It determines the whole only where [`Schedule::is_palindrome`] holds.
    pub fn half_period(&self) -> Events<'_> {
        Events::new(&self.clocks, self.period / 2, Ends::Halved)
    }
}

impl Clock {
    /// The step in ticks.
    pub fn step(&self) -> u64 {
        self.step
    }
}

/// What happens to the kicks at the two ends of the span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ends {
    /// Whole at the beginning, left to the next period at the end.
    Staggered,
    /// Halved at both ends.
    Halved,
}

/// Iterator over the [`Event`]s of a span that begins at t = 0.
#[derive(Clone, Debug)]
pub struct Events<'a> {
    clocks: &'a [Clock],
    /// Each clock's next strike.
    strikes: Vec<u64>,
    now: u64,
    end: u64,
    ends: Ends,
    done: bool,
}

impl<'a> Events<'a> {
    fn new(clocks: &'a [Clock], end: u64, ends: Ends) -> Self {
        let strikes = clocks.iter().map(|clock| clock.offset).collect();
        Events { clocks, strikes, now: 0, end, ends, done: false }
    }

    /// The clocks that strike at `time`, each sent on to its next strike.
    fn strike(&mut self, time: u64) -> u64 {
        let mut kicks = 0;
        for (i, (clock, next)) in self.clocks.iter().zip(&mut self.strikes).enumerate() {
            if *next == time {
                *next += clock.step;
                kicks |= 1 << i;
            }
        }
        kicks
    }
}

impl Iterator for Events<'_> {
    type Item = Event;

    fn next(&mut self) -> Option<Event> {
        if self.done {
            return None;
        }
        let strike = self.strikes.iter().copied().min().unwrap_or(self.end);
        let time = strike.min(self.end);
        let at_end = time == self.end;
        self.done = at_end;
        let kicks = if at_end && self.ends == Ends::Staggered { 0 } else { self.strike(time) };
        let halved = self.ends == Ends::Halved && (time == 0 || at_end);
        let drift = time - self.now;
        self.now = time;
        Some(Event { drift, kicks, weight: if halved { Weight::Half } else { Weight::Full } })
    }
}

fn too_long() -> Error {
    Error::too_much("the synchronization period exceeds 2^62 ticks", "choose steps with a simpler ratio")
}

/// The largest g ≥ 0 of which both a and b are integer multiples: gcd of rationals.
fn common_measure(a: &Rational, b: &Rational) -> Rational {
    let numer: BigInt = (a.numer() * b.denom()).gcd(&(b.numer() * a.denom()));
    Rational::new(numer, a.denom() * b.denom())
}

fn check(steps: &[Rational], phases: &[Rational]) -> Result<()> {
    if steps.is_empty() || steps.len() > MAX_CLOCKS || steps.len() != phases.len() {
        return Err(Error::input("steps", steps.len(), "give 1 to 64 steps and as many phases"));
    }
    if let Some(step) = steps.iter().find(|step| !step.is_positive()) {
        return Err(Error::input("step", step, "a step must be positive"));
    }
    if let Some(phase) = phases.iter().find(|phase| phase.is_negative() || **phase >= Rational::one()) {
        return Err(Error::input("phase", phase, "a phase lies in [0, 1)"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn r(n: i64, d: i64) -> Rational {
        Rational::new(n.into(), d.into())
    }

    /// The kick times of a span as (time, kicks, weight), events without kicks left out.
    fn kicks(events: Events) -> Vec<(u64, u64, Weight)> {
        let timed = events.scan(0, |now, e| {
            *now += e.drift;
            Some((*now, e.kicks, e.weight))
        });
        timed.filter(|&(_, kicks, _)| kicks != 0).collect()
    }

    #[test]
    fn one_period_holds_p_fast_and_q_slow_kicks_at_p_plus_q_minus_1_times() {
        for (p, q) in [(1, 1), (2, 1), (1, 3), (7, 5), (12, 35), (3499, 631)] {
            let schedule = Schedule::two_clocks(Ratio::new(p, q).unwrap()).unwrap();
            let times = kicks(schedule.staggered_period());
            assert_eq!(times.len() as u64, p + q - 1);
            assert_eq!(times.iter().filter(|t| t.1 & 1 != 0).count() as u64, p);
            assert_eq!(times.iter().filter(|t| t.1 & 2 != 0).count() as u64, q);
            assert_eq!(schedule.strikes(), p + q);
        }
    }

    #[test]
    fn phases_0_and_one_half_make_palindromes_and_others_do_not() {
        let mirrored = |schedule: &Schedule| {
            let times = kicks(schedule.symmetric_period());
            let back = times.iter().rev().map(|&(t, k, w)| (schedule.period() - t, k, w)).collect::<Vec<_>>();
            times == back
        };
        for (steps, phases) in [
            ([r(1, 1), r(7, 3)], [r(0, 1), r(0, 1)]),
            ([r(1, 1), r(7, 3)], [r(0, 1), r(1, 2)]),
            ([r(2, 5), r(6, 1)], [r(1, 2), r(1, 2)]),
            ([r(2, 5), r(6, 1)], [r(1, 3), r(1, 2)]),
            ([r(1, 1), r(1, 1)], [r(0, 1), r(1, 4)]),
        ] {
            let schedule = Schedule::new(&steps, &phases).unwrap();
            assert_eq!(mirrored(&schedule), schedule.is_palindrome(), "{steps:?} {phases:?}");
        }
    }

    #[test]
    fn a_kick_stands_at_half_time_iff_p_or_q_is_even() {
        for (p, q) in [(3, 2), (2, 3), (5, 3), (1, 1), (4, 1)] {
            let schedule = Schedule::two_clocks(Ratio::new(p, q).unwrap()).unwrap();
            let last = schedule.half_period().last().unwrap();
            assert_eq!(last.kicks != 0, p % 2 == 0 || q % 2 == 0, "{p}/{q}");
        }
    }

    #[test]
    fn bad_clocks_are_refused() {
        assert!(Schedule::new(&[], &[]).is_err());
        assert!(Schedule::new(&[r(0, 1)], &[r(0, 1)]).is_err());
        assert!(Schedule::new(&[r(1, 1)], &[r(1, 1)]).is_err());
        assert!(Schedule::two_clocks(Ratio::new((1 << 40) + 1, 1 << 40).unwrap()).is_err());
    }
}
