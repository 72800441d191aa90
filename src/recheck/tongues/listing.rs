//! Tongues as a list: none left out, and counted as they are.

use super::rows::{Claim, Input, Points, Tongue};
use crate::number::{Laurent, Ratio, Rational};
use crate::recheck::context::{Checked, Fault, Place, holds, same};
use crate::recheck::exact::check_ratio;
use crate::recheck::written::{Range, ratios};
use crate::resonance::dominant_family;
use crate::tongue::{Selection, Tongues};
use crate::verdict::Limits;

/// The label of the last tongue, which has no upper edge.
pub fn last(ratio: Ratio, rho: &Rational) -> u64 {
    if *rho == Rational::default() { ratio.p() } else { ratio.kicks() - 1 }
}

impl Claim {
    /// The labels asked for are there, in order: as many edges as an entry has zeros, so each enclosure holds one.
    pub(super) fn complete(&self, limits: &Limits) -> Checked {
        self.input.sound()?;
        let list = ratios(self.input.ratio.as_ref(), self.input.max_sum.as_ref())?;
        let mut rows = self.tongues.iter().zip(1..);
        for ratio in list {
            let (p, q) = ratio.terms();
            for m in self.input.labels(ratio, limits)? {
                let place = format!("p = {p}, q = {q}, m = {m}");
                let missing = || Fault::Wrong(format!("{place} is missing at the end"));
                let (row, i): (&Tongue, u64) = rows.next().ok_or_else(missing)?;
                holds((row.p, row.q, row.m) == (p, q, m), || {
                    format!("row {i}, {}, is not {place}, which belongs here", row.place())
                })?;
            }
        }
        let next = rows.next();
        holds(next.is_none(), || format!("row {} is one tongue too many", next.map_or(0, |(_, i)| i)))
    }
}

impl Claim {
    /// The counts behind the rows are those of the rows, and all rows have the same columns.
    pub(super) fn counted(&self) -> Checked {
        let rows = &self.tongues;
        let closed = rows.iter().filter(|row| row.closed).count() as u64;
        same("count", self.count, rows.len() as u64)?;
        same("closed", self.closed, closed)?;
        same("open", self.open, rows.len() as u64 - closed)?;
        let columns = |row: &Tongue| {
            let edges = row.upper.iter().chain([&row.lower]);
            let exact: Vec<bool> =
                edges.flat_map(|edge| [edge.exact.is_absent(), edge.on.is_absent()]).collect();
            let of_row = [row.growth.is_absent(), row.predicted.is_absent(), row.first_order.is_absent()];
            (of_row, exact[0], exact.iter().all(|&absent| absent == exact[0]))
        };
        for (i, row) in rows.iter().enumerate() {
            let uniform = columns(row) == columns(&rows[0]) && columns(row).2;
            holds(uniform, || format!("row {} has other columns than row 1", i + 1))?;
        }
        let side = |wanted: &str| {
            rows.iter().filter_map(|row| row.predicted.value()).filter(|p| p.side == wanted).count()
        };
        let [inside, on_edge, outside] = ["inside", "on the edge", "outside"].map(|name| side(name) as u64);
        let truth = Some(Points { inside, on_edge, outside }).filter(|_| inside + on_edge + outside > 0);
        holds(self.predicted_points == truth, || format!("predicted_points are {truth:?}"))
    }
}

impl Input {
    /// The stiffnesses are those of ρ, and a window has its unit.
    fn sound(&self) -> Checked {
        holds(self.rho >= Rational::default(), || "rho is negative".into())?;
        let unit = self.lambda1.is_some()
            || (self.lambda2.is_none() && self.h1_range.is_none() && self.h2_range.is_none());
        holds(unit, || "lambda1 is missing".into())?;
        if let Some(lambda1) = &self.lambda1 {
            holds(lambda1.0 > Laurent::from_integer(0), || "lambda1 is not positive".into())?;
            let ratio = self.lambda2.as_ref().map(|lambda2| Laurent::ratio(lambda2, lambda1));
            let right = ratio.is_none_or(|ratio| ratio.as_ref() == Some(&self.rho));
            holds(right, || "rho is not lambda2/lambda1".into())?;
        }
        Ok(())
    }

    /// The labels asked for; those in a window by the string's counts again.
    fn labels(&self, ratio: Ratio, limits: &Limits) -> Checked<Vec<u64>> {
        check_ratio(ratio.p(), ratio.q(), limits)?;
        let last = last(ratio, &self.rho);
        if let Some(list) = self.m.as_ref().filter(|_| self.ratio.is_some()) {
            let labels = list.iter().flat_map(|&(from, upto)| [from, upto]);
            holds(labels.into_iter().all(|m| (1..=last).contains(&m)), || {
                format!("{ratio} has the tongues 1 to {last}")
            })?;
        }
        let within = |range: Option<(i64, i64)>, x: i64| range.is_none_or(|(lo, hi)| lo <= x && x <= hi);
        let (a, b) = (self.a.as_ref().map(|a| a.0), self.b.as_ref().map(|b| b.0));
        let wanted = |&m: &u64| {
            let listed = self
                .m
                .as_ref()
                .is_none_or(|list| list.iter().any(|&(from, upto)| (from..=upto).contains(&m)));
            listed
                && ((a.is_none() && b.is_none()) || {
                    let family = dominant_family(ratio, m);
                    within(a, family.0) && within(b, family.1)
                })
        };
        let labels: Vec<u64> = (1..=last).filter(wanted).collect();
        let Some(window) = self.window(ratio) else { return Ok(labels) };
        let selection = Selection { s: Some(window), ..Selection::default() };
        let met = Tongues::new(ratio, &self.rho)?.select(&selection)?;
        Ok(met.iter().map(|gap| gap.m).filter(|m| labels.binary_search(m).is_ok()).collect())
    }

    /// The window of s = h1² L1, its ends rounded outward: h1 = h2 q/p.
    fn window(&self, ratio: Ratio) -> Option<(f64, f64)> {
        let lambda1 = self.lambda1.as_ref()?;
        let back = Laurent::from_rational(ratio.inverse().into());
        let of_h1 = self.h1_range.as_ref().map(|range| range.0.clone());
        let of_h2 = self.h2_range.as_ref().map(|range| (&range.0.0 * &back, &range.0.1 * &back));
        let (lo, hi): Range = match (of_h1, of_h2) {
            (Some((a, b)), Some((c, d))) => (a.max(c), b.min(d)),
            (one, other) => one.or(other)?,
        };
        let zero = Laurent::from_integer(0);
        if hi < lo || hi < zero {
            return Some((1.0, 0.0)); // empty
        }
        let s = |h1: Laurent| &(&h1 * &h1) * &lambda1.0;
        Some((s(lo.max(zero)).enclose_f64().0, s(hi).enclose_f64().1))
    }
}
