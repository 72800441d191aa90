//! A comparison: every pair by the filter, every offender by the full period in exact arithmetic, and θ
//! enclosed.

use super::context::{Checked, Context, Outcome, holds, same};
use super::exact::{affordable, again, full_period, meets};
use super::kind::Verify;
use crate::question::{Compare, Over};
use clocks::map::Grid;
use clocks::propagator::{Oscillator, TwoClocks};
use clocks::resonance::compare::{Comparison, Comparisons, Offender, Outcome as Rule};
use clocks::verdict::Tier;
use number::{Ball, Laurent, Ratio, Rational, Result};

const ROUTE: &str = "every pair by the certified filter, every offender by the full period in exact arithmetic; theta \
                     enclosed; the tan criterion and the trace give one verdict by a theorem";

const BITS: u32 = 96;

impl Verify for Compare {
    fn check(&self, answer: &Comparisons, context: &Context) -> Result<Outcome> {
        let truth = match self.pairs()? {
            Over::Grid(grid) => self.over_columns(&grid, context)?,
            Over::Ratios { max_sum, rho, samples } => {
                self.over_each_ratio(max_sum, &rho, samples, context)?
            }
        };
        let names = |all: &Comparisons| -> Vec<_> {
            let offenders = all.offenders.iter();
            offenders.map(|offender| (offender.place.clone(), offender.comparison.outcome)).collect()
        };
        let whole =
            same("the counts", format!("{:?}", answer.tally), format!("{:?}", truth.tally)).and_then(|()| {
                holds(names(answer) == names(&truth), || "by the filter the offenders are others".into())
            });
        context.outcome(ROUTE, whole, &answer.offenders, |offender| self.offends(offender, context))
    }
}

impl Compare {
    fn over_columns(&self, grid: &Grid, context: &Context) -> Result<Comparisons> {
        let (columns, rows) = (grid.columns(), grid.rows());
        let columns: Vec<u64> = (columns.0..=columns.1).collect();
        Comparisons::gather(&columns, &self.tolerance, |&i, found| {
            (rows.0..=rows.1)
                .try_for_each(|j| self.add(&grid.clocks(i, j)?, || [grid.h1(i), grid.h2(j)], found, context))
        })
    }

    fn over_each_ratio(
        &self,
        max_sum: u64,
        rho: &Rational,
        samples: u64,
        context: &Context,
    ) -> Result<Comparisons> {
        let (ratios, rho) = (Ratio::up_to(max_sum).collect::<Vec<_>>(), Laurent::from(rho));
        Comparisons::gather(&ratios, &self.tolerance, |&ratio, found| {
            (1..=samples).try_for_each(|k| {
                let place =
                    || [Laurent::from(&Rational::new((4 * k).into(), (samples + 1).into())), rho.clone()];
                let [s, rho] = place();
                self.add(&TwoClocks::with_rho(ratio, s, rho), place, found, context)
            })
        })
    }

    /// Compares one more pair: by the filter, and as if the tan criterion said the same.
    fn add(
        &self,
        clocks: &TwoClocks<Laurent>,
        place: impl Fn() -> [Laurent; 2],
        found: &mut Comparisons,
        context: &Context,
    ) -> Result<()> {
        let trace = again(Tier::Filter, clocks, &context.limits())?;
        let angle = clocks.angle();
        let is_resonant = angle.map(|angle| angle.is_resonant(clocks.p(), &self.tolerance));
        let outcome = is_resonant.map(|near| Rule::of(trace.verdict.is_stable(), near));
        let comparison = Comparison { trace, tan: trace.verdict, nearest: None, outcome };
        found.tally.add(&comparison);
        if outcome.is_some_and(Rule::is_offence) {
            found.offenders.push(Offender { place: place(), ratio: clocks.ratio(), comparison });
        }
        Ok(())
    }

    fn offends(&self, Offender { place, ratio, comparison }: &Offender, context: &Context) -> Checked {
        let [first, second] = place.clone();
        let clocks = match (&self.lambda1, &self.lambda2) {
            (Some(lambda1), Some(lambda2)) => {
                Oscillator::new(lambda1.clone(), lambda2.clone(), first, second)?.clocks()?
            }
            _ => TwoClocks::with_rho(*ratio, first, second),
        };
        let verdict = if affordable(&clocks) {
            full_period(&clocks).verdict
        } else {
            again(Tier::Refine, &clocks, &context.limits())?.verdict
        };
        same("its verdict", comparison.trace.verdict, verdict)?;
        same("its verdict by the tan criterion", comparison.tan, verdict)?;
        let Some((angle, nearest)) = clocks.angle().zip(comparison.nearest.as_ref()) else {
            return holds(false, || "its angle is missing".into());
        };
        let integer = |n: u64| Ball::from_integer(&n.into());
        let turns = angle.over_pi(BITS).mul(&integer(clocks.p()), BITS);
        let distance = turns.sub(&integer(nearest.m), BITS);
        let half = Rational::new(1.into(), 2.into());
        let is_nearest = distance.lower() <= half && distance.upper() >= -half;
        holds(is_nearest, || format!("m = {} is not the nearest to {}", nearest.m, turns.mid_f64()))?;
        holds(meets(&nearest.distance, &distance), || format!("its distance is {}", distance.mid_f64()))
    }
}
