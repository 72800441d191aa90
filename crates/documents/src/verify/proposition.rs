//! The Proposition's witnesses, in integers: no analysis.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, Place, holds, same};
use crate::question::Proposition;
use num_integer::Integer;
use number::error::Result;

const ROUTE: &str =
    "eq. (10) with m = a p + b q in integers, b not 0; every coprime (p, q, m) once; curves counted";

rows! {
    /// `kickdrift/proposition/1`.
    pub struct Claim {
        input: Proposition,
        holds: bool,
        resonant_points: u64,
        curves: u64,
        failures: Vec<Witness>,
        witnesses: Vec<Witness>,
    }

    #[derive(Copy)]
    struct Witness [p, q, m] {
        p: u64,
        q: u64,
        m: u64,
        a: i64,
        b: i64,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "witnesses";
    asked!(Proposition);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let max = self.input.max;
        context.outcome(ROUTE, (&format!("max = {max}"), self.whole(max)), &self.witnesses, Witness::holds)
    }
}

impl Claim {
    fn whole(&self, max: u64) -> Checked {
        let sound = self.holds && self.failures.is_empty();
        holds(sound, || "every point has its witness: it holds".into())?;
        let ratios = || (1..=max).flat_map(|p| (1..=max).filter(move |q| p.gcd(q) == 1).map(move |q| (p, q)));
        same("resonant_points", self.resonant_points, ratios().map(|(p, _)| p - 1).sum())?;
        same("the number of witnesses", self.witnesses.len() as u64, self.resonant_points)?;
        let mut points = ratios().flat_map(|(p, q)| (1..p).map(move |m| (p, q, m)));
        for (i, (w, (p, q, m))) in self.witnesses.iter().zip(&mut points).enumerate() {
            let place = || format!("row {} is {}, not p = {p}, q = {q}, m = {m}", i + 1, w.place());
            holds((w.p, w.q, w.m) == (p, q, m), place)?;
        }
        // a p + b q = m with |a| ≤ max, b ≠ 0: a runs through a residue class modulo q.
        let curves = |(p, q): (u64, u64)| {
            let (p, q, max) = (p as i64, q as i64, max as i64);
            let of = |m: i64| (-max..=max).filter(|a| (m - a * p) % q == 0 && m != a * p).count() as u64;
            (1..p).map(of).sum::<u64>()
        };
        same("curves", self.curves, ratios().map(curves).sum())
    }
}

impl Witness {
    fn holds(&self) -> Checked {
        let Witness { p, q, m, a, b } = *self;
        let small = [p, q, m, a.unsigned_abs(), b.unsigned_abs()].iter().all(|&n| n < 1 << 20);
        let sound = small && p > 0 && q > 0 && (1..p).contains(&m) && p.gcd(&q) == 1;
        holds(sound, || "is no resonant point of a ratio in lowest terms".into())?;
        holds(b != 0, || "b = 0: eq. (10) has no such curve".into())?;
        let (p, q, m) = (p as i64, q as i64, m as i64);
        // In the unit h1 T½ = p/m: h2 = b T½/(1 − a T½) = b p/(m − a p) must be p/q.
        let on_curve = m != a * p && b * p * q == p * (m - a * p);
        holds(on_curve, || "its curve does not pass through the point".into())
    }
}
