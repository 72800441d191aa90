//! A lever: one change, the step that it allows, and the engines that have it.

use super::caps::Bound;
use super::unit::{TimeUnit, decimal};
use number::{Laurent, Rational};
use words::Trigonometric;

/// One way, and how far it goes; lengths in fs.
#[derive(Clone, Debug)]
pub struct Lever {
    pub name: String,
    pub way: Way,
    /// The first unstable outer step of the periods given, one fast mode at a time; `None` where there is
    /// none ([`is_free`](Self::is_free)), or where none is computed.
    pub first: Option<(f64, f64)>,
    /// This step exactly, where it is c π^k.
    pub exact: Option<Laurent>,
    /// Whether no outer step of the band is unstable by a resonance of one fast mode.
    pub is_free: bool,
    /// Every outer step below its lower end is proven stable for all periods in the band and any coupling of
    /// such modes.
    pub band_edge: Option<(f64, f64)>,
    /// The outer step to take, and what bounds it; `None` where no step of the kind is proven.
    pub step: Option<(Rational, Bound)>,
    /// The innermost step beside it; `None` where the fast forces are solved for.
    pub inner: Option<Rational>,
    /// The step over the longest one of today's method.
    pub gain: Option<Rational>,
}

impl Lever {
    /// A lever whose steps are not computed yet.
    pub(super) fn new(name: String, way: Way) -> Lever {
        let (first, exact, band_edge, step, inner, gain) = Default::default();
        Lever { name, way, first, exact, is_free: false, band_edge, step, inner, gain }
    }

    /// A lever by friction: this rate per fs masks all growth up to this outer step.
    pub(super) fn masked(step: Rational, inner: &Rational, rate: &Rational, unit: TimeUnit) -> Lever {
        let rate = decimal(&(rate * Rational::from_integer(unit.in_rates().into())));
        let name = format!("friction {}", unit.rate(rate));
        Lever {
            step: Some((step, Bound::Friction)),
            inner: Some(inner.clone()),
            ..Lever::new(name, Way::Friction)
        }
    }

    /// Evaluations of the slowest force, a picosecond or a plain unit of time.
    pub fn slow_per_ps(&self, unit: TimeUnit) -> Option<Rational> {
        self.step.as_ref().map(|(step, _)| Rational::from_integer(unit.in_rates().into()) / step)
    }

    pub fn fast_per_ps(&self, unit: TimeUnit) -> Option<Rational> {
        self.step
            .as_ref()
            .and(self.inner.as_ref())
            .map(|step| Rational::from_integer(unit.in_rates().into()) / step)
    }

    /// Linear systems a picosecond.
    pub fn solves_per_ps(&self, unit: TimeUnit) -> Option<Rational> {
        if self.way == Way::ImplicitExplicit { self.slow_per_ps(unit) } else { None }
    }
}

/// The kind of change that a lever makes; the engines that support it stand in its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Kicks and drifts on one clock.
    Verlet,
    /// Kicks and drifts, as asked or at another ratio.
    Respa,
    /// Other masses.
    Hydrogens,
    /// No bonds with hydrogens.
    Held,
    /// Both.
    HeldAndHeavy,
    /// Exact fast flow, averaged slow force.
    Molly(Trigonometric),
    /// The slow force projected onto what the fast forces leave alone.
    Equilibrium,
    ImplicitExplicit,
    /// O in the middle of every drift.
    Friction,
}

/// An engine's keyword for a kind of lever, and where that is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keyword {
    pub engine: &'static str,
    pub keyword: &'static str,
    pub source: &'static str,
}

macro_rules! engines {
    ($($name:literal $keyword:literal $source:literal;)*) => {
        &[$(Keyword { engine: $name, keyword: $keyword, source: $source }),*]
    };
}

impl Way {
    /// The engines of which it is known.
    pub fn engines(self) -> &'static [Keyword] {
        match self {
            Way::Respa => engines! {
                "OpenMM" "MTSIntegrator" "wrappers/python/openmm/mtsintegrator.py";
                "GROMACS" "mts-level2-factor" "multipletimestepping.cpp";
                "LAMMPS" "run_style respa" "LAMMPS manual, run_style";
                "NAMD" "fullElectFrequency" "NAMD user guide, multiple timestepping";
                "Tinker" "RESPA-INNER" "respa.f";
                "i-PI" "nmts" "i-PI user guide, motion dynamics";
            },
            Way::Hydrogens => engines! {
                "OpenMM" "hydrogenMass" "wrappers/python/openmm/app/forcefield.py";
                "GROMACS" "mass-repartition-factor" "GROMACS 2024 release notes, performance";
            },
            Way::HeldAndHeavy => engines! {
                "OpenMM" "constraints=HBonds, hydrogenMass" "wrappers/python/openmm/app/forcefield.py";
                "GROMACS" "constraints = h-bonds, mass-repartition-factor" "GROMACS manual, mdp options";
            },
            Way::Held => engines! {
                "OpenMM" "constraints=HBonds" "wrappers/python/openmm/app/forcefield.py";
                "GROMACS" "constraints = h-bonds" "GROMACS manual, mdp options";
                "LAMMPS" "fix shake" "LAMMPS manual, fix shake";
                "NAMD" "rigidBonds all" "NAMD user guide, rigidBonds";
            },
            Way::Equilibrium => engines! {
                "NAMD" "molly on" "SimParameters.C";
                "LAMMPS" "fix filter/corotate" "LAMMPS manual, fix filter/corotate";
            },
            Way::Friction => engines! {
                "OpenMM" "MTSLangevinIntegrator" "wrappers/python/openmm/mtsintegrator.py";
            },
            Way::Verlet | Way::Molly(_) | Way::ImplicitExplicit => &[],
        }
    }
}
