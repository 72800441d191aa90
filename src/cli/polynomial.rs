//! `kickdrift polynomial`: the half period of one ratio in s and rho.

use super::args::{Common, Format};
use crate::error::{Error, Result};
use crate::number::parse::parse_ratio;
use crate::report::polynomial;

/// Flags of `polynomial`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// h2/h1 = p/q.
    #[arg(long, value_name = "P/Q", allow_hyphen_values = true)]
    ratio: String,
}

/// The largest p + q unless a budget says otherwise: the entries have about p q/4 terms, with coefficients of
/// some p + q digits.
const MOST_KICKS: u64 = 120;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let (p, q) = parse_ratio("ratio", &self.ratio)?;
        check(p, q, common.budget)?;
        common.write(&polynomial::document(p, q), Format::Text)
    }
}

/// The default bound for scenes.
pub fn check_default(p: u64, q: u64) -> Result<()> {
    check(p, q, None)
}

/// That the polynomials are worth their cost, or allowed by a budget.
pub fn check(p: u64, q: u64, budget: Option<u64>) -> Result<()> {
    let most = budget.unwrap_or(MOST_KICKS);
    let kicks = p.saturating_add(q);
    if kicks <= most {
        return Ok(());
    }
    let terms = u128::from(p) * u128::from(q) / 4 + 1;
    let cost = format!("polynomials of {p}/{q} have about {terms} terms each");
    Err(Error::budget(cost, kicks).or(format!("choose p + q <= {most}")))
}
