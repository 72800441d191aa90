//! The tongues of one ratio about a point on its ray.

use std::cmp::Ordering;

use serde_json::{Value, json};

use clocks::tongue::{Bounds, Edge, Request, Tongue, TongueEdge, Tongues};
use documents::report::document::enclosure;
use number::parallel::go_on;
use number::{Laurent, Ratio, Rational, Real, Result};

/// Masses and springs that are laid out, at most.
const MOST: u64 = 20_000;

/// Digits to which an edge is known before it is taken to be where the point is.
const DIGITS: [u32; 4] = [25, 50, 100, 200];

/// The tongues of one ratio.
pub(super) struct Ray {
    tongues: Tongues,
    request: Request,
}

/// The tongue that a point is in or on the edge of, and the nearest others.
pub(super) struct Around {
    pub inside: Option<Tongue>,
    pub below: Option<Tongue>,
    pub above: Option<Tongue>,
}

impl Ray {
    /// `None` where there are none by theory (ρ < 0) or too many to lay out.
    pub fn new(ratio: Ratio, rho: &Rational, lambda1: &Laurent) -> Option<Ray> {
        let request = Request { lambda1: Some(lambda1.clone()), ..Request::default() };
        let request =
            Request { wanted: clocks::tongue::Wanted { family: true, ..request.wanted }, ..request };
        (ratio.kicks() <= MOST)
            .then(|| Tongues::new(ratio, rho).ok())
            .flatten()
            .map(|tongues| Ray { tongues, request })
    }

    /// The tongues about s = h1² L1; `stable` is whether the pair is, which the verdict has proven.
    pub fn around(&self, s: &Laurent, stable: bool) -> Result<Around> {
        let began = self.begun(s)?;
        let (below, above) = if stable { (began, began + 1) } else { (began.max(1) - 1, began + 1) };
        let tongue = |m: u64| match (1..=self.tongues.last()).contains(&m) {
            true => self.tongue(m).map(Some),
            false => Ok(None),
        };
        Ok(Around {
            inside: if stable { None } else { tongue(began)? },
            below: tongue(below)?,
            above: tongue(above)?,
        })
    }

    fn tongue(&self, m: u64) -> Result<Tongue> {
        self.request.answer(&self.tongues, &self.tongues.gap(m)?)
    }

    /// How many tongues have their lower edge at s or below.
    fn begun(&self, s: &Laurent) -> Result<u64> {
        let (mut begun, mut not) = (0, self.tongues.last() + 1);
        while not - begun > 1 {
            go_on()?;
            let m = begun + (not - begun) / 2;
            match self.compare(&self.tongues.gap(m)?.lower, s)? {
                Ordering::Greater => not = m,
                _ => begun = m,
            }
        }
        Ok(begun)
    }

    /// An edge against s: by doubles, else by more digits; equal where all of them agree.
    fn compare(&self, edge: &Edge, s: &Laurent) -> Result<Ordering> {
        let (lo, hi) = s.enclose_f64();
        if edge.hi < lo {
            return Ok(Ordering::Less);
        }
        if edge.lo > hi {
            return Ok(Ordering::Greater);
        }
        for digits in DIGITS {
            let (edge, s) = (self.tongues.refine(edge, digits)?, s.enclosure(4 * digits + 64));
            if edge.hi < s.lower() {
                return Ok(Ordering::Less);
            }
            if edge.lo > s.upper() {
                return Ok(Ordering::Greater);
            }
        }
        Ok(Ordering::Equal)
    }
}

/// `p, q, m, a, b, closed`, `lower` and `upper` {`s`, `h1`, `h2`}, `width` in s; all enclosed. What has no
/// upper edge has null there.
pub(super) fn value(tongue: &Tongue) -> Value {
    let pair = |quantity: &Bounds| enclosure((quantity.lo, quantity.hi));
    let edge = |edge: &TongueEdge| {
        let steps = edge.steps.as_ref().map(|steps| steps.each_ref().map(pair));
        let [h1, h2] = steps.unwrap_or_default();
        json!({"entry": edge.entry.name(), "s": pair(&edge.s), "h1": h1, "h2": h2})
    };
    let (row, upper) = (&tongue.row, tongue.upper.as_ref());
    json!({
        "p": row.ratio.p(), "q": row.ratio.q(), "m": row.gap.m,
        "a": row.family.map(|(a, _)| a), "b": row.family.map(|(_, b)| b), "closed": row.gap.closed,
        "lower": edge(&tongue.lower), "upper": upper.map(edge), "width": upper.map(|_| enclosure(row.gap.width)),
    })
}
