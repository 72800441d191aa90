//! Closings: at both ends of the range of ρ the edges lie in opposite orders, by exact signs; where a closing is
//! rational, both entries vanish there.

use num_integer::Integer;
use serde_json::Value;

use super::exact::{ZeroOf, fraction, part, signs};
use super::read::{Checked, Row, holds, whole};
use super::{Context, Outcome};
use crate::error::Result;
use crate::number::{Rational, Sign};
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
    let (p, q, m) = (row.whole("p")?, row.whole("q")?, row.whole("m")?);
    holds(p > 0 && q > 0 && m > 0 && p.gcd(&q) == 1, || "is no tongue of a ratio in lowest terms".into())?;
    let pair = if m % 2 == 1 { [Entry::A, Entry::D] } else { [Entry::B, Entry::C] };
    let (s, rho) = (row.object("s")?, row.object("rho")?);
    let four = fraction(4, 1);
    let ends = |x: &Row| -> Checked<(Rational, Rational)> {
        let decimal = x.object("decimal")?;
        Ok((decimal.rational("lo")?, decimal.rational("hi")?))
    };
    let (s_lo, s_hi) = ends(&s)?;
    let below = if row.flag("below_verlet")? { s_lo < four } else { s_hi >= four };
    holds(below, || "s* is on the other side of 4".into())?;
    if s.get("exact").is_some() {
        let (s, rho) = (s.rational("exact")?, rho.rational("exact")?);
        let signs = signs(p, q, &rho, &s).all();
        let closed = pair.iter().all(|&entry| signs[entry as usize] == Sign::Zero);
        return holds(closed, || format!("its entries do not both vanish at s = {s}, rho = {rho}"));
    }
    // A hair to either side of the box, in units of its own size: there the edges have parted.
    let (lo, hi) = ends(&rho)?;
    let margin = &hi - &lo;
    let orders =
        [&lo - &margin, &hi + &margin].map(|rho| order((p, q, m), pair, &rho, (&s_lo, &s_hi), limits));
    let [early, late] = orders;
    holds(early? != late?, || "its edges do not exchange their order".into())
}

/// Whether the first entry's zero near s* lies below the second's, and that the label between them is m.
fn order(
    (p, q, m): (u64, u64, u64),
    pair: [Entry; 2],
    rho: &Rational,
    (lo, hi): (&Rational, &Rational),
    limits: &Limits,
) -> Checked<std::cmp::Ordering> {
    // Far wider than the box: the zeros move with rho.
    let reach = (hi - lo) * fraction(1 << 20, 1);
    let around = || (lo - &reach, hi + &reach);
    let mut first = ZeroOf::new((p, q, rho), pair[0], around(), "s")?;
    let mut second = ZeroOf::new((p, q, rho), pair[1], around(), "s")?;
    let order = part(&mut first, &mut second);
    let (lower, upper) =
        if order == Some(std::cmp::Ordering::Less) { (first, second) } else { (second, first) };
    let middle = (&lower.hi + &upper.lo) / fraction(2, 1);
    let clocks = TwoClocks::with_rho(p, q, middle, rho.clone());
    let verdict = decide(&clocks, limits)?.verdict;
    let label = growth(&clocks, verdict, limits)?.label;
    holds(label == Some(m), || format!("the growing solution beside it turns {label:?} times"))?;
    order.map_or_else(
        || holds(false, || "its edges do not part beside it".into()).map(|()| std::cmp::Ordering::Equal),
        Ok,
    )
}
