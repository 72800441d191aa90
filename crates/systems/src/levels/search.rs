//! Edges of what is proven, whoever proves it: margins, ends of regions, the first unstable step, stretches.

use faer::Mat;
use num_complex::Complex64;

use super::growth::{Growing, Sampled};
use crate::friction::{Damping, Radius, damping};
use crate::vary::stretches::{Stretch, cover, merged};
use crate::verdict::measured::Holds;
use number::{Result, bisected};

/// How closely the end of the first region is enclosed, relative.
pub(super) const EDGE: f64 = 1e-8;

/// The largest relative change of the stiffnesses by which one verdict is carried on.
const WIDEST: f64 = 0.05;

/// The largest ε in \[0, 1\] with `holds(ε)`, rounded down within a factor; `None` where not even `holds(0)`.
pub(super) fn largest(width: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    // By halves of the exponent: below 10^-15 the errors of the eigenbasis are larger than the margin.
    let (mut lo, mut hi) = (LEAST_MARGIN, 1.0_f64);
    if !holds(0.0) {
        return None;
    }
    if !holds(lo) {
        return Some(0.0);
    }
    while hi > width * lo {
        let middle = (lo * hi).sqrt();
        *(if holds(middle) { &mut lo } else { &mut hi }) = middle;
    }
    Some(lo)
}

/// A margin below it is rounding.
const LEAST_MARGIN: f64 = 1e-15;

/// The largest number that holds, rounded down within `width`, where none above `most` does: 0 where it is
/// below 10^-15.
pub(super) fn largest_below(most: f64, width: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut hi, mut part) = (most, 1.0 / (1.0 + 0.9 * width));
    while hi > LEAST_MARGIN {
        let lo = part * hi;
        if holds(lo) {
            return bisected((lo, hi), width, |x| Some(holds(x))).0;
        }
        (hi, part) = (lo, part * part);
    }
    0.0
}

/// Two steps below `hi`, one half the other unless that is `hi`: what holds at every step up to some one
/// holds at the first and not at the second one. `None` where it holds at none down to 2⁻⁴⁰ `hi`.
pub(super) fn bracket_below(hi: f64, holds: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
    let lo = (1..=40).map(|k| hi * 0.5f64.powi(k)).find(|&step| holds(step))?;
    Some((lo, hi.min(2.0 * lo)))
}

/// The first of steps that lie farther and farther past one, the first `width` past it, relative, that is
/// proven unstable; `None` where none below `limit` is.
pub(crate) fn first_past(at: f64, width: f64, limit: f64, unstable: impl Fn(f64) -> bool) -> Option<f64> {
    let steps = (0..40).map(|k| at * (1.0 + width * 1.5f64.powi(k)));
    steps.take_while(|step| *step < limit).find(|step| unstable(*step))
}

/// Stretches that cover a range: stable up to `first`, beyond it as cells of it are proven.
pub(super) fn with_first(
    (lo, hi): (f64, f64),
    first: f64,
    width: f64,
    verdict: impl Fn(f64, f64) -> Result<Holds> + Sync,
) -> Result<Vec<Stretch>> {
    let known = (first > lo).then_some(Stretch { lo, hi: first, verdict: Holds::Stable });
    let rest = if first < hi { cover((first, hi), width, verdict)? } else { Vec::new() };
    Ok(merged(known.into_iter().chain(rest)))
}

/// The verdict at one scheme.
#[derive(Clone, Debug)]
pub struct Decided {
    /// The verdict that is proven for all stiffnesses within the accuracy.
    pub holds: Holds,
    /// Whether that is stable, and so for all smaller steps.
    pub is_in_first_region: bool,
    /// The largest ε for which the verdict on the stiffnesses given stands; `None` where none is proven.
    pub margin: Option<f64>,
    /// Growth, rounded; 0 where nothing grows, `None` where that is not decided.
    pub rate: Option<f64>,
    /// Real and imaginary part of the fastest growing shape, mass-weighted.
    pub growing: Option<[Vec<f64>; 2]>,
}

/// Levels at fixed ratios of their steps, over the outer step: what is proven and found at one, and the
/// searches that are made of it.
pub trait Search {
    /// The outer step that they were given with.
    fn outer_step(&self) -> f64;

    /// Two outer steps, 1e-8 apart, relative: every step in (0, lo] is proven stable, hi is not proven to be
    /// in the first region. `None` where the sum of all stiffnesses is not proven definite, so that the
    /// region does not begin at 0, and where its end is beyond what is known of it.
    fn region_end(&self) -> Option<(f64, f64)>;

    /// Whether an outer step is proven stable.
    fn is_stable(&self, step: f64) -> bool;

    /// Whether it is proven unstable.
    fn is_unstable(&self, step: f64) -> bool;

    /// The step up to which every one from `at` on is proven unstable by a verdict at one of them that is
    /// carried on by a relative change of the stiffnesses; `None` where it proves nothing.
    ///
    /// # Errors
    /// A step that is no step, here and below.
    fn unstable_end(&self, at: f64, width: f64) -> Result<Option<f64>>;

    /// max ln |λ| per unit time, rounded.
    ///
    /// # Errors
    /// As above.
    fn rate(&self, step: f64) -> Result<f64>;

    /// Whether a band of periods is proven stable at an outer step, and at every smaller one, for all
    /// stiffnesses within ε of their norms.
    fn covers_band(&self, step: f64, band: f64, epsilon: f64) -> bool;

    /// Two outer steps about the longest at which a band is covered: it `holds` at the first one alone.
    fn band_bracket(&self, holds: &dyn Fn(f64) -> bool) -> Option<(f64, f64)>;

    /// The matrix of a period with friction γ per unit time, and how far it may be off; `None` where doubles
    /// do not tell.
    fn damped_period(&self, step: f64, friction: f64) -> Option<(Mat<f64>, f64)>;

    /// \[lo, hi\]: every outer step in (0, lo] is proven stable, hi is proven unstable; `None` as for
    /// [`Search::region_end`], and where nothing is proven unstable next to it.
    fn first_unstable(&self) -> Option<(f64, f64)> {
        let (lo, hi) = self.region_end()?;
        // Near the end forms are near 0, and doubles cannot decide; a little farther they can.
        let mut steps = (0..16).map(|k| hi + lo * EDGE * f64::from(1 << k));
        steps.find(|&step| self.is_unstable(step)).map(|step| (lo, step))
    }

    /// The step up to which every one from `from` on is proven unstable: up to where the change by which a
    /// verdict is carried on falls to `least`, relative, or 1.5 `from`.
    ///
    /// # Errors
    /// As above.
    fn unstable_up_to(&self, from: f64, least: f64) -> Result<f64> {
        let (mut at, last, mut width) = (from, 1.5 * from, least);
        while at < last {
            match self.unstable_end(at, width)? {
                Some(end) => (at, width) = (end, (4.0 * width).min(WIDEST)),
                None if width <= least => break,
                None => width = (width / 4.0).max(least),
            }
        }
        Ok(at.min(last))
    }

    /// The outer step up to which [`Search::covers_band`] provably holds, within 1e-6 of the longest; `None`
    /// where it does for none.
    fn band_edge(&self, band: f64, epsilon: f64) -> Option<f64> {
        let holds = |step: f64| self.covers_band(step, band, epsilon);
        Some(bisected(self.band_bracket(&holds)?, 1e-6, |step| Some(holds(step))).0)
    }

    /// Stretches that grow from an unstable outer step `from` on, the first samples `width` apart, relative.
    ///
    /// # Errors
    /// As above.
    fn growing(&self, from: f64, width: f64) -> Result<Vec<Growing>> {
        let (rate, is_stable) = (|step: f64| self.rate(step), |step: f64| self.is_stable(step));
        Sampled { rate: &rate, is_stable: &is_stable }.growing(from, width)
    }

    /// Where the spectral radius of a period with friction γ per unit time lies, v → exp(−γ t) v in the
    /// middle of every drift; `None`: doubles cannot decide.
    fn damping(&self, step: f64, friction: f64) -> Option<Damping> {
        let (q, error) = self.damped_period(step, friction)?;
        damping(&q, error, Radius::of(&q, error))
    }

    /// A friction that is proven to mask, where the radius is above 1 without one: at most a thirtieth above
    /// the least that does so in doubles. `None` where none was found.
    fn masking_friction(&self, step: f64) -> Option<f64> {
        let radius = |friction: f64| {
            let eigenvalues = self.damped_period(step, friction).and_then(|(q, _)| q.eigenvalues().ok());
            eigenvalues.map_or(f64::NAN, |all| all.into_iter().map(Complex64::norm).fold(0.0, f64::max))
        };
        let proven = |friction: f64| self.damping(step, friction) == Some(Damping::Damped);
        least_masking(self.rate(step).ok()?, step, radius, proven)
    }
}

/// About the least friction that is proven to mask what grows at this rate without one, bisected by the
/// rounded spectral radius of an outer step.
fn least_masking(
    growth: f64,
    step: f64,
    radius: impl Fn(f64) -> f64,
    proven: impl Fn(f64) -> bool,
) -> Option<f64> {
    let is_damped = |friction: f64| radius(friction) < 1.0;
    let mut hi = 2.0 * growth;
    while hi > 0.0 && !is_damped(hi) {
        hi *= 2.0;
        if hi * step > 1e3 {
            return None;
        }
    }
    let mut lo = 0.0;
    while hi - lo > 1e-4 * hi {
        let middle = lo + (hi - lo) / 2.0;
        *(if is_damped(middle) { &mut hi } else { &mut lo }) = middle;
    }
    [1.0, 1.0003, 1.001, 1.003, 1.01, 1.03].map(|off| off * hi).into_iter().find(|value| proven(*value))
}
