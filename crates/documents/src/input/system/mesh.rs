//! Meshes in a system file.
//!
//! ```json
//! "mesh": {
//!     "nodes": [[0], [3], [5]],
//!     "elements": [[0, 1], [1, 2]],
//!     "fixed": [0, 2],
//!     "young": 1, "density": 1,
//!     "courant": "87/100"
//! }
//! ```
//!
//! The steps: `step` for all; or `steps`, one an element; or `steps` one a class with `classes`, the class of
//! each element; or `courant`, for bars: the step of each is that times l/c, c = √(young/density).

use std::collections::BTreeSet;

use num_traits::{One, Zero};

use super::document::{Fixed, LARGEST, MeshDocument, Plane, at_most};
use super::linear::numbers;
use super::part::{Index, Number};
use number::{Error, Rational, Result};
use systems::System;
use systems::mesh::{Material, Mesh, root};

/// A label for each degree of freedom.
pub(super) fn labels(moving: &[(usize, usize)]) -> Vec<String> {
    moving.iter().map(|&(node, axis)| format!("node {node} {}", ["x", "y", "z"][axis])).collect()
}

impl MeshDocument {
    /// The system, and the node and the axis of each degree of freedom; each element takes so many substeps
    /// in its step, where they are given.
    pub fn system(&self, substeps: Option<&[u32]>) -> Result<(System, Vec<(usize, usize)>)> {
        let mut mesh = self.mesh()?;
        for ((_, step), &substeps) in mesh.elements.iter_mut().zip(substeps.unwrap_or_default()) {
            *step /= Rational::from_integer(substeps.into());
        }
        let axes = mesh.nodes.first().map_or(0, Vec::len);
        let size = mesh.nodes.len() * axes;
        if size > LARGEST {
            return Err(Error::input(
                "mesh.nodes",
                mesh.nodes.len(),
                format!("at most {LARGEST} degrees of freedom"),
            ));
        }
        mesh.system()
    }

    /// The nodes, the nodes of each element, and the node and the axis of each degree of freedom.
    #[expect(clippy::type_complexity, reason = "said above, used once")]
    pub fn placed(&self) -> Result<(Vec<Vec<Rational>>, Vec<Vec<usize>>, Vec<(usize, usize)>)> {
        let (mesh, (_, moving)) = (self.mesh()?, self.system(None)?);
        Ok((mesh.nodes, mesh.elements.into_iter().map(|(nodes, _)| nodes).collect(), moving))
    }

    fn mesh(&self) -> Result<Mesh> {
        let read = |what: &str, rows: &[Vec<Number>]| -> Result<Vec<Vec<Rational>>> {
            rows.iter().enumerate().map(|(i, row)| numbers(&format!("mesh.{what}[{i}]"), row)).collect()
        };
        at_most("mesh.nodes", self.nodes.len())?;
        let nodes = read("nodes", &self.nodes)?;
        let element = |(e, numbers): (usize, &Vec<Index>)| {
            let index = |i: &Index| i.read(&format!("mesh.elements[{e}]"), nodes.len());
            numbers.iter().map(index).collect::<Result<Vec<_>>>()
        };
        let elements: Vec<_> = self.elements.iter().enumerate().map(element).collect::<Result<_>>()?;
        let optional = |name: &str, given: &Option<Number>, default: Rational| {
            given.as_ref().map_or(Ok(default), |number| number.read(&format!("mesh.{name}")))
        };
        let material = Material {
            young: self.young.read("mesh.young")?,
            poisson: optional("poisson", &self.poisson, Rational::zero())?,
            density: self.density.read("mesh.density")?,
            thickness: optional("thickness", &self.thickness, Rational::one())?,
            is_plane_strain: self.plane == Some(Plane::Strain),
        };
        let axes = nodes.first().map_or(0, Vec::len);
        let mut fixed = BTreeSet::new();
        for (k, own) in self.fixed.iter().enumerate() {
            let field = format!("mesh.fixed[{k}]");
            match own {
                Fixed::Axis([node, axis]) => {
                    fixed.insert((node.read(&field, nodes.len())?, axis.read(&field, axes)?));
                }
                Fixed::Node(node) => {
                    let node = node.read(&field, nodes.len())?;
                    fixed.extend((0..axes).map(|axis| (node, axis)));
                }
            }
        }
        let mut mesh = Mesh {
            nodes,
            elements: elements.into_iter().map(|element| (element, Rational::zero())).collect(),
            fixed,
            material,
        };
        mesh.check()?;
        let steps = self.steps_of(&mesh)?;
        mesh.elements.iter_mut().zip(steps).for_each(|((_, value), step)| *value = step);
        Ok(mesh)
    }

    /// The step of each element.
    fn steps_of(&self, mesh: &Mesh) -> Result<Vec<Rational>> {
        let n = mesh.elements.len();
        match (&self.step, &self.steps, &self.classes, &self.courant) {
            (Some(step), None, None, None) => Ok(vec![step.read("mesh.step")?; n]),
            (None, Some(steps), None, None) if steps.len() == n => numbers("mesh.steps", steps),
            (None, Some(steps), None, None) => {
                let remedy = format!("give {n}, one an element, or the class of each element, too");
                Err(Error::input("mesh.steps", steps.len(), remedy))
            }
            (None, Some(steps), Some(classes), None) if classes.len() == n => {
                let steps = numbers("mesh.steps", steps)?;
                let class = |(e, number): (usize, &Index)| {
                    Ok(steps[number.read(&format!("mesh.classes[{e}]"), steps.len())?].clone())
                };
                classes.iter().enumerate().map(class).collect()
            }
            (None, Some(_), Some(classes), None) => {
                Err(Error::input("mesh.classes", classes.len(), format!("give {n}, one an element")))
            }
            (None, None, None, Some(courant)) => self.courant(mesh, &courant.read("mesh.courant")?),
            _ => Err(Error::input(
                "mesh.step",
                "missing, or one of several",
                "give step, steps, steps with classes, or courant, one of them",
            )),
        }
    }

    /// C l/c for bars.
    fn courant(&self, mesh: &Mesh, courant: &Rational) -> Result<Vec<Rational>> {
        let speed = root(&(&mesh.material.young / &mesh.material.density));
        let step = |(e, (own, _)): (usize, &(Vec<usize>, Rational))| {
            let field = || format!("mesh.elements[{e}]");
            let [Some(a), Some(b)] = [0, 1].map(|k| own.get(k).and_then(|&node| mesh.nodes.get(node))) else {
                return Err(Error::input(&field(), format!("{own:?}"), "a bar has 2 nodes"));
            };
            if own.len() != 2 {
                return Err(Error::input(&field(), format!("{own:?}"), "courant is for bars: give steps"));
            }
            let square: Rational = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            let length = root(&square).zip(speed.clone());
            length
                .map(|(length, speed)| courant * length / speed)
                .ok_or_else(|| Error::input(&field(), format!("{own:?}"), "its length is beyond all doubles"))
        };
        mesh.elements.iter().enumerate().map(step).collect()
    }
}
