//! The verdicts of a band of columns of a map.

use super::grid::Grid;
use super::products::Growing;
use crate::verdict::{Decision, Tier, Verdict};

/// The verdicts of a band of columns, column by column, in each by increasing row.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The multiplier i of the first column.
    pub first: u64,
    /// The number of columns and of rows.
    pub columns: usize,
    pub rows: usize,
    /// Positions in [`Verdict::ALL`].
    pub verdicts: Vec<u8>,
    /// The deciding tiers: 0 filter, 1 refine, 2 exact.
    pub tiers: Vec<u8>,
    /// Of the pairs whose powers grow exponentially, in the same order, what was asked for.
    pub growing: Vec<Growing>,
    pub counters: Counters,
}

/// Counts of the work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    pub pairs: u64,
    /// Kicks composed by the first tier for the verdicts.
    pub kicks: u64,
    /// Kicks composed again for labels and growth.
    pub kicks_again: u64,
    /// Pairs that the kernel sent up the ladder.
    pub escalated: u64,
}

impl Counters {
    /// The sums, which end where numbers do: a part that was written by somebody else may say anything.
    pub fn add(&mut self, other: &Counters) {
        let sum = |a: &mut u64, b: u64| *a = a.saturating_add(b);
        sum(&mut self.pairs, other.pairs);
        sum(&mut self.kicks, other.kicks);
        sum(&mut self.kicks_again, other.kicks_again);
        sum(&mut self.escalated, other.escalated);
    }
}

impl Band {
    /// The verdict and its tier at position n.
    pub fn decision(&self, n: usize) -> Decision {
        let decided_by = Tier::ALL[usize::from(self.tiers[n])];
        Decision { verdict: Verdict::ALL[usize::from(self.verdicts[n])], decided_by }
    }

    /// (i, j) of position n in a band of this grid.
    pub fn multipliers(&self, grid: &Grid, n: usize) -> (u64, u64) {
        (self.first + (n / self.rows) as u64, grid.rows().0 + (n % self.rows) as u64)
    }
}
