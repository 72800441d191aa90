//! Measured levels as a molecule to be advised on.

use serde_json::{Value, json};

use super::SystemScene;
use super::document::Document;
use molecules::unit::{self, Dimension};
use molecules::{Direct, Molecule, Names, Scheme, Told};
use number::{Error, Rational, Result};
use systems::Body;

/// A system file for an archive that holds `fast`, `slow`, `masses` and `positions`: mass-weighted, 1/ps²,
/// the steps in fs.
pub fn of_archive(npz: &str, steps: [&Rational; 2]) -> Value {
    let at = |array: &str| json!({"npz": npz, "array": array});
    let step = |step: &Rational| (step / Rational::from_integer(1000.into())).to_string();
    let potential =
        |name: &str, value: &Rational| json!({"name": name, "step": step(value), "stiffness": at(name)});
    json!({"schema": super::SCHEMA, "title": npz, "time_unit": "ps", "mass_weighted": true, "masses": at("masses"), "positions": at("positions"),
        "potentials": [potential("fast", steps[0]), potential("slow", steps[1])]})
}

impl SystemScene {
    /// The molecule with the scheme of steps of its file, in fs.
    ///
    /// # Errors
    /// As [`SystemScene::scheme`].
    pub fn molecule(&self) -> Result<(Molecule, Scheme)> {
        let (scheme, unit) = (self.scheme()?, self.femtoseconds()?);
        let levels = self.model.measured()?.levels()?;
        Ok((Molecule::new(levels.source, unit, self.names(levels.body)?, levels.accuracy), scheme))
    }

    /// Forces that are no gradient, to be advised on; `None` where they are gradients.
    ///
    /// # Errors
    /// As [`SystemScene::femtoseconds`]; labels that do not fit.
    pub fn direct(&self) -> Result<Option<Direct>> {
        let Some(jacobians) = self.model.jacobians() else { return Ok(None) };
        let names = match jacobians.accuracy() {
            Some(_) => self.names(jacobians.body())?,
            None => Names::of_labels(self.labels.clone().unwrap_or_default()),
        };
        Ok(Some(Direct::new(jacobians.clone(), self.femtoseconds()?, names)))
    }

    /// The names of atoms, from the labels, elements and bonds of the file.
    fn names(&self, body: &Body) -> Result<Names> {
        let document = Document::parse(self.source(), None)?;
        let labels = document.labels.clone().unwrap_or_default();
        let (Some(positions), Some(moving)) = (&body.positions, &body.masses) else {
            return Ok(Names::of_labels(labels));
        };
        let Some(given) = document.masses(moving.len(), &self.arrays)? else {
            return Ok(Names::of_labels(labels));
        };
        let of_atoms = |masses: &[f64]| masses.chunks_exact(3).map(|values| values[0]).collect::<Vec<_>>();
        let (elements, bonds) = (document.elements.unwrap_or_default(), document.bonded);
        let told = Told { labels, elements, bonds, masses: of_atoms(&given) };
        Ok(Names::new(told, positions, of_atoms(moving)))
    }

    /// The steps of measured levels, or of forces that are no gradient, in fs.
    ///
    /// # Errors
    /// A file without `time_unit`, or with another than fs, ps, ns or s; as
    /// [`Model::measured`](systems::Model::measured).
    pub fn scheme(&self) -> Result<Scheme> {
        let steps = match self.model.jacobians() {
            Some(jacobians) => jacobians.steps(),
            None => self.model.measured()?.steps_of_kicks()?,
        };
        let unit = self.femtoseconds()?;
        Scheme::new(steps.into_iter().map(|step| step * &unit).collect())
    }

    /// The file's unit of time in fs.
    ///
    /// # Errors
    /// A file without `time_unit`, or with another than fs, ps, ns or s.
    pub fn femtoseconds(&self) -> Result<Rational> {
        let missing = || {
            Error::missing(
                "time_unit",
                "say what its steps are in: \"time_unit\": \"ps\" in the file, time_unit='ps' in Python",
            )
        };
        let one = format!("1 {}", self.time_unit().ok_or_else(missing)?);
        unit::rational("time_unit", &one, Dimension::Time)
    }
}
