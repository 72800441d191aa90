//! Polynomials: numbers kicked and drifted at as many rational points as determine them.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, Place, holds};
use super::exact::{check_ratio, fraction};
use super::written::Written;
use crate::question::Polynomial;
use clocks::propagator::methods::avi;
use clocks::propagator::{TwoClocks, half_period};
use num_traits::{One, Zero};
use number::error::Result;
use number::{Ratio, Rational};
use serde::Deserialize;

const ROUTE: &str = "the full period, kick by kick, at more rational points than the degrees leave free";

rows! {
    /// `kickdrift/polynomial/1`.
    pub struct Claim {
        input: Polynomial,
        terms: Vec<Term>,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
enum Entry {
    A,
    B,
    C,
    D,
    #[serde(rename = "trace")]
    Trace,
}

rows! {
    struct Term {
        entry: Entry,
        s: u32,
        rho: u32,
        coefficient: Written<Rational>,
    }
}

impl Place for Entry {
    fn place(&self) -> String {
        format!("entry = {self:?}")
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "terms";
    asked!(Polynomial);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let all = [Entry::A, Entry::B, Entry::C, Entry::D, Entry::Trace];
        context.outcome(ROUTE, ("the ratio", self.affordable(context)), &all, |&entry| self.entry(entry))
    }
}

impl Claim {
    fn affordable(&self, context: &Context) -> Checked {
        check_ratio(self.input.ratio.p(), self.input.ratio.q(), &context.limits()).map(drop)
    }

    fn entry(&self, entry: Entry) -> Checked {
        let terms: Vec<&Term> = self.terms.iter().filter(|term| term.entry == entry).collect();
        // At most p + q kicks carry a power of s each, q of them one of ρ.
        let (in_s, in_rho) = (self.input.ratio.kicks() as u32, self.input.ratio.q() as u32);
        let bounded = terms.iter().all(|term| term.s <= in_s && term.rho <= in_rho);
        holds(bounded, || format!("no power above s^{in_s} rho^{in_rho} can stand"))?;
        // A polynomial of degree m in s and n in ρ is determined by (m + 1)(n + 1) values on a grid.
        for (s, rho) in (0..=in_s).flat_map(|i| (0..=in_rho).map(move |j| (i, j))) {
            let power =
                |x: u32, k: u32| if k == 0 { Rational::one() } else { fraction(x.into(), 1).pow(k as i32) };
            let value = terms.iter().fold(Rational::zero(), |sum, term| {
                sum + &*term.coefficient * power(s, term.s) * power(rho, term.rho)
            });
            let truth = entry.kicked(self.input.ratio, s, rho);
            holds(value == truth, || format!("at s = {s}, rho = {rho} it is {truth}, not {value}"))?;
        }
        Ok(())
    }
}

impl Entry {
    /// Its value at one point: numbers kicked and drifted, no polynomials.
    fn kicked(self, ratio: Ratio, s: u32, rho: u32) -> Rational {
        let clocks = TwoClocks::with_rho(ratio, fraction(s.into(), 1), fraction(rho.into(), 1));
        let half = || half_period(&clocks);
        match self {
            Entry::A => half().a().clone(),
            Entry::B => half().b().clone(),
            Entry::C => half().c().clone(),
            Entry::D => half().d().clone(),
            Entry::Trace => avi::staggered(&clocks).trace(),
        }
    }
}
