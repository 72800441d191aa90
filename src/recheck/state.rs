//! A state after many steps: kick by kick in so many bits that enclosures stay narrow.

use super::again::{Recheck, asked};
use super::context::{Context, Outcome, holds};
use super::written::{Ends, Whole, Written};
use crate::error::Result;
use crate::number::{Ball, Laurent, Rational, Real};
use crate::question::State;
use num_traits::{ToPrimitive, Zero};

const ROUTE: &str = "every kick and drift, one after the other";

/// The most kicks that are followed.
const MOST: u64 = 20_000;

/// Bits beside four a kick, by which the enclosure of a product may widen.
const BITS: u32 = 256;

rows! {
    /// `kickdrift/state/1`.
    pub struct Claim {
        input: State,
        states: Vec<Row>,
    }

    struct Row [steps] {
        steps: Whole,
        time: Written<Laurent>,
        x: Ends,
        v: Ends,
        xx: Ends,
        xv: Ends,
        vx: Ends,
        vv: Ends,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "states";
    asked!(State);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let reached = self.followed()?.map(|propagator| self.input.reached(propagator));
        let mut outcome = context.outcome(ROUTE, ("the steps", Ok(())), &self.states, |row: &Row| {
            let steps = Laurent::from_rational(Rational::from_integer(row.steps.0.clone()));
            holds(row.steps.0 == self.input.steps.into(), || "has another number of steps".into())?;
            holds(row.time.0 == &self.input.h2 * &steps, || "has another time".into())?;
            let Some(reached) = &reached else { return Ok(()) };
            let ends = [&row.x, &row.v, &row.xx, &row.xv, &row.vx, &row.vv];
            let mut found = reached.state.iter().chain(&reached.propagator).zip(ends);
            holds(found.all(|(ball, ends)| ends.holds(ball)), || "its kicks lead elsewhere".into())
        })?;
        if reached.is_none() {
            outcome.not_rechecked.push("the state by another route: more kicks than can be followed".into());
        }
        Ok(outcome)
    }
}

impl Claim {
    /// In the time unit h1; `None` where the kicks are too many.
    fn followed(&self) -> Result<Option<[Ball; 4]>> {
        let clocks = self.input.oscillator()?.long_clocks();
        let (ratio, steps) = (clocks.ratio(), Rational::from_integer(self.input.steps.into()));
        let end = ratio * &steps;
        let Some(fast) = end.to_integer().to_u64().filter(|fast| fast + self.input.steps <= MOST) else {
            return Ok(None);
        };
        let bits = BITS + 4 * (fast + self.input.steps) as u32;
        let [one, zero] = [Ball::one(), Ball::zero()];
        let mut columns = [[one.clone(), zero.clone()], [zero, one]];
        let [s, k] = [clocks.fast(), clocks.slow()].map(|x| x.enclosure(bits));
        let mut kicks: Vec<(Rational, &Ball)> =
            (0..=fast).map(|n| (Rational::from_integer(n.into()), &s)).collect();
        kicks.extend((0..=self.input.steps).map(|n| (ratio * Rational::from_integer(n.into()), &k)));
        // Between the halves of the kicks at t = 0 nothing happens.
        kicks.retain(|_| self.input.steps > 0);
        kicks.sort_by(|a, b| a.0.cmp(&b.0));
        let mut now = Rational::zero();
        for (time, strength) in kicks {
            let drift = Ball::from_rational(&(&time - &now), bits);
            let is_half = time.is_zero() || time == end;
            let kick = if is_half { strength.scale2(-1) } else { strength.clone() };
            for [x, v] in &mut columns {
                *x = x.add(&drift.mul(v, bits), bits);
                *v = v.sub(&kick.mul(x, bits), bits);
            }
            now = time;
        }
        let [[xx, vx], [xv, vv]] = columns;
        Ok(Some([xx, xv, vx, vv]))
    }
}
