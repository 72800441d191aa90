//! `kickdrift polynomial`: the half period of one ratio in s and rho.

use super::args::{Common, of};
use super::request::Request;
use crate::error::Result;
use crate::format::Format;
use crate::number::Ratio;
use crate::number::parse::parse_ratio;

/// Flags of `polynomial`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// h2/h1 = p/q.
    #[arg(long, value_name = "P/Q", allow_hyphen_values = true, value_parser = of(parse_ratio))]
    ratio: Ratio,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let request = Request::Polynomial { ratio: self.ratio };
        common.write(&request.perform(common, true)?, Format::Text)
    }
}
