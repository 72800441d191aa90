//! What there is to say about a tongue, column by column; each is computed only where it is wanted.
//!
//! ```
//! use kickdrift::number::rational::ratio;
//! use kickdrift::tongue::{Side, Tongues, Wanted};
//! // 7/3, m = 4: the resonance p th = 4 pi lies outside its own tongue.
//! let mut tongues = Tongues::new("7/3".parse().unwrap(), &ratio(1, 25)).unwrap();
//! let gap = tongues.gap(4).unwrap();
//! let row = tongues.row(&gap, &Wanted::all()).unwrap();
//! assert_eq!((row.family, row.predicted.unwrap().side), (Some((1, -1)), Side::Above));
//! assert_eq!(tongues.effort().doubles, 2); // no other edge was computed
//! ```

use num_traits::{Signed, ToPrimitive, Zero};

use super::gaps::Tongues;
use super::order::Gap;
use super::peak::Peak;
use super::precise::{Enclosure, simplest};
use super::spectrum::Edge;
use super::string::Entry;
use crate::error::Result;
use crate::number::{Cyclotomic, Ratio, Rational, Sign, rational};
use crate::propagator::TwoClocks;
use crate::resonance::{FirstOrder, dominant_family, first_order};
use crate::verdict::{Kind, Limits, decide};

/// The columns wanted beside p, q, m, the edges and the width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The dominant (a, b).
    pub family: bool,
    /// Which edges are known exactly.
    pub exact: bool,
    /// The largest growth rate inside.
    pub growth: bool,
    /// The point p θ = m π against the tongue.
    pub predicted: bool,
    /// The first-order law against the tongue.
    pub first_order: bool,
}

impl Wanted {
    /// Every column.
    pub fn all() -> Self {
        Wanted { family: true, exact: true, growth: true, predicted: true, first_order: true }
    }
}

/// An edge in closed form, proven.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExactEdge {
    /// s is this rational.
    Rational(Rational),
    /// p θ = m π exactly: s = 4 sin²(m π/(2p)).
    Resonance,
    /// The same for the slow clock's angle, q θ' = m π: s ρ (p/q)² = 4 sin²(m π/(2q)).
    SlowResonance,
}

/// Where the predicted point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    Below,
    OnLower,
    Inside,
    OnUpper,
    Above,
}

impl Side {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Side::Below => "below",
            Side::OnLower => "on the lower edge",
            Side::Inside => "inside",
            Side::OnUpper => "on the upper edge",
            Side::Above => "above",
        }
    }

    /// Whether the point lies off the closed tongue.
    pub fn is_outside(self) -> bool {
        matches!(self, Side::Below | Side::Above)
    }
}

/// The paper's point p θ = m π (eq. (9)) and the tongue that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// The double next to s = 4 sin²(m π/(2p)).
    pub s: f64,
    /// Decided, not estimated.
    pub side: Side,
    /// The distance to the tongue in s, rounded: positive outside, minus the distance to the nearer edge inside,
    /// 0 on an edge.
    pub distance: f64,
}

/// The first-order law and what it misses; rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    pub law: FirstOrder,
    /// Tongue minus law.
    pub centre_error: f64,
    pub width_error: f64,
    /// Tongue's width over the law's.
    pub width_ratio: f64,
}

/// A tongue and the columns asked for; `None` where not asked, or where there is none (said beside each).
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub ratio: Ratio,
    pub gap: Gap,
    /// (a, b), m = a p + b q, of the strongest family.
    pub family: Option<(i64, i64)>,
    /// The two edges, where recognized.
    pub exact: [Option<ExactEdge>; 2],
    /// Not for closed tongues, nor the infinite one.
    pub peak: Option<Peak>,
    /// Only for m < p: below the fast clock's Verlet limit.
    pub predicted: Option<Predicted>,
    /// Only for m < p, ρ > 0.
    pub first_order: Option<Law>,
}

impl Tongues {
    /// The row of a tongue.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn row(&mut self, gap: &Gap, wanted: &Wanted) -> Result<Row> {
        let (ratio, m) = (self.ratio(), gap.m);
        let family = wanted.family.then(|| dominant_family(ratio, m));
        let mut exact = [None, None];
        if wanted.exact {
            exact[0] = self.exact_edge(m, &gap.lower)?;
            exact[1] = gap.upper.as_ref().map_or(Ok(None), |upper| self.exact_edge(m, upper))?;
        }
        let peak = if wanted.growth { self.peak(gap)? } else { None };
        let predicted = if wanted.predicted { self.predicted(gap)? } else { None };
        let first_order = if wanted.first_order { self.law(gap) } else { None };
        Ok(Row { ratio, gap: gap.clone(), family, exact, peak, predicted, first_order })
    }

    /// An edge in closed form, if it has one that we know.
    ///
    /// The odd solution of p θ = m π vanishes at all slow kicks if q = 1 (and then ends with x = 0 or v = 0 at T/2 as m is
    /// even or odd), or if q = 2 and m is even: the slow clock does not act on it. Likewise with the clocks
    /// exchanged. Other edges are rational if the simplest rational in the enclosure is a zero.
    fn exact_edge(&self, m: u64, edge: &Edge) -> Result<Option<ExactEdge>> {
        let odd_start = matches!(edge.entry, Entry::B | Entry::D);
        let silent = |other: u64| other == 1 || (other == 2 && edge.entry == Entry::B);
        if let Some(s) = self.rational_edge(edge)? {
            return Ok(Some(ExactEdge::Rational(s)));
        }
        if (odd_start && silent(self.q()) && m < self.p()) || self.rho().is_zero() {
            return Ok(Some(ExactEdge::Resonance));
        }
        Ok((odd_start && silent(self.p()) && m < self.q()).then_some(ExactEdge::SlowResonance))
    }

    fn rational_edge(&self, edge: &Edge) -> Result<Option<Rational>> {
        let around = Enclosure::from(edge);
        let candidate = simplest(&around.lo, &around.hi);
        // A random enclosure of 2^-52 has its simplest rational at a denominator of some 2^26.
        let simple = candidate.denom().bits() <= 20;
        let is_zero = simple && self.function(edge.entry)?.exact_sign(&candidate) == Sign::Zero;
        Ok(is_zero.then_some(candidate))
    }

    /// The predicted point against the tongue, decided.
    fn predicted(&mut self, gap: &Gap) -> Result<Option<Predicted>> {
        let Some(upper) = gap.upper.filter(|_| gap.m < self.p()) else { return Ok(None) };
        let s = self.resonance(gap.m, 128);
        let (nearest, lower) = (s.mid_f64(), gap.lower);
        let side = match (self.compare(&s, &lower), self.compare(&s, &upper)) {
            _ if self.rho().is_zero() => Side::OnLower,
            (Some(Sign::Negative), _) => Side::Below,
            (_, Some(Sign::Positive)) => Side::Above,
            (Some(Sign::Positive), Some(Sign::Negative)) => Side::Inside,
            (at_lower, _) => self.decide_side(gap, at_lower.is_none())?,
        };
        let distance = match side {
            Side::Below => self.distance(gap.m, &lower)?,
            Side::Above => self.distance(gap.m, &upper)?,
            Side::OnLower | Side::OnUpper => 0.0,
            Side::Inside => -self.distance(gap.m, &lower)?.min(self.distance(gap.m, &upper)?),
        };
        Ok(Some(Predicted { s: nearest, side, distance }))
    }

    /// How far the predicted point is from an edge that it is not; rounded, but never to 0 or to the other side.
    fn distance(&mut self, m: u64, edge: &Edge) -> Result<f64> {
        let from_doubles = |s: f64| (edge.lo - s).max(s - edge.hi);
        let near = from_doubles(self.resonance(m, 128).mid_f64());
        // Two roundings of s: of a larger distance they take less than a millionth.
        if near > 1e6 * f64::EPSILON * edge.hi {
            return Ok(near);
        }
        let mut digits = 40;
        loop {
            let precise = self.refine(edge, digits)?;
            let s = self.resonance(m, 4 * digits + 64);
            let (below, above) = (&precise.lo - s.upper(), s.lower() - &precise.hi);
            if let Some(distance) = [below, above].into_iter().find(Signed::is_positive) {
                return Ok(rational::to_f64(&distance));
            }
            digits *= 2;
        }
    }

    /// How a ball compares with an edge, where their enclosures are apart.
    fn compare(&self, s: &crate::number::Ball, edge: &Edge) -> Option<Sign> {
        let (lo, hi) = s.to_f64_enclosure();
        match () {
            () if hi < edge.lo => Some(Sign::Negative),
            () if lo > edge.hi => Some(Sign::Positive),
            () => None,
        }
    }

    /// The predicted point lies within an edge's enclosure: the verdict there, in exact cyclotomic numbers if
    /// need be, tells on which side of the edge.
    fn decide_side(&self, gap: &Gap, at_lower: bool) -> Result<Side> {
        let edge = if at_lower { &gap.lower } else { gap.upper.as_ref().expect("a finite tongue") };
        let on = if at_lower { Side::OnLower } else { Side::OnUpper };
        if self.exact_edge(gap.m, edge)? == Some(ExactEdge::Resonance) {
            return Ok(on);
        }
        let p = u32::try_from(self.p()).expect("a period that is laid out in memory");
        let s = Cyclotomic::resonant_s(gap.m as i64, p);
        let rho = <Cyclotomic as crate::number::Ring>::from_rational(self.rho());
        let verdict = decide(&TwoClocks::with_rho(self.ratio(), s, rho), &Limits::default())?.verdict;
        Ok(match verdict.kind() {
            Kind::Hyperbolic => Side::Inside,
            Kind::Elliptic if at_lower => Side::Below,
            Kind::Elliptic => Side::Above,
            Kind::Parabolic | Kind::Coexistence => on,
        })
    }

    fn law(&self, gap: &Gap) -> Option<Law> {
        let rho = self.rho().to_f64().filter(|_| !self.rho().is_zero())?;
        let law = first_order(self.ratio(), gap.m, rho)?;
        let upper = gap.upper.as_ref()?;
        let width = 0.5 * (gap.width.0 + gap.width.1);
        let centre = 0.25 * (gap.lower.lo + gap.lower.hi + upper.lo + upper.hi);
        Some(Law {
            law,
            centre_error: centre - law.centre,
            width_error: width - law.width,
            width_ratio: width / law.width,
        })
    }
}
