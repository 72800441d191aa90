//! Work and precision, drawn.

use kickdrift::report::figure::palette::{GREY, INK, family};
use kickdrift::report::figure::{Axis, Dash, Figure, Layer, Panel, Place, Shape, Stroke};

use crate::methods::Method;
use crate::traces::Row;
use crate::verdicts::{NAIVE, Verdicts};

/// What exact methods are drawn at.
const NO_ERROR: f64 = 1e-33;

/// Guesses in solid lines, balls dotted, proofs in ink.
fn stroke(method: Method) -> Stroke {
    let place = Method::ALL.iter().position(|&other| other == method).unwrap_or(0);
    let (colour, width, dash) = match method {
        Method::Filter => (INK, 1.6, Dash::Solid),
        Method::Refine => (INK, 0.9, Dash::Dashed),
        Method::Exact => (GREY, 0.9, Dash::DashDotted),
        Method::Balls(_) => (family(place), 0.9, Dash::Dotted),
        _ => (family(place), 0.8, Dash::Solid),
    };
    Stroke { colour, width, dash }
}

/// Left: time against error of the trace as periods grow. Right: wrong verdicts near an edge.
pub fn precision(traces: &[Row], verdicts: &Verdicts) -> Figure {
    let left = Panel::new(
        Axis::log("time (s)", 1e-7, 20.0),
        Axis::log("error of the trace, relative to max(1, |Tr|)", NO_ERROR / 3.0, 10.0),
    )
    .titled("*p* + *q* = 10, 100, ..., 10^6 kicks a period");
    let left = Method::ALL.into_iter().fold(left, |panel, method| {
        let points: Vec<[f64; 2]> = traces
            .iter()
            .filter(|row| row.method == method && row.scene == "usual")
            .filter_map(|row| Some([row.seconds, row.error?.max(NO_ERROR)]))
            .collect();
        let line = stroke(method);
        panel.with(Layer::lines(vec![points.clone()], line).labelled(method.name())).with(Layer::dots(
            points,
            Shape::Disc,
            3.0,
            line.colour,
        ))
    });
    let right = Panel::new(
        Axis::linear("*k*: *s* is 10^{−k} beside an edge", 0.0, 31.0),
        Axis::linear("wrong verdicts (%)", -2.0, 62.0),
    )
    .titled("The verdict near an edge");
    let rows = &verdicts.0;
    let share = |count: &dyn Fn(usize) -> u64| -> Vec<[f64; 2]> {
        rows.iter()
            .enumerate()
            .map(|(n, row)| [f64::from(row.k), 100.0 * count(n) as f64 / row.cases as f64])
            .collect()
    };
    let right = NAIVE.into_iter().enumerate().fold(right, |panel, (place, method)| {
        let points = share(&|n| rows[n].wrong[place]);
        panel.with(Layer::lines(vec![points], stroke(method)).labelled(method.name()))
    });
    let ladder = Layer::lines(vec![share(&|n| rows[n].ladder)], Stroke::THICK).labelled("kickdrift");
    Figure::double_column(105.0)
        .named("Run time against error: trace and verdict by ten methods")
        .with(left.legend(Place::Above))
        .with(right.with(ladder).legend(Place::Above))
}
