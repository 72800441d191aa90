//! The base clocks of a grid, each made once: a column's first clock, a row's second.

use std::sync::OnceLock;

use num_bigint::BigInt;

use super::grid::Grid;
use crate::orbit::floquet::{Base, Pair, ordinary};
use crate::orbit::lanes::{Constants, InLanes};
use number::vector::{double_of, each, integer_of};
use number::{Ball, Laurent, Real, Ring};

/// Bits of what all bases share.
const BITS: u32 = 256;

/// The data that all bases of a grid share, and the bases of its rows as they are asked for.
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

    /// Whether one table of rows serves all bands.
    pub fn rows_are_shared(&self) -> bool {
        !self.rows.is_empty()
    }

    /// The second clock of row j as the base of pairs in the columns `first..=last`.
    pub fn row_within(&self, row: u64, first: u64, last: u64) -> Option<Base> {
        self.row_base(row, self.turns(first, row).saturating_sub(1), last)
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

    /// The pair (i, j) on the clock that has more kicks, or on the other one; `None` where neither serves.
    /// `first` and `second` are asked for the column's or the row's base; `gcd` is that of the two steps in
    /// their common unit.
    #[inline(always)]
    pub fn pair<'b>(
        &self,
        first: impl Fn(u64) -> Option<&'b Base>,
        second: impl Fn(u64) -> Option<&'b Base>,
        (column, row): (u64, u64),
        gcd: u64,
    ) -> Option<OnBase<'b>> {
        let (a, b) = self.grid.step_ratio();
        let (steps, product) = ([column * b, row * a], (column * row) as i64 as f64);
        let kick = |clock: usize| Some(self.kicks[clock]? * product);
        let on_first =
            || Some(OnBase { base: first(column)?, kick: kick(0)?, p: steps[1], q: steps[0], common: gcd });
        let on_second =
            || Some(OnBase { base: second(row)?, kick: kick(1)?, p: steps[0], q: steps[1], common: gcd });
        if steps[1] >= steps[0] { on_first().or_else(on_second) } else { on_second().or_else(on_first) }
    }
}

/// ⌊p/q⌋ for p below 2^50, by the faster division of doubles: where p/q is no integer it is 1/q below the
/// next one at least, more than p/q 2^-53, so that rounding does not reach that.
#[inline(always)]
pub(super) fn quotient(p: u64, q: u64) -> u64 {
    (p as i64 as f64 / q as i64 as f64) as i64 as u64
}

/// A pair on one of its bases: the other clock's kicks, of this strength, strike every p base steps over q,
/// whose greatest common divisor is `common`.
pub(super) struct OnBase<'b> {
    base: &'b Base,
    kick: f64,
    p: u64,
    q: u64,
    common: u64,
}

impl<'b> OnBase<'b> {
    /// ⌊q/2⌋ in lowest terms.
    pub fn updates(&self) -> u64 {
        quotient(self.q, self.common) / 2
    }

    pub fn pair(&self) -> Pair<'b> {
        let whole = quotient(self.p, self.q);
        // n/common is odd where `common` holds all factors 2 of n.
        let odd = |n: u64| n.trailing_zeros() == self.common.trailing_zeros();
        Pair {
            base: self.base,
            kick: self.kick,
            whole,
            rest: self.p - whole * self.q,
            modulus: self.q,
            p_odd: odd(self.p),
            q_even: !odd(self.q),
            updates: self.updates(),
        }
    }
}

/// The data of [`OnBase::pair`], in all lanes at a time.
impl InLanes for OnBase<'_> {
    #[inline(always)]
    fn constants<const L: usize>(pairs: &[Self]) -> (Constants<L>, [[f64; L]; 2]) {
        let (mut p, mut q, mut common) = ([0; L], [0; L], [0; L]);
        let zero = [0.0; L];
        let (mut kick, mut slope, mut sin) = (zero, zero, zero);
        for i in 0..L {
            let on_base = &pairs[i.min(pairs.len() - 1)];
            (p[i], q[i], common[i]) = (on_base.p, on_base.q, on_base.common);
            (kick[i], slope[i], sin[i]) = (on_base.kick, on_base.base.slope, on_base.base.sin);
        }
        // n/common is odd where the lowest bits of both are one.
        let odd = |n: &[u64; L]| -> [f64; L] {
            let lowest = |n: u64| n & n.wrapping_neg();
            each(|i| if lowest(n[i]) == lowest(common[i]) { 1.0 } else { 0.0 })
        };
        let [p_odd, q_odd] = [odd(&p), odd(&q)];
        let [p, q, common] = [p, q, common].map(|n| -> [f64; L] { each(|i| double_of(n[i])) });
        // See `quotient`: rounding never reaches the next whole number.
        let whole: [f64; L] = each(|i| (p[i] / q[i]).floor());
        let rest = each(|i| (-whole[i]).mul_add(q[i], p[i]));
        let updates: [f64; L] = each(|i| (0.5 * (q[i] / common[i])).floor());
        let last_kick = each(|i| 0.5 + 0.5 * q_odd[i]);
        // See `Pair::left`, for more than one update.
        let carried: [f64; L] = each(|i| {
            let half = 0.5 * (whole[i] + 1.0);
            let even = if half == half.floor() { 1.0 } else { 0.0 };
            if even == p_odd[i] { 1.0 } else { 0.0 }
        });
        let mut places = [0; L];
        for (place, whole) in places.iter_mut().zip(whole) {
            *place = integer_of(whole);
        }
        let (mut tan, mut sine, mut left) = ([zero; 2], [zero; 2], [zero; 2]);
        for i in 0..L {
            let on_base = &pairs[i.min(pairs.len() - 1)];
            let turns = on_base.base.turns_from(places[i]);
            for (carry, turn) in turns.iter().enumerate() {
                (tan[carry][i], sine[carry][i]) = (turn.tan, turn.sin);
            }
            [left[0][i], left[1][i]] = turns[usize::from(carried[i] > 0.0)].half;
            if updates[i] == 0.0 && q_odd[i] > 0.0 {
                [left[0][i], left[1][i]] = on_base.base.turn(places[i] - 1).half;
            }
        }
        let left = [
            each(|i| if q_odd[i] > 0.0 { left[0][i] } else { 1.0 }),
            each(|i| if q_odd[i] > 0.0 { left[1][i] } else { 0.0 }),
        ];
        (Constants { kick, slope, sin, modulus: q, rest, tan, sine, updates, last_kick }, left)
    }
}

#[cfg(test)]
mod tests {
    use super::{OnBase, quotient};
    use crate::orbit::floquet::Base;
    use crate::orbit::lanes::{Constants, InLanes};
    use num_integer::gcd;
    use number::{Ball, ratio};
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

        /// All at a time as one by one.
        #[test]
        fn lanes_hold_what_pairs_hold(all in prop::collection::vec((1u64..40, 1u64..40, 1u64..9), 1..17)) {
            let bases: Vec<Base> = (1..4).map(|s| Base::new(&Ball::from_rational(&ratio(s, 1), 200), 0, 41).unwrap()).collect();
            let pairs: Vec<OnBase> = all
                .iter()
                .map(|&(p, q, times)| {
                    let (p, q) = (times * p, times * q);
                    OnBase { base: &bases[(times % 3) as usize], kick: p as f64, p, q, common: gcd(p, q) }
                })
                .collect();
            let (found, left): (Constants<16>, _) = OnBase::constants(&pairs);
            for (i, on_base) in pairs.iter().enumerate() {
                let pair = on_base.pair();
                prop_assert_eq!([pair.whole, pair.rest, pair.updates], [on_base.p / on_base.q, on_base.p % on_base.q, on_base.q / on_base.common / 2]);
                let turn = |n: u64| on_base.base.turn(n);
                let turns = [turn(pair.whole), turn(pair.whole + 1)];
                prop_assert_eq!(found.tan.map(|tan| tan[i]), turns.map(|turn| turn.tan));
                prop_assert_eq!(found.sine.map(|sine| sine[i]), turns.map(|turn| turn.sin));
                prop_assert_eq!([found.rest[i], found.modulus[i], found.updates[i]], [pair.rest, pair.modulus, pair.updates].map(|n| n as f64));
                prop_assert_eq!([found.kick[i], found.slope[i], found.sin[i]], [on_base.kick, on_base.base.slope, on_base.base.sin]);
                prop_assert_eq!(found.last_kick[i], if pair.q_even { 0.5 } else { 1.0 });
                prop_assert_eq!(left.map(|left| left[i]), pair.left().map_or([1.0, 0.0], |n| turn(n).half));
            }
        }
    }
}
