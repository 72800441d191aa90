//! The unstable intervals next to one number, from stretches that cover its neighbourhood: searched for outwards, farther and farther.

use crate::error::Result;
use crate::system::vary::stretches::{Stretch, merged};
use crate::system::verdict::measured::Holds;

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

    /// Searched for from `number` > 0 outwards, down to half of it and up to twice, `stretches` covering a range; `own` is what is proven at
    /// the number itself, which parts what nothing is proven of on either side of it.
    ///
    /// # Errors
    /// The first error of `stretches`.
    pub fn search(
        (number, own): (f64, Holds),
        stretches: impl Fn((f64, f64)) -> Result<Vec<Stretch>>,
    ) -> Result<Nearest> {
        let mut covered = vec![Stretch { lo: number, hi: number, verdict: own }];
        for upwards in [false, true] {
            let (mut at, mut reach) = (number, FIRST);
            loop {
                let end = if upwards { number * (1.0 + reach) } else { number / (1.0 + reach) };
                let more = stretches(if upwards { (at, end) } else { (end, at) })?;
                covered = if upwards { [covered, more].concat() } else { [more, covered].concat() };
                covered = merged(covered.into_iter());
                let found = Nearest::of(number, &covered);
                // Searched until what is behind it is proven stable.
                let is_whole = if upwards {
                    found.above.is_some_and(|own| own.within.1.is_some())
                } else {
                    found.below.is_some_and(|own| own.within.0.is_some())
                };
                if is_whole || reach >= 1.0 {
                    break;
                }
                (at, reach) = (end, (2.0 * reach).min(1.0));
            }
        }
        Ok(Nearest::of(number, &covered))
    }

    /// From stretches that cover a range about the number.
    pub fn of(number: f64, all: &[Stretch]) -> Nearest {
        let runs: Vec<&[Stretch]> =
            all.split(|own| own.verdict == Holds::Stable).filter(|run| !run.is_empty()).collect();
        let ends = |run: &[Stretch]| (run[0].lo, run[run.len() - 1].hi);
        let searched = (all.first().map_or(number, |own| own.lo), all.last().map_or(number, |own| own.hi));
        let unstable = |run: &[Stretch]| {
            let told = || run.iter().filter(|own| own.verdict == Holds::Unstable);
            let (lo, hi) = ends(run);
            let proven = (told().next()?.lo, told().next_back()?.hi);
            let stable = || all.iter().filter(|own| own.verdict == Holds::Stable);
            let below = stable().rfind(|own| own.hi <= lo).map(|own| own.hi);
            let above = stable().find(|own| own.lo >= hi).map(|own| own.lo);
            Some(Unstable { proven, within: (below, above) })
        };
        let found: Vec<Unstable> = runs.iter().filter_map(|run| unstable(run)).collect();
        let own = runs.iter().find(|run| ends(run).0 <= number && number <= ends(run).1);
        let own = own.and_then(|run| unstable(run));
        let others = || found.iter().filter(|other| Some(**other) != own).copied();
        let below = others().rfind(|other| other.proven.1 <= number);
        let above = others().find(|other| other.proven.0 >= number);
        let near =
            (below.map_or(searched.0, |own| own.proven.1), above.map_or(searched.1, |own| own.proven.0));
        let untold = runs.iter().filter(|run| unstable(run).is_none()).map(|run| ends(run));
        let untold = untold.filter(|(lo, hi)| near.0 <= *lo && *hi <= near.1).collect();
        Nearest { number, searched, own, below, above, untold }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unstable in the given intervals and untold in the last, cells of one piece each.
    fn covered(unstable: &[(f64, f64)], untold: &[(f64, f64)], (lo, hi): (f64, f64)) -> Vec<Stretch> {
        let mut marks: Vec<f64> = unstable.iter().chain(untold).flat_map(|(a, b)| [*a, *b]).collect();
        marks.extend([lo, hi]);
        marks.retain(|x| (lo..=hi).contains(x));
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        let holds = |x: f64| {
            let is_in = |all: &[(f64, f64)]| all.iter().any(|(a, b)| *a < x && x < *b);
            match (is_in(unstable), is_in(untold)) {
                (true, _) => Holds::Unstable,
                (_, true) => Holds::NotTold,
                _ => Holds::Stable,
            }
        };
        let stretch =
            |ends: &[f64]| Stretch { lo: ends[0], hi: ends[1], verdict: holds((ends[0] + ends[1]) / 2.0) };
        merged(marks.windows(2).map(stretch))
    }

    #[test]
    fn the_next_intervals_are_found_whole_and_what_holds_the_number_is_no_neighbour() {
        let unstable = [(0.6, 0.7), (1.5, 1.6), (1.8, 1.85)];
        let untold = [(0.59, 0.6), (0.7, 0.71), (1.49, 1.5), (1.6, 1.61), (1.2, 1.21)];
        let found =
            Nearest::search((1.0, Holds::Stable), |range| Ok(covered(&unstable, &untold, range))).unwrap();
        let below = Unstable { proven: (0.6, 0.7), within: (Some(0.59), Some(0.71)) };
        let above = Unstable { proven: (1.5, 1.6), within: (Some(1.49), Some(1.61)) };
        assert_eq!((found.own, found.below, found.above), (None, Some(below), Some(above)));
        assert_eq!(found.untold, [(1.2, 1.21)]);
        assert!(found.searched.0 < 0.59 && found.searched.1 > 1.61 && found.searched.1 <= 2.0, "{found:?}");
        let inside =
            Nearest::search((1.55, Holds::Unstable), |range| Ok(covered(&unstable, &untold, range))).unwrap();
        assert_eq!(inside.own, Some(above));
        assert_eq!(inside.above.unwrap().proven, (1.8, 1.85));
        // 0.6 is below half of it.
        assert!(inside.below.is_none() && inside.searched.0 == 1.55 / 2.0, "{inside:?}");
        let alone =
            Nearest::search((1.0, Holds::Stable), |range| Ok(covered(&[(1.7, 3.0)], &[], range))).unwrap();
        assert_eq!(alone.above, Some(Unstable { proven: (1.7, 2.0), within: (Some(1.7), None) }));
        assert_eq!((alone.below, alone.searched), (None, (0.5, 2.0)));
    }
}
