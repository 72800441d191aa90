//! The (a, b) families of resonance curves as tables.

use serde_json::Value;

use super::document::Document;
use super::table::{Cell, Column, Table};
use crate::resonance::{Curve, CurvePoint};

/// The document `kickdrift/curves/1`: empty curves are left out. The caller adds the input.
pub fn document(curves: &[Curve]) -> Document {
    let curves: Vec<&Curve> = curves.iter().filter(|curve| !curve.pieces.is_empty()).collect();
    let points: usize = curves.iter().flat_map(|curve| &curve.pieces).map(Vec::len).sum();
    let rows = table(&curves);
    let summary = format!("{} curves 1/T½ = a/h1 + b/h2 in the window, {points} points", curves.len());
    let values: Vec<Value> = curves.iter().map(|curve| value(curve)).collect();
    Document::new("curves").entry("curves", values).rows(rows).summary(&[summary])
}

fn value(curve: &Curve) -> Value {
    let point = |piece: usize, p: &CurvePoint| serde_json::json!({"h1": p.h1, "h2": p.h2, "theta_over_pi": p.theta_over_pi, "piece": piece});
    let points: Vec<Value> = curve
        .pieces
        .iter()
        .enumerate()
        .flat_map(|(i, piece)| piece.iter().map(move |p| point(i, p)))
        .collect();
    serde_json::json!({"a": curve.a, "b": curve.b, "points": points})
}

fn table(curves: &[&Curve]) -> Table {
    let columns = vec![
        Column::new("a").titled("a", "$a$"),
        Column::new("b").titled("b", "$b$"),
        Column::new("h1").titled("h1", "$h_1$"),
        Column::new("h2").titled("h2", "$h_2$"),
        Column::new("theta_over_pi").titled("theta/pi", "$\\theta/\\pi$"),
    ];
    let caption = "Points of the resonance curves (a, b)";
    let mut table = Table::new("curves", caption, columns);
    for curve in curves {
        for p in curve.pieces.iter().flatten() {
            let (a, b) = (Cell::Integer(curve.a), Cell::Integer(curve.b));
            table.push(vec![a, b, Cell::Float(p.h1), Cell::Float(p.h2), Cell::Float(p.theta_over_pi)]);
        }
    }
    table
}
