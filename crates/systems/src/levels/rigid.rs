//! Hessians of two levels in mass-weighted coordinates, rigid motions projected out.

use faer::{Mat, MatRef};
use nalgebra::DMatrix;

use crate::half::norm;
use crate::signs::inertia::{orthogonality, spectral_norm};
use crate::verdict::measured::{Removed, check_masses};
use number::{Error, Result, U};

/// F and S, mass-weighted (1/time²), in coordinates without the rigid motions.
#[derive(Clone, Debug)]
pub struct Hessians {
    pub(super) fast: Mat<f64>,
    pub(super) slow: Mat<f64>,
    /// How far (2-norm) these are from the exact restrictions of the matrices given.
    pub(super) errors: [f64; 2],
    /// No less than what each is known relative to: its norm, or the sum of those of potentials that share
    /// its clock; 0 where that is its norm.
    pub(super) sizes: [f64; 2],
    /// The coordinates kept, as orthonormal columns in those given; `None`: all.
    pub(super) basis: Option<Mat<f64>>,
    pub(super) removed: Option<Removed>,
}

/// What the potentials, in their order, hold along motions set apart.
#[derive(Clone, Debug)]
pub(crate) struct Shares {
    /// Of each one's norm.
    pub each: Vec<f64>,
    /// Of the sum of the norms, by all together.
    pub total: f64,
}

impl Hessians {
    /// From mass-weighted matrices, M^-½ K M^-½, of one size.
    ///
    /// # Errors
    /// Names the matrix that is empty, not square, of another size, not finite, or farther from symmetric
    /// than `accuracy` times its norm. What asymmetry there is is split evenly.
    pub fn new(fast: &DMatrix<f64>, slow: &DMatrix<f64>, accuracy: f64) -> Result<Hessians> {
        let n = fast.nrows();
        let [fast, slow] = [("fast", fast), ("slow", slow)].map(|(name, k)| symmetric(name, k, n, accuracy));
        Ok(Hessians {
            fast: fast?,
            slow: slow?,
            errors: [0.0; 2],
            sizes: [0.0; 2],
            basis: None,
            removed: None,
        })
    }

    /// From stiffnesses K and the mass of each degree of freedom.
    ///
    /// # Errors
    /// As [`Hessians::new`]; a mass that is not positive.
    pub fn weighted(
        masses: &[f64],
        fast: &DMatrix<f64>,
        slow: &DMatrix<f64>,
        accuracy: f64,
    ) -> Result<Hessians> {
        check_masses(masses)?;
        if masses.len() != fast.nrows() {
            let remedy = format!("there are {} rows: give as many masses", fast.nrows());
            return Err(Error::input("masses", masses.len(), remedy));
        }
        let root: Vec<f64> = masses.iter().map(|m| m.sqrt()).collect();
        let weigh = |k: &DMatrix<f64>| {
            let entry =
                |i: usize, j: usize| k[(i, j)] / (root[i.min(root.len() - 1)] * root[j.min(root.len() - 1)]);
            DMatrix::from_fn(k.nrows(), k.ncols(), entry)
        };
        let mut all = Hessians::new(&weigh(fast), &weigh(slow), accuracy)?;
        // Two roots, their product, the quotient.
        all.errors = [&all.fast, &all.slow].map(|k| 4.1 * U * norm::frobenius(k));
        Ok(all)
    }

    /// The number of degrees of freedom kept.
    pub fn size(&self) -> usize {
        self.fast.nrows()
    }

    /// These Hessians on the motions orthogonal to the columns of `rigid`, which are orthonormal.
    #[must_use]
    pub fn without(self, rigid: &Mat<f64>, found_by: &'static str) -> Hessians {
        let part = |k: &Mat<f64>| norm::spectral(&(k * rigid)) / norm::spectral(k).max(f64::MIN_POSITIVE);
        let each = [&self.fast, &self.slow].map(part).to_vec();
        let total = part(&(&self.fast + &self.slow));
        self.set_apart(rigid, found_by, Shares { each, total })
    }

    /// The same, with what each potential holds along the rigid motions among these.
    #[must_use]
    pub(crate) fn set_apart(self, rigid: &Mat<f64>, found_by: &'static str, shares: Shares) -> Hessians {
        let (n, r) = (rigid.nrows(), rigid.ncols());
        if r == 0 || r >= n {
            return self;
        }
        let full = rigid.qr().compute_Q();
        let kept = full.subcols(r, n - r).to_owned();
        // Exactly orthonormal columns are within the defect of these.
        let defect = orthogonality(&kept).unwrap_or(f64::INFINITY);
        let project = |k: &Mat<f64>| projected(k, &kept, defect);
        let removed = Removed { count: r, found_by, held: shares.each, total: shares.total };
        let ((fast, e), (slow, f)) = (project(&self.fast), project(&self.slow));
        let errors = [self.errors[0] + e, self.errors[1] + f];
        Hessians { fast, slow, errors, basis: Some(kept), removed: Some(removed), ..self }
    }

    /// Another mass-weighted stiffness in the coordinates kept, what asymmetry there is split evenly, and how
    /// far (2-norm) it is from the exact restriction.
    pub(super) fn restricted(&self, k: &DMatrix<f64>) -> (Mat<f64>, f64) {
        let whole = halved(MatRef::from_column_major_slice(k.as_slice(), k.nrows(), k.ncols()));
        // The rounding of two roots, their product, the quotient and the mean of both triangles.
        let weights = 5.1 * U * norm::frobenius(&whole);
        let Some(basis) = &self.basis else { return (whole, weights) };
        let (matrix, error) = projected(&whole, basis, orthogonality(basis).unwrap_or(f64::INFINITY));
        (matrix, weights + error)
    }

    /// These Hessians where one level, 0 the fast one, is a sum of mass-weighted stiffnesses: each of these
    /// is known to its own norm, though they may cancel.
    #[must_use]
    pub fn of_shares(mut self, level: usize, shares: &[DMatrix<f64>]) -> Hessians {
        let size = |k: &DMatrix<f64>| {
            let whole = halved(MatRef::from_column_major_slice(k.as_slice(), k.nrows(), k.ncols()));
            let kept = match &self.basis {
                Some(basis) => halved((basis.transpose() * &whole * basis).as_ref()),
                None => whole,
            };
            // The roundings of two products, and of the basis.
            let slack = 8.0 * (k.nrows() as f64 + 4.0) * U * norm::frobenius(&kept);
            spectral_norm(&kept, slack)
        };
        self.sizes[level] = 1.01 * shares.iter().map(size).sum::<f64>();
        self
    }

    /// The coordinates kept, as orthonormal columns in those given; `None`: all.
    pub fn basis(&self) -> Option<&Mat<f64>> {
        self.basis.as_ref()
    }

    /// The motions that were projected out.
    pub fn removed(&self) -> Option<&Removed> {
        self.removed.as_ref()
    }
}

fn symmetric(name: &str, k: &DMatrix<f64>, n: usize, accuracy: f64) -> Result<Mat<f64>> {
    if k.nrows() != n || k.ncols() != n || n == 0 {
        let size = format!("{} x {}", k.nrows(), k.ncols());
        return Err(Error::input(name, size, format!("give a square matrix of {} rows", n.max(1))));
    }
    if k.as_slice().iter().any(|x| !x.is_finite()) {
        return Err(Error::input(name, "an entry that is not finite", "give finite numbers"));
    }
    let whole = MatRef::from_column_major_slice(k.as_slice(), n, n).to_owned();
    if is_symmetric(k.as_slice(), n) {
        return Ok(whole);
    }
    let off = norm::frobenius(&(&whole - whole.transpose())) / 2.0;
    let size = norm::frobenius(&whole);
    if off > accuracy * size {
        let remedy = format!(
            "it must be symmetric to its accuracy, {accuracy:.0e} of its norm; of a force that is no gradient say \"symmetric\": false"
        );
        return Err(Error::input(name, format!("asymmetry of {:.1e} of its norm", off / size), remedy));
    }
    Ok(halved(whole.as_ref()))
}

/// Tile by tile: a whole row of a large matrix lies on as many pages as it has entries.
fn is_symmetric(k: &[f64], n: usize) -> bool {
    const TILE: usize = 32;
    let mut tiles = (0..n).step_by(TILE).flat_map(|left| (left..n).step_by(TILE).map(move |top| (top, left)));
    tiles.all(|(top, left)| {
        let column = |j: usize| (top..n.min(top + TILE)).all(|i| k[i + j * n] == k[j + i * n]);
        (left..n.min(left + TILE)).all(column)
    })
}

/// Vᵀ k V for orthonormal columns V but for this defect, and how far (2-norm) it is from that of exactly
/// orthonormal ones.
pub fn projected(k: &Mat<f64>, kept: &Mat<f64>, defect: f64) -> (Mat<f64>, f64) {
    let image = kept.transpose() * k * kept;
    let size = norm::frobenius(k);
    let rounding = 2.2 * (k.nrows() as f64 + 4.0) * U * norm::frobenius(kept).powi(2) * size;
    (halved(image.as_ref()), rounding + 2.1 * defect * size)
}

/// (m + mᵀ)/2.
pub(super) fn halved(m: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)] / 2.0 + m[(j, i)] / 2.0)
}

/// Translations and rotations of particles at `positions` (one triple each) with `masses` (one each), in
/// mass-weighted coordinates x_1, y_1, z_1, x_2, ...: orthonormal columns, 6 of them, 5 for particles on a
/// line, 3 for one.
pub fn rigid_motions(positions: &[[f64; 3]], masses: &[f64]) -> Mat<f64> {
    Motions::of_particles(positions, masses).columns
}

/// The three translations alone, of particles in a periodic box.
pub fn translations(masses: &[f64]) -> Mat<f64> {
    Motions::of_box(masses).columns
}

/// Translations and rotations.
#[derive(Clone, Debug)]
pub struct Motions {
    /// Orthonormal and mass-weighted.
    pub columns: Mat<f64>,
    /// ω of each, the rotation in it: 0 of translations.
    pub turns: Vec<[f64; 3]>,
}

impl Motions {
    pub fn of_particles(positions: &[[f64; 3]], masses: &[f64]) -> Motions {
        motions(positions, masses, 6)
    }

    pub fn of_box(masses: &[f64]) -> Motions {
        motions(&vec![[0.0; 3]; masses.len()], masses, 3)
    }
}

/// The first `count` of translations and rotations.
fn motions(positions: &[[f64; 3]], masses: &[f64], count: usize) -> Motions {
    let total: f64 = masses.iter().sum();
    let centre = [0, 1, 2].map(|a| positions.iter().zip(masses).map(|(x, m)| x[a] * m).sum::<f64>() / total);
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut turns: Vec<[f64; 3]> = Vec::new();
    for motion in 0..count {
        let axis = motion % 3;
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mut column, mut turn) = (vec![0.0; 3 * positions.len()], [0.0; 3]);
        turn[axis] = f64::from(u8::from(motion >= 3));
        for (i, (x, m)) in positions.iter().zip(masses).enumerate() {
            let weight = m.sqrt();
            if motion < 3 {
                column[3 * i + axis] = weight;
            } else {
                column[3 * i + b] = -weight * (x[c] - centre[c]);
                column[3 * i + c] = weight * (x[b] - centre[b]);
            }
        }
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let before = length(&column);
        // Twice is enough (Kahan, Parlett).
        for _ in 0..2 {
            for (other, turned) in columns.iter().zip(&turns) {
                let along: f64 = column.iter().zip(other).map(|(x, y)| x * y).sum();
                column.iter_mut().zip(other).for_each(|(x, y)| *x -= along * y);
                turn.iter_mut().zip(turned).for_each(|(x, y)| *x -= along * y);
            }
        }
        let after = length(&column);
        // A rotation about the line of a linear molecule moves nothing: what is left of it is rounding.
        if after > 1e-8 * before.max(f64::MIN_POSITIVE) {
            columns.push(column.iter().map(|x| x / after).collect());
            turns.push(turn.map(|x| x / after));
        }
    }
    let columns = Mat::from_fn(3 * positions.len(), columns.len(), |i, j| columns[j][i]);
    Motions { columns, turns }
}
