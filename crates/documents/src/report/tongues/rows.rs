//! The row of a tongue.

use crate::report::decimal::{concise, outward, rounded, shortened};
use crate::report::record::Record;
use crate::report::shape::{
    DECIMAL, ENCLOSURE, ENCLOSURE_FROM_0, FLAG, GROUP, GROUP_OR_NULL, INTEGER, Keys, POSITIVE,
    POSITIVE_ENCLOSURE, RATIONAL_OR_NULL, ROUNDED, Shape,
};
use crate::report::table::{Cell, Choice, Column};
use clocks::tongue::{Bounds, Law, Request, Side, Tongue, TongueEdge, Wanted};
use number::{Laurent, Result};

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
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .field(Column::math("q", "q"), |tongue| tongue.row.ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .field(Column::math("m", "m"), |tongue| tongue.row.gap.m.into())
        .says(POSITIVE, "The label: half turns of the growing solution in a period.")
        .field(Column::math("a", "a"), |tongue| tongue.row.family.map(|(a, _)| a).into())
        .says(Shape::OrNull(&INTEGER), "The dominant family: m = a p + b q; null beyond 31 bits.")
        .field(Column::math("b", "b"), |tongue| tongue.row.family.map(|(_, b)| b).into())
        .says(Shape::OrNull(&INTEGER), "b of the dominant family.");
    let record = Edge {
        end: "lower",
        sign: '-',
        find: |tongue| Some(&tongue.lower),
        shape: POSITIVE_ENCLOSURE,
        says: EDGE,
    }
    .of(record, request, short);
    fn upper(tongue: &Tongue) -> Option<&TongueEdge> {
        tongue.upper.as_ref()
    }
    let record =
        Edge { end: "upper", sign: '+', find: upper, shape: UPPER, says: LAST }.of(record, request, short);
    let closed = |tongue: &Tongue| Cell::from(tongue.row.gap.closed);
    let record = if short {
        record
    } else {
        record.field(Column::new("closed"), closed).says(FLAG, "Whether both edges are one point, proven.")
    };
    let record = record
        .field(Column::new("width").enclosure(), move |tongue| match tongue.row.gap.upper {
            Some(_) if tongue.row.gap.closed && short => "closed".into(),
            Some(_) => tongue.row.gap.width.into(),
            None => Cell::Missing,
        })
        .says(Shape::OrNull(&ENCLOSURE_FROM_0), "The distance of the edges in s; null for the last tongue.");
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
    shape: Shape,
    says: &'static str,
}

const EDGE: &str = "An edge in s: lo and hi hold exactly one zero of the entry.";
const LAST: &str = "As lower; null for the last tongue, m = p + q - 1, which has no end.";
const UPPER: Shape = Shape::Plain(
    r#"{
        "type": ["object", "null"],
        "required": ["lo", "hi"],
        "properties": {
            "lo": {"type": "number", "exclusiveMinimum": 0, "description": "A double not above the edge."},
            "hi": {"type": "number", "exclusiveMinimum": 0, "description": "A double not below the edge."}
        }
    }"#,
);
const ENTRY: Shape = Shape::OneOf(&["A", "B", "C", "D"]);
const ON: Shape = Shape::Plain(r#"{"enum": ["p theta = m pi", "q theta' = m pi", null]}"#);
const SIDE: Shape = Shape::OneOf(&["inside", "on the edge", "outside"]);
const POSITION: Shape = Shape::OneOf(&["below", "on the lower edge", "inside", "on the upper edge", "above"]);

/// The keys of a tongue; those that are not asked for are not there.
pub fn keys() -> Keys {
    let all = Request { wanted: Wanted::all(), lambda1: Some(Laurent::from_integer(1)), digits: Some(1) };
    let with = |wanted| Request { wanted, ..all.clone() };
    let less = [
        Request { digits: None, ..all.clone() },
        Request { lambda1: None, ..all.clone() },
        with(Wanted { exact: false, ..Wanted::all() }),
        with(Wanted { growth: false, ..Wanted::all() }),
        with(Wanted { predicted: false, ..Wanted::all() }),
        with(Wanted { first_order: false, ..Wanted::all() }),
    ];
    let keys =
        less.iter().fold(record(&all, false).keys(), |keys, less| keys.or_only(&record(less, false).keys()));
    let decimals = ["lower", "upper"]
        .into_iter()
        .flat_map(|end| ["", ".h1", ".h2"].map(|step| format!("{end}{step}.decimal")));
    let says = "Decimals around the value, to the digits asked for.";
    let keys = decimals.fold(keys, |keys, path| keys.key(path, GROUP, says));
    keys.key(
        "growth",
        GROUP_OR_NULL,
        "The fastest exponential growth inside, rounded; null where the tongue is closed or has no end.",
    )
    .key(
        "predicted",
        GROUP_OR_NULL,
        "The point p theta = m pi (eq. 9) against the tongue; null for m >= p, beyond the fast clock's Verlet limit.",
    )
    .key(
        "first_order",
        GROUP_OR_NULL,
        "The law of first order in lambda2, the nearest doubles of it, and the tongue minus the law, enclosed; null for m >= p and for rho = 0.",
    )
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
        let Edge { end, sign, find, .. } = self;
        let path = |key: &str| format!("{end}.{key}");
        let column = |key: &str| Column::new(&format!("{end}_{key}"));
        let title = Column::new(end).titled(&format!("{end} edge"), &format!("$s_{sign}$")).enclosure();
        let mut record = record
            .field(title, move |tongue| {
                let digits = short.then(|| concisely(self.s(tongue), request)).flatten();
                digits.unwrap_or_else(|| self.s(tongue).map(ends).into())
            })
            .says(self.shape, self.says);
        if request.digits.is_some() {
            record = record
                .json(&path("decimal.lo"), move |tongue| decimal(self.s(tongue), request, 0))
                .says(DECIMAL, "Not above the edge.")
                .json(&path("decimal.hi"), move |tongue| decimal(self.s(tongue), request, 1))
                .says(DECIMAL, "Not below the edge.");
        }
        record = record
            .at(&path("entry"), column("entry").titled("of", "of").left().aside(), move |tongue| {
                find(tongue).map(|edge| edge.entry.name()).into()
            })
            .says(ENTRY, "The entry of the half period that vanishes there.");
        if request.wanted.exact {
            let exact = move |tongue: &Tongue| find(tongue)?.exact.as_ref().map(Cell::exact);
            let on = move |tongue: &Tongue| Cell::from(find(tongue).and_then(|edge| Some(edge.on?.name())));
            let title = column("exact").titled("exact", "exact").left();
            record = if short {
                record.column(title, move |tongue| exact(tongue).unwrap_or_else(|| on(tongue)))
            } else {
                let exact = move |tongue: &Tongue| exact(tongue).unwrap_or(Cell::Missing);
                record
                    .at(&path("exact"), title, exact)
                    .says(RATIONAL_OR_NULL, "The edge, where it is rational.")
                    .at(&path("on"), column("on").left(), on)
                    .says(
                        ON,
                        "The resonance of the fast or the slow clock alone on which the edge sits exactly.",
                    )
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
                record = record
                    .at(&path(h), title, move |tongue| {
                        let digits = short.then(|| concisely(self.step(tongue, n), request)).flatten();
                        digits.unwrap_or_else(|| self.step(tongue, n).map(ends).into())
                    })
                    .says(ENCLOSURE_FROM_0, format!("The edge in {h}, h2 = h1 p/q; only with lambda1."));
                if request.digits.is_some() {
                    record = record
                        .json(&path(&format!("{h}.decimal.lo")), move |tongue| {
                            decimal(self.step(tongue, n), request, 0)
                        })
                        .says(DECIMAL, "Not above it.")
                        .json(&path(&format!("{h}.decimal.hi")), move |tongue| {
                            decimal(self.step(tongue, n), request, 1)
                        })
                        .says(DECIMAL, "Not below it.");
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
            record = record
                .at("growth.s", titled("growth_s", "fastest at s"), s)
                .says(ROUNDED, "Where: a double, nine digits of it certain.")
                .at("growth.ln_multiplier", titled("ln_multiplier", "ln multiplier"), ln_multiplier)
                .says(ROUNDED, "Growth of ln amplitude in a period there, as a double.");
        }
        if !(short && has_steps) {
            record = record.at("growth.rate", titled("rate", "growth/√lambda1"), rate).says(
                ROUNDED,
                "The same per unit time, in units of the square root of lambda1, as a double.",
            );
        }
        record = record
            .json("growth.steps_until_tenfold", tenfold)
            .says(ROUNDED, "Slow steps until the amplitude is tenfold, as a double.");
        if has_steps {
            let title = titled("growth_rate", "growth rate");
            record = record
                .at("growth.growth_rate", title, move |tongue| float(tongue.growth_rate))
                .says(ROUNDED, "Per unit time, as a double; only with lambda1.");
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
        .says(ROUNDED, "The double nearest to 4 sin^2(m pi/(2 p)).")
                .at("predicted.side", side, place)
        .says(SIDE, "Decided, not estimated.")
                .at("predicted.position", titled("position", "position"), position)
        .says(POSITION, "The same, and which edge.")
                .at("predicted.distance", titled("distance", "distance"), move |tongue| {
                    float(distance(tongue))
                })
        .says(ROUNDED, "The distance to the tongue in s as a double, rounded: positive outside, minus the distance to the nearer edge inside, 0 on an edge.")
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
                .says(ROUNDED, "The double nearest to the law's middle.")
                .json("first_order.width", width)
                .says(ROUNDED, "The double nearest to the law's width.")
                .json("first_order.ln_multiplier", move |tongue| {
                    float(law(tongue).map(|law| law.ln_multiplier))
                })
                .says(ROUNDED, "The double nearest to the law's growth in a period, in the middle.")
                .at("first_order.centre_error", its_error("centre_error"), move |tongue| {
                    law(tongue).map(|law| law.centre_error).into()
                })
                .says(ENCLOSURE, "The tongue's middle minus the law's.")
                .column(titled("first_order_width", "width to first order"), width)
                .at("first_order.width_error", its_error("width_error"), move |tongue| {
                    law(tongue).map(|law| law.width_error).into()
                })
                .says(ENCLOSURE, "The tongue's width minus the law's.");
        }
        let title = titled("width_ratio", "width/first order").enclosure();
        record = record
            .at("first_order.width_ratio", title, move |tongue| {
                match law(tongue).map(|law| law.width_ratio) {
                    Some((lo, hi)) if short => Cell::Decimal(shortened(lo, hi, DIGITS as u32).to_string()),
                    ends => ends.into(),
                }
            })
            .says(ENCLOSURE_FROM_0, "The tongue's width over the law's.");
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
