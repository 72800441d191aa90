//! Closed tongues as a document: each a box s × ρ that holds exactly one of them.

use super::decimal::outward;
use super::document::Document;
use super::record::Record;
use super::table::{Cell, Column};
use crate::number::Rational;
use crate::tongue::{Closing, Enclosure, Found};

/// Significant digits unless others are asked for: the boxes are known to 2^-100.
pub const DIGITS: u32 = 25;

const CAPTION: &str =
    "Closed tongues, where $Q = \\pm I$, in $s = h_1^2 \\Lambda_1$ and $\\rho = \\Lambda_2/\\Lambda_1$";

/// The document `kickdrift/closings/1`. The caller adds the input; `what` says in words what was searched.
pub fn document(found: &[Found], digits: u32, what: &str) -> Document {
    let closings = || found.iter().flat_map(|of| &of.closings);
    let ratios = Record::new()
        .json("p", |of: &Found| of.ratio.p().into())
        .json("q", |of| of.ratio.q().into())
        .json("complete", |of| of.complete.into());
    let table = |short| {
        let record = record(digits, short);
        record.table("closings", "Closed tongues: Q = I or -I", closings()).captioned(CAPTION)
    };
    Document::new("closings")
        .entry("closings", record(digits, false).all(closings()))
        .entry("ratios", ratios.all(found))
        .long_rows(table(false))
        .for_people(table(true))
        .summary(&lines(found, what))
}

/// s or ρ of a closing: its enclosure, and its value where that is rational.
type Side = fn(&Closing) -> (&Enclosure, Option<&Rational>);

/// What is written of a closing; in the short form s and ρ are one column each, exact where they are rational.
fn record(digits: u32, short: bool) -> Record<'static, Closing> {
    let mut record = Record::new()
        .field(Column::math("p", "p"), |of: &Closing| of.ratio.p().into())
        .field(Column::math("q", "q"), |of| of.ratio.q().into())
        .field(Column::math("m", "m"), |of| of.m.into());
    let sides: [(&str, &str, Side); 2] = [
        ("s", "s", |of| (&of.s, of.exact.as_ref().map(|(s, _)| s))),
        ("rho", "\\rho", |of| (&of.rho, of.exact.as_ref().map(|(_, rho)| rho))),
    ];
    for (key, formula, side) in sides {
        let column = Column::math(key, formula).enclosure();
        let exact = move |of: &Closing| side(of).1.map(Cell::exact).unwrap_or(Cell::Missing);
        let enclosed = move |of: &Closing| Cell::from(side(of).0.to_f64());
        if short {
            record = record.field(column, move |of| match exact(of) {
                Cell::Missing => enclosed(of),
                exact => exact,
            });
            continue;
        }
        let ends = move |of: &Closing| match side(of) {
            (_, Some(x)) => outward(x, x, digits),
            (x, None) => outward(&x.lo, &x.hi, digits),
        };
        let titled = |part: &str, title: &str| Column::new(&format!("{key}_{part}")).titled(title, title);
        record = record
            .field(column, enclosed)
            .at(format!("{key}.exact"), titled("exact", "exact"), exact)
            .at(format!("{key}.decimal.lo"), titled("decimal_lo", "lo"), move |of| Cell::exact(&ends(of)[0]))
            .at(format!("{key}.decimal.hi"), titled("decimal_hi", "hi"), move |of| Cell::exact(&ends(of)[1]));
    }
    record.field(Column::new("below_verlet").titled("s < 4", "$s < 4$"), |of| of.below_verlet.into())
}

fn lines(found: &[Found], what: &str) -> Vec<String> {
    let closings = || found.iter().flat_map(|of| &of.closings);
    let count = closings().count();
    let exact = closings().filter(|closing| closing.exact.is_some()).count();
    let below = closings().filter(|closing| closing.below_verlet).count();
    let complete = found.iter().filter(|of| of.complete).count();
    let plural = if count == 1 { "" } else { "s" };
    vec![
        format!("{count} closed tongue{plural} of {what}"),
        format!("  rational     {exact}: s and rho known exactly"),
        format!("  below s = 4  {below}: the fast clock alone is stable there"),
        format!(
            "  complete     {complete} of {} ratios: elimination proves that there are no others",
            found.len()
        ),
    ]
}
