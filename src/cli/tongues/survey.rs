//! The survey of all ratios up to a sum.

use crate::cli::args::Common;
use crate::cli::ratios::Ratios;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Rational;
use crate::report::document::Document;
use crate::report::survey;
use crate::tongue::{self, Stiffness};

/// Thin tongues listed unless a number is given, and at most.
pub const THINNEST: usize = 10;
const MOST_THIN: usize = 100_000;

/// Computes and writes a survey.
///
/// # Errors
/// One ratio only, ρ ≤ 0, more thin tongues than are listed.
pub fn run(
    ratios: Ratios,
    stiffness: &Stiffness,
    thinnest: Option<usize>,
    common: &Common,
    format: Format,
) -> Result<()> {
    let Ratios::UpTo(max_sum) = ratios else {
        return Err(Error::missing("max-sum", "a survey is of many ratios: give --max-sum N"));
    };
    common.write(&document(max_sum, &stiffness.rho, thinnest.unwrap_or(THINNEST))?, format)
}

/// The survey as a document.
///
/// # Errors
/// As [`tongue::survey`], and a number of thin tongues that is out of range.
pub fn document(max_sum: u64, rho: &Rational, thinnest: usize) -> Result<Document> {
    if thinnest > MOST_THIN {
        return Err(Error::input("thinnest", thinnest, format!("choose at most {MOST_THIN}")));
    }
    Ok(survey::document(&tongue::survey(max_sum, rho, thinnest)?))
}
