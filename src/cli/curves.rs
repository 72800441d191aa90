//! `kickdrift curves`: the (a, b) families as tables.

use super::args::{Columns, Common, of, whole};
use super::request::Request;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::parse::{parse, parse_integer_range, parse_range};
use crate::number::{ExactSign, Laurent, Sign};
use crate::resonance::Families;
use crate::scene::{StepRange, shown_range};

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
    /// Points a curve, evenly spaced in theta over its pieces in the window.
    #[arg(long, value_name = "N", default_value_t = 400, allow_negative_numbers = true, value_parser = whole::<usize>)]
    samples: usize,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::DOCUMENT)?;
        let Args { lambda1, h1_range: h1, h2_range: h2, a, b, samples, columns } = self;
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
        let given = vec![("h1_range", shown_range(h1)), ("h2_range", shown_range(h2))];
        let ranges = [h1.clone(), h2.clone()];
        let request = Request::Curves { lambda1: lambda1.clone(), ranges, families, given };
        common.write(&columns.of(request.perform(common, true)?)?, format)
    }
}
