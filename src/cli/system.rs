//! `kickdrift system`: many clocks, many degrees of freedom.

use std::path::{Path, PathBuf};

use super::args::{Columns, Common, from_str};
use super::paper::Paper;
use documents::format::Format;
use documents::input::{Arrays, Axis, Span, SystemFile};
use documents::question::{Found, Question, System, Work, flag};
use documents::report::system::Colouring;
use number::Rational;
use number::error::{Error, Result};
use number::file;
use systems::levels::Method;
use systems::{Holds, Route};

/// Flags of `system`.
///
/// --output FILE.svg, FILE.pdf or FILE.png draws: the multipliers and the shapes of the growing modes, the
/// map of --scan, or the growth over the intervals of --intervals. FILE.xyz and FILE.vtu hold the growing
/// modes in space, for viewers of molecules and meshes.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/diatomic-tether.json.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The verdicts over a number of the file, as potentials.1.step=1/10..2:1/20; give it twice for a map
    #[arg(long, value_name = "PATH=LO..HI:BY", allow_hyphen_values = true, value_parser = from_str::<Axis>)]
    scan: Vec<Axis>,
    /// What the colours of a map stand for [default: growth].
    #[arg(long, value_name = "WHAT")]
    colour: Option<Colouring>,
    /// Decide in exact arithmetic; where it exceeds --budget (products of machine words) the error states its
    /// cost.
    #[arg(long)]
    exact: bool,
    /// How well measured stiffnesses (by reference to NumPy's files) are known, relative to their norms
    /// [default: 1e-6].
    #[arg(long, value_name = "X", value_parser = flag::<f64>)]
    accuracy: Option<f64>,
    /// The integrator of two measured levels: respa, implicit-explicit, impulse, molly-short, ... [default:
    /// the file's].
    #[arg(long, value_name = "NAME", value_parser = from_str::<Method>)]
    method: Option<Method>,
    /// Unstable intervals of a number of the file: outer (all steps, or one of them), a scale, a stiffness, a
    /// spring, a mass
    #[arg(long, value_name = "PATH=LO..HI", conflicts_with_all = ["scan", "exact"], value_parser = from_str::<Span>)]
    intervals: Option<Span>,
    /// With the verdict: the unstable intervals of the outer step next to this one, from half of it to twice
    /// it
    #[arg(long, conflicts_with_all = ["scan", "intervals", "friction"])]
    nearest: bool,
    /// The relative width above which no interval is missed, of --intervals and --nearest [default: 1e-4].
    #[arg(long, value_name = "W", value_parser = flag::<f64>)]
    resolution: Option<f64>,
    /// Friction per unit time, as BAOAB has it: halfway through a drift over t, v becomes v exp(-G t). Does
    /// it stop the growth?
    #[arg(long, value_name = "G", value_parser = flag::<Rational>, conflicts_with_all = ["scan", "intervals"])]
    friction: Option<Rational>,
    /// Exit with 0 if stable, 1 if unstable, both proven; with --quiet and without --output that is all the
    /// answer.
    #[arg(long, conflicts_with_all = ["scan", "intervals", "friction"])]
    exit_code: bool,
    /// Leave the rigid motions of measured stiffnesses in.
    #[arg(long)]
    keep_rigid: bool,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        let form = common.format(&Format::SYSTEM, Format::Text)?;
        let drawing = common.output.as_deref().filter(|_| form.is_figure());
        if Format::MODES.contains(&form) && (!self.scan.is_empty() || self.intervals.is_some()) {
            let remedy = "holds the modes of one verdict: leave --scan and --intervals out";
            return Err(Error::input("output", form.name(), remedy));
        }
        // Refused before the work, not after it.
        self.paper.check(drawing.is_some())?;
        let (system, arrays) = (source(&self.file)?, arrays(&self.file));
        let asked = self.asked(system)?;
        let work = Work { arrays: Some(&arrays), ..common.work() };
        if self.exit_code && common.quiet && common.output.is_none() {
            let (scene, limits) = (asked.scene(&work)?, work.products());
            return self.code(match asked.route() {
                Route::Exact => scene.model().decide(Route::Exact, &limits)?.holds(),
                Route::Cheapest => scene.model().verdict(0.0, &limits)?,
            });
        }
        let answer = asked.answer(&work)?;
        match drawing {
            None if Format::MODES.contains(&form) => {
                common.write_text(&asked.in_space(&answer, form)?)?;
                common.tell_beside_output(&asked.document(&answer))?;
            }
            Some(path) => {
                let figure = asked.drawn(&answer, self.colour.unwrap_or_default(), &work)?;
                self.paper.draw("output", path, figure, common)?;
            }
            None => {
                let format = match &answer.found {
                    Found::Map(_) => common.format_of_table(&Format::DOCUMENT)?,
                    _ => Format::Text,
                };
                common.write(&self.columns.of(asked.document(&answer))?, format)?;
            }
        }
        match &answer.found {
            Found::Verdict(verdict) if self.exit_code => self.code(verdict.analysis.holds()),
            _ => Ok(0),
        }
    }

    /// 0 or 1.
    fn code(&self, holds: Holds) -> Result<u8> {
        let remedy = "doubles do not prove whether it is stable: choose another step, or --exact if its stiffnesses are dense and written without pi";
        let stable = holds.is_stable().ok_or_else(|| Error::input("file", self.file.display(), remedy))?;
        Ok(u8::from(!stable))
    }

    fn asked(&self, system: SystemFile) -> Result<System> {
        if let Some(width) = self.resolution.filter(|_| !self.nearest && self.intervals.is_none()) {
            let remedy = "is the width of intervals: add --intervals PATH=LO..HI or --nearest";
            return Err(Error::input("--resolution", width, remedy));
        }
        if self.colour.is_some() && self.scan.is_empty() {
            return Err(Error::input("--colour", "given", "is for maps: add --scan twice"));
        }
        let [scan_x, scan_y] = match self.scan.as_slice() {
            [] => [None, None],
            [x] => [Some(x.clone()), None],
            [x, y] => [Some(x.clone()), Some(y.clone())],
            more => {
                let given = format!("given {} times", more.len());
                return Err(Error::input("--scan", given, "a map has two axes: give --scan once or twice"));
            }
        };
        Ok(System {
            file: self.file.file_name().unwrap_or_default().to_string_lossy().into(),
            title: None,
            system,
            exact: self.exact,
            keep_rigid: self.keep_rigid,
            friction: self.friction.clone(),
            accuracy: self.accuracy,
            method: self.method,
            scan_x,
            scan_y,
            intervals: self.intervals.clone(),
            nearest: self.nearest,
            width: self.resolution,
        })
    }
}

fn text(path: &Path) -> Result<String> {
    file::text(path, file::LONGEST).map_err(|cause| {
        let remedy = "name a system file, such as data/scenes/diatomic-tether.json";
        Error::io(path.display(), format!("cannot read the system ({cause}): {remedy}")).caused_by(cause)
    })
}

/// A system file.
pub fn source(path: &Path) -> Result<SystemFile> {
    SystemFile::of_text(&text(path)?)
}

/// Where the arrays are that a file refers to.
pub fn arrays(path: &Path) -> Arrays {
    Arrays::from(path.parent().unwrap_or(Path::new("")))
}
