//! A tongue with all that is asked for.

use crate::error::Result;
use crate::number::{Ball, Laurent, Ratio, Rational, Real};
use crate::report::digits::{exact, outward};
use crate::tongue::{Edge, Enclosure, Entry, ExactEdge, Gap, Peak, Resonance, Row, Tongues, Wanted};

/// What is asked for beside the edges in s.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    pub wanted: Wanted,
    /// L1, which turns s into steps: h1 = √(s/L1), h2 = h1 p/q.
    pub lambda1: Option<Laurent>,
    /// Significant digits of the edges, beyond doubles.
    pub digits: Option<u32>,
}

/// An enclosure, in doubles and in digits.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    pub lo: f64,
    pub hi: f64,
    /// Both ends in writing, where digits are asked for.
    pub decimal: Option<[String; 2]>,
}

/// An edge.
#[derive(Clone, Debug, PartialEq)]
pub struct ToldEdge {
    pub entry: Entry,
    pub s: Quantity,
    /// h1 and h2.
    pub steps: Option<[Quantity; 2]>,
    /// s, where it is rational.
    pub exact: Option<Rational>,
    /// The resonance it sits on exactly.
    pub on: Option<Resonance>,
}

/// A tongue ready to be told.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    pub row: Row,
    pub lower: ToldEdge,
    pub upper: Option<ToldEdge>,
    /// The fastest growth per unit time, where L1 is known; rounded.
    pub growth_rate: Option<f64>,
    /// Whether closed forms were asked for.
    pub closed_forms: bool,
}

impl Frame {
    /// Completes a tongue of `tongues`.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn told(&self, tongues: &Tongues, gap: &Gap) -> Result<Told> {
        let row = tongues.row(gap, &self.wanted)?;
        let lower = self.edge(tongues, gap.m, &gap.lower, &row.exact[0])?;
        let upper = match &gap.upper {
            Some(upper) => Some(self.edge(tongues, gap.m, upper, &row.exact[1])?),
            None => None,
        };
        let growth_rate = self.growth_rate(row.peak.as_ref());
        Ok(Told { row, lower, upper, growth_rate, closed_forms: self.wanted.exact })
    }

    fn edge(&self, tongues: &Tongues, m: u64, edge: &Edge, form: &Option<ExactEdge>) -> Result<ToldEdge> {
        let on = form.as_ref().and_then(|form| Resonance::of(tongues.ratio(), m, tongues.rho(), form));
        let rational = match form {
            Some(ExactEdge::Rational(s)) => Some(s.clone()),
            _ => None,
        };
        let precise = match (self.digits, &rational) {
            (Some(_), Some(s)) => Enclosure { lo: s.clone(), hi: s.clone() },
            (Some(digits), None) => tongues.refine(edge, digits)?,
            (None, _) => Enclosure { lo: exact(edge.lo), hi: exact(edge.hi) },
        };
        let decimal = self.digits.map(|digits| outward(&precise.lo, &precise.hi, digits));
        let s = Quantity { lo: edge.lo, hi: edge.hi, decimal };
        let steps = self.lambda1.as_ref().map(|lambda1| self.steps(&precise, lambda1, tongues.ratio()));
        Ok(ToldEdge { entry: edge.entry, s, steps, exact: rational, on })
    }

    /// h1 = √(s/L1) and h2 = h1 p/q over an enclosure of s.
    fn steps(&self, s: &Enclosure, lambda1: &Laurent, ratio: Ratio) -> [Quantity; 2] {
        let bits = self.digits.map_or(96, |digits| 4 * digits + 96);
        let lambda1 = lambda1.enclosure(bits);
        let h1 = |s: &Rational| {
            let square = Ball::from_rational(s, bits).div(&lambda1, bits).expect("lambda1 > 0");
            square.sqrt(bits).expect("s > 0")
        };
        let ends = [h1(&s.lo), h1(&s.hi)];
        let ratio = Ball::from_rational(&ratio.into(), bits);
        let slow = ends.each_ref().map(|h1| h1.mul(&ratio, bits));
        [&ends, &slow].map(|[lo, hi]| Quantity {
            lo: lo.to_f64_enclosure().0,
            hi: hi.to_f64_enclosure().1,
            decimal: self.digits.map(|digits| outward(&lo.lower(), &hi.upper(), digits)),
        })
    }

    /// The peak's rate is in units of √L1.
    fn growth_rate(&self, peak: Option<&Peak>) -> Option<f64> {
        Some(peak?.rate * self.lambda1.as_ref()?.to_f64().sqrt())
    }
}
