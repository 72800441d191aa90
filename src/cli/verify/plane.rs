//! Maps and comparisons over a grid: pair by pair, kick by kick.

use crate::parallel::*;
use serde_json::Value;

use super::exact::{affordable, check_ratio, full_period, meets};
use super::read::{Checked, Fault, Row, holds, whole};
use super::{Context, Outcome};
use crate::cli::progress::progress;
use crate::cli::ratios::Ratios;
use crate::cli::tongues::MOST_SUM;
use crate::error::Result;
use crate::map::Grid;
use crate::number::parse::{parse, parse_range};
use crate::number::{Ball, Laurent, Rational};
use crate::propagator::{Oscillator, TwoClocks};
use crate::resonance::compare::Outcome as Rule;
use crate::resonance::tan;
use crate::scene::GridRange;
use crate::verdict::{Kind, Limits, Tier, Verdict, decide_from};

const MAP: &str = "every pair of the grid decided again by the refine tier, kick by kick";
const COMPARE: &str = "every pair listed: the full period in exact arithmetic, and theta enclosed";

/// The counts are the rows: stable, unstable, parabolic, coexistence.
pub fn check_map(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let input = whole(all.object("input"))?;
    if input.get("shard").is_some() {
        let remedy = "verify rechecks whole maps: join the parts with kickdrift merge";
        return Err(crate::error::Error::input("shard", whole(input.text("shard"))?, remedy));
    }
    let grid = grid(&input)?;
    let counts = recount(&grid, context)?;
    let tiers = whole(all.object("decided_by"))?;
    let decided = Tier::ALL.iter().map(|tier| whole(tiers.whole(tier.name()))).collect::<Result<Vec<_>>>()?;
    let decided: u128 = decided.into_iter().map(u128::from).sum();
    let mut told: Vec<Value> = counts
        .iter()
        .map(|(key, count)| serde_json::json!({"entry": key, "count": count, "told": document[key]}))
        .collect();
    let decided = u64::try_from(decided).unwrap_or(u64::MAX);
    told.push(serde_json::json!({"entry": "decided_by", "count": grid.pairs(), "told": decided}));
    context.rows(&told, MAP, |row| {
        let (count, told) = (row.whole("count")?, row.whole("told")?);
        holds(count == told, || format!("{count} pairs, not {told}"))
    })
}

fn grid(input: &Row) -> Result<Grid> {
    let text = |key: &str| whole(input.text(key));
    let steps = [parse("step1", text("step1")?)?, parse("step2", text("step2")?)?];
    let ranges = [parse_range("h1_range", text("h1_range")?)?, parse_range("h2_range", text("h2_range")?)?];
    GridRange::new(steps, ranges).of(parse("lambda1", text("lambda1")?)?, parse("lambda2", text("lambda2")?)?)
}

fn recount(grid: &Grid, context: &Context) -> Result<[(&'static str, u64); 5]> {
    let bar = progress(context.common.quiet, grid.pairs(), "pairs");
    let column = |i: u64| -> Result<[u64; 7]> {
        let mut seen = [0; Verdict::ALL.len()];
        for j in grid.rows().0..=grid.rows().1 {
            let clocks = grid.clocks(i, j)?;
            seen[usize::from(again(&clocks, &context.limits)?.index())] += 1;
        }
        bar.inc(grid.shape().1 as u64);
        Ok(seen)
    };
    let columns: Vec<[u64; 7]> =
        (grid.columns().0..=grid.columns().1).into_par_iter().map(column).collect::<Result<_>>()?;
    bar.finish_and_clear();
    let count = |wanted: fn(&Verdict) -> bool| {
        let of = |seen: &[u64; 7]| {
            Verdict::ALL.iter().zip(seen).filter(|(v, _)| wanted(v)).map(|(_, n)| n).sum::<u64>()
        };
        columns.iter().map(of).sum()
    };
    Ok([
        ("pairs", count(|_| true)),
        ("stable", count(|verdict| verdict.is_stable())),
        ("unstable", count(|verdict| !verdict.is_stable())),
        ("parabolic", count(|verdict| verdict.kind() == Kind::Parabolic)),
        ("coexistence", count(|verdict| verdict.kind() == Kind::Coexistence)),
    ])
}

fn again(clocks: &TwoClocks<Laurent>, limits: &Limits) -> Result<Verdict> {
    let decision = match clocks.as_rational() {
        Some(rational) => decide_from(Tier::Refine, &rational, limits),
        None => decide_from(Tier::Refine, clocks, limits),
    };
    decision.map(|decision| decision.verdict)
}

pub fn check_compare(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let input = whole(all.object("input"))?;
    let lambdas = input
        .get("lambda1")
        .map(|_| -> Result<_> { Ok((whole(input.quantity("lambda1"))?, whole(input.quantity("lambda2"))?)) });
    let lambdas = lambdas.transpose()?;
    let tolerance = whole(input.rational("tolerance"))?;
    let given = input.get("rho").map(|_| whole(input.rational("rho"))).transpose()?;
    let rows = whole(all.rows("offenders"))?;
    let mut outcome = context.rows(rows, COMPARE, |row| {
        let clocks = match &lambdas {
            Some((lambda1, lambda2)) => {
                let oscillator = Oscillator::new(
                    lambda1.clone(),
                    lambda2.clone(),
                    row.quantity("h1")?,
                    row.quantity("h2")?,
                );
                oscillator.map_err(|error| Fault::Wrong(error.to_string()))?.clocks()
            }
            None => {
                let (ratio, s, rho) = (row.ratio()?, row.rational("s")?, row.rational("rho")?);
                check_ratio(ratio, &context.limits)?;
                holds(given.as_ref() == Some(&rho), || format!("rho = {rho} is not that of the input"))?;
                TwoClocks::with_rho(ratio, Laurent::from_rational(s), Laurent::from_rational(rho))
            }
        };
        check_offender(row, &clocks, &tolerance, &context.limits)
    })?;
    let asked = match &lambdas {
        Some(_) => grid(&input)?.pairs(),
        None => asked_ratios(&input)?,
    };
    if let Some(failure) = counts(&all, rows, asked)? {
        outcome.failures.push(failure);
    }
    Ok(outcome)
}

/// The pairs of all coprime p + q up to a number, so many values of s each.
fn asked_ratios(input: &Row) -> Result<u64> {
    let number =
        |key: &str| -> Result<u64> { Ok(whole(input.rational(key))?.to_integer().try_into().unwrap_or(0)) };
    let list = Ratios::UpTo(number("max_sum")?).within(MOST_SUM)?.list();
    Ok((list.len() as u64).saturating_mul(number("samples")?))
}

fn check_offender(
    row: &Row,
    clocks: &TwoClocks<Laurent>,
    tolerance: &Rational,
    limits: &Limits,
) -> Checked<()> {
    holds(row.ratio()? == clocks.ratio(), || format!("h2/h1 is {}", clocks.ratio()))?;
    let kind = match (affordable(clocks), clocks.as_rational()) {
        (true, Some(rational)) => full_period(&rational).kind,
        (true, None) => full_period(clocks).kind,
        _ => again(clocks, limits)?.kind(),
    };
    let told = row.text("kind")?;
    holds(told == kind.name(), || format!("is {}, not {told}", kind.name()))?;
    let tan = clocks.as_rational().map_or_else(|| tan::criterion(clocks), |clocks| tan::criterion(&clocks));
    let (tan, told) = (tan.verdict().kind(), row.text("tan")?);
    holds(told == tan.name(), || format!("the tan criterion says {}, not {told}", tan.name()))?;
    let angle = clocks.angle();
    let outcome = angle.as_ref().map(|angle| {
        Rule::of(matches!(kind, Kind::Elliptic | Kind::Coexistence), angle.is_resonant(clocks.p(), tolerance))
    });
    let offence = if tan == kind { outcome.map_or("none", Rule::name) } else { "tan" };
    let told = row.text("offence")?;
    holds(told == offence, || format!("its offence is {offence}, not {told}"))?;
    let Some(angle) = angle else {
        return holds(row.get("m").is_none(), || "has no angle".into());
    };
    const BITS: u32 = 96;
    let integer = |n: u64| Ball::from_integer(&n.into());
    let turns = angle.over_pi(BITS).mul(&integer(clocks.p()), BITS);
    let distance = turns.sub(&integer(row.whole("m")?), BITS);
    holds(meets(row.ends("distance")?, &distance), || format!("its distance is {}", distance.mid_f64()))
}

/// The counts add up to the pairs asked for, and the rows are as many as they say.
fn counts(all: &Row, rows: &[Value], asked: u64) -> Result<Option<(u64, String, String)>> {
    let (resonance, tan) = (whole(all.object("resonance"))?, whole(all.object("tan"))?);
    let sum =
        |row: &Row, keys: &[&str]| -> Result<u64> { keys.iter().map(|key| whole(row.whole(key))).sum() };
    let pairs = whole(all.whole("pairs"))?;
    let beyond = whole(resonance.whole("beyond_verlet"))?;
    let unstable = whole(all.whole("unstable"))?;
    let seen = sum(&resonance, &["hits", "misses"])?;
    let wrong = pairs != asked
        || sum(&resonance, &["hits", "quiet", "misses", "false_alarms", "beyond_verlet"])? != pairs
        || !(seen..=seen.saturating_add(beyond)).contains(&unstable)
        || sum(&tan, &["agree", "disagree"])? != pairs
        || (whole(tan.whole("disagree"))? == 0
            && sum(&resonance, &["misses", "false_alarms"])? != rows.len() as u64);
    Ok(wrong.then(|| (0, "the counts".into(), "do not add up".into())))
}
