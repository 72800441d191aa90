//! The trace condition against the resonance predictions, pair by pair.
//!
//! Two questions are asked of every pair. Does the tan criterion say what the trace says? (It must, for every
//! q: both are exact, each by arithmetic of its own.) And does the rule of thumb "unstable whenever q h2 is
//! near an integer multiple of T½" say so, "near" meaning |p θ/π − m| ≤ tolerance for some m ≥ 1? (It need
//! not.)
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::propagator::TwoClocks;
//! use kickdrift_clocks::resonance::compare::{compare, Outcome};
//! use kickdrift_clocks::verdict::Limits;
//! // A closed tongue: q h2 is near 4 T½ and yet the pair is stable.
//! let clocks = TwoClocks::with_rho("5/3".parse().unwrap(), ratio(11, 4), ratio(114, 55));
//! let pair = compare(&clocks, &ratio(1, 2), &Limits::default()).unwrap();
//! assert!(pair.tan_agrees());
//! assert_eq!(pair.outcome, Some(Outcome::FalseAlarm));
//! ```

use super::angle::Nearest;
use super::tan;
use crate::orbit::refine;
use crate::propagator::TwoClocks;
use crate::verdict::{Decidable, Decision, Limits, Tier, Verdict, decide_from};
use number::parallel::{go_on, try_map};
use number::{Error, Laurent, Ratio, Rational, Result, named};

named! {
    /// The rule of thumb held against the verdict of a pair.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Outcome {
        /// Unstable and near a resonance.
        Hit = "hit",
        /// Stable and away from all resonances.
        Quiet = "quiet",
        /// Unstable, but away from all resonances.
        Miss = "miss",
        /// Stable, but near a resonance.
        FalseAlarm = "false alarm",
    }
}

impl Outcome {
    /// The outcome for a pair that is stable or not, near a resonance or not.
    pub fn of(stable: bool, near: bool) -> Outcome {
        match (stable, near) {
            (false, true) => Outcome::Hit,
            (true, false) => Outcome::Quiet,
            (false, false) => Outcome::Miss,
            (true, true) => Outcome::FalseAlarm,
        }
    }

    /// Whether the rule is wrong here.
    pub fn is_offence(self) -> bool {
        matches!(self, Outcome::Miss | Outcome::FalseAlarm)
    }
}

/// Both predictions beside the trace's verdict.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Rests on kicks and drifts one by one, in multiple precision or exactly (the refine and exact tiers).
    pub trace: Decision,
    /// Rests on turns of the fast clock by θ with the slow kicks between them, in balls or exactly
    /// ([`tan::criterion`]): the two sides share the numbers and the table of signs, and no arithmetic
    /// beyond.
    pub tan: Verdict,
    /// The nearest resonance; `None` beyond the fast clock's Verlet limit s = 4, where there is no θ.
    pub nearest: Option<Nearest>,
    /// The rule of thumb held against the verdict; `None` where there is no θ.
    pub outcome: Option<Outcome>,
}

impl Comparison {
    /// Whether the tan criterion and the trace give one verdict.
    pub fn tan_agrees(&self) -> bool {
        self.tan == self.trace.verdict
    }
}

/// Compares one pair; `tolerance` in units of T½.
///
/// # Errors
/// A budget error where the period is longer than `limits` allows.
pub fn compare<S: Decidable>(
    clocks: &TwoClocks<S>,
    tolerance: &Rational,
    limits: &Limits,
) -> Result<Comparison> {
    const BITS: u32 = 64;
    let trace = decide_from(Tier::Refine, clocks, limits)?.decision();
    let tan = tan::criterion(clocks, limits)?;
    let angle = clocks.angle();
    let outcome = angle
        .as_ref()
        .map(|angle| Outcome::of(trace.verdict.is_stable(), angle.is_resonant(clocks.p(), tolerance)));
    let nearest = angle.map(|angle| angle.nearest(clocks.p(), BITS));
    Ok(Comparison { trace, tan, nearest, outcome })
}

/// That pairs which compose so many kicks together are within the limits: each pair's half period kick by
/// kick, or what return maps of a longer one cost, and the tan criterion's turns. The `ratios` are those of
/// some of the pairs.
///
/// # Errors
/// A budget error in kicks.
pub fn allow(pairs: u64, ratios: impl Iterator<Item = Ratio>, limits: &Limits) -> Result<()> {
    let (mut kicks, mut sampled) = (0.0, 0u64);
    for ratio in ratios {
        kicks += PAIR + refine::kicks(ratio).min(LONGEST) as f64 + TURN * (ratio.q() / 2) as f64;
        sampled += 1;
    }
    let kicks = (kicks / sampled.max(1) as f64 * pairs as f64).ceil();
    if kicks <= limits.kicks as f64 {
        return Ok(());
    }
    let cost = format!(
        "comparing {pairs} pairs costs as much as {kicks:.1e} kicks, some {:.0} min of one core; the budget is {} kicks",
        (kicks / KICKS_A_MINUTE).max(1.0),
        limits.kicks
    );
    Err(Error::budget(cost, kicks as u64).or("choose fewer pairs"))
}

/// Numbers made and compared for each pair cost as much as so many kicks.
const PAIR: f64 = 40.0;

/// Return maps of a long period cost as much as so many kicks.
const LONGEST: u64 = 1 << 10;

/// A turn of the tan criterion costs as much as so many kicks.
const TURN: f64 = 4.0;

const KICKS_A_MINUTE: f64 = 6e7;

/// Counts over many pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub pairs: u64,
    pub unstable: u64,
    pub tan_agree: u64,
    pub tan_disagree: u64,
    pub hits: u64,
    pub quiet: u64,
    pub misses: u64,
    pub false_alarms: u64,
    /// Pairs with s ≥ 4, for which the rule of thumb says nothing.
    pub beyond_verlet: u64,
}

impl Tally {
    /// Counts one pair in.
    pub fn add(&mut self, pair: &Comparison) {
        self.pairs += 1;
        self.unstable += u64::from(!pair.trace.verdict.is_stable());
        *(if pair.tan_agrees() { &mut self.tan_agree } else { &mut self.tan_disagree }) += 1;
        *match pair.outcome {
            Some(Outcome::Hit) => &mut self.hits,
            Some(Outcome::Quiet) => &mut self.quiet,
            Some(Outcome::Miss) => &mut self.misses,
            Some(Outcome::FalseAlarm) => &mut self.false_alarms,
            None => &mut self.beyond_verlet,
        } += 1;
    }

    /// The counts of two disjoint sets of pairs together.
    #[must_use]
    pub fn plus(mut self, other: &Tally) -> Self {
        self.pairs += other.pairs;
        self.unstable += other.unstable;
        self.tan_agree += other.tan_agree;
        self.tan_disagree += other.tan_disagree;
        self.hits += other.hits;
        self.quiet += other.quiet;
        self.misses += other.misses;
        self.false_alarms += other.false_alarms;
        self.beyond_verlet += other.beyond_verlet;
        self
    }
}

/// A pair at which a prediction is wrong.
#[derive(Clone, Debug)]
pub struct Offender {
    /// Two exact quantities that name the pair: h1 and h2 on a grid, s and ρ for ratios.
    pub place: [Laurent; 2],
    pub ratio: Ratio,
    pub comparison: Comparison,
}

/// Many pairs compared: the counts, and the pairs at which a prediction is wrong, in order.
#[derive(Clone, Debug, Default)]
pub struct Comparisons {
    pub tally: Tally,
    pub offenders: Vec<Offender>,
}

impl Comparisons {
    /// Compares one more pair.
    ///
    /// # Errors
    /// As [`compare`].
    pub fn add<S: Decidable>(
        &mut self,
        clocks: &TwoClocks<S>,
        place: impl FnOnce() -> [Laurent; 2],
        tolerance: &Rational,
        limits: &Limits,
    ) -> Result<()> {
        go_on()?;
        let comparison = compare(clocks, tolerance, limits)?;
        self.tally.add(&comparison);
        if !comparison.tan_agrees() || comparison.outcome.is_some_and(Outcome::is_offence) {
            self.offenders.push(Offender { place: place(), ratio: clocks.ratio(), comparison });
        }
        Ok(())
    }

    /// The parts of all items, on all threads, joined in the items' order.
    ///
    /// # Errors
    /// A negative tolerance, and those of the parts.
    pub fn gather<T: Sync>(
        items: &[T],
        tolerance: &Rational,
        part: impl Fn(&T, &mut Comparisons) -> Result<()> + Sync,
    ) -> Result<Comparisons> {
        if *tolerance < Rational::default() {
            return Err(Error::input("tolerance", tolerance, "must not be negative"));
        }
        let one = |item: &T| {
            let mut found = Comparisons::default();
            part(item, &mut found).map(|()| found)
        };
        let parts: Vec<Comparisons> = try_map(items, one)?;
        Ok(parts.into_iter().fold(Comparisons::default(), |mut all, mut part| {
            all.tally = all.tally.plus(&part.tally);
            all.offenders.append(&mut part.offenders);
            all
        }))
    }
}

/// Every ratio with p + q ≤ `max_sum` at s = 4k/(samples + 1), k = 1, ..., samples.
///
/// # Errors
/// Numbers beyond 2000 and a million, a negative tolerance, and as [`compare`].
pub fn compare_ratios(
    max_sum: u64,
    rho: &Rational,
    samples: u64,
    tolerance: &Rational,
    limits: &Limits,
) -> Result<Comparisons> {
    if !(2..=2000).contains(&max_sum) {
        return Err(Error::input("max-sum", max_sum, "choose 2 to 2000"));
    }
    if !(1..=1_000_000).contains(&samples) {
        return Err(Error::input("samples", samples, "choose 1 to 1000000"));
    }
    let ratios: Vec<Ratio> = Ratio::up_to(max_sum).collect();
    allow(samples * ratios.len() as u64, ratios.iter().copied(), limits)?;
    Comparisons::gather(&ratios, tolerance, |&ratio, found| {
        (1..=samples).try_for_each(|k| {
            let s = Rational::new((4 * k).into(), (samples + 1).into());
            let place = || [Laurent::from(&s), Laurent::from(rho)];
            found.add(&TwoClocks::with_rho(ratio, s.clone(), rho.clone()), place, tolerance, limits)
        })
    })
}
