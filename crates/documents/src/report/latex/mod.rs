//! Tables for papers: LaTeX floats with a `booktabs` body, numbers in math mode and aligned at their points,
//! no wider than a column of text; beyond a page a `longtable`. Polynomials are equations.

mod equations;
mod label;
mod layout;
mod typeset;

use serde_json::{Map, Value};

use super::table::{Cell, Column, Table};
pub use equations::{Equation, equations};
use label::{checksum, label};
pub use layout::Float;
use layout::{Body, Place};
use number::{Error, Result};
pub use typeset::{enclosure, escaped, exact, float, shown};

/// Rows beyond this number do not fit a page of an article.
const ROWS_OF_A_PAGE: usize = 40;

/// Significant digits where none are asked for: the first of them that fit the paper choose the place, and as
/// many more stand there as it has room for.
const DIGITS: [u32; 4] = [10, 8, 6, 4];
/// Every double reads back from so many digits.
const MOST_DIGITS: u32 = 17;

/// A table with its caption, its parameters behind it, and the label `tab:NAME-PARAMETERS-FORM`. Without
/// `digits` as many are shown as there is room for in the place that ten have, or the most of fewer that fit.
///
/// It fits an article of one column and one of two: in a column of two where it can, across both where it
/// must, in smaller letters where that is not enough, unless `float` chooses; what is too wide even so goes
/// on in further tables, the first columns of numbers repeated. More rows than a page holds are a
/// `longtable`, for which an article of two columns is interrupted.
///
/// # Errors
/// A column wider than a page.
pub fn document(
    table: &Table,
    input: &Map<String, Value>,
    digits: Option<u32>,
    float: Option<Float>,
) -> Result<String> {
    let table = &table.keeping(|column| !column.aside);
    let parts = parts(table, digits, float)?;
    let caption = table.typeset().map_or_else(|| escaped(table.caption()), Into::into);
    let parameters = parameters(input, table.columns());
    let label = format!("{}-{}", label(table.name(), input), form(table, digits));
    let one = |(n, (place, body)): (usize, &(Place, Body))| {
        let (more, number) =
            if n == 0 { ("", String::new()) } else { (" (continued)", format!("-{}", n + 1)) };
        let caption = format!("\\caption{{{caption}{more}{parameters}}}\n  \\label{{tab:{label}{number}}}");
        match place {
            Place::Long(size) => long(body, size, &caption),
            Place::Float { name, size } => page(body, name, size, &caption),
        }
    };
    Ok(parts.iter().enumerate().map(one).collect::<Vec<_>>().join("\n"))
}

/// The table where it fits, else its parts.
fn parts(table: &Table, digits: Option<u32>, float: Option<Float>) -> Result<Vec<(Place, Body)>> {
    let tries = digits.map_or(DIGITS.to_vec(), |digits| vec![digits]);
    let is_long = table.rows().len() > ROWS_OF_A_PAGE;
    let whole = |digits: u32| Body::new(&table.shortened(digits)).placed(is_long, float);
    let parts = |digits: u32| split(&table.shortened(digits), is_long, float);
    // More digits than were sure to fit, the most first.
    let more = |fitting: u32| if digits.is_some() { fitting..fitting } else { fitting..MOST_DIGITS };
    if let Some((fitting, first)) = tries.iter().find_map(|&digits| Some((digits, whole(digits)?))) {
        let same = more(fitting).rev().filter_map(|n| whole(n + 1)).find(|(place, _)| *place == first.0);
        return Ok(vec![same.unwrap_or(first)]);
    }
    let first = parts(tries[0])?;
    let form = |parts: &[(Place, Body)]| parts.iter().map(|(_, body)| body.count()).collect::<Vec<_>>();
    let same = |all: &Vec<(Place, Body)>| {
        form(all) == form(&first) && all.iter().zip(&first).all(|(a, b)| a.0 == b.0)
    };
    let same = more(tries[0]).rev().filter_map(|n| parts(n + 1).ok()).find(same);
    Ok(same.unwrap_or(first))
}

/// The first columns of integers, three at most, and as many others as fit, again and again.
fn split(table: &Table, is_long: bool, float: Option<Float>) -> Result<Vec<(Place, Body)>> {
    let keys: Vec<String> = table.columns().iter().map(|column| column.key.clone()).collect();
    let is_integer = |i: &usize| table.rows().iter().all(|row| matches!(row[*i], Cell::Integer(_)));
    let repeated = (0..keys.len().min(3)).take_while(is_integer).count();
    let (first, mut rest) = keys.split_at(repeated);
    let mut parts = Vec::new();
    while !rest.is_empty() {
        let part = |n: usize| {
            let keys = [first, &rest[..n]].concat();
            Some((Body::new(&table.choose(&keys).ok()?).placed(is_long, float)?, n))
        };
        let (placed, n) = (1..=rest.len()).rev().find_map(part).ok_or_else(|| {
            Error::input("column", &rest[0], "is wider than a page: choose fewer digits, or write csv")
        })?;
        parts.push(placed);
        rest = &rest[n..];
    }
    Ok(parts)
}

fn page(body: &Body, name: &str, size: &str, caption: &str) -> String {
    let (sides, head, lines) = (body.sides(), body.head(), body.lines("    "));
    format!(
        "% needs \\usepackage{{amsmath,booktabs}}\n\\begin{{{name}}}\n  \\centering{size}\n  {caption}\n  \
         \\begin{{tabular}}{{{sides}}}\n    \\toprule\n    {head}\n    \\midrule\n{lines}    \\bottomrule\n  \
         \\end{{tabular}}\n\\end{{{name}}}\n"
    )
}

/// Over many pages, the head on each.
fn long(body: &Body, size: &str, caption: &str) -> String {
    let (sides, head, lines) = (body.sides(), body.head(), body.lines("  "));
    format!(
        "% needs \\usepackage{{amsmath,booktabs,longtable}}; in an article of two columns it has pages of its own\n\
         \\begingroup{size}\n\\makeatletter\\if@twocolumn\\onecolumn\\let\\afterrows\\twocolumn\\else\\let\\afterrows\\relax\\fi\\makeatother\n\
         \\begin{{longtable}}{{{sides}}}\n  {caption} \\\\\n  \\toprule\n  {head}\n  \\midrule\n  \\endfirsthead\n  \\toprule\n  \
         {head}\n  \\midrule\n  \\endhead\n  \\bottomrule\n  \\endfoot\n{lines}\\end{{longtable}}\n\\afterrows\n\\endgroup\n"
    )
}

/// Inputs as formulas, ending in `=` or `in`, before the value.
const FORMULAS: [(&str, &str); 14] = [
    ("ratio", "h_2/h_1 ="),
    ("max_sum", "p + q \\le"),
    ("max", "p, q \\le"),
    ("rho", "\\rho ="),
    ("lambda1", "\\Lambda_1 ="),
    ("lambda2", "\\Lambda_2 ="),
    ("h1", "h_1 ="),
    ("h2", "h_2 ="),
    ("step", "\\Delta ="),
    ("h1_range", "h_1 \\in"),
    ("h2_range", "h_2 \\in"),
    ("rho_range", "\\rho \\in"),
    ("friction", "\\gamma ="),
    ("m", "m \\in"),
];

/// The inputs that have a formula and no column, as a sentence.
fn parameters(input: &Map<String, Value>, columns: &[Column]) -> String {
    let given = FORMULAS.iter().filter(|(key, _)| !columns.iter().any(|column| column.key == *key));
    let typeset = given.filter_map(|(key, formula)| {
        let value = input.get(*key)?.as_str()?;
        Some(match value.split_once("..") {
            Some((lo, hi)) => format!("${formula} [{}, {}]$", exact(lo), exact(hi)),
            None => format!("${formula} {}$", exact(value)),
        })
    });
    let mut all: Vec<String> = typeset.collect();
    all.extend(input.get("title").and_then(Value::as_str).filter(|title| !title.is_empty()).map(escaped));
    if all.is_empty() { String::new() } else { format!(". {}.", all.join(", ")) }
}

/// A checksum of columns and digits: tables of one input have different labels.
fn form(table: &Table, digits: Option<u32>) -> String {
    let keys: Vec<&str> = table.columns().iter().map(|column| column.key.as_str()).collect();
    format!("{:04x}", checksum(&format!("{keys:?}{digits:?}")) & 0xffff)
}
