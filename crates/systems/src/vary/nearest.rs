//! The unstable intervals next to one number, from stretches that cover its neighbourhood: searched for
//! outwards, farther and farther.

use crate::vary::stretches::{self, Stretch, merged};
use crate::verdict::measured::Holds;
use number::Result;

/// Neighbours that no proven stable number separates, some of them unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unstable {
    /// The first and the last number proven unstable.
    pub proven: (f64, f64),
    /// The last below and the first above that are proven stable; `None` beyond what was searched.
    pub within: (Option<f64>, Option<f64>),
}

/// The unstable intervals next to a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    pub number: f64,
    /// All between is covered.
    pub searched: (f64, f64),
    /// The one that holds the number itself.
    pub own: Option<Unstable>,
    /// The next one; `None`: between the number and the end of what was searched none is.
    pub below: Option<Unstable>,
    pub above: Option<Unstable>,
    /// Stretches no farther than these where nothing is proven, what is next to them being stable.
    pub untold: Vec<(f64, f64)>,
}

/// The first part of a number that is searched; twice as far each time.
const FIRST: f64 = 1.0 / 32.0;

impl Nearest {
    /// Half of it and twice it.
    pub fn reach(number: f64) -> (f64, f64) {
        (number / 2.0, number * 2.0)
    }

    /// The ranges from a number outwards, which [`Nearest::search`] covers one after the other.
    fn ranges(number: f64, upwards: bool) -> impl Iterator<Item = (f64, f64)> {
        let reaches = std::iter::successors(Some(FIRST), |reach| (*reach < 1.0).then_some(2.0 * reach));
        let ends = reaches.map(move |far| if upwards { number * (1.0 + far) } else { number / (1.0 + far) });
        ends.scan(number, move |at, end| {
            let before = std::mem::replace(at, end);
            Some(if upwards { (before, end) } else { (end, before) })
        })
    }

    /// The most cells that a search asks about, roughly.
    pub fn most_cells(number: f64, width: f64) -> f64 {
        let ranges = [false, true].into_iter().flat_map(|upwards| Nearest::ranges(number, upwards));
        ranges.map(|range| stretches::most_cells(range, width)).sum()
    }

    /// Searched for from `number` > 0 outwards, down to half of it and up to twice, `stretches` covering a
    /// range; `own` is what is proven at the number itself, which parts what nothing is proven of on either
    /// side of it.
    ///
    /// # Errors
    /// The first error of `stretches`.
    pub fn search(
        (number, holds): (f64, Holds),
        stretches: impl Fn((f64, f64)) -> Result<Vec<Stretch>>,
    ) -> Result<Nearest> {
        let mut covered = vec![Stretch { lo: number, hi: number, verdict: holds }];
        for upwards in [false, true] {
            for range in Nearest::ranges(number, upwards) {
                let more = stretches(range)?;
                covered = if upwards { [covered, more].concat() } else { [more, covered].concat() };
                covered = merged(covered.into_iter());
                let found = Nearest::of(number, &covered);
                // Searched until what is behind it is proven stable.
                let is_whole = if upwards {
                    found.above.is_some_and(|above| above.within.1.is_some())
                } else {
                    found.below.is_some_and(|below| below.within.0.is_some())
                };
                if is_whole {
                    break;
                }
            }
        }
        Ok(Nearest::of(number, &covered))
    }

    /// From stretches that cover a range about the number.
    pub fn of(number: f64, all: &[Stretch]) -> Nearest {
        let runs: Vec<&[Stretch]> =
            all.split(|stretch| stretch.verdict == Holds::Stable).filter(|run| !run.is_empty()).collect();
        let ends = |run: &[Stretch]| (run[0].lo, run[run.len() - 1].hi);
        let searched = (
            all.first().map_or(number, |stretch| stretch.lo),
            all.last().map_or(number, |stretch| stretch.hi),
        );
        let unstable = |run: &[Stretch]| {
            let proven = || run.iter().filter(|stretch| stretch.verdict == Holds::Unstable);
            let (lo, hi) = ends(run);
            let proven = (proven().next()?.lo, proven().next_back()?.hi);
            let stable = || all.iter().filter(|stretch| stretch.verdict == Holds::Stable);
            let below = stable().rfind(|stable| stable.hi <= lo).map(|stretch| stretch.hi);
            let above = stable().find(|stretch| stretch.lo >= hi).map(|stretch| stretch.lo);
            Some(Unstable { proven, within: (below, above) })
        };
        let found: Vec<Unstable> = runs.iter().filter_map(|run| unstable(run)).collect();
        let stretches = runs.iter().find(|run| ends(run).0 <= number && number <= ends(run).1);
        let own = stretches.and_then(|run| unstable(run));
        let others = || found.iter().filter(|other| Some(**other) != own).copied();
        let below = others().rfind(|other| other.proven.1 <= number);
        let above = others().find(|other| other.proven.0 >= number);
        let near = (
            below.map_or(searched.0, |unstable| unstable.proven.1),
            above.map_or(searched.1, |unstable| unstable.proven.0),
        );
        let untold = runs.iter().filter(|run| unstable(run).is_none()).map(|run| ends(run));
        let untold = untold.filter(|(lo, hi)| near.0 <= *lo && *hi <= near.1).collect();
        Nearest { number, searched, own, below, above, untold }
    }
}
