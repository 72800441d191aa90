//! Work and precision, drawn.

use kickdrift::plot::palette::{GREY, INK, family};
use kickdrift::plot::{Axis, Dash, Figure, Layer, Panel, Place, Shape, Stroke};
use serde_json::Value;

use crate::methods::Method;
use crate::verdicts::NAIVE;

/// What exact methods are drawn at.
const NO_ERROR: f64 = 1e-33;

/// Guesses in solid lines, balls dotted, proofs in ink; each method has a mark of its own, for print in grey.
fn line(method: Method, points: Vec<[f64; 2]>) -> Layer {
    const SHAPES: [Shape; 6] =
        [Shape::Disc, Shape::Square, Shape::Diamond, Shape::Triangle, Shape::Ring, Shape::Cross];
    let place = Method::ALL.iter().position(|&other| other == method).unwrap_or(0);
    let (colour, width, dash) = match method {
        Method::Filter => (INK, 1.6, Dash::Solid),
        Method::Refine => (INK, 0.9, Dash::Dashed),
        Method::Exact => (GREY, 0.9, Dash::DashDotted),
        Method::Balls(_) => (family(place), 0.9, Dash::Dotted),
        _ => (family(place), 0.8, Dash::Solid),
    };
    let layer = Layer::lines(vec![points], Stroke { colour, width, dash });
    layer.marked(SHAPES[place % SHAPES.len()], 3.4).labelled(method.name())
}

/// Left: time against error of the trace as periods grow. Right: wrong verdicts near an edge. From the
/// document that is kept.
pub fn precision(document: &Value) -> Figure {
    let rows = |name: &str| document[name].as_array().expect("rows").iter();
    let number = |value: &Value| value.as_f64().expect("a number");
    let left = Panel::new(
        Axis::log("time (s)", 1e-7, 20.0),
        Axis::log("error of the trace, relative to max(1, |Tr|)", NO_ERROR / 3.0, 10.0),
    )
    .titled("*p* + *q* = 10, 100, ..., 10^6 kicks a period");
    let left = Method::ALL.into_iter().fold(left, |panel, method| {
        let own = rows("traces").filter(|row| row["method"] == method.name() && row["scene"] == "usual");
        let point = |row: &Value| Some([number(&row["seconds"]), row["error"].as_f64()?.max(NO_ERROR)]);
        panel.with(line(method, own.filter_map(point).collect()))
    });
    let right = Panel::new(
        Axis::linear("*k*: *s* is 10^{−k} beside an edge", 0.0, 31.0),
        Axis::linear("wrong verdicts (%)", -2.0, 62.0),
    )
    .titled("The verdict near an edge");
    let share = |count: &dyn Fn(&Value) -> f64| -> Vec<[f64; 2]> {
        let k = |row: &Value| row["distance"].as_str().and_then(|text| text[3..].parse().ok()).expect("1e-k");
        rows("verdicts").map(|row| [k(row), 100.0 * count(row) / number(&row["cases"])]).collect()
    };
    let right = NAIVE.into_iter().fold(right, |panel, method| {
        panel.with(line(method, share(&|row| number(&row["wrong"][method.name()]))))
    });
    let ladder = share(&|row| number(&row["wrong_ladder"]));
    let ladder = Layer::lines(vec![ladder], Stroke::THICK).labelled("kickdrift");
    Figure::double_column(105.0)
        .named("Run time against error: trace and verdict by ten methods")
        .with(left.legend(Place::Above))
        .with(right.with(ladder).legend(Place::Above))
}
