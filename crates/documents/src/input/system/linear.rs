//! Masses and stiffnesses from a file, and the usual systems by name.

use super::document::{
    Build, Chain, Document, GradedBar, LARGEST, PotentialDocument, Rows, StiffSoft, TetheredPair, at_most,
    ends,
};
use super::given::Given;
use super::part::Number;
use nalgebra::DMatrix;
use number::{Error, Rational, Result};
use systems::{Jacobians, Potential, Symmetric, System, builders};

/// One number for each degree of freedom, or fewer.
pub(super) fn numbers(field: &str, values: &[Number]) -> Result<Vec<Rational>> {
    at_most(field, values.len())?;
    values.iter().enumerate().map(|(i, x)| x.read(&format!("{field}[{i}]"))).collect()
}

fn matrix(field: &str, rows: &[Vec<Number>]) -> Result<Symmetric> {
    at_most(field, rows.len())?;
    let read = |(i, row): (usize, &Vec<Number>)| numbers(&format!("{field}[{i}]"), row);
    Symmetric::dense(field, &rows.iter().enumerate().map(read).collect::<Result<Vec<_>>>()?)
}

impl Document {
    /// M, checked for its size alone.
    pub fn mass(&self) -> Result<Symmetric> {
        let (masses, rows) =
            (Given::here(&self.masses, "masses")?, Given::here(&self.mass_matrix, "mass_matrix")?);
        match (masses, rows) {
            (Some(masses), None) => Ok(Symmetric::diagonal(&numbers("masses", masses)?)),
            (None, Some(rows)) => matrix("mass_matrix", rows),
            _ => Err(Error::input("masses", "missing", "give masses or mass_matrix, one of them")),
        }
    }

    /// The potentials, at least one.
    pub fn potentials(&self) -> Result<&[PotentialDocument]> {
        let missing = || Error::input("potentials", "missing", "give at least one potential with its step");
        self.potentials.as_deref().filter(|p| !p.is_empty()).ok_or_else(missing)
    }
}

impl Document {
    /// Forces that are no gradient: `stiffness` by rows is minus the derivative of the force.
    pub fn jacobians(&self) -> Result<Jacobians> {
        let masses = Given::here(&self.masses, "masses")?.ok_or_else(|| {
            Error::missing("masses", "a force that is no gradient needs them, one for each degree of freedom")
        })?;
        let masses = numbers("masses", masses)?;
        let given = self
            .potentials()?
            .iter()
            .enumerate()
            .map(|(k, potential_document)| potential_document.jacobian(k, masses.len()));
        Jacobians::rational(&masses, &given.collect::<Result<Vec<_>>>()?)
    }
}

impl PotentialDocument {
    /// The rows of the k-th potential's stiffness.
    pub fn rows(&self, k: usize) -> Result<Option<&[Vec<Number>]>> {
        Given::here(&self.stiffness, &format!("potentials[{k}].stiffness"))
            .map(|rows| rows.map(Rows::as_slice))
    }

    /// Springs and matrix on n degrees of freedom, which need not be symmetric, with step and phase.
    fn jacobian(&self, k: usize, n: usize) -> Result<(DMatrix<Rational>, Rational, Rational)> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        if !self.bonds.is_empty() {
            return Err(Error::input(
                &field("bonds"),
                "given",
                "bonds have gradients: give springs or stiffness",
            ));
        }
        let mut springs = self.clone();
        (springs.stiffness, springs.scale) = (None, None);
        let springs = springs.linear(k, n)?;
        let mut matrix = springs.stiffness.to_dense();
        if let Some(rows) = self.rows(k)? {
            at_most(&field("stiffness"), rows.len())?;
            let read =
                |(i, row): (usize, &Vec<Number>)| numbers(&format!("{}[{i}]", field("stiffness")), row);
            let rows = rows.iter().enumerate().map(read).collect::<Result<Vec<_>>>()?;
            if rows.len() != n || rows.iter().any(|row| row.len() != n) {
                let remedy = format!("there are {n} masses: give {n} rows of {n} numbers");
                return Err(Error::input(&field("stiffness"), format!("{} rows", rows.len()), remedy));
            }
            matrix += DMatrix::from_fn(n, n, |i, j| rows[i][j].clone());
        }
        if let Some(scale) = &self.scale {
            let scale = scale.read(&field("scale"))?;
            matrix.iter_mut().for_each(|x| *x *= &scale);
        }
        Ok((matrix, springs.step, springs.phase))
    }

    /// Springs and matrix on n degrees of freedom, with the clock; bonds stand elsewhere.
    pub fn linear(&self, k: usize, n: usize) -> Result<Potential> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let mut stiffness = match self.rows(k)? {
            Some(rows) => matrix(&field("stiffness"), rows)?,
            None => Symmetric::zero(n),
        };
        if self.bonds.is_empty() && stiffness.size() == n {
            for (s, (i, j, value)) in self.springs.iter().enumerate() {
                let field = field(&format!("springs[{s}]"));
                let (i, j) = ends(&field, i, j.as_ref(), n)?;
                stiffness.add_spring(i, j, &value.read(&field)?);
            }
        }
        if let Some(scale) = &self.scale {
            stiffness = stiffness.scaled(&scale.read(&field("scale"))?);
        }
        let [step, phase] = self.step_and_phase(k)?;
        Ok(Potential { stiffness, step, phase })
    }

    /// The clock, in rational numbers.
    pub fn step_and_phase(&self, k: usize) -> Result<[Rational; 2]> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let phase =
            self.phase.as_ref().map_or(Ok(Rational::default()), |phase| phase.read(&field("phase")))?;
        Ok([self.step.read(&field("step"))?, phase])
    }
}

impl Build {
    pub fn system(&self) -> Result<System> {
        let pair = |field: &str, pair: &[Number; 2]| -> Result<[Rational; 2]> {
            Ok([pair[0].read(&format!("{field}[0]"))?, pair[1].read(&format!("{field}[1]"))?])
        };
        match self {
            Build::Chain(Chain { masses, stiffness, steps }) => {
                let masses = masses.read("build.masses", LARGEST)?;
                let stiffness = numbers("build.stiffness", stiffness)?;
                builders::periodic_chain(masses, &stiffness, &numbers("build.steps", steps)?)
            }
            Build::StiffSoft(StiffSoft { pairs, stiff, steps }) => {
                let pairs = pairs.read("build.pairs", LARGEST / 2)?;
                let [h_stiff, h_soft] = pair("build.steps", steps)?;
                builders::stiff_soft_chain(pairs, &stiff.read("build.stiff")?, [&h_stiff, &h_soft])
            }
            Build::GradedBar(GradedBar { elements, classes, courant }) => {
                let elements = elements.read("build.elements", LARGEST)?;
                let classes = classes.read("build.classes", LARGEST)?;
                builders::graded_bar(elements, classes, &courant.read("build.courant")?)
            }
            Build::TetheredPair(TetheredPair { masses, stiffness, steps }) => {
                let [m1, m2] = pair("build.masses", masses)?;
                let [bond, tether] = pair("build.stiffness", stiffness)?;
                let [h_bond, h_tether] = pair("build.steps", steps)?;
                builders::tethered_pair([&m1, &m2], (&bond, &h_bond), (&tether, &h_tether))
            }
        }
    }
}
