//! filter → refine → exact.

use std::cell::Cell;
use std::ops::RangeInclusive;
use std::sync::OnceLock;

use num_bigint::BigInt;

use super::answer::{Answer, Decision};
use super::exact::Decidable;
use super::growth::{Growth, Runs, long_growth};
use super::kind::{Side, Verdict};
use super::lone;
use super::tier::{Limits, Tier};
use crate::orbit::floquet::Floquet;
use crate::orbit::returns::{self, Found, Wanted};
use crate::orbit::{filter, plain, refine};
use crate::propagator::{LongClocks, Oscillator, TwoClocks};
use crate::schedule::Schedule;
use number::parallel::go_on;
use number::{Error, Result, Sign};

/// The precisions of the refine tier in bits, as far as the exact tier is expected to cost more.
const PRECISIONS: [u32; 3] = [128, 256, 512];

/// The least precision in which kicks of any strength are followed.
const PAST_THE_BOUND: u32 = 1024;

/// The binary digits of the longest period that is tried: a power of one step takes as many squarings of
/// numbers with three times as many digits, half a second here.
const LONGEST_RATIO: u64 = 1 << 12;

/// Decides the pair, with the cheapest tier that can.
///
/// # Errors
/// A budget error, before the work begins, where a tier would need more than `limits` allows; `Stopped` where
/// the work is [stoppable](number::parallel::stoppable) and was stopped: at once in the refine tier, after
/// their run in the others.
pub fn decide<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Answer<S>> {
    decide_from(Tier::Filter, clocks, limits)
}

/// Decides the pair without the tiers below `first`: for cross-checks by another route.
///
/// # Errors
/// As [`decide`].
pub fn decide_from<S: Decidable>(first: Tier, clocks: &TwoClocks<S>, limits: &Limits) -> Result<Answer<S>> {
    let mut runs = Runs::default();
    let (verdict, decided_by) = by_tiers(first, clocks, limits, &mut runs)?;
    Ok(Answer { verdict, decided_by, clocks: clocks.clone(), limits: *limits, runs, growth: OnceLock::new() })
}

/// The first tier from `first` on that proves a verdict.
fn by_tiers<S: Decidable>(
    first: Tier,
    clocks: &TwoClocks<S>,
    limits: &Limits,
    runs: &mut Runs,
) -> Result<(Verdict, Tier)> {
    if first == Tier::Filter
        && let Some(verdict) = lone::verdict(clocks)
    {
        return Ok((verdict, Tier::Filter));
    }
    if first != Tier::Exact && returns::is_worth(clocks.ratio(), 53) {
        let least = if first == Tier::Filter { 53 } else { 106 };
        if let Some((verdict, bits)) = by_returns(clocks, least..=256, runs)? {
            return Ok((verdict, if bits == 53 { Tier::Filter } else { Tier::Refine }));
        }
        // No tier follows the kicks of such a period, but where one clock strikes seldom.
        let updates = clocks.p().min(clocks.q()) / 2;
        if Schedule::two_clocks(clocks.ratio()).is_err() && limits.allow(updates, Tier::Filter).is_err() {
            return Err(undecided(&(BigInt::from(clocks.p()) + clocks.q())));
        }
    }
    for tier in Tier::ALL.into_iter().filter(|&tier| tier >= first) {
        let verdict = match tier {
            Tier::Filter => by_filter(clocks, limits, runs)?,
            Tier::Refine => by_refine(clocks, limits, runs)?,
            Tier::Exact => Some(by_exact(clocks, limits)?),
        };
        if let Some(verdict) = verdict {
            return Ok((verdict, tier));
        }
    }
    unreachable!("the exact tier decides every pair")
}

/// Decides a long period by another route than [`decide`]: return maps over the other clock, or in more bits.
/// `None` where neither decides.
///
/// # Errors
/// `Stopped`.
pub fn decide_anew<S: Decidable>(clocks: &LongClocks<S>) -> Result<Option<(Verdict, Growth)>> {
    let [_, middle, most] = returns::PRECISIONS;
    for (over_other, bits) in [(true, middle), (false, most)] {
        go_on()?;
        let run = if over_other { returns::run_over_other } else { returns::run };
        let Some(ends) = run(clocks, bits, Wanted::Entries) else { continue };
        if let Some(verdict) = ends.signs().verdict() {
            let runs = Runs { refined: Some((ends, bits)), ..Runs::default() };
            return runs.long_growth(clocks, verdict).map(|growth| Some((verdict, growth)));
        }
    }
    go_on().map(|()| None)
}

/// Decides a pair whose period may hold any number of kicks, as that of two steps that are doubles does, by
/// return maps alone.
///
/// ```
/// use kickdrift_clocks::number::{Laurent, Rational};
/// use kickdrift_clocks::propagator::Oscillator;
/// use kickdrift_clocks::verdict::{Kind, decide_long};
/// let exact = |x: f64| Laurent::from_rational(Rational::from_float(x).unwrap());
/// // The doubles 0.001 and 0.9: a period of 10^19 fast kicks.
/// let oscillator = Oscillator::new(exact(10.0), exact(0.4), exact(0.001), exact(0.9))?;
/// assert_eq!(decide_long(&oscillator.long_clocks())?.verdict.kind(), Kind::Elliptic);
/// # Ok::<(), kickdrift_clocks::number::error::Error>(())
/// ```
///
/// # Errors
/// A budget error where return maps in 256 bits decide no verdict: on an edge of a tongue exactly or next to
/// it, and where kicks are so strong that the bound exceeds the entries (proofs/RETURNS.md); at once where
/// the period has more than 2^4096 kicks. `Stopped`.
pub fn decide_long<S: Decidable>(clocks: &LongClocks<S>) -> Result<Decision> {
    let kicks = clocks.ratio().numer() + clocks.ratio().denom();
    if kicks.bits() > LONGEST_RATIO {
        let work = format!(
            "the period has {} kicks, and a verdict's cost grows with the cube of the digits",
            short(&kicks)
        );
        return Err(Error::too_much(work, "choose steps of fewer digits: at most 1200"));
    }
    for bits in returns::PRECISIONS {
        go_on()?;
        if let Some((verdict, _)) = returned(clocks, bits, Wanted::Verdict) {
            let decided_by = if bits == 53 { Tier::Filter } else { Tier::Refine };
            return Ok(Decision { verdict, decided_by });
        }
    }
    go_on()?;
    Err(undecided(&kicks))
}

/// Where return maps decide nothing, of a period that is too long for kicks.
fn undecided(kicks: &BigInt) -> Error {
    let work = format!(
        "256 bits do not decide the verdict, and the period has {} kicks: the pair is on an edge of a tongue or next to one, or its kicks are very strong",
        short(kicks)
    );
    Error::too_much(work, "move a step by a hair, or choose steps with a simpler ratio")
}

/// A whole number, or its power of two.
fn short(n: &BigInt) -> String {
    if n.bits() < 64 { n.to_string() } else { format!("some 2^{}", n.bits()) }
}

/// Decides the pair by [`decide`], or by [`decide_long`] where its period is too long for that.
///
/// # Errors
/// Those of both.
pub fn decide_steps(oscillator: &Oscillator, limits: &Limits) -> Result<Decision> {
    match oscillator.clocks() {
        Ok(clocks) => decide(&clocks, limits).map(|answer| answer.decision()),
        Err(_) => decide_long(&oscillator.long_clocks()),
    }
}

/// As [`decide_steps`], from the tier `first` on, with trace, growth and label.
///
/// # Errors
/// As there; where a long period is to be decided in exact arithmetic, and where its entries have more than
/// 2^58 binary digits.
pub fn decide_with_growth(
    oscillator: &Oscillator,
    first: Tier,
    limits: &Limits,
) -> Result<(Decision, Growth)> {
    match oscillator.clocks() {
        Err(_) if first != Tier::Exact => {
            let clocks = oscillator.long_clocks();
            let decision = decide_long(&clocks)?;
            Ok((decision, long_growth(&clocks, decision.verdict)?))
        }
        clocks => {
            let answer = decide_from(first, &clocks?, limits)?;
            Ok((answer.decision(), answer.growth()?.clone()))
        }
    }
}

/// By return maps in the least of these bits, then in more; with the bits that decide. `None` where no
/// precision does: an entry may be zero, or a partial quotient too large.
fn by_returns<S: Decidable>(
    clocks: &TwoClocks<S>,
    precisions: RangeInclusive<u32>,
    runs: &mut Runs,
) -> Result<Option<(Verdict, u32)>> {
    let long = clocks.into();
    // Another route than the first tier's goes to the end.
    let wanted = if *precisions.start() == 53 { Wanted::Verdict } else { Wanted::Entries };
    for bits in returns::PRECISIONS.into_iter().filter(|bits| precisions.contains(bits)) {
        go_on()?;
        if let Some((verdict, ends)) = returned(&long, bits, wanted) {
            runs.refined = ends.map(|ends| (ends, bits));
            return Ok(Some((verdict, bits)));
        }
    }
    go_on().map(|()| None)
}

/// The verdict by return maps, with the half period where it took all of it.
fn returned<S: Decidable>(
    clocks: &LongClocks<S>,
    bits: u32,
    wanted: Wanted,
) -> Option<(Verdict, Option<refine::Ends>)> {
    let Found { signs, grows, ends } = returns::decisive(clocks, bits, wanted)?;
    let side = grows.map(|sign| if sign == Sign::Positive { Side::Plus } else { Side::Minus });
    Some((side.map(Verdict::Hyperbolic).or_else(|| signs.verdict())?, ends))
}

fn by_filter<S: Decidable>(
    clocks: &TwoClocks<S>,
    limits: &Limits,
    runs: &mut Runs,
) -> Result<Option<Verdict>> {
    let Some(floquet) = Floquet::new(clocks) else {
        runs.filtered = Some(None);
        return without_floquet(clocks, limits, runs);
    };
    limits.allow(floquet.updates(), Tier::Filter)?;
    let ends = filter::run(&floquet);
    runs.filtered = Some(ends);
    Ok(ends.and_then(|ends| ends.signs().verdict()))
}

/// Kick by kick.
fn without_floquet<S: Decidable>(
    clocks: &TwoClocks<S>,
    limits: &Limits,
    runs: &mut Runs,
) -> Result<Option<Verdict>> {
    let schedule = Schedule::two_clocks(clocks.ratio())?;
    // Both clocks are beyond their own limits: over so many kicks entries exceed all doubles, and the cost is
    // that of the next tier.
    let is_allowed = limits.allow(schedule.strikes() / 2, Tier::Filter).is_ok();
    let ends = if is_allowed { plain::run(clocks, &schedule) } else { None };
    runs.filtered = Some(ends);
    Ok(ends.and_then(|ends| ends.signs().verdict()))
}

fn by_refine<S: Decidable>(
    clocks: &TwoClocks<S>,
    limits: &Limits,
    runs: &mut Runs,
) -> Result<Option<Verdict>> {
    let ratio = clocks.ratio();
    // From there on they were tried before the filter.
    if returns::is_worth(ratio, 106)
        && !returns::is_worth(ratio, 53)
        && let Some((verdict, _)) = by_returns(clocks, 106..=106, runs)?
    {
        return Ok(Some(verdict));
    }
    let schedule = Schedule::two_clocks(ratio)?;
    limits.allow(refine::kicks(ratio), Tier::Refine)?;
    let has_room = Cell::new(false);
    let mut verdict = |bits: u32| {
        let ends = refine::run_at_any(clocks, &schedule, bits)?;
        has_room.set(true);
        let verdict = ends.signs().verdict();
        runs.refined = Some((ends, bits));
        verdict
    };
    let found = PRECISIONS.into_iter().find_map(&mut verdict);
    go_on()?;
    // Kicks so strong that the bound has no room are decided by balls as a rule, and exact numbers are as
    // long as they are strong.
    let found = found.or_else(|| if has_room.get() { None } else { verdict(PAST_THE_BOUND) });
    if found.is_some() || !S::surely_nonzero(clocks) {
        return Ok(found);
    }
    // No entry is zero: some precision decides all four signs. Where 2^14 bits do not suffice, the periods
    // are short in practice, and exact arithmetic is the shorter way.
    let found = (10..15).map(|log2| 1 << log2).find_map(verdict);
    go_on().map(|()| found)
}

fn by_exact<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Verdict> {
    let schedule = Schedule::two_clocks(clocks.ratio())?;
    limits.allow(S::exact_cost(clocks, schedule.strikes() / 2), Tier::Exact)?;
    Ok(S::half_signs(clocks).verdict())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    use super::*;
    use number::error::Kind;
    use number::parallel::stoppable;
    use number::{Ratio, ratio};

    /// Before it begins and on the way; the kicks that are left would take many times as long.
    #[test]
    fn a_long_verdict_hears_that_it_was_stopped() {
        // Both clocks beyond their own limits.
        let clocks =
            TwoClocks::with_rho(Ratio::new(10_000_001, 10_000_003).unwrap(), ratio(5, 1), ratio(1, 1));
        let flag = Arc::new(AtomicBool::new(true));
        let decided = || stoppable(&flag, || decide_from(Tier::Refine, &clocks, &Limits::default()));
        assert_eq!(decided().unwrap_err().kind(), Kind::Stopped);
        flag.store(false, Ordering::Relaxed);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(50));
                flag.store(true, Ordering::Relaxed);
            });
            assert_eq!(decided().unwrap_err().kind(), Kind::Stopped);
        });
    }
}
