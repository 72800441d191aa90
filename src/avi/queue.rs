//! The priority queue of Algorithm 1: which potential kicks next, times in whole ticks, ties decided exactly.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};

use crate::error::{Error, Result};
use crate::number::Rational;

/// A potential's clock: its next kick and the time between two, in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    pub first: u64,
    pub step: u64,
}

/// The clocks of all potentials over one common measure of time.
#[derive(Clone, Debug)]
pub struct Clocks {
    /// The length of a tick.
    pub tick: Rational,
    pub clocks: Vec<Clock>,
    /// T in ticks: the least common multiple of the steps.
    pub period: u64,
}

impl Clocks {
    /// Clocks kicking at (n + phase) step. The tick is the greatest common measure of the steps and half of it, so
    /// that half periods are whole.
    ///
    /// # Errors
    /// Names the step that is not positive, the phase outside [0, 1); a period of 2^62 ticks and more.
    pub fn new(steps: &[Rational], phases: &[Rational]) -> Result<Self> {
        if steps.is_empty() || steps.len() != phases.len() {
            return Err(Error::input("steps", steps.len(), "give at least one, and as many phases"));
        }
        let mut tick = Rational::zero();
        for (k, (step, phase)) in steps.iter().zip(phases).enumerate() {
            if !step.is_positive() {
                return Err(Error::input(&format!("step[{k}]"), step, "a step must be positive"));
            }
            if phase.is_negative() || *phase >= Rational::from_integer(1.into()) {
                return Err(Error::input(&format!("phase[{k}]"), phase, "a phase lies in [0, 1)"));
            }
            tick = common_measure(&common_measure(&tick, step), &(step * phase));
        }
        tick /= Rational::from_integer(2.into());
        let too_long =
            || Error::too_much("the synchronization period exceeds 2^62 ticks", "choose simpler step ratios");
        let ticks =
            |x: Rational| (x / &tick).to_integer().to_u64().filter(|&n| n < 1 << 62).ok_or_else(too_long);
        let clock = |(h, phase): (&Rational, &Rational)| {
            Ok(Clock { first: ticks(h * phase)?, step: ticks(h.clone())? })
        };
        let clocks: Vec<Clock> = steps.iter().zip(phases).map(clock).collect::<Result<_>>()?;
        let lcm = |t: u64, clock: &Clock| (t / t.gcd(&clock.step)).checked_mul(clock.step);
        let period = clocks.iter().try_fold(1, lcm).filter(|&t| t < 1 << 62).ok_or_else(too_long)?;
        Ok(Clocks { tick, clocks, period })
    }

    /// The number of kicks in a period.
    pub fn kicks(&self) -> u64 {
        self.clocks.iter().map(|clock| self.period / clock.step).fold(0, u64::saturating_add)
    }
}

/// The largest g ≥ 0 of which both are integer multiples.
fn common_measure(a: &Rational, b: &Rational) -> Rational {
    let numer = (a.numer() * b.denom()).gcd(&(b.numer() * a.denom()));
    Rational::new(numer, a.denom() * b.denom())
}

/// The queue: (time, potential) pairs, the earliest first, at equal times the smaller index first.
#[derive(Clone, Debug)]
pub struct Queue {
    order: Order,
    steps: Vec<u64>,
}

/// Few next kicks are looked through, many lie in a heap.
#[derive(Clone, Debug)]
enum Order {
    Few(Vec<u64>),
    Many(BinaryHeap<Reverse<(u64, usize)>>),
}

/// Up to here a look through all clocks is faster than a heap.
const FEW: usize = 8;

impl Queue {
    /// All clocks at their first kicks.
    pub fn new(clocks: &[Clock]) -> Self {
        let first = clocks.iter().map(|clock| clock.first);
        let order = if clocks.len() <= FEW {
            Order::Few(first.collect())
        } else {
            Order::Many(first.enumerate().map(|(k, time)| Reverse((time, k))).collect())
        };
        Queue { order, steps: clocks.iter().map(|clock| clock.step).collect() }
    }

    /// The next kick, if it comes before `end` (or at it, if `inclusive`); its potential is scheduled again.
    pub fn pop_before(&mut self, end: u64, inclusive: bool) -> Option<(u64, usize)> {
        let due = |time: u64| time < end || (time == end && inclusive);
        match &mut self.order {
            Order::Few(next) => {
                let earlier = |best: (u64, usize), (k, &time): (usize, &u64)| {
                    if time < best.0 { (time, k) } else { best }
                };
                let (time, potential) = next.iter().enumerate().fold((u64::MAX, 0), earlier);
                if !due(time) {
                    return None;
                }
                next[potential] = time + self.steps[potential];
                Some((time, potential))
            }
            Order::Many(heap) => {
                let mut top = heap.peek_mut()?;
                let Reverse((time, potential)) = *top;
                if !due(time) {
                    return None;
                }
                *top = Reverse((time + self.steps[potential], potential));
                Some((time, potential))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heap_and_the_look_through_give_one_order() {
        // Ties everywhere: steps 6, 4, 3, 12, 4, ... and phases 0 and 1/2.
        let clocks: Vec<_> = (0..FEW)
            .map(|k| [6, 4, 3, 12][k % 4])
            .enumerate()
            .map(|(k, step)| Clock { first: if k % 3 == 2 { step / 2 } else { 0 }, step })
            .collect();
        let mut few = Queue::new(&clocks);
        let heap = clocks.iter().enumerate().map(|(k, clock)| Reverse((clock.first, k))).collect();
        let mut many = Queue { order: Order::Many(heap), steps: few.steps.clone() };
        let mut last = (0, 0);
        while let Some(kick) = few.pop_before(100, true) {
            assert_eq!(many.pop_before(100, true), Some(kick));
            assert!(kick >= last);
            last = kick;
        }
        assert_eq!((many.pop_before(100, true), last.0), (None, 100));
    }
}
