//! Pairs that lie on no grid, side by side all the same.

use super::resources::Resources;
use super::work::{LANES, in_groups};
use crate::error::Result;
use crate::orbit::filter::UNDECIDED;
use crate::orbit::floquet::{Floquet, Pair};
use crate::parallel::try_map;
use crate::propagator::TwoClocks;
use crate::verdict::{Decidable, Decision, Tier, Verdict, decide};

/// Pairs that are sorted by their numbers of updates together: enough for each to find company.
const TOGETHER: usize = 1 << 14;

/// The verdicts of any pairs, in their order: those of [`decide`], with pairs of about the same number of updates run
/// side by side.
///
/// ```
/// use kickdrift::map::{Resources, decide_all};
/// use kickdrift::number::{Ratio, rational::ratio};
/// use kickdrift::propagator::TwoClocks;
/// use kickdrift::verdict::{Limits, decide};
/// let steps = Ratio::new(7, 3).unwrap();
/// let pairs: Vec<_> = (1..200).map(|n| TwoClocks::with_rho(steps, ratio(n, 60), ratio(1, 25))).collect();
/// let decisions = decide_all(&pairs, &Resources::default()).unwrap();
/// assert_eq!(decisions[70].verdict, decide(&pairs[70], &Limits::default()).unwrap().verdict);
/// ```
///
/// # Errors
/// A budget error where a pair would compose more kicks than the limits allow, and `Stopped`.
pub fn decide_all<S: Decidable + Sync>(
    pairs: &[TwoClocks<S>],
    resources: &Resources,
) -> Result<Vec<Decision>> {
    let some = |pairs: &&[TwoClocks<S>]| together(pairs, resources);
    let chunks: Vec<_> = pairs.chunks(TOGETHER).collect();
    let done = resources.pool()?.install(|| try_map(&chunks, some))?;
    Ok(done.concat())
}

fn together<S: Decidable>(clocks: &[TwoClocks<S>], resources: &Resources) -> Result<Vec<Decision>> {
    let limits = &resources.limits;
    let floquets: Vec<Option<Floquet>> = clocks.iter().map(Floquet::new).collect();
    // Longer ones than the limits allow are left to `decide`, which says so.
    let allowed = |floquet: &Floquet| floquet.updates() <= limits.kicks;
    let mut order: Vec<usize> =
        (0..clocks.len()).filter(|&n| floquets[n].as_ref().is_some_and(allowed)).collect();
    order.sort_by_key(|&n| floquets[n].as_ref().map(Floquet::updates));
    let mut found = vec![UNDECIDED; clocks.len()];
    in_groups(&order, |mut group, order| {
        for positions in order.chunks(LANES) {
            resources.go_on()?;
            let pairs: Vec<Pair> =
                positions.iter().filter_map(|&n| floquets[n].as_ref().map(Floquet::pair)).collect();
            positions.iter().zip(group.verdicts(&pairs)).for_each(|(&n, verdict)| found[n] = verdict);
        }
        Ok(order.iter().copied().filter(|&n| found[n] == UNDECIDED).collect())
    })?;
    let decided = |(verdict, clocks)| match verdict {
        UNDECIDED => {
            resources.go_on()?;
            decide(clocks, limits).map(|answer| answer.decision())
        }
        verdict => Ok(Decision { verdict: Verdict::ALL[usize::from(verdict)], decided_by: Tier::Filter }),
    };
    found.into_iter().zip(clocks).map(decided).collect()
}
