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
//! [`document`] says what each field is, to the reader and to the schema `data/schema/system.json`.
//!
//! * All quantities are exact, texts or JSON numbers (0.1 is 1/10); indices count from 0. Stiffnesses,
//!   springs and scales may involve π, as `"pi^2/25"`; of one mass alone (K clocks on one oscillator) its
//!   mass and its steps, too.
//! * With bonds other than harmonic the system is the linear one at the equilibrium found near the positions
//!   `near`: exact for the Hessian in doubles, which is itself rounded.
//! * A `stiffness` by reference, `{"npy": "h.npy"}` or `{"npz": "data.npz", "array": "h"}`, makes it a system
//!   of measured doubles: then all stiffnesses are references, and some fields stand there alone.
//! * `scheme`: `"lts"` or `"avi"` with `levels` are local time steps, see `local`.
//! * In place of masses and potentials a `mesh` of finite elements, see `mesh`; or `build`, as `{"kind":
//!   "chain", "masses": 200, "stiffness": [...], "steps": [...]}`.
//!
//! | file | what |
//! |---|---|
//! | `document`, `part` | the fields, for the reader and the schema; what they are made of |
//! | `linear`, `bonds` | rational systems, named forms at an equilibrium |
//! | `oscillator`, `pi` | one oscillator over ℚ\[π\], several degrees of freedom with such stiffnesses |
//! | `mesh` | finite elements |
//! | `geometry` | where the degrees of freedom are in space |
//! | `local` | local time steps |
//! | `measured`, `array`, `market` | stiffnesses by reference to NumPy's and Matrix Market's files |
//! | `sparse` | two sparse levels, as SciPy writes them |
//! | `held` | their constraints, heavy hydrogens |
//! | `molecule` | two measured levels, to be advised on |
//! | `scan`, `intervals` | one file, many systems: any number of it over a range; its unstable intervals |

mod array;
mod bonds;
mod document;
mod geometry;
mod given;
mod held;
mod intervals;
mod linear;
mod local;
mod market;
mod measured;
mod mesh;
mod molecule;
mod oscillator;
mod part;
mod pi;
mod scan;
mod sparse;

use std::sync::Arc;

use serde_json::Value;

use crate::input::json;
use crate::input::kind::of_another_kind;
pub use array::{Array, Arrays};
use bonds::Nonlinear;
use document::{Document, SIZES, check_lengths, is_by_reference, no_system};
pub use intervals::{NEAREST, Span};
pub use molecule::of_archive;
use number::{Error, Rational, Result, to_f64};
pub(crate) use scan::OUTER;
pub use scan::{Axis, Scan};
use systems::avi::{self, Bond, Clocks, Simulation, State};
use systems::friction::Friction;
use systems::levels::Method;
use systems::{ElementSteps, Limits, Model, OwnOrbit, Potential, Scheme as LocalScheme, System};

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

/// A system as it is written, not read yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SystemFile {
    source: Value,
    /// For errors to name their lines, where there is one.
    text: Option<String>,
}

impl From<Value> for SystemFile {
    /// From JSON that was parsed already, such as that which a document echoes.
    fn from(source: Value) -> Self {
        SystemFile { source, text: None }
    }
}

impl SystemFile {
    /// From the text of a file.
    ///
    /// # Errors
    /// A text that is too long, or no JSON.
    pub fn of_text(text: &str) -> Result<SystemFile> {
        if text.len() > LONGEST {
            let remedy = "a system has at most 16 MiB; is this the right file?";
            return Err(Error::input("system", format!("{} bytes", text.len()), remedy));
        }
        check_lengths(text.strip_prefix('\u{feff}').unwrap_or(text))?;
        Ok(SystemFile {
            source: json::from_str(text).map_err(|cause| no_system(&cause, &json::plain(&cause)))?,
            text: Some(text.into()),
        })
    }

    /// The schema of its files, by their name.
    pub fn file_schema() -> (&'static str, Value) {
        Document::schema()
    }

    /// This file with other texts in some of its fields, where they are given.
    #[must_use]
    pub fn with<const N: usize>(&self, fields: [(&str, Option<String>); N]) -> SystemFile {
        fields.into_iter().filter_map(|(key, text)| Some((key, text?))).fold(
            self.clone(),
            |mut file, (key, own)| {
                file.source[key] = own.into();
                SystemFile { text: None, ..file }
            },
        )
    }

    /// What was written.
    pub fn source(&self) -> &Value {
        &self.source
    }

    /// Reads it with the folder that the files it refers to are in, or with these arrays in memory.
    ///
    /// # Errors
    /// JSON that is no system, an unknown field, a quantity that does not parse, an index out of range, and
    /// whatever [`System::new`] refuses; each by the entry's name. An I/O error of the files that it refers
    /// to.
    pub fn read(&self, arrays: impl Into<Arrays>) -> Result<SystemScene> {
        SystemScene::parsed(arrays.into(), self.source.clone(), self.text.as_deref())
    }
}

/// A system file, read and checked.
#[derive(Clone, Debug)]
pub struct SystemScene {
    source: Value,
    /// Where the arrays are that it refers to.
    arrays: Arrays,
    model: Arc<dyn Model>,
    /// The bonds at whose equilibrium the model is.
    bonds: Option<Nonlinear>,
    /// One for each degree of freedom.
    labels: Option<Vec<String>>,
    /// γ per unit time.
    friction: Option<Rational>,
}

impl SystemScene {
    /// Reads a system from the text of its file.
    ///
    /// # Errors
    /// As [`SystemFile::of_text`] and [`SystemFile::read`].
    pub fn read(text: &str) -> Result<SystemScene> {
        SystemScene::read_in("", text)
    }

    /// Reads a system from a text whose arrays are in a folder or in memory, as [`SystemFile::read`].
    ///
    /// # Errors
    /// As [`SystemScene::read`].
    pub fn read_in(arrays: impl Into<Arrays>, text: &str) -> Result<SystemScene> {
        SystemFile::of_text(text)?.read(arrays)
    }

    /// Reads a system from JSON whose arrays are in a folder or in memory.
    ///
    /// # Errors
    /// As [`SystemFile::read`].
    pub fn from_json_in(arrays: impl Into<Arrays>, source: Value) -> Result<SystemScene> {
        SystemFile::from(source).read(arrays)
    }

    fn parsed(arrays: Arrays, source: Value, text: Option<&str>) -> Result<SystemScene> {
        source.get("schema").and_then(Value::as_str).map_or(Ok(()), check_schema)?;
        let document = Document::parse(&source, text)?;
        if is_by_reference(&source) {
            let model: Arc<dyn Model> = if document.is_sparse() {
                Arc::new(sparse::read(&document, &arrays)?)
            } else {
                measured::read(&document, &arrays)?
            };
            let labels = document.labels.map(|labels| spread(&labels, model.size())).transpose()?;
            let (bonds, friction) = (None, None);
            return Ok(SystemScene { source, arrays, model, bonds, labels, friction });
        }
        let Described { model, bonds, labels } = document.model()?;
        if let Some(step) = model.steps().into_iter().find(|step| !SIZES.contains(&to_f64(step))) {
            let remedy = "choose a unit of time in which steps are 1e-150 to 1e150";
            return Err(Error::input("step", step, remedy));
        }
        let given = document.labels.as_ref().map(|labels| spread(labels, model.size())).transpose()?;
        let labels = given.or(labels);
        let scene = SystemScene { source, arrays, model, bonds, labels, friction: None };
        let friction = document.friction.as_ref().map(|friction| friction.read("friction")).transpose()?;
        let method = document.method.as_deref().map(str::parse).transpose()?;
        scene.asked(None, false, friction.as_ref(), method)
    }

    /// This system with what is asked of it beside its file: another accuracy of measured stiffnesses,
    /// relative to their norms; their rigid motions left in; friction of a rate per unit time, O in the
    /// middle of every drift; another integrator of two levels.
    ///
    /// # Errors
    /// An accuracy or rigid motions where nothing is measured, an accuracy that is not in (0, 1/10), a rate
    /// that is not positive.
    pub fn asked(
        mut self,
        accuracy: Option<f64>,
        keeps_rigid: bool,
        friction: Option<&Rational>,
        method: Option<Method>,
    ) -> Result<SystemScene> {
        if let Some(accuracy) = accuracy {
            self.model = self.model.at_accuracy(accuracy)?;
        }
        if keeps_rigid {
            self.model = self.model.keeping_rigid()?;
        }
        if let Some(method) = method {
            self.model = with_method(self.model, self.bonds.as_ref(), method)?;
        }
        if let Some(rate) = friction {
            if *rate <= Rational::default() {
                return Err(Error::input("friction", rate, "a rate of friction must be positive"));
            }
            self.friction = Some(rate.clone());
        }
        Ok(self)
    }

    /// What decides: the linear system at the equilibrium, where there are nonlinear bonds.
    pub fn model(&self) -> &dyn Model {
        &*self.model
    }

    /// What the friction of the file does; `None` where it has none.
    ///
    /// # Errors
    /// As [`Model::friction`].
    pub fn friction(&self, limits: &Limits) -> Result<Option<Friction>> {
        self.friction.as_ref().map(|rate| self.model.friction(rate, limits)).transpose()
    }

    /// The name of each degree of freedom, where the file has names.
    pub fn labels(&self) -> Option<&[String]> {
        self.labels.as_deref()
    }

    /// The whole input, as it was read.
    pub fn source(&self) -> &Value {
        &self.source
    }

    /// The title, or nothing.
    pub fn title(&self) -> &str {
        self.source["title"].as_str().unwrap_or_default()
    }

    /// The name of the unit in which the file's times are, where it gives one.
    pub fn time_unit(&self) -> Option<&str> {
        self.source.get("time_unit").and_then(Value::as_str)
    }

    /// The equilibrium, where there are bonds.
    pub fn equilibrium(&self) -> Option<&[f64]> {
        self.bonds.as_ref().map(|n| n.equilibrium.as_slice())
    }

    /// The integrator's own periodic orbit beside the equilibrium, and the verdict about it; `None` where
    /// there are no nonlinear bonds, or where the equilibrium is the orbit.
    ///
    /// # Errors
    /// Where no orbit is found; as [`decide_along`](systems::decide_along).
    pub fn own_orbit(&self, limits: &Limits) -> Result<Option<OwnOrbit>> {
        let Some(nonlinear) = self.bonds.as_ref().filter(|bonds| !bonds.is_harmonic) else { return Ok(None) };
        let masses: Vec<f64> = self.masses()?.iter().map(to_f64).collect();
        nonlinear.own_orbit(&masses, limits)
    }

    /// Whether [`SystemScene::model`] is all there is: no bond but harmonic ones.
    pub fn is_linear(&self) -> bool {
        self.bonds.as_ref().is_none_or(|n| n.is_harmonic)
    }

    /// The simulation of the linear system in doubles, from positions and momenta.
    ///
    /// # Errors
    /// A mass matrix that is not diagonal, steps that are irrational, and as [`Simulation::new`].
    pub fn linear_simulation(&self, x: Vec<f64>, p: Vec<f64>) -> Result<Simulation<f64, avi::Linear<f64>>> {
        let clocks = self.model.to_run()?.clocks();
        let force = |clock: &Potential| {
            let particles = clock.stiffness.support();
            let row = |&i: &usize| particles.iter().map(|&j| to_f64(&clock.stiffness.get(i, j))).collect();
            let rows = particles.iter().map(row).collect();
            avi::Linear::new(particles, rows)
        };
        let forces = clocks.iter().map(force).collect::<Result<Vec<_>>>()?;
        let steps: Vec<_> = clocks.iter().map(|c| c.step.clone()).collect();
        let phases: Vec<_> = clocks.iter().map(|c| c.phase.clone()).collect();
        Simulation::new(&self.masses()?, forces, Clocks::new(&steps, &phases)?, State::new(x, p))
    }

    /// The simulation of the bonds themselves; `None` where the file has none.
    ///
    /// # Errors
    /// As [`SystemScene::linear_simulation`].
    pub fn nonlinear_simulation(&self, x: Vec<f64>, p: Vec<f64>) -> Result<Option<Simulation<f64, Bond>>> {
        let Some(nonlinear) = &self.bonds else { return Ok(None) };
        let clocks = Clocks::new(&nonlinear.steps, &nonlinear.phases)?;
        Simulation::new(&self.masses()?, nonlinear.bonds.clone(), clocks, State::new(x, p)).map(Some)
    }

    fn masses(&self) -> Result<Vec<Rational>> {
        let mass = self.model.to_run()?.mass();
        if !mass.is_diagonal() {
            let remedy = "Algorithm 1 moves particle by particle: give masses in place of mass_matrix";
            return Err(Error::input("mass_matrix", "not diagonal", remedy));
        }
        Ok((0..mass.size()).map(|i| mass.get(i, i)).collect())
    }
}

/// The model under another integrator, unless bonds are there whose forces are not linear.
fn with_method(model: Arc<dyn Model>, bonds: Option<&Nonlinear>, method: Method) -> Result<Arc<dyn Model>> {
    if bonds.is_some_and(|bonds| !bonds.is_harmonic) {
        return Err(Error::input("method", method, "is for linear systems: give springs in place of bonds"));
    }
    if method == model.method() { Ok(model) } else { model.with_method(method) }
}

fn check_schema(schema: &str) -> Result<()> {
    if schema == SCHEMA {
        return Ok(());
    }
    Err(of_another_kind(schema, SCHEMA))
}

/// A model, the bonds at whose equilibrium it is, and labels of its degrees of freedom, where the file
/// implies some.
struct Described {
    model: Arc<dyn Model>,
    bonds: Option<Nonlinear>,
    labels: Option<Vec<String>>,
}

impl Document {
    fn model(&self) -> Result<Described> {
        let is_explicit = self.masses.is_some() || self.potentials.is_some();
        match (&self.build, &self.mesh) {
            (Some(build), None) if !is_explicit => {
                let model = self.with_scheme(build.system()?, &[])?;
                Ok(Described { model, bonds: None, labels: None })
            }
            (None, Some(mesh)) if !is_explicit => {
                let substeps = match self.named_scheme()? {
                    Some((LocalScheme::Avi, levels)) => {
                        Some(ElementSteps::substeps(&mesh.levels(levels)?, mesh.elements.len())?)
                    }
                    _ => None,
                };
                let (system, moving) = mesh.system(substeps.as_deref())?;
                let model = self.with_scheme(system, &moving)?;
                Ok(Described { model, bonds: None, labels: Some(mesh::labels(&moving)) })
            }
            (None, None) => {
                let (model, bonds) = self.explicit()?;
                Ok(Described { model, bonds, labels: None })
            }
            _ => {
                let remedy = "give either build, or mesh, or masses and potentials";
                let field = if self.build.is_some() { "build" } else { "mesh" };
                Err(Error::input(field, "given", remedy))
            }
        }
    }

    fn explicit(&self) -> Result<(Arc<dyn Model>, Option<Nonlinear>)> {
        if self.symmetric == Some(false) {
            self.refuse_scheme()?;
            return Ok((Arc::new(self.jacobians()?), None));
        }
        if let Some(oscillator) = self.oscillator()? {
            self.refuse_scheme()?;
            return Ok((Arc::new(oscillator), None));
        }
        let (mass, potentials) = (self.mass()?, self.potentials()?);
        let n = mass.size();
        let has_bonds = potentials.iter().any(|potential| !potential.bonds.is_empty());
        let linear =
            potentials.iter().enumerate().map(|(k, potential_document)| potential_document.linear(k, n));
        match linear.collect::<Result<Vec<_>>>() {
            Ok(linear) if has_bonds => {
                let (system, bonds) = self.at_equilibrium(mass, potentials, linear)?;
                if let Some(scheme) = &self.scheme {
                    let remedy = "is for linear systems: give springs in place of bonds";
                    return Err(Error::input("scheme", scheme, remedy));
                }
                self.refuse_scheme()?;
                Ok((Arc::new(system), Some(bonds)))
            }
            Ok(linear) => Ok((self.with_scheme(System::new(mass, linear)?, &[])?, None)),
            Err(error) if has_bonds => Err(error),
            Err(error) => {
                let beside_pi = self.beside_pi(mass)?.ok_or(error)?;
                self.refuse_scheme()?;
                Ok((Arc::new(beside_pi), None))
            }
        }
    }
}
