//! A band at work: its pairs sorted by their number of updates, run side by side, the rest sent up the
//! ladder.

use std::cell::OnceCell;

use super::band::{Band, Counters};
use super::bases::{Bases, OnBase};
use super::gcd;
use super::grid::Grid;
use super::resources::Resources;
use crate::orbit::filter::{self, Group};
use crate::orbit::floquet::{Base, Turn};
use crate::verdict::{Limits, decide};
use number::vector::instructions::{Instructions, Task};
use number::{Error, Result};

/// Pairs that run side by side: four AVX-512 registers hide each other's latency.
pub(super) const LANES: usize = 32;

/// Longer pairs are left to the ladder, whose return maps cost less than so many updates in a group
/// (tests/bench/README.md).
pub(super) const MOST_TOGETHER: u64 = 1 << 15;

/// Decides the pairs at these positions in groups, `decide` returning those that the groups' bound does not
/// certify, and these again where there are enough: long ones, for which a look at every update is the
/// sharpest bound, and still many times faster than one by one. Returns what is left.
pub(super) fn in_groups<P>(
    order: &[P],
    mut decide: impl FnMut(Group<LANES>, &[P]) -> Result<Vec<P>>,
) -> Result<Vec<P>> {
    let rest = decide(Group::new(Instructions::best()), order)?;
    if rest.len() < LANES { Ok(rest) } else { decide(Group::watched(Instructions::best(), 1), &rest) }
}

/// A band at work.
pub(super) struct Work<'a> {
    grid: &'a Grid,
    bases: &'a Bases<'a>,
    resources: &'a Resources<'a>,
    first: u64,
    /// The columns' bases, as they are asked for.
    firsts: Vec<OnceCell<Option<Base>>>,
    /// The rows', where those are not shared by all bands.
    seconds: Vec<OnceCell<Option<Base>>>,
    gcds: Vec<u32>,
    /// Positions in the order of the number of updates.
    order: Vec<u32>,
}

/// Bytes of a pair at work: its divisor, key, place among the sorted and among the undecided, the two while
/// they are sorted, verdict, tier.
const BYTES_A_PAIR: u128 = 4 + 4 + 4 + 4 + 12 + 1 + 1;

/// Bytes of a row that is the base of pairs in one band: in a band of one column it makes three turns.
const BYTES_A_ROW: usize = size_of::<OnceCell<Option<Base>>>() + 3 * size_of::<Turn>();

impl<'a> Work<'a> {
    pub fn new(
        grid: &'a Grid,
        bases: &'a Bases<'a>,
        resources: &'a Resources<'a>,
        (first, columns): (u64, usize),
    ) -> Self {
        let (rows, first_row) = (grid.shape().1, grid.rows().0);
        let (a, b) = grid.step_ratio();
        let mut gcds = vec![0; columns * rows];
        for (i, gcds) in (first..).zip(gcds.chunks_mut(rows)) {
            // gcd(ib, ja) = gcd(i, a) gcd(i b / gcd(i, a), j), a and b being coprime.
            let common = num_integer::gcd(i, a);
            gcd::with_run(&[i / common, b], first_row, gcds);
            gcds.iter_mut().for_each(|g| *g *= common as u32);
        }
        let cells = |n: usize| (0..n).map(|_| OnceCell::new()).collect();
        let (firsts, seconds) = (cells(columns), cells(if bases.rows_are_shared() { 0 } else { rows }));
        let mut work = Work { grid, bases, resources, first, firsts, seconds, gcds, order: Vec::new() };
        work.order = work.sorted();
        work
    }

    /// Bytes that a band of so many columns takes at most while it is worked on.
    pub fn bytes(grid: &Grid, bases: &Bases, columns: usize) -> u128 {
        let rows = grid.shape().1 as u128;
        let count = if bases.rows_are_shared() { 0 } else { BYTES_A_ROW as u128 };
        rows * (BYTES_A_PAIR * columns as u128 + count)
    }

    pub(super) fn multipliers(&self, n: usize) -> (u64, u64) {
        // A band has fewer than 2^32 pairs, and the shorter division is the faster one.
        let (n, rows) = (n as u32, self.grid.shape().1 as u32);
        (self.first + u64::from(n / rows), self.grid.rows().0 + u64::from(n % rows))
    }

    /// Positions by min(p, q)/2: equal numbers run together.
    fn sorted(&self) -> Vec<u32> {
        let (a, b) = self.grid.step_ratio();
        let rows = (self.grid.rows().0 as f64, a as f64);
        let mut keys = Vec::with_capacity(self.gcds.len());
        for (i, gcds) in (self.first..).zip(self.gcds.chunks(self.grid.shape().1)) {
            Instructions::best().perform(Updates { column: (i * b) as f64, rows, gcds, keys: &mut keys });
        }
        by_counting(0.., &keys)
    }

    /// The band's verdicts.
    pub fn run(&self) -> Result<Band> {
        let (pairs, rows) = (self.gcds.len(), self.grid.shape().1);
        let mut band = Band {
            first: self.first,
            columns: pairs / rows,
            rows,
            verdicts: vec![filter::UNDECIDED; pairs],
            tiers: vec![0; pairs],
            growing: Vec::new(),
            counters: Counters { pairs: pairs as u64, ..Counters::default() },
        };
        let undecided = |verdicts: &[u8]| -> Vec<u32> {
            self.order.iter().copied().filter(|&n| verdicts[n as usize] == filter::UNDECIDED).collect()
        };
        let mut rest = in_groups(&self.order, |group, order| {
            band.counters.kicks += self.decide_in(group, order, &mut band.verdicts)?;
            Ok(undecided(&band.verdicts))
        })?;
        rest.sort_unstable();
        band.counters.escalated = rest.len() as u64;
        for n in rest.into_iter().map(|n| n as usize) {
            let (i, j) = self.multipliers(n);
            self.go_on()?;
            let decision = decide(&self.grid.clocks(i, j)?, self.limits())?;
            (band.verdicts[n], band.tiers[n]) = (decision.verdict.index(), decision.decided_by as u8);
        }
        Ok(band)
    }

    /// The verdicts of the pairs at these positions as far as the groups certify them, and the kicks that it
    /// took.
    fn decide_in(&self, mut group: Group<LANES>, order: &[u32], verdicts: &mut [u8]) -> Result<u64> {
        self.side_by_side(order, MOST_TOGETHER, |pairs, positions| {
            let found = group.verdicts(pairs);
            positions.iter().zip(found).for_each(|(&n, verdict)| verdicts[n] = verdict);
            group.kicks()
        })
    }

    pub(super) fn uncertified_unstable(&self) -> Result<u64> {
        let (mut group, mut unstable) = (Group::<LANES>::new(Instructions::best()), 0);
        self.side_by_side(&self.order, u64::MAX, |pairs, _| {
            let verdicts = group.uncertified(pairs);
            unstable += verdicts[..pairs.len()].iter().filter(|&&verdict| verdict != 0).count() as u64;
            group.kicks()
        })?;
        Ok(unstable)
    }

    /// Hands the pairs at the given positions, which are in the order of their updates, on in groups that run
    /// side by side, without those that have no base or more than `most` updates, and counts the kicks that
    /// the groups say they compose.
    pub(super) fn side_by_side(
        &self,
        order: &[u32],
        most: u64,
        mut run: impl FnMut(&[OnBase], &[usize]) -> u64,
    ) -> Result<u64> {
        let mut kicks = 0;
        let (mut pairs, mut positions) = (Vec::with_capacity(LANES), Vec::with_capacity(LANES));
        for group in order.chunks(LANES) {
            self.go_on()?;
            pairs.clear();
            positions.clear();
            for n in group.iter().map(|&n| n as usize) {
                let (place, gcd) = (self.multipliers(n), u64::from(self.gcds[n]));
                if let Some(pair) = self.bases.pair(|i| self.first(i), |j| self.second(j), place, gcd) {
                    pairs.push(pair);
                    positions.push(n);
                }
            }
            // The last one has the most.
            if pairs.last().is_some_and(|pair| pair.updates() > most) {
                let fit = pairs.partition_point(|pair| pair.updates() <= most);
                pairs.truncate(fit);
                positions.truncate(fit);
            }
            if pairs.last().is_some_and(|pair| pair.updates() >= self.limits().kicks) {
                pairs.iter().try_for_each(|pair| self.allow(pair.updates() + 1))?;
            }
            if !pairs.is_empty() {
                kicks += run(&pairs, &positions);
            }
        }
        Ok(kicks)
    }

    /// The base of a column of this band.
    fn first(&self, column: u64) -> Option<&Base> {
        self.firsts[(column - self.first) as usize].get_or_init(|| self.bases.column(column)).as_ref()
    }

    /// The base of a row: of this band or, as a rule, of all.
    fn second(&self, row: u64) -> Option<&Base> {
        let Some(base) = self.seconds.get((row - self.grid.rows().0) as usize) else {
            return self.bases.row(row);
        };
        let last = self.first + self.firsts.len() as u64 - 1;
        base.get_or_init(|| self.bases.row_within(row, self.first, last)).as_ref()
    }

    fn allow(&self, kicks: u64) -> Result<()> {
        if kicks <= self.limits().kicks {
            return Ok(());
        }
        let cost = format!("a pair of the map composes {kicks} kicks, the budget is {}", self.limits().kicks);
        Err(Error::budget(cost, kicks).or("choose steps with a simpler ratio"))
    }

    /// # Errors
    /// Where the work was stopped.
    pub(super) fn go_on(&self) -> Result<()> {
        self.resources.go_on()
    }

    pub(super) fn grid(&self) -> &Grid {
        self.grid
    }

    pub(super) fn limits(&self) -> &Limits {
        &self.resources.limits
    }

    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }
}

/// Appends ⌊min(p, q)/2⌋ of a column's pairs: its step, the number of the first row and their unit, and the
/// greatest common divisors.
struct Updates<'a> {
    column: f64,
    rows: (f64, f64),
    gcds: &'a [u32],
    keys: &'a mut Vec<u32>,
}

impl Task for Updates<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Updates { column, rows: (first, unit), gcds, keys } = self;
        keys.extend(gcds.iter().zip(0u32..).map(|(&gcd, n)| {
            let row = (first + f64::from(n)) * unit;
            let shorter = if row < column { row } else { column };
            // Whole numbers, or a half more; what is larger than a key is among the last.
            (0.5 * (shorter / f64::from(gcd))) as u32
        }));
    }
}

/// Items in the order of their keys, those of equal keys in the order that they have.
pub(super) fn by_counting<T: Copy>(items: impl Iterator<Item = T>, keys: &[u32]) -> Vec<T> {
    let largest = keys.iter().copied().max().unwrap_or(0) as usize;
    if largest > 8 * keys.len() + 1024 {
        let mut keyed: Vec<(u32, T)> = keys.iter().copied().zip(items).collect();
        keyed.sort_by_key(|&(key, _)| key);
        return keyed.into_iter().map(|(_, item)| item).collect();
    }
    let mut starts = vec![0u32; largest + 2];
    keys.iter().for_each(|&key| starts[key as usize + 1] += 1);
    (1..starts.len()).for_each(|key| starts[key] += starts[key - 1]);
    let mut items = items.peekable();
    let mut sorted = items.peek().map_or(Vec::new(), |&first| vec![first; keys.len()]);
    for (item, &key) in items.zip(keys) {
        let place = &mut starts[key as usize];
        sorted[*place as usize] = item;
        *place += 1;
    }
    sorted
}
