//! Where an oscillator is after any number of steps.

use super::asking::{Question, Work, question};
#[cfg(feature = "cli")]
use super::field::flag;
use crate::error::Result;
use crate::number::{Ball, Laurent, Rational, Real};
use crate::propagator::Oscillator;
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::table::{Cell, Column};
use crate::verdict::propagator_after;

question! {
    /// Position and velocity after n steps of the slow clock, of any number, from a given state, in the form with half kicks at both ends.
    args struct State {
        /// The stiffness of the fast force, 1/time^2.
        #[arg(long, value_name = "L1", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda1: Laurent,
        /// The stiffness of the slow force.
        #[arg(long, value_name = "L2", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda2: Laurent,
        /// The fast step.
        #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        h1: Laurent,
        /// The slow step; h2/h1 is rational.
        #[arg(long, value_name = "B", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        h2: Laurent,
        /// How many steps of the slow clock.
        #[arg(long, value_name = "N", value_parser = flag::<u64>)]
        steps: u64,
        /// The position at the start.
        #[arg(long, value_name = "X", default_value = "1", allow_hyphen_values = true, value_parser = flag::<Rational>)]
        x: Rational = "1",
        /// The velocity at the start.
        #[arg(long, value_name = "V", default_value = "0", allow_hyphen_values = true, value_parser = flag::<Rational>)]
        v: Rational = "0",
    }
}

/// A state and the propagator that leads to it, as enclosures, in the units of what was asked.
#[derive(Clone, Debug)]
pub struct Reached {
    /// n.
    pub steps: u64,
    /// n h2.
    pub time: Laurent,
    /// [[xx, xv], [vx, vv]].
    pub propagator: [Ball; 4],
    /// Position and velocity.
    pub state: [Ball; 2],
}

const BITS: u32 = 256;

impl State {
    /// From a propagator in the time unit h1.
    pub fn reached(&self, [xx, xv, vx, vv]: [Ball; 4]) -> Reached {
        let h1 = self.h1.enclosure(BITS);
        let over_h1 = |x: &Ball| x.div(&h1, BITS).expect("a step is positive");
        let propagator = [xx, xv.mul(&h1, BITS), over_h1(&vx), vv];
        let [x, v] = [&self.x, &self.v].map(|start| Ball::from_rational(start, BITS));
        let row = |k: usize| propagator[k].mul(&x, BITS).add(&propagator[k + 1].mul(&v, BITS), BITS);
        let state = [row(0), row(2)];
        let time = &self.h2 * &Laurent::from_rational(Rational::from_integer(self.steps.into()));
        Reached { steps: self.steps, time, propagator, state }
    }

    /// The oscillator with its steps.
    ///
    /// # Errors
    /// As [`Oscillator::new`].
    pub fn oscillator(&self) -> Result<Oscillator> {
        let State { lambda1, lambda2, h1, h2, .. } = self.clone();
        Oscillator::new(lambda1, lambda2, h1, h2)
    }
}

/// The columns of a state.
fn state<'a>() -> Record<'a, Reached> {
    Record::new()
        .field(Column::math("steps", "n"), |of: &Reached| Cell::whole(&of.steps.into()))
        .field(Column::new("time"), |of| Cell::exact(&of.time))
        .field(Column::math("x", "x").enclosure(), |of| of.state[0].to_f64_enclosure().into())
        .field(Column::math("v", "v").enclosure(), |of| of.state[1].to_f64_enclosure().into())
}

/// Its row: the same, and the propagator behind it.
fn record<'a>() -> Record<'a, Reached> {
    let mut record = state();
    for (k, name) in ["xx", "xv", "vx", "vv"].into_iter().enumerate() {
        let column = Column::new(name).enclosure();
        record = record.field(column, move |of| of.propagator[k].to_f64_enclosure().into());
    }
    record
}

impl Question for State {
    const NAME: &'static str = "state";
    const EXAMPLES: &'static [&'static str] =
        &["state --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.333 --steps 1000000000000000000"];
    type Answer = Reached;

    fn answer(&self, _: &Work) -> Result<Reached> {
        Ok(self.reached(propagator_after(&self.oscillator()?.long_clocks(), self.steps)?))
    }

    fn show(&self, reached: &Reached) -> Document {
        let caption = format!("The state after {} steps", self.steps);
        let table = |record: Record<Reached>| record.table("states", &caption, [reached]).captioned(&caption);
        let [x, v] = reached.state.each_ref().map(|own| {
            let (lo, hi) = own.to_f64_enclosure();
            decimal::enclosure(lo, hi)
        });
        let summary = format!("after {} steps of h2, at t = {}: x = {x}, v = {v}", self.steps, reached.time);
        Document::new(Self::NAME).rows(table(record())).for_people(table(state())).summary(&[summary])
    }
}
