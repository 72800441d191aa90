//! The Proposition's witnesses, in integers: no analysis.

use num_integer::Integer;

use super::context::{Checked, Context, Outcome, holds, same};
use super::kind::Verify;
use crate::question::Proposition;
use clocks::resonance::proposition::{Check, Witness};
use number::Result;

const ROUTE: &str =
    "eq. (10) with m = a p + b q in integers, b not 0; every coprime (p, q, m) once; curves counted";

impl Verify for Proposition {
    fn check(&self, (check, witnesses): &(Check, Vec<Witness>), context: &Context) -> Result<Outcome> {
        context.outcome(ROUTE, whole(self.max, check, witnesses), witnesses, passes)
    }
}

fn whole(max: u64, check: &Check, witnesses: &[Witness]) -> Checked {
    holds(check.failures.is_empty(), || "every point has its witness: it holds".into())?;
    let ratios = || (1..=max).flat_map(|p| (1..=max).filter(move |q| p.gcd(q) == 1).map(move |q| (p, q)));
    same("resonant_points", check.forward, ratios().map(|(p, _)| p - 1).sum())?;
    let points = ratios().flat_map(|(p, q)| (1..p).map(move |m| (p, q, m)));
    let found = witnesses.iter().map(|witness| (witness.ratio.p(), witness.ratio.q(), witness.m));
    holds(points.eq(found), || "its witnesses are not the witnesses of all points, in order".into())?;
    // a p + b q = m with |a| ≤ max, b ≠ 0: a runs through a residue class modulo q.
    let curves = |(p, q): (u64, u64)| {
        let (p, q, max) = (p as i64, q as i64, max as i64);
        let of = |m: i64| (-max..=max).filter(|a| (m - a * p) % q == 0 && m != a * p).count() as u64;
        (1..p).map(of).sum::<u64>()
    };
    same("curves", check.backward, ratios().map(curves).sum())
}

fn passes(witness: &Witness) -> Checked {
    let Witness { ratio, m, a, b } = *witness;
    holds(b != 0, || "b = 0: eq. (10) has no such curve".into())?;
    let (p, q, m) = (ratio.p() as i64, ratio.q() as i64, m as i64);
    // In the unit h1 T½ = p/m: h2 = b T½/(1 − a T½) = b p/(m − a p) must be p/q.
    let is_on_curve = m != a * p && b * p * q == p * (m - a * p);
    holds(is_on_curve, || "its curve does not pass through the point".into())
}
