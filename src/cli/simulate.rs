//! `kickdrift simulate`: Algorithm 1 run, and its growth beside the predicted one.

use std::path::PathBuf;

use super::args::{Columns, Common};
use super::paper::Paper;
use super::system::source;
use documents::format::Format;
use documents::question::{Question, Simulate, Work};
use number::Result;

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/fpu.json.
    #[arg(id = "file", value_name = "FILE")]
    path: PathBuf,
    #[command(flatten)]
    question: Simulate,
    /// Also draw energy, momentum and amplitude: FILE.svg, FILE.pdf or FILE.png.
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        self.paper.check(self.figure.is_some())?;
        self.figure.as_ref().map_or(Ok(()), |path| common.apart_from_output("figure", path))?;
        let (file, system, arrays) = source(&self.path)?;
        let asked = Simulate { file, system, ..self.question.clone() };
        let work = Work { arrays: Some(&arrays), ..common.work() };
        let answer = asked.answer(&work)?;
        if let Some((path, figure)) = self.figure.as_ref().zip(asked.figure(&answer, &work)?) {
            self.paper.draw("figure", path, figure, common)?;
        }
        common.write(&self.columns.of(asked.document(&answer))?, Format::Text)
    }
}
