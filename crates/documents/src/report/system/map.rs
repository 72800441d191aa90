//! A system's verdict over one or two of its numbers: counts and rows.

use super::words::rate_per;
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{
    COUNT, ENCLOSED_OR_NULL, FLAG, KIND_IF_DECIDED, Keys, POSITIVE, RATIONAL, Schema, Shape,
};
use crate::report::table::{Cell, Column};
use clocks::verdict::Kind;
use num_traits::Zero;
use number::{Rational, from_f64_exact};
use systems::scan::Point;

/// The points of a scan, row by row of y.
#[derive(Clone, Debug)]
pub struct SystemMap {
    /// The number varied along x and, if there are two, along y: in words, with the power of time in its
    /// unit.
    pub numbers: Vec<(String, i8)>,
    pub xs: Vec<Rational>,
    pub ys: Vec<Rational>,
    pub points: Vec<Point>,
    /// The name of the unit of time, where the file gives one.
    pub time_unit: Option<String>,
}

/// Digits of a growth rate: eigenvalues in doubles agree in them on every machine.
const DIGITS: u32 = 6;

/// An enclosure of a growth rate in so many digits.
fn outward(rate: Option<(f64, f64)>) -> Option<(f64, f64)> {
    let (lo, hi) = rate.filter(|rate| rate.0 > 0.0 || rate.1.is_finite())?;
    let end = |x: f64, n: usize| match from_f64_exact(x).filter(|x| !x.is_zero()) {
        // The double nearest to a decimal number is on the same side of every double.
        Some(x) => decimal::outward(&x, &x, DIGITS)[n].parse().unwrap_or(0.0),
        None => 0.0,
    };
    Some((end(lo, 0), if hi.is_finite() { end(hi, 1) } else { hi }))
}

impl SystemMap {
    pub(super) fn count(&self, kind: Kind) -> usize {
        self.points.iter().filter(|point| point.kind == Some(kind)).count()
    }

    /// The document `kickdrift/system-map/1`; the caller adds the input.
    pub fn document(&self) -> Document {
        let unproven = self.unproven();
        let [hyperbolic, parabolic, coexistence] =
            [Kind::Hyperbolic, Kind::Parabolic, Kind::Coexistence].map(|k| self.count(k));
        let mut lines = vec![
            format!("{} of {} points unstable", hyperbolic + parabolic, self.points.len()),
            format!(
                "  hyperbolic {hyperbolic}, parabolic {parabolic}, coexistence {coexistence}; not decided {unproven}"
            ),
        ];
        if let Some(Point { at: (x, y), growth_rate, .. }) = self.fastest() {
            let places =
                self.numbers.iter().zip([x, y]).map(|((name, _), value)| format!("{name} = {value}"));
            let places = places.collect::<Vec<_>>().join(", ");
            let per = self.time_unit.as_deref().unwrap_or("unit time");
            lines.push(format!("  fastest growth {} at {places}", rate_per(*growth_rate, per)));
        }
        let names = self.names();
        let caption = format!("Verdicts over the {}", names.join(" and the "));
        let rows = record(&names, true).table("verdicts", &caption, &self.points);
        head().document(Document::new("system-map"), self).rows(rows).summary(&lines)
    }

    /// Its schema.
    pub fn schema() -> Schema {
        let verdicts = Shape::List(&Shape::Object(|| keys(true)));
        let keys = head().keys().key("verdicts", verdicts, "");
        Schema::new("A system's verdict over two of its numbers", keys)
            .about("Every pair of values of two numbers of a system file, row by row of y.")
    }

    fn names(&self) -> Vec<&str> {
        self.numbers.iter().map(|(name, _)| &**name).collect()
    }

    fn unproven(&self) -> usize {
        self.points.iter().filter(|point| point.kind.is_none()).count()
    }

    fn fastest(&self) -> Option<&Point> {
        let fastest = self.points.iter().max_by(|a, b| a.rounded_rate().total_cmp(&b.rounded_rate()));
        fastest.filter(|point| point.rounded_rate() > 0.0)
    }
}

/// All but the points.
fn head() -> Record<'static, SystemMap> {
    let stable = |map: &SystemMap| map.count(Kind::Elliptic) + map.count(Kind::Coexistence);
    Record::new()
        .json("points", |map: &SystemMap| map.points.len().into())
        .says(POSITIVE, "")
        .json("stable", move |map| stable(map).into())
        .says(COUNT, "Elliptic or coexistence.")
        .json("hyperbolic", |map| map.count(Kind::Hyperbolic).into())
        .says(COUNT, "")
        .json("parabolic", |map| map.count(Kind::Parabolic).into())
        .says(COUNT, "")
        .json("coexistence", |map| map.count(Kind::Coexistence).into())
        .says(COUNT, "")
        .json("unproven", |map| map.unproven().into())
        .says(COUNT, "Points that are not decided.")
        .value("fastest", |map| map.fastest().map(|point| record(&map.names(), false).entries(point)).into())
        .says(Shape::OrNull(&Shape::Object(|| keys(false))), "null where no point is proven to grow.")
}

/// The record of a point at values of these numbers, with its kind or without.
fn record(names: &[&str], has_kind: bool) -> Record<'static, Point> {
    const SAYS: &str = "An exact rational.";
    let x = Column::new("x").in_words(names[0]);
    let mut record = Record::new().field(x, |point: &Point| Cell::exact(&point.at.0)).says(RATIONAL, SAYS);
    if let Some(name) = names.get(1) {
        let y = Column::new("y").in_words(name);
        record = record.field(y, |point| Cell::exact(&point.at.1)).says(RATIONAL, SAYS);
    }
    if has_kind {
        record = record
            .field(Column::new("kind").left(), |point| point.kind_name().into())
            .says(KIND_IF_DECIDED, "")
            .field(Column::new("proven"), |point| point.kind.is_some().into())
            .says(FLAG, "");
    }
    let column = Column::new("growth_rate").titled("growth rate", "growth rate").enclosure();
    record.field(column, |point| outward(point.growth_rate).into()).says(ENCLOSED_OR_NULL, "Per unit time, in six digits rounded outward, 0 where nothing grows exponentially; null where no bound is proven.")
}

/// The keys of a point, of one number or of two.
fn keys(has_kind: bool) -> Keys {
    let names = ["x", "y"];
    record(&names, has_kind).keys().or_only(&record(&names[..1], has_kind).keys())
}
