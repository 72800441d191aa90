//! `kickdrift compare`: the trace against the predictions, over a grid or over ratios.

use super::args::{Columns, Common, Details, Spacing};
use super::asked::Flags;
use super::paper::Paper;
use documents::format::Format;
use documents::question::{Compare, CompareMethods, Question};
use number::Result;

/// Flags of `compare`: of the trace against its predictions, or of integrators side by side.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    asked: Flags<Compare>,
    #[command(flatten)]
    methods: Flags<CompareMethods>,
    // Behind those who read it: whoever takes a flag by its type leaves none.
    #[command(flatten)]
    spacing: Spacing,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    details: Details,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if self.methods.has("methods") {
            return self.side_by_side(&self.methods.question()?, common);
        }
        self.paper.check(false)?;
        let format = common.format(&Format::DOCUMENT, Format::Text)?;
        let document = self.columns.of(self.asked.question()?.ask(&common.work())?)?;
        common.write(&self.details.of(document, format, common)?, format)
    }

    /// The table, or the maps drawn.
    fn side_by_side(&self, asked: &CompareMethods, common: &Common) -> Result<()> {
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        self.paper.check(format.is_figure())?;
        let work = common.work();
        let answer = asked.answer(&work)?;
        let document = self.details.of(self.columns.of(asked.document(&answer))?, format, common)?;
        let figure = if format.is_figure() { asked.figure(&answer, &work)? } else { None };
        self.paper.write_answer(figure, &document, format, common)?;
        common.tell_beside_output(&document)
    }
}
