//! The tongues of one ratio: which edge bounds which, open or closed.
//!
//! With 0 = P0 < P1 <= P2 < ... the zeros of B and C together and M1 <= M2 < ... those of A and D, tongue m
//! is [M_m, M_{m+1}] for odd m and [P_{m−1}, P_m] for even m: one edge from each of the two problems, both
//! with the index ⌈m/2⌉. For ρ > 0 there are p + q − 2 of them, and the last, m = p + q − 1, has no upper
//! end. For ρ = 0 the slow clock is silent: all are closed, at p θ = m π, m < p, and m = p begins at the
//! Verlet limit s = 4.

use std::cmp::Ordering;

use num_traits::Zero;

use super::edge::{Edge, Edges, Effort, Enclosure};
use super::gap::{Gap, Openness};
use super::peak::Peak;
use super::row::{Row, Wanted};
use super::select::{Selection, runs};
use super::string::Entry;
use number::error::{Error, Result};
use number::parallel::go_on;
use number::{Ball, Ratio, Rational};

/// All tongues of one p/q and ρ ≥ 0, computed as they are asked for.
#[derive(Clone, Debug)]
pub struct Tongues {
    edges: Edges,
    open: Openness,
}

impl Tongues {
    /// The tongues of h2/h1 = p/q and ρ = L2/L1.
    ///
    /// # Errors
    /// ρ < 0 (then the masses are no string's), ρ p/q beyond 1e±16.
    pub fn new(ratio: Ratio, rho: &Rational) -> Result<Self> {
        Ok(Tongues { edges: Edges::new(ratio, rho)?, open: Openness::default() })
    }

    /// h2/h1 = p/q.
    pub fn ratio(&self) -> Ratio {
        self.edges.ratio()
    }

    /// The numerator of h2/h1.
    pub fn p(&self) -> u64 {
        self.ratio().p()
    }

    /// ρ = L2/L1.
    pub fn rho(&self) -> &Rational {
        self.edges.rho()
    }

    /// m of the last tongue, which is infinite: p + q − 1, or p for ρ = 0.
    pub fn last(&self) -> u64 {
        if self.rho().is_zero() { self.p() } else { self.ratio().kicks() - 1 }
    }

    /// The work done so far.
    pub fn effort(&self) -> Effort {
        self.edges.effort()
    }

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
        Gap::new(&self.edges, &self.open, m, edges)
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
        let lists = self.edges.with_indices(&wanted)?;
        let edge = |entry: Entry, index: usize| {
            let first = *wanted[entry as usize].as_ref()?.start();
            lists[entry as usize].get(index - first).copied()
        };
        let pair = |m: u64| Entry::of_tongue(m % 2 == 1).map(|entry| edge(entry, m.div_ceil(2) as usize));
        (from..=upto).map(|m| go_on().and_then(|()| Gap::new(&self.edges, &self.open, m, pair(m)))).collect()
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
        let labels = selection.labels(&self.edges, self.last())?;
        let mut gaps = Vec::with_capacity(labels.len());
        for (from, upto) in runs(&labels) {
            let run = self.gaps(from, upto)?;
            gaps.extend(run.into_iter().filter(|gap| labels.binary_search(&gap.m).is_ok()));
        }
        kept(gaps, |gap| selection.meets_window(&self.edges, gap))
    }

    /// The tongues whose lower edge lies below s = `limit`; below 4 each clock is stable on its own.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn below(&self, limit: impl Into<f64>) -> Result<Vec<Gap>> {
        let limit = limit.into();
        let selection = Selection::below(limit);
        let begins_below = |gap: &Gap| match &selection.s {
            Some((_, limit)) => self.edges.compare(&gap.lower, limit).map(Ordering::is_lt),
            None => Ok(true),
        };
        kept(self.select(&selection)?, begins_below)
    }

    /// That the labels asked for exist.
    ///
    /// # Errors
    /// A label beyond the last tongue.
    pub fn check_labels(&self, selection: &Selection) -> Result<()> {
        selection.check_labels(&self.edges, self.last())
    }

    /// A tongue with the columns wanted.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn row(&self, gap: &Gap, wanted: &Wanted) -> Result<Row> {
        Ok(self.rows(std::slice::from_ref(gap), wanted)?.remove(0))
    }

    /// Tongues with the columns wanted: where growth is wanted, many cost a fraction of so many alone.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn rows(&self, gaps: &[Gap], wanted: &Wanted) -> Result<Vec<Row>> {
        Row::all(&self.edges, gaps, wanted)
    }

    /// The fastest growth inside a tongue; `None` of a closed one and of the infinite one.
    ///
    /// # Errors
    /// Where the schedule is too long, or more digits are needed than are tried.
    pub fn peak(&self, gap: &Gap) -> Result<Option<Peak>> {
        Ok(Peak::all(&self.edges, std::slice::from_ref(gap))?.remove(0))
    }

    /// The edges `first` ..= `last` of one problem, counted from 1.
    ///
    /// # Errors
    /// Where the schedule is too long; an index out of range.
    pub fn edges(&self, entry: Entry, first: usize, last: usize) -> Result<Vec<Edge>> {
        self.edges.range(entry, first, last)
    }

    /// All edges, by entry: the quickest way to have them all.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn all_edges(&self) -> Result<[Vec<Edge>; 4]> {
        self.edges.all()
    }

    /// How many positive zeros an entry has.
    pub fn zeros(&self, entry: Entry) -> usize {
        self.edges.dimension(entry)
    }

    /// The edge to `digits` significant digits: an interval narrower than 10^-digits of itself.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn refine(&self, edge: &Edge, digits: u32) -> Result<Enclosure> {
        self.edges.refine(edge, digits)
    }

    /// s = 4 sin²(m π/(2p)), where p θ = m π: the paper's eq. (9).
    pub fn resonance(&self, m: u64, bits: u32) -> Ball {
        self.edges.resonance(m, bits)
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
