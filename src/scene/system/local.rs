//! Local time steps in a system file: leapfrog as codes for waves have it.
//!
//! ```json
//! "scheme": "lts",
//! "levels": [{"fine": [4, 5, 6], "substeps": 2}, {"fine": [5], "substeps": 3}]
//! ```
//!
//! * All potentials have one step, dt, and masses are diagonal.
//! * `levels`, the coarsest first: `fine`, the degrees of freedom that take `substeps` in a step of the level above, or `elements` of a mesh,
//!   with all their nodes. Each level is a part of the one above.

use std::collections::BTreeSet;

use super::document::{Document, LevelDocument, MeshDocument, Number};
use crate::error::{Error, Result};
use crate::system::{Level, LocalSteps, Model, System};

/// The only scheme so far that has a name.
pub(super) const NAME: &str = "lts";

impl Document {
    /// The model with the scheme of the file, where it names one; `moving` are node and axis of each degree of freedom of a mesh.
    pub fn with_scheme(&self, model: Model, moving: &[(usize, usize)]) -> Result<Model> {
        let levels = match (self.scheme.as_deref(), &self.levels) {
            (None, None) => return Ok(model),
            (Some(NAME), Some(levels)) => levels,
            (Some(NAME), None) => {
                let remedy = "give levels, as [{\"fine\": [3, 4], \"substeps\": 2}]";
                return Err(Error::input("levels", "missing", remedy));
            }
            (Some(other), _) => {
                let remedy = "lts, leapfrog with local time steps, is the only one with a name";
                return Err(Error::input("scheme", other, remedy));
            }
            (None, Some(_)) => {
                return Err(Error::input(
                    "levels",
                    "given",
                    "are those of a scheme: give \"scheme\": \"lts\", too",
                ));
            }
        };
        let Model::Rational(plain) = model else {
            return Err(Error::input("scheme", NAME, "is for rational numbers in the file, without pi"));
        };
        if self.friction.is_some() {
            return Err(Error::input(
                "friction",
                "given",
                "has no place in a scheme of local steps: leave it out",
            ));
        }
        let level = |(l, own)| self.level(l, own, &plain, moving);
        let levels = levels.iter().enumerate().map(level).collect::<Result<_>>()?;
        Ok(Model::LocalSteps(LocalSteps::new(plain, levels)?))
    }

    fn level(
        &self,
        l: usize,
        own: &LevelDocument,
        plain: &System,
        moving: &[(usize, usize)],
    ) -> Result<Level> {
        let field = |name: &str| format!("levels[{l}].{name}");
        let indices = |name: &str, all: &[Number], n: usize| {
            all.iter().map(|i| i.index(&field(name), n)).collect::<Result<BTreeSet<_>>>()
        };
        let fine = match (&own.fine, &own.elements, &self.mesh) {
            (Some(fine), None, _) => indices("fine", fine, plain.size())?,
            (None, Some(elements), Some(mesh)) => {
                let elements = indices("elements", elements, mesh.elements.len())?;
                mesh.degrees_of_freedom(&elements, moving)?
            }
            _ => {
                let remedy = "give fine, the degrees of freedom, or elements, those of a mesh";
                return Err(Error::input(&format!("levels[{l}]"), "not told", remedy));
            }
        };
        let substeps = own.substeps.count(&field("substeps"), LocalSteps::MOST_SUBSTEPS as usize)? as u32;
        Ok(Level { fine, substeps })
    }
}

impl MeshDocument {
    /// Those of all nodes of some elements.
    fn degrees_of_freedom(
        &self,
        elements: &BTreeSet<usize>,
        moving: &[(usize, usize)],
    ) -> Result<BTreeSet<usize>> {
        let nodes = elements.iter().flat_map(|&e| &self.elements[e]);
        let nodes = nodes
            .map(|node| node.index("mesh.elements", self.nodes.len()))
            .collect::<Result<BTreeSet<_>>>()?;
        Ok((0..moving.len()).filter(|&k| nodes.contains(&moving[k].0)).collect())
    }
}
