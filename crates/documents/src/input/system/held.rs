//! Molecules: bonds that are held, hydrogens that are made heavier.
//!
//! A held distance is σ = |x_a − x_b|²/2. On what the constraints leave, with the kinetic energy as metric, a
//! potential V has the second derivative Zᵀ (∇²V − Σ λ_c ∇²σ_c) Z, Z a basis of the tangent space, λ the
//! multipliers of V's own gradient (mass-weighted, least squares): the tension that its force puts on a bond
//! bends it. At a minimum the tensions of all potentials cancel, those of one alone do not.

use nalgebra::{DMatrix, DVector};
use serde::Deserialize;
use serde_json::Value;

use super::part::Part;
use crate::report::shape::Shape;
use number::{Error, Result};

/// Atoms up to this mass are hydrogens (deuterium is none).
const HYDROGEN: f64 = 1.1;

/// `"h-bonds"` or pairs of particles, counted from 0.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "Value")]
pub(super) enum Constraints {
    Word(String),
    Pairs(Vec<[usize; 2]>),
}

impl Part for Constraints {
    const SHAPE: Shape = Shape::Any(&[
        Shape::OneOf(&["h-bonds"]),
        Shape::With(&<Vec<[usize; 2]>>::SHAPE, r#"{"minItems": 1}"#),
    ]);
}

impl TryFrom<Value> for Constraints {
    type Error = String;

    fn try_from(value: Value) -> std::result::Result<Self, String> {
        if let Value::String(word) = value {
            return Ok(Constraints::Word(word));
        }
        let pairs = Vec::deserialize(&value).map(Constraints::Pairs);
        pairs.map_err(|_| {
            format!("{value} are no constraints: write \"h-bonds\", or pairs of particles, as [[0, 1]]")
        })
    }
}

/// Point masses in space.
pub(super) struct Particles<'a> {
    /// One for each coordinate.
    pub masses: &'a [f64],
    pub positions: &'a [[f64; 3]],
}

impl Particles<'_> {
    fn is_hydrogen(&self, i: usize) -> bool {
        self.masses[3 * i] <= HYDROGEN
    }

    /// Each hydrogen with the nearest heavier particle.
    fn hydrogens(&self) -> Vec<[usize; 2]> {
        let square = |i: usize, j: usize| {
            (0..3).map(|a| (self.positions[i][a] - self.positions[j][a]).powi(2)).sum::<f64>()
        };
        let all = || 0..self.positions.len();
        let heavy = |i: usize| {
            all().filter(|&j| !self.is_hydrogen(j)).min_by(|&j, &k| square(i, j).total_cmp(&square(i, k)))
        };
        all().filter(|&i| self.is_hydrogen(i)).filter_map(|i| Some([i, heavy(i)?])).collect()
    }

    /// The pairs that are held.
    pub fn pairs(&self, constraints: &Constraints) -> Result<Vec<[usize; 2]>> {
        let n = self.positions.len();
        let pairs = match constraints {
            Constraints::Word(word) if word == "h-bonds" => self.hydrogens(),
            Constraints::Word(word) => {
                return Err(Error::input(
                    "constraints",
                    word,
                    "write h-bonds, or pairs of particles, as [[0, 1]]",
                ));
            }
            Constraints::Pairs(pairs) => pairs.clone(),
        };
        match pairs.iter().find(|[a, b]| *a >= n || *b >= n || a == b) {
            Some(pair) => Err(Error::input(
                "constraints",
                format!("{pair:?}"),
                format!("there are {n} particles, counted from 0"),
            )),
            None if pairs.is_empty() => Err(Error::input(
                "constraints",
                "none",
                "no mass is up to 1.1, a hydrogen's: give pairs, as [[0, 1]]",
            )),
            None => Ok(pairs),
        }
    }

    /// The masses with every hydrogen of this mass; its heavy particle, the nearest one, loses what it gains.
    ///
    /// # Errors
    /// A mass that is not positive, or one that leaves a heavy particle none.
    pub fn heavier(&self, hydrogen: f64) -> Result<Vec<f64>> {
        let mut masses = self.masses.to_vec();
        for [light, heavy] in self.hydrogens() {
            (0..3).for_each(|a| masses[3 * heavy + a] -= hydrogen - self.masses[3 * light + a]);
            (0..3).for_each(|a| masses[3 * light + a] = hydrogen);
        }
        if masses.iter().all(|&mass| mass > 0.0) {
            return Ok(masses);
        }
        Err(Error::input(
            "hydrogen_mass",
            hydrogen,
            "give a positive mass that leaves every heavy particle some, as 3.024",
        ))
    }

    /// Gradients of the σ, mass-weighted, as columns.
    pub fn gradients(&self, pairs: &[[usize; 2]]) -> DMatrix<f64> {
        let mut columns = DMatrix::zeros(self.masses.len(), pairs.len());
        for (c, &[a, b]) in pairs.iter().enumerate() {
            for axis in 0..3 {
                let apart = self.positions[a][axis] - self.positions[b][axis];
                columns[(3 * a + axis, c)] = apart / self.masses[3 * a].sqrt();
                columns[(3 * b + axis, c)] = -apart / self.masses[3 * b].sqrt();
            }
        }
        columns
    }

    /// A mass-weighted second derivative as the constraints bend it, from the force that goes with it.
    ///
    /// # Errors
    /// Constraints that depend on one another; a force of another size.
    pub fn bend(&self, stiffness: &mut DMatrix<f64>, force: &[f64], pairs: &[[usize; 2]]) -> Result<()> {
        if force.len() != self.masses.len() || force.iter().any(|x| !x.is_finite()) {
            let remedy = format!("give {} finite numbers, one for each coordinate", self.masses.len());
            return Err(Error::input("force", format!("{} numbers", force.len()), remedy));
        }
        let columns = self.gradients(pairs);
        let slope =
            DVector::from_iterator(force.len(), force.iter().zip(self.masses).map(|(f, m)| -f / m.sqrt()));
        let normal = (columns.transpose() * &columns).cholesky().ok_or_else(|| {
            Error::input(
                "constraints",
                format!("{} pairs", pairs.len()),
                "they depend on one another: leave some out",
            )
        })?;
        let multipliers = normal.solve(&(columns.transpose() * slope));
        for (&[a, b], multiplier) in pairs.iter().zip(multipliers.iter()) {
            for axis in 0..3 {
                let (i, j) = (3 * a + axis, 3 * b + axis);
                stiffness[(i, i)] -= multiplier / self.masses[i];
                stiffness[(j, j)] -= multiplier / self.masses[j];
                let off = multiplier / (self.masses[i] * self.masses[j]).sqrt();
                stiffness[(i, j)] += off;
                stiffness[(j, i)] += off;
            }
        }
        Ok(())
    }
}

/// M^-½ K M^-½ of masses m from that of `old` ones (all 1: from K itself).
pub(super) fn reweigh(stiffness: &mut DMatrix<f64>, old: Option<&[f64]>, new: &[f64]) {
    let factor: Vec<f64> =
        new.iter().enumerate().map(|(i, m)| (old.map_or(1.0, |old| old[i]) / m).sqrt()).collect();
    for i in 0..stiffness.nrows() {
        for j in 0..stiffness.ncols() {
            stiffness[(i, j)] *= factor[i] * factor[j];
        }
    }
}
