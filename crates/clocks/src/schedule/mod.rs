//! The schedule: which clocks kick when, over the synchronization period or its first half.
//!
//! Times are whole numbers of *ticks*, the greatest common measure of all steps (and phases), so
//! coincidences are decided by integer equality. The kick pattern of clocks with phases 0 and 1/2
//! is a palindrome over the period (theorem `two_clocks_palindrome` in proofs/).
//!
//! ```
//! use kickdrift_clocks::schedule::{Schedule, Weight};
//! // h2/h1 = 3/2: one tick is h1/2 = h2/3, so the steps are 2 and 3 ticks and the period is 6.
//! let schedule = Schedule::two_clocks("3/2".parse().unwrap()).unwrap();
//! let events: Vec<_> = schedule.half_period().map(|e| (e.drift, e.kicks, e.weight)).collect();
//! // Both clocks at 0 (half a kick each), the first at 2, the second at T/2 = 3 (half a kick).
//! assert_eq!(events, [(0, 0b11, Weight::Half), (2, 0b01, Weight::Full), (1, 0b10, Weight::Half)]);
//! ```

mod clocks;
mod events;
mod kicks;
mod period;
mod queue;

pub use clocks::{Clock, Clocks};
pub use events::{Event, Events, Weight, reversed};
pub use kicks::{KickDrift, Kicks};
pub use period::Schedule;
pub use queue::Queue;
