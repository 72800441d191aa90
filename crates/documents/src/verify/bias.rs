//! The bias by the full period, drift by drift, in fractions: no half period, no symmetry.

use num_traits::{One, Zero};

use clocks::propagator::{Bias, TwoClocks};
use clocks::schedule::{KickDrift, Kicks, Schedule};
use number::{Rational, rational};

/// The columns of the propagator, and Σ duration · x² of each in the middle of the drifts.
struct Columns {
    columns: [[Rational; 2]; 2],
    squares: [Rational; 2],
    unit: Rational,
}

impl KickDrift<Rational> for Columns {
    fn drift(&mut self, ticks: u64) {
        let duration = Rational::from_integer(ticks.into()) / &self.unit;
        let half = &duration / Rational::from_integer(2.into());
        let [even, odd] = [0, 1].map(|i| &self.columns[i][0] + &half * &self.columns[i][1]);
        for (sum, product) in self.squares.iter_mut().zip([&even * &even, &odd * &odd]) {
            *sum += &duration * product;
        }
        for [x, v] in &mut self.columns {
            *x += &duration * &*v;
        }
    }

    fn kick(&mut self, strength: &Rational) {
        for [x, v] in &mut self.columns {
            *v -= strength * &*x;
        }
    }
}

/// The bias of an elliptic pair.
pub(super) fn bias(clocks: &TwoClocks<Rational>) -> Option<Bias<Rational>> {
    let schedule = Schedule::two_clocks(clocks.ratio()).ok()?;
    let half = rational::ratio(1, 2);
    let kicks = Kicks::of_two_clocks(clocks.strengths(), |k| [k.clone(), k * &half]);
    let (one, zero) = (Rational::one(), Rational::zero());
    let mut period = Columns {
        columns: [[one.clone(), zero.clone()], [zero.clone(), one]],
        squares: [zero.clone(), zero],
        unit: Rational::from_integer(schedule.clocks()[0].step().into()),
    };
    kicks.lead(schedule.symmetric_period(), &mut period);
    let [[_, c], [b, _]] = period.columns;
    let square = -(b / c);
    let stiffness = clocks.fast() + clocks.slow() / Rational::from(clocks.ratio());
    let [even, odd] = period.squares;
    let time = Rational::from_integer(clocks.p().into());
    Some(Bias { in_drifts: &stiffness * (&square * even + odd) / time, at_kicks: stiffness * square })
}
