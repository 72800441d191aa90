//! Cells and words as LaTeX.

use crate::report::decimal::{self, Shown};
use crate::report::table::Cell;

/// One cell, ready to stand between two `&`.
pub fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Exact(text) => format!("${}$", exact(text)),
        Cell::Float(value) => format!("${}$", float(*value)),
        Cell::Enclosure { lo, hi } => format!("${}$", enclosure(*lo, *hi)),
        Cell::Decimal(text) => format!("${}$", power_of_ten(text.clone())),
        Cell::Integer(value) => format!("${value}$"),
        Cell::Text(text) => escaped(text),
        Cell::Flag(true) => "yes".into(),
        Cell::Flag(false) => "no".into(),
        Cell::Missing => "--".into(),
    }
}

/// An enclosure in math mode: the digits that are certain, the exponent as a power of ten.
pub fn enclosure(lo: f64, hi: f64) -> String {
    match decimal::enclosure(lo, hi) {
        Shown::Ends(lo, hi) => format!("[{}, {}]", float(lo), float(hi)),
        concise => power_of_ten(concise.to_string()),
    }
}

/// A double in math mode: the shortest digits that read back as the same double.
pub fn float(value: f64) -> String {
    if value.is_nan() {
        return "\\text{NaN}".into();
    }
    let text = format!("{value:?}").replace("inf", "\\infty");
    power_of_ten(text)
}

fn power_of_ten(text: String) -> String {
    match text.split_once('e') {
        Some((mantissa, power)) => format!("{mantissa} \\times 10^{{{power}}}"),
        None => text,
    }
}

/// An exact number of kickdrift's notation in math mode: `3*pi^-2/25` becomes `3\pi^{-2}/25`.
pub fn exact(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let (taken, typeset) = token(rest, letter);
        // A command such as \pi must not run into a letter behind it.
        if ends_in_command(&out) && typeset.starts_with(|c: char| c.is_ascii_alphabetic()) {
            out.push(' ');
        }
        out.push_str(&typeset);
        rest = &rest[taken..];
    }
    out
}

/// How many bytes the first token takes, and how it is typeset.
fn token(rest: &str, letter: char) -> (usize, String) {
    if rest.starts_with("pi") {
        return (2, "\\pi".into());
    }
    if let Some(power) = rest.strip_prefix('^') {
        let sign = usize::from(power.starts_with('-'));
        let digits = power[sign..].bytes().take_while(u8::is_ascii_digit).count();
        return (1 + sign + digits, format!("^{{{}}}", &power[..sign + digits]));
    }
    match letter {
        // A product with pi needs no sign; one of two numbers does.
        '*' if rest[1..].trim_start().starts_with("pi") => (1, String::new()),
        '*' => (1, " \\cdot ".into()),
        other => (other.len_utf8(), escaped(&other.to_string())),
    }
}

fn ends_in_command(text: &str) -> bool {
    text.rsplit_once('\\').is_some_and(|(_, name)| name.bytes().all(|b| b.is_ascii_alphabetic()))
}

/// Plain text with everything that means something to LaTeX made harmless.
///
/// ```
/// use kickdrift_documents::report::latex::escaped;
/// assert_eq!(escaped("50% of h_1 & ~h^2"), r"50\% of h\_1 \& \textasciitilde{}h\textasciicircum{}2");
/// ```
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', letter]),
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("\\textless{}"),
            '>' => out.push_str("\\textgreater{}"),
            '|' => out.push_str("\\textbar{}"),
            control if control.is_control() => out.push(' '),
            plain => out.push(plain),
        }
    }
    out
}
