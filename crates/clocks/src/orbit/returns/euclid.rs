//! Euclid's algorithm on the exchange of two intervals, and the walk from the deepest level up.
//!
//! Just after its kick k the slow clock stands at x = k p mod q, in units of 1/q, behind the last fast kick.
//! Two branches lead to the next: the left one on 0..a moves by b, the right one on a..a + b by −a. Inducing
//! on the longer interval,
//!
//! ```text
//!     a ≥ b:  right(x) := right(x + b) left(x)  on a − b..a,     a := a − b
//!     a < b:  left(x)  := right(x + b) left(x)  on 0..a,         right on a..b,   b := b − a,
//! ```
//!
//! and k such steps at once are a [`Run`]. Heights times widths sum to q throughout, so all branches vary
//! alike over their intervals. The first n maps from x = 0 are a few returns of the deepest level whose
//! heights fit, then of the next, and so on (Ostrowski's numeration). All lengths and heights are exact.
//!
//! An orbit of n maps passes through a level's branches some (a + b)/2 times, each of which adds its
//! rounding. So the levels above, of many passes, want more bits than those below, and a branch is rounded as
//! soon as what is left is known well enough so.

use super::branch::{Branch, Budget};
use super::coefficient::Coefficient;
use super::cone;
use super::fit;
use super::map::Map;
use super::run::Run;
use super::wanted::Wanted;
use number::Sign;

/// The two branches of one level; the longer one is the one that runs.
struct Level<T> {
    left: Run<T>,
    right: Run<T>,
}

/// The product of the maps so far, the place reached, and how many maps are left.
pub struct Reached<P> {
    pub product: Map<P>,
    pub x: i128,
    pub left: u128,
}

/// How a walk ends.
pub enum Walked<P> {
    Reached(Reached<P>),
    /// The period grows, with this sign of Tr Q.
    Grows(Sign),
}

/// The highest sum of the roundings of all passes through a level: a result that is known less well has few
/// digits.
const ROUNDINGS: f64 = 1.0 / 32768.0;

/// The terms left out of a level's products may add up to this share of the error that long products may
/// have, or to that of what rounding costs the result.
const LEFT_OUT: f64 = 1e-3;
const LEFT_OUT_BESIDE_ROUNDING: f64 = 1.0 / 1024.0;

/// What the terms left out of a level's products may add up to, of an orbit over q places.
pub fn left_out<T: Coefficient, P: Coefficient>(q: u128) -> f64 {
    let rounding = if T::BITS > P::BITS { most_roundings::<P>() } else { q as f64 * P::UNIT };
    (LEFT_OUT * P::CLOSE).max(LEFT_OUT_BESIDE_ROUNDING * rounding.min(most_roundings::<P>()))
}

fn most_roundings<P: Coefficient>() -> f64 {
    ROUNDINGS * (P::UNIT / f64::UNIT).sqrt()
}

/// Whether a level's branches may be known to these numbers' digits, where the product is wanted to those of
/// P.
fn suffices<T: Coefficient, P: Coefficient>(passes: i128) -> bool {
    passes as f64 * T::UNIT <= most_roundings::<P>()
}

/// The first n maps from x = 0 after `entered`, to the digits of P, or where the verdict alone is wanted, the
/// level that shows that the period grows; `None` where the budget or a bound does not last.
pub fn walk<T: Coefficient, P: Coefficient>(
    mut left: Branch<T>,
    mut right: Branch<T>,
    n: u128,
    mut entered: Map<P>,
    left_out: f64,
    wanted: Wanted,
    budget: &mut Budget,
) -> Option<Walked<P>> {
    if T::BITS > P::BITS && suffices::<T::Lower, P>(left.length + right.length) {
        return walk::<T::Lower, P>(left.rounded(), right.rounded(), n, entered, left_out, wanted, budget);
    }
    // The terms left out of a product add an error on each pass.
    let least = left_out / (left.length + right.length) as f64;
    [&mut left, &mut right].into_iter().for_each(|branch| branch.map.least = branch.map.least.max(least));
    let back = fit::coordinates(&left.map, &right.map).map(|(there, back)| {
        for branch in [&mut left, &mut right] {
            branch.map = there.after(&branch.map).after(&back);
        }
        entered = there.rounded().after(&entered);
        back
    });
    if wanted == Wanted::Verdict
        && let Some(sign) = cone::trace_sign(&left, &right)
    {
        return Some(Walked::Grows(sign));
    }
    // So often, and oftener than any branch below, is the next level's new one passed through.
    let allowed = P::CLOSE / left.length.min(right.length) as f64;
    let [left, right] = [left, right].map(|branch| Run::new(branch, allowed, wanted));
    let mut level = Level { left, right };
    let mut reached = match level.induced(n, budget)? {
        Some([left, right]) => match walk(left, right, n, entered, left_out, wanted, budget)? {
            Walked::Reached(reached) => reached,
            grows => return Some(grows),
        },
        None => Reached { product: entered, x: 0, left: n },
    };
    while let Some((value, steps)) = level.next(&reached, budget)? {
        let (stride, height) = level.moves(reached.x);
        let product = value.rounded().after(&reached.product);
        if !product.is_useful() {
            return None;
        }
        reached =
            Reached { product, x: reached.x + stride * steps as i128, left: reached.left - height * steps };
    }
    if let Some(back) = back {
        reached.product = back.rounded().after(&reached.product);
    }
    Some(Walked::Reached(reached))
}

impl<T: Coefficient> Level<T> {
    /// The branches of the next level; within `Some`, `None` where the new one's return does not fit into n <
    /// q maps: beyond, only some of its factors are needed, which this level has. (The last return of all
    /// holds q of them.)
    #[allow(clippy::option_option, clippy::type_complexity)]
    fn induced(&mut self, n: u128, budget: &mut Budget) -> Option<Option<[Branch<T>; 2]>> {
        let Level { left, right } = self;
        let (a, b) = (left.branch.length, right.branch.length);
        let height = |run: &Run<T>, k: i128, other: &Run<T>| {
            Some(run.branch.height.saturating_add((k as u128).saturating_mul(other.branch.height)))
                .filter(|&height| height <= n)
        };
        if a >= b {
            let k = a / b;
            let rest = a - k * b;
            let Some(height) = height(right, k, left) else { return Some(None) };
            let first = left.product(k as u128, rest, b, budget)?;
            let map = budget.product(&right.branch.map, &first)?;
            let right = Branch { map, start: rest, length: b, stride: -rest, height };
            Some(Some([left.branch.restricted(0, rest), right]))
        } else {
            let k = (b - 1) / a;
            let rest = b - k * a;
            let Some(height) = height(left, k, right) else { return Some(None) };
            let then = right.product(k as u128, b, a, budget)?;
            let map = budget.product(&then, &left.branch.map)?;
            let left = Branch { map, start: 0, length: a, stride: rest, height };
            Some(Some([left, right.branch.restricted(a, rest)]))
        }
    }

    fn is_left(&self, x: i128) -> bool {
        x < self.left.branch.length
    }

    /// The stride and the height of the branch that holds x.
    fn moves(&self, x: i128) -> (i128, u128) {
        let run = if self.is_left(x) { &self.left } else { &self.right };
        (run.branch.stride, run.branch.height)
    }

    /// As many steps of the branch that holds the place reached as stay in it and fit into the maps left;
    /// `None` where none does.
    #[allow(clippy::type_complexity)]
    fn next<P>(&mut self, reached: &Reached<P>, budget: &mut Budget) -> Option<Option<(Map<T>, u128)>> {
        let &Reached { x, left: n, .. } = reached;
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
