//! `kickdrift simulate`: Algorithm 1 run, and its growth beside the predicted one.

use std::path::PathBuf;

use plot::Foot;

use super::args::{Columns, Common};
use super::paper::Paper;
use super::system::{limits, read};
use crate::avi::Ends;
use crate::error::Result;
use crate::format::Format;
use crate::question::flag;
use crate::report::simulate as report;
use crate::scene::{Displacement, RunRequest};

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/fpu.json.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Synchronization periods to run.
    #[arg(long, value_name = "N", default_value_t = 200, allow_negative_numbers = true, value_parser = flag::<u32>)]
    periods: u32,
    /// The starting displacement of each degree of freedom, as 1/10,0,0; one number moves the first alone.
    #[arg(long, value_name = "X", default_value = "1/10", allow_hyphen_values = true)]
    displace: Displacement,
    /// Algorithm 1 as it stands: whole kicks at the start of a period, none at its end [default: halves at both]
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
        let (ends, form) =
            if self.staggered { (Ends::Staggered, "staggered") } else { (Ends::Symmetric, "symmetric") };
        let request = RunRequest { periods: self.periods, displacement: self.displace.clone(), ends };
        let scene = read(&self.file, common)?;
        let run = scene.run(&request, &limits(common))?;
        if let Some(path) = &self.figure {
            let foot = Foot::default()
                .words(scene.title())
                .value("periods", request.periods)
                .value("displaced by", &request.displacement)
                .words(form);
            let figure = report::figure(&run, scene.title()).footed(&foot);
            self.paper.draw(
                "figure",
                path,
                figure.in_units_of(scene.time_unit().unwrap_or("time")),
                common,
            )?;
        }
        let document = report::document(&run)
            .input("file", self.file.file_name().unwrap_or_default().to_string_lossy())
            .input("title", scene.title())
            .input_json("system", scene.source().clone())
            .input("periods", request.periods)
            .input("displace", &request.displacement)
            .input("form", form);
        common.write(&self.columns.of(document)?, Format::Text)
    }
}
