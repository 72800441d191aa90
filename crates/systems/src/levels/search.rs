//! Edges of what is proven, whoever proves it: margins, ends of regions, the first unstable step, stretches.

use crate::vary::stretches::{Stretch, cover, merged};
use crate::verdict::measured::Holds;
use number::bisected;
use number::error::Result;

/// How closely the end of the first region is enclosed, relative.
pub(super) const EDGE: f64 = 1e-8;

/// The largest relative change of the stiffnesses by which one verdict is carried on.
const WIDEST: f64 = 0.05;

/// The largest ε in \[0, 1\] with `holds(ε)`, rounded down within a factor; `None` where not even `holds(0)`.
pub(super) fn largest(width: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    // By halves of the exponent: below 10^-15 the errors of the eigenbasis are larger than the margin.
    let (mut lo, mut hi) = (1e-15_f64, 1.0_f64);
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

/// Two steps below `hi`, `width` apart, relative: what holds at every step up to its end holds at the first
/// and not at the second one, unless that is `hi`. `None` where it holds at none down to 2⁻⁴⁰ `hi`.
pub(super) fn edge_below(hi: f64, width: f64, holds: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
    let lo = (1..=40).map(|k| hi * 0.5f64.powi(k)).find(|&step| holds(step))?;
    Some(bisected((lo, hi.min(2.0 * lo)), width, |step| Some(holds(step))))
}

/// The end of the first region with a step past it that is proven unstable: near the end forms are near 0,
/// and doubles cannot decide; a little farther they can.
pub(super) fn unstable_past((lo, hi): (f64, f64), unstable: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
    let mut steps = (0..16).map(|k| hi + lo * EDGE * f64::from(1 << k));
    steps.find(|&step| unstable(step)).map(|step| (lo, step))
}

/// The step up to which every one from `at` on is proven unstable, no farther than 1.5 `at`. `end` carries
/// the verdict on from a step by a relative change of the stiffnesses, which falls to `least`.
pub(super) fn carried_on(
    mut at: f64,
    least: f64,
    end: impl Fn(f64, f64) -> Result<Option<f64>>,
) -> Result<f64> {
    let (last, mut width) = (1.5 * at, least);
    while at < last {
        match end(at, width)? {
            Some(end) => (at, width) = (end, (4.0 * width).min(WIDEST)),
            None if width <= least => break,
            None => width = (width / 4.0).max(least),
        }
    }
    Ok(at.min(last))
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
