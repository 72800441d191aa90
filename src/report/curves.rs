//! The (a, b) families of resonance curves as tables.

use serde_json::{Value, json};

use super::document::Document;
use super::record::Record;
use super::table::{Column, Table};
use crate::resonance::{Curve, CurvePoint};

/// A point, its curve, and the number of its piece.
type Point<'a> = (&'a Curve, usize, &'a CurvePoint);

/// The document `kickdrift/curves/1`: empty curves are left out. The caller adds the input.
pub fn document(curves: &[Curve]) -> Document {
    let curves: Vec<&Curve> = curves.iter().filter(|curve| !curve.pieces.is_empty()).collect();
    let points: Vec<Point> = curves.iter().flat_map(|curve| points(curve)).collect();
    let summary =
        format!("{} curves 1/T½ = a/h1 + b/h2 in the window, {} points", curves.len(), points.len());
    let values: Vec<Value> = curves.iter().map(|curve| value(curve)).collect();
    Document::new("curves").entry("curves", values).rows(table(&points)).summary(&[summary])
}

fn points(curve: &Curve) -> impl Iterator<Item = Point<'_>> {
    let pieces = curve.pieces.iter().enumerate();
    pieces.flat_map(move |(i, piece)| piece.iter().map(move |point| (curve, i, point)))
}

/// What is written of a point, beside the curve that it is on.
fn place<'a>(record: Record<'a, Point<'a>>) -> Record<'a, Point<'a>> {
    record
        .field(Column::math("h1", "h_1"), |(_, _, point)| point.h1.into())
        .field(Column::math("h2", "h_2"), |(_, _, point)| point.h2.into())
        .field(Column::new("theta_over_pi").titled("theta/pi", "$\\theta/\\pi$"), |(_, _, point)| {
            point.theta_over_pi.into()
        })
}

fn value(curve: &Curve) -> Value {
    let record = place(Record::new()).field(Column::new("piece"), |(_, piece, _)| (*piece as u64).into());
    let points: Vec<Value> = points(curve).map(|point| record.entries(&point)).collect();
    json!({"a": curve.a, "b": curve.b, "points": points})
}

fn table(points: &[Point]) -> Table {
    let curve = Record::new()
        .field(Column::math("a", "a"), |(curve, ..): &Point| curve.a.into())
        .field(Column::math("b", "b"), |(curve, ..)| curve.b.into());
    place(curve)
        .table("curves", "Points of the resonance curves (a, b)", points)
        .captioned("Points of the resonance curves $1/T_{1/2} = a/h_1 + b/h_2$, $\\theta = \\pi h_1/T_{1/2}$")
}
