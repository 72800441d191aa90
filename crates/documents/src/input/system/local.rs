//! Local time steps in a system file: leapfrog as codes for waves have it, AVI.
//!
//! ```json
//! "scheme": "lts",
//! "levels": [{"fine": [4, 5, 6], "substeps": 2}, {"fine": [5], "substeps": 3}]
//! ```
//!
//! In `avi` each element is a clock of its own, and levels are of `elements` alone.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::document::{Document, LevelDocument, MeshDocument};
use super::given::Given;
use super::part::Index;
use number::{Error, Result};
use systems::{ElementSteps, Level, LocalSteps, Model, Scheme, System};

impl Document {
    /// The scheme that the file names, with its levels.
    pub fn named_scheme(&self) -> Result<Option<(Scheme, &[LevelDocument])>> {
        match (self.scheme.as_deref().map(str::parse).transpose()?, &self.levels) {
            (None, None) => Ok(None),
            (Some(scheme), Some(levels)) => Ok(Some((scheme, levels))),
            (Some(_), None) => {
                let remedy = "give levels, as [{\"fine\": [3, 4], \"substeps\": 2}]";
                Err(Error::input("levels", "missing", remedy))
            }
            (None, Some(_)) => {
                let remedy = "belong to a scheme: give \"scheme\": \"lts\", too, or avi";
                Err(Error::input("levels", "given", remedy))
            }
        }
    }

    /// That the file names no scheme, whose numbers must be rational.
    pub fn refuse_scheme(&self) -> Result<()> {
        let Some((scheme, _)) = self.named_scheme()? else { return Ok(()) };
        Err(Error::input("scheme", scheme.name(), "is for rational numbers in the file, without pi"))
    }

    /// The model with the scheme of the file, where it names one; `moving` are node and axis of each degree
    /// of freedom of a mesh.
    pub fn with_scheme(&self, plain: System, moving: &[(usize, usize)]) -> Result<Arc<dyn Model>> {
        let Some((scheme, levels)) = self.named_scheme()? else { return Ok(Arc::new(plain)) };
        if scheme == Scheme::Avi {
            // Its clocks are those of the elements already.
            let Some(mesh) = &self.mesh else {
                let remedy = "needs a mesh, whose elements take the steps; without one give each potential its own step and leave out scheme";
                return Err(Error::input("scheme", "avi", remedy));
            };
            return Ok(Arc::new(ElementSteps::new(plain, mesh.elements.len(), mesh.levels(levels)?)?));
        }
        if self.friction.is_some() {
            let remedy = "has no place in a scheme of local steps: leave it out";
            return Err(Error::input("friction", "given", remedy));
        }
        let level = |(l, level_document)| self.level(l, level_document, &plain, moving);
        let levels = levels.iter().enumerate().map(level).collect::<Result<_>>()?;
        Ok(Arc::new(LocalSteps::new(plain, levels)?))
    }

    fn level(
        &self,
        l: usize,
        level_document: &LevelDocument,
        plain: &System,
        moving: &[(usize, usize)],
    ) -> Result<Level> {
        let field = |name: &str| format!("levels[{l}].{name}");
        let fine = match (
            Given::here(&level_document.fine, &field("fine"))?,
            &level_document.elements,
            &self.mesh,
        ) {
            (Some(fine), None, _) => indices(&field("fine"), fine, plain.size())?,
            (None, Some(elements), Some(mesh)) => {
                let elements = indices(&field("elements"), elements, mesh.elements.len())?;
                mesh.degrees_of_freedom(&elements, moving)?
            }
            (fine, elements, _) => {
                let given = if fine.is_some() && elements.is_some() { "both" } else { "none" };
                let remedy = "give one of them: fine, the degrees of freedom, or elements, parts of a mesh";
                return Err(Error::input(&format!("levels[{l}]"), given, remedy));
            }
        };
        Ok(Level { fine, substeps: level_document.count(l)? })
    }
}

/// Indices below n.
pub(super) fn indices(field: &str, all: &[Index], n: usize) -> Result<BTreeSet<usize>> {
    all.iter().map(|i| i.read(field, n)).collect()
}

impl LevelDocument {
    /// Its substeps.
    pub fn count(&self, l: usize) -> Result<u32> {
        let field = format!("levels[{l}].substeps");
        Ok(self.substeps.read(&field, LocalSteps::MOST_SUBSTEPS as usize)? as u32)
    }
}

impl MeshDocument {
    /// Levels of elements.
    pub fn levels(&self, levels: &[LevelDocument]) -> Result<Vec<Level>> {
        let level = |(l, level_document): (usize, &LevelDocument)| {
            let (Some(elements), None) = (&level_document.elements, &level_document.fine) else {
                let remedy =
                    "name elements: with avi elements have steps of their own, degrees of freedom have none";
                return Err(Error::input(&format!("levels[{l}]"), "no elements", remedy));
            };
            let fine = indices(&format!("levels[{l}].elements"), elements, self.elements.len())?;
            Ok(Level { fine, substeps: level_document.count(l)? })
        };
        levels.iter().enumerate().map(level).collect()
    }

    /// The degrees of freedom of all nodes of some elements.
    fn degrees_of_freedom(
        &self,
        elements: &BTreeSet<usize>,
        moving: &[(usize, usize)],
    ) -> Result<BTreeSet<usize>> {
        let nodes = elements.iter().flat_map(|&e| &self.elements[e]);
        let nodes = nodes
            .map(|node| node.read("mesh.elements", self.nodes.len()))
            .collect::<Result<BTreeSet<_>>>()?;
        Ok((0..moving.len()).filter(|&k| nodes.contains(&moving[k].0)).collect())
    }
}
