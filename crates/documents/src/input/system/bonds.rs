//! Bonds of named forms, and the linear system at their equilibrium.

use super::document::{BondDocument, Document, PotentialDocument, Spring, ends};
use super::linear::numbers;
use super::part::{Index, Number};
use clocks::schedule::Schedule;
use number::{Error, Rational, Result, from_f64_exact, to_f64};
use systems::avi::{self, Bond, Clocked, Form};
use systems::{Limits, OwnOrbit, Potential, Symmetric, System, decide_along};

/// A system with bonds as it is simulated: harmonic springs are bonds too.
#[derive(Clone, Debug)]
pub(super) struct Nonlinear {
    pub bonds: Vec<Bond>,
    pub steps: Vec<Rational>,
    pub phases: Vec<Rational>,
    pub equilibrium: Vec<f64>,
    /// Whether all forms are harmonic: the linear system is then the system itself.
    pub is_harmonic: bool,
}

/// An orbit as near to the equilibrium as Newton's method leaves both is the equilibrium.
const LEAST_DISPLACEMENT: f64 = 1e-12;

impl Nonlinear {
    /// `None` where the equilibrium is the orbit.
    pub fn own_orbit(&self, masses: &[f64], limits: &Limits) -> Result<Option<OwnOrbit>> {
        let mut clocks: Vec<(&Rational, &Rational)> = self.steps.iter().zip(&self.phases).collect();
        clocks.sort();
        clocks.dedup();
        let place = |pair| clocks.binary_search(&pair).expect("one of them");
        let clock_of: Vec<usize> = self.steps.iter().zip(&self.phases).map(place).collect();
        let steps: Vec<_> = clocks.iter().map(|(step, _)| (*step).clone()).collect();
        let phases: Vec<_> = clocks.iter().map(|(_, phase)| (*phase).clone()).collect();
        let schedule = Schedule::new(&steps, &phases)?;
        let clocked = Clocked { masses, bonds: &self.bonds, clock_of: &clock_of, schedule: &schedule };
        let orbit = clocked.periodic_orbit(&self.equilibrium)?;
        let off = orbit.start.iter().zip(&self.equilibrium).map(|(y, x)| (y - x).abs());
        let displacement = off.fold(0.0, f64::max);
        let scale = self.equilibrium.iter().fold(1.0, |a: f64, x| a.max(x.abs()));
        if displacement <= LEAST_DISPLACEMENT * scale {
            return Ok(None);
        }
        let analysis = decide_along(masses, &schedule, &orbit.hessians, limits)?;
        Ok(Some(OwnOrbit { start: orbit.start, displacement, analysis }))
    }
}

impl Document {
    /// The Hessians of the bonds at the equilibrium near `near`, each with its potential's clock.
    pub fn at_equilibrium(
        &self,
        mass: Symmetric,
        potentials: &[PotentialDocument],
        mut linear: Vec<Potential>,
    ) -> Result<(System, Nonlinear)> {
        let n = mass.size();
        let (mut bonds, mut owners) = (Vec::new(), Vec::new());
        for (k, document) in potentials.iter().enumerate() {
            let own = document.bonds(k, n)?;
            owners.extend(own.iter().map(|_| k));
            bonds.extend(own);
        }
        let near = numbers("near", self.near.as_deref().unwrap_or(&vec![Number::Json("0".into()); n]))?;
        if near.len() != n {
            return Err(Error::input("near", format!("{} positions", near.len()), format!("give {n}")));
        }
        let equilibrium = avi::equilibrium(&bonds, &near.iter().map(to_f64).collect::<Vec<_>>())?;
        for (bond, &k) in bonds.iter().zip(&owners) {
            let particles = avi::Force::particles(bond);
            let at: Vec<_> = particles.iter().map(|&i| equilibrium[i]).collect();
            let curvature = from_f64_exact(bond.curvature(&at)).ok_or_else(|| {
                let field = format!("potentials[{k}].bonds");
                Error::input(&field, "no finite curvature", "start nearer to an equilibrium")
            })?;
            linear[k].stiffness.add_spring(particles[0], particles.get(1).copied(), &curvature);
        }
        let of_owner =
            |part: fn(&Potential) -> &Rational| owners.iter().map(|&k| part(&linear[k]).clone()).collect();
        let (steps, phases) = (of_owner(|p| &p.step), of_owner(|p| &p.phase));
        let is_harmonic = potentials.iter().flat_map(|p| &p.bonds).all(|bond| bond.form == "harmonic");
        Ok((System::new(mass, linear)?, Nonlinear { bonds, steps, phases, equilibrium, is_harmonic }))
    }
}

impl PotentialDocument {
    /// The bonds of a file that has some: springs are harmonic ones.
    fn bonds(&self, k: usize, n: usize) -> Result<Vec<Bond>> {
        let field = |what: &str, b: usize| format!("potentials[{k}].{what}[{b}]");
        if self.stiffness.is_some() || (self.bonds.is_empty() && !self.springs.is_empty()) {
            let remedy = "a file with bonds writes every force as a bond: a spring is a harmonic one";
            return Err(Error::input(&format!("potentials[{k}]"), "springs or stiffness", remedy));
        }
        let scale = match &self.scale {
            Some(scale) => to_f64(&scale.read(&format!("potentials[{k}].scale"))?),
            None => 1.0,
        };
        let join = |field: &str, i: &Index, j: Option<&Index>, form: Form| {
            Ok(match ends(field, i, j, n)? {
                (i, Some(j)) => Bond::between(i, j, form.scaled(scale)),
                (i, None) => Bond::wall(i, form.scaled(scale)),
            })
        };
        let bond = |(b, bond): (usize, &BondDocument)| {
            let field = field("bonds", b);
            join(&field, &bond.i, bond.j.as_ref(), bond.form(&field)?)
        };
        let spring = |(b, (i, j, value)): (usize, &Spring)| {
            let field = field("springs", b);
            join(&field, i, j.as_ref(), Form::Harmonic { k: to_f64(&value.read(&field)?) })
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
