//! Pairs that lie on no grid, side by side all the same.

use std::ops::Range;

use super::resources::Resources;
use super::work::{LANES, in_groups};
use crate::error::Result;
use crate::orbit::filter::UNDECIDED;
use crate::orbit::floquet::{Floquet, Pair};
use crate::parallel::try_map;
use crate::propagator::TwoClocks;
use crate::verdict::{Decidable, Decision, Limits, Tier, Verdict, decide};

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
    decide_each(pairs, resources)
}

/// Where pairs come from.
pub(super) trait Source: Sync {
    fn count(&self) -> usize;

    /// The n-th pair in Floquet coordinates, where these serve.
    fn floquet(&self, n: usize) -> Result<Option<Floquet>>;

    /// Its verdict by the ladder.
    fn decide(&self, n: usize, limits: &Limits) -> Result<Decision>;
}

impl<S: Decidable + Sync> Source for [TwoClocks<S>] {
    fn count(&self) -> usize {
        self.len()
    }

    fn floquet(&self, n: usize) -> Result<Option<Floquet>> {
        Ok(Floquet::new(&self[n]))
    }

    fn decide(&self, n: usize, limits: &Limits) -> Result<Decision> {
        decide(&self[n], limits).map(|answer| answer.decision())
    }
}

/// The verdicts of all pairs of a source.
pub(super) fn decide_each<P: Source + ?Sized>(source: &P, resources: &Resources) -> Result<Vec<Decision>> {
    let count = source.count();
    let parts: Vec<Range<usize>> =
        (0..count).step_by(TOGETHER).map(|first| first..count.min(first + TOGETHER)).collect();
    let done = resources
        .pool()?
        .install(|| try_map(&parts, |part: &Range<usize>| together(source, part.clone(), resources)))?;
    Ok(done.concat())
}

fn together<P: Source + ?Sized>(
    source: &P,
    part: Range<usize>,
    resources: &Resources,
) -> Result<Vec<Decision>> {
    resources.go_on()?;
    let limits = &resources.limits;
    let floquets: Vec<Option<Floquet>> = part.clone().map(|n| source.floquet(n)).collect::<Result<_>>()?;
    // Longer ones than the limits allow are left to the ladder, which says so.
    let allowed = |floquet: &Floquet| floquet.updates() <= limits.kicks;
    let mut order: Vec<usize> =
        (0..floquets.len()).filter(|&n| floquets[n].as_ref().is_some_and(allowed)).collect();
    order.sort_by_key(|&n| floquets[n].as_ref().map(Floquet::updates));
    let mut found = vec![UNDECIDED; floquets.len()];
    in_groups(&order, |mut group, order| {
        for positions in order.chunks(LANES) {
            resources.go_on()?;
            let pairs: Vec<Pair> =
                positions.iter().filter_map(|&n| floquets[n].as_ref().map(Floquet::pair)).collect();
            positions.iter().zip(group.verdicts(&pairs)).for_each(|(&n, verdict)| found[n] = verdict);
        }
        Ok(order.iter().copied().filter(|&n| found[n] == UNDECIDED).collect())
    })?;
    let decided = |(verdict, n)| match verdict {
        UNDECIDED => {
            resources.go_on()?;
            source.decide(n, limits)
        }
        verdict => Ok(Decision { verdict: Verdict::ALL[usize::from(verdict)], decided_by: Tier::Filter }),
    };
    found.into_iter().zip(part).map(decided).collect()
}
