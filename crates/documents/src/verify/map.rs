//! A map: its counts by the map's own certified route again, a sample of its pairs kick by kick.

use serde_json::Value;

use super::again::Recheck;
use super::context::{Checked, Context, Failure, Fault, Options, Outcome, holds};
use super::exact::again;
use super::sample::sample;
use super::written::{Ends, Written};
use crate::question::{Map, Question};
use crate::report::map::MapTally;
use clocks::map::{Band, Grid};
use clocks::verdict::{Tier, growth};
use number::error::{Error, Result};
use number::parallel::try_map;
use number::{Ball, Laurent, Real};

const ROUTE: &str = "the pairs of a random sample kick by kick";
const ALL: &str = "every pair kick by kick";

/// Pairs that are decided kick by kick, unless all are asked for.
const SAMPLE: u64 = 2000;

rows! {
    /// `kickdrift/map/1`.
    pub struct Claim {
        input: Map,
        fastest: Option<Fastest>,
    }

    struct Fastest {
        h1: Written<Laurent>,
        h2: Written<Laurent>,
        growth_rate: Ends,
        steps_until_tenfold: Ends,
    }
}

/// Findings on the way through the bands.
pub struct Found {
    grid: Grid,
    /// No pair is proven to grow faster.
    rate: f64,
    /// Pairs that are decided otherwise kick by kick.
    failures: Vec<Failure>,
}

impl Claim {
    /// The kicks of the other route.
    pub fn work(&self, options: &Options) -> Result<u64> {
        const PROBES: u64 = 1000;
        let grid = self.input.grid()?;
        let kicks = |n: u64| {
            let (i, j) = place(&grid, n);
            grid.ratio(i, j).kicks() / 2
        };
        let probes = sample(&grid.fingerprint(), grid.pairs(), PROBES);
        let sum: u64 = probes.iter().map(|&n| kicks(n)).sum();
        let pairs = grid.pairs().min(most(&grid, options));
        Ok((u128::from(sum) * u128::from(pairs) / probes.len() as u128).try_into().unwrap_or(u64::MAX))
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "rows";
    type Found = Found;

    fn again(&self, context: &Context) -> Result<(Value, Found)> {
        let grid = self.input.grid()?;
        let (pairs, limit) = (grid.pairs(), context.limits().kicks);
        if pairs > limit {
            return Err(Error::budget(
                format!("deciding {pairs} pairs again, where {limit} are allowed"),
                pairs,
            ));
        }
        let drawn = sample(&grid.fingerprint(), pairs, most(&grid, context.options));
        let (mut tally, mut rate, mut failures) = (MapTally::default(), 0.0_f64, Vec::new());
        let (mut next, mut done) = (drawn.as_slice(), 0);
        self.input.each(&grid, &context.work(), |band| {
            let pairs = band.verdicts.len() as u64;
            let (counts, rest) = next.split_at(next.partition_point(|&n| n < done + pairs));
            let one = |&n: &u64| kick_by_kick(&grid, &band, (n - done) as usize, context);
            failures.extend(try_map(counts, one)?.into_iter().flatten());
            tally.add(&grid, &band);
            for growing in &band.growing {
                let (i, j) = band.multipliers(&grid, growing.position as usize);
                let period = grid.ratio(i, j).p() as f64 * i as f64 * grid.steps().0.to_f64();
                rate = rate.max(growing.rate(period).map_or(0.0, |rate| rate.lo));
            }
            (next, done) = (rest, done + pairs);
            context.see.inspect(|see| see(done, grid.pairs()));
            Ok(())
        })?;
        Ok((self.input.document(&tally).value(), Found { grid, rate, failures }))
    }

    fn check(&self, found: Found, context: &Context) -> Result<Outcome> {
        let Found { grid, rate, mut failures } = found;
        let (most, pairs) = (most(&grid, context.options), grid.pairs());
        let fastest = self.fastest(&grid, rate, context);
        failures.extend(context.failure(0, || "the fastest pair".into(), fastest)?);
        Ok(Outcome {
            rows: 1,
            route: if most < pairs { ROUTE } else { ALL },
            sample: Some((most.min(pairs), pairs)),
            failures,
            not_rechecked: Vec::new(),
        })
    }
}

impl Claim {
    /// The fastest pair grows as fast as is written, and no other one faster.
    fn fastest(&self, grid: &Grid, largest: f64, context: &Context) -> Checked {
        let due = self.input.growth && largest > 0.0;
        let Some(written) = self.fastest.as_ref().filter(|_| due) else {
            return holds(!due && self.fastest.is_none(), || format!("the fastest growth is {largest}"));
        };
        let inside = |steps: (&Laurent, &Laurent), (first, last): (u64, u64)| {
            let ratio = Laurent::ratio(steps.0, steps.1).filter(|ratio| ratio.is_integer());
            let n = ratio.and_then(|ratio| u64::try_from(ratio.to_integer()).ok());
            n.filter(|n| (first..=last).contains(n))
                .ok_or_else(|| Fault::Wrong("its steps are not of the grid".into()))
        };
        let (step1, step2) = grid.steps();
        let i = inside((&written.h1, step1), grid.columns())?;
        let j = inside((&written.h2, step2), grid.rows())?;
        let (clocks, limits) = (grid.clocks(i, j)?, &context.limits());
        const BITS: u32 = 128;
        let ln = growth(&clocks, again(Tier::Refine, &clocks, limits)?.verdict, limits)?.ln_multiplier;
        let ln = ln.ok_or_else(|| Fault::Wrong("the fastest pair does not grow".into()))?;
        let period = written.h1.enclosure(BITS).mul(&Ball::from_integer(&clocks.p().into()), BITS);
        let rate = ln.div(&period, BITS).expect("T > 0");
        let ten = Ball::from_integer(&10.into()).ln(BITS).expect("10 > 0");
        let tenfold = ten.mul(&Ball::from_integer(&clocks.q().into()), BITS).div(&ln, BITS);
        holds(written.growth_rate.holds(&rate), || format!("the fastest growth rate is {}", rate.mid_f64()))?;
        let right = tenfold.is_some_and(|steps| written.steps_until_tenfold.holds(&steps));
        holds(right, || "steps_until_tenfold does not belong to this growth rate".into())?;
        holds(largest <= rate.to_f64_enclosure().1, || {
            format!("another pair grows faster, at a rate of {largest}")
        })
    }
}

/// The n-th pair, column by column.
fn place(grid: &Grid, n: u64) -> (u64, u64) {
    let rows = grid.shape().1 as u64;
    (grid.columns().0 + n / rows, grid.rows().0 + n % rows)
}

/// How many pairs are decided kick by kick.
fn most(grid: &Grid, options: &Options) -> u64 {
    if options.all { grid.pairs() } else { SAMPLE }
}

/// The failure of a pair of a band, if its verdict is another one kick by kick.
fn kick_by_kick(grid: &Grid, band: &Band, row: usize, context: &Context) -> Result<Option<Failure>> {
    let (i, j) = band.multipliers(grid, row);
    let truth = again(Tier::Refine, &grid.clocks(i, j)?, &context.limits())?.verdict;
    let wrong = || format!("is {}, side {}, kick by kick", truth.kind().name(), truth.side());
    let name = || format!("h1 = {}, h2 = {}", grid.h1(i), grid.h2(j));
    context.failure(1, name, holds(band.decision(row).verdict == truth, wrong))
}
