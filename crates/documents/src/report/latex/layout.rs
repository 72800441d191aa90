//! How wide a table is, and what fits.

use super::typeset::{escaped, shown};
use crate::report::table::{Align, Column, Table};
use number::named;

/// The widths, in points, of a column of a two-column article on A4 and of the text of a one-column one, both
/// in letters of ten points: the narrowest that there are.
const COLUMN: f64 = 221.0;
const TEXT: f64 = 345.0;

/// The sizes of letters: their command, their widths against ten points (those of Computer Modern's digits),
/// half the space between columns.
const SIZES: [(&str, f64, f64); 4] = [
    ("", 1.0, 6.0),
    ("\\small", 0.925, 6.0),
    ("\\footnotesize\\setlength{\\tabcolsep}{4pt}", 0.85, 4.0),
    ("\\scriptsize\\setlength{\\tabcolsep}{4pt}", 0.8, 4.0),
];

named! {
    /// The environment of a table that is not longer than a page.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[derive(clap::ValueEnum)]
    pub enum Float {
        /// As wide as the column it stands in; in an article of two columns a wide one runs over.
        #[value(name = "table")]
        Column = "table",
        /// Across both columns of an article of two.
        #[value(name = "table*")]
        Page = "table*",
    }
}

/// Where a table stands and in what size.
#[derive(PartialEq)]
pub enum Place {
    /// A float, `table` or `table*`.
    Float { name: &'static str, size: &'static str },
    /// Pages.
    Long(&'static str),
}

/// The cells as LaTeX, column by column.
pub struct Body {
    columns: Vec<Typeset>,
    rows: usize,
}

/// One column: cells that hold a decimal point are cut there, so that points stand below each other.
struct Typeset {
    column: Column,
    cells: Vec<String>,
    is_cut: bool,
}

impl Body {
    pub fn new(table: &Table) -> Self {
        let column = |i: usize, column: &Column| {
            let cells: Vec<String> = table.rows().iter().map(|row| shown(&row[i])).collect();
            let is_cut = cells.iter().any(|cell| cut(cell).is_some_and(|(_, rest)| !rest.is_empty()));
            Typeset { column: column.clone(), cells, is_cut }
        };
        Body {
            columns: (0..).zip(table.columns()).map(|(i, heading)| column(i, heading)).collect(),
            rows: table.rows().len(),
        }
    }

    /// The largest letters in which the table fits, in one column of two if it can be and no environment is
    /// asked for; `None` where it does not fit.
    fn place(&self, is_long: bool, float: Option<Float>) -> Option<Place> {
        let fits = |limit: f64, sizes: usize| {
            let fits = |(_, scale, space): &&(&str, f64, f64)| self.width(*scale, *space) <= limit;
            SIZES[..sizes].iter().find(fits).map(|(size, ..)| *size)
        };
        if is_long {
            return fits(TEXT, 4).map(Place::Long);
        }
        let place = |float: Float, size| Place::Float { name: float.name(), size };
        let in_column = || fits(COLUMN, 3).map(|size| place(Float::Column, size));
        let across = |float| fits(TEXT, 4).map(|size| place(float, size));
        match float {
            Some(Float::Page) => across(Float::Page),
            Some(Float::Column) => in_column().or_else(|| across(Float::Column)),
            None => in_column().or_else(|| across(Float::Page)),
        }
    }

    /// The table with its place, where it fits.
    pub fn placed(self, is_long: bool, float: Option<Float>) -> Option<(Place, Body)> {
        Some((self.place(is_long, float)?, self))
    }

    fn width(&self, scale: f64, space: f64) -> f64 {
        let gaps = 2.0 * space * (self.columns.len() as f64 - 1.0);
        scale * self.columns.iter().map(Typeset::width).sum::<f64>() + gaps
    }

    /// How many columns it has.
    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// The argument of `tabular`.
    pub fn sides(&self) -> String {
        let sides: Vec<&str> = self.columns.iter().map(Typeset::side).collect();
        format!("@{{}}{}@{{}}", sides.concat())
    }

    pub fn head(&self) -> String {
        line(self.columns.iter().map(Typeset::head))
    }

    pub fn lines(&self, indent: &str) -> String {
        let row = |i: usize| format!("{indent}{}\n", line(self.columns.iter().map(|column| column.cell(i))));
        (0..self.rows).map(row).collect()
    }
}

fn line(fields: impl Iterator<Item = String>) -> String {
    format!("{} \\\\", fields.collect::<Vec<_>>().join(" & "))
}

impl Typeset {
    fn side(&self) -> &'static str {
        match self.column.align {
            _ if self.is_cut => "r@{}l",
            Align::Left => "l",
            Align::Right => "r",
        }
    }

    fn title(&self) -> String {
        let title = self.column.latex.clone().unwrap_or_else(|| escaped(&self.column.title));
        self.column.unit.as_ref().map_or(title.clone(), |unit| format!("{title} ({})", escaped(unit)))
    }

    fn head(&self) -> String {
        let title = self.title();
        if self.is_cut { format!("\\multicolumn{{2}}{{c}}{{{title}}}") } else { title }
    }

    fn cell(&self, i: usize) -> String {
        let cell = &self.cells[i];
        match cut(cell) {
            _ if !self.is_cut => cell.clone(),
            Some((whole, "")) => format!("${whole}$ &"),
            Some((whole, rest)) => format!("${whole}$ & ${rest}$"),
            None => format!("\\multicolumn{{2}}{{c}}{{{cell}}}"),
        }
    }

    fn width(&self) -> f64 {
        let widest = |widths: &mut dyn Iterator<Item = f64>| widths.fold(0.0, f64::max);
        let parts = || self.cells.iter().filter_map(|cell| cut(cell));
        let cut_width = widest(&mut parts().map(|(whole, _)| points(whole)))
            + widest(&mut parts().map(|(_, rest)| points(rest)));
        let whole =
            self.cells.iter().filter(|cell| !self.is_cut || cut(cell).is_none()).map(|cell| points(cell));
        widest(&mut whole.chain([points(&self.title()), if self.is_cut { cut_width } else { 0.0 }]))
    }
}

/// A number in math mode before its point, and the rest of it.
fn cut(cell: &str) -> Option<(&str, &str)> {
    let number = cell.strip_prefix('$')?.strip_suffix('$')?;
    let sign = usize::from(number.starts_with('-'));
    let digits = number[sign..].bytes().take_while(u8::is_ascii_digit).count();
    let (whole, rest) = number.split_at(sign + digits);
    let is_number = rest.is_empty() || rest.starts_with(['.', '(']) || rest.starts_with(" \\times");
    (digits > 0 && is_number).then_some((whole, rest))
}

/// The width of some LaTeX in Computer Modern of ten points, or a little more.
pub fn points(latex: &str) -> f64 {
    let (mut width, mut rest) = (0.0, latex);
    while let Some(letter) = rest.chars().next() {
        let mut taken = letter.len_utf8();
        width += match letter {
            '\\' => {
                let name = rest[1..].bytes().take_while(u8::is_ascii_alphabetic).count();
                taken += name.max(1);
                match &rest[1..=name.max(1)] {
                    "times" | "cdot" | "le" | "in" => 13.0,
                    "operatorname" | "tfrac" | "mathrm" | "," | "quad" => 2.0,
                    _ => 8.0,
                }
            }
            '$' | '{' | '}' | '^' | '_' => 0.0,
            '.' | ',' | ':' | '/' | '(' | ')' | '[' | ']' | '|' | 'i' | 'j' | 'l' | 't' | 'f' | ' '
            | '\'' => 4.5,
            '-' | '+' | '=' | '<' | '>' => 9.5,
            '0'..='9' => 5.0,
            'm' | 'w' | 'M' | 'W' => 10.3,
            'A'..='Z' => 7.8,
            _ => 5.6,
        };
        rest = &rest[taken..];
    }
    width
}
