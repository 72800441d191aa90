//! Sparse stiffnesses by reference, as SciPy writes them: two levels of many thousands of degrees of freedom.
//!
//! ```json
//! {
//!     "schema": "kickdrift/system/1",
//!     "masses": {"npz": "droplet.npz", "array": "masses"},
//!     "positions": {"npz": "droplet.npz", "array": "positions"},
//!     "potentials": [
//!         {"step": "1/2000", "stiffness": {"npz": "bonded.npz", "csr": ""}},
//!         {"step": "1/250", "stiffness": {"npz": "droplet.npz", "csr": "slow"}}
//!     ]
//! }
//! ```
//!
//! `csr` names the three arrays `data`, `indices` and `indptr` of compressed rows: `slow.data` and so on, or, where it is empty, those of a file
//! of `scipy.sparse.save_npz`. A stiffness is K, not mass-weighted, symmetric to rounding; both triangles stand in it.

use faer::Mat;
use serde::Deserialize;
use serde_json::Value;

use super::array::{Arrays, Reference};
use super::document::{Number, no_system};
use super::measured::{USUAL_ACCURACY, spread, triples};
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::rational::to_f64;
use crate::system::levels::sparse::SparseLevels;
use crate::system::levels::{rigid_motions, translations};
use crate::system::{Removed, SparseSystem};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(rename = "schema")]
    _schema: String,
    #[serde(rename = "title")]
    _title: Option<String>,
    #[serde(rename = "time_unit")]
    _time_unit: Option<String>,
    masses: Reference,
    positions: Option<Reference>,
    #[serde(default)]
    periodic: bool,
    accuracy: Option<Number>,
    #[serde(default)]
    keep_rigid: bool,
    potentials: [PotentialDocument; 2],
    labels: Option<Vec<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PotentialDocument {
    #[serde(rename = "name")]
    _name: Option<String>,
    step: Number,
    stiffness: Compressed,
}

/// `{"npz": FILE, "csr": NAME}`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Compressed {
    npz: String,
    csr: String,
}

/// The most degrees of freedom.
const LARGEST: usize = 1 << 20;

/// Whether some stiffness of the file is sparse.
pub(super) fn is_sparse(source: &Value) -> bool {
    let potentials = source.get("potentials").and_then(Value::as_array);
    let is_compressed = |own: &Value| own.get("stiffness").is_some_and(|own| own.get("csr").is_some());
    potentials.is_some_and(|all| all.iter().any(is_compressed))
}

/// From a file of two such stiffnesses, with the labels that it gives.
pub(super) fn read(source: &Value, arrays: &Arrays) -> Result<(SparseSystem, Option<Vec<String>>)> {
    let document: Document = serde_path_to_error::deserialize(source).map_err(|fault| {
        let field = fault.path().to_string();
        let error = no_system(fault.into_inner());
        if field == "." { error } else { error.at(field) }
    })?;
    let mut levels = Vec::new();
    for (k, own) in document.potentials.iter().enumerate() {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let step = own.step.read(&field("step"))?;
        if step <= Rational::default() {
            return Err(Error::input(&field("step"), step, "a step must be positive"));
        }
        levels.push((step, own.stiffness.read(&field("stiffness"), arrays)?));
    }
    levels.sort_by(|a, b| a.0.cmp(&b.0));
    let [(inner, (n, fast)), (outer, (m, slow))] = &levels[..] else { unreachable!("two of them") };
    if n != m || *n == 0 || *n > LARGEST {
        let remedy = format!("give both as many rows, 1 to {LARGEST}");
        return Err(Error::input("potentials", format!("{n} and {m} rows"), remedy));
    }
    let masses = spread(document.masses.read("masses", arrays)?.into_values(), *n)?;
    let positions = document.positions.as_ref().map(|at| at.read("positions", arrays)).transpose()?;
    let positions = positions.map(|own| triples(&own.into_values(), *n)).transpose()?;
    let particles: Vec<f64> = masses.iter().step_by(3).copied().collect();
    let (rigid, found_by) = match &positions {
        _ if document.keep_rigid || !n.is_multiple_of(3) => (Mat::zeros(*n, 0), ""),
        _ if document.periodic => (translations(&particles), "periodic box"),
        Some(positions) => (rigid_motions(positions, &particles), "positions"),
        None => (Mat::zeros(*n, 0), ""),
    };
    let count = rigid.ncols();
    let own = SparseLevels::new(&masses, [fast, slow], rigid)?;
    let [fast, slow] = own.removed();
    let removed = (count > 0).then_some(Removed { count, found_by, fast, slow });
    let accuracy = match &document.accuracy {
        Some(number) => to_f64(&number.read("accuracy")?),
        None => USUAL_ACCURACY,
    };
    Ok((SparseSystem::new(own, [inner, outer], accuracy, removed)?, document.labels))
}

/// The number of rows, and the entries of the lower triangle.
type Rows = (usize, Vec<(usize, usize, f64)>);

impl Compressed {
    fn read(&self, field: &str, arrays: &Arrays) -> Result<Rows> {
        let array = |name: &str| {
            let array = if self.csr.is_empty() { name.into() } else { format!("{}.{name}", self.csr) };
            Ok(Reference::Npz { npz: self.npz.clone(), array }.read(field, arrays)?.into_values())
        };
        let [data, indices, ends]: [Vec<f64>; 3] = [array("data")?, array("indices")?, array("indptr")?];
        let refused = |what: String, remedy: &str| Err(Error::input(field, what, remedy));
        let n = ends.len().saturating_sub(1);
        let is_index = |x: &f64| *x >= 0.0 && x.fract() == 0.0 && *x <= data.len().max(n) as f64;
        let is_sound = ends.first() == Some(&0.0)
            && ends.last() == Some(&(data.len() as f64))
            && data.len() == indices.len()
            && ends.windows(2).all(|pair| pair[0] <= pair[1])
            && ends.iter().chain(&indices).all(is_index)
            && indices.iter().all(|&j| (j as usize) < n);
        if !is_sound {
            let remedy =
                "give data, indices and indptr of compressed rows, as scipy.sparse.csr_matrix has them";
            return refused(format!("{} entries of {n} rows", data.len()), remedy);
        }
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for i in 0..n {
            for at in ends[i] as usize..ends[i + 1] as usize {
                let (j, x) = (indices[at] as usize, data[at]);
                if i >= j {
                    lower.push((i, j, x));
                }
                if i <= j {
                    upper.push((j, i, x));
                }
            }
        }
        lower.sort_unstable_by_key(|&(i, j, _)| (i, j));
        upper.sort_unstable_by_key(|&(i, j, _): &(usize, usize, f64)| (i, j));
        let largest = data.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let is_same = |(a, b): (&(usize, usize, f64), &(usize, usize, f64))| {
            (a.0, a.1) == (b.0, b.1) && (a.2 - b.2).abs() <= SYMMETRIC * largest
        };
        if lower.len() != upper.len() || !lower.iter().zip(&upper).all(is_same) {
            return refused("not symmetric".into(), "give both triangles, the same to rounding: (K + K.T)/2");
        }
        Ok((n, lower))
    }
}

/// Entries of both triangles may differ by so much, relative to the largest one: the roundings of a product.
const SYMMETRIC: f64 = 1e-14;
