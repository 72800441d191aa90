//! The survey of all ratios up to a sum.

use super::Stiffness;
use crate::cli::args::{Common, Format};
use crate::cli::map::Target;
use crate::cli::ratios::Ratios;
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::report::document::Document;
use crate::report::file::write_output;
use crate::report::survey;
use crate::tongue;

/// Thin tongues listed unless a number is given, and at most.
pub const THINNEST: usize = 10;
const MOST_THIN: usize = 100_000;

/// Computes and writes a survey.
///
/// # Errors
/// One ratio only, ρ ≤ 0, a format that a document does not have.
pub fn run(
    ratios: Ratios,
    stiffness: &Stiffness,
    thinnest: Option<usize>,
    common: &Common,
    target: Target,
) -> Result<()> {
    let Ratios::UpTo(max_sum) = ratios else {
        return Err(Error::missing("max-sum", "a survey is of many ratios: give --max-sum N"));
    };
    let format = match target {
        Target::Json => Format::Json,
        Target::Text => Format::Text,
        Target::Csv => Format::Csv,
        Target::Latex => Format::Latex,
        _ => return Err(Error::input("output", "a figure", "a survey is a document: json, txt, csv or tex")),
    };
    let document = document(max_sum, &stiffness.rho, thinnest.unwrap_or(THINNEST))?;
    write_output(common.output.as_deref(), document.render(format.into())?.as_bytes())
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
