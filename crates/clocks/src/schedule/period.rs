//! The schedule of an integrator: the events of a period and of its first half.

use super::clocks::{Clock, Clocks};
use super::events::{Ends, Events};
use number::{Error, Ratio, Rational, Result};

/// As many clocks as the bit set of an [`Event`](super::Event) holds.
const MAX_CLOCKS: usize = 64;

/// The [`Clocks`] of an integrator, 64 at most, whose kicks come as [`Event`](super::Event)s.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule(Clocks);

impl Schedule {
    /// The paper's pair, h2/h1 = p/q, phases 0: the steps are to each other as q to p
    /// and the period is T = q h2 = p h1. One tick is h1/q = h2/p, or half of it where p and q are both odd;
    /// the unit of time is h1.
    ///
    /// # Errors
    /// Where the period reaches 2^62 ticks.
    pub fn two_clocks(ratio: Ratio) -> Result<Self> {
        let (p, q) = ratio.terms();
        let clocks = vec![Clock::new(q, 0), Clock::new(p, 0)];
        Clocks::from_ticks(clocks, Rational::new_raw(1.into(), q.into())).map(Schedule)
    }

    /// [`Clocks::new`] for 64 clocks at most.
    ///
    /// # Errors
    /// As [`Clocks::new`], and more than 64 clocks.
    pub fn new(steps: &[Rational], phases: &[Rational]) -> Result<Self> {
        if steps.is_empty() || steps.len() > MAX_CLOCKS || steps.len() != phases.len() {
            return Err(Error::input("steps", steps.len(), "give 1 to 64 steps and as many phases"));
        }
        Clocks::new(steps, phases).map(Schedule)
    }

    /// T in ticks, an even number.
    pub fn period(&self) -> u64 {
        self.0.period()
    }

    /// The clocks in ticks.
    pub fn clocks(&self) -> &[Clock] {
        self.0.all()
    }

    /// The length of a tick, in the unit of the steps.
    pub fn tick(&self) -> &Rational {
        self.0.tick()
    }

    /// The sum of all clocks' strikes in one period: the number of kick times, coincidences counted apart.
    pub fn strikes(&self) -> u64 {
        self.0.strikes()
    }

    /// Whether kicks(T − t) = kicks(t): each phase is 0 or 1/2 (theorem `many_clocks_palindrome` in proofs/).
    pub fn is_palindrome(&self) -> bool {
        self.clocks().iter().all(|clock| clock.offset() == 0 || 2 * clock.offset() == clock.step())
    }

    /// One period of the staggered form: whole kicks at t = 0, none at T.
    pub fn staggered_period(&self) -> Events {
        Events::new(self.clocks(), self.period(), Ends::Staggered)
    }

    /// One period of the time-symmetric form: half of each kick at t = 0 and at T.
    pub fn symmetric_period(&self) -> Events {
        Events::new(self.clocks(), self.period(), Ends::Halved)
    }

    /// The first half of the time-symmetric period: half of each kick at t = 0 and at T/2.
    /// It determines the whole only where [`Schedule::is_palindrome`] holds.
    pub fn half_period(&self) -> Events {
        Events::new(self.clocks(), self.period() / 2, Ends::Halved)
    }
}
