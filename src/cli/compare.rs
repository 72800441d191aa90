//! `kickdrift compare`: the trace against the predictions, over a grid or over ratios.

use super::args::{self, Columns, Common, of, whole};
use super::request::Request;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Laurent;
use crate::number::Rational;
use crate::number::parse::{parse, parse_rational};

/// Flags of `compare`: either a grid with both stiffnesses, or --max-sum with --rho.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The stiffness of the fast force (with a grid).
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = of(parse))]
    lambda1: Option<Laurent>,
    /// The stiffness of the slow force (with a grid).
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = of(parse))]
    lambda2: Option<Laurent>,
    #[command(flatten)]
    grid: args::Grid,
    /// Instead of a grid: all coprime p + q up to this number.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64>)]
    max_sum: Option<u64>,
    /// lambda2/lambda1, with --max-sum.
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = of(parse_rational))]
    rho: Option<Rational>,
    /// With --max-sum: the values of s = h1^2 lambda1, evenly spaced inside 0 < s < 4.
    #[arg(long, value_name = "K", default_value_t = 99, allow_negative_numbers = true, value_parser = whole::<u64>)]
    samples: u64,
    /// How near q h2 must be to a multiple of T1/2 to count as resonant, in units of T1/2.
    #[arg(long, value_name = "T", default_value = "1/20", allow_hyphen_values = true, value_parser = of(parse_rational))]
    tolerance: Rational,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let tolerance = self.tolerance.clone();
        let request = match (&self.lambda1, &self.lambda2, self.max_sum, &self.rho) {
            (Some(lambda1), Some(lambda2), None, None) => {
                let range = self.grid.range()?;
                Request::CompareGrid { grid: range.of(lambda1.clone(), lambda2.clone())?, range, tolerance }
            }
            (None, None, Some(max_sum), Some(rho)) if self.grid.is_absent() => {
                Request::CompareRatios { max_sum, rho: rho.clone(), samples: self.samples, tolerance }
            }
            _ => {
                let remedy = "give --lambda1, --lambda2 and a grid (--step, --h1-range, --h2-range), or --max-sum and --rho";
                return Err(Error::input("flags", "incomplete or mixed", remedy));
            }
        };
        common.write(&self.columns.of(request.perform(common, true)?)?, Format::Text)
    }
}
