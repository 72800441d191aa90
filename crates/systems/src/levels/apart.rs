//! Which motions may be set apart: those that no stiffness holds, each by what it is known to itself.
//!
//! Where F and S cancel their sum holds nothing, and a run is held all the same: their kicks fall at
//! different times. So a motion r is rigid only if
//! |K_k r| ≤ accuracy ‖K_k‖ for every potential k.
//!
//! Rotations are seen in another way. A potential that knows no place turns its force with the atoms: for ω ×
//! x it has
//!
//! ```text
//!     K_k (ω × x) = ω × g_k,      g_k its gradient, Σ g_k = 0 at a minimum.
//! ```
//!
//! Its own share is not small there, and no spring holds the rotation. So from K_k r of motions by positions
//! that of the best g_k is taken away, three numbers an atom from nine; the rest counts as held.

use faer::{Mat, MatRef, Side};
use nalgebra::{DMatrix, Matrix3, Vector3};

use super::rigid::{Motions, Shares};
use crate::half::compose::connected;
use crate::half::norm;
use number::{Error, Rational, Result, U};

/// A potential's part of its norm that is small beside a motion set apart. Turned forces hold up to 0.064 of
/// molecules at their minima (four flexible waters, nonbonded). What holds a motion by more than a quarter is
/// no matter of balance: the projection would move its stiffest modes by an eighth of their frequencies and
/// more, and no advice covers that.
const SMALL: f64 = 0.25;

/// What is left of a sum that cancels: a rotation of a molecule by far less, what only one potential holds
/// all of it.
const CANCELLED: f64 = 0.5;

/// A mass-weighted stiffness given, its step, and its norm.
pub(crate) struct Given {
    step: Rational,
    stiffness: Mat<f64>,
    size: f64,
}

impl Given {
    pub fn new(step: Rational, k: &DMatrix<f64>) -> Given {
        let stiffness = MatRef::from_column_major_slice(k.as_slice(), k.nrows(), k.ncols()).to_owned();
        let size = sharp_norm(&stiffness);
        Given { step, stiffness, size }
    }

    /// Refuses translations of particles that it holds, a kick along an orbit, known to `accuracy` times
    /// `size`.
    ///
    /// # Errors
    /// Where it holds them by more.
    pub fn leaves_free(&self, translations: &Mat<f64>, size: f64, accuracy: f64) -> Result<()> {
        let part = norm::spectral(&(&self.stiffness * translations)) / size.max(f64::MIN_POSITIVE);
        if part > accuracy + rounding(translations.nrows()) {
            return Err(held(&self.step, part, accuracy));
        }
        Ok(())
    }

    pub fn size(&self) -> f64 {
        self.size
    }

    fn part(&self, pull: &Mat<f64>) -> f64 {
        norm::spectral(pull) / self.size.max(f64::MIN_POSITIVE)
    }
}

/// The 2-norm, rounded; of a large matrix more than it, by at most a factor n^(1/8).
fn sharp_norm(m: &Mat<f64>) -> f64 {
    const LARGE: usize = 256;
    let exact = |m: &Mat<f64>| {
        m.singular_values().ok().map(|singular_value| singular_value.iter().copied().fold(0.0, f64::max))
    };
    let small = (m.nrows() <= LARGE).then(|| exact(m)).flatten();
    small.unwrap_or_else(|| norm::spectral(m))
}

/// Of a product with orthonormal columns, relative to the norms.
fn rounding(n: usize) -> f64 {
    16.0 * (n as f64 + 4.0) * U
}

/// The shares of motions of particles with these masses, one each, that their positions say are rigid.
///
/// # Errors
/// A potential that holds them: then they are not.
pub(crate) fn of_particles(
    motions: &Motions,
    masses: &[f64],
    given: &[Given],
    accuracy: f64,
) -> Result<Shares> {
    let mut shares = Shares { each: Vec::new(), total: 0.0 };
    let n = motions.columns.nrows();
    let mut all = Mat::zeros(n, motions.columns.ncols());
    for own in given {
        let pull = &own.stiffness * &motions.columns;
        let rest = own.part(&unexplained(&pull, motions, masses));
        if rest > accuracy + rounding(n) {
            return Err(held(&own.step, rest, accuracy));
        }
        let part = own.part(&pull);
        if part > SMALL {
            let value =
                format!("the forces of the potential with step {} turn by {part:.1e} of its norm", own.step);
            let remedy = "so much cannot be projected out: give potentials whose forces nearly vanish at the positions, or say \"keep_rigid\": true";
            return Err(Error::input("rigid motions", value, remedy));
        }
        shares.each.push(part);
        all += &pull;
    }
    shares.total =
        norm::spectral(&all) / given.iter().map(|given| given.size).sum::<f64>().max(f64::MIN_POSITIVE);
    Ok(shares)
}

fn held(step: &Rational, part: f64, accuracy: f64) -> Error {
    let value = format!("the potential with step {step} holds {part:.1e} of its norm along them");
    // Rounded up, so that what is named is enough.
    let enough = 1.1 * part;
    let remedy = if part > SMALL {
        "a field or tethers hold the atoms: say \"keep_rigid\": true".to_string()
    } else {
        format!(
            "within its accuracy of {accuracy:.1e} they are neither rigid nor clearly held: say \"keep_rigid\": true where a field holds the atoms, or \
             \"accuracy\": {enough:.1e} where the stiffnesses are known no better"
        )
    };
    Error::input("rigid motions", value, remedy)
}

/// K r without the best ω × g: least squares over all motions, atom by atom.
fn unexplained(pull: &Mat<f64>, motions: &Motions, masses: &[f64]) -> Mat<f64> {
    let turns: Vec<Vector3<f64>> = motions.turns.iter().map(|turn| Vector3::from(*turn)).collect();
    let normal = turns.iter().fold(Matrix3::zeros(), |sum, matrix| {
        sum + Matrix3::identity() * matrix.norm_squared() - matrix * matrix.transpose()
    });
    let Some(inverse) = normal.try_inverse() else { return pull.clone() };
    let mut rest = pull.clone();
    for (i, mass) in masses.iter().enumerate() {
        let root = mass.sqrt();
        let force =
            |c: usize| Vector3::new(pull[(3 * i, c)], pull[(3 * i + 1, c)], pull[(3 * i + 2, c)]) * root;
        let sum =
            turns.iter().enumerate().fold(Vector3::zeros(), |sum, (c, matrix)| sum + force(c).cross(matrix));
        let gradient = inverse * sum;
        for (c, matrix) in turns.iter().enumerate() {
            let turned = matrix.cross(&gradient) / root;
            (0..3).for_each(|axis| rest[(3 * i + axis, c)] -= turned[axis]);
        }
    }
    rest
}

/// The motions that no potential holds, as orthonormal columns, where no positions tell them; none: `None`.
/// Motions along which the sum vanishes and single potentials do not stay, unless they may be rotations.
///
/// # Errors
/// More than `most` motions for each part that no entry joins to the others: what is soft is not rigid.
/// Potentials that balance each other along a motion, each by a small part of itself, as along rotations of a
/// molecule: neither rigid nor held.
pub(crate) fn common_null_space(
    given: &[Given],
    accuracy: f64,
    most: usize,
) -> Result<Option<(Mat<f64>, Shares)>> {
    let Some(first) = given.first() else { return Ok(None) };
    let n = first.stiffness.nrows();
    let total = given.iter().fold(Mat::zeros(n, n), |sum, given| sum + &given.stiffness);
    let all: f64 = given.iter().map(|given| given.size).sum();
    let Ok(eigen) = total.self_adjoint_eigen(Side::Lower) else { return Ok(None) };
    let null: Vec<usize> = (0..n).filter(|&i| eigen.S()[i].abs() <= accuracy * all).collect();
    if null.is_empty() {
        return Ok(None);
    }
    let candidates = Mat::from_fn(n, null.len(), |i, j| eigen.U()[(i, null[j])]);
    let relative = |given: &Given| {
        let pull = &given.stiffness * &candidates;
        Mat::from_fn(n, null.len(), |i, j| pull[(i, j)] / given.size.max(f64::MIN_POSITIVE))
    };
    let pulls: Vec<Mat<f64>> = given.iter().map(relative).collect();
    let stacked = Mat::from_fn(n * pulls.len(), null.len(), |i, j| pulls[i / n][(i % n, j)]);
    let Ok(svd) = stacked.thin_svd() else { return Ok(None) };
    // The length of all potentials' parts together is no less than any one's.
    let (rigid, held): (Vec<usize>, Vec<usize>) = (0..null.len()).partition(|&k| svd.S()[k] <= accuracy);
    let column = |k: usize| Mat::from_fn(null.len(), 1, |i, _| svd.V()[(i, k)]);
    for k in held.into_iter().filter(|&k| svd.S()[k] <= SMALL) {
        balanced(given, &(&candidates * column(k)))?;
    }
    if rigid.is_empty() {
        return Ok(None);
    }
    let places = (0..n * n).map(|k| (k % n, k / n)).filter(|&(i, j)| total[(i, j)] != 0.0);
    let bound = || connected(n, places).iter().map(|part| part.len().min(most)).sum::<usize>();
    if rigid.len() > most {
        let bound = bound();
        if rigid.len() > bound {
            let found = format!("zero within {accuracy:.1e} of the norms in {} directions", rigid.len());
            let remedy = format!(
                "rigid motions are at most {bound}, and what else is soft may not be left out: give masses and positions, or better \
                 stiffnesses with their accuracy, or keep the rigid motions in"
            );
            return Err(Error::input("total stiffness", found, remedy));
        }
    }
    let basis = Mat::from_fn(null.len(), rigid.len(), |i, j| svd.V()[(i, rigid[j])]);
    let each = pulls.iter().map(|pull| norm::spectral(&(pull * &basis))).collect();
    let columns = &candidates * &basis;
    let total = norm::spectral(&(&total * &columns)) / all.max(f64::MIN_POSITIVE);
    Ok(Some((columns, Shares { each, total })))
}

/// Refuses a motion along which potentials that are not small cancel.
fn balanced(given: &[Given], motion: &Mat<f64>) -> Result<()> {
    let pulls: Vec<Mat<f64>> = given.iter().map(|given| &given.stiffness * motion).collect();
    let alone: f64 = pulls.iter().map(norm::frobenius).sum();
    let together = pulls.iter().fold(Mat::zeros(motion.nrows(), 1), |sum, matrix| sum + matrix);
    if norm::frobenius(&together) > CANCELLED * alone {
        return Ok(());
    }
    let parts = given.iter().zip(&pulls).map(|(given, pull)| (given, given.part(pull)));
    let (given, part) = parts.max_by(|a, b| a.1.total_cmp(&b.1)).expect("at least one potential");
    let value = format!(
        "the sum of the stiffnesses vanishes, and the potential with step {} holds {part:.1e} of its norm along one of them",
        given.step
    );
    let remedy = "it is neither rigid nor clearly held. Rotations of a molecule are such: give masses and positions. Else say \"keep_rigid\": true";
    Err(Error::input("rigid motions", value, remedy))
}
