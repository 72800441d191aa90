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
//!         {"step": "1/2", "stiffness": [["2", "-1"], ["-1", "2"]]},
//!         {"step": "1/2", "bonds": [{"i": 0, "j": 1, "form": "quartic", "k": "1", "beta": "1/3"}]}
//!     ],
//!     "near": ["0", "0"]
//! }
//! ```
//!
//! * All quantities are exact strings (or JSON integers) without π; indices count from 0.
//! * `masses`, or `mass_matrix` by rows.
//! * A potential has a `step`, a `phase` (0 unless given, or 1/2), and at least one of `springs` (i, j, k; j null for a
//!   wall), `stiffness` (by rows), `bonds` (a named form between i and j, without j to a wall at 0). They add up.
//! * Forms: `harmonic` (k), `quartic` (k, beta), `lennard-jones` (epsilon, sigma). With bonds other than harmonic the
//!   system is the linear one at the equilibrium found near the positions `near`: exact for the Hessian in doubles,
//!   which is itself rounded.
//! * In place of masses and potentials, `build`: `{"kind": "chain", "masses": 200, "stiffness": [...], "steps": [...]}`,
//!   `{"kind": "stiff-soft", "pairs": 4, "stiff": "100", "steps": [stiff, soft]}`,
//!   `{"kind": "graded-bar", "elements": 100, "classes": 10, "courant": "1/4"}`,
//!   `{"kind": "tethered-pair", "masses": [...], "stiffness": [bond, tether], "steps": [bond, tether]}`.

use serde::Deserialize;

use crate::avi::{self, Bond, Clocks, Form, Simulation, State};
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::parse::parse_rational;
use crate::number::rational::{from_f64_exact, to_f64};
use crate::system::{Potential, Symmetric, System, builders};

/// The schema that this version reads.
const SCHEMA: &str = "kickdrift/system/1";

/// The longest file, in bytes.
const LONGEST: usize = 16 << 20;

/// The most degrees of freedom: dense matrices of this size still fit.
const LARGEST: usize = 4096;

/// An exact number: a string, or an integer.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Number {
    Text(String),
    Integer(i64),
}

impl Number {
    fn read(&self, field: &str) -> Result<Rational> {
        match self {
            Number::Text(text) => parse_rational(field, text),
            Number::Integer(n) => Ok(Rational::from_integer((*n).into())),
        }
    }
}

/// The fields of a system file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: String,
    title: Option<String>,
    masses: Option<Vec<Number>>,
    mass_matrix: Option<Vec<Vec<Number>>>,
    potentials: Option<Vec<PotentialDocument>>,
    near: Option<Vec<Number>>,
    build: Option<Build>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PotentialDocument {
    /// For people.
    #[serde(rename = "name")]
    _name: Option<String>,
    step: Number,
    phase: Option<Number>,
    #[serde(default)]
    springs: Vec<(usize, Option<usize>, Number)>,
    stiffness: Option<Vec<Vec<Number>>>,
    #[serde(default)]
    bonds: Vec<BondDocument>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BondDocument {
    i: usize,
    j: Option<usize>,
    form: String,
    k: Option<Number>,
    beta: Option<Number>,
    epsilon: Option<Number>,
    sigma: Option<Number>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
enum Build {
    Chain { masses: usize, stiffness: Vec<Number>, steps: Vec<Number> },
    StiffSoft { pairs: usize, stiff: Number, steps: [Number; 2] },
    GradedBar { elements: usize, classes: usize, courant: Number },
    TetheredPair { masses: [Number; 2], stiffness: [Number; 2], steps: [Number; 2] },
}

/// A system file, read and checked.
#[derive(Clone, Debug)]
pub struct SystemScene {
    title: String,
    system: System,
    nonlinear: Option<Nonlinear>,
}

/// A system with bonds as it is simulated: harmonic springs are bonds too.
#[derive(Clone, Debug)]
struct Nonlinear {
    bonds: Vec<Bond>,
    steps: Vec<Rational>,
    phases: Vec<Rational>,
    equilibrium: Vec<f64>,
}

impl SystemScene {
    /// Reads a system from the text of its file.
    ///
    /// # Errors
    /// JSON that is no system, an unknown field, a quantity that does not parse, an index out of range, and whatever
    /// [`System::new`] refuses; each by the entry's name.
    pub fn read(text: &str) -> Result<SystemScene> {
        if text.len() > LONGEST {
            let remedy = "a system has at most 16 MiB; is this the right file?";
            return Err(Error::input("system", format!("{} bytes", text.len()), remedy));
        }
        let document: Document = serde_json::from_str(text).map_err(|cause| {
            Error::input("system", cause, "write one JSON object as in data/scenes/diatomic-tether.json")
        })?;
        if document.schema != SCHEMA {
            return Err(Error::input("schema", &document.schema, format!("this version reads {SCHEMA}")));
        }
        let title = document.title.clone().unwrap_or_default();
        match &document.build {
            Some(build) if document.masses.is_none() && document.potentials.is_none() => {
                Ok(SystemScene { title, system: build.system()?, nonlinear: None })
            }
            Some(_) => Err(Error::input("build", "given", "give either build, or masses and potentials")),
            None => document.explicit(title),
        }
    }

    /// The title, or nothing.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The linear system: that at the equilibrium, where there are nonlinear bonds.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The equilibrium, where there are bonds.
    pub fn equilibrium(&self) -> Option<&[f64]> {
        self.nonlinear.as_ref().map(|n| n.equilibrium.as_slice())
    }

    /// The simulation of the linear system in doubles, from positions and momenta.
    ///
    /// # Errors
    /// A mass matrix that is not diagonal, and as [`Simulation::new`].
    pub fn linear_simulation(&self, x: Vec<f64>, p: Vec<f64>) -> Result<Simulation<f64, avi::Linear<f64>>> {
        let force = |clock: &Potential| {
            let particles = clock.stiffness.support();
            let row = |&i: &usize| particles.iter().map(|&j| to_f64(&clock.stiffness.get(i, j))).collect();
            let rows = particles.iter().map(row).collect();
            avi::Linear::new(particles, rows)
        };
        let forces = self.system.clocks().iter().map(force).collect::<Result<Vec<_>>>()?;
        let steps: Vec<_> = self.system.clocks().iter().map(|c| c.step.clone()).collect();
        let phases: Vec<_> = self.system.clocks().iter().map(|c| c.phase.clone()).collect();
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
        if !self.system.mass().is_diagonal() {
            let remedy = "Algorithm 1 moves particle by particle: give masses in place of mass_matrix";
            return Err(Error::input("mass_matrix", "not diagonal", remedy));
        }
        Ok((0..self.system.size()).map(|i| self.system.mass().get(i, i)).collect())
    }
}

fn numbers(field: &str, values: &[Number]) -> Result<Vec<Rational>> {
    values.iter().enumerate().map(|(i, x)| x.read(&format!("{field}[{i}]"))).collect()
}

fn matrix(field: &str, rows: &[Vec<Number>]) -> Result<Symmetric> {
    let read = |(i, row): (usize, &Vec<Number>)| numbers(&format!("{field}[{i}]"), row);
    Symmetric::dense(field, &rows.iter().enumerate().map(read).collect::<Result<Vec<_>>>()?)
}

fn in_range(field: &str, i: usize, n: usize) -> Result<()> {
    if i < n { Ok(()) } else { Err(Error::input(field, i, format!("indices are 0 to {}", n.max(1) - 1))) }
}

impl Document {
    fn explicit(&self, title: String) -> Result<SystemScene> {
        let mass = match (&self.masses, &self.mass_matrix) {
            (Some(masses), None) => Symmetric::diagonal(&numbers("masses", masses)?),
            (None, Some(rows)) => matrix("mass_matrix", rows)?,
            _ => return Err(Error::input("masses", "missing", "give masses or mass_matrix, one of them")),
        };
        let n = mass.size();
        if n > LARGEST {
            return Err(Error::input("masses", n, format!("at most {LARGEST} degrees of freedom")));
        }
        let missing = || Error::input("potentials", "missing", "give at least one potential with its step");
        let potentials = self.potentials.as_ref().filter(|p| !p.is_empty()).ok_or_else(missing)?;
        let linear =
            potentials.iter().enumerate().map(|(k, p)| p.linear(k, n)).collect::<Result<Vec<_>>>()?;
        if potentials.iter().all(|p| p.bonds.is_empty()) {
            return Ok(SystemScene { title, system: System::new(mass, linear)?, nonlinear: None });
        }
        self.at_equilibrium(title, mass, potentials, linear)
    }

    fn at_equilibrium(
        &self,
        title: String,
        mass: Symmetric,
        potentials: &[PotentialDocument],
        mut linear: Vec<Potential>,
    ) -> Result<SystemScene> {
        let n = mass.size();
        let mut nonlinear = Nonlinear { bonds: vec![], steps: vec![], phases: vec![], equilibrium: vec![] };
        let mut owners = Vec::new();
        for (k, (document, potential)) in potentials.iter().zip(&linear).enumerate() {
            for bond in document.bonds(k, n)? {
                nonlinear.bonds.push(bond);
                nonlinear.steps.push(potential.step.clone());
                nonlinear.phases.push(potential.phase.clone());
                owners.push(k);
            }
        }
        let near = numbers("near", self.near.as_deref().unwrap_or(&vec![Number::Integer(0); n]))?;
        if near.len() != n {
            return Err(Error::input("near", format!("{} positions", near.len()), format!("give {n}")));
        }
        let near: Vec<_> = near.iter().map(to_f64).collect();
        nonlinear.equilibrium = avi::equilibrium(&nonlinear.bonds, &near)?;
        for (bond, k) in nonlinear.bonds.iter().zip(owners) {
            let ends = avi::Force::particles(bond);
            let at: Vec<_> = ends.iter().map(|&i| nonlinear.equilibrium[i]).collect();
            let curvature = from_f64_exact(bond.curvature(&at)).ok_or_else(|| {
                Error::input(
                    &format!("potentials[{k}].bonds"),
                    "no finite curvature",
                    "start nearer to an equilibrium",
                )
            })?;
            // Springs and matrices beside bonds were given to the bonds already, as harmonic ones.
            linear[k].stiffness.add_spring(ends[0], ends.get(1).copied(), &curvature);
        }
        Ok(SystemScene { title, system: System::new(mass, linear)?, nonlinear: Some(nonlinear) })
    }
}

impl PotentialDocument {
    /// Springs and matrix; where there are bonds anywhere in the file, springs stand among the bonds instead.
    fn linear(&self, k: usize, n: usize) -> Result<Potential> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let mut stiffness = match &self.stiffness {
            Some(rows) => matrix(&field("stiffness"), rows)?,
            None => Symmetric::zero(n),
        };
        if self.bonds.is_empty() {
            for (s, (i, j, value)) in self.springs.iter().enumerate() {
                let field = field(&format!("springs[{s}]"));
                in_range(&field, *i, n.min(stiffness.size()))?;
                j.iter().try_for_each(|j| in_range(&field, *j, n.min(stiffness.size())))?;
                if *j == Some(*i) {
                    return Err(Error::input(
                        &field,
                        i,
                        "a spring joins two different indices, or one and null",
                    ));
                }
                stiffness.add_spring(*i, *j, &value.read(&field)?);
            }
        }
        let phase =
            self.phase.as_ref().map_or(Ok(Rational::default()), |phase| phase.read(&field("phase")))?;
        Ok(Potential { stiffness, step: self.step.read(&field("step"))?, phase })
    }

    /// The bonds of a file that has some: springs are harmonic ones.
    fn bonds(&self, k: usize, n: usize) -> Result<Vec<Bond>> {
        let field = |what: &str, b: usize| format!("potentials[{k}].{what}[{b}]");
        if self.stiffness.is_some() || (self.bonds.is_empty() && !self.springs.is_empty()) {
            let remedy = "a file with bonds writes every force as a bond: a spring is a harmonic one";
            return Err(Error::input(&format!("potentials[{k}]"), "springs or stiffness", remedy));
        }
        let bond = |(b, bond): (usize, &BondDocument)| {
            let field = field("bonds", b);
            in_range(&field, bond.i, n)?;
            let form = bond.form(&field)?;
            match bond.j {
                Some(j) => in_range(&field, j, n).map(|()| Bond::between(bond.i, j, form)),
                None => Ok(Bond::wall(bond.i, form)),
            }
        };
        let spring = |(b, (i, j, value)): (usize, &(usize, Option<usize>, Number))| {
            let field = field("springs", b);
            in_range(&field, *i, n)?;
            let form = Form::Harmonic { k: to_f64(&value.read(&field)?) };
            match j {
                Some(j) => in_range(&field, *j, n).map(|()| Bond::between(*i, *j, form)),
                None => Ok(Bond::wall(*i, form)),
            }
        };
        let springs = self.springs.iter().enumerate().map(spring);
        self.bonds.iter().enumerate().map(bond).chain(springs).collect()
    }
}

impl BondDocument {
    fn form(&self, field: &str) -> Result<Form> {
        let value = |name: &str, value: &Option<Number>| {
            let field = format!("{field}.{name}");
            let missing = || Error::input(&field, "missing", format!("the form {} needs it", self.form));
            Ok(to_f64(&value.as_ref().ok_or_else(missing)?.read(&field)?))
        };
        match self.form.as_str() {
            "harmonic" => Ok(Form::Harmonic { k: value("k", &self.k)? }),
            "quartic" => Ok(Form::Quartic { k: value("k", &self.k)?, beta: value("beta", &self.beta)? }),
            "lennard-jones" => Ok(Form::LennardJones {
                epsilon: value("epsilon", &self.epsilon)?,
                sigma: value("sigma", &self.sigma)?,
            }),
            _ => {
                Err(Error::input(&format!("{field}.form"), &self.form, "harmonic, quartic or lennard-jones"))
            }
        }
    }
}

impl Build {
    fn system(&self) -> Result<System> {
        let size = |field: &str, n: usize| {
            if n <= LARGEST { Ok(()) } else { Err(Error::input(field, n, format!("at most {LARGEST}"))) }
        };
        let pair = |field: &str, pair: &[Number; 2]| -> Result<[Rational; 2]> {
            Ok([pair[0].read(&format!("{field}[0]"))?, pair[1].read(&format!("{field}[1]"))?])
        };
        match self {
            Build::Chain { masses, stiffness, steps } => {
                size("build.masses", *masses)?;
                let stiffness = numbers("build.stiffness", stiffness)?;
                builders::periodic_chain(*masses, &stiffness, &numbers("build.steps", steps)?)
            }
            Build::StiffSoft { pairs, stiff, steps } => {
                size("build.pairs", pairs.saturating_mul(2))?;
                let [h_stiff, h_soft] = pair("build.steps", steps)?;
                builders::stiff_soft_chain(*pairs, &stiff.read("build.stiff")?, [&h_stiff, &h_soft])
            }
            Build::GradedBar { elements, classes, courant } => {
                size("build.elements", *elements)?;
                builders::graded_bar(*elements, *classes, &courant.read("build.courant")?)
            }
            Build::TetheredPair { masses, stiffness, steps } => {
                let [m1, m2] = pair("build.masses", masses)?;
                let [bond, tether] = pair("build.stiffness", stiffness)?;
                let [h_bond, h_tether] = pair("build.steps", steps)?;
                builders::tethered_pair([&m1, &m2], (&bond, &h_bond), (&tether, &h_tether))
            }
        }
    }
}
