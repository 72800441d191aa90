//! The half period of forces that are no gradient: in doubles with a proven bound, and exactly.
//!
//! Bounds grow as the norms of drifts and kicks do, e_x + d e_v and e_v + h |A| e_x: some e^(√|A| T) times
//! the rounding of a step. That serves the few dozen inner steps of a run; no inverse is needed, which only
//! symplectic matrices have for nothing.

use faer::{Mat, Scale};
use nalgebra::DMatrix;
use num_traits::One;

use super::model::Jacobians;
use crate::exact::decide::led;
use crate::half::norm;
use clocks::schedule::{Event, KickDrift, Kicks, Weight, reversed};
use number::{Rational, U, to_f64};

/// A clock that kicks, and how much of its kick.
pub(super) type Strike = (usize, Weight);

/// Leads positions and velocities, a column a solution, through the events.
pub(super) fn lead(
    jacobians: &Jacobians,
    events: impl IntoIterator<Item = Event>,
    state: &mut impl KickDrift<Strike>,
) {
    let strikes = |clock| [Weight::Full, Weight::Half].map(|weight| (clock, weight));
    Kicks::of_clocks(0..jacobians.clocks.len(), strikes).lead(events, state);
}

/// The events of half a period, from t = 0 or back from T/2.
fn events(jacobians: &Jacobians, is_reversed: bool) -> Vec<Event> {
    let events: Vec<Event> = jacobians.schedule.half_period().collect();
    if is_reversed { reversed(&events) } else { events }
}

/// Bounds on the errors of positions and velocities, in Frobenius's norm.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    x: f64,
    v: f64,
}

/// In doubles; errors of rounding, and those with the accuracy of the matrices beside them.
pub(super) struct Doubles<'a> {
    own: &'a Jacobians,
    pub x: Mat<f64>,
    pub v: Mat<f64>,
    errors: [Errors; 2],
}

impl<'a> Doubles<'a> {
    pub fn new(own: &'a Jacobians, x: Mat<f64>, v: Mat<f64>) -> Doubles<'a> {
        Doubles { own, x, v, errors: [Errors::default(); 2] }
    }

    /// Half a period, forwards from x = 1, v = 0, or backwards from x = 0, v = 1.
    fn half(jacobians: &'a Jacobians, is_reversed: bool) -> Doubles<'a> {
        let n = jacobians.size();
        let (one, zero) = (Mat::identity(n, n), Mat::zeros(n, n));
        let (x, v) = if is_reversed { (zero, one) } else { (one, zero) };
        let mut state = Doubles::new(jacobians, x, v);
        lead(jacobians, events(jacobians, is_reversed), &mut state);
        state
    }
}

impl Doubles<'_> {
    /// x + t v, the time rounded.
    pub fn moved(&mut self, time: f64) {
        let size = norm::frobenius(&self.x) + time * norm::frobenius(&self.v);
        self.x += time * &self.v;
        // The time, the product, the sum.
        self.errors.iter_mut().for_each(|error| error.x = 1.01 * (error.x + time * error.v + 3.1 * U * size));
    }

    /// c v, the factor c within \[0, 1\] rounded.
    pub fn faded(&mut self, factor: f64) {
        self.v *= Scale(factor);
        let size = norm::frobenius(&self.v);
        // The factor, the product; both once more, since the size is that of the result.
        self.errors.iter_mut().for_each(|error| error.v = 1.01 * (factor * error.v + 4.1 * U * size));
    }

    /// A bound on the error of both for the matrices given, in Frobenius's norm.
    pub fn error(&self) -> f64 {
        1.01 * self.errors[0].x.hypot(self.errors[0].v)
    }
}

impl KickDrift<Strike> for Doubles<'_> {
    fn drift(&mut self, ticks: u64) {
        self.moved(to_f64(&(&self.own.tick * Rational::from_integer(ticks.into()))));
    }

    fn kick(&mut self, &(clock, weight): &Strike) {
        let clock = &self.own.clocks[clock];
        let step = to_f64(&clock.step) * weight.share();
        let (x, v) = (norm::frobenius(&self.x), norm::frobenius(&self.v));
        self.v -= step * (&clock.matrix * &self.x);
        // Sums of n products, the step, a product and a sum.
        let terms = self.own.size() as f64 + 4.0;
        let rounding = 1.01 * terms * U * step * norm::frobenius(&clock.matrix) * x + 3.1 * U * v;
        let known = [0.0, self.own.accuracy.unwrap_or(0.0) * clock.size];
        for (errors, known) in self.errors.iter_mut().zip(known) {
            errors.v = 1.01
                * (errors.v
                    + step * (clock.size * errors.x + (clock.off + known) * (x + errors.x))
                    + rounding);
        }
    }
}

/// S = B' C with bounds (2-norm): on the error for the matrices given, and for all within their accuracy.
pub(super) fn half_product(jacobians: &Jacobians) -> (Mat<f64>, [f64; 2]) {
    let (forwards, backwards) = (Doubles::half(jacobians, false), Doubles::half(jacobians, true));
    let (b, c) = (&backwards.x, &forwards.v);
    let [size_b, size_c] = [b, c].map(norm::frobenius);
    let rounding = 1.01 * (jacobians.size() as f64 + 4.0) * U * size_b * size_c;
    let errors = [0, 1].map(|k| {
        let (b, c) = (backwards.errors[k].x, forwards.errors[k].v);
        1.01 * (size_b * c + size_c * b + b * c + rounding)
    });
    (b * c, errors)
}

/// The blocks A, B, C, D of the half period over ℚ and S = B' C, of rational matrices or of the doubles that
/// stand for them.
pub(super) fn exact(own: &Jacobians) -> ([DMatrix<Rational>; 4], DMatrix<Rational>) {
    let n = own.size();
    let kick = |event: &Event| {
        event.clocks().map(|clock| &own.clocks[clock]).fold(DMatrix::zeros(n, n), |sum, clock| {
            sum + clock.rational().as_ref() * event.weight.of(&clock.step)
        })
    };
    let (one, zero) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
    let half = |start: [&DMatrix<Rational>; 2], is_reversed: bool| {
        let timed = |event: Event| (&own.tick * Rational::from_integer(event.drift.into()), kick(&event));
        let events = events(own, is_reversed).into_iter().map(timed);
        led(start.map(Clone::clone), &vec![Rational::one(); n], events)
    };
    let ([a, c], [b, d]) = (half([&one, &zero], false), half([&zero, &one], false));
    let [back, _] = half([&zero, &one], true);
    let product = back * &c;
    ([a, b, c, d], product)
}
