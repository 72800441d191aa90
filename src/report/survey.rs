//! A survey of all ratios as a document: counts, the thinnest tongues, how widths spread about the first-order law.

use serde_json::{Value, json};

use super::decimal;
use super::digits::rounded;
use super::document::{Document, enclosure};
use super::table::{Cell, Column, Table};
use crate::tongue::{Spread, Survey, Thin};

/// Digits that people need of a quotient of widths.
const FEW: usize = 4;

/// The document `kickdrift/survey/1`.
pub fn document(survey: &Survey) -> Document {
    let closed: Vec<Value> =
        survey.closed.iter().map(|(ratio, m)| json!({"p": ratio.p(), "q": ratio.q(), "m": m})).collect();
    Document::new("survey")
        .input("max_sum", survey.max_sum)
        .input("rho", &survey.rho)
        .entry("ratios", survey.ratios)
        .entry("tongues", survey.tongues)
        .entry("open", survey.open)
        .entry("closed", closed)
        .entry("edges", json!({"doubles": survey.edges.0, "more_bits": survey.edges.1}))
        .entry(
            "predicted",
            json!({
                "points": survey.predicted, "outside": survey.predicted_outside,
                "on_edge": survey.predicted_on_edge, "inside": survey.predicted_inside,
            }),
        )
        .entry("width_ratios", survey.width_ratios.iter().map(spread).collect::<Vec<_>>())
        .entry("thinnest", survey.thinnest.iter().map(thin).collect::<Vec<_>>())
        .long_rows(widths(survey))
        .and_rows(thinnest(survey))
        .summary(&lines(survey))
}

fn spread(spread: &Spread) -> Value {
    json!({
        "abs_a": spread.abs_a, "count": spread.count, "least": spread.least,
        "lower_quartile": spread.lower_quartile, "median": spread.median,
        "upper_quartile": spread.upper_quartile, "largest": spread.largest,
    })
}

fn thin(thin: &Thin) -> Value {
    json!({
        "p": thin.ratio.p(), "q": thin.ratio.q(), "m": thin.m, "a": thin.a, "b": thin.b,
        "s": thin.s, "width": enclosure(thin.width),
    })
}

fn lines(survey: &Survey) -> Vec<String> {
    let share = |n: u64| rounded(100.0 * n as f64 / survey.predicted.max(1) as f64, 3);
    let closed: Vec<String> = survey.closed.iter().map(|(ratio, m)| format!("{ratio} m = {m}")).collect();
    let mut lines = vec![
        format!(
            "all tongues that begin below s = 4, for all h2/h1 = p/q, p + q <= {}, rho = {}",
            survey.max_sum, survey.rho
        ),
        format!("  ratios       {}", survey.ratios),
        format!(
            "  tongues      {}: {} proven open, {} proven closed",
            survey.tongues,
            survey.open,
            survey.closed.len()
        ),
    ];
    if !closed.is_empty() {
        lines.push(format!("  closed       {}", closed.join(", ")));
    }
    lines.push(format!(
        "  edges        {} certified in doubles, {} with more bits",
        survey.edges.0, survey.edges.1
    ));
    lines.push(format!(
        "  predicted    {} points p theta = m pi: {} ({} %) outside their own tongue, {} ({} %) on its edge, {} inside",
        survey.predicted,
        survey.predicted_outside,
        share(survey.predicted_outside),
        survey.predicted_on_edge,
        share(survey.predicted_on_edge),
        survey.predicted_inside
    ));
    if let Some(thin) = survey.thinnest.first() {
        let width = decimal::enclosure(thin.width.0, thin.width.1);
        lines.push(format!("  thinnest     {width} wide: {}, m = {}", thin.ratio, thin.m));
    }
    lines
}

fn widths(survey: &Survey) -> Table {
    let columns = vec![
        Column::new("abs_a").titled("|a|", "$|a|$"),
        Column::new("count").titled("tongues", "tongues"),
        Column::new("least"),
        Column::new("lower_quartile").titled("lower quartile", "lower quartile"),
        Column::new("median"),
        Column::new("upper_quartile").titled("upper quartile", "upper quartile"),
        Column::new("largest"),
    ];
    let caption = format!(
        "Width over first-order width, by the dominant family (a, b), for all p + q up to {} at rho = {}",
        survey.max_sum, survey.rho
    );
    let mut table = Table::new("width_ratios", &caption, columns);
    for spread in &survey.width_ratios {
        let Spread { least, lower_quartile, median, upper_quartile, largest, .. } = *spread;
        let five = [least, lower_quartile, median, upper_quartile, largest];
        let mut cells = vec![Cell::Integer(spread.abs_a as i64), Cell::Integer(spread.count as i64)];
        cells.extend(five.map(|x| Cell::Float(rounded(x, FEW))));
        table.push(cells);
    }
    table
}

fn thinnest(survey: &Survey) -> Table {
    let mut columns: Vec<Column> =
        ["p", "q", "m", "a", "b"].map(|key| Column::new(key).titled(key, &format!("${key}$"))).into();
    columns.push(Column::new("s").titled("s", "$s$"));
    columns.push(Column::new("width").enclosure());
    let caption = format!(
        "The thinnest tongues that begin below s = 4, for all p + q up to {} at rho = {}",
        survey.max_sum, survey.rho
    );
    let mut table = Table::new("thinnest", &caption, columns);
    for thin in &survey.thinnest {
        let mut cells: Vec<Cell> =
            [thin.ratio.p() as i64, thin.ratio.q() as i64, thin.m as i64, thin.a, thin.b]
                .map(Cell::Integer)
                .into();
        let (lo, hi) = thin.width;
        cells.extend([Cell::Float(thin.s), Cell::Enclosure { lo, hi }]);
        table.push(cells);
    }
    table
}
