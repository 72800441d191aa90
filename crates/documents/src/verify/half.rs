//! A half period in numbers: its determinant, and the full period kick by kick.

use num_traits::One;

use super::bias::bias;
use super::context::{Context, Outcome, holds};
use super::kind::Verify;
use crate::question::Half;
use clocks::propagator::methods::avi;
use clocks::propagator::{HalfPeriod, TwoClocks};
use number::{Rational, Result};

const ROUTE: &str =
    "the trace of the full period, kick by kick, is 2 (AD + BC), and AD - BC = 1, in exact arithmetic";

impl Verify for Half {
    fn check(&self, half: &HalfPeriod<Rational>, _: &Context) -> Result<Outcome> {
        let (diagonal, rest) = (half.a() * half.d(), half.b() * half.c());
        let det_is_one = holds(&diagonal - &rest == Rational::one(), || "its determinant is not 1".into());
        let clocks = TwoClocks::with_rho(self.ratio, self.s.clone(), self.rho.clone());
        let (trace, two) = (avi::staggered(&clocks).trace(), Rational::from_integer(2.into()));
        let is_trace = trace == two * (diagonal + rest);
        let whole =
            det_is_one.and_then(|()| holds(is_trace, || format!("the trace of the full period is {trace}")));
        let found = self.bias();
        let whole = whole.and_then(|()| {
            holds(found.is_none() || found == bias(&clocks), || "the bias is another one".into())
        });
        Ok(Outcome { rows: 4, ..Outcome::whole(ROUTE, whole)? })
    }
}
