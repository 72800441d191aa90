//! `kickdrift compare`: the trace against the predictions, over a grid or over ratios.

use crate::parallel::*;

use super::args::{self, Common, echo_grid, whole};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::map::Grid;
use crate::number::parse::{parse, parse_rational};
use crate::number::{Ratio, Rational};
use crate::propagator::TwoClocks;
use crate::report::compare::{self, Offender};
use crate::report::document::Document;
use crate::resonance::compare::{Comparison, Tally, compare};
use crate::scene::GridRange;
use crate::verdict::Limits;

/// Flags of `compare`: either a grid with both stiffnesses, or --max-sum with --rho.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The stiffness of the fast force (with a grid).
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    lambda1: Option<String>,
    /// The stiffness of the slow force (with a grid).
    #[arg(long, value_name = "Y", allow_hyphen_values = true)]
    lambda2: Option<String>,
    #[command(flatten)]
    grid: args::Grid,
    /// Instead of a grid: all coprime p + q up to this number.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64>)]
    max_sum: Option<u64>,
    /// lambda2/lambda1, with --max-sum.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    rho: Option<String>,
    /// With --max-sum: the values of s = h1^2 lambda1, evenly spaced inside 0 < s < 4.
    #[arg(long, value_name = "K", default_value_t = 99, allow_negative_numbers = true, value_parser = whole::<u64>)]
    samples: u64,
    /// How near q h2 must be to a multiple of T1/2 to count as resonant, in units of T1/2.
    #[arg(long, value_name = "T", default_value = "1/20", allow_hyphen_values = true)]
    tolerance: String,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let tolerance = parse_rational("tolerance", &self.tolerance)?;
        check(&tolerance)?;
        let limits = common.limits();
        let document = match (&self.lambda1, &self.lambda2, self.max_sum, &self.rho) {
            (Some(lambda1), Some(lambda2), None, None) => {
                let (lambda1, lambda2) = (parse("lambda1", lambda1)?, parse("lambda2", lambda2)?);
                let range = self.grid.range()?;
                over_grid(&range.of(lambda1, lambda2)?, &range, &tolerance, &limits)?
            }
            (None, None, Some(max_sum), Some(rho)) if self.grid.is_absent() => {
                over_ratios(max_sum, &parse_rational("rho", rho)?, self.samples, &tolerance, &limits)?
            }
            _ => {
                let remedy = "give --lambda1, --lambda2 and a grid (--step, --h1-range, --h2-range), or --max-sum and --rho";
                return Err(Error::input("flags", "incomplete or mixed", remedy));
            }
        };
        common.write(&document, Format::Text)
    }
}

fn check(tolerance: &Rational) -> Result<()> {
    let zero = Rational::default();
    if *tolerance >= zero {
        return Ok(());
    }
    Err(Error::input("tolerance", tolerance, "must not be negative"))
}

/// The comparison over all pairs of a grid.
pub fn over_grid(grid: &Grid, range: &GridRange, tolerance: &Rational, limits: &Limits) -> Result<Document> {
    check(tolerance)?;
    let column = |i: u64| {
        let mut part = Part::default();
        for j in grid.rows().0..=grid.rows().1 {
            let clocks = grid.clocks(i, j)?;
            let comparison = match clocks.as_rational() {
                Some(rational) => compare(&rational, tolerance, limits)?,
                None => compare(&clocks, tolerance, limits)?,
            };
            let place = || [grid.h1(i).to_string(), grid.h2(j).to_string()];
            part.add(clocks.ratio(), comparison, place);
        }
        Ok(part)
    };
    let columns: Vec<u64> = (grid.columns().0..=grid.columns().1).collect();
    let all = gather(columns, column)?;
    let document = compare::document(&all.tally, tolerance, ["h1", "h2"], &all.offenders);
    let (lambda1, lambda2) = grid.lambdas();
    Ok(echo_grid(document.input("lambda1", lambda1).input("lambda2", lambda2), range))
}

/// The comparison over all coprime p + q ≤ max_sum at s = 4k/(samples + 1).
fn over_ratios(
    max_sum: u64,
    rho: &Rational,
    samples: u64,
    tolerance: &Rational,
    limits: &Limits,
) -> Result<Document> {
    if !(2..=2000).contains(&max_sum) {
        return Err(Error::input("max-sum", max_sum, "choose 2 to 2000"));
    }
    if !(1..=1_000_000).contains(&samples) {
        return Err(Error::input("samples", samples, "choose 1 to 1000000"));
    }
    let of_ratio = |ratio: Ratio| {
        let mut part = Part::default();
        for k in 1..=samples {
            let s = Rational::new((4 * k).into(), (samples + 1).into());
            let place = || [s.to_string(), rho.to_string()];
            let comparison = compare(&TwoClocks::with_rho(ratio, s.clone(), rho.clone()), tolerance, limits)?;
            part.add(ratio, comparison, place);
        }
        Ok(part)
    };
    let all = gather(Ratio::up_to(max_sum).collect(), of_ratio)?;
    let document = compare::document(&all.tally, tolerance, ["s", "rho"], &all.offenders);
    Ok(document.input("max_sum", max_sum).input("rho", rho).input("samples", samples))
}

/// Counts and offenders of a set of pairs.
#[derive(Default)]
struct Part {
    tally: Tally,
    offenders: Vec<Offender>,
}

impl Part {
    fn add(&mut self, ratio: Ratio, comparison: Comparison, place: impl FnOnce() -> [String; 2]) {
        self.tally.add(&comparison);
        if !comparison.tan_agrees() || comparison.outcome.is_some_and(|outcome| outcome.is_offence()) {
            self.offenders.push(Offender { place: place(), ratio, comparison });
        }
    }
}

/// The parts of all items on all threads, joined in the items' order.
fn gather<T: Send>(items: Vec<T>, part: impl Fn(T) -> Result<Part> + Send + Sync) -> Result<Part> {
    let parts: Result<Vec<Part>> = items.into_par_iter().map(part).collect();
    Ok(parts?.into_iter().fold(Part::default(), |mut all, mut part| {
        all.tally = all.tally.plus(&part.tally);
        all.offenders.append(&mut part.offenders);
        all
    }))
}
