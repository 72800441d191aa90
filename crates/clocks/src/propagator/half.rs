//! The propagator over the synchronization period, and over its half, which determines it.
//!
//! The kick pattern is a palindrome. With H = \[\[A, B\], \[C, D\]\] the propagator from 0 to T/2 (half of
//! each kick at both ends) and H' = \[\[D, B\], \[C, A\]\] its time reversal, Q = H' H, and AD − BC = 1 gives
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
use crate::schedule::{Events, KickDrift, Kicks, Schedule};
use number::{Rational, Ring};

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
    HalfPeriod(compose(clocks, Schedule::half_period))
}

/// The full-period propagator of the time-symmetric form: half of each kick at t = 0 and T.
///
/// # Panics
/// As [`half_period`].
pub fn full_period<S: Ring>(clocks: &TwoClocks<S>) -> Matrix2<S> {
    compose(clocks, Schedule::symmetric_period)
}

/// The product over the events of a span of the pair's schedule, the first event rightmost.
pub(super) fn compose<S: Ring>(clocks: &TwoClocks<S>, span: impl Fn(&Schedule) -> Events) -> Matrix2<S> {
    let schedule = schedule(clocks);
    let mut product = Product::over(&schedule);
    Kicks::of_two_clocks(clocks.strengths(), with_half).lead(span(&schedule), &mut product);
    product.matrix
}

/// The schedule of a pair.
pub(super) fn schedule<S: Ring>(clocks: &TwoClocks<S>) -> Schedule {
    Schedule::two_clocks(clocks.ratio()).expect("a period short enough to compose")
}

/// A kick and half of it.
pub(super) fn with_half<S: Ring>(kick: S) -> [S; 2] {
    let half = S::from_rational(&Rational::new(1.into(), 2.into()));
    [kick.clone(), kick * half]
}

/// The product so far.
pub(super) struct Product<S> {
    pub matrix: Matrix2<S>,
    /// Ticks in the unit of time h1.
    ticks: u64,
}

impl<S: Ring> Product<S> {
    /// The empty one; the unit of time is the step of the first clock.
    pub fn over(schedule: &Schedule) -> Product<S> {
        let matrix = Matrix2::new(S::one(), S::zero(), S::zero(), S::one());
        Product { matrix, ticks: schedule.clocks()[0].step() }
    }

    /// So many ticks in the unit of time.
    pub fn time(&self, ticks: u64) -> S {
        let divisor = ticks.gcd(&self.ticks);
        S::from_rational(&Rational::new_raw((ticks / divisor).into(), (self.ticks / divisor).into()))
    }
}

impl<S: Ring> KickDrift<S> for Product<S> {
    fn drift(&mut self, ticks: u64) {
        let time = self.time(ticks);
        apply_drift(&mut self.matrix, &time);
    }

    fn kick(&mut self, strength: &S) {
        apply_kick(&mut self.matrix, strength);
    }
}
