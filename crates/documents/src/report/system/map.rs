//! A system's verdict over one or two of its numbers: counts and rows.

use num_traits::Zero;
use serde_json::json;

use super::words::rate_per;
use crate::report::decimal;
use crate::report::document::{Document, enclosure};
use crate::report::record::Record;
use crate::report::table::{Cell, Column, Table};
use clocks::verdict::Kind;
use number::Rational;
use number::rational::from_f64_exact;
use systems::scan::Point;

/// The points of a scan, row by row of y.
#[derive(Clone, Debug)]
pub struct SystemMap {
    /// The number varied along x and, if there are two, along y: in words, with the power of time in its unit.
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
        let unproven = self.points.iter().filter(|point| point.kind.is_none()).count();
        let [hyperbolic, parabolic, coexistence] =
            [Kind::Hyperbolic, Kind::Parabolic, Kind::Coexistence].map(|k| self.count(k));
        let fastest = self.points.iter().max_by(|a, b| a.rounded_rate().total_cmp(&b.rounded_rate()));
        let fastest = fastest.filter(|point| point.rounded_rate() > 0.0);
        let mut lines = vec![
            format!("{} of {} points unstable", hyperbolic + parabolic, self.points.len()),
            format!(
                "  hyperbolic {hyperbolic}, parabolic {parabolic}, coexistence {coexistence}; not decided {unproven}"
            ),
        ];
        if let Some(Point { at: (x, y), growth_rate, .. }) = fastest {
            let places =
                self.numbers.iter().zip([x, y]).map(|((name, _), value)| format!("{name} = {value}"));
            let places = places.collect::<Vec<_>>().join(", ");
            let per = self.time_unit.as_deref().unwrap_or("unit time");
            lines.push(format!("  fastest growth {} at {places}", rate_per(*growth_rate, per)));
        }
        let fastest = fastest.map(|point| {
            let (x, y) = (point.at.0.to_string(), point.at.1.to_string());
            let growth_rate = outward(point.growth_rate).map(enclosure);
            match self.numbers.len() {
                1 => json!({"x": x, "growth_rate": growth_rate}),
                _ => json!({"x": x, "y": y, "growth_rate": growth_rate}),
            }
        });
        Document::new("system-map")
            .entry("points", self.points.len())
            .entry("stable", self.points.len() - hyperbolic - parabolic - unproven)
            .entry("hyperbolic", hyperbolic)
            .entry("parabolic", parabolic)
            .entry("coexistence", coexistence)
            .entry("unproven", unproven)
            .entry("fastest", fastest)
            .rows(self.table())
            .summary(&lines)
    }

    fn table(&self) -> Table {
        let x = Column::new("x").in_words(&self.numbers[0].0);
        let record = Record::new().field(x, |point: &Point| Cell::exact(&point.at.0));
        let record = match self.numbers.get(1) {
            Some((name, _)) => {
                record.field(Column::new("y").in_words(name), |point| Cell::exact(&point.at.1))
            }
            None => record,
        };
        let names: Vec<&str> = self.numbers.iter().map(|(name, _)| &**name).collect();
        let caption = format!("Verdicts over the {}", names.join(" and the "));
        record
            .field(Column::new("kind").left(), |point| point.kind_name().into())
            .field(Column::new("proven"), |point| point.kind.is_some().into())
            .field(Column::new("growth_rate").titled("growth rate", "growth rate").enclosure(), |point| {
                outward(point.growth_rate).into()
            })
            .table("verdicts", &caption, &self.points)
    }
}
