//! A comparison: every pair by the filter, every offender by the full period in exact arithmetic, and θ
//! enclosed.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Fault, Outcome, Place, holds, same};
use super::exact::{affordable, again, full_period};
use super::written::{Ends, Written};
use crate::question::{Compare, Over};
use clocks::map::Grid;
use clocks::propagator::TwoClocks;
use clocks::resonance::compare::Outcome as Rule;
use clocks::verdict::{Kind, Tier, Verdict};
use number::error::Result;
use number::parallel::try_map;
use number::{Ball, Laurent, Ratio, Rational};

const ROUTE: &str = "every pair by the certified filter, every offender by the full period in exact arithmetic; theta \
                     enclosed; the tan criterion and the trace give one verdict by a theorem";

rows! {
    /// `kickdrift/compare/1`.
    pub struct Claim {
        input: Compare,
        pairs: u64,
        unstable: u64,
        tan: Tan,
        resonance: Counts,
        offenders: Vec<Offender>,
    }

    struct Tan {
        agree: u64,
        disagree: u64,
    }

    #[derive(Copy, Default, PartialEq, Eq)]
    struct Counts {
        hits: u64,
        quiet: u64,
        misses: u64,
        false_alarms: u64,
        beyond_verlet: u64,
    }

    struct Offender {
        h1: Option<Written<Laurent>>,
        h2: Option<Written<Laurent>>,
        s: Option<Written<Rational>>,
        rho: Option<Written<Rational>>,
        p: u64,
        q: u64,
        offence: String,
        kind: Written<Kind>,
        tan: Written<Kind>,
        m: u64 | null,
        distance: Ends | null,
    }
}

impl Place for Offender {
    fn place(&self) -> String {
        let exact = |name: &str, x: Option<String>| x.map(|x| format!(", {name} = {x}")).unwrap_or_default();
        let written = |x: &Option<Written<Laurent>>| x.as_ref().map(|x| x.to_string());
        let s = exact("s", self.s.as_ref().map(|s| s.to_string()));
        let steps = exact("h1", written(&self.h1)) + &exact("h2", written(&self.h2));
        format!("p = {}, q = {}{s}{steps}", self.p, self.q)
    }
}

/// The pairs that are compared, line by line.
pub enum Pairs {
    Grid(Grid),
    /// All ratios at s = 4 k/(samples + 1).
    Ratios {
        list: Vec<Ratio>,
        rho: Rational,
        samples: u64,
    },
}

/// The counts of a line, and its offenders in their order.
type Line = (u64, Counts, Vec<(usize, u64)>);

/// A row, and the place of the offender that belongs there.
struct Placed<'a> {
    row: &'a Offender,
    at: Option<(usize, u64)>,
}

impl Place for Placed<'_> {
    fn place(&self) -> String {
        self.row.place()
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "offenders";
    asked!(Compare);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let pairs = match self.input.pairs()? {
            Over::Grid(grid) => Pairs::Grid(grid),
            Over::Ratios { max_sum, rho, samples } => {
                Pairs::Ratios { list: Ratio::up_to(max_sum).collect(), rho, samples }
            }
        };
        let all: Vec<usize> = (0..pairs.lines()).collect();
        let lines = try_map(&all, |&line| self.line(&pairs, line, context))?;
        let mut places = lines.iter().flat_map(|(.., places)| places.iter().copied());
        let rows: Vec<Placed> = self.offenders.iter().map(|row| Placed { row, at: places.next() }).collect();
        let missing = places.count();
        let whole = holds(missing == 0, || format!("{missing} offenders are missing"));
        let whole = whole.and_then(|()| self.counts(&pairs, &lines));
        context.outcome(ROUTE, ("the counts", whole), &rows, |row| self.offender(&pairs, row, context))
    }
}

impl Claim {
    /// Line by line: unstable pairs, the rule's outcomes, offenders.
    fn line(&self, pairs: &Pairs, line: usize, context: &Context) -> Result<Line> {
        let (mut unstable, mut counts, mut offenders) = (0, Counts::default(), Vec::new());
        for k in 0..pairs.length() {
            let clocks = pairs.clocks(line, k)?;
            let verdict = again(Tier::Filter, &clocks, &context.limits())?.verdict;
            unstable += u64::from(!verdict.is_stable());
            let rule = self.rule(&clocks, verdict);
            *match rule {
                Some(Rule::Hit) => &mut counts.hits,
                Some(Rule::Quiet) => &mut counts.quiet,
                Some(Rule::Miss) => &mut counts.misses,
                Some(Rule::FalseAlarm) => &mut counts.false_alarms,
                None => &mut counts.beyond_verlet,
            } += 1;
            if rule.is_some_and(Rule::is_offence) {
                offenders.push((line, k));
            }
        }
        Ok((unstable, counts, offenders))
    }

    fn rule(&self, clocks: &TwoClocks<Laurent>, verdict: Verdict) -> Option<Rule> {
        let near = clocks.angle().map(|angle| angle.is_resonant(clocks.p(), &self.input.tolerance));
        near.map(|near| Rule::of(verdict.is_stable(), near))
    }

    fn counts(&self, pairs: &Pairs, lines: &[Line]) -> Checked {
        let sum = |count: fn(&Counts) -> u64| lines.iter().map(|(_, counts, _)| count(counts)).sum::<u64>();
        let all = pairs.lines() as u64 * pairs.length();
        same("pairs", self.pairs, all)?;
        same("unstable", self.unstable, lines.iter().map(|(unstable, ..)| unstable).sum())?;
        same("tan.disagree", self.tan.disagree, 0)?;
        same("tan.agree", self.tan.agree, all)?;
        let written = &self.resonance;
        same("hits", written.hits, sum(|c| c.hits))?;
        same("quiet", written.quiet, sum(|c| c.quiet))?;
        same("misses", written.misses, sum(|c| c.misses))?;
        same("false_alarms", written.false_alarms, sum(|c| c.false_alarms))?;
        same("beyond_verlet", written.beyond_verlet, sum(|c| c.beyond_verlet))
    }

    fn offender(&self, pairs: &Pairs, placed: &Placed, context: &Context) -> Checked {
        let row = placed.row;
        let (line, k) = placed.at.ok_or_else(|| Fault::Wrong("is one offender too many".into()))?;
        let clocks = pairs.clocks(line, k)?;
        let here = pairs.is_at(row, line, k) && (row.p, row.q) == clocks.ratio().terms();
        holds(here, || format!("is not the next offender, which has h2/h1 = {}", clocks.ratio()))?;
        let verdict = if affordable(&clocks) {
            full_period(&clocks).verdict
        } else {
            again(Tier::Refine, &clocks, &context.limits())?.verdict
        };
        let kind = verdict.kind();
        same("its kind", row.kind.name(), kind.name())?;
        same("its kind by the tan criterion", row.tan.name(), kind.name())?;
        let rule = self.rule(&clocks, verdict);
        same("its offence", row.offence.as_str(), rule.map_or("none", Rule::name))?;
        const BITS: u32 = 96;
        let (Some(angle), Some(m), Some(written)) = (clocks.angle(), row.m, row.distance) else {
            return holds(rule.is_none() && row.m.is_none() && row.distance.is_none(), || {
                "its angle is missing".into()
            });
        };
        let integer = |n: u64| Ball::from_integer(&n.into());
        let turns = angle.over_pi(BITS).mul(&integer(clocks.p()), BITS);
        let distance = turns.sub(&integer(m), BITS);
        let half = Rational::new(1.into(), 2.into());
        let nearest = distance.lower() <= half && distance.upper() >= -half;
        holds(nearest, || format!("m = {m} is not the nearest to {}", turns.mid_f64()))?;
        holds(written.holds(&distance), || format!("its distance is {}", distance.mid_f64()))
    }
}

impl Pairs {
    fn lines(&self) -> usize {
        match self {
            Pairs::Grid(grid) => grid.shape().0,
            Pairs::Ratios { list, .. } => list.len(),
        }
    }

    fn length(&self) -> u64 {
        match self {
            Pairs::Grid(grid) => grid.shape().1 as u64,
            Pairs::Ratios { samples, .. } => *samples,
        }
    }

    fn s(k: u64, samples: u64) -> Rational {
        Rational::new((4 * (k + 1)).into(), (samples + 1).into())
    }

    fn clocks(&self, line: usize, k: u64) -> Result<TwoClocks<Laurent>> {
        match self {
            Pairs::Grid(grid) => grid.clocks(grid.columns().0 + line as u64, grid.rows().0 + k),
            Pairs::Ratios { list, rho, samples } => {
                let strengths = [Pairs::s(k, *samples), rho.clone()].map(Laurent::from_rational);
                let [s, rho] = strengths;
                Ok(TwoClocks::with_rho(list[line], s, rho))
            }
        }
    }

    /// Whether a row is pair k of a line.
    fn is_at(&self, row: &Offender, line: usize, k: u64) -> bool {
        match self {
            Pairs::Grid(grid) => {
                let steps = (grid.h1(grid.columns().0 + line as u64), grid.h2(grid.rows().0 + k));
                let written = (row.h1.as_deref(), row.h2.as_deref());
                written == (Some(&steps.0), Some(&steps.1)) && row.s.is_none() && row.rho.is_none()
            }
            Pairs::Ratios { rho, samples, .. } => {
                let written = (row.s.as_deref(), row.rho.as_deref());
                written == (Some(&Pairs::s(k, *samples)), Some(rho)) && row.h1.is_none() && row.h2.is_none()
            }
        }
    }
}
