//! A map: its counts by the map's own certified route again, a sample of its pairs kick by kick.

use serde_json::{Map as Object, Value};

use super::context::{Checked, Context, Failure, Fault, Options, Outcome, failure, holds};
use super::exact::{again, encloses};
use super::kind::{Again, Kind, asked};
use super::sample::sample;
use crate::question::{Map, Question};
use crate::report::map::{Fastest, MapTally};
use clocks::map::{Band, Grid};
use clocks::verdict::{Tier, growth};
use number::parallel::try_map;
use number::{Ball, Error, Real, Result};

const ROUTE: &str = "the pairs of a random sample kick by kick";
const ALL: &str = "every pair kick by kick";

/// Pairs that are decided kick by kick, unless all are asked for.
const SAMPLE: u64 = 2000;

/// Verdicts are not kept, so pairs are drawn on the way through the bands.
pub const KIND: Kind = Kind {
    name: "map",
    table: "rows",
    excluded: &[],
    by_input: true,
    read: |document| asked::<Map>(document).map(drop),
    again: recompute,
};

/// Findings on the way through the bands.
#[derive(Default)]
struct Drawn {
    /// No pair is proven to grow faster.
    rate: f64,
    /// Pairs that are decided otherwise kick by kick.
    failures: Vec<Failure>,
}

/// The kicks of the other route.
pub fn work(question: &Map, options: &Options) -> Result<u64> {
    const PROBES: u64 = 1000;
    let grid = question.grid()?;
    let kicks = |n: u64| {
        let (i, j) = place(&grid, n);
        grid.ratio(i, j).kicks() / 2
    };
    let probes = sample(&grid.fingerprint(), grid.pairs(), PROBES);
    let sum: u64 = probes.iter().map(|&n| kicks(n)).sum();
    let pairs = grid.pairs().min(most(&grid, options));
    Ok((u128::from(sum) * u128::from(pairs) / probes.len() as u128).try_into().unwrap_or(u64::MAX))
}

fn recompute<'a>(document: &Object<String, Value>, context: &'a Context<'a>) -> Result<Again<'a>> {
    let question: Map = asked(document)?;
    question.check_whole()?;
    let grid = question.grid()?;
    let (pairs, limit) = (grid.pairs(), context.limits().kicks);
    if pairs > limit {
        let cost = format!("deciding {pairs} pairs again, where {limit} are allowed");
        return Err(Error::budget(cost, pairs));
    }
    let chosen = sample(&grid.fingerprint(), pairs, most(&grid, context.options));
    let (mut tally, mut drawn) = (MapTally::default(), Drawn::default());
    let (mut next, mut done) = (chosen.as_slice(), 0);
    question.each(&grid, None, &context.work(), |band| {
        let pairs = band.verdicts.len() as u64;
        let (here, rest) = next.split_at(next.partition_point(|&n| n < done + pairs));
        let one = |&n: &u64| failure(0, kick_by_kick(&grid, &band, (n - done) as usize, context));
        drawn.failures.extend(try_map(here, one)?.into_iter().flatten());
        tally.add(&grid, &band);
        for growing in &band.growing {
            let (i, j) = band.multipliers(&grid, growing.position as usize);
            let period = grid.ratio(i, j).p() as f64 * i as f64 * grid.steps().0.to_f64();
            drawn.rate = drawn.rate.max(growing.rate(period).map_or(0.0, |rate| rate.lo));
        }
        (next, done) = (rest, done + pairs);
        context.progress.inspect(|progress| progress(done, grid.pairs()));
        Ok(())
    })?;
    let document = question.document(&tally).value();
    Ok((document, Box::new(move || check(&question, &grid, &tally, drawn, context))))
}

fn check(question: &Map, grid: &Grid, tally: &MapTally, drawn: Drawn, context: &Context) -> Result<Outcome> {
    let (most, pairs) = (most(grid, context.options), grid.pairs());
    let mut failures = drawn.failures;
    let fastest = match &tally.fastest {
        Some(fastest) => grows_fastest(fastest, grid, drawn.rate, context),
        None => holds(!(question.growth && drawn.rate > 0.0), || format!("a pair grows at {}", drawn.rate)),
    };
    failures.extend(failure(0, fastest)?);
    let route = if most < pairs { ROUTE } else { ALL };
    Ok(Outcome { sample: Some((most.min(pairs), pairs)), failures, ..Outcome::holding(route, 1) })
}

/// The fastest pair grows as fast as is found, and no other one faster.
fn grows_fastest(fastest: &Fastest, grid: &Grid, largest: f64, context: &Context) -> Checked {
    const BITS: u32 = 128;
    let ([i, j], limits) = (fastest.at, &context.limits());
    let clocks = grid.clocks(i, j)?;
    let ln = growth(&clocks, again(Tier::Refine, &clocks, limits)?.verdict, limits)?.ln_multiplier;
    let ln = ln.ok_or_else(|| Fault::Wrong("the fastest pair does not grow".into()))?;
    let integer = |n: u64| Ball::from_integer(&n.into());
    let period = grid.h1(i).enclosure(BITS).mul(&integer(clocks.p()), BITS);
    let rate = ln.div(&period, BITS).expect("T > 0");
    let ten = integer(10).ln(BITS).expect("10 > 0");
    let tenfold = ten.mul(&integer(clocks.q()), BITS).div(&ln, BITS);
    let is_rate = encloses((fastest.rate.lo, fastest.rate.hi), &rate);
    holds(is_rate, || format!("the fastest growth rate is {}", rate.mid_f64()))?;
    let said = (fastest.tenfold.lo, fastest.tenfold.hi);
    holds(tenfold.is_some_and(|steps| encloses(said, &steps)), || {
        "steps_until_tenfold does not belong to this growth rate".into()
    })?;
    holds(largest <= rate.to_f64_enclosure().1, || {
        format!("another pair grows faster, at a rate of {largest}")
    })
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

/// That the verdict on a pair of a band is the same kick by kick.
fn kick_by_kick(grid: &Grid, band: &Band, row: usize, context: &Context) -> Checked {
    let (i, j) = band.multipliers(grid, row);
    let truth = again(Tier::Refine, &grid.clocks(i, j)?, &context.limits())?.verdict;
    let is_so = band.decision(row).verdict == truth;
    holds(is_so, || format!("h1 = {}, h2 = {} is {truth}, kick by kick", grid.h1(i), grid.h2(j)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clocks::verdict::Verdict;
    use serde_json::json;

    #[test]
    fn a_pair_that_is_decided_otherwise_and_a_forged_growth_are_found() {
        let asked = json!({"lambda1": "10", "lambda2": "2/5", "step1": "1/10", "step2": "1/10", "growth": "true",
            "h1_range": "1/10..3/5", "h2_range": "1/10..3"});
        let (question, options): (Map, _) = (serde_json::from_value(asked).unwrap(), Options::default());
        let (grid, context) = (question.grid().unwrap(), Context::new(&options, None));
        let (mut tally, mut bands) = (MapTally::default(), 0);
        let each = |mut band: Band| {
            tally.add(&grid, &band);
            assert!(kick_by_kick(&grid, &band, 0, &context).is_ok());
            band.verdicts[0] = (band.verdicts[0] + 1) % Verdict::ALL.len() as u8;
            assert!(matches!(kick_by_kick(&grid, &band, 0, &context), Err(Fault::Wrong(_))));
            bands += 1;
            Ok(())
        };
        question.each(&grid, None, &context.work(), each).unwrap();
        let fastest = tally.fastest.unwrap();
        let is_right =
            |fastest: &Fastest, largest: f64| grows_fastest(fastest, &grid, largest, &context).is_ok();
        assert!(bands > 0 && is_right(&fastest, fastest.rate.lo));
        assert!(!is_right(&fastest, 1.01 * fastest.rate.hi));
        let mut forged = fastest.clone();
        (forged.rate.lo, forged.rate.hi) = (1.01 * forged.rate.lo, 1.01 * forged.rate.hi);
        assert!(!is_right(&forged, fastest.rate.lo));
        let mut beside = fastest.clone();
        beside.at[0] -= 1;
        assert!(!is_right(&beside, 0.0));
    }
}
