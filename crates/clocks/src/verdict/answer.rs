//! The answer to "is this pair stable?", and what else there is to say, computed when it is asked for.

use std::sync::OnceLock;

use super::exact::Decidable;
use super::growth::{Growth, Runs};
use super::kind::Verdict;
use super::tier::{Limits, Tier};
use crate::propagator::TwoClocks;
use number::{Ball, Result};

/// A proven answer. Trace, growth and label cost hundreds of verdicts where the filter decided, so they are
/// computed when first asked for, from the runs that decided as far as these reach.
///
/// ```
/// use kickdrift_clocks::number::rational::ratio;
/// use kickdrift_clocks::propagator::TwoClocks;
/// use kickdrift_clocks::verdict::{Limits, Side, Verdict, decide};
/// let clocks = TwoClocks::with_rho("7/3".parse()?, ratio(19, 8), ratio(1, 25));
/// let answer = decide(&clocks, &Limits::default())?;
/// assert_eq!(answer.verdict, Verdict::Hyperbolic(Side::Plus));
/// assert_eq!((answer.label()?, answer.family()?), (Some(4), Some((1, -1))));
/// assert!(answer.trace()?.mid_f64() > 2.0);
/// # Ok::<(), kickdrift_clocks::number::error::Error>(())
/// ```
///
/// As JSON: the verdict, its tier, and the growth, null where it was not asked for yet.
#[derive(Debug, serde::Serialize)]
#[serde(bound = "")]
pub struct Answer<S> {
    /// Stable or not, and on which side.
    pub verdict: Verdict,
    /// The tier that proved it.
    pub decided_by: Tier,
    #[serde(skip)]
    pub(super) clocks: TwoClocks<S>,
    #[serde(skip)]
    pub(super) limits: Limits,
    #[serde(skip)]
    pub(super) runs: Runs,
    #[serde(serialize_with = "where_known")]
    pub(super) growth: OnceLock<Growth>,
}

/// A verdict and the tier that proved it: an [`Answer`] without its pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Decision {
    pub verdict: Verdict,
    pub decided_by: Tier,
}

fn where_known<Z: serde::Serializer>(
    growth: &OnceLock<Growth>,
    out: Z,
) -> std::result::Result<Z::Ok, Z::Error> {
    serde::Serialize::serialize(&growth.get(), out)
}

impl<S: Decidable> Answer<S> {
    /// The pair.
    pub fn clocks(&self) -> &TwoClocks<S> {
        &self.clocks
    }

    /// The verdict and its tier alone.
    pub fn decision(&self) -> Decision {
        Decision { verdict: self.verdict, decided_by: self.decided_by }
    }

    /// Trace, ln of the multiplier and label.
    ///
    /// # Errors
    /// A budget error where more kicks would have to be composed than the limits of the decision allow.
    pub fn growth(&self) -> Result<&Growth> {
        if self.growth.get().is_none() {
            let growth = self.runs.growth(&self.clocks, self.verdict, &self.limits)?;
            // Another thread that was quicker found the same.
            let _ = self.growth.set(growth);
        }
        Ok(self.growth.get().expect("just set"))
    }

    /// Tr Q, enclosed; on an edge exactly ±2.
    ///
    /// # Errors
    /// As [`Answer::growth`].
    pub fn trace(&self) -> Result<&Ball> {
        Ok(&self.growth()?.trace)
    }

    /// m, the number of half turns that the growing solution makes in a period; `None` unless hyperbolic.
    ///
    /// # Errors
    /// As [`Answer::growth`].
    pub fn label(&self) -> Result<Option<u64>> {
        match self.runs.label(self.verdict) {
            Some(m) => Ok(Some(m)),
            None => Ok(self.growth()?.label),
        }
    }
}
