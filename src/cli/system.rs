//! `kickdrift system`: many clocks, many degrees of freedom.

use std::path::{Path, PathBuf};

use super::args::{Columns, Common, Details};
use super::paper::Paper;
use documents::format::Format;
use documents::input::{Arrays, Axis, SystemFile};
use documents::question::{Question, System, SystemFound, Work, flag};
use documents::report::system::Colouring;
use number::{Error, Result, file};
use systems::{Holds, Route};

/// Flags of `system`.
///
/// --output FILE.svg, FILE.pdf or FILE.png draws: the multipliers and the shapes of the growing modes, the
/// map of --scan, or the growth over the intervals of --intervals. FILE.xyz and FILE.vtu hold the growing
/// modes in space, for viewers of molecules and meshes.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/diatomic-tether.json.
    #[arg(id = "file", value_name = "FILE")]
    path: PathBuf,
    #[command(flatten)]
    question: System,
    /// The verdicts over a number of the file, as potentials.1.step=1/10..2:1/20; give it twice for a map
    #[arg(long, value_name = "PATH=LO..HI:BY", allow_hyphen_values = true, conflicts_with_all = ["intervals", "nearest", "friction"], value_parser = flag::<Axis>)]
    scan: Vec<Axis>,
    /// What the colours of a map stand for [default: growth].
    #[arg(long, value_name = "WHAT")]
    colour: Option<Colouring>,
    /// Exit with 0 if stable, 1 if unstable, both proven; with --quiet and without --output that is all the
    /// answer.
    #[arg(long, conflicts_with_all = ["scan", "intervals", "friction"])]
    exit_code: bool,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    details: Details,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        let form = common.format(&Format::SYSTEM, Format::Text)?;
        if Format::MODES.contains(&form) && (!self.scan.is_empty() || self.question.intervals.is_some()) {
            let remedy = "holds the modes of one verdict: leave --scan and --intervals out";
            return Err(Error::input("output", form.name(), remedy));
        }
        // Refused before the work, not after it.
        self.paper.check(form.is_figure())?;
        let (file, system, arrays) = source(&self.path)?;
        let asked = System { file, system, ..self.asked()? };
        let work = Work { arrays: Some(&arrays), ..common.work() };
        if self.exit_code && common.quiet && common.output.is_none() {
            let (scene, limits) = (asked.scene(&work)?, work.products());
            return self.code(match asked.route() {
                Route::Exact => scene.model().decide(Route::Exact, &limits)?.holds(),
                Route::Cheapest => scene.model().verdict(0.0, &limits)?,
            });
        }
        let answer = asked.answer(&work)?;
        if Format::MODES.contains(&form) {
            common.write_text(&asked.in_space(&answer, form)?)?;
            common.tell_beside_output(&self.details.of(asked.document(&answer), form, common)?)?;
        } else if form.is_figure() {
            let figure = asked.drawn(&answer, self.colour.unwrap_or_default(), &work)?;
            self.paper.write(figure, form, common.output.as_deref(), common)?;
        } else {
            let format = match &answer.found {
                SystemFound::Map(_) => common.format_of_table(&Format::DOCUMENT)?,
                _ => form,
            };
            let document = self.columns.of(asked.document(&answer))?;
            common.write(&self.details.of(document, format, common)?, format)?;
        }
        match &answer.found {
            SystemFound::Verdict(verdict) if self.exit_code => self.code(verdict.analysis.holds()),
            _ => Ok(0),
        }
    }

    /// 0 or 1.
    fn code(&self, holds: Holds) -> Result<u8> {
        let remedy = "doubles do not prove whether it is stable: choose another step, or --exact if its stiffnesses are dense and written without pi";
        let stable = holds.is_stable().ok_or_else(|| Error::input("file", self.path.display(), remedy))?;
        Ok(u8::from(!stable))
    }

    /// The question without its system.
    fn asked(&self) -> Result<System> {
        let asked = self.question.clone();
        if let Some(width) = asked.width.filter(|_| asked.width().is_none()) {
            let remedy = "is the width of intervals: add --intervals PATH=LO..HI or --nearest";
            return Err(Error::input("--resolution", width, remedy));
        }
        if self.colour.is_some() && self.scan.is_empty() {
            return Err(Error::input("--colour", "given", "is for maps: add --scan twice"));
        }
        if self.scan.len() > 2 {
            let given = format!("given {} times", self.scan.len());
            return Err(Error::input("--scan", given, "a map has two axes: give --scan once or twice"));
        }
        let axis = |place: usize| self.scan.get(place).cloned();
        Ok(System { scan_x: axis(0), scan_y: axis(1), ..asked })
    }
}

fn text(path: &Path) -> Result<String> {
    file::text(path, file::LONGEST).map_err(|cause| {
        let remedy = "name a system file, such as data/scenes/diatomic-tether.json";
        Error::io(path.display(), format!("cannot read the system ({cause}): {remedy}")).caused_by(cause)
    })
}

/// A system file: its name, the system, and where the arrays are that it refers to.
pub fn source(path: &Path) -> Result<(String, SystemFile, Arrays)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into();
    Ok((name, SystemFile::of_text(&text(path)?)?, arrays(path)))
}

/// Where the arrays are that a file refers to.
pub fn arrays(path: &Path) -> Arrays {
    Arrays::from(path.parent().unwrap_or(Path::new("")))
}
