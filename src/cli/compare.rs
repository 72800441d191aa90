//! `kickdrift compare`: the trace against the predictions, over a grid or over ratios.

use super::args::{self, Columns, Common};
use crate::error::Result;
use crate::format::Format;
use crate::number::Laurent;
use crate::number::Rational;
use crate::question::{Compare, Question, flag};

/// Flags of `compare`: either a grid with both stiffnesses, or --max-sum with --rho.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The stiffness of the fast force (with a grid).
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    lambda1: Option<Laurent>,
    /// The stiffness of the slow force (with a grid).
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    lambda2: Option<Laurent>,
    #[command(flatten)]
    grid: args::Grid,
    /// Instead of a grid: all coprime p + q up to this number.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = flag::<u64>)]
    max_sum: Option<u64>,
    /// lambda2/lambda1, with --max-sum.
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = flag::<Rational>)]
    rho: Option<Rational>,
    /// With --max-sum: the values of s = h1^2 lambda1, evenly spaced inside 0 < s < 4.
    #[arg(long, value_name = "K", default_value_t = 99, allow_negative_numbers = true, value_parser = flag::<u64>)]
    samples: u64,
    /// How near q h2 must be to a multiple of T1/2 to count as resonant, in units of T1/2.
    #[arg(long, value_name = "T", default_value = "1/20", allow_hyphen_values = true, value_parser = flag::<Rational>)]
    tolerance: Rational,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let document = self.question()?.ask(&common.work())?;
        common.write(&self.columns.of(document)?, Format::Text)
    }

    fn question(&self) -> Result<Compare> {
        let tolerance = self.tolerance.clone();
        match (&self.lambda1, &self.lambda2, self.max_sum, &self.rho) {
            (Some(lambda1), Some(lambda2), None, None) => {
                Ok(Compare::over_grid(self.grid.map(lambda1, lambda2)?, tolerance))
            }
            (None, None, Some(max_sum), Some(rho)) if self.grid.is_absent() => {
                Ok(Compare::over_ratios(max_sum, rho.clone(), self.samples, tolerance))
            }
            _ => Err(Compare::mixed()),
        }
    }
}
