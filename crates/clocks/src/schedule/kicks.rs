//! The table of kicks, and the one loop that leads an orbit through a schedule.

use super::events::{Event, Weight};

/// Anything that can be drifted and kicked: an orbit, a matrix, a polynomial in the stiffness.
pub trait KickDrift<K> {
    /// Lets `ticks` > 0 pass without a kick.
    fn drift(&mut self, ticks: u64);

    /// Looks at the state at every kick time, before the kick, and at the end of the span.
    fn arrive(&mut self) {}

    /// Kicks with this strength.
    fn kick(&mut self, strength: &K);
}

/// The strengths of all kicks of a schedule, whole and halved, made once and looked up at each event.
#[derive(Clone, Debug)]
pub struct Kicks<K> {
    /// \[whole, halved\] for each set of clocks that may strike together, or for each clock.
    strengths: Vec<[K; 2]>,
    by_set: bool,
}

impl<K> Kicks<K> {
    /// For two clocks: the strengths of the fast clock, of the slow one and of both together, which `parts`
    /// makes the whole and the halved kick of.
    pub fn of_two_clocks<T>(strengths: [T; 3], parts: impl Fn(T) -> [K; 2]) -> Self {
        Kicks { strengths: strengths.map(parts).into(), by_set: true }
    }

    /// For any number of clocks, which kick in turn where they strike together.
    pub fn of_clocks<T>(strengths: impl IntoIterator<Item = T>, parts: impl Fn(T) -> [K; 2]) -> Self {
        Kicks { strengths: strengths.into_iter().map(parts).collect(), by_set: false }
    }

    /// Leads the orbit through the events.
    // With the instructions that the caller is compiled for.
    #[inline(always)]
    pub fn lead(&self, events: impl IntoIterator<Item = Event>, orbit: &mut impl KickDrift<K>) {
        for event in events {
            if event.drift > 0 {
                orbit.drift(event.drift);
            }
            orbit.arrive();
            let part = usize::from(event.weight == Weight::Half);
            if !self.by_set {
                event.clocks().for_each(|clock| orbit.kick(&self.strengths[clock][part]));
            } else if event.kicks != 0 {
                orbit.kick(&self.strengths[event.kicks as usize - 1][part]);
            }
        }
    }
}
