//! A system's verdict over two of its numbers: counts and rows.

use serde_json::json;

use crate::number::Rational;
use crate::report::decimal::rounded;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::table::{Cell, Column, Table};
use crate::system::scan::Point;
use crate::verdict::Kind;

/// The points of a scan, row by row of y.
#[derive(Clone, Debug)]
pub struct SystemMap {
    /// What is varied along x and y.
    pub names: [String; 2],
    pub xs: Vec<Rational>,
    pub ys: Vec<Rational>,
    pub points: Vec<Point>,
}

/// Digits of a growth rate: eigenvalues in doubles agree in them on every machine.
const DIGITS: usize = 6;

impl SystemMap {
    pub(super) fn count(&self, kind: Kind) -> usize {
        self.points.iter().filter(|point| point.kind == kind).count()
    }

    /// The document `kickdrift/system-map/1`; the caller adds the input.
    pub fn document(&self) -> Document {
        let unproven = self.points.iter().filter(|point| !point.is_proof).count();
        let [hyperbolic, parabolic, coexistence] =
            [Kind::Hyperbolic, Kind::Parabolic, Kind::Coexistence].map(|k| self.count(k));
        let fastest = self.points.iter().max_by(|a, b| a.growth_rate.total_cmp(&b.growth_rate));
        let fastest = fastest.filter(|point| point.growth_rate > 0.0);
        let mut lines = vec![
            format!("{} of {} points unstable", hyperbolic + parabolic, self.points.len()),
            format!(
                "  hyperbolic {hyperbolic}, parabolic {parabolic}, coexistence {coexistence}; not proven {unproven}"
            ),
        ];
        if let Some(Point { at: (x, y), growth_rate, .. }) = fastest {
            let [a, b] = &self.names;
            lines.push(format!("  fastest growth {growth_rate:.5e} per unit time at {a} = {x}, {b} = {y}"));
        }
        let fastest = fastest.map(|point| {
            let (x, y) = (point.at.0.to_string(), point.at.1.to_string());
            json!({"x": x, "y": y, "growth_rate": rounded(point.growth_rate, DIGITS)})
        });
        Document::new("system-map")
            .entry("points", self.points.len())
            .entry("stable", self.points.len() - hyperbolic - parabolic)
            .entry("hyperbolic", hyperbolic)
            .entry("parabolic", parabolic)
            .entry("coexistence", coexistence)
            .entry("unproven", unproven)
            .entry("fastest", fastest)
            .rows(self.table())
            .summary(&lines)
    }

    fn table(&self) -> Table {
        let [x, y] = &self.names;
        Record::new()
            .field(Column::new("x").in_words(x), |of: &Point| Cell::exact(&of.at.0))
            .field(Column::new("y").in_words(y), |of| Cell::exact(&of.at.1))
            .field(Column::new("kind").left(), |of| of.kind.name().into())
            .field(Column::new("proven"), |of| of.is_proof.into())
            .field(Column::new("growth_rate").titled("growth rate", "growth rate"), |of| {
                rounded(of.growth_rate, DIGITS).into()
            })
            .table("verdicts", "Verdicts over two numbers of the system", &self.points)
    }
}
