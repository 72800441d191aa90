//! A survey: its counts add up, and the thin tongues it lists have edges that part by the width told.

use num_traits::Zero;
use serde_json::{Value, json};

use super::exact::{ZeroOf, check_ratio, fraction, part};
use super::read::{Checked, Row, holds, whole};
use super::{Context, Outcome};
use crate::cli::ratios::Ratios;
use crate::cli::tongues::MOST_SUM;
use crate::error::Result;
use crate::number::{Ratio, Rational, rational};
use crate::tongue::Entry;
use crate::verdict::Limits;

const ROUTE: &str = "thin tongues by exact signs about both edges; ratios counted again; the counts add up";

pub fn check(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let input = whole(all.object("input"))?;
    let rho = whole(input.rational("rho"))?;
    let max_sum = whole(input.rational("max_sum"))?.to_integer().try_into().unwrap_or(0);
    Ratios::UpTo(max_sum).within(MOST_SUM)?;
    let mut rows = whole(all.rows("thinnest"))?.to_vec();
    rows.push(json!({"entry": "counts"}));
    context.rows(&rows, ROUTE, |row| match row.get("entry") {
        Some(_) => counts(&all, Ratio::up_to(max_sum).count() as u64),
        None => thin(row, &rho, &context.limits),
    })
}

fn counts(all: &Row, ratios: u64) -> Checked<()> {
    holds(all.whole("ratios")? == ratios, || format!("there are {ratios} ratios"))?;
    let closed = all.rows("closed")?.len() as u64;
    holds(all.whole("tongues")? == all.whole("open")? + closed, || "open and closed are not all".into())?;
    let predicted = all.object("predicted")?;
    let parts = ["outside", "on_edge", "inside"].map(|key| predicted.whole(key));
    let sum = parts.into_iter().sum::<Checked<u64>>()?;
    holds(predicted.whole("points")? == sum, || "the predicted points do not add up".into())?;
    let spreads = all.rows("width_ratios")?.iter().map(|row| Row::new(row).whole("count"));
    let sum = spreads.sum::<Checked<u64>>()?;
    holds(predicted.whole("points")? == sum || sum == 0, || "the quotients of widths do not add up".into())
}

/// Both entries vanish just above s, as far apart as told.
fn thin(row: &Row, rho: &Rational, limits: &Limits) -> Checked<()> {
    let (ratio, m, s) = (row.ratio()?, row.whole("m")?, row.float("s")?);
    check_ratio(ratio, limits)?;
    let pair = if m % 2 == 1 { [Entry::A, Entry::D] } else { [Entry::B, Entry::C] };
    let (least, most) = row.enclosure("width")?;
    // From a double below the lower edge, a few doubles and the width up.
    let exact = |s: f64| rational::from_f64_exact(s).unwrap_or_else(Rational::zero);
    let reach = (exact(s), exact(s * (1.0 + 4.0 * f64::EPSILON)) + &most);
    let mut zeros = Vec::new();
    for entry in pair {
        zeros.push(ZeroOf::new((ratio, rho), entry, reach.clone(), "s")?);
    }
    let [a, b] = &mut zeros[..] else { unreachable!("two entries") };
    let order = part(a, b);
    holds(order.is_some(), || "its edges do not part".into())?;
    // Halved until the distance is known to a thousandth, as the width is told.
    let apart = |a: &ZeroOf, b: &ZeroOf| {
        if a.hi < b.lo { (&b.lo - &a.hi, &b.hi - &a.lo) } else { (&a.lo - &b.hi, &a.hi - &b.lo) }
    };
    let (inner, outer) = loop {
        let (inner, outer) = apart(a, b);
        let exact = a.lo == a.hi && b.lo == b.hi;
        if exact || outer <= &inner * fraction(1001, 1000) {
            break (inner, outer);
        }
        a.halve();
        b.halve();
    };
    holds(least <= outer && inner <= most, || "its width is not the distance of its edges".into())
}
