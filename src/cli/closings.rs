//! `kickdrift closings`: where tongues close.

use super::args::Common;
use super::ratios::Flags;
use crate::error::Result;
use crate::format::Format;
use crate::number::Rational;
use crate::question::{Closings, DIGITS, Question, flag};
use crate::tongue::Labels;

/// Flags of `closings`: a ratio or all of them.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    which: Flags,
    /// Only these labels (with --ratio), as 4 or 1,3,7..9.
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = flag::<Labels>)]
    m: Option<Labels>,
    /// The closed range of rho = lambda2/lambda1, positive.
    #[arg(long, value_name = "LO..HI", default_value = "1/10000..100", allow_hyphen_values = true, value_parser = flag::<(Rational, Rational)>)]
    rho_range: (Rational, Rational),
    /// Values of rho, evenly spaced in ln rho, between which edges are seen to cross, where p + q > 24.
    #[arg(long, value_name = "N", default_value_t = 400, allow_negative_numbers = true, value_parser = flag::<usize>)]
    samples: usize,
    /// Significant digits of s and rho.
    #[arg(long, value_name = "N", default_value_t = DIGITS, allow_negative_numbers = true, value_parser = flag::<u32>)]
    digits: u32,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::DOCUMENT)?;
        let (ratio, max_sum) = self.which.ratios()?.fields();
        let (m, rho_range, samples, digits) =
            (self.m.clone(), self.rho_range.clone(), self.samples, self.digits);
        let question = Closings { ratio, max_sum, m, rho_range, samples, digits };
        common.write(&question.ask(&common.work())?, format)
    }
}
