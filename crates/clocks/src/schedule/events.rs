//! The events of a span: at which times which clocks kick.

use super::clocks::Clock;
use super::queue::Queue;
use number::Rational;

/// How much of each kick an event carries: half of it where a half period begins or ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    Half,
    Full,
}

impl Weight {
    /// 1/2 or 1.
    pub fn share(self) -> f64 {
        if self == Weight::Full { 1.0 } else { 0.5 }
    }

    /// x/2 or x.
    pub fn of(self, x: &Rational) -> Rational {
        if self == Weight::Full { x.clone() } else { x / Rational::from_integer(2.into()) }
    }
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

/// The events of a span from its end to its beginning: each drift comes after the kicks that it led to.
pub fn reversed(events: &[Event]) -> Vec<Event> {
    let mut drift = 0;
    let back = events
        .iter()
        .rev()
        .map(|event| Event { drift: std::mem::replace(&mut drift, event.drift), ..*event });
    let mut back: Vec<Event> = back.collect();
    back.extend((drift > 0).then_some(Event { drift, kicks: 0, weight: Weight::Full }));
    back
}

/// How the kicks at the two ends of the span are taken.
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
