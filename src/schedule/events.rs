//! The events of a span: at which times which clocks kick.

use super::clocks::Clock;
use super::queue::Queue;

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

impl Event {
    /// The indices of the clocks that kick, in increasing order.
    pub fn clocks(&self) -> impl Iterator<Item = usize> + use<> {
        let kicks = self.kicks;
        (0..(64 - kicks.leading_zeros()) as usize).filter(move |clock| kicks >> clock & 1 == 1)
    }
}

/// What happens to the kicks at the two ends of the span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// Whole at the beginning, left to the next period at the end.
    Staggered,
    /// Halved at both ends.
    Halved,
}

/// Iterator over the [`Event`]s of a span that begins at t = 0.
#[derive(Clone, Debug)]
pub struct Events {
    queue: Queue,
    /// The first strike that is in no event yet: its time and its clock. `None` where none is left.
    next: Option<(u64, usize)>,
    now: u64,
    end: u64,
    ends: Ends,
    done: bool,
}

impl Events {
    pub(super) fn new(clocks: &[Clock], end: u64, ends: Ends) -> Self {
        let mut queue = Queue::new(clocks);
        let next = queue.pop_before(end, ends == Ends::Halved);
        Events { queue, next, now: 0, end, ends, done: false }
    }
}

impl Iterator for Events {
    type Item = Event;

    fn next(&mut self) -> Option<Event> {
        if self.done {
            return None;
        }
        let time = self.next.map_or(self.end, |(time, _)| time);
        let mut kicks = 0;
        while let Some((_, clock)) = self.next.filter(|&(strike, _)| strike == time) {
            kicks |= 1 << clock;
            self.next = self.queue.pop_before(self.end, self.ends == Ends::Halved);
        }
        self.done = time == self.end;
        let halved = self.ends == Ends::Halved && (time == 0 || self.done);
        let drift = time - self.now;
        self.now = time;
        Some(Event { drift, kicks, weight: if halved { Weight::Half } else { Weight::Full } })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Schedule;
    use super::*;
    use crate::number::{Ratio, Rational};

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
