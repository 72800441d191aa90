//! Closings: at both ends of the range of ρ the edges lie in opposite orders, by exact signs; where a closing
//! is rational, both entries vanish there. How many there are is counted for the mirror ratio q/p, whose
//! tongues close at 1/ρ: by another resultant.

use serde_json::Value;

use super::again::Recheck;
use super::context::{Checked, Context, Fault, Outcome, holds};
use super::exact::{ZeroOf, check_ratio, fraction, part, signs};
use super::written::{Decimal, Written, exact};
use crate::question::{Closings, Question};
use clocks::propagator::TwoClocks;
use clocks::tongue::{COMPLETE_UP_TO, Entry, Search, Tongues, closings_of, count_closings};
use clocks::verdict::{Limits, decide, growth};
use num_traits::Signed;
use number::error::Result;
use number::rational::simplest;
use number::{Ratio, Rational, Sign};

const ROUTE: &str = "exact signs at both ends of the range of rho: the edges exchange their order, the label between \
                     them is m; rational closings: both entries vanish; complete lists by the mirror ratio's resultant";

rows! {
    /// `kickdrift/closings/1`.
    pub struct Claim {
        input: Closings,
        closings: Vec<Closing>,
        ratios: Vec<Searched>,
    }

    struct Closing [p, q, m] {
        p: u64,
        q: u64,
        m: u64,
        s: Side,
        rho: Side,
        below_verlet: bool,
    }

    struct Side {
        lo: f64,
        hi: f64,
        exact: Written<Rational> | null,
        decimal: Decimal,
    }

    struct Searched {
        complete: bool,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "closings";
    type Found = ();

    fn again(&self, context: &Context) -> Result<(Value, ())> {
        let list = self.input.ratios()?.list();
        list.iter()
            .try_for_each(|ratio| check_ratio(ratio.p(), ratio.q(), &context.limits()).map(drop))
            .map_err(Fault::refused)?;
        Ok((self.input.ask(&context.work())?.value(), ()))
    }

    fn check(&self, (): (), context: &Context) -> Result<Outcome> {
        let whole = self.complete(&context.limits());
        let holds = |row: &Closing| row.holds(&context.limits());
        let mut outcome = context.outcome(ROUTE, ("the list", whole), &self.closings, holds)?;
        if self.ratios.iter().any(|ratio| !ratio.complete) {
            let remark = "ratios that are not complete: that a tongue closes there as often as it is listed, but for pairs";
            outcome.not_rechecked.push(remark.into());
        }
        Ok(outcome)
    }
}

impl Claim {
    /// The closings lie in the range, and none of a ratio is missing.
    fn complete(&self, limits: &Limits) -> Checked {
        let (lo, hi) = &self.input.rho_range;
        for row in &self.closings {
            let (from, upto) = row.rho.both()?;
            holds(from <= *hi && *lo <= upto, || "a closing lies outside the range of rho".into())?;
        }
        for (ratio, searched) in self.input.ratios()?.list().into_iter().zip(&self.ratios) {
            let rows: Vec<&Closing> =
                self.closings.iter().filter(|row| (row.p, row.q) == ratio.terms()).collect();
            self.counted(ratio, searched.complete, &rows, (lo, hi), limits)?;
        }
        Ok(())
    }

    /// As many closings as the resultants have zeros, where the ratio is complete; else as many, but for
    /// pairs, as the edges' orders at both ends of the range of ρ require.
    fn counted(
        &self,
        ratio: Ratio,
        complete: bool,
        rows: &[&Closing],
        (lo, hi): (&Rational, &Rational),
        limits: &Limits,
    ) -> Checked {
        check_ratio(ratio.p(), ratio.q(), limits)?;
        let finite = ratio.kicks() - 2;
        let labels: Vec<u64> = (1..=finite)
            .filter(|m| {
                self.input.m.as_ref().is_none_or(|list| list.0.iter().any(|&(a, b)| (a..=b).contains(m)))
            })
            .collect();
        if !complete {
            let orders = [lo, hi].map(|rho| Tongues::new(ratio, rho)?.gaps(1, finite.max(1)));
            let [early, late] = orders;
            for (early, late) in early?.iter().zip(&late?).filter(|(gap, _)| labels.contains(&gap.m)) {
                let there = rows.iter().filter(|row| row.m == early.m).count() % 2 == 1;
                let crossed = early.lower.entry != late.lower.entry;
                let right = there == crossed || early.closed || late.closed;
                holds(right, || format!("{ratio}, m = {}: its edges change their order {crossed}", early.m))?;
            }
            return Ok(());
        }
        holds(ratio.kicks() <= COMPLETE_UP_TO, || {
            format!("{ratio} is too long for elimination: it cannot be complete")
        })?;
        // The clocks exchanged: s' = s ρ (p/q)², ρ' = 1/ρ, and the same half period, so the same labels.
        let mirrored = (hi.recip(), lo.recip());
        if let Some(asked) = &self.input.m {
            let search = Search { rho: mirrored, ..Search::default() };
            let truth = closings_of(ratio.inverse(), &asked.0, &search)?;
            let all = truth.complete && truth.closings.len() == rows.len();
            return holds(all, || {
                format!("{ratio} has {} closings of these labels, not {}", truth.closings.len(), rows.len())
            });
        }
        for odd in [true, false] {
            let said = rows.iter().filter(|row| (row.m % 2 == 1) == odd).count();
            let truth =
                count_closings(ratio.inverse(), Entry::of_tongue(odd), &mirrored.0, &mirrored.1).unwrap_or(0);
            holds(said == truth, || format!("{ratio} has {truth} closings of this parity, not {said}"))?;
        }
        Ok(())
    }
}

impl Side {
    /// The doubles and the decimals both hold the value: what they have in common.
    fn both(&self) -> Checked<(Rational, Rational)> {
        let ((a, b), (c, d)) = (exact(self.lo, self.hi)?, self.decimal.ends()?);
        let (lo, hi) = (a.max(c), b.min(d));
        holds(lo <= hi && lo.is_positive(), || {
            "doubles and decimals have nothing positive in common".into()
        })?;
        Ok((lo, hi))
    }
}

/// One side of a closing's box.
struct Interval {
    lo: Rational,
    hi: Rational,
    exact: Option<Rational>,
}

impl Interval {
    fn new(side: &Side, name: &str) -> Checked<Self> {
        let (lo, hi) = side.both()?;
        let exact = side.exact.as_ref().map(|x| x.0.clone());
        let inside = exact.as_ref().is_none_or(|x| lo <= *x && *x <= hi);
        holds(inside, || format!("{name} lies outside its own enclosure"))?;
        Ok(Interval { lo, hi, exact })
    }

    /// Its width, or a trillionth of a trillionth of its value where it is narrower.
    fn size(&self) -> Rational {
        (&self.hi - &self.lo).max(&self.hi * fraction(1, 1 << 40) * fraction(1, 1 << 40))
    }
}

impl Closing {
    fn holds(&self, limits: &Limits) -> Checked {
        let (p, q, m) = (self.p, self.q, self.m);
        let ratio = check_ratio(p, q, limits)?;
        holds((1..p + q - 1).contains(&m), || format!("{ratio} has the finite tongues 1 to {}", p + q - 2))?;
        let pair = Entry::of_tongue(m % 2 == 1);
        let (s, rho) = (Interval::new(&self.s, "s")?, Interval::new(&self.rho, "rho")?);
        let four = fraction(4, 1);
        let below = if self.below_verlet { s.lo < four } else { s.hi >= four };
        holds(below, || "s* is on the other side of 4".into())?;
        let vanish = |s: &Rational, rho: &Rational| {
            let signs = signs(ratio, rho, s).all();
            pair.iter().all(|&entry| signs[entry as usize] == Sign::Zero)
        };
        match (&s.exact, &rho.exact) {
            (Some(s), Some(rho)) => {
                holds(vanish(s, rho), || format!("its entries do not both vanish at s = {s}, rho = {rho}"))?;
            }
            (None, None) => {
                // The simplest rationals of the box: no coincidence where they are short.
                let [s, rho] = [&s, &rho].map(|side| simplest(&side.lo, &side.hi));
                let short = s.denom().bits() + rho.denom().bits() <= 32;
                holds(!(short && vanish(&s, &rho)), || format!("it is rational: s = {s}, rho = {rho}"))?;
            }
            _ => return Err(Fault::Wrong("s and rho are rational together".into())),
        }
        // A hair to either side of the box, in units of its own size: there the edges have parted. Zeros move
        // by no larger part of themselves than rho does (masses and eigenvalues), and rho by three of its
        // sizes at most.
        let margin = rho.size();
        let reach = s.size() + &s.hi * fraction(4, 1) * &margin / &rho.lo;
        let around = (&s.lo - &reach, &s.hi + &reach);
        let [early, late] =
            [&rho.lo - &margin, &rho.hi + &margin].map(|rho| order((ratio, m), pair, &rho, &around, limits));
        holds(early? != late?, || "its edges do not exchange their order".into())
    }
}

/// Whether the first entry's zero near s* lies below the second's, and that the label between them is m.
fn order(
    (ratio, m): (Ratio, u64),
    pair: [Entry; 2],
    rho: &Rational,
    around: &(Rational, Rational),
    limits: &Limits,
) -> Checked<std::cmp::Ordering> {
    let mut first = ZeroOf::new((ratio, rho), pair[0], around.clone(), "s")?;
    let mut second = ZeroOf::new((ratio, rho), pair[1], around.clone(), "s")?;
    let order = part(&mut first, &mut second);
    let (lower, upper) =
        if order == Some(std::cmp::Ordering::Less) { (first, second) } else { (second, first) };
    let middle = (&lower.hi + &upper.lo) / fraction(2, 1);
    let clocks = TwoClocks::with_rho(ratio, middle, rho.clone());
    let verdict = decide(&clocks, limits)?.verdict;
    let label = growth(&clocks, verdict, limits)?.label;
    holds(label == Some(m), || format!("the growing solution beside it turns {label:?} times"))?;
    order.map_or_else(
        || holds(false, || "its edges do not part beside it".into()).map(|()| std::cmp::Ordering::Equal),
        Ok,
    )
}
