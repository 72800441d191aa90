//! The four eigenvalue problems of a half period.

use number::named;
use std::ops::RangeInclusive;

/// The range of indices that is wanted of each of the four problems, in the order of [`Entry::ALL`].
pub(crate) type Indices = [Option<RangeInclusive<usize>>; 4];

named! {
    /// An entry of the half-period propagator, as the problem whose eigenvalues are its zeros.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Entry {
        /// Even at 0 (free), odd at T/2 (pinned).
        A = "A",
        /// Odd at both ends.
        B = "B",
        /// Even at both ends; its zero s = 0, a rigid shift, is not counted.
        C = "C",
        /// Odd at 0, even at T/2.
        D = "D",
    }
}

impl Entry {
    /// Whether the string is free at t = 0.
    pub(crate) fn starts_free(self) -> bool {
        matches!(self, Entry::A | Entry::C)
    }

    /// Whether the string is free at t = T/2.
    pub(crate) fn ends_free(self) -> bool {
        matches!(self, Entry::C | Entry::D)
    }

    /// The problem with such ends.
    pub(crate) fn of_ends(starts_free: bool, ends_free: bool) -> Entry {
        match (starts_free, ends_free) {
            (true, false) => Entry::A,
            (false, false) => Entry::B,
            (true, true) => Entry::C,
            (false, true) => Entry::D,
        }
    }

    /// The eigenvalue of one index of this problem alone.
    pub fn only(self, index: usize) -> Indices {
        Entry::ALL.map(|entry| (entry == self).then_some(index..=index))
    }

    /// The two entries whose zeros bound the tongues of odd or of even m.
    pub fn of_tongue(odd: bool) -> [Entry; 2] {
        if odd { [Entry::A, Entry::D] } else { [Entry::B, Entry::C] }
    }
}
