//! `kickdrift aperture`: how hot a bond may be at each step.

use super::args::{Columns, Common};
use super::paper::Paper;
use documents::format::Format;
use documents::question::{Aperture, Question};
use number::error::Result;

/// Flags of `aperture`: the question, its table, its figure.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: Aperture,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        let draws = Format::FIGURE.contains(&format);
        self.paper.check(draws)?;
        let work = common.work();
        let answer = self.question.answer(&work)?;
        match self.question.figure(&answer, &work)?.filter(|_| draws) {
            Some(figure) => self.paper.write(figure, format, common.output.as_deref(), common),
            None => common.write(&self.columns.of(self.question.document(&answer))?, format),
        }
    }
}
