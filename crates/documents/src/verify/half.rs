//! A half period in numbers: its determinant, and the full period kick by kick.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, holds};
use super::written::{Ends, Written};
use crate::question::Half;
use clocks::propagator::TwoClocks;
use clocks::propagator::methods::avi;
use num_traits::One;
use number::error::Result;
use number::{ExactSign, Rational, rational};

const ROUTE: &str =
    "the trace of the full period, kick by kick, is 2 (AD + BC), and AD - BC = 1, in exact arithmetic";

rows! {
    /// `kickdrift/half/1`.
    pub struct Claim {
        input: Half,
        entries: Vec<Entry>,
    }

    struct Entry [entry] {
        entry: String,
        sign: i64,
        value: Ends,
        exact: Written<Rational>,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "entries";
    asked!(Half);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        context.outcome(ROUTE, ("the entries", self.whole()), &self.entries, Entry::holds)
    }
}

impl Claim {
    fn whole(&self) -> Checked {
        let names: Vec<&str> = self.entries.iter().map(|entry| entry.entry.as_str()).collect();
        let [a, b, c, d] = match &self.entries[..] {
            [a, b, c, d] if names == ["A", "B", "C", "D"] => [a, b, c, d].map(|entry| &entry.exact.0),
            _ => return holds(false, || "its entries are not A, B, C, D".into()),
        };
        let (diagonal, rest) = (a * d, b * c);
        holds(&diagonal - &rest == Rational::one(), || "its determinant is not 1".into())?;
        let Half { ratio, s, rho } = self.input.clone();
        let trace = avi::staggered(&TwoClocks::with_rho(ratio, s, rho)).trace();
        let two = Rational::from_integer(2.into());
        holds(trace == two * (diagonal + rest), || format!("the trace of the full period is {trace}"))
    }
}

impl Entry {
    fn holds(&self) -> Checked {
        let (lo, hi) = (rational::from_f64_exact(self.value.lo), rational::from_f64_exact(self.value.hi));
        let inside = lo.is_none_or(|lo| lo <= *self.exact) && hi.is_none_or(|hi| *self.exact <= hi);
        holds(inside, || "its value lies outside its enclosure".into())?;
        holds(self.sign == i64::from(self.exact.sign().to_i8()), || "its sign is another one".into())
    }
}
