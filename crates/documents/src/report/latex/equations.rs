//! Sums of many terms as numbered equations.

use serde_json::{Map, Value};

use super::label::label;
use super::layout::points;
use number::{Error, Result};

/// name = the sum of the terms, each with its sign.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The left side in LaTeX.
    pub name: String,
    /// The beginning of the label.
    pub key: String,
    /// As ` + \tfrac{7}{2} s`.
    pub terms: Vec<String>,
}

/// The room of a column of two between the left side and the number of the equation, in points.
const LINE: f64 = 150.0;

/// The equations as one `align`, broken before terms that a column of two has no room for; pages may be
/// broken too.
///
/// # Errors
/// A term that no line holds.
pub fn equations(all: &[Equation], input: &Map<String, Value>) -> Result<String> {
    let lines: Vec<String> = all.iter().map(|line| equation(line, input)).collect::<Result<_>>()?;
    Ok(format!(
        "% needs \\usepackage{{amsmath}}\n\\begingroup\\allowdisplaybreaks\n\\begin{{align}}\n{}\n\\end{{align}}\n\\endgroup\n",
        lines.join(" \\\\\n")
    ))
}

fn equation(equation: &Equation, input: &Map<String, Value>) -> Result<String> {
    let (mut lines, mut filled) = (vec![format!("  {} &=", equation.name)], 0.0);
    for term in &equation.terms {
        let width = wide(term);
        if width > LINE {
            let remedy = "a coefficient is longer than a line of a column: write text, csv or json";
            return Err(Error::input("equation", &equation.key, remedy));
        }
        if filled + width > LINE {
            lines.push("    &\\quad".into());
            filled = 0.0;
        }
        filled += width;
        *lines.last_mut().expect("it begins with one") += term;
    }
    if equation.terms.is_empty() {
        lines[0] += " 0";
    }
    Ok(format!("{} \\label{{eq:{}}}", lines.join(" \\notag \\\\\n"), label(&equation.key, input)))
}

/// A fraction is as wide as the longer of its numbers, in small digits.
fn wide(term: &str) -> f64 {
    let fraction = term.split_once("\\tfrac{").and_then(|(before, rest)| {
        let (above, rest) = rest.split_once("}{")?;
        let (below, after) = rest.split_once('}')?;
        Some(points(before) + 0.8 * points(above).max(points(below)) + 3.0 + points(after))
    });
    fraction.unwrap_or_else(|| points(term))
}
