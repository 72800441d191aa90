//! The label of a tongue: how many half turns the growing solution makes in one period.
//!
//! Inside a tongue m half turns of the growing solution over the period are m/2 over its half, and the even
//! solution turns as far give or take less than one quarter turn; the signs of x and v at T/2 leave one m for
//! it.

use super::kind::{Kind, Verdict};
use crate::orbit::{filter, refine};

/// m, or `None` where the pair is not hyperbolic or the even solution's quarter at T/2 is not certain.
pub fn label(ends: &filter::Ends, verdict: Verdict) -> Option<u64> {
    let signs = ends.signs();
    if verdict.kind() != Kind::Hyperbolic || signs.a.is_none() || signs.c.is_none() {
        return None;
    }
    // The turn Θ lies in the quarter turn after `quarters`. Tr > 2: the nearest number of half turns to Θ/π
    // is m/2. Tr < -2: m/2 is the middle of the half turn in which Θ lies.
    let m = if verdict.side() > 0 {
        2 * (ends.quarters + 1).div_euclid(2)
    } else {
        2 * ends.quarters.div_euclid(2) + 1
    };
    u64::try_from(m).ok()
}

/// m from the sign changes n of the even solution over the half period. Where Tr > 2 the even solution has
/// turned by less than a quarter from n half turns, so m = 2n. Where Tr < −2 it has turned by (m/2) half
/// turns give or take a quarter: past n of them if x v < 0 at T/2 (it turns clockwise), before n if x v > 0.
pub(super) fn from_nodes(ends: &refine::Ends, verdict: Verdict) -> Option<u64> {
    use number::Sign::Negative;
    if verdict.kind() != Kind::Hyperbolic {
        return None;
    }
    let nodes = ends.even.nodes?;
    if verdict.side() > 0 {
        return Some(2 * nodes);
    }
    let (x, v) = ends.even.signs;
    if x? * v? == Negative { Some(2 * nodes + 1) } else { (2 * nodes).checked_sub(1) }
}
