//! `kickdrift system`: many clocks, many degrees of freedom.

use std::path::{Path, PathBuf};

use plot::{Figure, Foot};

use super::args::{Columns, Common, from_str};
use super::paper::Paper;
use super::progress::{announce, progress};
use crate::error::{Error, Kind, Result};
use crate::format::Format;
use crate::number::Rational;
use crate::question::flag;
use crate::report::document::Document;
use crate::report::system::{self as report, Beside, Colouring, SystemMap};
use crate::scene::{Arrays, Axis, Scan, Span, SystemScene, file};
use crate::system::scan::scan;
use crate::system::{Analysis, Holds, Limits, Route};

/// Flags of `system`.
///
/// --output FILE.svg, FILE.pdf or FILE.png draws: the multipliers and the shapes of the growing modes, the map of --scan, or the
/// growth over the intervals of --intervals.
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
    /// Decide in exact arithmetic; where it exceeds --budget (products of machine words) the error states its cost.
    #[arg(long)]
    exact: bool,
    /// How well measured stiffnesses (by reference to NumPy's files) are known, relative to their norms [default: 1e-6].
    #[arg(long, value_name = "X")]
    accuracy: Option<f64>,
    /// Unstable intervals of a number of the file: outer (all steps, or one of them), a scale, a stiffness, a spring, a mass
    #[arg(long, value_name = "PATH=LO..HI", conflicts_with_all = ["scan", "exact"], value_parser = from_str::<Span>)]
    intervals: Option<Span>,
    /// With the verdict: the unstable intervals of the outer step next to this one, from half of it to twice it
    #[arg(long, conflicts_with_all = ["scan", "intervals", "friction"])]
    nearest: bool,
    /// The relative width above which no interval is missed, of --intervals and --nearest [default: 1e-4].
    #[arg(long, value_name = "W")]
    resolution: Option<f64>,
    /// Friction per unit time, v times exp(-G t) amid every drift between any two kicks (BAOAB): is it enough?
    #[arg(long, value_name = "G", value_parser = flag::<Rational>, conflicts_with_all = ["scan", "intervals"])]
    friction: Option<Rational>,
    /// Exit with 0 if stable, 1 if unstable, both proven; with --quiet and without --output that is all the answer.
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
        // Refused before the work, not after it.
        self.paper.check(drawing(common)?.is_some())?;
        let (text, arrays) = source(&self.file, common)?;
        let scene = SystemScene::read_in(arrays, &text)?;
        let scene = scene.asked(self.accuracy, self.keep_rigid, self.friction.as_ref())?;
        if let Some(span) = &self.intervals {
            return self.intervals(&scene, span, common).map(|()| 0);
        }
        if let Some(width) = self.resolution.filter(|_| !self.nearest) {
            let remedy = "is the width of intervals: add --intervals PATH=LO..HI or --nearest";
            return Err(Error::input("--resolution", width, remedy));
        }
        match self.scan.as_slice() {
            [] if self.colour.is_some() => {
                Err(Error::input("--colour", "given", "is for maps: add --scan twice"))
            }
            [] if self.exit_code => self.exit_code(&scene, common),
            [] => self.verdict(&scene, common).map(|_| 0),
            [x] | [x, _] => {
                let axes = Scan::new(scene.clone(), x.clone(), self.scan.get(1).cloned())?;
                self.map(&scene, &axes, common).map(|()| 0)
            }
            other => {
                Err(Error::input("--scan", format!("given {} times", other.len()), "a map has two axes"))
            }
        }
    }

    fn route(&self) -> Route {
        if self.exact { Route::Exact } else { Route::Cheapest }
    }

    fn width(&self) -> f64 {
        self.resolution.unwrap_or(1e-4)
    }

    fn intervals(&self, scene: &SystemScene, span: &Span, common: &Common) -> Result<()> {
        let (width, limits) = (self.width(), limits(common));
        let found = scene.intervals(span, width, &limits)?;
        if let Some(path) = drawing(common)? {
            let rates = scene.growth_rates(span, &report::sampled(&found.stretches), &limits)?;
            let foot = Foot::default().words(&span.to_string());
            let figure =
                report::intervals_figure(&found, &rates, scene.title(), &scene.number(&found.number));
            return self.draw(scene, path, figure, foot, common);
        }
        let document = report::intervals(&found).input("intervals", span).input("width", width);
        common.write(&self.columns.of(self.echo(document, scene))?, Format::Text)
    }

    /// 0 or 1; nothing but the verdict is computed where nothing is shown.
    fn exit_code(&self, scene: &SystemScene, common: &Common) -> Result<u8> {
        let silent = common.quiet && common.output.is_none();
        let holds = if silent {
            scene.model().verdict(self.route(), &limits(common))?
        } else {
            self.verdict(scene, common)?.holds()
        };
        match holds {
            Holds::Stable => Ok(0),
            Holds::Unstable => Ok(1),
            Holds::NotTold => {
                let remedy = "doubles do not prove whether it is stable: decide it with --exact";
                Err(Error::input("file", self.file.display(), remedy))
            }
        }
    }

    fn verdict(&self, scene: &SystemScene, common: &Common) -> Result<Analysis> {
        let words = format!("a verdict on {} degrees of freedom", scene.model().size());
        announce(common.quiet, &words, scene.model().seconds());
        let analysis = scene.model().decide(self.route(), &limits(common))?;
        match drawing(common)? {
            Some(path) => {
                self.draw(scene, path, report::figure(&analysis, scene.title()), Foot::default(), common)?
            }
            None => {
                let limits = limits(common);
                let friction = scene.friction(&limits)?;
                let (orbit, is_orbit_missing) = match scene.own_orbit(&limits) {
                    Err(error) if error.kind() == Kind::Input => (None, true),
                    found => (found?, false),
                };
                let nearest =
                    self.nearest.then(|| scene.nearest_unstable(self.width(), &limits)).transpose()?;
                let (friction, orbit, nearest) = (friction.as_ref(), orbit.as_ref(), nearest.as_ref());
                let (unit, labels) = (scene.time_unit(), scene.labels());
                let beside = Beside { unit, friction, orbit, is_orbit_missing, labels, nearest };
                let document = self.echo(report::document(&analysis, &beside), scene);
                let document = match self.nearest {
                    true => document.input("nearest", "true").input("width", self.width()),
                    false => document,
                };
                common.write(&self.columns.of(document)?, Format::Text)?;
            }
        }
        Ok(analysis)
    }

    fn map(&self, scene: &SystemScene, axes: &Scan, common: &Common) -> Result<()> {
        let (xs, ys, limits) = (axes.x.values(), axes.ys(), limits(common));
        let bar = progress(common.quiet, (xs.len() * ys.len()) as u64, "points");
        let decide = |x: &_, y: &_| axes.at(x, y)?.model().decide(self.route(), &limits);
        let points = scan(&xs, &ys, decide, |done| bar.inc(done as u64));
        bar.finish_and_clear();
        let time_unit = scene.time_unit().map(String::from);
        let map = SystemMap { names: axes.names(), xs, ys, points: points?, time_unit };
        if let Some(path) = drawing(common)? {
            let numbers: Vec<_> = map.names.iter().map(|path| scene.number(path)).collect();
            let ranges = Foot::default().words(&axes.x.to_string());
            let ranges = axes.y.iter().fold(ranges, |foot, axis| foot.words(&axis.to_string()));
            return self.draw(
                scene,
                path,
                map.figure(self.colour.unwrap_or_default(), scene.title(), &numbers),
                ranges,
                common,
            );
        }
        let document = self.echo(map.document(), scene).input("scan_x", &axes.x);
        let document = match &axes.y {
            Some(y) => document.input("scan_y", y),
            None => document,
        };
        common.write(&self.columns.of(document)?, common.format_of_table(&Format::DOCUMENT)?)
    }

    /// In the system's unit of time, and with its title and what was varied below.
    fn draw(
        &self,
        scene: &SystemScene,
        path: &Path,
        figure: Figure,
        varied: Foot,
        common: &Common,
    ) -> Result<()> {
        let foot = Foot::default().words(scene.title()).part(varied.to_string());
        let figure = figure.in_units_of(scene.time_unit().unwrap_or("time")).footed(&foot);
        self.paper.draw("output", path, figure, common)
    }

    fn echo(&self, document: Document, scene: &SystemScene) -> Document {
        let document = document
            .input("file", self.file.file_name().unwrap_or_default().to_string_lossy())
            .input("title", scene.title())
            .input_json("system", scene.source().clone());
        let document = if self.exact { document.input("exact", "true") } else { document };
        let document = if self.keep_rigid { document.input("keep_rigid", "true") } else { document };
        let document = match &self.friction {
            Some(rate) => document.input("friction", rate),
            None => document,
        };
        self.accuracy.map_or(document.clone(), |accuracy| document.input("accuracy", accuracy))
    }
}

pub fn limits(common: &Common) -> Limits {
    common.budget.map_or_else(Limits::default, |products| Limits { products, ..Limits::default() })
}

/// The file to draw, where the output is one.
fn drawing(common: &Common) -> Result<Option<&Path>> {
    let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
    Ok(common.output.as_deref().filter(|_| format.is_figure()))
}

fn text(path: &Path) -> Result<String> {
    file::text(path, file::LONGEST).map_err(|cause| {
        let remedy = "name a system file, such as data/scenes/diatomic-tether.json";
        Error::io(path.display(), format!("cannot read the system ({cause}): {remedy}")).caused_by(cause)
    })
}

/// The text of a system file and where the arrays are that it refers to; or what the host holds in its place.
fn source(path: &Path, common: &Common) -> Result<(String, Arrays)> {
    match &common.held {
        Some(held) => Ok((held.text.clone(), held.arrays.clone())),
        None => Ok((text(path)?, folder(path))),
    }
}

/// Where the arrays are that a file refers to.
pub fn arrays(path: &Path, common: &Common) -> Arrays {
    common.held.as_ref().map_or_else(|| folder(path), |held| held.arrays.clone())
}

fn folder(path: &Path) -> Arrays {
    Arrays::from(path.parent().unwrap_or(Path::new("")))
}

/// A system file, read.
pub fn read(path: &Path, common: &Common) -> Result<SystemScene> {
    let (text, arrays) = source(path, common)?;
    SystemScene::read_in(arrays, &text)
}
