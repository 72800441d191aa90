//! The row of a tongue.

use crate::report::decimal::{concise, outward, rounded, shortened};
use crate::report::record::Record;
use crate::report::table::{Cell, Choice, Column};
use clocks::tongue::{Bounds, Law, Request, Side, Tongue, TongueEdge, Wanted};
use number::error::Result;

/// The caption of a table of tongues.
pub const CAPTION: &str =
    "Unstable intervals (tongues) in s, the fast stiffness times the square of the fast step";

/// The caption in LaTeX.
pub const CAPTION_LATEX: &str = "Unstable intervals (tongues) $s_- < s < s_+$ of $s = h_1^2 \\Lambda_1$";

/// Digits that people need of a number that is rounded anyway.
const DIGITS: usize = 4;

/// Every column and every entry of JSON: `p, q, m, a, b, lower, upper, closed, width` and what else is
/// wanted, null where a tongue has none of it. In the `short` form only the columns that fit a line, rounded
/// numbers in a few digits.
pub fn record(request: &Request, short: bool) -> Record<'_, Tongue> {
    let record = Record::new()
        .field(Column::math("p", "p"), |tongue: &Tongue| tongue.row.ratio.p().into())
        .field(Column::math("q", "q"), |tongue| tongue.row.ratio.q().into())
        .field(Column::math("m", "m"), |tongue| tongue.row.gap.m.into())
        .field(Column::math("a", "a"), |tongue| tongue.row.family.map(|(a, _)| a).into())
        .field(Column::math("b", "b"), |tongue| tongue.row.family.map(|(_, b)| b).into());
    let record =
        Edge { end: "lower", sign: '-', find: |tongue| Some(&tongue.lower) }.of(record, request, short);
    let record =
        Edge { end: "upper", sign: '+', find: |tongue| tongue.upper.as_ref() }.of(record, request, short);
    let closed = |tongue: &Tongue| Cell::from(tongue.row.gap.closed);
    let record = if short { record } else { record.field(Column::new("closed"), closed) };
    let record = record.field(Column::new("width").enclosure(), move |tongue| match tongue.row.gap.upper {
        Some(_) if tongue.row.gap.closed && short => "closed".into(),
        Some(_) => tongue.row.gap.width.into(),
        None => Cell::Missing,
    });
    wanted(record, request, short)
}

/// The groups that have to be computed for columns of these names, by which CSV calls them.
///
/// # Errors
/// A name that no column has, whatever is computed.
pub fn needed(names: &[String], request: &Request) -> Result<Wanted> {
    let columns = |wanted: Wanted| record(&Request { wanted, ..request.clone() }, false).columns();
    Choice::new(&columns(Wanted::all()), names)?;
    let without = |wanted: Wanted| Choice::new(&columns(wanted), names).is_err();
    Ok(Wanted {
        family: true,
        exact: without(Wanted { exact: false, ..Wanted::all() }),
        growth: without(Wanted { growth: false, ..Wanted::all() }),
        predicted: without(Wanted { predicted: false, ..Wanted::all() }),
        first_order: without(Wanted { first_order: false, ..Wanted::all() }),
    })
}

/// An edge: what it is called, its sign in formulas, and where it is.
#[derive(Clone, Copy)]
struct Edge {
    end: &'static str,
    sign: char,
    find: fn(&Tongue) -> Option<&TongueEdge>,
}

impl Edge {
    fn s(self, tongue: &Tongue) -> Option<&Bounds> {
        (self.find)(tongue).map(|edge| &edge.s)
    }

    /// h1 (0) or h2 (1).
    fn step(self, tongue: &Tongue, n: usize) -> Option<&Bounds> {
        (self.find)(tongue)?.steps.as_ref().map(|steps| &steps[n])
    }

    /// `lo, hi, entry`, with digits `decimal`, with closed forms `exact, on`, with L1 `h1, h2`.
    fn of<'a>(self, record: Record<'a, Tongue>, request: &'a Request, short: bool) -> Record<'a, Tongue> {
        let Edge { end, sign, find } = self;
        let path = |key: &str| format!("{end}.{key}");
        let column = |key: &str| Column::new(&format!("{end}_{key}"));
        let title = Column::new(end).titled(&format!("{end} edge"), &format!("$s_{sign}$")).enclosure();
        let mut record = record.field(title, move |tongue| {
            let digits = short.then(|| concisely(self.s(tongue), request)).flatten();
            digits.unwrap_or_else(|| self.s(tongue).map(ends).into())
        });
        if request.digits.is_some() {
            record = record
                .json(path("decimal.lo"), move |tongue| decimal(self.s(tongue), request, 0))
                .json(path("decimal.hi"), move |tongue| decimal(self.s(tongue), request, 1));
        }
        record = record.at(path("entry"), column("entry").titled("of", "of").left().aside(), move |tongue| {
            find(tongue).map(|edge| edge.entry.name()).into()
        });
        if request.wanted.exact {
            let exact = move |tongue: &Tongue| find(tongue)?.exact.as_ref().map(Cell::exact);
            let on = move |tongue: &Tongue| Cell::from(find(tongue).and_then(|edge| Some(edge.on?.name())));
            let title = column("exact").titled("exact", "exact").left();
            record = if short {
                record.column(title, move |tongue| exact(tongue).unwrap_or_else(|| on(tongue)))
            } else {
                let exact = move |tongue: &Tongue| exact(tongue).unwrap_or(Cell::Missing);
                record.at(path("exact"), title, exact).at(path("on"), column("on").left(), on)
            };
        }
        if request.digits.is_some() && !short {
            for (n, side) in ["lo", "hi"].into_iter().enumerate() {
                let title = column(&format!("decimal_{side}")).titled(&format!("{end} {side}"), side);
                record = record.column(title, move |tongue| decimal(self.s(tongue), request, n));
            }
        }
        if request.lambda1.is_some() {
            for (n, h) in ["h1", "h2"].into_iter().enumerate() {
                let formula = format!("$h_{}^{sign}$", n + 1);
                let title = column(h).titled(&format!("{h} {end}"), &formula).enclosure();
                // h2 is p/q of h1.
                let title = if n == 1 { title.aside() } else { title };
                record = record.at(path(h), title, move |tongue| {
                    let digits = short.then(|| concisely(self.step(tongue, n), request)).flatten();
                    digits.unwrap_or_else(|| self.step(tongue, n).map(ends).into())
                });
                if request.digits.is_some() {
                    record = record
                        .json(path(&format!("{h}.decimal.lo")), move |tongue| {
                            decimal(self.step(tongue, n), request, 0)
                        })
                        .json(path(&format!("{h}.decimal.hi")), move |tongue| {
                            decimal(self.step(tongue, n), request, 1)
                        });
                }
            }
        }
        record
    }
}

fn ends(quantity: &Bounds) -> (f64, f64) {
    (quantity.lo, quantity.hi)
}

/// A place to the digits that are asked for, its error in the last of them.
fn concisely(quantity: Option<&Bounds>, request: &Request) -> Option<Cell> {
    let (x, digits) = quantity.and_then(|quantity| quantity.precise.as_ref()).zip(request.digits)?;
    Some(Cell::Decimal(concise(&x.lo, &x.hi, digits).to_string()))
}

/// The lower (0) or the upper (1) end in writing, to the digits that are asked for.
fn decimal(quantity: Option<&Bounds>, request: &Request, end: usize) -> Cell {
    let precise = quantity.and_then(|quantity| quantity.precise.as_ref()).zip(request.digits);
    precise.map_or(Cell::Missing, |(x, digits)| Cell::exact(&outward(&x.lo, &x.hi, digits)[end]))
}

/// Growth, predicted point and first-order law.
fn wanted<'a>(mut record: Record<'a, Tongue>, request: &'a Request, short: bool) -> Record<'a, Tongue> {
    let float = move |x: Option<f64>| Cell::from(x.map(|x| if short { rounded(x, DIGITS) } else { x }));
    let titled = |key: &str, title: &str| {
        Column::new(key).titled(title, &title.replace("√lambda1", "$\\sqrt{\\Lambda_1}$"))
    };
    let has_steps = request.lambda1.is_some();
    if request.wanted.growth {
        let s = move |tongue: &Tongue| float(tongue.row.peak.map(|peak| peak.s));
        let ln_multiplier = move |tongue: &Tongue| float(tongue.row.peak.map(|peak| peak.ln_multiplier));
        let rate = move |tongue: &Tongue| float(tongue.row.peak.map(|peak| peak.rate));
        let tenfold = move |tongue: &Tongue| float(tongue.row.peak.map(|peak| peak.slow_steps_to_tenfold));
        if !short {
            record = record.at("growth.s", titled("growth_s", "fastest at s"), s).at(
                "growth.ln_multiplier",
                titled("ln_multiplier", "ln multiplier"),
                ln_multiplier,
            );
        }
        if !(short && has_steps) {
            record = record.at("growth.rate", titled("rate", "growth/√lambda1"), rate);
        }
        record = record.json("growth.steps_until_tenfold", tenfold);
        if has_steps {
            let title = titled("growth_rate", "growth rate");
            record = record.at("growth.growth_rate", title, move |tongue| float(tongue.growth_rate));
        }
        record = record.column(titled("steps_until_tenfold", "tenfold in"), tenfold);
    }
    if request.wanted.predicted {
        let point = |tongue: &Tongue| tongue.row.predicted.as_ref().map(|point| point.s);
        let place = |tongue: &Tongue| Cell::from(tongue.row.predicted.as_ref().map(|point| side(point.side)));
        let position =
            |tongue: &Tongue| Cell::from(tongue.row.predicted.as_ref().map(|point| point.side.name()));
        let distance = |tongue: &Tongue| tongue.row.predicted.as_ref().map(|point| point.distance);
        let side = titled("side", "predicted point");
        record = if short {
            record.column(side, place)
        } else {
            record
                .at("predicted.s", titled("predicted_s", "predicted s"), move |tongue| float(point(tongue)))
                .at("predicted.side", side, place)
                .at("predicted.position", titled("position", "position"), position)
                .at("predicted.distance", titled("distance", "distance"), move |tongue| {
                    float(distance(tongue))
                })
        };
    }
    if request.wanted.first_order {
        fn law(tongue: &Tongue) -> Option<&Law> {
            tongue.row.first_order.as_ref()
        }
        let width = move |tongue: &Tongue| float(law(tongue).map(|law| law.width));
        if !short {
            let its_error = |key| titled(key, "its error").enclosure();
            record = record
                .at(
                    "first_order.centre",
                    titled("first_order_centre", "centre to first order"),
                    move |tongue| float(law(tongue).map(|law| law.centre)),
                )
                .json("first_order.width", width)
                .json("first_order.ln_multiplier", move |tongue| {
                    float(law(tongue).map(|law| law.ln_multiplier))
                })
                .at("first_order.centre_error", its_error("centre_error"), move |tongue| {
                    law(tongue).map(|law| law.centre_error).into()
                })
                .column(titled("first_order_width", "width to first order"), width)
                .at("first_order.width_error", its_error("width_error"), move |tongue| {
                    law(tongue).map(|law| law.width_error).into()
                });
        }
        let title = titled("width_ratio", "width/first order").enclosure();
        record = record.at("first_order.width_ratio", title, move |tongue| {
            match law(tongue).map(|law| law.width_ratio) {
                Some((lo, hi)) if short => Cell::Decimal(shortened(lo, hi, DIGITS as u32).to_string()),
                ends => ends.into(),
            }
        });
    }
    record
}

/// Which of three places: the words of documents.
pub fn side(side: Side) -> &'static str {
    match side {
        Side::Inside => "inside",
        Side::OnLower | Side::OnUpper => "on the edge",
        Side::Below | Side::Above => "outside",
    }
}
