//! Pairs that lie on no grid, side by side all the same.

use std::ops::Range;

use super::pairs::Pairs;
use super::resources::Resources;
use super::work::{LANES, MOST_TOGETHER, by_counting, in_groups};
use crate::orbit::filter::UNDECIDED;
use crate::orbit::strengths::{Placed, Strengths};
use crate::verdict::{Decision, Tier, Verdict};
use number::Result;
use number::parallel::try_map;

/// Pairs that are sorted by their strengths and their numbers of updates together: enough for each to find
/// company, few enough for the processor's caches.
const TOGETHER: usize = 1 << 15;

impl Pairs {
    /// The verdicts in the order of the pairs: those of [`decide_steps`](crate::verdict::decide_steps), with
    /// pairs of about the same number of updates run side by side.
    ///
    /// # Errors
    /// A pair whose steps have an irrational ratio, a budget error where one would compose more kicks than
    /// the limits allow, and `Stopped`.
    pub fn verdicts(&self, resources: &Resources) -> Result<Vec<Decision>> {
        let count = self.count();
        let parts: Vec<Range<usize>> =
            (0..count).step_by(TOGETHER).map(|first| first..count.min(first + TOGETHER)).collect();
        let done = resources
            .pool()?
            .install(|| try_map(&parts, |part: &Range<usize>| together(self, part.clone(), resources)))?;
        Ok(done.concat())
    }
}

/// Pairs on their way to their groups.
struct Unsorted {
    pairs: Vec<Placed>,
    /// The class and the number of updates, as far as they fit, of each: all that sorting looks at.
    ranks: Vec<(u32, u32)>,
}

impl Unsorted {
    fn of_at_most(count: usize) -> Self {
        Unsorted { pairs: Vec::with_capacity(count), ranks: Vec::with_capacity(count) }
    }

    #[inline(always)]
    fn push(&mut self, pair: Placed) {
        let Placed { strengths, .. } = &pair;
        self.ranks.push((strengths.class(), strengths.updates().min(1 << 26) as u32));
        self.pairs.push(pair);
    }

    /// Those together that suit each other: of like strength first, where there are so many that their
    /// numbers of updates are alike all the same, for a look costs three updates; then of like numbers of
    /// updates, then of like strength.
    fn sorted(&self) -> Vec<Placed> {
        let longest = 1 + self.ranks.iter().map(|&(_, updates)| updates).max().unwrap_or(0);
        let kinds = (self.pairs.len() as u32 / (2 * longest)).clamp(1, Strengths::CLASSES);
        let key = |&(class, updates): &(u32, u32)| {
            let kind = class * kinds / Strengths::CLASSES;
            (kind * longest + updates) * Strengths::CLASSES + class
        };
        by_counting(self.pairs.iter().copied(), &self.ranks.iter().map(key).collect::<Vec<u32>>())
    }
}

fn together(all: &Pairs, part: Range<usize>, resources: &Resources) -> Result<Vec<Decision>> {
    resources.go_on()?;
    let limits = &resources.limits;
    // The ladder says so where one is longer than the limits allow.
    let allowed = |pair: &Strengths| pair.updates() < limits.kicks.min(MOST_TOGETHER);
    let (first, mut unsorted) = (part.start, Unsorted::of_at_most(part.len()));
    all.strengths(part.clone(), |n, strengths| {
        if allowed(&strengths) {
            unsorted.push(Placed { strengths, place: (n - first) as u32 });
        }
    });
    let mut found = vec![UNDECIDED; part.len()];
    in_groups(&unsorted.sorted(), |mut group, pairs| {
        let mut rest = Vec::new();
        for pairs in pairs.chunks(LANES) {
            resources.go_on()?;
            for (pair, verdict) in pairs.iter().zip(group.verdicts(pairs)) {
                found[pair.place as usize] = verdict;
                if verdict == UNDECIDED {
                    rest.push(*pair);
                }
            }
        }
        Ok(rest)
    })?;
    resources.count(found.iter().filter(|&&verdict| verdict != UNDECIDED).count());
    let mut decisions = Vec::with_capacity(part.len());
    for (verdict, n) in found.into_iter().zip(part) {
        decisions.push(match verdict {
            UNDECIDED => {
                resources.go_on()?;
                resources.count(1);
                all.decide(n, limits)?
            }
            verdict => Decision { verdict: Verdict::ALL[usize::from(verdict)], decided_by: Tier::Filter },
        });
    }
    Ok(decisions)
}
