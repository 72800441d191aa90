//! `kickdrift word`: an integrator as its author writes it, and the catalogue.

use super::args::{Columns, Common};
use crate::error::Result;
use crate::format::Format;
use crate::question::{Methods, Question, Word};

/// Flags of `word`: the question, its table, or the catalogue in its place.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: Word,
    /// Shows the catalogue.
    #[arg(long, conflicts_with_all = ["word", "method", "lambda1", "lambda2", "h", "h_range"])]
    list: bool,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let work = common.work();
        let document = if self.list { Methods {}.ask(&work) } else { self.question.ask(&work) };
        common.write(&self.columns.of(document?)?, Format::Text)
    }
}
