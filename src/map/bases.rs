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
    rows: Vec<OnceLock<Option<Base>>>,
}

impl<'a> Bases<'a> {
    pub fn new(grid: &'a Grid) -> Self {
        let ((lambda1, lambda2), (d1, d2)) = (grid.lambdas(), grid.steps());
        let product = |a: &Laurent, b: &Laurent, c: &Laurent| Laurent::product(&Laurent::product(a, b), c);
        let units = [product(d1, d1, lambda1), product(d2, d2, lambda2)].map(|x| x.enclosure(BITS));
        let kicks = [lambda2, lambda1].map(|lambda| ordinary(&product(d1, d2, lambda).enclosure(BITS)));
        let rows = (0..grid.shape().1).map(|_| OnceLock::new()).collect();
        Bases { grid, units, kicks, rows }
    }

    /// The first clock of column i as the base of all its pairs.
    pub fn column(&self, column: u64) -> Option<Base> {
        let (a, b) = self.grid.ratio();
        Base::new(&self.strength(0, column), 0, self.grid.rows().1 * a / (column * b) + 1)
    }

    /// The second clock of row j as the base of all its pairs.
    pub fn row(&self, row: u64) -> Option<&Base> {
        let (a, b) = self.grid.ratio();
        let make = || Base::new(&self.strength(1, row), 0, self.grid.columns().1 * b / (row * a) + 1);
        self.rows[(row - self.grid.rows().0) as usize].get_or_init(make).as_ref()
    }

    fn strength(&self, clock: usize, multiple: u64) -> Ball {
        self.units[clock]
            .mul(&Ball::from_integer(&BigInt::from(u128::from(multiple) * u128::from(multiple))), BITS)
    }

    /// The pair (i, j) on the clock that has more kicks, or on the other one; `None` where neither serves.
    /// `gcd` is that of the two steps in their common unit.
    #[inline(always)]
    pub fn pair<'b>(
        &'b self,
        first: Option<&'b Base>,
        (column, row): (u64, u64),
        gcd: u64,
    ) -> Option<Pair<'b>> {
        let (a, b) = self.grid.ratio();
        let (steps, product) = ((column * b, row * a), (column * row) as f64);
        let on_first = || Some(pair(first?, self.kicks[0]? * product, (steps.1, steps.0), gcd));
        let on_second = || Some(pair(self.row(row)?, self.kicks[1]? * product, steps, gcd));
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
