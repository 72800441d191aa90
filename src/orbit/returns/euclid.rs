//! Euclid's algorithm on the exchange of two intervals, and the walk from the deepest level up.
//!
//! Just after its kick k the slow clock stands at x = k p mod q, in units of 1/q, behind the last fast kick. Two branches lead to
//! the next: the left one on 0..a moves by b, the right one on a..a + b by −a. Inducing on the longer interval,
//!
//! ```text
//!     a ≥ b:  right(x) := right(x + b) left(x)  on a − b..a,     a := a − b
//!     a < b:  left(x)  := right(x + b) left(x)  on 0..a,         right on a..b,   b := b − a,
//! ```
//!
//! and k such steps at once are a [`Run`]. Heights times widths sum to q throughout, so all branches vary alike over their
//! intervals. The first n maps from x = 0 are a few returns of the deepest level whose heights fit, then of the next, and so on
//! (Ostrowski's numeration). All lengths and heights are exact.

use super::branch::{Branch, Budget};
use super::fit;
use super::map::Map;
use super::number::Coefficient;
use super::run::Run;

/// The two branches of one level; the longer one is the one that runs.
struct Level<T> {
    left: Run<T>,
    right: Run<T>,
    /// From its coordinates to those of the level above.
    back: Option<Map<T>>,
}

/// The product of the first n maps from x = 0, and the place reached; `None` where the budget or a bound does not last.
pub fn walk<T: Coefficient>(
    left: Branch<T>,
    right: Branch<T>,
    n: u128,
    budget: &mut Budget,
) -> Option<(Map<T>, i128)> {
    if n == 0 {
        return Some((Map::identity(), 0));
    }
    let (mut levels, mut product) = descend(left, right, n, budget)?;
    let (mut x, mut n) = (0, n);
    while let Some(mut level) = levels.pop() {
        while let Some((value, steps)) = level.next(x, n, budget)? {
            let (stride, height) = level.moves(x);
            product = value.after(&product);
            if !product.is_useful() {
                return None;
            }
            x += stride * steps as i128;
            n -= height * steps;
        }
        if let Some(back) = level.back {
            product = back.after(&product);
        }
    }
    debug_assert_eq!(n, 0);
    Some((product, x))
}

/// The levels as far as their returns fit into n < q maps, and what leads into the coordinates of the last: beyond, of the new
/// branch's factors only some are needed, which its level has. (The last return of all holds q of them.)
fn descend<T: Coefficient>(
    mut left: Branch<T>,
    mut right: Branch<T>,
    n: u128,
    budget: &mut Budget,
) -> Option<(Vec<Level<T>>, Map<T>)> {
    let (mut levels, mut entered) = (Vec::new(), Map::identity());
    loop {
        let (a, b) = (left.length, right.length);
        let back = fit::coordinates(&left.map, &right.map).map(|(there, back)| {
            for branch in [&mut left, &mut right] {
                branch.map = there.after(&branch.map).after(&back);
            }
            entered = there.after(&entered);
            back
        });
        let mut level = Level { left: Run::new(left.clone()), right: Run::new(right.clone()), back };
        if a >= b {
            let k = a / b;
            let rest = a - k * b;
            let height = right.height.saturating_add((k as u128).saturating_mul(left.height));
            if height > n {
                levels.push(level);
                break;
            }
            let map = {
                let first = level.left.product(k as u128, rest, b, budget)?;
                budget.product(&right.map, &first)?
            };
            right = Branch { map, start: rest, length: b, stride: -rest, height };
            left = left.restricted(0, rest);
        } else {
            let k = (b - 1) / a;
            let rest = b - k * a;
            let height = left.height.saturating_add((k as u128).saturating_mul(right.height));
            if height > n {
                levels.push(level);
                break;
            }
            let map = {
                let then = level.right.product(k as u128, b, a, budget)?;
                budget.product(&then, &left.map)?
            };
            left = Branch { map, start: 0, length: a, stride: rest, height };
            right = right.restricted(a, rest);
        }
        levels.push(level);
    }
    Some((levels, entered))
}

impl<T: Coefficient> Level<T> {
    fn is_left(&self, x: i128) -> bool {
        x < self.left.branch.length
    }

    /// The stride and the height of the branch that holds x.
    fn moves(&self, x: i128) -> (i128, u128) {
        let run = if self.is_left(x) { &self.left } else { &self.right };
        (run.branch.stride, run.branch.height)
    }

    /// As many steps of the branch that holds x as stay in it and fit into n maps; `None` where none does.
    #[allow(clippy::type_complexity)]
    fn next(&mut self, x: i128, n: u128, budget: &mut Budget) -> Option<Option<(Map<T>, u128)>> {
        let (a, b) = (self.left.branch.length, self.right.branch.length);
        let (run, stay) = if self.is_left(x) {
            (&mut self.left, (a - x + b - 1) / b)
        } else {
            (&mut self.right, (x - a) / a + 1)
        };
        let steps = (n / run.branch.height).min(stay as u128);
        if steps == 0 {
            return Some(None);
        }
        Some(Some((run.product(steps, x, 0, budget)?, steps)))
    }
}
