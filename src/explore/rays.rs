//! Which ratios a window shows.

use num_bigint::BigInt;

use number::{Ratio, Rational};

/// All p/q in lowest terms with p + q ≤ `most` in a closed range of ratios (no upper end: `None`), by p + q,
/// then p; `None` where there are more than `count`.
///
/// Down the tree of Stern and Brocot, whose every node's p + q exceeds its parent's: what lies outside or is
/// too long is left out with all that is below it.
pub(super) fn ratios(range: &(Rational, Option<Rational>), most: u64, count: usize) -> Option<Vec<Ratio>> {
    let (lo, hi) = range;
    let below = |p: u64, q: u64| BigInt::from(p) * lo.denom() < lo.numer() * BigInt::from(q);
    let above = |p: u64, q: u64| {
        hi.as_ref().is_some_and(|hi| BigInt::from(p) * hi.denom() > hi.numer() * BigInt::from(q))
    };
    let (mut found, mut open) = (Vec::new(), vec![((0, 1), (1, 0))]);
    while let Some(((a, b), (c, d))) = open.pop() {
        let (p, q) = (a + c, b + d);
        if p + q > most {
            continue;
        }
        let (low, high) = (below(p, q), above(p, q));
        if !low && !high {
            if found.len() == count {
                return None;
            }
            found.push(Ratio::new(p, q).expect("positive and small"));
        }
        if !low {
            open.push(((a, b), (p, q)));
        }
        if !high {
            open.push(((p, q), (c, d)));
        }
    }
    found.sort_unstable_by_key(|ratio| (ratio.kicks(), ratio.p()));
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    #[test]
    fn the_tree_gives_what_trial_does() {
        for (lo, hi) in
            [(ratio(0, 1), None), (ratio(5, 2), Some(ratio(7, 2))), (ratio(1, 97), Some(ratio(1, 3)))]
        {
            let within = |r: &Ratio| {
                Rational::from(*r) >= lo && hi.as_ref().is_none_or(|hi| Rational::from(*r) <= *hi)
            };
            let all: Vec<Ratio> = Ratio::up_to(60).filter(within).collect();
            assert!(all.len() > 20);
            assert_eq!(ratios(&(lo.clone(), hi.clone()), 60, 10_000).unwrap(), all);
            assert!(ratios(&(lo.clone(), hi.clone()), 60, all.len() - 1).is_none());
        }
    }
}
