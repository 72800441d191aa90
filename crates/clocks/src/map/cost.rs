//! The cost of a map, stated before it begins.

use super::grid::Grid;
use super::shard::Shard;
use super::work::MOST_TOGETHER;
use crate::verdict::Limits;
use number::{Error, Ratio, Result};

/// A map as a whole may compose so many times the kicks that one pair may: with the default limits 10^12.
const TIMES_A_PAIR: u64 = 10_000;

/// Pairs whose kicks are counted for an estimate.
const SAMPLE: u64 = 1 << 16;

impl Grid {
    /// How many kicks the verdicts compose, Σ (min(p, q)/2 + 1), with as much as a long period's return maps
    /// cost at most: exact for grids of up to 2^16 pairs, else from as many of them, drawn the same way each
    /// time. min(p, q) varies by about as much as its mean, so the estimate is off by 0.4 %, one standard
    /// deviation.
    pub fn kicks(&self) -> f64 {
        let pairs = self.pairs();
        let kicks = |ratio: Ratio| (ratio.p().min(ratio.q()) / 2 + 1).min(MOST_TOGETHER) as f64;
        let sum: f64 = self.sampled().map(kicks).sum();
        if pairs <= SAMPLE { sum } else { sum / SAMPLE as f64 * pairs as f64 }
    }

    /// The ratios of some pairs spread over the grid, of all where these are few.
    pub(super) fn sampled(&self) -> impl Iterator<Item = Ratio> {
        let (pairs, rows) = (self.pairs(), self.shape().1 as u64);
        let n = move |n| if pairs <= SAMPLE { n } else { scattered(n, pairs) };
        (0..pairs.min(SAMPLE))
            .map(n)
            .map(move |n| self.ratio(self.columns().0 + n / rows, self.rows().0 + n % rows))
    }

    /// No pair costs more kicks than this.
    pub fn longest(&self) -> u64 {
        let (a, b) = self.step_ratio();
        ((self.columns().1 * b).min(self.rows().1 * a) / 2 + 1).min(MOST_TOGETHER)
    }
}

/// A number below `pairs`, one for each n (SplitMix64).
fn scattered(n: u64, pairs: u64) -> u64 {
    let mut x = (n + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((u128::from(x ^ (x >> 31)) * u128::from(pairs)) >> 64) as u64
}

/// The time that so many kicks take a core: a nanosecond each, or less.
fn time(kicks: f64) -> String {
    let seconds = kicks * 1e-9;
    let units = [("days", 86_400.0), ("hours", 3600.0), ("minutes", 60.0), ("seconds", 1.0)];
    let unit = units.into_iter().find(|(_, unit)| seconds >= 2.0 * unit);
    unit.map_or("a second or two".into(), |(name, unit)| format!("some {:.0} {name}", seconds / unit))
}

/// # Errors
/// A budget error that states the cost where this part of the map exceeds the limit.
pub(super) fn allow(grid: &Grid, shard: Shard, limits: &Limits) -> Result<()> {
    let (pairs, most) = (shard.pairs(grid), limits.kicks.saturating_mul(TIMES_A_PAIR) as f64);
    // Most maps need no estimate.
    if pairs as f64 * grid.longest() as f64 <= most {
        return Ok(());
    }
    let kicks = grid.kicks() * (pairs as f64 / grid.pairs() as f64);
    if kicks <= most {
        return Ok(());
    }
    let cost =
        format!("a map of {pairs} pairs composes about {kicks:.1e} kicks, {} of one core", time(kicks));
    let needed = ((kicks / TIMES_A_PAIR as f64).ceil() as u64).max(grid.longest() + 1);
    Err(Error::budget(cost, needed).or("choose a larger step, a smaller window, or a part of the map"))
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_cost_is_stated_in_the_unit_that_fits_it() {
        let times = [2.6e5, 4e9, 1e12, 1e13, 1e15].map(super::time);
        assert_eq!(
            times,
            ["a second or two", "some 4 seconds", "some 17 minutes", "some 3 hours", "some 12 days"]
        );
    }
}
