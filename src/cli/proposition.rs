//! `kickdrift proposition`: the exhaustive exact check.

use super::args::{Columns, Common, whole};
use super::request::Request;
use crate::error::Result;
use crate::format::Format;

/// Flags of `proposition`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// All coprime p, q up to this number.
    #[arg(long, value_name = "N", default_value_t = 60, allow_negative_numbers = true, value_parser = whole::<u64>)]
    max: u64,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let request = Request::Proposition { max: self.max };
        common.write(&self.columns.of(request.perform(common, true)?)?, Format::Text)
    }
}
