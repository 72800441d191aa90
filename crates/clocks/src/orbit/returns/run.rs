//! One branch many times: products of a slowly varying matrix function along an arithmetic progression.
//!
//! P_n(x) = F(x + (n − 1) d) … F(x + d) F(x), so P_2n(x) = P_n(x + n d) P_n(x). F varies by so much over its
//! interval of length L, and P_n by as much over a piece of length L/n. So there are about 2 n pieces on
//! which P_n is known, each as long as two of the next kind, and k/n places where it is asked for: a product
//! of k factors costs about √k products of functions. Its error grows by a factor per doubling, like a power
//! of k. From [`slow::worth`] factors on, [`Slow`] takes fewer and keeps it.

use super::branch::{Branch, Budget};
use super::coefficient::Coefficient;
use super::map::Map;
use super::slow::{self, Slow, after};
use super::wanted::Wanted;

/// log2 of the rows at a point that cost as much as one piece.
const LOG2_ROWS_A_PIECE: u32 = 3;

/// A branch and what is known of its products.
pub struct Run<T> {
    pub branch: Branch<T>,
    /// The relative error of a very long product allowed beside roundings.
    allowed: f64,
    wanted: Wanted,
    /// By the logarithm of n and the place: some dozens.
    pieces: Vec<((u32, i128), Branch<T>)>,
    /// The factors of very long products.
    slow: Option<Slow<T>>,
}

impl<T: Coefficient> Run<T> {
    pub fn new(branch: Branch<T>, allowed: f64, wanted: Wanted) -> Self {
        Run { branch, allowed, wanted, pieces: Vec::new(), slow: None }
    }

    /// P_n on start..start + length, or at a point; `None` where the budget or the bound does not last.
    pub fn product(&mut self, n: u128, start: i128, length: i128, budget: &mut Budget) -> Option<Map<T>> {
        if n >= slow::worth(self.wanted) {
            let slow = self.slow.get_or_insert_with(|| Slow::new(self.branch.clone(), self.allowed));
            return slow.product(n, start, length, budget);
        }
        let (mut product, mut from) = (None, start);
        let powers = (T::ROW..128 - n.leading_zeros()).rev().filter(|bit| n >> bit & 1 == 1);
        for log2 in powers {
            let next = self.power(log2, from, length, budget)?;
            product = Some(after(next, product, budget)?);
            from += self.branch.stride << log2;
        }
        match n % (1 << T::ROW) {
            0 => product,
            rest => after(self.few(rest as usize, from, length, budget)?, product, budget),
        }
    }

    /// P_n for n = 2^log2.
    fn power(&mut self, log2: u32, start: i128, length: i128, budget: &mut Budget) -> Option<Map<T>> {
        if log2 <= T::ROW {
            return self.few(1 << log2, start, length, budget);
        }
        let long = self.branch.length >> log2;
        // At a point, some factors cost less than a piece that is not known yet.
        let is_worth =
            || length > 0 || log2 >= T::ROW + LOG2_ROWS_A_PIECE || self.known(log2, start).is_some();
        if long >= 2.max(2 * length) && is_worth() {
            return Some(self.piece(log2, start, budget)?.on(start, length));
        }
        self.twice(log2, start, length, budget)
    }

    /// P_n for n that one row has.
    fn few(&self, n: usize, start: i128, length: i128, budget: &mut Budget) -> Option<Map<T>> {
        if n == 1 {
            return Some(self.branch.on(start, length));
        }
        budget.spend::<T>(1)?;
        if T::ROW > 0
            && let Some(row) = self.branch.row(n, start, length)
        {
            return Some(row);
        }
        let first = self.few(n / 2, start, length, budget)?;
        let from = start + self.branch.stride * (n / 2) as i128;
        let second = self.few(n - n / 2, from, length, budget)?;
        budget.product(&second, &first)
    }

    fn twice(&mut self, log2: u32, start: i128, length: i128, budget: &mut Budget) -> Option<Map<T>> {
        let first = self.power(log2 - 1, start, length, budget)?;
        let second = self.power(log2 - 1, start + (self.branch.stride << (log2 - 1)), length, budget)?;
        budget.product(&second, &first)
    }

    /// Where the pieces of length L/n begin of which one holds x and half a piece beyond it, in halves of
    /// one.
    fn place(&self, log2: u32, x: i128) -> i128 {
        (x - self.branch.start) / ((self.branch.length >> log2) / 2)
    }

    fn known(&self, log2: u32, x: i128) -> Option<usize> {
        let place = self.place(log2, x);
        self.pieces.iter().position(|piece| piece.0 == (log2, place))
    }

    /// The piece of length L/n that holds x and half a piece beyond it, as far as P_n is defined.
    fn piece(&mut self, log2: u32, x: i128, budget: &mut Budget) -> Option<&Branch<T>> {
        let known = match self.known(log2, x) {
            Some(known) => known,
            None => {
                let Branch { start, length, stride, .. } = self.branch;
                let (long, place) = (length >> log2, self.place(log2, x));
                // All of x, x + d, ..., x + (n − 1) d lie in the branch's interval.
                let reach = stride * ((1 << log2) - 1);
                let (least, end) = (start.max(start - reach), (start + length).min(start + length - reach));
                let from = (start + place * (long / 2)).min(end - long).max(least);
                let long = long.min(end - from);
                let map = self.twice(log2, from, long, budget)?;
                let piece = Branch { map, start: from, length: long, stride: 0, height: 0 };
                self.pieces.push(((log2, place), piece));
                self.pieces.len() - 1
            }
        };
        Some(&self.pieces[known].1)
    }
}
