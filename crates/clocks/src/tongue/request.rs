//! A tongue with all that is asked for: its edges in h1 and h2 where L1 is known, by as many digits as are
//! wanted.

use super::edge::{Edge, Enclosure, Tongues};
use super::gap::Gap;
use super::row::{ExactEdge, Resonance, Row, Wanted};
use super::string::Entry;
use number::{Ball, Laurent, Ratio, Rational, Real, Result};

/// The columns asked for beside the edges in s.
#[derive(Clone, Debug, Default)]
pub struct Request {
    pub wanted: Wanted,
    /// L1, which turns s into steps: h1 = √(s/L1), h2 = h1 p/q.
    pub lambda1: Option<Laurent>,
    /// Significant digits of the edges, beyond doubles.
    pub digits: Option<u32>,
}

/// An enclosure, in doubles and to the digits that are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    pub lo: f64,
    pub hi: f64,
    /// Its enclosure by rational ends, where digits are asked for.
    pub precise: Option<Enclosure>,
}

/// An edge of a tongue.
#[derive(Clone, Debug, PartialEq)]
pub struct TongueEdge {
    pub entry: Entry,
    pub s: Bounds,
    /// h1 and h2.
    pub steps: Option<[Bounds; 2]>,
    /// s, where it is rational.
    pub exact: Option<Rational>,
    /// The resonance it sits on exactly.
    pub on: Option<Resonance>,
}

/// A tongue with all that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Tongue {
    pub row: Row,
    pub lower: TongueEdge,
    pub upper: Option<TongueEdge>,
    /// The fastest growth per unit time, where it is asked for and L1 is known; rounded.
    pub growth_rate: Option<f64>,
}

impl Request {
    /// A tongue of `tongues` with what is asked for.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn answer(&self, tongues: &Tongues, gap: &Gap) -> Result<Tongue> {
        Ok(self.answers(tongues, std::slice::from_ref(gap))?.remove(0))
    }

    /// Several of them, which where growth is wanted cost a fraction of so many alone.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn answers(&self, tongues: &Tongues, gaps: &[Gap]) -> Result<Vec<Tongue>> {
        let answer = |row: Row| {
            let gap = &row.gap;
            let lower = self.edge(tongues, gap.m, &gap.lower, &row.exact[0])?;
            let upper =
                gap.upper.map(|upper| self.edge(tongues, gap.m, &upper, &row.exact[1])).transpose()?;
            let growth_rate =
                row.peak.zip(self.lambda1.as_ref()).map(|(peak, lambda1)| peak.growth_rate(lambda1));
            Ok(Tongue { row, lower, upper, growth_rate })
        };
        tongues.rows(gaps, &self.wanted)?.into_iter().map(answer).collect()
    }

    fn edge(&self, tongues: &Tongues, m: u64, edge: &Edge, form: &Option<ExactEdge>) -> Result<TongueEdge> {
        let on = form.as_ref().and_then(|form| Resonance::of(tongues.ratio(), m, tongues.rho(), form));
        let rational = match form {
            Some(ExactEdge::Rational(s)) => Some(s.clone()),
            _ => None,
        };
        let precise = match (self.digits, &rational) {
            (Some(_), Some(s)) => Enclosure { lo: s.clone(), hi: s.clone() },
            (Some(digits), None) => tongues.refine(edge, digits)?,
            (None, _) => Enclosure::from(edge),
        };
        let steps = self.lambda1.as_ref().map(|lambda1| self.steps(&precise, lambda1, tongues.ratio()));
        let s = Bounds { lo: edge.lo, hi: edge.hi, precise: self.digits.map(|_| precise) };
        Ok(TongueEdge { entry: edge.entry, s, steps, exact: rational, on })
    }

    /// h1 = √(s/L1) and h2 = h1 p/q over an enclosure of s.
    fn steps(&self, s: &Enclosure, lambda1: &Laurent, ratio: Ratio) -> [Bounds; 2] {
        let bits = self.digits.map_or(96, |digits| 4 * digits + 96);
        let lambda1 = lambda1.enclosure(bits);
        let h1 = |s: &Rational| {
            let square = Ball::from_rational(s, bits).div(&lambda1, bits).expect("lambda1 > 0");
            square.sqrt(bits).expect("s > 0")
        };
        let ends = [h1(&s.lo), h1(&s.hi)];
        let ratio = Ball::from_rational(&ratio.into(), bits);
        let slow = ends.each_ref().map(|h1| h1.mul(&ratio, bits));
        [&ends, &slow].map(|[lo, hi]| Bounds {
            lo: lo.to_f64_enclosure().0,
            hi: hi.to_f64_enclosure().1,
            precise: self.digits.map(|_| Enclosure { lo: lo.lower(), hi: hi.upper() }),
        })
    }
}
