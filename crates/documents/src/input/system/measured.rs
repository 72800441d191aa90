//! Stiffnesses by reference to NumPy's files: Hessians as people measure them, in doubles.
//!
//! ```json
//! {
//!     "schema": "kickdrift/system/1",
//!     "mass_weighted": true,
//!     "masses": {"npz": "water.npz", "array": "masses"},
//!     "positions": {"npz": "water.npz", "array": "positions"},
//!     "accuracy": 1e-6,
//!     "potentials": [
//!         {"name": "bonded", "step": "1/2000", "stiffness": {"npz": "water.npz", "array": "fast"}},
//!         {"name": "rest", "step": "1/250", "stiffness": {"npy": "slow.npy"}}
//!     ]
//! }
//! ```
//!
//! Rigid motions are projected out: by `positions` three translations and three rotations, with `"periodic":
//! true` the translations alone, else the common null space of all stiffnesses, if it is no larger than that.
//! What a stiffness holds is not rigid, each by its own accuracy: then the file is refused, or the motion
//! stays (see [`Removed`](systems::Removed)).
//!
//! Constraints hold distances (see `held`). A `method` integrates two levels otherwise than by kicks and
//! drifts: the force of the shorter step is followed exactly, or by the midpoint rule, over the whole longer
//! one, and the other force kicks, filtered (see [`Method`](systems::levels::Method)). With `"symmetric":
//! false` a stiffness is the Jacobian, minus the derivative of the force. By the words of `labels`, by
//! `elements` and `bonded`, or by masses and distances, the motions of a molecule are named. Along an orbit,
//! which is at rest at t = 0 and at T/2, a free molecule has `positions` at t = 0 and `turned`, those at T/2,
//! by which its rigid motions are set apart; in other coordinates than those of atoms `rigid` has them.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::array::{Arrays, Reference};
use super::document::{Document, LARGEST, PotentialDocument};
use super::given::Given;
use super::held::{Particles, reweigh};
use super::part::Number;
use number::{Error, Rational, Result, to_f64};
use systems::{Along, Body, Jacobians, MeasuredSystem, Model};

/// How well a measured stiffness is known unless its file says so: a Hessian by differences is good to some
/// 10^-6 of its norm.
const USUAL_ACCURACY: f64 = 1e-6;

/// From a file of dense stiffnesses.
pub(super) fn read(document: &Document, arrays: &Arrays) -> Result<Arc<dyn Model>> {
    if document.scheme.is_some() || document.levels.is_some() {
        let remedy = "a dense stiffness by reference takes none: name its compressed rows (csr), or write its numbers in the file";
        return Err(Error::input("scheme", "local time steps", remedy));
    }
    if document.along_orbit {
        return document.along(arrays);
    }
    for (field, is_given) in [("turned", document.turned.is_some()), ("rigid", document.rigid.is_some())] {
        if is_given {
            return Err(Error::input(field, "given", "is for \"along_orbit\": true: leave it out"));
        }
    }
    let potentials = document.potentials()?.iter().enumerate();
    let mut read =
        potentials.map(|(k, potential)| potential.measured(k, arrays)).collect::<Result<Vec<_>>>()?;
    let n = read.first().map_or(0, |read| read.stiffness.nrows());
    if n == 0 || n > LARGEST {
        return Err(Error::input("potentials", n, format!("give 1 to {LARGEST} degrees of freedom")));
    }
    let is_sound = |k: &DMatrix<f64>| k.shape() == (n, n) && k.iter().all(|x| x.is_finite());
    if !read.iter().all(|read| is_sound(&read.stiffness)) {
        let remedy = format!("give {n} x {n} finite numbers for each potential");
        return Err(Error::input("potentials", "a stiffness", remedy));
    }
    let masses = document.masses(n, arrays)?;
    if masses.is_none() && !document.mass_weighted {
        return Err(Error::missing("masses", "give them, or say \"mass_weighted\": true"));
    }
    let positions = document.positions(n, arrays)?;
    let (is_weighted, is_periodic) = (document.mass_weighted, document.periodic);
    let mut body = Body { masses, positions, is_weighted, is_periodic, held: None, rigid: None };
    document.transform(&mut body, &mut read, arrays)?;
    let accuracy = document.accuracy()?;
    let potentials: Vec<_> = read.into_iter().map(|read| (read.step, read.stiffness)).collect();
    let model: Arc<dyn Model> = if document.symmetric != Some(false) {
        let measured_system = MeasuredSystem::new(body, potentials, accuracy)?;
        Arc::new(if document.keep_rigid { measured_system.keeping_rigid() } else { measured_system })
    } else {
        Arc::new(Jacobians::measured(&body, &potentials, accuracy, document.keep_rigid)?)
    };
    document.method.as_ref().map_or(Ok(Arc::clone(&model)), |method| model.with_method(method.parse()?))
}

impl Document {
    /// Hessians along an orbit.
    fn along(&self, arrays: &Arrays) -> Result<Arc<dyn Model>> {
        let refused = [
            ("mass_weighted", self.mass_weighted),
            ("constraints", self.constraints.is_some()),
            ("hydrogen_mass", self.hydrogen_mass.is_some()),
            ("method", self.method.is_some()),
            ("symmetric", self.symmetric == Some(false)),
        ];
        if let Some((field, _)) = refused.iter().find(|(_, is_given)| *is_given) {
            return Err(Error::input(field, "given", "has no place along an orbit: leave it out"));
        }
        let (mut steps, mut kicks) = (Vec::new(), Vec::new());
        for (k, potential_document) in self.potentials()?.iter().enumerate() {
            let field = format!("potentials[{k}].stiffness");
            steps.push(potential_document.step(k)?);
            if potential_document.scale.is_some() || potential_document.force.is_some() {
                let remedy = "scale and force have no place along an orbit: leave them out";
                return Err(Error::input(&format!("potentials[{k}]"), "given", remedy));
            }
            let matrixes = potential_document.array(k)?.read(&field, arrays)?.matrices(&field)?;
            check_symmetric(&field, &matrixes, self.accuracy()?)?;
            kicks.push(matrixes);
        }
        let n = kicks.first().and_then(|kicks: &Vec<DMatrix<f64>>| kicks.first()).map_or(0, DMatrix::nrows);
        if n == 0 || n > LARGEST {
            return Err(Error::input("potentials", n, format!("give 1 to {LARGEST} degrees of freedom")));
        }
        let masses = self.masses(n, arrays)?.ok_or_else(|| Error::missing("masses", "give them"))?;
        let along = Along::new(&masses, &steps, &kicks)?.at_accuracy(self.accuracy()?)?;
        if let Some(at) = &self.rigid {
            let ends = at.read("rigid", arrays)?.matrices("rigid")?;
            if self.keep_rigid || self.periodic || self.positions.is_some() || self.turned.is_some() {
                let remedy = "stands in place of positions, turned, periodic and keep_rigid: leave these out";
                return Err(Error::input("rigid", "given", remedy));
            }
            return Ok(Arc::new(along.free_of(&ends)?));
        }
        let turned = self.turned.as_ref().map(|at| at.read("turned", arrays)).transpose()?;
        let turned = turned.map(|turned| triples(&turned.into_values(), n)).transpose()?;
        Ok(Arc::new(match (self.positions(n, arrays)?, turned) {
            _ if self.keep_rigid => along,
            _ if self.periodic => along.in_box()?,
            (Some(start), Some(turned)) => along.turning([&start, &turned])?,
            (None, None) => along,
            (start, _) => {
                let missing = if start.is_some() { "turned" } else { "positions" };
                let remedy =
                    "give where the atoms are at both ends of the half period, or say \"keep_rigid\": true";
                return Err(Error::missing(missing, remedy));
            }
        }))
    }
}

/// A potential as it was read, its stiffness times its scale.
struct Read {
    step: Rational,
    scale: f64,
    stiffness: DMatrix<f64>,
}

impl Document {
    /// Whether some stiffness is sparse.
    pub fn is_sparse(&self) -> bool {
        let is_sparse = |potential: &PotentialDocument| {
            matches!(potential.stiffness, Some(Given::Array(Reference::Csr { .. })))
        };
        self.potentials.iter().flatten().any(is_sparse)
    }

    /// The mass of each degree of freedom, where masses are given.
    pub fn masses(&self, n: usize, arrays: &Arrays) -> Result<Option<Vec<f64>>> {
        let masses = match (&self.masses, &self.mass_matrix) {
            (None, None) => return Ok(None),
            (Some(_), Some(_)) => {
                let remedy = "stands in place of masses: give one of them";
                return Err(Error::input("mass_matrix", "given", remedy));
            }
            (None, Some(Given::Here(_))) => {
                let remedy = "stands beside stiffnesses by rows: here name the file of a diagonal matrix, or give masses";
                return Err(Error::input("mass_matrix", "by rows", remedy));
            }
            (Some(Given::Here(all)), None) => {
                let number = |(i, number): (usize, &Number)| {
                    number.read(&format!("masses[{i}]")).map(|value| to_f64(&value))
                };
                all.iter().enumerate().map(number).collect::<Result<_>>()?
            }
            (Some(Given::Array(at)), None) => at.read("masses", arrays)?.into_diagonal("masses")?,
            (None, Some(Given::Array(at))) => at.read("mass_matrix", arrays)?.into_diagonal("mass_matrix")?,
        };
        spread(masses, n).map(Some)
    }

    /// The positions of the particles, where they are given. Elements and bonds are checked against the
    /// number of particles.
    pub fn positions(&self, n: usize, arrays: &Arrays) -> Result<Option<Vec<[f64; 3]>>> {
        let positions = self.positions.as_ref().map(|at| at.read("positions", arrays)).transpose()?;
        let positions = positions.map(|positions| triples(&positions.into_values(), n)).transpose()?;
        self.check_atoms(n).map(|()| positions)
    }

    /// The accuracy that the file gives, or the usual one.
    pub fn accuracy(&self) -> Result<f64> {
        let given = self.accuracy.as_ref().map(|number| number.read("accuracy")).transpose()?;
        Ok(given.map_or(USUAL_ACCURACY, |value| to_f64(&value)))
    }

    /// That elements and bonds are those of the particles that there are.
    fn check_atoms(&self, n: usize) -> Result<()> {
        let remedy = || format!("there are {} particles of three coordinates, counted from 0", n / 3);
        match (&self.elements, self.bonded.iter().flatten().find(|pair| pair.iter().any(|&i| 3 * i + 2 >= n)))
        {
            (Some(all), _) if 3 * all.len() != n => {
                Err(Error::input("elements", format!("{} of them", all.len()), remedy()))
            }
            (_, Some(pair)) => Err(Error::input("bonded", format!("{pair:?}"), remedy())),
            _ => Ok(()),
        }
    }

    /// Heavier hydrogens first, then constraints: the stiffnesses as they are then, and what is held.
    fn transform(&self, body: &mut Body, read: &mut [Read], arrays: &Arrays) -> Result<()> {
        if self.constraints.is_none() && self.hydrogen_mass.is_none() {
            return Ok(());
        }
        let (Some(masses), Some(positions)) = (&mut body.masses, &body.positions) else {
            let field = if body.masses.is_none() { "masses" } else { "positions" };
            return Err(Error::missing(
                field,
                "constraints and heavy hydrogens need masses and positions in the file",
            ));
        };
        // By the masses as given: heavy hydrogens are hydrogens still.
        let named = self.constraints.as_ref();
        let pairs = named.map(|named| Particles { masses, positions }.pairs(named)).transpose()?;
        let old = body.is_weighted.then(|| masses.clone());
        if let Some(mass) = &self.hydrogen_mass {
            *masses = Particles { masses, positions }.heavier(to_f64(&mass.read("hydrogen_mass")?))?;
        }
        read.iter_mut().for_each(|read| reweigh(&mut read.stiffness, old.as_deref(), masses));
        body.is_weighted = true;
        let Some(pairs) = pairs else { return Ok(()) };
        let particles = Particles { masses, positions };
        for (k, (potential_document, read)) in self.potentials()?.iter().zip(read).enumerate() {
            let field = format!("potentials[{k}].force");
            let remedy = "give the force of each potential at the positions: its tension bends the bonds that are held";
            let force = potential_document.force.as_ref().ok_or_else(|| Error::missing(&field, remedy))?;
            let force: Vec<f64> =
                force.read(&field, arrays)?.into_values().iter().map(|x| x * read.scale).collect();
            particles.bend(&mut read.stiffness, &force, &pairs)?;
        }
        body.held = Some(particles.gradients(&pairs));
        Ok(())
    }
}

impl PotentialDocument {
    /// The step of the k-th potential.
    pub fn step(&self, k: usize) -> Result<Rational> {
        let field = format!("potentials[{k}].step");
        let step = self.step.read(&field)?;
        if step <= Rational::default() {
            return Err(Error::input(&field, step, "a step must be positive"));
        }
        Ok(step)
    }

    /// The array of the k-th potential's stiffness.
    pub fn array(&self, k: usize) -> Result<&Reference> {
        let refused = |value: &str, remedy: &str| {
            Err(Error::input(&format!("potentials[{k}].stiffness"), value, remedy))
        };
        match &self.stiffness {
            Some(Given::Array(at)) => Ok(at),
            Some(Given::Here(_)) => refused("by rows", "give all stiffnesses by reference, or all by rows"),
            None => refused(
                "missing",
                "name its array, as {\"npy\": \"h.npy\"}: those of others are by reference, too",
            ),
        }
    }

    fn measured(&self, k: usize, arrays: &Arrays) -> Result<Read> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let step = self.step(k)?;
        let stiffness = self.array(k)?.read(&field("stiffness"), arrays)?.matrix(&field("stiffness"))?;
        let scale = self.scale.as_ref().map(|scale| scale.read(&field("scale"))).transpose()?;
        let scale = scale.map_or(1.0, |value| to_f64(&value));
        Ok(Read { step, scale, stiffness: stiffness * scale })
    }
}

/// That the Hessians of a clock's kicks are symmetric to their accuracy, which is relative to the largest
/// norm among them: within that the symmetric part is taken.
fn check_symmetric(field: &str, kicks: &[DMatrix<f64>], accuracy: f64) -> Result<()> {
    let largest = kicks.iter().map(DMatrix::norm).fold(0.0, f64::max);
    let square = kicks.iter().enumerate().filter(|(_, matrix)| matrix.is_square());
    for (k, matrix) in square {
        let off = matrix - matrix.transpose();
        if off.norm() / 2.0 > accuracy * largest {
            let (i, j) = off.map(f64::abs).iamax_full();
            let remedy = format!(
                "differs from [{j}][{i}] by {:e}, more than the accuracy of {accuracy:e} allows: give (K + K.T)/2 of the \
                 matrix K that should be symmetric, or an accuracy that covers it",
                off[(i, j)].abs()
            );
            return Err(Error::input(&format!("{field}[{k}][{i}][{j}]"), matrix[(i, j)], remedy));
        }
    }
    Ok(())
}

/// A mass for each degree of freedom, from one each or from one for each three.
fn spread(masses: Vec<f64>, n: usize) -> Result<Vec<f64>> {
    let wrong = || {
        let remedy = format!("there are {n} degrees of freedom: give a mass for each, or for each three");
        Error::input("masses", masses.len(), remedy)
    };
    if let Some((i, mass)) = masses.iter().enumerate().find(|(_, mass)| **mass <= 0.0) {
        return Err(Error::input(&format!("masses[{i}]"), mass, "a mass must be positive"));
    }
    match masses.len() {
        k if k == n => Ok(masses),
        k if 3 * k == n => Ok(masses.iter().flat_map(|&m| [m; 3]).collect()),
        _ => Err(wrong()),
    }
}

fn triples(positions: &[f64], n: usize) -> Result<Vec<[f64; 3]>> {
    if positions.len() != n || !n.is_multiple_of(3) {
        let remedy = format!("there are {n} degrees of freedom: give three coordinates for each particle");
        return Err(Error::input("positions", format!("{} numbers", positions.len()), remedy));
    }
    Ok(positions.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect())
}
