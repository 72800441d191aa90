//! filter → refine → exact.

use super::exact::Decidable;
use super::kind::Verdict;
use super::lone;
use crate::error::{Error, Result};
use crate::number::Real;
use crate::orbit::floquet::Floquet;
use crate::orbit::{filter, plain, refine};
use crate::propagator::TwoClocks;
use crate::schedule::Schedule;

/// Which tier decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Tier {
    /// Doubles in Floquet coordinates, min(p, q)/2 updates, with a proven bound; where there are none, kick by kick,
    /// and a closed form where only one clock kicks.
    Filter,
    /// Kicks and drifts in multiple precision, p + q of them, with the same bound.
    Refine,
    /// Exact arithmetic.
    Exact,
}

impl Tier {
    /// All tiers, the cheapest first.
    pub const ALL: [Tier; 3] = [Tier::Filter, Tier::Refine, Tier::Exact];

    /// The tier's name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Tier::Filter => "filter",
            Tier::Refine => "refine",
            Tier::Exact => "exact",
        }
    }
}

/// A proven answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    pub verdict: Verdict,
    pub decided_by: Tier,
}

/// How much work one verdict may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most kicks that one tier may compose: min(p, q)/2 in the filter, (p + q)/2 in the refine tier; for
    /// the exact tier its cost in kicks of the refine tier, [`Decidable::exact_cost`].
    pub kicks: u64,
}

impl Default for Limits {
    /// 10^8 kicks: about a second in the filter, minutes in the other tiers. That is p + q up to some 2·10^8 in
    /// the refine tier, 2·10^5 in the exact one over the rationals, 900 over Q\[π\].
    fn default() -> Self {
        Limits { kicks: 100_000_000 }
    }
}

impl Limits {
    /// # Errors
    /// A budget error that tells the cost where `kicks` exceeds the limit.
    pub(super) fn allow(&self, kicks: u64, tier: Tier) -> Result<()> {
        if kicks <= self.kicks {
            return Ok(());
        }
        // A kick costs the filter some 10 ns, the others about 1 µs a pass.
        let seconds = if tier == Tier::Filter { kicks / 100_000_000 } else { kicks / 1_000_000 };
        let work = match tier {
            Tier::Exact => "work as long as for",
            _ => "compose",
        };
        let (tier, seconds, limit) = (tier.name(), seconds.max(1), self.kicks);
        let cost = format!(
            "the {tier} tier would {work} {kicks} kicks, on the order of {seconds} s; the budget is {limit}"
        );
        Err(Error::budget(cost, kicks).or("choose steps with a simpler ratio"))
    }
}

/// The precisions of the refine tier in bits, as far as the exact tier is expected to cost more.
const PRECISIONS: [u32; 3] = [128, 256, 512];

/// Decides the pair, with the cheapest tier that can.
///
/// # Errors
/// A budget error, before the work begins, where a tier would need more than `limits` allows.
pub fn decide<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Decision> {
    decide_from(Tier::Filter, clocks, limits)
}

/// Decides the pair without the tiers below `first`: for cross-checks by another route.
///
/// # Errors
/// As [`decide`].
pub fn decide_from<S: Decidable>(first: Tier, clocks: &TwoClocks<S>, limits: &Limits) -> Result<Decision> {
    for decided_by in Tier::ALL.into_iter().filter(|&tier| tier >= first) {
        let verdict = match decided_by {
            Tier::Filter => by_filter(clocks, limits)?,
            Tier::Refine => by_refine(clocks, limits)?,
            Tier::Exact => Some(by_exact(clocks, limits)?),
        };
        if let Some(verdict) = verdict {
            return Ok(Decision { verdict, decided_by });
        }
    }
    unreachable!("the exact tier decides every pair")
}

/// The verdict where doubles in Floquet coordinates certify it, for routes that have their own exact form.
pub(crate) fn filter_only<S: Real>(clocks: &TwoClocks<S>) -> Option<Verdict> {
    filter::run(&Floquet::new(clocks)?)?.signs().verdict()
}

fn by_filter<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Option<Verdict>> {
    let Some(floquet) = Floquet::new(clocks) else { return without_floquet(clocks, limits) };
    limits.allow(floquet.updates(), Tier::Filter)?;
    Ok(filter::run(&floquet).and_then(|ends| ends.signs().verdict()))
}

/// One clock alone in closed form, or kick by kick.
fn without_floquet<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Option<Verdict>> {
    if let Some(verdict) = lone::verdict(clocks) {
        return Ok(Some(verdict));
    }
    let schedule = Schedule::two_clocks(clocks.ratio())?;
    limits.allow(schedule.strikes() / 2, Tier::Filter)?;
    Ok(plain::signs(clocks, &schedule).and_then(|signs| signs.verdict()))
}

fn by_refine<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Option<Verdict>> {
    let schedule = Schedule::two_clocks(clocks.ratio())?;
    limits.allow(schedule.strikes() / 2, Tier::Refine)?;
    let verdict = |bits: u32| refine::run(clocks, &schedule, bits)?.signs().verdict();
    let found = PRECISIONS.into_iter().find_map(verdict);
    if found.is_some() || !S::surely_nonzero(clocks) {
        return Ok(found);
    }
    // No entry is zero: some precision tells all four signs. Strengths so far apart that 2^14 bits do not suffice
    // come with short periods in practice, and exact arithmetic is the shorter way.
    Ok((10..15).map(|log2| 1 << log2).find_map(verdict))
}

fn by_exact<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Verdict> {
    let schedule = Schedule::two_clocks(clocks.ratio())?;
    limits.allow(S::exact_cost(clocks, schedule.strikes() / 2), Tier::Exact)?;
    Ok(S::half_signs(clocks).verdict())
}
