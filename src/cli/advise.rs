//! `kickdrift advise`: which steps are safe, for how long, and why.

use std::path::{Path, PathBuf};

use super::args::{Common, Details};
use super::paper::Paper;
use super::system::{arrays, source};
use documents::format::Format;
use documents::question::{Advise, Question, Safe, Work};
use number::{Error, Result, file};

/// Flags of `advise`.
///
/// --output FILE.svg, FILE.pdf or FILE.png draws: the outer step across, each mode a row.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Hessians in place of periods: a system file of any number of steps, or FILE.npz.
    ///
    /// The file's steps are the first scheme; an archive holds fast, slow (mass-weighted, 1/ps^2), masses and
    /// positions.
    #[arg(id = "file", value_name = "FILE", conflicts_with_all = ["period", "bond", "on"])]
    path: Option<PathBuf>,
    #[command(flatten)]
    asked: Advise,
    /// An input of OpenMM, LAMMPS, GROMACS, NAMD, Tinker or i-PI, or a log, for its steps; twice with an
    /// OpenMM system
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    engine: Vec<PathBuf>,
    /// Draws what would let the step grow, a bar a row: FILE.svg, .pdf or .png.
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, conflicts_with = "no_levers")]
    levers: Option<PathBuf>,
    /// Exit with 1 if a step asked about is advised against or not proven stable for all periods in the band.
    #[arg(long)]
    exit_code: bool,
    #[command(flatten)]
    details: Details,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        self.paper.check(format.is_figure() || self.levers.is_some())?;
        let (asked, arrays) = (self.asked()?, self.path.as_ref().map(|path| arrays(path)));
        let work = Work { arrays: arrays.as_ref(), ..common.work() };
        let answer = asked.answer(&work)?;
        let code = if self.exit_code { Self::code(&answer.safe)? } else { 0 };
        let document = self.details.of(asked.document(&answer), format, common)?;
        let figure = if format.is_figure() { asked.figure(&answer, &work)? } else { None };
        self.paper.write_answer(figure, &document, format, common)?;
        if let Some(path) = &self.levers {
            let figure = asked.levers_figure(&answer).ok_or_else(|| {
                Error::input("levers", path.display(), "there is no lever to draw: the answer says why")
            })?;
            self.paper.draw("levers", path, figure, common)?;
        }
        common.tell_beside_output(&document)?;
        Ok(code)
    }

    /// 0 or 1.
    fn code(safe: &Safe) -> Result<u8> {
        let none = || {
            Error::missing(
                "steps",
                "no steps are asked about: add --steps, or --engine with an input that has them",
            )
        };
        safe.is_proven().map(|proven| u8::from(!proven)).ok_or_else(none)
    }

    /// With the texts of the engine's files, and the system.
    fn asked(&self) -> Result<Advise> {
        let mut asked = self.asked.clone();
        asked.engine = self.engine.iter().map(|path| text(path)).collect::<Result<_>>()?;
        if let Some(path) = &self.path {
            asked.file = Some(path.file_name().unwrap_or_default().to_string_lossy().into());
            let archive = path.extension().is_some_and(|extension| extension == "npz");
            asked.system = if archive { None } else { Some(source(path)?.1) };
        }
        Ok(asked)
    }
}

fn text(path: &Path) -> Result<String> {
    file::any_text(path, file::LONGEST).map_err(|cause| {
        Error::io(path.display(), format!("cannot read it ({cause}): name an engine's input"))
            .caused_by(cause)
    })
}
