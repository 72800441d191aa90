//! `kickdrift polynomial`: the half period of one ratio in s and rho.

use super::args::{Common, of};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Ratio;
use crate::number::parse::parse_ratio;
use crate::report::polynomial;

/// Flags of `polynomial`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// h2/h1 = p/q.
    #[arg(long, value_name = "P/Q", allow_hyphen_values = true, value_parser = of(parse_ratio))]
    ratio: Ratio,
}

/// The largest p + q unless a budget says otherwise: the entries have about p q/4 terms, with coefficients of
/// some p + q digits.
const MOST_KICKS: u64 = 120;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        check(self.ratio, common.budget)?;
        common.write(&polynomial::document(self.ratio), Format::Text)
    }
}

/// That the polynomials are worth their cost, or allowed by a budget.
pub fn check(ratio: Ratio, budget: Option<u64>) -> Result<()> {
    let most = budget.unwrap_or(MOST_KICKS);
    let kicks = ratio.kicks();
    if kicks <= most {
        return Ok(());
    }
    let terms = u128::from(ratio.p()) * u128::from(ratio.q()) / 4 + 1;
    let cost = format!("polynomials of {ratio} have about {terms} terms each");
    Err(Error::budget(cost, kicks).or(format!("choose p + q <= {most}")))
}
