//! `kickdrift curves`: the (a, b) families as tables.

use crate::parallel::*;

use super::args::{Common, echo_grid, shown_range, whole};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::parse::{parse, parse_integer_range, parse_range};
use crate::number::{ExactSign, Laurent, Sign};
use crate::report::curves;
use crate::report::document::Document;
use crate::resonance::{Curve, Window, curve, curve_within};
use crate::scene::{Families, GridRange};

/// Flags of `curves`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The stiffness of the fast force.
    #[arg(long, value_name = "X", default_value = "pi^2", allow_hyphen_values = true)]
    lambda1: String,
    /// The closed range of h1.
    #[arg(long, value_name = "LO..HI", default_value = "1/1000..2/pi", allow_hyphen_values = true)]
    h1_range: String,
    /// The closed range of h2.
    #[arg(long, value_name = "LO..HI", default_value = "1/1000..7/2", allow_hyphen_values = true)]
    h2_range: String,
    /// The range of a.
    #[arg(long, value_name = "LO..HI", default_value = "0..3", allow_hyphen_values = true)]
    a: String,
    /// The range of b.
    #[arg(long, value_name = "LO..HI", default_value = "-12..12", allow_hyphen_values = true)]
    b: String,
    /// Points a curve, evenly spaced in theta.
    #[arg(long, value_name = "N", default_value_t = 400, allow_negative_numbers = true, value_parser = whole::<usize>)]
    samples: usize,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::DOCUMENT)?;
        let lambda1 = parse("lambda1", &self.lambda1)?;
        let (h1, h2) = (parse_range("h1-range", &self.h1_range)?, parse_range("h2-range", &self.h2_range)?);
        for (field, (lo, hi)) in [("h1-range", &h1), ("h2-range", &h2)] {
            if hi.sign() != Sign::Positive {
                return Err(Error::input(
                    field,
                    format!("{lo}..{hi}"),
                    "holds no positive step; raise its end",
                ));
            }
        }
        let (a, b) = (parse_integer_range("a", &self.a)?, parse_integer_range("b", &self.b)?);
        let families = Families { a, b, samples: self.samples };
        let curves = sample(&lambda1, &families, &window(&h1, &h2))?;
        let document = curves::document(&curves)
            .input("lambda1", &lambda1)
            .input("h1_range", shown_range(&h1))
            .input("h2_range", shown_range(&h2));
        common.write(&echo(document, &families), format)
    }
}

/// The curves of a grid's window as a document.
pub fn document(lambda1: &Laurent, range: &GridRange, families: &Families, curves: &[Curve]) -> Document {
    let document = curves::document(curves).input("lambda1", lambda1);
    echo(echo_grid(document, range), families)
}

/// Echoes the families into a document.
pub fn echo(document: Document, families: &Families) -> Document {
    let range = |(lo, hi): (i64, i64)| format!("{lo}..{hi}");
    document.input("a", range(families.a)).input("b", range(families.b)).input("samples", families.samples)
}

/// The most curves drawn at once: beyond it the range is a mistake.
const MOST_CURVES: i128 = 100_000;

/// The most points of all curves together: some gigabytes of rows.
const MOST_POINTS: i128 = 20_000_000;

/// All curves of the families that pass through the window.
pub fn sample(lambda1: &Laurent, families: &Families, window: &Window) -> Result<Vec<Curve>> {
    each(families, |a, b| curve(a, b, lambda1, window, families.samples))
}

/// The same, all samples in the window.
pub fn sample_within(lambda1: &Laurent, families: &Families, window: &Window) -> Result<Vec<Curve>> {
    each(families, |a, b| curve_within(a, b, lambda1, window, families.samples))
}

fn each(families: &Families, sample: impl Fn(i64, i64) -> Result<Curve> + Sync) -> Result<Vec<Curve>> {
    let count = |(lo, hi): (i64, i64)| i128::from(hi) - i128::from(lo) + 1;
    let curves = count(families.a) * count(families.b);
    if curves > MOST_CURVES {
        let value = format!("{:?} by {:?}", families.a, families.b);
        return Err(Error::input(
            "a, b",
            value,
            format!("at most {MOST_CURVES} curves: choose smaller ranges"),
        ));
    }
    if curves * families.samples as i128 > MOST_POINTS {
        let remedy = format!("{curves} curves of so many points are more than {MOST_POINTS}: choose fewer");
        return Err(Error::input("samples", families.samples, remedy));
    }
    let pairs: Vec<(i64, i64)> = (families.a.0..=families.a.1)
        .flat_map(|a| (families.b.0..=families.b.1).map(move |b| (a, b)))
        .collect();
    let curves: Result<Vec<Curve>> = pairs.into_par_iter().map(|(a, b)| sample(a, b)).collect();
    Ok(curves?.into_iter().filter(|curve| !curve.pieces.is_empty()).collect())
}

/// The window of two closed ranges, widened to doubles.
pub fn window(h1: &(Laurent, Laurent), h2: &(Laurent, Laurent)) -> Window {
    let ends = |(lo, hi): &(Laurent, Laurent)| (lo.enclose_f64().0, hi.enclose_f64().1);
    Window { h1: ends(h1), h2: ends(h2) }
}
