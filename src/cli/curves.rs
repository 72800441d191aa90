//! `kickdrift curves`: the (a, b) families as tables.

use crate::parallel::*;

use super::args::{Common, of, whole};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::parse::{parse, parse_integer_range, parse_range};
use crate::number::{ExactSign, Laurent, Sign};
use crate::report::curves;
use crate::report::document::Document;
use crate::resonance::{Curve, Window, curve, curve_within};
use crate::scene::{Families, GridRange, StepRange, shown_range};

/// Flags of `curves`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The stiffness of the fast force.
    #[arg(long, value_name = "X", default_value = "pi^2", allow_hyphen_values = true, value_parser = of(parse))]
    lambda1: Laurent,
    /// The closed range of h1.
    #[arg(long, value_name = "LO..HI", default_value = "1/1000..2/pi", allow_hyphen_values = true, value_parser = of(parse_range))]
    h1_range: StepRange,
    /// The closed range of h2.
    #[arg(long, value_name = "LO..HI", default_value = "1/1000..7/2", allow_hyphen_values = true, value_parser = of(parse_range))]
    h2_range: StepRange,
    /// The range of a.
    #[arg(long, value_name = "LO..HI", default_value = "0..3", allow_hyphen_values = true, value_parser = of(parse_integer_range))]
    a: (i64, i64),
    /// The range of b.
    #[arg(long, value_name = "LO..HI", default_value = "-12..12", allow_hyphen_values = true, value_parser = of(parse_integer_range))]
    b: (i64, i64),
    /// Points a curve, evenly spaced in theta.
    #[arg(long, value_name = "N", default_value_t = 400, allow_negative_numbers = true, value_parser = whole::<usize>)]
    samples: usize,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::DOCUMENT)?;
        let Args { lambda1, h1_range: h1, h2_range: h2, a, b, samples } = self;
        for (field, (lo, hi)) in [("h1-range", h1), ("h2-range", h2)] {
            if hi.sign() != Sign::Positive {
                return Err(Error::input(
                    field,
                    format!("{lo}..{hi}"),
                    "holds no positive step; raise its end",
                ));
            }
        }
        let families = Families { a: *a, b: *b, samples: *samples };
        let curves = sample(lambda1, &families, &window(h1, h2))?;
        let document = curves::document(&curves)
            .input("lambda1", lambda1)
            .input("h1_range", shown_range(h1))
            .input("h2_range", shown_range(h2))
            .inputs(families.given());
        common.write(&document, format)
    }
}

/// The curves of a grid's window as a document.
pub fn document(lambda1: &Laurent, range: &GridRange, families: &Families, curves: &[Curve]) -> Document {
    curves::document(curves).input("lambda1", lambda1).inputs(range.given()).inputs(families.given())
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
pub fn window(h1: &StepRange, h2: &StepRange) -> Window {
    let ends = |(lo, hi): &StepRange| (lo.enclose_f64().0, hi.enclose_f64().1);
    Window { h1: ends(h1), h2: ends(h2) }
}
