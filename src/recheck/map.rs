//! A map: its counts by the map's own certified route again, a sample of its pairs kick by kick.

use std::collections::BTreeMap;

use crate::parallel::try_map;
use serde::de::IgnoredAny;

use super::context::{Checked, Context, Failure, Fault, Options, Outcome, holds, same};
use super::exact::again;
use super::sample::sample;
use super::written::{Ends, Range, Written};
use crate::error::{Error, Result};
use crate::map::{Band, Grid, Map, Products, Resources};
use crate::number::{Ball, Laurent, Real};
use crate::verdict::{Kind, Tier, Verdict, growth};

const ROUTE: &str =
    "the counts by the map's own certified route again; the pairs of a random sample kick by kick";
const ALL: &str = "the counts by the map's own certified route again; every pair kick by kick";

/// Pairs that are decided kick by kick, unless all are asked for.
const SAMPLE: u64 = 2000;

rows! {
    /// `kickdrift/map/1`.
    pub struct Claim {
        input: Input,
        pairs: u64,
        stable: u64,
        unstable: u64,
        parabolic: u64,
        coexistence: u64,
        decided_by: DecidedBy,
        #[serde(rename = "work")]
        _work: IgnoredAny,
        families: Option<Vec<Family>>,
        fastest: Option<Fastest>,
    }

    struct Input {
        lambda1: Written<Laurent>,
        lambda2: Written<Laurent>,
        step1: Written<Laurent>,
        step2: Written<Laurent>,
        h1_range: Written<Range>,
        h2_range: Written<Range>,
        label: Option<Written<bool>>,
        growth: Option<Written<bool>>,
        shard: Option<String>,
    }

    struct DecidedBy {
        filter: u64,
        refine: u64,
        exact: u64,
    }

    #[derive(PartialEq)]
    struct Family {
        a: i64,
        pairs: u64,
    }

    struct Fastest {
        h1: Written<Laurent>,
        h2: Written<Laurent>,
        growth_rate: Ends,
        steps_until_tenfold: Ends,
    }
}

/// What the map's own route finds.
#[derive(Default)]
struct Found {
    verdicts: [u64; Verdict::ALL.len()],
    families: BTreeMap<i64, u64>,
    /// No pair is proven to grow faster.
    rate: f64,
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
        let pairs = if options.all { grid.pairs() } else { grid.pairs().min(SAMPLE) };
        Ok((u128::from(sum) * u128::from(pairs) / probes.len() as u128).try_into().unwrap_or(u64::MAX))
    }

    pub fn check(&self, context: &Context) -> Result<Outcome> {
        if let Some(shard) = &self.input.shard {
            return Err(Error::input("shard", shard, "whole maps can be rechecked: join the parts first"));
        }
        let grid = self.input.grid()?;
        let (pairs, limit) = (grid.pairs(), context.limits().kicks);
        if pairs > limit {
            return Err(Error::budget(
                format!("deciding {pairs} pairs again, where {limit} are allowed"),
                pairs,
            ));
        }
        let most = if context.options.all { grid.pairs() } else { SAMPLE };
        let found = self.again(&grid, most, context)?;
        let mut failures: Vec<Failure> = context
            .failure(0, || "the counts".into(), self.holds(&grid, &found, context))?
            .into_iter()
            .collect();
        failures.extend(found.failures);
        Ok(Outcome {
            rows: 1,
            route: if most < grid.pairs() { ROUTE } else { ALL },
            sample: Some((most.min(grid.pairs()), grid.pairs())),
            failures,
            not_rechecked: vec![
                "decided_by: that its parts are all pairs is; the tiers depend on the version of the program",
                "work: so does the cost",
            ],
        })
    }

    /// The map again, and its sample.
    fn again(&self, grid: &Grid, most: u64, context: &Context) -> Result<Found> {
        let products = Products { label: self.input.label.is_some(), growth: self.input.growth.is_some() };
        let drawn = sample(&grid.fingerprint(), grid.pairs(), most);
        let (mut found, mut next, mut done) = (Found::default(), drawn.as_slice(), 0);
        let resources = Resources { limits: *context.limits(), ..Resources::default() };
        Map::of(grid).with(products).within(resources).for_each_band(|_, band| {
            let pairs = band.verdicts.len() as u64;
            let (own, rest) = next.split_at(next.partition_point(|&n| n < done + pairs));
            let one = |&n: &u64| {
                let row = (n - done) as usize;
                let (i, j) = band.multipliers(grid, row);
                let name = || format!("h1 = {}, h2 = {}", grid.h1(i), grid.h2(j));
                let (told, truth) = (
                    band.decision(row).verdict,
                    again(Tier::Refine, &grid.clocks(i, j)?, context.limits())?.verdict,
                );
                let wrong = || format!("is {}, side {}, kick by kick", truth.kind().name(), truth.side());
                context.failure(1, name, holds(told == truth, wrong))
            };
            let failures: Vec<_> = try_map(own, one)?;
            found.failures.extend(failures.into_iter().flatten());
            found.add(grid, &band);
            (next, done) = (rest, done + pairs);
            context.see.inspect(|see| see(done, grid.pairs()));
            Ok(())
        })?;
        Ok(found)
    }

    fn holds(&self, grid: &Grid, found: &Found, context: &Context) -> Checked {
        let count = |wanted: fn(Verdict) -> bool| -> u64 {
            Verdict::ALL.iter().zip(found.verdicts).filter(|(v, _)| wanted(**v)).map(|(_, n)| n).sum()
        };
        same("pairs", self.pairs, grid.pairs())?;
        same("stable", self.stable, count(Verdict::is_stable))?;
        same("unstable", self.unstable, count(|verdict| !verdict.is_stable()))?;
        same("parabolic", self.parabolic, count(|verdict| verdict.kind() == Kind::Parabolic))?;
        same("coexistence", self.coexistence, count(|verdict| verdict.kind() == Kind::Coexistence))?;
        let DecidedBy { filter, refine, exact } = self.decided_by;
        let decided = [filter, refine, exact].into_iter().map(u128::from).sum::<u128>();
        same("the sum of decided_by", decided, u128::from(grid.pairs()))?;
        let families: Vec<Family> = found.families.iter().map(|(&a, &pairs)| Family { a, pairs }).collect();
        let told = self.families.as_deref().unwrap_or_default();
        holds(told == families, || format!("the families are {families:?}"))?;
        holds(self.families.is_some() != families.is_empty(), || "families has no rows".into())?;
        self.fastest(grid, found.rate, context)
    }

    /// The fastest pair grows as fast as is written, and no other one faster.
    fn fastest(&self, grid: &Grid, largest: f64, context: &Context) -> Checked {
        let due = self.input.growth.is_some() && largest > 0.0;
        let Some(told) = self.fastest.as_ref().filter(|_| due) else {
            return holds(!due && self.fastest.is_none(), || format!("the fastest growth is {largest}"));
        };
        let inside = |steps: (&Laurent, &Laurent), (first, last): (u64, u64)| {
            let ratio = Laurent::ratio(steps.0, steps.1).filter(|ratio| ratio.is_integer());
            let n = ratio.and_then(|ratio| u64::try_from(ratio.to_integer()).ok());
            n.filter(|n| (first..=last).contains(n))
                .ok_or_else(|| Fault::Wrong("its steps are not of the grid".into()))
        };
        let (step1, step2) = grid.steps();
        let i = inside((&told.h1, step1), grid.columns())?;
        let j = inside((&told.h2, step2), grid.rows())?;
        let (clocks, limits) = (grid.clocks(i, j)?, context.limits());
        const BITS: u32 = 128;
        let ln = growth(&clocks, again(Tier::Refine, &clocks, limits)?.verdict, limits)?.ln_multiplier;
        let ln = ln.ok_or_else(|| Fault::Wrong("the fastest pair does not grow".into()))?;
        let period = told.h1.enclosure(BITS).mul(&Ball::from_integer(&clocks.p().into()), BITS);
        let rate = ln.div(&period, BITS).expect("T > 0");
        let ten = Ball::from_integer(&10.into()).ln(BITS).expect("10 > 0");
        let tenfold = ten.mul(&Ball::from_integer(&clocks.q().into()), BITS).div(&ln, BITS);
        holds(told.growth_rate.holds(&rate), || format!("the fastest growth rate is {}", rate.mid_f64()))?;
        let right = tenfold.is_some_and(|steps| told.steps_until_tenfold.holds(&steps));
        holds(right, || "steps_until_tenfold does not belong to this growth rate".into())?;
        holds(largest <= rate.to_f64_enclosure().1, || {
            format!("another pair grows faster, at a rate of {largest}")
        })
    }
}

impl Found {
    fn add(&mut self, grid: &Grid, band: &Band) {
        band.verdicts.iter().for_each(|&verdict| self.verdicts[usize::from(verdict)] += 1);
        for growing in &band.growing {
            let (i, j) = band.multipliers(grid, growing.position as usize);
            let ratio = grid.ratio(i, j);
            let (p, q) = ratio.terms();
            if growing.label.is_some_and(|m| p.max(q).max(m) < 1 << 31)
                && let Some((a, _)) = growing.family(ratio)
            {
                *self.families.entry(a).or_default() += 1;
            }
            let period = p as f64 * i as f64 * grid.steps().0.to_f64();
            self.rate = self.rate.max(growing.rate(period).map_or(0.0, |rate| rate.lo));
        }
    }
}

impl Input {
    fn grid(&self) -> Result<Grid> {
        let Input { lambda1, lambda2, step1, step2, h1_range, h2_range, .. } = self;
        let steps = [step1.0.clone(), step2.0.clone()];
        Grid::new(lambda1.0.clone(), lambda2.0.clone(), steps, h1_range.0.clone(), h2_range.0.clone())
    }
}

/// The n-th pair, column by column.
fn place(grid: &Grid, n: u64) -> (u64, u64) {
    let rows = grid.shape().1 as u64;
    (grid.columns().0 + n / rows, grid.rows().0 + n % rows)
}
