//! `kickdrift simulate`: Algorithm 1 run, and its growth beside the predicted one.

use std::path::PathBuf;

use super::args::{Columns, Common};
use super::paper::Paper;
use super::system::{arrays, source};
use documents::format::Format;
use documents::question::{Displacement, Question, Simulate, Work, flag};
use number::error::Result;
use systems::avi::Ends;

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/fpu.json.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Synchronization periods to run.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = flag::<u32>)]
    periods: u32,
    /// The starting displacement of each degree of freedom, as 1/10,0,0; one number moves the first alone.
    #[arg(long, value_name = "X", default_value = "1/10", allow_hyphen_values = true, value_parser = flag::<Displacement>)]
    displace: Displacement,
    /// Algorithm 1 as printed: whole kicks at the start of a period, none at its end [default: half a kick at
    /// both]
    #[arg(long)]
    staggered: bool,
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
        let (system, arrays) = (source(&self.file)?, arrays(&self.file));
        let asked = Simulate {
            file: self.file.file_name().unwrap_or_default().to_string_lossy().into(),
            title: None,
            system,
            periods: self.periods,
            displace: self.displace.clone(),
            form: if self.staggered { Ends::Staggered } else { Ends::Symmetric },
        };
        let work = Work { arrays: Some(&arrays), ..common.work() };
        let answer = asked.answer(&work)?;
        if let Some((path, figure)) = self.figure.as_ref().zip(asked.figure(&answer, &work)?) {
            self.paper.draw("figure", path, figure, common)?;
        }
        common.write(&self.columns.of(asked.document(&answer))?, Format::Text)
    }
}
