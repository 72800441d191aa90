//! The paper's predicted point p θ = m π against the tongue that belongs to it.

use num_traits::{Signed, Zero};

use super::exact::{ExactEdge, exact_edge};
use crate::propagator::TwoClocks;
use crate::tongue::edge::{Edge, Tongues};
use crate::tongue::gap::Gap;
use crate::verdict::{Kind, Limits, decide};
use number::{Ball, Cyclotomic, Result, Ring, Sign, named, rational};

named! {
    /// Where the predicted point lies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Side {
        Below = "below",
        OnLower = "on the lower edge",
        Inside = "inside",
        OnUpper = "on the upper edge",
        Above = "above",
    }
}

/// The paper's point p θ = m π (eq. (9)) and the tongue that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// The double nearest to s = 4 sin²(m π/(2p)).
    pub s: f64,
    /// Decided, not estimated.
    pub side: Side,
    /// The distance to the tongue in s, rounded: positive outside, minus the distance to the nearer edge
    /// inside, 0 on an edge.
    pub distance: f64,
}

impl Predicted {
    /// The predicted point of a tongue, decided; `None` beyond the fast clock's Verlet limit.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn new(tongues: &Tongues, gap: &Gap) -> Result<Option<Predicted>> {
        let Some(upper) = gap.upper.filter(|_| gap.m < tongues.ratio().p()) else { return Ok(None) };
        let s = tongues.resonance(gap.m, 128);
        let lower = gap.lower;
        let side = match (compare(&s, &lower), compare(&s, &upper)) {
            _ if tongues.rho().is_zero() => Side::OnLower,
            (Some(Sign::Negative), _) => Side::Below,
            (_, Some(Sign::Positive)) => Side::Above,
            (Some(Sign::Positive), Some(Sign::Negative)) => Side::Inside,
            (at_lower, _) => decide_side(tongues, gap, at_lower.is_none())?,
        };
        let distance = match side {
            Side::Below => distance(tongues, gap.m, &lower)?,
            Side::Above => distance(tongues, gap.m, &upper)?,
            Side::OnLower | Side::OnUpper => 0.0,
            Side::Inside => -distance(tongues, gap.m, &lower)?.min(distance(tongues, gap.m, &upper)?),
        };
        Ok(Some(Predicted { s: Ball::nearest_f64(|bits| tongues.resonance(gap.m, bits)), side, distance }))
    }
}

/// How far the predicted point is from an edge that it is not; rounded, but never to 0 or to the other side.
fn distance(tongues: &Tongues, m: u64, edge: &Edge) -> Result<f64> {
    let from_doubles = |s: f64| (edge.lo - s).max(s - edge.hi);
    let near = from_doubles(tongues.resonance(m, 128).mid_f64());
    // Two roundings of s: of a larger distance they take less than a millionth.
    if near > 1e6 * f64::EPSILON * edge.hi {
        return Ok(near);
    }
    let mut digits = 40;
    loop {
        let precise = tongues.refine(edge, digits)?;
        let s = tongues.resonance(m, 4 * digits + 64);
        let (below, above) = (&precise.lo - s.upper(), s.lower() - &precise.hi);
        if let Some(distance) = [below, above].into_iter().find(Signed::is_positive) {
            return Ok(rational::to_f64(&distance));
        }
        digits *= 2;
    }
}

/// How a ball compares with an edge, where their enclosures are apart.
fn compare(s: &Ball, edge: &Edge) -> Option<Sign> {
    let (lo, hi) = s.to_f64_enclosure();
    match () {
        () if hi < edge.lo => Some(Sign::Negative),
        () if lo > edge.hi => Some(Sign::Positive),
        () => None,
    }
}

/// The predicted point lies within an edge's enclosure: the verdict there, in exact cyclotomic numbers if
/// need be, decides on which side of the edge.
fn decide_side(tongues: &Tongues, gap: &Gap, at_lower: bool) -> Result<Side> {
    let edge = if at_lower { &gap.lower } else { gap.upper.as_ref().expect("a finite tongue") };
    let on = if at_lower { Side::OnLower } else { Side::OnUpper };
    if exact_edge(tongues, gap.m, edge)? == Some(ExactEdge::Resonance) {
        return Ok(on);
    }
    let p = u32::try_from(tongues.ratio().p()).expect("a period that is laid out in memory");
    let s = Cyclotomic::resonant_s(gap.m as i64, p);
    let rho = <Cyclotomic as Ring>::from_rational(tongues.rho());
    let verdict = decide(&TwoClocks::with_rho(tongues.ratio(), s, rho), &Limits::default())?.verdict;
    Ok(match verdict.kind() {
        Kind::Hyperbolic => Side::Inside,
        Kind::Elliptic if at_lower => Side::Below,
        Kind::Elliptic => Side::Above,
        Kind::Parabolic | Kind::Coexistence => on,
    })
}
