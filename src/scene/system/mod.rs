//! A system as it is written: masses, potentials with their clocks, or one of the usual cases by name.
//!
//! ```json
//! {
//!     "schema": "kickdrift/system/1",
//!     "title": "two masses",
//!     "masses": ["1", "3/2"],
//!     "potentials": [
//!         {"step": "1/4", "springs": [[0, 1, "10"]]},
//!         {"step": "1", "phase": "1/2", "springs": [[0, null, "1/2"]]},
//!         {"step": "1/2", "stiffness": [["2", "-1"], ["-1", "2"]], "scale": "1/3"},
//!         {"step": "1/2", "bonds": [{"i": 0, "j": 1, "form": "quartic", "k": "1", "beta": "1/3"}]}
//!     ],
//!     "near": ["0", "0"]
//! }
//! ```
//!
//! * All quantities are exact, texts or JSON numbers (0.1 is 1/10); indices count from 0. Stiffnesses, springs and scales may involve
//!   π, as `"pi^2/25"`; of one mass alone (K clocks on one oscillator) its mass and its steps, too.
//! * `time_unit`, if given, is the name of the unit of steps and periods, as "ps": answers name it.
//! * `masses`, or `mass_matrix` by rows.
//! * A potential has a `step`, a `phase` (0 unless given, or 1/2), and at least one of `springs` (i, j, k; j null for a
//!   wall), `stiffness` (by rows), `bonds` (a named form between i and j, without j to a wall at 0). They add up, times
//!   `scale` (1 unless given).
//! * Forms: `harmonic` (k), `quartic` (k, beta), `lennard-jones` (epsilon, sigma). With bonds other than harmonic the
//!   system is the linear one at the equilibrium found near the positions `near`: exact for the Hessian in doubles,
//!   which is itself rounded.
//! * A `stiffness` by reference, `{"npy": "h.npy"}` or `{"npz": "data.npz", "array": "h"}`, makes it a system of measured
//!   doubles: then all stiffnesses are references, `masses` and `positions` too; `mass_weighted` says that the matrices are,
//!   `accuracy` how well they are known.
//! * `labels` name the degrees of freedom, or the particles of three each; `friction` is a rate γ per unit time: O, v → exp(−γ t) v,
//!   in the middle of every drift of the whole schedule, also for what only some of the clocks act on.
//! * In place of masses and potentials a `mesh` of finite elements, see `mesh`; or `build`: `{"kind": "chain", "masses": 200, "stiffness": [...], "steps": [...]}`,
//!   `{"kind": "stiff-soft", "pairs": 4, "stiff": "100", "steps": [stiff, soft]}`,
//!   `{"kind": "graded-bar", "elements": 100, "classes": 10, "courant": "1/4"}`,
//!   `{"kind": "tethered-pair", "masses": [...], "stiffness": [bond, tether], "steps": [bond, tether]}`.
//!
//! | file | what |
//! |---|---|
//! | `document` | the fields |
//! | `linear`, `bonds` | rational systems, named forms at an equilibrium |
//! | `oscillator`, `pi` | one oscillator over ℚ\[π\], several degrees of freedom with such stiffnesses |
//! | `mesh` | finite elements |
//! | `measured`, `array`, `market` | stiffnesses by reference to NumPy's and Matrix Market's files |
//! | `held` | their constraints, heavy hydrogens |
//! | `projected` | them on any clocks, rigid motions projected out |
//! | `molecule` | two measured levels, to be advised on |
//! | `run` | Algorithm 1 run on it |
//! | `scan`, `intervals` | one file, many systems: any number of it over a range; its unstable intervals |

mod array;
mod bonds;
mod document;
mod held;
mod intervals;
mod linear;
mod market;
mod measured;
mod mesh;
#[cfg(feature = "advise")]
mod molecule;
mod oscillator;
mod pi;
mod projected;
mod run;
mod scan;

use std::sync::OnceLock;

use serde::Deserialize;
use serde_json::Value;

use crate::avi::{self, Bond, Clocks, Simulation, State};
use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::number::{Laurent, Rational};
use crate::propagator;
use crate::scene::json;
use crate::system::friction::{Friction, damped_system};
use crate::system::levels::Hessians;
use crate::system::{
    Analysis, Holds, Limits, ManyClocks, OwnOrbit, PiSystem, Potential, Route, System, decide_by,
    decide_oscillator, exact_kind, verdict_cost,
};
use crate::verdict::Kind;
pub use array::{Array, Arrays};
use bonds::Nonlinear;
use document::{Document, no_system};
pub use intervals::Span;
use measured::Measured;
pub use measured::TwoLevels;
#[cfg(feature = "advise")]
pub use molecule::of_archive;
use oscillator::Oscillator;
pub use run::{Displacement, RunRequest};
pub use scan::{Axis, Scan};

/// The schema that this version reads.
const SCHEMA: &str = "kickdrift/system/1";

/// The longest file, in bytes.
const LONGEST: usize = 16 << 20;

/// A label for each of n degrees of freedom, from one each or from one for each particle in space.
fn spread(labels: &[String], n: usize) -> Result<Vec<String>> {
    match labels.len() {
        k if k == n => Ok(labels.to_vec()),
        k if 3 * k == n => {
            Ok(labels.iter().flat_map(|own| ["x", "y", "z"].map(|axis| format!("{own} {axis}"))).collect())
        }
        k => {
            let remedy =
                format!("there are {n} degrees of freedom: give a label for each, or for each three");
            Err(Error::input("labels", k, remedy))
        }
    }
}

/// A system file, read and checked.
#[derive(Clone, Debug)]
pub struct SystemScene {
    source: Value,
    /// Where the arrays are that it refers to.
    arrays: Arrays,
    title: String,
    /// Built when it is first asked for where stiffnesses are measured.
    system: OnceLock<System>,
    nonlinear: Option<Nonlinear>,
    oscillator: Option<Oscillator>,
    /// Several degrees of freedom with stiffnesses that involve π.
    with_pi: Option<PiSystem>,
    measured: Option<Measured>,
    /// One for each degree of freedom.
    labels: Option<Vec<String>>,
    /// γ per unit time.
    friction: Option<Rational>,
}

impl SystemScene {
    /// Reads a system from the text of its file.
    ///
    /// # Errors
    /// JSON that is no system, an unknown field, a quantity that does not parse, an index out of range, and whatever
    /// [`System::new`] refuses; each by the entry's name.
    pub fn read(text: &str) -> Result<SystemScene> {
        SystemScene::read_in("", text)
    }

    /// The same with the folder that the files it refers to are in, or with these arrays in memory.
    ///
    /// # Errors
    /// As [`SystemScene::read`]; an I/O error of these files.
    pub fn read_in(arrays: impl Into<Arrays>, text: &str) -> Result<SystemScene> {
        if text.len() > LONGEST {
            let remedy = "a system has at most 16 MiB; is this the right file?";
            return Err(Error::input("system", format!("{} bytes", text.len()), remedy));
        }
        let source: Value = json::from_str(text).map_err(no_system)?;
        if measured::is_by_reference(&source) {
            return SystemScene::from_json_in(arrays, source);
        }
        let document = match Document::deserialize(&source) {
            Ok(document) => document,
            // Once more from the text, for the error to name its line.
            Err(_) => json::from_str(text).map_err(no_system)?,
        };
        SystemScene::new(document, source)
    }

    /// Reads a system from JSON that was parsed already, such as the one that a document echoes.
    ///
    /// # Errors
    /// As [`SystemScene::read`].
    pub fn from_json(source: Value) -> Result<SystemScene> {
        SystemScene::from_json_in("", source)
    }

    /// The same with the folder that the files it refers to are in, or with these arrays in memory.
    ///
    /// # Errors
    /// As [`SystemScene::read_in`].
    pub fn from_json_in(arrays: impl Into<Arrays>, source: Value) -> Result<SystemScene> {
        if !measured::is_by_reference(&source) {
            return SystemScene::new(Document::deserialize(&source).map_err(no_system)?, source);
        }
        let text = |key: &str| source.get(key).and_then(Value::as_str).unwrap_or_default().to_string();
        let (schema, title) = (text("schema"), text("title"));
        if schema != SCHEMA {
            return Err(Error::input("schema", schema, format!("this version reads {SCHEMA}")));
        }
        let arrays = arrays.into();
        let measured = Measured::read(&source, &arrays)?;
        let labels = source.get("labels").map(Vec::<String>::deserialize).transpose().map_err(no_system)?;
        let labels = labels.map(|own| spread(&own, measured.size())).transpose()?;
        Ok(SystemScene {
            arrays,
            system: OnceLock::new(),
            measured: Some(measured),
            labels,
            ..SystemScene::empty(source, title)
        })
    }

    fn new(document: Document, source: Value) -> Result<SystemScene> {
        if document.schema != SCHEMA {
            return Err(Error::input("schema", &document.schema, format!("this version reads {SCHEMA}")));
        }
        let title = document.title.clone().unwrap_or_default();
        let is_explicit = document.masses.is_some() || document.potentials.is_some();
        let mut scene = match (&document.build, &document.mesh) {
            (Some(build), None) if !is_explicit => SystemScene::linear(source, title, build.system()?),
            (None, Some(mesh)) if !is_explicit => {
                let (system, labels) = mesh.system()?;
                SystemScene { labels: Some(labels), ..SystemScene::linear(source, title, system) }
            }
            (None, None) => SystemScene::explicit(source, title, &document)?,
            _ => {
                let remedy = "give either build, or mesh, or masses and potentials";
                let field = if document.build.is_some() { "build" } else { "mesh" };
                return Err(Error::input(field, "given", remedy));
            }
        };
        if let Some(labels) = &document.labels {
            scene.labels = Some(spread(labels, scene.system().size())?);
        }
        let friction = document.friction.as_ref().map(|own| own.read("friction")).transpose()?;
        friction.map_or(Ok(scene.clone()), |rate| scene.with_friction(rate))
    }

    fn explicit(source: Value, title: String, document: &Document) -> Result<SystemScene> {
        if let Some(oscillator) = document.oscillator()? {
            let system = oscillator.rounded.clone();
            return Ok(SystemScene {
                oscillator: Some(oscillator),
                ..SystemScene::linear(source, title, system)
            });
        }
        let (mass, potentials) = (document.mass()?, document.potentials()?);
        let n = mass.size();
        let linear = potentials.iter().enumerate().map(|(k, p)| p.linear(k, n)).collect::<Result<_>>();
        let linear = match linear {
            Err(error) if potentials.iter().all(|p| p.bonds.is_empty()) => {
                let own = document.with_pi(mass)?.ok_or(error)?;
                let scene = SystemScene::linear(source, title, own.near().clone());
                return Ok(SystemScene { with_pi: Some(own), ..scene });
            }
            linear => linear?,
        };
        let (system, nonlinear) = if potentials.iter().all(|p| p.bonds.is_empty()) {
            (System::new(mass, linear)?, None)
        } else {
            let (system, nonlinear) = document.at_equilibrium(mass, potentials, linear)?;
            (system, Some(nonlinear))
        };
        Ok(SystemScene { nonlinear, ..SystemScene::linear(source, title, system) })
    }

    fn linear(source: Value, title: String, system: System) -> SystemScene {
        SystemScene { system: OnceLock::from(system), ..SystemScene::empty(source, title) }
    }

    fn empty(source: Value, title: String) -> SystemScene {
        SystemScene {
            source,
            arrays: "".into(),
            title,
            system: OnceLock::new(),
            nonlinear: None,
            oscillator: None,
            with_pi: None,
            measured: None,
            labels: None,
            friction: None,
        }
    }

    /// The same with another accuracy of its measured stiffnesses, relative to their norms.
    ///
    /// # Errors
    /// Where nothing is measured, and where the accuracy is not in (0, 1/10).
    pub fn at_accuracy(mut self, accuracy: f64) -> Result<SystemScene> {
        let exact = || Error::input("accuracy", accuracy, "is for stiffnesses by reference: these are exact");
        self.measured = Some(self.measured.ok_or_else(exact)?.at_accuracy(accuracy)?);
        Ok(self)
    }

    /// The same with the rigid motions of measured stiffnesses left in.
    ///
    /// # Errors
    /// Where nothing is measured.
    pub fn keeping_rigid(mut self) -> Result<SystemScene> {
        let exact =
            || Error::input("rigid motions", "kept", "is for stiffnesses by reference: these are exact");
        self.measured = Some(self.measured.ok_or_else(exact)?.keeping_rigid());
        Ok(self)
    }

    /// The same with friction of a rate per unit time, O in the middle of every drift.
    ///
    /// # Errors
    /// A rate that is not positive; stiffnesses by reference.
    pub fn with_friction(mut self, rate: Rational) -> Result<SystemScene> {
        if rate <= Rational::default() {
            return Err(Error::input("friction", rate, "a rate of friction must be positive"));
        }
        self.friction = Some(rate);
        Ok(self)
    }

    /// What the friction of the file does; `None` where it has none.
    ///
    /// # Errors
    /// As [`damped_system`]; an oscillator that involves π takes its rounded stiffnesses, and is refused where its steps are
    /// irrational; measured stiffnesses are answered for two steps, one a multiple of the other.
    pub fn friction(&self, limits: &Limits) -> Result<Option<Friction>> {
        let Some(rate) = &self.friction else { return Ok(None) };
        if let Some(own) = &self.oscillator {
            limits.allow(own.clocks.schedule().strikes().saturating_mul(1000), || {
                "friction on one oscillator".into()
            })?;
            return own.friction(rate).map(Some);
        }
        if let Some(own) = &self.measured {
            return own.friction(rate, limits).map(Some);
        }
        if self.with_pi.is_some() {
            let remedy = "with several degrees of freedom write stiffnesses without pi";
            return Err(Error::input("friction", rate, remedy));
        }
        damped_system(self.system(), rate, limits).map(Some)
    }

    /// What each degree of freedom is called, where the file tells.
    pub fn labels(&self) -> Option<&[String]> {
        self.labels.as_deref()
    }

    /// The whole input, as it was read.
    pub fn source(&self) -> &Value {
        &self.source
    }

    /// The title, or nothing.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The name of the unit in which the file's times are, where it gives one.
    pub fn time_unit(&self) -> Option<&str> {
        self.source.get("time_unit").and_then(Value::as_str)
    }

    /// The linear system: that at the equilibrium, where there are nonlinear bonds; rounded to doubles (and, where steps
    /// are irrational, in the unit of time of the shortest one), where an oscillator involves π; within 2^-150 of every entry
    /// where several degrees of freedom do.
    pub fn system(&self) -> &System {
        self.system.get_or_init(|| self.measured.as_ref().expect("measured, where it was not built").system())
    }

    /// The verdict.
    ///
    /// # Errors
    /// As [`decide_by`] and [`decide_oscillator`].
    pub fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        if let Some(own) = &self.with_pi {
            return own.decide(route, limits);
        }
        match (&self.oscillator, &self.measured) {
            (Some(own), _) => decide_oscillator(&own.clocks, &own.rounded, &own.unit, limits),
            (None, Some(measured)) => measured.decide(route, limits),
            (None, None) => decide_by(route, self.system(), limits),
        }
    }

    /// Whether it is stable, and nothing else: of two measured levels without an eigenbasis where that proves it.
    ///
    /// # Errors
    /// As [`SystemScene::decide`].
    pub fn verdict(&self, route: Route, limits: &Limits) -> Result<Holds> {
        let own = self.measured.as_ref().filter(|_| route == Route::Cheapest);
        match own.map(|own| own.verdict(limits)).transpose()?.flatten() {
            Some(holds) => Ok(holds),
            None => Ok(self.decide(route, limits)?.holds()),
        }
    }

    /// The kind by exact arithmetic alone: by characteristic polynomials over ℚ or power sums over ℚ\[π\], part by part; of an
    /// oscillator with π by the four signs.
    ///
    /// # Errors
    /// A budget error, before the work on the part that exceeds it.
    pub fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        match (&self.with_pi, &self.oscillator) {
            (Some(own), _) => own.exact_kind(limits),
            (None, Some(own)) => own.exact_kind(limits),
            (None, None) => exact_kind(self.system(), limits),
        }
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.measured.as_ref().map_or_else(|| self.system().size(), Measured::size)
    }

    /// The products of doubles that the verdict costs, roughly, where doubles prove it.
    pub fn cost(&self) -> u64 {
        match &self.measured {
            Some(measured) => measured.cost(),
            None => verdict_cost(self.system()),
        }
    }

    /// Both levels of a system of two measured ones.
    ///
    /// # Errors
    /// Where the stiffnesses do not stand by reference, and where the steps are others than an inner and an outer one.
    pub fn two_levels(&self) -> Result<TwoLevels<'_>> {
        let remedy = "give stiffnesses by reference, as {\"npz\": \"water.npz\", \"array\": \"fast\"}";
        let exact = || Error::input("stiffness", "given in place", remedy);
        self.measured.as_ref().ok_or_else(exact)?.two_levels()
    }

    /// The largest ln |λ|/T of two levels of measured stiffnesses by the dense full period, rounded; `None` of any other system.
    ///
    /// # Errors
    /// As [`SystemScene::decide`].
    pub fn growth_of_period(&self) -> Result<Option<f64>> {
        self.measured.as_ref().map_or(Ok(None), |own| own.growth_of_period())
    }

    /// The matrices of [`SystemScene::two_levels`], rigid motions projected out.
    ///
    /// # Errors
    /// As [`SystemScene::two_levels`].
    pub fn hessians(&self) -> Result<Hessians> {
        self.two_levels()?;
        self.measured.as_ref().expect("measured, as two levels are").hessians()
    }

    /// The clocks exactly, where one oscillator has irrational quantities: in units of its shortest step.
    pub fn many_clocks(&self) -> Option<&ManyClocks<Laurent>> {
        self.oscillator.as_ref().map(|own| &own.clocks)
    }

    /// The same as two clocks on one oscillator, where it is that, without phases.
    pub fn two_clocks(&self) -> Option<propagator::Oscillator> {
        if let Some(own) = &self.oscillator {
            let (two, h1) = (own.clocks.as_two_clocks()?, &own.unit);
            let h2 = h1 * &Laurent::from_rational(two.ratio().into());
            let lambda = |strength: &Laurent, step: &Laurent| strength.checked_div(&(h1 * step));
            return propagator::Oscillator::new(
                lambda(two.fast(), h1)?,
                lambda(two.slow(), &h2)?,
                h1.clone(),
                h2,
            )
            .ok();
        }
        let system = self.measured.is_none().then(|| self.system()).filter(|system| system.size() == 1)?;
        let [fast, slow] = system.clocks() else { return None };
        let phased = [fast, slow].iter().any(|clock| clock.phase != Rational::default());
        let lambda =
            |clock: &Potential| Laurent::from_rational(clock.stiffness.get(0, 0) / system.mass().get(0, 0));
        let step = |clock: &Potential| Laurent::from_rational(clock.step.clone());
        (!phased)
            .then(|| propagator::Oscillator::new(lambda(fast), lambda(slow), step(fast), step(slow)).ok())
            .flatten()
    }

    /// The equilibrium, where there are bonds.
    pub fn equilibrium(&self) -> Option<&[f64]> {
        self.nonlinear.as_ref().map(|n| n.equilibrium.as_slice())
    }

    /// The integrator's own periodic orbit beside the equilibrium, and the verdict about it; `None` where there are no nonlinear
    /// bonds, or where the equilibrium is the orbit.
    ///
    /// # Errors
    /// Where no orbit is found; as [`decide_along`](crate::system::decide_along).
    pub fn own_orbit(&self, limits: &Limits) -> Result<Option<OwnOrbit>> {
        let Some(nonlinear) = self.nonlinear.as_ref().filter(|own| !own.is_harmonic) else { return Ok(None) };
        let masses: Vec<f64> = self.masses()?.iter().map(to_f64).collect();
        nonlinear.own_orbit(&masses, limits)
    }

    /// Whether the system of [`SystemScene::system`] is all there is: no bond but harmonic ones.
    pub fn is_linear(&self) -> bool {
        self.nonlinear.as_ref().is_none_or(|n| n.is_harmonic)
    }

    /// The simulation of the linear system in doubles, from positions and momenta.
    ///
    /// # Errors
    /// A mass matrix that is not diagonal, steps that are irrational, and as [`Simulation::new`].
    pub fn linear_simulation(&self, x: Vec<f64>, p: Vec<f64>) -> Result<Simulation<f64, avi::Linear<f64>>> {
        if let Some(own) = self.oscillator.as_ref().filter(|own| !own.has_rational_steps) {
            let remedy = "a run needs rational steps: choose a unit of time in which they are";
            return Err(Error::input("step", &own.unit, remedy));
        }
        let force = |clock: &Potential| {
            let particles = clock.stiffness.support();
            let row = |&i: &usize| particles.iter().map(|&j| to_f64(&clock.stiffness.get(i, j))).collect();
            let rows = particles.iter().map(row).collect();
            avi::Linear::new(particles, rows)
        };
        let forces = self.system().clocks().iter().map(force).collect::<Result<Vec<_>>>()?;
        let steps: Vec<_> = self.system().clocks().iter().map(|c| c.step.clone()).collect();
        let phases: Vec<_> = self.system().clocks().iter().map(|c| c.phase.clone()).collect();
        Simulation::new(&self.masses()?, forces, Clocks::new(&steps, &phases)?, State::new(x, p))
    }

    /// The simulation of the bonds themselves; `None` where the file has none.
    ///
    /// # Errors
    /// As [`SystemScene::linear_simulation`].
    pub fn nonlinear_simulation(&self, x: Vec<f64>, p: Vec<f64>) -> Result<Option<Simulation<f64, Bond>>> {
        let Some(nonlinear) = &self.nonlinear else { return Ok(None) };
        let clocks = Clocks::new(&nonlinear.steps, &nonlinear.phases)?;
        Simulation::new(&self.masses()?, nonlinear.bonds.clone(), clocks, State::new(x, p)).map(Some)
    }

    fn masses(&self) -> Result<Vec<Rational>> {
        self.measured.as_ref().map_or(Ok(()), Measured::refuse_constraints)?;
        if !self.system().mass().is_diagonal() {
            let remedy = "Algorithm 1 moves particle by particle: give masses in place of mass_matrix";
            return Err(Error::input("mass_matrix", "not diagonal", remedy));
        }
        Ok((0..self.system().size()).map(|i| self.system().mass().get(i, i)).collect())
    }
}
