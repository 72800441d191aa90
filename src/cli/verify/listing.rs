//! Tongues as a list: none left out, and counted as they are.

use num_traits::Zero;
use serde_json::Value;

use super::read::{Row, whole};
use crate::cli::ratios::Ratios;
use crate::cli::tongues::MOST_SUM;
use crate::error::Result;
use crate::number::parse::parse_ratio;
use crate::number::{Ratio, Rational};

/// The row (0: none), its name, what is wrong.
type Failure = (u64, String, String);

/// The counts behind the rows are those of the rows.
pub fn counts(all: &Row, rows: &[Value]) -> Result<Option<Failure>> {
    let rows: Vec<Row> = rows.iter().map(Row::new).collect();
    let count = rows.len() as u64;
    let closed = rows.iter().filter(|row| row.flag("closed").ok() == Some(true)).count() as u64;
    let mut expected = vec![(*all, "count", count), (*all, "open", count - closed), (*all, "closed", closed)];
    let sides: Vec<&str> = rows.iter().filter_map(|row| row.get("predicted")?.text("side").ok()).collect();
    if !sides.is_empty() {
        let points = whole(all.object("predicted_points"))?;
        for (key, side) in [("inside", "inside"), ("on_edge", "on the edge"), ("outside", "outside")] {
            expected.push((points, key, sides.iter().filter(|told| **told == side).count() as u64));
        }
    }
    for (object, key, truth) in expected {
        let told = whole(object.whole(key))?;
        if told != truth {
            return Ok(Some((0, "the counts".into(), format!("{key} is {truth}, not {told}"))));
        }
    }
    Ok(None)
}

/// Without a selection, the labels 1, 2, ... of every ratio are there, in order: as many edges as an entry has zeros,
/// so each enclosure holds one.
pub fn complete(input: &Row, rows: &[Value], rho: &Rational) -> Result<Option<Failure>> {
    if ["m", "a", "b", "h1_range", "h2_range"].iter().any(|key| input.get(key).is_some()) {
        return Ok(None);
    }
    let asked = match input.get("ratio") {
        Some(_) => parse_ratio("ratio", whole(input.text("ratio"))?).map(Ratios::One)?,
        None => Ratios::UpTo(whole(input.rational("max_sum"))?.to_integer().try_into().unwrap_or(0)),
    };
    let list = asked.within(MOST_SUM)?.list();
    let last = |ratio: Ratio| if rho.is_zero() { ratio.p() } else { ratio.kicks() - 1 };
    let expected = list.into_iter().flat_map(|ratio| (1..=last(ratio)).map(move |m| (ratio, m)));
    let mut rows = rows.iter().map(Row::new).enumerate();
    for (ratio, m) in expected {
        let (p, q) = ratio.terms();
        let place = format!("p = {p}, q = {q}, m = {m}");
        let Some((i, row)) = rows.next() else {
            return Ok(Some((0, place, "is missing at the end".into())));
        };
        let labels = (row.whole("p").ok(), row.whole("q").ok(), row.whole("m").ok());
        if labels != (Some(p), Some(q), Some(m)) {
            return Ok(Some((
                i as u64 + 1,
                row.place(),
                format!("is not the tongue {place} that belongs here"),
            )));
        }
    }
    Ok(rows.next().map(|(i, row)| (i as u64 + 1, row.place(), "is one tongue too many".into())))
}
