//! Closings: at both ends of the range of ρ the edges lie in opposite orders, by exact signs; where a closing is
//! rational, both entries vanish there.

use num_traits::Signed;
use serde_json::Value;

use super::exact::{ZeroOf, check_ratio, fraction, part, signs};
use super::read::{Checked, Row, holds, whole};
use super::{Context, Outcome};
use crate::error::Result;
use crate::number::{Ratio, Rational, Sign};
use crate::propagator::TwoClocks;
use crate::tongue::Entry;
use crate::verdict::{Limits, decide, growth};

const ROUTE: &str = "exact signs at both ends of the range of rho: the edges exchange their order, the label between \
                     them is m; rational closings: both entries vanish";

pub fn check(document: &Value, context: &Context) -> Result<Outcome> {
    let rows = whole(Row::new(document).rows("closings"))?;
    context.rows(rows, ROUTE, |row| check_row(row, &context.limits))
}

fn check_row(row: &Row, limits: &Limits) -> Checked<()> {
    let (ratio, m) = (row.ratio()?, row.whole("m")?);
    check_ratio(ratio, limits)?;
    holds(m > 0, || "labels begin at 1".into())?;
    let pair = if m % 2 == 1 { [Entry::A, Entry::D] } else { [Entry::B, Entry::C] };
    let (s, rho) = (side(row, "s")?, side(row, "rho")?);
    let four = fraction(4, 1);
    let below = if row.flag("below_verlet")? { s.lo < four } else { s.hi >= four };
    holds(below, || "s* is on the other side of 4".into())?;
    if let (Some(s), Some(rho)) = (&s.exact, &rho.exact) {
        let signs = signs(ratio, rho, s).all();
        let closed = pair.iter().all(|&entry| signs[entry as usize] == Sign::Zero);
        holds(closed, || format!("its entries do not both vanish at s = {s}, rho = {rho}"))?;
    }
    holds(rho.lo.is_positive() && s.lo.is_positive(), || "s and rho are positive".into())?;
    // A hair to either side of the box, in units of its own size: there the edges have parted. Zeros move by no larger
    // part of themselves than rho does (masses and eigenvalues), and rho by three of its sizes at most.
    let margin = rho.size();
    let reach = s.size() + &s.hi * fraction(4, 1) * &margin / &rho.lo;
    let around = (&s.lo - &reach, &s.hi + &reach);
    let [early, late] =
        [&rho.lo - &margin, &rho.hi + &margin].map(|rho| order((ratio, m), pair, &rho, &around, limits));
    holds(early? != late?, || "its edges do not exchange their order".into())
}

/// One side of a closing's box.
struct Interval {
    lo: Rational,
    hi: Rational,
    exact: Option<Rational>,
}

/// The doubles and the decimals both hold the value: what they have in common.
fn side(row: &Row, key: &str) -> Checked<Interval> {
    let object = row.object(key)?;
    let decimal = object.object("decimal")?;
    let ((a, b), (c, d)) = (row.enclosure(key)?, (decimal.rational("lo")?, decimal.rational("hi")?));
    let (lo, hi) = (a.max(c), b.min(d));
    holds(lo <= hi, || format!("the doubles and the decimals of {key} have nothing in common"))?;
    let exact = object.get("exact").map(|_| object.rational("exact")).transpose()?;
    let inside = exact.as_ref().is_none_or(|x| lo <= *x && *x <= hi);
    holds(inside, || format!("{key} lies outside its own enclosure"))?;
    Ok(Interval { lo, hi, exact })
}

impl Interval {
    /// Its width, or a trillionth of a trillionth of its value where it is narrower.
    fn size(&self) -> Rational {
        (&self.hi - &self.lo).max(&self.hi * fraction(1, 1 << 40) * fraction(1, 1 << 40))
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
