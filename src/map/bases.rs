//! The base clocks of a grid, each made once: a column's first clock, a row's second.

use std::sync::OnceLock;

use num_bigint::BigInt;

use super::grid::Grid;
use crate::number::{Ball, Laurent, Real, Ring};
use crate::orbit::floquet::{Base, Pair, ordinary};

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
        let mut bases = Bases { grid, units, kicks, rows: Vec::new() };
        let ((low, high), last) = (grid.rows(), grid.columns().1);
        let add = |sum: u64, row| Some(sum + bases.turns(last, row) + 2).filter(|&sum| sum <= TURNS);
        if (low..=high).try_fold(0, add).is_some() {
            bases.rows.resize_with(grid.shape().1, OnceLock::new);
        }
        bases
    }

    /// The first clock of column i as the base of all its pairs.
    pub fn column(&self, column: u64) -> Option<Base> {
        let (a, b) = self.grid.step_ratio();
        Base::new(&self.strength(0, column), 0, self.grid.rows().1 * a / (column * b) + 1)
    }

    /// The second clock of row j as the base of all its pairs, if rows are shared at all.
    pub fn row(&self, row: u64) -> Option<&Base> {
        let make = || self.row_base(row, 0, self.grid.columns().1);
        self.rows.get((row - self.grid.rows().0) as usize)?.get_or_init(make).as_ref()
    }

    /// The second clocks of all rows as bases of the pairs in the columns `first..=last`; empty where rows are shared.
    pub fn rows_within(&self, first: u64, last: u64) -> Vec<Option<Base>> {
        if !self.rows.is_empty() {
            return Vec::new();
        }
        let (low, high) = self.grid.rows();
        (low..=high).map(|row| self.row_base(row, self.turns(first, row).saturating_sub(1), last)).collect()
    }

    /// The second clock of a row with the turns from `first` on that pairs up to column `last` make.
    fn row_base(&self, row: u64, first: u64, last: u64) -> Option<Base> {
        Base::new(&self.strength(1, row), first, self.turns(last, row) + 1)
    }

    /// ⌊h1/h2⌋: pairs turn by that many steps of the row's clock at a time, one less or one more.
    fn turns(&self, column: u64, row: u64) -> u64 {
        let (a, b) = self.grid.step_ratio();
        column * b / (row * a)
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
        let (a, b) = self.grid.step_ratio();
        let (steps, product) = ((column * b, row * a), (column * row) as f64);
        let on_first = || Some(pair(first(column)?, self.kicks[0]? * product, (steps.1, steps.0), gcd));
        let on_second = || Some(pair(second(row)?, self.kicks[1]? * product, steps, gcd));
        if steps.1 >= steps.0 { on_first().or_else(on_second) } else { on_second().or_else(on_first) }
    }
}

/// ⌊p/q⌋ for p below 2^50, by the faster division of doubles: where p/q is no integer it is 1/q below the next one at
/// least, more than p/q 2^-53, so that rounding does not reach that.
#[inline(always)]
pub(super) fn quotient(p: u64, q: u64) -> u64 {
    (p as i64 as f64 / q as i64 as f64) as i64 as u64
}

/// The foreign clock's step is p base steps over q, both `gcd` times what they are in lowest terms.
#[inline(always)]
fn pair(base: &Base, kick: f64, (p, q): (u64, u64), gcd: u64) -> Pair<'_> {
    let whole = quotient(p, q);
    // n/gcd is odd where gcd holds all factors 2 of n.
    let odd = |n: u64| n.trailing_zeros() == gcd.trailing_zeros();
    Pair {
        base,
        kick,
        whole,
        rest: p - whole * q,
        modulus: q,
        p_odd: odd(p),
        q_even: !odd(q),
        updates: quotient(q, gcd) / 2,
    }
}

#[cfg(test)]
mod tests {
    use super::quotient;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quotients_of_doubles_are_those_of_integers(q in 1u64..1 << 50, n in 0u64..1 << 25, off in 0u64..3) {
            let q = q >> (n % 50);
            prop_assume!(q > 0);
            // Next to multiples, where rounding could matter.
            let p = ((u128::from(n) * u128::from(q)).saturating_sub(off.into()) % (1 << 50)) as u64;
            prop_assert_eq!(quotient(p, q), p / q);
            prop_assert_eq!(quotient(q, p.max(1)), q / p.max(1));
        }
    }
}
