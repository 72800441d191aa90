//! The tongues of one ratio: which edge bounds which, open or closed.
//!
//! With 0 = P0 < P1 <= P2 < ... the zeros of B and C together and M1 <= M2 < ... those of A and D, tongue m
//! is [M_m, M_{m+1}] for odd m and [P_{m−1}, P_m] for even m: one edge from each of the two problems, both
//! with the index ⌈m/2⌉. For ρ > 0 there are p + q − 2 of them, and the last, m = p + q − 1, has no upper
//! end. For ρ = 0 the slow clock is silent: all are closed, at p θ = m π, m < p, and m = p begins at the
//! Verlet limit s = 4.

use std::cmp::Ordering;

use super::edge::Tongues;
use super::gap::Gap;
use super::select::{Selection, runs};
use super::string::Entry;
use number::parallel::go_on;
use number::{Error, Result};

impl Tongues {
    /// Tongue m alone, 1 ≤ m ≤ [`Tongues::last`]: two edges are computed.
    ///
    /// # Errors
    /// m out of range.
    pub fn gap(&self, m: u64) -> Result<Gap> {
        self.check(m)?;
        let index = m.div_ceil(2) as usize;
        let mut edges = [None, None];
        for (edge, entry) in edges.iter_mut().zip(Entry::of_tongue(m % 2 == 1)) {
            if index <= self.zeros(entry) {
                *edge = self.edges(entry, index, index)?.pop();
            }
        }
        Gap::new(self, m, edges)
    }

    /// The tongues `from` ..= `upto`; all edges of one problem are computed side by side.
    ///
    /// # Errors
    /// m out of range.
    pub fn gaps(&self, from: u64, upto: u64) -> Result<Vec<Gap>> {
        self.check(from)?;
        self.check(upto)?;
        let mut wanted = [const { None }; 4];
        for entry in Entry::ALL {
            let (first, last) = indices(entry, from, upto);
            let last = last.min(self.zeros(entry));
            wanted[entry as usize] = (first <= last).then_some(first..=last);
        }
        let lists = self.with_indices(&wanted)?;
        let edge = |entry: Entry, index: usize| {
            let first = *wanted[entry as usize].as_ref()?.start();
            lists[entry as usize].get(index - first).copied()
        };
        let pair = |m: u64| Entry::of_tongue(m % 2 == 1).map(|entry| edge(entry, m.div_ceil(2) as usize));
        (from..=upto).map(|m| go_on().and_then(|()| Gap::new(self, m, pair(m)))).collect()
    }

    /// All tongues, the infinite one last: the quickest way to have them all.
    ///
    /// # Errors
    /// As [`Tongues::gaps`].
    pub fn all(&self) -> Result<Vec<Gap>> {
        self.gaps(1, self.last())
    }

    /// The tongues selected, in order of m.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn select(&self, selection: &Selection) -> Result<Vec<Gap>> {
        let labels = selection.labels(self)?;
        let mut gaps = Vec::with_capacity(labels.len());
        for (from, upto) in runs(&labels) {
            let run = self.gaps(from, upto)?;
            gaps.extend(run.into_iter().filter(|gap| labels.binary_search(&gap.m).is_ok()));
        }
        kept(gaps, |gap| selection.meets_window(self, gap))
    }

    /// The tongues whose lower edge lies below s = `limit`; below 4 each clock is stable on its own.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn below(&self, limit: impl Into<f64>) -> Result<Vec<Gap>> {
        let limit = limit.into();
        let selection = Selection::below(limit);
        let begins_below = |gap: &Gap| match &selection.s {
            Some((_, limit)) => self.compare(&gap.lower, limit).map(Ordering::is_lt),
            None => Ok(true),
        };
        kept(self.select(&selection)?, begins_below)
    }

    fn check(&self, m: u64) -> Result<()> {
        if (1..=self.last()).contains(&m) {
            return Ok(());
        }
        Err(Error::input("m", m, format!("{} has the tongues 1 to {}", self.ratio(), self.last())))
    }
}

/// The tongues of which something holds.
fn kept(gaps: Vec<Gap>, holds: impl Fn(&Gap) -> Result<bool>) -> Result<Vec<Gap>> {
    let kept = gaps.into_iter().filter_map(|gap| match holds(&gap) {
        Ok(holds) => holds.then_some(Ok(gap)),
        Err(error) => Some(Err(error)),
    });
    kept.collect()
}

/// The indices of an entry's edges in the tongues `from` ..= `upto`.
fn indices(entry: Entry, from: u64, upto: u64) -> (usize, usize) {
    let odd = matches!(entry, Entry::A | Entry::D);
    // The least and the largest m of the parity in the range.
    let first = if (from % 2 == 1) == odd { from } else { from + 1 };
    let last = if (upto % 2 == 1) == odd { upto } else { upto.saturating_sub(1) };
    (first.div_ceil(2) as usize, last.div_ceil(2) as usize)
}
