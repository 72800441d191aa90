//! The propagator over the synchronization period, and over its half, which tells all about it.
//!
//! The kick pattern is a palindrome. With H = \[\[A, B\], \[C, D\]\] the propagator from 0 to T/2 (half of each
//! kick at both ends) and H' = \[\[D, B\], \[C, A\]\] its time reversal, Q = H' H, and AD − BC = 1 gives
//!
//! ```text
//!     Tr Q = 2 (AD + BC),     Tr Q - 2 = 4 BC,     Tr Q + 2 = 4 AD
//! ```
//!
//! (theorem `palindrome` in proofs/). So the four signs of H decide
//! stability, at half the cost and without cancellation at |Tr| = 2.

use nalgebra::Matrix2;
use num_integer::Integer;

use super::TwoClocks;
use super::elementary::{apply_drift, apply_kick};
use crate::error::Result;
use crate::number::{Rational, Ring};
use crate::schedule::{Event, Schedule, Weight};

/// H = \[\[A, B\], \[C, D\]\], the propagator over the first half of the time-symmetric period.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfPeriod<S>(Matrix2<S>);

impl<S: Ring> HalfPeriod<S> {
    /// A: the position at T/2 of the even solution, (x, v) = (1, 0) at t = 0.
    pub fn a(&self) -> &S {
        &self.0[(0, 0)]
    }

    /// B: the position at T/2 of the odd solution, (x, v) = (0, 1) at t = 0.
    pub fn b(&self) -> &S {
        &self.0[(0, 1)]
    }

    /// C: the velocity at T/2 of the even solution.
    pub fn c(&self) -> &S {
        &self.0[(1, 0)]
    }

    /// D: the velocity at T/2 of the odd solution.
    pub fn d(&self) -> &S {
        &self.0[(1, 1)]
    }

    /// Tr Q = 2 (AD + BC).
    pub fn trace(&self) -> S {
        let mut sum = S::product(self.a(), self.d());
        sum.add_product(self.b(), self.c());
        sum.clone() + sum
    }

    /// Q = H' H of the time-symmetric form, H' = \[\[D, B\], \[C, A\]\].
    pub fn full(&self) -> Matrix2<S> {
        let (a, b, c, d) = (self.a(), self.b(), self.c(), self.d());
        Matrix2::new(d.clone(), b.clone(), c.clone(), a.clone()) * &self.0
    }

    /// The matrix H.
    pub fn matrix(&self) -> &Matrix2<S> {
        &self.0
    }
}

/// The half-period propagator of two clocks in the time unit h1, exact in every exact ring: about (p + q)/2
/// kicks and drifts of two multiplications a column.
///
/// # Panics
/// Where the period has 2^62 ticks and more (some 10^18 kicks).
pub fn half_period<S: Ring>(clocks: &TwoClocks<S>) -> HalfPeriod<S> {
    let schedule = schedule(clocks).expect("a period short enough to compose");
    HalfPeriod(compose(schedule.half_period(), &Steps::new(clocks, &schedule)))
}

/// The full-period propagator of the time-symmetric form: half of each kick at t = 0 and T.
///
/// # Panics
/// As [`half_period`].
pub fn full_period<S: Ring>(clocks: &TwoClocks<S>) -> Matrix2<S> {
    let schedule = schedule(clocks).expect("a period short enough to compose");
    compose(schedule.symmetric_period(), &Steps::new(clocks, &schedule))
}

/// The schedule of the pair.
pub(super) fn schedule<S: Ring>(clocks: &TwoClocks<S>) -> Result<Schedule> {
    Schedule::two_clocks(clocks.ratio())
}

/// The product over `events`, the first event rightmost.
pub(super) fn compose<S: Ring>(events: impl Iterator<Item = Event>, steps: &Steps<S>) -> Matrix2<S> {
    let mut m = Matrix2::new(S::one(), S::zero(), S::zero(), S::one());
    for event in events {
        if event.drift > 0 {
            apply_drift(&mut m, &steps.drift(event.drift));
        }
        if event.kicks != 0 {
            apply_kick(&mut m, steps.kick(event.kicks, event.weight));
        }
    }
    m
}

/// The lengths and strengths that the events of two clocks refer to.
pub(super) struct Steps<S> {
    /// Ticks in the unit of time h1.
    ticks: u64,
    /// The strength for each set of clocks (index: the event's bits), whole and halved.
    full: [S; 4],
    half: [S; 4],
}

impl<S: Ring> Steps<S> {
    pub(super) fn new(clocks: &TwoClocks<S>, schedule: &Schedule) -> Self {
        let (fast, slow) = (clocks.fast().clone(), clocks.slow().clone());
        let full = [S::zero(), fast.clone(), slow.clone(), fast + slow];
        let one_half = S::from_rational(&Rational::new(1.into(), 2.into()));
        let half = full.clone().map(|k| k * one_half.clone());
        Steps { ticks: schedule.clocks()[0].step(), full, half }
    }

    fn kick(&self, kicks: u64, weight: Weight) -> &S {
        match weight {
            Weight::Full => &self.full[kicks as usize],
            Weight::Half => &self.half[kicks as usize],
        }
    }

    fn drift(&self, ticks: u64) -> S {
        let divisor = ticks.gcd(&self.ticks);
        S::from_rational(&Rational::new_raw((ticks / divisor).into(), (self.ticks / divisor).into()))
    }
}
