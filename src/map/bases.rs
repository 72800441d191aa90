//! The base clocks of a grid, each made once: a column's first clock, a row's second.

use std::sync::OnceLock;

use num_bigint::BigInt;

use super::grid::Grid;
use crate::number::{Ball, Laurent, Real, Ring};
use crate::verdict::floquet::{Base, Pair, ordinary};

/// Bits of what all bases share.
const BITS: u32 = 256;

/// What the bases of a grid share, and the bases of its rows as they are asked for.
pub(super) struct Bases<'a> {
    grid: &'a Grid,
    /// d1² λ1 and d2² λ2: a base's strength is i² or j² times that.
    units: [Ball; 2],
    /// d1 d2 λ2 and d1 d2 λ1, the foreign kicks' strengths in units of ij.
    kicks: [Option<f64>; 2],
    /// Empty where their tables of turns would be too long: then each band makes the parts that it needs.
    rows: Vec<OnceLock<Option<Base>>>,
}

/// Turns (48 bytes each) in the tables of all rows together, at most.
const TURNS: u64 = 1 << 20;

impl<'a> Bases<'a> {
    pub fn new(grid: &'a Grid) -> Self {
        let ((lambda1, lambda2), (d1, d2)) = (grid.lambdas(), grid.steps());
        let product = |a: &Laurent, b: &Laurent, c: &Laurent| Laurent::product(&Laurent::product(a, b), c);
        let units = [product(d1, d1, lambda1), product(d2, d2, lambda2)].map(|x| x.enclosure(BITS));
        let kicks = [lambda2, lambda1].map(|lambda| ordinary(&product(d1, d2, lambda).enclosure(BITS)));
        let ((a, b), (low, high)) = (grid.ratio(), grid.rows());
        let turns = |row: u64| grid.columns().1 * b / (row * a) + 2;
        let most =
            (low..=high).try_fold(0, |sum: u64, row| Some(sum + turns(row)).filter(|&sum| sum <= TURNS));
        let rows = most.map_or(0, |_| grid.shape().1);
        let rows = (0..rows).map(|_| OnceLock::new()).collect();
        Bases { grid, units, kicks, rows }
    }

    /// The first clock of column i as the base of all its pairs.
    pub fn column(&self, column: u64) -> Option<Base> {
        let (a, b) = self.grid.ratio();
        Base::new(&self.strength(0, column), 0, self.grid.rows().1 * a / (column * b) + 1)
    }

    /// The second clock of row j as the base of all its pairs, if rows are shared at all.
    pub fn row(&self, row: u64) -> Option<&Base> {
        let (a, b) = self.grid.ratio();
        let make = || Base::new(&self.strength(1, row), 0, self.grid.columns().1 * b / (row * a) + 1);
        self.rows.get((row - self.grid.rows().0) as usize)?.get_or_init(make).as_ref()
    }

    /// The second clocks of all rows as bases of the pairs in the columns `first..=last`; empty where rows are shared.
    pub fn rows_within(&self, first: u64, last: u64) -> Vec<Option<Base>> {
        let ((a, b), (low, high)) = (self.grid.ratio(), self.grid.rows());
        if !self.rows.is_empty() {
            return Vec::new();
        }
        // Turns by the whole part of h1/h2, one less and one more.
        let turns = |column: u64, row: u64| column * b / (row * a);
        let make = |row| {
            Base::new(&self.strength(1, row), turns(first, row).saturating_sub(1), turns(last, row) + 1)
        };
        (low..=high).map(make).collect()
    }

    fn strength(&self, clock: usize, multiple: u64) -> Ball {
        self.units[clock]
            .mul(&Ball::from_integer(&BigInt::from(u128::from(multiple) * u128::from(multiple))), BITS)
    }

    /// The pair (i, j) on the clock that has more kicks, or on the other one; `None` where neither serves. `first`
    /// and `second` are asked for the column's or the row's base; `gcd` is that of the two steps in their common unit.
    #[inline(always)]
    pub fn pair<'b>(
        &self,
        first: impl Fn(u64) -> Option<&'b Base>,
        second: impl Fn(u64) -> Option<&'b Base>,
        (column, row): (u64, u64),
        gcd: u64,
    ) -> Option<Pair<'b>> {
        let (a, b) = self.grid.ratio();
        let (steps, product) = ((column * b, row * a), (column * row) as f64);
        let on_first = || Some(pair(first(column)?, self.kicks[0]? * product, (steps.1, steps.0), gcd));
        let on_second = || Some(pair(second(row)?, self.kicks[1]? * product, steps, gcd));
        if steps.1 >= steps.0 { on_first().or_else(on_second) } else { on_second().or_else(on_first) }
    }
}

/// The foreign clock's step is p base steps over q, both `gcd` times what they are in lowest terms.
#[inline(always)]
fn pair(base: &Base, kick: f64, (p, q): (u64, u64), gcd: u64) -> Pair<'_> {
    // n/gcd is odd where gcd holds all factors 2 of n.
    let odd = |n: u64| n.trailing_zeros() == gcd.trailing_zeros();
    Pair {
        base,
        kick,
        whole: p / q,
        rest: p % q,
        modulus: q,
        p_odd: odd(p),
        q_even: !odd(q),
        updates: q / gcd / 2,
    }
}
