//! The largest growth inside a tongue.
//!
//! ln of the multiplier per period is 2 asinh √(BC) where Tr > 2 and 2 asinh √(−AD) where Tr < −2; the growth rate per
//! unit time at fixed L1 is that over T = p h1 = p √(s/L1). Tr has one extremum in each tongue (it is a polynomial all
//! of whose crossings of ±2 are real), and the rate one maximum nearby: found by golden section.

use super::gaps::Tongues;
use super::order::Gap;
use super::precise::Enclosure;
use crate::error::Result;
use crate::number::{Ball, Rational, rational};
use crate::propagator::{Schedule, TwoClocks};
use crate::verdict::refine;

/// The fastest growth in a tongue; rounded (about nine digits of s, fifteen of the rates).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Where.
    pub s: f64,
    /// Growth of ln amplitude per period.
    pub ln_multiplier: f64,
    /// The same per unit time, in units of √L1.
    pub rate: f64,
    /// Slow steps h2 until the amplitude is ten times as large.
    pub slow_steps_to_tenfold: f64,
}

/// Bits beyond the tongue's narrowness: the entries' own size is far below 2^64 there.
const GUARD: u32 = 128;

/// Each golden section keeps 0.618 of the interval: 44 of them leave 6e-10, where the rate is flat to 1e-18.
const SECTIONS: u32 = 44;

impl Tongues {
    /// The peak of an open, finite tongue.
    pub(super) fn peak(&mut self, gap: &Gap) -> Result<Option<Peak>> {
        let Some(upper) = gap.upper.filter(|_| !gap.closed) else { return Ok(None) };
        let (lower, upper) = (self.wide_enough(gap, &gap.lower)?, self.wide_enough(gap, &upper)?);
        let (from, width) = (lower.middle(), upper.middle() - lower.middle());
        let relative = &width / &from;
        let bits = GUARD + relative.denom().bits().saturating_sub(relative.numer().bits()) as u32;
        let growth = self.growth(gap.m % 2 == 1, bits)?;
        let rate = |share: f64| {
            let s = &from + &width * rational::from_f64_exact(share).expect("finite");
            growth(&s) / rational::to_f64(&s).sqrt()
        };
        let share = golden(rate);
        let s = &from + &width * rational::from_f64_exact(share).expect("finite");
        let (ln_multiplier, s) = (growth(&s), rational::to_f64(&s));
        Ok(Some(Peak {
            s,
            ln_multiplier,
            rate: ln_multiplier / (self.p() as f64 * s.sqrt()),
            slow_steps_to_tenfold: std::f64::consts::LN_10 * self.q() as f64 / ln_multiplier,
        }))
    }

    /// An edge, narrower than a thousandth of the tongue.
    fn wide_enough(&mut self, gap: &Gap, edge: &super::Edge) -> Result<Enclosure> {
        if edge.hi - edge.lo <= 1e-3 * gap.width.0 {
            return Ok(Enclosure::from(edge));
        }
        let digits = (edge.hi / gap.width.0).log10().ceil().max(0.0) as u32 + 6;
        self.refine(edge, digits)
    }

    /// s ↦ ln of the multiplier per period, rounded; 0 outside.
    fn growth(&self, odd: bool, bits: u32) -> Result<impl Fn(&Rational) -> f64 + use<>> {
        let (p, q, rho) = (self.p(), self.q(), self.rho().clone());
        let schedule = Schedule::two_clocks(p, q)?;
        Ok(move |s: &Rational| {
            let clocks = TwoClocks::with_rho(p, q, s.clone(), rho.clone());
            let Some(ends) = refine::run(&clocks, &schedule, bits) else { return 0.0 };
            let excess =
                if odd { ends.even.x.mul(&ends.odd.v, 64).neg() } else { ends.odd.x.mul(&ends.even.v, 64) };
            excess.sqrt_clipped(64).map_or(0.0, |root: Ball| 2.0 * root.mid_f64().asinh())
        })
    }
}

/// Where f, with one maximum in [0, 1], has it.
fn golden(f: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut lo, mut hi) = (0.0, 1.0);
    let (mut x, mut y) = (1.0 - ratio, ratio);
    let (mut at_x, mut at_y) = (f(x), f(y));
    for _ in 0..SECTIONS {
        if at_x > at_y {
            (hi, y, at_y) = (y, x, at_x);
            x = hi - ratio * (hi - lo);
            at_x = f(x);
        } else {
            (lo, x, at_x) = (x, y, at_y);
            y = lo + ratio * (hi - lo);
            at_y = f(y);
        }
    }
    0.5 * (lo + hi)
}
