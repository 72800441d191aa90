//! Polynomials: numbers kicked and drifted at as many rational points as determine them.

use super::context::{Checked, Context, Outcome, holds, located};
use super::exact::{check_ratio, fraction};
use super::kind::Verify;
use crate::question::{Polynomial, Polynomials};
use clocks::propagator::methods::avi;
use clocks::propagator::{TwoClocks, half_period};
use number::{self, Ratio, Rational, Result};

const ROUTE: &str = "the full period, kick by kick, at more rational points than the degrees leave free";

type Bivariate = number::Polynomial<number::Polynomial<Rational>>;

impl Verify for Polynomial {
    fn check(&self, polynomials: &Polynomials, context: &Context) -> Result<Outcome> {
        let is_affordable = check_ratio(self.ratio.p(), self.ratio.q(), &context.limits()).map(drop);
        let mut outcome = context.outcome(ROUTE, is_affordable, polynomials, |(name, polynomial)| {
            located(name, equals(self.ratio, name, polynomial))
        })?;
        // A row is a term.
        outcome.failures.iter_mut().for_each(|failure| failure.row = 0);
        Ok(outcome)
    }
}

fn equals(ratio: Ratio, name: &str, polynomial: &Bivariate) -> Checked {
    // At most p + q kicks carry a power of s each, q of them one of ρ.
    let (in_s, in_rho) = (ratio.kicks(), ratio.q());
    let is_within = |degree: Option<usize>, most: u64| degree.is_none_or(|degree| degree as u64 <= most);
    let bounded = is_within(polynomial.degree(), in_s)
        && polynomial.coefficients().iter().all(|in_rho_of_s| is_within(in_rho_of_s.degree(), in_rho));
    holds(bounded, || format!("no power above s^{in_s} rho^{in_rho} can stand"))?;
    // A polynomial of degree m in s and n in ρ is determined by (m + 1)(n + 1) values on a grid.
    for (s, rho) in (0..=in_s).flat_map(|i| (0..=in_rho).map(move |j| (fraction(i, 1), fraction(j, 1)))) {
        let value = polynomial.map(|in_rho_of_s| in_rho_of_s.eval(&rho)).eval(&s);
        let truth = kicked(name, &TwoClocks::with_rho(ratio, s.clone(), rho.clone()));
        holds(value == truth, || format!("at s = {s}, rho = {rho} it is {truth}, not {value}"))?;
    }
    Ok(())
}

/// An entry, or the trace, at one point: numbers kicked and drifted, no polynomials.
fn kicked(name: &str, clocks: &TwoClocks<Rational>) -> Rational {
    if name == "trace" {
        return avi::staggered(clocks).trace();
    }
    let half = half_period(clocks);
    match name {
        "A" => half.a(),
        "B" => half.b(),
        "C" => half.c(),
        _ => half.d(),
    }
    .clone()
}
