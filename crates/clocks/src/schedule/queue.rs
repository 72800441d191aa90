//! The priority queue of Algorithm 1: which clock strikes next, times in whole ticks, ties decided exactly.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::clocks::Clock;

/// The strikes to come as (time, clock) pairs: the earliest first, at equal times the clock of the smaller
/// index.
#[derive(Clone, Debug)]
pub struct Queue {
    order: Order,
    steps: Vec<u64>,
}

/// Few next strikes are looked through, many lie in a heap.
#[derive(Clone, Debug)]
enum Order {
    Few(Vec<u64>),
    Many(BinaryHeap<Reverse<(u64, usize)>>),
}

/// Up to here a look through all clocks is faster than a heap.
const SCANNED_CLOCKS: usize = 8;

impl Queue {
    /// All clocks at their first strikes.
    pub fn new(clocks: &[Clock]) -> Self {
        let first = clocks.iter().map(|clock| clock.offset());
        let order = if clocks.len() <= SCANNED_CLOCKS {
            Order::Few(first.collect())
        } else {
            Order::Many(first.enumerate().map(|(k, time)| Reverse((time, k))).collect())
        };
        Queue { order, steps: clocks.iter().map(|clock| clock.step()).collect() }
    }

    /// The next strike, if it comes before `end` (or at it, if `inclusive`); its clock is scheduled again.
    pub fn pop_before(&mut self, end: u64, inclusive: bool) -> Option<(u64, usize)> {
        let due = |time: u64| time < end || (time == end && inclusive);
        match &mut self.order {
            Order::Few(next) => {
                let earlier = |best: (u64, usize), (k, &time): (usize, &u64)| {
                    if time < best.0 { (time, k) } else { best }
                };
                let (time, clock) = next.iter().enumerate().fold((u64::MAX, 0), earlier);
                if !due(time) {
                    return None;
                }
                next[clock] = time + self.steps[clock];
                Some((time, clock))
            }
            Order::Many(heap) => {
                let mut top = heap.peek_mut()?;
                let Reverse((time, clock)) = *top;
                if !due(time) {
                    return None;
                }
                *top = Reverse((time + self.steps[clock], clock));
                Some((time, clock))
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
        let clocks: Vec<_> = (0..SCANNED_CLOCKS)
            .map(|k| [6, 4, 3, 12][k % 4])
            .enumerate()
            .map(|(k, step)| Clock::new(step, if k % 3 == 2 { step / 2 } else { 0 }))
            .collect();
        let mut few = Queue::new(&clocks);
        let heap = clocks.iter().enumerate().map(|(k, clock)| Reverse((clock.offset(), k))).collect();
        let mut many = Queue { order: Order::Many(heap), steps: few.steps.clone() };
        let mut last = (0, 0);
        while let Some(strike) = few.pop_before(100, true) {
            assert_eq!(many.pop_before(100, true), Some(strike));
            assert!(strike >= last);
            last = strike;
        }
        assert_eq!((many.pop_before(100, true), last.0), (None, 100));
    }
}
