//! One edge of a tongue.

use num_traits::Signed;

use crate::verify::context::{Checked, Fault, holds};
use crate::verify::exact::{ZeroOf, between, fraction, resonance};
use clocks::propagator::TwoClocks;
use clocks::tongue::{Bounds, Entry, Resonance, Stiffness, TongueEdge};
use clocks::verdict::Decidable;
use number::rational::simplest;
use number::{Ball, Cyclotomic, Laurent, Ratio, Rational, Ring, Sign};

/// An edge found again: the zero of an entry between two rationals.
pub struct Zero<'a> {
    pub zero: ZeroOf<'a>,
    pub exact: Option<Rational>,
    name: &'static str,
}

/// The largest p for which zeros are decided in the cyclotomic field: its numbers have φ(p)/2 terms.
const MOST_TERMS: u64 = 64;

const BITS: u32 = 128;

/// An edge that is to be found again.
#[derive(Clone, Copy)]
pub struct Claimed<'a> {
    pub edge: &'a TongueEdge,
    pub name: &'static str,
    /// Whether closed forms and resonances were asked for.
    pub has_closed_forms: bool,
}

impl Claimed<'_> {
    /// The zero of its entry that the edge encloses; all that it says of it holds.
    pub fn zero<'a>(&self, (ratio, m): (Ratio, u64), given: &'a Stiffness) -> Checked<Zero<'a>> {
        let (name, TongueEdge { entry, s, exact, .. }) = (self.name, self.edge);
        let pair = Entry::of_tongue(m % 2 == 1);
        holds(pair.contains(entry), || format!("{name}: {} bounds no tongue m = {m}", entry.name()))?;
        holds(s.lo > 0.0, || format!("{name}: s is positive"))?;
        let mut zero = ZeroOf::new((ratio, &given.rho), *entry, between(s.lo, s.hi)?, name)?;
        if let Some(precise) = &s.precise {
            // The digits enclose the same zero.
            let (lo, hi) = (precise.lo.clone().max(zero.lo.clone()), precise.hi.clone().min(zero.hi.clone()));
            holds(lo <= hi, || format!("{name}: doubles and digits have nothing in common"))?;
            zero = ZeroOf::new((ratio, &given.rho), *entry, (lo, hi), name)?;
        }
        let found = Zero { zero, exact: exact.clone(), name };
        if self.has_closed_forms {
            self.closed_form(&found, m)?;
        }
        self.steps(&found, given)?;
        Ok(found)
    }

    /// A rational edge is a zero, a resonance lies on it; neither is left out where it is known.
    fn closed_form(&self, found: &Zero, m: u64) -> Checked {
        let (name, zero) = (found.name, &found.zero);
        if let Some(s) = &found.exact {
            holds(zero.lo <= *s && *s <= zero.hi, || format!("{name}: {s} lies outside its enclosure"))?;
            holds(zero.vanishes(s), || format!("{name}: {} does not vanish at {s}", zero.entry.name()))?;
        } else {
            // A few units in the last place hold few rationals of small denominators.
            let simple = simplest(&zero.lo, &zero.hi);
            let hidden = simple.denom().bits() <= 20 && zero.vanishes(&simple);
            holds(!hidden, || format!("{name}: it is rational, {simple}"))?;
        }
        let sits = |on: Resonance| found.sits(on, m);
        let truth = [Resonance::Fast, Resonance::Slow].map(|on| (on, sits(on)));
        match self.edge.on {
            Some(on) => {
                let sits = truth.iter().any(|(other, sits)| *other == on && *sits != Some(false));
                holds(sits, || format!("{name}: it does not sit on {}", on.name()))
            }
            None => {
                let hidden = truth.iter().find(|(_, sits)| *sits == Some(true)).map(|(on, _)| on.name());
                holds(hidden.is_none(), || format!("{name}: it sits on {}", hidden.unwrap_or_default()))
            }
        }
    }

    /// h² L over an enclosure of a step meets the enclosure of s.
    fn steps(&self, found: &Zero, given: &Stiffness) -> Checked {
        let (name, back) = (found.name, Rational::from(found.zero.ratio.inverse()));
        let Some(lambda1) = &given.lambda1 else { return Ok(()) };
        let missing = || Fault::Wrong(format!("{name}: h1 and h2 are missing"));
        let [h1, h2] = self.edge.steps.as_ref().ok_or_else(missing)?;
        let [from, upto] = [&found.zero.lo, &found.zero.hi].map(|s| Laurent::from_rational(s.clone()));
        for (key, Bounds { lo, hi, precise }, back) in [("h1", h1, fraction(1, 1)), ("h2", h2, back)] {
            let s = |h: Rational| {
                let h = h * &back;
                &Laurent::from_rational(&h * &h) * lambda1
            };
            let precise = precise.as_ref().map(|precise| (precise.lo.clone(), precise.hi.clone()));
            for (lo, hi) in [between(*lo, *hi)?].into_iter().chain(precise) {
                let meets = !lo.is_negative() && s(lo) <= upto && from <= s(hi);
                holds(meets, || format!("{name}: {key} is not the step of s"))?;
            }
        }
        Ok(())
    }
}

impl Zero<'_> {
    /// Where a clock's own resonance m lies.
    fn place(&self, on: Resonance, m: u64) -> Ball {
        let ratio = self.zero.ratio;
        match on {
            Resonance::Fast => resonance(ratio.p(), m, BITS),
            Resonance::Slow => {
                let back = Rational::from(ratio.inverse());
                let scale = &back * &back / self.zero.rho;
                resonance(ratio.q(), m, BITS).mul(&Ball::from_rational(&scale, BITS), BITS)
            }
        }
    }

    /// Whether the edge sits exactly on a clock's own resonance; `None` where that is not decided.
    ///
    /// The odd solution of that resonance vanishes at all kicks of the other clock if there is one a period,
    /// or if there are two and m is even: that clock does not act on it. Else the entry is evaluated in the
    /// cyclotomic field.
    pub fn sits(&self, on: Resonance, m: u64) -> Option<bool> {
        let (ratio, rho) = (self.zero.ratio, self.zero.rho);
        let still = *rho == Rational::default();
        let ratio = if on == Resonance::Fast { ratio } else { ratio.inverse() };
        let (count, other) = ratio.terms();
        if m >= count || (still && on == Resonance::Slow) {
            return Some(false);
        }
        let place = self.place(on, m);
        if place.upper() < self.zero.lo || self.zero.hi < place.lower() {
            return Some(false);
        }
        let odd_start = matches!(self.zero.entry, Entry::B | Entry::D);
        if still || (odd_start && (other == 1 || (other == 2 && self.zero.entry == Entry::B))) {
            return Some(true);
        }
        if count > MOST_TERMS {
            return None;
        }
        let s = Cyclotomic::resonant_s(m as i64, count as u32);
        let rho = if on == Resonance::Fast { rho.clone() } else { rho.recip() };
        let clocks = TwoClocks::with_rho(ratio, s, <Cyclotomic as Ring>::from_rational(&rho));
        Some(Decidable::half_signs(&clocks).all()[self.zero.entry as usize] == Sign::Zero)
    }

    /// That without slow kicks it is the resonance.
    pub fn on_resonance(&self, m: u64) -> Checked {
        holds(self.sits(Resonance::Fast, m) == Some(true), || {
            format!("{}: p theta = m pi lies elsewhere", self.name)
        })
    }
}
