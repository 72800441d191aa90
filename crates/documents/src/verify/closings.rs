//! Closings: at both ends of the range of ρ the edges lie in opposite orders, by exact signs; where a closing
//! is rational, both entries vanish there. How many there are is counted for the mirror ratio q/p, whose
//! tongues close at 1/ρ: by another resultant.

use std::cmp::Ordering;

use super::context::{Checked, Context, Outcome, holds, located};
use super::exact::{ZeroOf, check_ratio, fraction, part, signs};
use super::kind::Verify;
use crate::question::Closings;
use clocks::propagator::TwoClocks;
use clocks::tongue::{Closing, Enclosure, Entry, Found, Search, Tongues, closings_of, count_closings};
use clocks::verdict::{Limits, decide, growth};
use number::rational::simplest;
use number::{Ratio, Rational, Result, Sign};

const ROUTE: &str = "exact signs at both ends of the range of rho: the edges exchange their order, the label between \
                     them is m; rational closings: both entries vanish; complete lists by the mirror ratio's resultant";

impl Verify for Closings {
    fn check(&self, found: &Vec<Found>, context: &Context) -> Result<Outcome> {
        let limits = context.limits();
        let counted = |found: &Found| located(found.ratio, self.counted(found, &limits));
        let closings: Vec<&Closing> = found.iter().flat_map(|found| &found.closings).collect();
        let mut outcome =
            context.outcome(ROUTE, found.iter().try_for_each(counted), &closings, |closing| {
                self.is_in_range(closing).and_then(|()| closes(closing, &limits))
            })?;
        if found.iter().any(|found| !found.complete) {
            let remark = "ratios that are not complete: that a tongue closes there as often as it is listed, but for pairs";
            outcome.not_rechecked.push(remark.into());
        }
        Ok(outcome)
    }
}

impl Closings {
    fn is_in_range(&self, closing: &Closing) -> Checked {
        let (lo, hi) = &self.rho_range;
        let is_inside = closing.rho.lo <= *hi && *lo <= closing.rho.hi;
        holds(is_inside, || "it lies outside the range of rho".into())
    }

    /// As many closings as the resultants have zeros, where the ratio is complete; else as many, but for
    /// pairs, as the edges' orders at both ends of the range of ρ require.
    fn counted(&self, Found { ratio, closings, complete }: &Found, limits: &Limits) -> Checked {
        check_ratio(ratio.p(), ratio.q(), limits)?;
        let (lo, hi) = &self.rho_range;
        if !complete {
            return self.crossed(*ratio, closings);
        }
        // The clocks exchanged: s' = s ρ (p/q)², ρ' = 1/ρ, and the same half period, so the same labels.
        let mirrored = (hi.recip(), lo.recip());
        if let Some(asked) = &self.m {
            let search = Search { rho: mirrored, ..Search::default() };
            let truth = closings_of(ratio.inverse(), &asked.0, &search)?;
            let all = truth.complete && truth.closings.len() == closings.len();
            return holds(all, || {
                format!("it has {} closings of these labels, not {}", truth.closings.len(), closings.len())
            });
        }
        for odd in [true, false] {
            let count = closings.iter().filter(|closing| (closing.m % 2 == 1) == odd).count();
            let truth = count_closings(ratio.inverse(), Entry::of_tongue(odd), &mirrored.0, &mirrored.1);
            let truth = truth.unwrap_or(0);
            holds(count == truth, || format!("it has {truth} closings of this parity, not {count}"))?;
        }
        Ok(())
    }

    /// Edges that change their order over the range of ρ do so at an odd number of closings.
    fn crossed(&self, ratio: Ratio, closings: &[Closing]) -> Checked {
        let (lo, hi) = &self.rho_range;
        let gaps = |rho: &Rational| Tongues::new(ratio, rho)?.gaps(1, (ratio.kicks() - 2).max(1));
        let (early, late) = (gaps(lo)?, gaps(hi)?);
        let is_asked =
            |m: u64| self.m.as_ref().is_none_or(|list| list.0.iter().any(|&(a, b)| (a..=b).contains(&m)));
        for (early, late) in early.iter().zip(&late).filter(|(gap, _)| is_asked(gap.m)) {
            let is_odd = closings.iter().filter(|closing| closing.m == early.m).count() % 2 == 1;
            let crossed = early.lower.entry != late.lower.entry;
            let right = is_odd == crossed || early.closed || late.closed;
            holds(right, || format!("m = {}: its edges change their order {crossed}", early.m))?;
        }
        Ok(())
    }
}

/// The width of an enclosure, or a trillionth of a trillionth of its value where it is narrower.
fn size(Enclosure { lo, hi }: &Enclosure) -> Rational {
    (hi - lo).max(hi * fraction(1, 1 << 40) * fraction(1, 1 << 40))
}

fn closes(closing: &Closing, limits: &Limits) -> Checked {
    let Closing { ratio, m, s, rho, exact, below_verlet } = closing;
    check_ratio(ratio.p(), ratio.q(), limits)?;
    let pair = Entry::of_tongue(m % 2 == 1);
    let four = fraction(4, 1);
    let below = if *below_verlet { s.lo < four } else { s.hi >= four };
    holds(below, || "s* is on the other side of 4".into())?;
    let vanish = |s: &Rational, rho: &Rational| {
        let signs = signs(*ratio, rho, s).all();
        pair.iter().all(|&entry| signs[entry as usize] == Sign::Zero)
    };
    match exact {
        Some((s, rho)) => {
            holds(vanish(s, rho), || format!("its entries do not both vanish at s = {s}, rho = {rho}"))?;
        }
        None => {
            // The simplest rationals of the box: no coincidence where they are short.
            let [s, rho] = [s, rho].map(|side| simplest(&side.lo, &side.hi));
            let short = s.denom().bits() + rho.denom().bits() <= 32;
            holds(!(short && vanish(&s, &rho)), || format!("it is rational: s = {s}, rho = {rho}"))?;
        }
    }
    // A hair to either side of the box, in units of its own size: there the edges have parted. Zeros move by
    // no larger part of themselves than rho does (masses and eigenvalues), and rho by three of its sizes at
    // most.
    let margin = size(rho);
    let reach = size(s) + &s.hi * fraction(4, 1) * &margin / &rho.lo;
    let around = (&s.lo - &reach, &s.hi + &reach);
    let [early, late] =
        [&rho.lo - &margin, &rho.hi + &margin].map(|rho| order((*ratio, *m), pair, &rho, &around, limits));
    holds(early? != late?, || "its edges do not exchange their order".into())
}

/// Whether the first entry's zero near s* lies below the second's, and that the label between them is m.
fn order(
    (ratio, m): (Ratio, u64),
    pair: [Entry; 2],
    rho: &Rational,
    around: &(Rational, Rational),
    limits: &Limits,
) -> Checked<Ordering> {
    let mut first = ZeroOf::new((ratio, rho), pair[0], around.clone(), "s")?;
    let mut second = ZeroOf::new((ratio, rho), pair[1], around.clone(), "s")?;
    let order = part(&mut first, &mut second);
    let (lower, upper) = if order == Some(Ordering::Less) { (first, second) } else { (second, first) };
    let middle = (&lower.hi + &upper.lo) / fraction(2, 1);
    let clocks = TwoClocks::with_rho(ratio, middle, rho.clone());
    let verdict = decide(&clocks, limits)?.verdict;
    let label = growth(&clocks, verdict, limits)?.label;
    holds(label == Some(m), || format!("the growing solution beside it turns {label:?} times"))?;
    holds(order.is_some(), || "its edges do not part beside it".into())?;
    Ok(order.unwrap_or(Ordering::Equal))
}
