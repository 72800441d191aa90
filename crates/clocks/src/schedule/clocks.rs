//! Clocks with commensurable steps, and the time after which they meet again.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};

use number::{Error, Rational, Result};

/// A clock in ticks: it strikes at `offset + n · step`, n = 0, 1, 2, ..., with `offset < step`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    step: u64,
    offset: u64,
}

impl Clock {
    /// With `offset < step`.
    pub(super) fn new(step: u64, offset: u64) -> Self {
        Clock { step, offset }
    }

    /// The step in ticks.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// The time of the first strike in ticks.
    pub fn offset(&self) -> u64 {
        self.offset
    }
}

/// Any number of clocks, their unit of time and their synchronization period.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clocks {
    all: Vec<Clock>,
    tick: Rational,
    /// T in ticks: the least common multiple of the steps, even.
    period: u64,
}

impl Clocks {
    /// Clocks with the given steps (any common unit, all positive) and phases in [0, 1): clock i strikes
    /// at the times (n + phase_i) step_i.
    ///
    /// # Errors
    /// No clock, a step that is not positive, a phase outside [0, 1), or a period of 2^62 ticks and more.
    pub fn new(steps: &[Rational], phases: &[Rational]) -> Result<Self> {
        if steps.is_empty() || steps.len() != phases.len() {
            return Err(Error::input("steps", steps.len(), "give at least one, and as many phases"));
        }
        for (k, (step, phase)) in steps.iter().zip(phases).enumerate() {
            if !step.is_positive() {
                return Err(Error::input(&format!("step[{k}]"), step, "a step must be positive"));
            }
            if phase.is_negative() || *phase >= Rational::one() {
                return Err(Error::input(&format!("phase[{k}]"), phase, "a phase lies in [0, 1)"));
            }
        }
        let offsets: Vec<Rational> = steps.iter().zip(phases).map(|(h, phase)| h * phase).collect();
        let tick = steps.iter().chain(&offsets).fold(Rational::zero(), |g, x| common_measure(&g, x));
        let ticks = |x: &Rational| (x / &tick).to_integer().to_u64().ok_or_else(too_long);
        let clock = |(h, o)| Ok(Clock::new(ticks(h)?, ticks(o)?));
        let all = steps.iter().zip(&offsets).map(clock).collect::<Result<_>>()?;
        Clocks::from_ticks(all, tick)
    }

    /// The tick is halved where T would be odd, so that T/2 is whole.
    pub(super) fn from_ticks(mut all: Vec<Clock>, mut tick: Rational) -> Result<Self> {
        let lcm = |t: u64, clock: &Clock| (t / t.gcd(&clock.step)).checked_mul(clock.step);
        let mut period = all.iter().try_fold(1, lcm).filter(|&t| t < 1 << 62).ok_or_else(too_long)?;
        if period % 2 == 1 {
            period *= 2;
            tick /= BigInt::from(2);
            all.iter_mut().for_each(|c| *c = Clock::new(2 * c.step, 2 * c.offset));
        }
        Ok(Clocks { all, tick, period })
    }

    /// The clocks in ticks.
    pub fn all(&self) -> &[Clock] {
        &self.all
    }

    /// The length of a tick, in the unit of the steps.
    pub fn tick(&self) -> &Rational {
        &self.tick
    }

    /// T in ticks, an even number.
    pub fn period(&self) -> u64 {
        self.period
    }

    /// The sum of all clocks' strikes in one period.
    pub fn strikes(&self) -> u64 {
        self.all.iter().map(|clock| self.period / clock.step).fold(0, u64::saturating_add)
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
