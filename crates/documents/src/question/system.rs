//! Many clocks, many degrees of freedom: is the system stable, and where does that change?

use plot::{Figure, Foot, literal};
use serde_json::Value;

use super::asking::{Question, Work, question};
use super::field::{Field, flag, notation};
use crate::format::Format;
use crate::input::{Arrays, Axis, NEAREST, Scan, Span, SystemFile, SystemScene};
use crate::report::document::Document;
use crate::report::shape::{Keys, Schema, Shape};
use crate::report::system::{self as report, Beside, Biases, SystemMap};
use clocks::verdict::Kind as Stability;
use number::error::Kind;
use number::{Error, Rational, Result};
use systems::friction::Friction;
use systems::levels::Method;
use systems::nearest::Nearest;
use systems::scan::scan;
use systems::vary::Intervals;
use systems::{Analysis, Jacobians, Limits, NoBias, NoGradient, OwnOrbit, Route, SchemeSummary, seconds};

question! {
    /// The verdict on a system; the verdicts over one of its numbers, or two; or the unstable intervals of
    /// one.
    args struct System {
        /// The name of its file.
        #[arg(skip)]
        file: String,
        /// Its title, which documents take from the system.
        #[arg(skip)]
        title: Option<String>,
        /// The contents of the file.
        #[arg(skip)]
        system: SystemFile,
        /// Decide in exact arithmetic; where it exceeds --budget (products of machine words) the error states
        /// its cost.
        #[arg(long)]
        exact: bool,
        /// Leave the rigid motions of measured stiffnesses in.
        #[arg(long)]
        keep_rigid: bool,
        /// Friction per unit time, as BAOAB has it: halfway through a drift over t, v becomes v exp(-G t).
        /// Does it stop the growth?
        friction as "G": Option<Rational>,
        /// How well measured stiffnesses (by reference to NumPy's files) are known, relative to their norms
        /// [default: 1e-6].
        accuracy as "X": Option<f64>,
        /// The integrator of two measured levels: respa, implicit-explicit, impulse, molly-short, ...
        /// [default: the file's].
        method as "NAME": Option<Method>,
        /// The number that is varied in a map,
        #[arg(skip)]
        scan_x: Option<Axis>,
        /// and another one.
        #[arg(skip)]
        scan_y: Option<Axis>,
        /// Unstable intervals of a number of the file: outer (all steps, or one of them), a scale, a
        /// stiffness, a spring, a mass
        #[arg(conflicts_with_all = ["exact", "friction"])]
        intervals as "PATH=LO..HI": Option<Span>,
        /// With the verdict: the unstable intervals of the outer step next to this one, from half of it to
        /// twice it
        #[arg(long, conflicts_with_all = ["intervals", "friction"])]
        nearest: bool,
        /// The relative width above which no interval is missed, of --intervals and --nearest [default:
        /// 1e-4].
        #[arg(id = "resolution", long = "resolution", value_name = "W", value_parser = flag::<f64>)]
        width: Option<f64>,
    }
}

notation! {
    Method: |_, text: &str| text.parse(), ToString::to_string;
    Axis: |_, text: &str| text.parse(), ToString::to_string, Shape::Plain(r#"{"type": "string", "pattern": "=.*\\.\\..*:"}"#);
    Span: |_, text: &str| text.parse(), ToString::to_string, Shape::Plain(r#"{"type": "string", "pattern": "^.+=.*\\.\\."}"#);
}

/// A file: what is in it, or its text.
impl Field for SystemFile {
    const SHAPE: Shape = Shape::Plain(
        r#"{"type": "object", "description": "The system file, whole: a document of kickdrift/system/1."}"#,
    );

    fn of(given: Option<&Value>, _: &str) -> Option<Result<Self>> {
        given.map(|value| match value {
            Value::String(text) => SystemFile::of_text(text),
            other => Ok(other.clone().into()),
        })
    }

    fn shown(&self) -> Option<Value> {
        Some(self.source().clone())
    }
}

/// The result that was asked for.
pub enum SystemFound {
    Verdict(Box<SystemVerdict>),
    Map(SystemMap),
    Intervals(Intervals),
}

/// A verdict, and what stands beside it.
pub struct SystemVerdict {
    pub analysis: Analysis,
    friction: Option<Friction>,
    orbit: Option<OwnOrbit>,
    is_orbit_missing: bool,
    nearest: Option<Nearest>,
    no_gradient: Option<NoGradient>,
    /// The bias of its modes, or why it is not told; `None` unless it is stable.
    pub bias: Option<Biases>,
    pub local: Option<SchemeSummary>,
}

/// The answer about a system.
pub struct SystemAnswer {
    pub scene: SystemScene,
    pub found: SystemFound,
}

impl Work<'_> {
    /// The highest cost of one verdict on a system.
    pub fn products(&self) -> Limits {
        self.budget.map_or_else(Limits::default, |products| Limits { products, ..Limits::default() })
    }

    /// A system, read with the arrays at hand.
    pub(super) fn read(&self, file: &SystemFile) -> Result<SystemScene> {
        file.read(self.arrays.cloned().unwrap_or_else(|| Arrays::from("")))
    }
}

impl System {
    /// The system as it is asked about.
    ///
    /// # Errors
    /// As [`SystemFile::read`] and [`SystemScene::asked`].
    pub fn scene(&self, work: &Work) -> Result<SystemScene> {
        work.read(&self.system)?.asked(self.accuracy, self.keep_rigid, self.friction.as_ref(), self.method)
    }

    /// By which means it is decided.
    pub fn route(&self) -> Route {
        if self.exact { Route::Exact } else { Route::Cheapest }
    }

    /// The width of intervals, where any are looked for.
    pub fn width(&self) -> Option<f64> {
        (self.nearest || self.intervals.is_some()).then(|| self.width.unwrap_or(1e-4))
    }

    /// The system with the numbers open that a map varies; `None` where it varies none.
    ///
    /// # Errors
    /// As [`Scan::new`].
    pub fn scan(&self, scene: &SystemScene) -> Result<Option<Scan>> {
        let of = |x: &Axis| Scan::new(scene.clone(), x.clone(), self.scan_y.clone());
        self.scan_x.as_ref().map(of).transpose()
    }

    fn verdict(&self, scene: &SystemScene, work: &Work) -> Result<SystemVerdict> {
        let (model, limits) = (scene.model(), work.products());
        let what = format!("a verdict on {} degrees of freedom", model.size());
        work.announce(&what, seconds(model.cost() as f64));
        let analysis = model.decide(self.route(), &limits)?;
        let (orbit, is_orbit_missing) = match scene.own_orbit(&limits) {
            Err(error) if error.kind() == Kind::Input => (None, true),
            found => (found?, false),
        };
        let width = self.width().filter(|_| self.nearest);
        let nearest = |width| {
            let cost = scene.cost_of_nearest(width, &limits)?;
            limits.allow(cost as u64, || NEAREST.into())?;
            work.announce(NEAREST, seconds(cost));
            scene.nearest_unstable(width, &limits)
        };
        let nearest = width.map(nearest).transpose()?;
        let no_gradient = model.jacobians().map(Jacobians::no_gradient);
        let bias = match analysis.kind {
            Some(Stability::Elliptic) => Some(model.biased_modes()?),
            Some(kind) if kind.is_stable() => Some(Err(NoBias::Edge)),
            _ => None,
        };
        let (friction, local) = (scene.friction(&limits)?, model.local_steps_summary());
        Ok(SystemVerdict { analysis, friction, orbit, is_orbit_missing, nearest, no_gradient, bias, local })
    }

    fn intervals(span: &Span, width: f64, scene: &SystemScene, work: &Work) -> Result<Intervals> {
        let limits = work.products();
        let cost = scene.cost_of_intervals(span, width, &limits)?;
        limits.allow(cost as u64, || format!("intervals of {span}"))?;
        work.announce(&format!("intervals of {span}"), seconds(cost));
        scene.intervals(span, width, &limits)
    }

    fn map(&self, scene: &SystemScene, axes: &Scan, work: &Work) -> Result<SystemMap> {
        let (xs, ys, limits) = (axes.x.values(), axes.ys(), work.products());
        let points = xs.len() * ys.len();
        let cost = System::cost_of_map(axes, &xs, &ys)?;
        limits
            .allow(cost as u64, || format!("a map of {points} points"))
            .map_err(|error| error.or("choose larger spacings"))?;
        let seconds = seconds(cost);
        work.announce(&format!("{points} points, each {:.2} s on average", seconds / points as f64), seconds);
        let bar = work.count(points as u64, "points");
        let decide = |x: &_, y: &_| axes.at(x, y)?.model().at_point(self.route(), &limits);
        let points = scan(&xs, &ys, decide, || bar.advance(1))?;
        let numbers = axes.names().iter().map(|path| scene.number(path)).collect();
        Ok(SystemMap { numbers, xs, ys, points, time_unit: scene.time_unit().map(String::from) })
    }

    /// The products that a map costs, roughly, from those of some points spread over it: to ask each takes as
    /// long as many a verdict.
    fn cost_of_map(axes: &Scan, xs: &[Rational], ys: &[Rational]) -> Result<f64> {
        let points = xs.len() * ys.len();
        let asked = points.min(ASKED);
        let place = |k: usize| (2 * k + 1) * points / (2 * asked);
        let cost = |k| Ok(axes.at(&xs[place(k) % xs.len()], &ys[place(k) / xs.len()])?.model().cost() as f64);
        let costs = (0..asked).map(cost).collect::<Result<Vec<_>>>()?;
        Ok(costs.iter().sum::<f64>() * points as f64 / asked as f64)
    }

    /// That only one kind of answer is asked for.
    fn check(&self) -> Result<()> {
        let asked = [self.scan_x.is_some(), self.intervals.is_some(), self.nearest];
        let refused = |field, remedy| Err(Error::input(field, "given", remedy));
        if asked.into_iter().filter(|asked| *asked).count() > 1 {
            return refused("question", "asks for several answers: for a map, intervals or the nearest ones");
        }
        match (&self.scan_x, self.scan_y.is_some(), &self.intervals) {
            (None, true, _) => refused("scan_y", "a map has a first axis: give scan_x, too"),
            (.., Some(_)) if self.exact => refused("exact", "is for verdicts and maps: leave it out"),
            _ => Ok(()),
        }
    }
}

/// The points of a map that are asked what they cost.
const ASKED: usize = 16;

impl Question for System {
    const NAME: &'static str = "system";
    const EXAMPLES: &'static [&'static str] =
        &["system data/scenes/three-clocks.json", "system data/scenes/bar-resonant.json --output modes.pdf"];
    type Answer = SystemAnswer;

    /// A map, intervals, or a verdict: each leaves out what the others are asked by.
    fn schemas() -> Vec<(&'static str, Schema, Keys)> {
        let keys = <System as super::Fields>::keys;
        let verdict = keys().without(&["scan_x", "scan_y", "intervals"]).requiring(&["title"]);
        let map =
            keys().without(&["friction", "intervals", "nearest", "width"]).requiring(&["title", "scan_x"]);
        let intervals = keys().without(&["exact", "friction", "scan_x", "scan_y", "nearest"]).requiring(&[
            "title",
            "intervals",
            "width",
        ]);
        vec![
            ("system-verdict", report::schema(), verdict),
            ("system-map", SystemMap::schema(), map),
            ("system-intervals", report::intervals_schema(), intervals),
        ]
    }

    fn answer(&self, work: &Work) -> Result<SystemAnswer> {
        self.check()?;
        let scene = self.scene(work)?;
        let found = match (self.scan(&scene)?, &self.intervals, self.width()) {
            (Some(axes), ..) => SystemFound::Map(self.map(&scene, &axes, work)?),
            (_, Some(span), Some(width)) => {
                SystemFound::Intervals(System::intervals(span, width, &scene, work)?)
            }
            _ => SystemFound::Verdict(Box::new(self.verdict(&scene, work)?)),
        };
        Ok(SystemAnswer { scene, found })
    }

    fn show(&self, SystemAnswer { scene, found }: &SystemAnswer) -> Document {
        match found {
            SystemFound::Map(map) => map.document(),
            SystemFound::Intervals(intervals) => {
                report::intervals(intervals, &scene.number(&intervals.number).0)
            }
            SystemFound::Verdict(verdict) => report::document(
                &verdict.analysis,
                &Beside {
                    unit: scene.time_unit(),
                    friction: verdict.friction.as_ref(),
                    orbit: verdict.orbit.as_ref(),
                    is_orbit_missing: verdict.is_orbit_missing,
                    labels: scene.labels(),
                    nearest: verdict.nearest.as_ref(),
                    local: verdict.local.as_ref(),
                    remark: scene.model().remark(),
                    bias: verdict.bias.as_ref(),
                    no_gradient: verdict.no_gradient.as_ref(),
                },
            ),
        }
    }

    /// With the system's own title, and the width that was taken.
    fn document(&self, answer: &SystemAnswer) -> Document {
        let (title, width) = (Some(answer.scene.title().into()), self.width());
        self.show(answer).inputs(super::Fields::input(&System { title, width, ..self.clone() }))
    }

    fn figure(&self, answer: &SystemAnswer, work: &Work) -> Result<Option<Figure>> {
        self.drawn(answer, report::Colouring::default(), work).map(Some)
    }
}

impl System {
    /// The growing modes in space, as viewers read them: extended XYZ, or VTK's unstructured grid.
    ///
    /// # Errors
    /// Where the file places no points, where nothing grows, of maps and intervals.
    pub fn in_space(&self, answer: &SystemAnswer, format: Format) -> Result<String> {
        let SystemFound::Verdict(verdict) = &answer.found else {
            return Err(Error::input(
                "output",
                format.name(),
                "holds the modes of one verdict, and this is none",
            ));
        };
        let geometry = answer.scene.geometry()?;
        match format {
            Format::Vtu => report::vtu(&verdict.analysis, &geometry),
            _ => report::xyz(&verdict.analysis, &geometry),
        }
    }
}

impl System {
    /// The multipliers and the shapes of the growing modes; a map in these colours; growth over the
    /// intervals. In the system's unit of time, with its title and what was varied below.
    ///
    /// # Errors
    /// As [`SystemScene::growth_rates`].
    pub fn drawn(&self, answer: &SystemAnswer, colouring: report::Colouring, work: &Work) -> Result<Figure> {
        let (scene, title) = (&answer.scene, answer.scene.title());
        let varied = [self.scan_x.as_ref(), self.scan_y.as_ref()].into_iter().flatten();
        let varied = varied.fold(Foot::default(), |foot, axis| {
            foot.grid(&literal(&scene.number(&axis.path).0), [&axis.lo, &axis.hi, &axis.by])
        });
        let (figure, varied) = match (&answer.found, &self.intervals) {
            (SystemFound::Map(map), _) => (map.figure(colouring, title), varied),
            (SystemFound::Intervals(intervals), Some(span)) => {
                let steps = report::sampled(&intervals.stretches);
                let rates = scene.growth_rates(span, &steps, &work.products())?;
                let number = scene.number(&intervals.number);
                let figure = report::intervals_figure(intervals, &rates, title, &number);
                let (lo, hi) = span.range();
                (figure, varied.range(&literal(&number.0), lo, hi))
            }
            (SystemFound::Verdict(verdict), _) => (report::figure(&verdict.analysis, title), varied),
            (SystemFound::Intervals(_), None) => unreachable!("intervals need a number"),
        };
        let foot = Foot::default().words(title).part(varied.to_string());
        Ok(figure.in_units_of(scene.time_unit().unwrap_or("time")).footed(&foot))
    }
}
