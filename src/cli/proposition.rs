//! `kickdrift proposition`: the exhaustive exact check.

use super::args::{Common, whole};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::report::document::Document;
use crate::report::proposition;
use crate::resonance::proposition::check;

/// Flags of `proposition`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// All coprime p, q up to this number.
    #[arg(long, value_name = "N", default_value_t = 60, allow_negative_numbers = true, value_parser = whole::<u64>)]
    max: u64,
}

/// Beyond this the witnesses alone would fill gigabytes.
const LARGEST_MAX: u64 = 400;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        common.write(&document(self.max)?, Format::Text)
    }
}

/// The check and all witnesses for p, q ≤ max.
pub fn document(max: u64) -> Result<Document> {
    check_bound(max)?;
    let mut witnesses = Vec::new();
    let check = check(max, |w| witnesses.push(*w));
    Ok(proposition::document(max, &check, &witnesses))
}

/// That the check is worth its cost.
pub fn check_bound(max: u64) -> Result<()> {
    if max == 0 || max > LARGEST_MAX {
        return Err(Error::input(
            "max",
            max,
            format!("choose 1 to {LARGEST_MAX}; the number of witnesses grows like its cube"),
        ));
    }
    Ok(())
}
