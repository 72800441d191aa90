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
//! `csr` names the three arrays `data`, `indices` and `indptr` of compressed rows: `slow.data` and so on, or,
//! where it is empty, those of a file of `scipy.sparse.save_npz`. With `"scheme": "lts"` there is one
//! stiffness, and `"levels": [{"fine": [4, 5], "substeps": 2}]` are local time steps (see `local`); `fine`
//! may stand by reference, too, as `{"npz": "mesh.npz", "array": "fine"}`. A stiffness is K, not
//! mass-weighted, symmetric to rounding; both triangles stand in it.

use std::collections::BTreeSet;

use faer::Mat;
use serde_json::Value;

use super::array::{Arrays, Reference};
use super::document::{Document, LevelDocument};
use super::given::Given;
use super::local::indices;
use number::error::room;
use number::{Error, Rational, Result};
use systems::levels::sparse::{SparseLevels, symmetric};
use systems::levels::{rigid_motions, translations};
use systems::{Level, Removed, Scheme, SparseSteps, SparseSystem};

/// The most degrees of freedom.
const LARGEST: usize = 1 << 20;

/// From a file of two such stiffnesses.
pub(super) fn read(document: &Document, arrays: &Arrays) -> Result<SparseSystem> {
    document.is_plain()?;
    if document.scheme.is_some() || document.levels.is_some() {
        return local_steps(document, arrays);
    }
    let mut levels = Vec::new();
    for (k, potential) in document.potentials()?.iter().enumerate() {
        let field = format!("potentials[{k}].stiffness");
        levels.push((potential.step(k)?, rows(potential.array(k)?, &field, arrays)?));
    }
    levels.sort_by(|a, b| a.0.cmp(&b.0));
    let [(inner, (n, fast)), (outer, (m, slow))] = &levels[..] else {
        let remedy = "sparse stiffnesses are two, a fast one and a slow one";
        return Err(Error::input("potentials", format!("{} of them", levels.len()), remedy));
    };
    if n != m || *n == 0 || *n > LARGEST {
        let remedy = format!("give both as many rows, 1 to {LARGEST}");
        return Err(Error::input("potentials", format!("{n} and {m} rows"), remedy));
    }
    let masses = document.masses(*n, arrays)?.ok_or_else(|| Error::missing("masses", "give them"))?;
    let positions = document.positions(*n, arrays)?;
    let particles: Vec<f64> = masses.iter().step_by(3).copied().collect();
    let (rigid, found_by) = match &positions {
        _ if document.keep_rigid || !n.is_multiple_of(3) => (Mat::zeros(*n, 0), ""),
        _ if document.periodic => (translations(&particles), "periodic box"),
        Some(positions) => (rigid_motions(positions, &particles), "positions"),
        None => (Mat::zeros(*n, 0), ""),
    };
    let count = rigid.ncols();
    let sparse_levels = SparseLevels::new(&masses, [fast, slow], rigid)?;
    let held = sparse_levels.removed().to_vec();
    let removed = (count > 0).then_some(Removed { count, found_by, held, total: 0.0 });
    SparseSystem::new(sparse_levels, [inner, outer], document.accuracy()?, removed)
}

/// Two levels that a file gives, with the steps of another in which nothing else differs: their stiffnesses
/// are not read again. `None` where the fast one is no longer the fast one, or there are no two levels.
pub(super) fn with_steps(sparse_system: &SparseSystem, files: [&Value; 2]) -> Result<Option<SparseSystem>> {
    let steps = |file: &Value| -> Result<Vec<Rational>> {
        let document = Document::parse(file, None)?;
        document.potentials()?.iter().enumerate().map(|(k, potential)| potential.step(k)).collect()
    };
    let own_steps = match (&steps(files[0])?[..], &steps(files[1])?[..]) {
        ([a, b], [c, d]) if a < b && c < d => [c.clone(), d.clone()],
        ([a, b], [c, d]) if a > b && c > d => [d.clone(), c.clone()],
        _ => return Ok(None),
    };
    sparse_system.with_steps(own_steps.each_ref()).transpose()
}

/// One stiffness with local time steps.
fn local_steps(document: &Document, arrays: &Arrays) -> Result<SparseSystem> {
    let refused = |field: &str, value: String, remedy: &str| Err(Error::input(field, value, remedy));
    let scheme = document.scheme.as_deref().map(str::parse).transpose()?;
    let (levels, potential) = match (scheme, &document.levels, document.potentials()?) {
        (Some(Scheme::Avi), ..) => {
            let remedy = "is two stiffnesses here, each with its step: leave out scheme and levels";
            return refused("scheme", "avi".into(), remedy);
        }
        (Some(_), Some(levels), [potential]) => (levels, potential),
        (Some(_), Some(_), all) => {
            return refused(
                "potentials",
                format!("{} of them", all.len()),
                "local steps are for one stiffness",
            );
        }
        (Some(_), None, _) => {
            return refused(
                "levels",
                "missing".into(),
                "give levels, as [{\"fine\": [3, 4], \"substeps\": 2}]",
            );
        }
        (None, ..) => {
            let remedy = "belong to a scheme: give \"scheme\": \"lts\", too";
            return refused("levels", "given".into(), remedy);
        }
    };
    if document.accuracy.is_some() {
        return refused("accuracy", "given".into(), "has no meaning with local steps: leave it out");
    }
    let (n, stiffness) = rows(potential.array(0)?, "potentials[0].stiffness", arrays)?;
    if n == 0 || n > LARGEST {
        return refused("potentials", format!("{n} rows"), &format!("give 1 to {LARGEST}"));
    }
    let masses = document.masses(n, arrays)?.ok_or_else(|| Error::missing("masses", "give them"))?;
    let levels = levels.iter().enumerate().map(|(l, level_document)| level_document.sparse(l, n, arrays));
    let (levels, step) = (levels.collect::<Result<_>>()?, potential.step(0)?);
    SparseSystem::with_local_steps(SparseSteps::new(&masses, &stiffness, levels)?, &step)
}

impl LevelDocument {
    fn sparse(&self, l: usize, n: usize, arrays: &Arrays) -> Result<Level> {
        let field = format!("levels[{l}].fine");
        let fine: BTreeSet<usize> = match (&self.fine, &self.elements) {
            (Some(Given::Here(all)), None) => indices(&field, all, n)?,
            (Some(Given::Array(at)), None) => {
                let values = at.read(&field, arrays)?.into_values();
                let is_index = |x: &&f64| **x >= 0.0 && x.fract() == 0.0 && **x < n as f64;
                if let Some(x) = values.iter().find(|x| !is_index(x)) {
                    return Err(Error::input(&field, x, format!("indices are 0 to {}", n - 1)));
                }
                values.into_iter().map(|x| x as usize).collect()
            }
            _ => {
                let remedy =
                    "give fine, the degrees of freedom: elements are parts of a mesh, and there is none";
                return Err(Error::input(&format!("levels[{l}]"), "elements, or no fine", remedy));
            }
        };
        Ok(Level { fine, substeps: self.count(l)? })
    }
}

impl Document {
    /// That nothing is asked for which dense stiffnesses alone have.
    fn is_plain(&self) -> Result<()> {
        let fields = [
            ("mass_weighted", self.mass_weighted),
            ("constraints", self.constraints.is_some()),
            ("hydrogen_mass", self.hydrogen_mass.is_some()),
            ("symmetric", self.symmetric == Some(false)),
            ("method", self.method.is_some()),
        ];
        let of_potential =
            |(k, name, given): (usize, &str, bool)| given.then(|| format!("potentials[{k}].{name}"));
        let potentials = self.potentials.iter().flatten().enumerate();
        let potentials = potentials
            .flat_map(|(k, potential_document)| {
                [
                    (k, "scale", potential_document.scale.is_some()),
                    (k, "force", potential_document.force.is_some()),
                ]
            })
            .find_map(of_potential);
        let found = fields.into_iter().find(|field| field.1).map(|field| field.0.to_string()).or(potentials);
        found.map_or(Ok(()), |field| {
            Err(Error::input(
                &field,
                "given",
                "is for dense stiffnesses alone: leave it out, or give dense ones",
            ))
        })
    }
}

/// What an entry takes in two triangles until they are known to be the same.
const BYTES_AN_ENTRY: u128 = 48;

/// The number of rows, and the entries of the lower triangle.
type Rows = (usize, Vec<(usize, usize, f64)>);

fn rows(stiffness: &Reference, field: &str, arrays: &Arrays) -> Result<Rows> {
    let Reference::Csr { npz, csr } = stiffness else {
        return Err(Error::input(field, "one array", "give both stiffnesses as compressed rows, or neither"));
    };
    let array = |name: &str| {
        let array = if csr.is_empty() { name.into() } else { format!("{}.{name}", csr) };
        Ok(Reference::Npz { npz: npz.clone(), array }.read(field, arrays)?.into_values())
    };
    let [data, indices, ends]: [Vec<f64>; 3] = [array("data")?, array("indices")?, array("indptr")?];
    let refused = |what: String, remedy: &str| Err(Error::input(field, what, remedy));
    let n = ends.len().saturating_sub(1);
    if n > LARGEST || data.len() as u128 > (n as u128).pow(2) {
        let remedy = format!("give at most {LARGEST} rows, and each entry once: csr.sum_duplicates()");
        return refused(format!("{} entries of {n} rows", data.len()), &remedy);
    }
    room(data.len() as u128 * BYTES_AN_ENTRY, "a shorter cutoff, which leaves fewer entries")?;
    // SciPy writes it, kickdrift's own files have none.
    if let Ok(shape) = array("shape")
        && shape != [n as f64; 2]
    {
        return refused(
            format!("of shape {shape:?}"),
            "give a square matrix, a row for each degree of freedom",
        );
    }
    let is_index = |x: &f64| *x >= 0.0 && x.fract() == 0.0 && *x <= data.len().max(n) as f64;
    let is_sound = ends.first() == Some(&0.0)
        && ends.last() == Some(&(data.len() as f64))
        && data.len() == indices.len()
        && ends.windows(2).all(|pair| pair[0] <= pair[1])
        && ends.iter().chain(&indices).all(is_index)
        && indices.iter().all(|&j| (j as usize) < n);
    if !is_sound {
        let remedy = "give data, indices and indptr of compressed rows, as scipy.sparse.csr_matrix has them";
        return refused(format!("{} entries of {n} rows", data.len()), remedy);
    }
    let row = |i: usize| (ends[i] as usize..ends[i + 1] as usize).map(move |at| (i, at));
    let all: Vec<_> = (0..n).flat_map(row).map(|(i, at)| (i, indices[at] as usize, data[at])).collect();
    Ok((n, symmetric(field, n, &all, true)?))
}
