//! Friction on forces that are no gradient: which masks growth, by the spectral radius of whole periods.
//!
//! O, v → exp(−γ d) v, stands in the middle of every drift d, as BAOAB has it. Eigenvalues of the period in
//! doubles lie in discs that its error widens, so all discs within the unit circle, or a form that every
//! matrix within the error shrinks, prove that every mean and covariance stays bounded, and a component of
//! discs outside it that something grows in spite of the friction (file `radius` of the room `friction`).

use faer::Mat;
use nalgebra::DMatrix;

use super::model::Jacobians;
use super::orbit::{Doubles, Strike, lead};
use crate::friction::{Damping, Radius, damping};
use clocks::schedule::KickDrift;
use number::{Ball, Rational, from_f64_exact, to_f64};

/// The friction that masks growth is looked for of so many degrees of freedom: some thirty eigenvalue
/// problems of twice as many rows.
pub(super) const MOST_MASKED: usize = 150;

/// How much a multiplier may be above 1 in doubles where nothing grows: of nearly defective periods half of
/// the digits are right.
const STILL: f64 = 1e-7;

/// A friction so much above the least one in doubles is tried for a proof.
const ABOVE: f64 = 1.01;

const BITS: u32 = 96;

impl Jacobians {
    /// Where the spectral radius of a period with friction γ per unit time lies; `None`: doubles cannot
    /// decide.
    pub fn damping(&self, friction: &Rational) -> Option<Damping> {
        let (period, error) = self.damped_period(friction);
        damping(&period, error, Radius::of(&period, error))
    }

    /// A friction per unit time that is proven to mask what grows, about the least; `None` where nothing
    /// grows in doubles, none is proven, or there are too many degrees of freedom to look for it.
    pub fn masking_friction(&self) -> Option<f64> {
        if self.size() > MOST_MASKED {
            return None;
        }
        let found = Some(ABOVE * self.masking()).filter(|rate| *rate > 0.0)?;
        (self.damping(&from_f64_exact(found)?) == Some(Damping::Damped)).then_some(found)
    }

    /// One period of the time-symmetric form in doubles, rounded: positions first, then velocities, without
    /// rigid motions.
    pub fn full_period(&self) -> DMatrix<f64> {
        let (period, _) = self.damped_period(&Rational::default());
        DMatrix::from_fn(period.nrows(), period.ncols(), |i, j| period[(i, j)])
    }

    /// The period with friction, and a bound on its error for the matrices given (2-norm).
    fn damped_period(&self, rate: &Rational) -> (Mat<f64>, f64) {
        let n = self.size();
        let whole = Mat::<f64>::identity(2 * n, 2 * n);
        let (x, v) = (whole.subrows(0, n).to_owned(), whole.subrows(n, n).to_owned());
        let mut state = Damped { rate, doubles: Doubles::new(self, x, v), tick: &self.tick };
        lead(self, self.schedule.symmetric_period(), &mut state);
        let (x, v) = (&state.doubles.x, &state.doubles.v);
        let period = Mat::from_fn(2 * n, 2 * n, |i, j| if i < n { x[(i, j)] } else { v[(i - n, j)] });
        (period, state.doubles.error())
    }

    /// By bisection on the spectral radius of the damped period, rounded; 0 where nothing grows without
    /// friction.
    pub(super) fn masking(&self) -> f64 {
        let grows = |rate: f64| {
            let rate = from_f64_exact(rate).unwrap_or_default();
            let multipliers = self.damped_period(&rate).0.eigenvalues();
            multipliers.map_or(true, |all| all.iter().any(|z| z.norm() > 1.0 + STILL))
        };
        if !grows(0.0) {
            return 0.0;
        }
        let mut hi = 0.01 / to_f64(&self.period());
        while grows(hi) && hi.is_finite() {
            hi *= 2.0;
        }
        let mut lo = 0.0;
        for _ in 0..20 {
            let middle = (lo + hi) / 2.0;
            *(if grows(middle) { &mut lo } else { &mut hi }) = middle;
        }
        hi
    }
}

/// With friction halfway through every drift.
struct Damped<'a> {
    rate: &'a Rational,
    tick: &'a Rational,
    doubles: Doubles<'a>,
}

impl KickDrift<Strike> for Damped<'_> {
    fn drift(&mut self, ticks: u64) {
        let time = self.tick * Rational::from_integer(ticks.into());
        let half = 0.5 * to_f64(&time);
        let factor = Ball::from_rational(&-(self.rate * &time), BITS).exp(BITS).mid_f64();
        self.doubles.moved(half);
        self.doubles.faded(factor);
        self.doubles.moved(half);
    }

    fn kick(&mut self, strike: &Strike) {
        self.doubles.kick(strike);
    }
}
