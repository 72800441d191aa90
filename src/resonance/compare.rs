//! The trace condition against the resonance predictions, pair by pair.
//!
//! Two questions are asked of every pair. Does the tan criterion say what the trace says? (It must, for every
//! q: both are exact.) And does the rule of thumb "unstable whenever q h2 is near an integer multiple of T½" say
//! so, "near" meaning |p θ/π − m| ≤ tolerance for some m ≥ 1? (It need not.)
//!
//! ```
//! use kickdrift::number::rational::ratio;
//! use kickdrift::propagator::TwoClocks;
//! use kickdrift::resonance::compare::{compare, Outcome};
//! use kickdrift::verdict::Limits;
//! // A closed tongue: q h2 is near 4 T½ and yet the pair is stable.
//! let clocks = TwoClocks::with_rho("5/3".parse().unwrap(), ratio(11, 4), ratio(114, 55));
//! let pair = compare(&clocks, &ratio(1, 2), &Limits::default()).unwrap();
//! assert!(pair.tan_agrees());
//! assert_eq!(pair.outcome, Some(Outcome::FalseAlarm));
//! ```

use super::angle::Nearest;
use super::tan;
use crate::error::Result;
use crate::number::Rational;
use crate::propagator::TwoClocks;
use crate::verdict::{Decidable, Decision, Limits, Tier, Verdict, decide_from};

/// What the rule of thumb makes of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// Unstable and near a resonance.
    Hit,
    /// Stable and away from all resonances.
    Quiet,
    /// Unstable, but away from all resonances.
    Miss,
    /// Stable, but near a resonance.
    FalseAlarm,
}

impl Outcome {
    /// What the rule makes of a pair that is stable or not, near a resonance or not.
    pub fn of(stable: bool, near: bool) -> Outcome {
        match (stable, near) {
            (false, true) => Outcome::Hit,
            (true, false) => Outcome::Quiet,
            (false, false) => Outcome::Miss,
            (true, true) => Outcome::FalseAlarm,
        }
    }

    /// The outcome's name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Hit => "hit",
            Outcome::Quiet => "quiet",
            Outcome::Miss => "miss",
            Outcome::FalseAlarm => "false alarm",
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
    /// By kicks and drifts (the refine and exact tiers), which share nothing with the tan criterion.
    pub trace: Decision,
    /// By the tan criterion.
    pub tan: Verdict,
    /// The nearest resonance; `None` beyond the fast clock's Verlet limit s = 4, where there is no θ.
    pub nearest: Option<Nearest>,
    /// What the rule of thumb makes of it; `None` where there is no θ.
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
    let trace = decide_from(Tier::Refine, clocks, limits)?;
    let tan = tan::criterion(clocks).verdict();
    let angle = clocks.angle();
    let outcome = angle
        .as_ref()
        .map(|angle| Outcome::of(trace.verdict.is_stable(), angle.is_resonant(clocks.p(), tolerance)));
    let nearest = angle.map(|angle| angle.nearest(clocks.p(), BITS));
    Ok(Comparison { trace, tan, nearest, outcome })
}

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
