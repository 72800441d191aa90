//! Tongues as a list: none left out, and counted as they are.

use super::rows::{Claim, Input, Tongue};
use crate::error::{Error, Result};
use crate::number::{Laurent, Ratio, Rational};
use crate::recheck::context::{Checked, Fault, Place, holds};
use crate::recheck::exact::check_ratio;
use crate::recheck::written::{Range, ratios};
use crate::resonance::dominant_family;
use crate::tongue::{Labels, Question, Request, Selection, Stiffness, Tongues, Wanted, Window};
use crate::verdict::Limits;

/// The most digits of an edge.
const MOST_DIGITS: u64 = 10_000;

/// The label of the last tongue, which has no upper edge.
pub fn last(ratio: Ratio, rho: &Rational) -> u64 {
    if *rho == Rational::default() { ratio.p() } else { ratio.kicks() - 1 }
}

impl Claim {
    /// The labels asked for are there, in order: as many edges as an entry has zeros, so each enclosure holds one.
    pub(super) fn complete(&self, limits: &Limits) -> Checked {
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
    /// The columns asked for: those that the first row has.
    pub(super) fn wanted(&self) -> Wanted {
        let has = |find: fn(&Tongue) -> bool| self.tongues.first().is_some_and(find);
        Wanted {
            family: true,
            exact: has(|row| !row.lower.exact.is_absent()),
            growth: has(|row| !row.growth.is_absent()),
            predicted: has(|row| !row.predicted.is_absent()),
            first_order: has(|row| !row.first_order.is_absent()),
        }
    }
}

impl Input {
    /// The question, within the limits.
    pub(super) fn question(&self, wanted: Wanted, limits: &Limits) -> Result<Question> {
        let list = ratios(self.ratio.as_ref(), self.max_sum.as_ref()).map_err(Fault::refused)?;
        if let Some(longest) = list.iter().max_by_key(|ratio| ratio.kicks()) {
            check_ratio(longest.p(), longest.q(), limits).map_err(Fault::refused)?;
        }
        let [lambda1, lambda2] =
            [&self.lambda1, &self.lambda2].map(|own| own.as_ref().map(|own| own.0.clone()));
        // rho is echoed, whether it was given or follows.
        let rho = lambda2.is_none().then(|| self.rho.clone());
        let stiffness = Stiffness::new(rho, lambda1, lambda2)?;
        let [h1, h2] = [&self.h1_range, &self.h2_range].map(|own| own.as_ref().map(|own| own.0.clone()));
        let m = self.m.as_ref().map(|m| Labels(m.0.clone()));
        let [a, b] = [&self.a, &self.b].map(|own| own.as_ref().map(|own| own.0));
        let digits = self.digits.as_ref().map(|digits| digits.0);
        if let Some(digits) = digits.filter(|digits| !(1..=MOST_DIGITS).contains(digits)) {
            return Err(Error::input("input.digits", digits, format!("is not in 1..{MOST_DIGITS}")));
        }
        let request = Request { wanted, lambda1: None, digits: digits.map(|digits| digits as u32) };
        let selection = Selection { m, a, b, s: None };
        Question::new(list, stiffness, Window { h1, h2 }, selection, request)
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
