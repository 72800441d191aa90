//! `kickdrift bands`: sectors of steps in which every ratio is unstable.

use super::args::{Columns, Common};
use super::paper::Paper;
use documents::format::Format;
use documents::question::{Bands, Question};
use documents::report::bands;
use number::error::Result;

/// Flags of `bands`: the question, its table, its figure.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: Bands,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::DOCUMENT_OR_FIGURE)?;
        let draws = Format::FIGURE.contains(&format);
        self.paper.check(draws)?;
        let answer = self.question.answer(&common.work())?;
        if draws {
            return self.paper.write(bands::figure(&answer), format, common.output.as_deref(), common);
        }
        common.write(&self.columns.of(self.question.document(&answer))?, format)
    }
}
