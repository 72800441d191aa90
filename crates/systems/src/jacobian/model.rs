//! The matrices A_k = M⁻¹ J_k with their clocks, in coordinates without the rigid motions.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::OnceLock;

use faer::{Mat, MatRef};
use nalgebra::DMatrix;
use num_traits::{One, Zero};

use crate::half::norm;
use crate::levels::Motions;
use crate::levels::apart::{self, of_particles};
use crate::linear::sparse::{Symmetric, null_space};
use crate::linear::system::{Potential, System};
use crate::model::Body;
use crate::spectrum::discs::Spectrum;
use crate::verdict::measured::check_accuracy;
use clocks::schedule::Schedule;
use number::{Error, Rational, Result, U, from_f64_exact, to_f64};

/// One clock with its matrix.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    pub step: Rational,
    /// A_k in doubles,
    pub matrix: Mat<f64>,
    /// and no less than the spectral norms of it, and of what it is off by.
    pub size: f64,
    pub off: f64,
    /// A_k itself, where it is rational; `None`: the doubles are.
    pub exact: Option<DMatrix<Rational>>,
}

impl Clock {
    /// A_k over ℚ.
    pub fn rational(&self) -> Cow<'_, DMatrix<Rational>> {
        let entry = |i: usize, j: usize| from_f64_exact(self.matrix[(i, j)]).expect("finite, as it was read");
        let n = self.matrix.nrows();
        self.exact.as_ref().map_or_else(|| Cow::Owned(DMatrix::from_fn(n, n, entry)), Cow::Borrowed)
    }
}

/// Forces that are no gradient, each with its clock.
///
/// ```
/// use kickdrift_systems::number::rational::ratio;
/// use kickdrift_systems::{Jacobians, Limits, Route};
/// use nalgebra::DMatrix;
/// let rational = |entries: [i64; 4]| DMatrix::from_row_slice(2, 2, &entries.map(|x| ratio(x, 2)));
/// // Two oscillators alike, stiff ones every 1/50; every 4/25 a force that turns one into the other.
/// let stiff = (rational([400, 0, 0, 400]), ratio(1, 50), ratio(0, 1));
/// let turning = (rational([40, 1, -1, 40]), ratio(4, 25), ratio(0, 1));
/// let forces = Jacobians::rational(&[ratio(1, 1), ratio(1, 1)], &[stiff, turning])?;
/// let found = forces.decide(Route::Cheapest, &Limits::default())?;
/// // It grows, and would with the shortest steps: these add a fifth.
/// let (lo, hi) = found.growth_rate().expect("enclosed");
/// let (least, most) = forces.no_gradient().without_steps.expect("enclosed");
/// assert!(found.is_unstable() && lo > 1.1 * most && hi < 1.3 * least);
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Jacobians {
    pub(super) clocks: Vec<Clock>,
    pub(super) schedule: Schedule,
    /// The time of a tick.
    pub(super) tick: Rational,
    /// Every matrix is known to this times its norm, where it was measured.
    pub(super) accuracy: Option<f64>,
    /// |J − Jᵀ|/|J + Jᵀ| of each potential as it was given, Frobenius's norms, rounded.
    pub(super) asymmetries: Vec<f64>,
    /// The rigid motions, in the coordinates given.
    pub(super) rigid: Vec<Vec<Rational>>,
    /// Positions in the coordinates given from those that are left, a column each.
    pub(super) lift: Mat<f64>,
    /// The masses that move.
    pub(super) body: Body,
    /// With the symmetric parts alone.
    pub(super) symmetric: System,
    /// Computed when it is first asked for.
    pub(super) spectrum: OnceLock<(Option<Spectrum>, f64)>,
}

/// J of a potential with its step and phase.
type Given<T> = (DMatrix<T>, Rational, Rational);

impl Jacobians {
    /// From masses and rational Jacobians J with steps and phases.
    ///
    /// # Errors
    /// As [`System::new`] for the symmetric parts; a matrix of another size.
    pub fn rational(masses: &[Rational], given: &[Given<Rational>]) -> Result<Jacobians> {
        let n = masses.len();
        let half = Rational::new(1.into(), 2.into());
        let mut potentials = Vec::new();
        for (k, (j, step, phase)) in given.iter().enumerate() {
            square(k, j, n)?;
            let mean = DMatrix::from_fn(n, n, |a, b| (&j[(a, b)] + &j[(b, a)]) * &half);
            let stiffness = Symmetric::try_from(&mean)?;
            potentials.push(Potential { stiffness, step: step.clone(), phase: phase.clone() });
        }
        let symmetric = System::new(Symmetric::diagonal(masses), potentials)?;
        let body = Body { masses: Some(masses.iter().map(to_f64).collect()), ..Body::default() };
        let weighted = given.iter().map(|(j, step, phase)| {
            (DMatrix::from_fn(n, n, |a, b| &j[(a, b)] / &masses[a]), step.clone(), phase.clone())
        });
        let clocks = merged(weighted);
        // Motions n that no force sees, each for itself: those of one clock may cancel. In the coordinates
        // y_i = x_i − Σ n_J[i] x_J of the others A_k keeps its rows' images.
        let rows = given.iter().flat_map(|(j, ..)| {
            j.row_iter().map(|row| {
                row.iter().cloned().enumerate().filter(|(_, x)| !x.is_zero()).collect::<BTreeMap<_, _>>()
            })
        });
        let rigid = null_space(rows.collect(), n);
        let kept: Vec<usize> = (0..n).filter(|i| rigid.iter().all(|(index, _)| index != i)).collect();
        let left = |a: &DMatrix<Rational>| {
            DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
                let (i, j) = (kept[i], kept[j]);
                rigid.iter().fold(a[(i, j)].clone(), |x, (index, n)| x - &n[i] * &a[(*index, j)])
            })
        };
        let clocks = clocks.into_iter().map(|(a, step, phase)| {
            let exact = left(&a);
            let matrix = Mat::from_fn(kept.len(), kept.len(), |i, j| to_f64(&exact[(i, j)]));
            let off = 1.01 * U * norm::frobenius(&matrix) + f64::MIN_POSITIVE * kept.len() as f64;
            (Clock { step, size: norm::spectral(&matrix), off, matrix, exact: Some(exact) }, phase)
        });
        let lift = Mat::from_fn(n, kept.len(), |i, j| f64::from(u8::from(i == kept[j])));
        let motions = rigid.iter().map(|(_, n)| n.clone()).collect();
        let asymmetries = given.iter().map(|(j, ..)| asymmetry(&j.map(|x| to_f64(&x)))).collect();
        Jacobians::new(clocks.collect(), (motions, lift), asymmetries, (None, body), symmetric)
    }

    /// From Jacobians in doubles, each known to `accuracy` times its norm, with steps: rigid motions by
    /// positions, in a periodic box translations, are set apart, unless they are kept.
    ///
    /// # Errors
    /// As [`Jacobians::rational`]; an accuracy that is not in (0, 1/10); constraints.
    pub fn measured(
        body: &Body,
        given: &[(Rational, DMatrix<f64>)],
        accuracy: f64,
        keeps_rigid: bool,
    ) -> Result<Jacobians> {
        if body.held.is_some() {
            let remedy = "holding distances needs a force with a potential: leave them free";
            return Err(Error::input("constraints", "given", remedy));
        }
        let n = given.first().map_or(0, |(_, j)| j.nrows());
        given.iter().enumerate().try_for_each(|(k, (_, j))| square(k, j, n))?;
        let root: Vec<f64> = match &body.masses {
            Some(masses) if !body.is_weighted => masses.iter().map(|m| m.sqrt()).collect(),
            _ => vec![1.0; n],
        };
        let found = match (&body.masses, &body.positions) {
            _ if keeps_rigid || !n.is_multiple_of(3) => None,
            (Some(masses), _) if body.is_periodic => Some((Motions::of_box(&thirds(masses)), masses)),
            (Some(masses), Some(positions)) => {
                Some((Motions::of_particles(positions, &thirds(masses)), masses))
            }
            _ => None,
        };
        let weighted = |j: &DMatrix<f64>| DMatrix::from_fn(n, n, |a, b| j[(a, b)] / (root[a] * root[b]));
        if let Some((motions, masses)) = &found {
            let each: Vec<_> =
                given.iter().map(|(step, j)| apart::Given::new(step.clone(), &weighted(j))).collect();
            of_particles(motions, &thirds(masses), &each, accuracy)?;
        }
        let motions = found.map_or_else(Mat::new, |(motions, _)| motions.columns);
        // Orthonormal columns beside the motions.
        let removed = motions.ncols();
        let basis = match removed {
            0 => Mat::identity(n, n),
            _ => motions.qr().compute_Q().subcols(removed, n - removed).to_owned(),
        };
        let clocks = merged(given.iter().map(|(step, j)| (weighted(j), step.clone(), Rational::zero())));
        let clocks = clocks.into_iter().map(|(a, step, phase)| {
            let a = MatRef::from_column_major_slice(a.as_slice(), n, n);
            let matrix = basis.transpose() * a * &basis;
            // Roots, quotients, two products with orthonormal columns (Frobenius's norm n^½ at most).
            let rounding = if removed == 0 { 5.0 } else { 5.0 + 3.0 * (n as f64 + 4.0) * n as f64 };
            let off = rounding * U * norm::frobenius(&a.to_owned());
            (Clock { step, size: norm::spectral(&matrix), off, matrix, exact: None }, phase)
        });
        let lift = Mat::from_fn(n, basis.ncols(), |i, j| basis[(i, j)] / root[i]);
        let exact = |x: f64| from_f64_exact(x).unwrap_or_default();
        let rigid = (0..removed).map(|k| (0..n).map(|i| exact(motions[(i, k)])).collect()).collect();
        let asymmetries = given.iter().map(|(_, j)| asymmetry(j)).collect();
        let symmetric = System::of_clocks(n, given.iter().map(|(step, _)| step.clone()))?;
        let known = (Some(accuracy), body.clone());
        Jacobians::new(clocks.collect(), (rigid, lift), asymmetries, known, symmetric)?.at_accuracy(accuracy)
    }

    /// This system with every matrix known to this times its norm.
    ///
    /// # Errors
    /// Rational matrices; an accuracy that is not in (0, 1/10).
    pub fn at_accuracy(self, accuracy: f64) -> Result<Jacobians> {
        if self.accuracy.is_none() {
            return Err(Error::input(
                "accuracy",
                accuracy,
                "is for stiffnesses by reference: these are exact",
            ));
        }
        check_accuracy(accuracy)?;
        Ok(Jacobians { accuracy: Some(accuracy), spectrum: OnceLock::new(), ..self })
    }

    fn new(
        clocks: Vec<(Clock, Rational)>,
        (rigid, lift): (Vec<Vec<Rational>>, Mat<f64>),
        asymmetries: Vec<f64>,
        (accuracy, body): (Option<f64>, Body),
        symmetric: System,
    ) -> Result<Jacobians> {
        let (clocks, phases): (Vec<_>, Vec<_>) = clocks.into_iter().unzip();
        let steps: Vec<_> = clocks.iter().map(|clock: &Clock| clock.step.clone()).collect();
        let schedule = Schedule::new(&steps, &phases)?;
        let tick = &steps[0] / Rational::from_integer(schedule.clocks()[0].step().into());
        let spectrum = OnceLock::new();
        Ok(Jacobians {
            clocks,
            schedule,
            tick,
            accuracy,
            asymmetries,
            rigid,
            lift,
            body,
            symmetric,
            spectrum,
        })
    }

    /// This system with all steps `factor` > 0 times as long.
    ///
    /// # Errors
    /// A factor that is not positive.
    pub fn slowed(&self, factor: &Rational) -> Result<Jacobians> {
        let symmetric = self.symmetric.with(&Rational::one(), factor)?;
        let clock = |clock: &Clock| Clock { step: &clock.step * factor, ..clock.clone() };
        let clocks = self.clocks.iter().map(clock).collect();
        let (tick, spectrum) = (&self.tick * factor, Default::default());
        Ok(Jacobians { clocks, tick, symmetric, spectrum, ..self.clone() })
    }

    /// This system with another step for each clock, by increasing step.
    ///
    /// # Errors
    /// Another number of steps than clocks; phases; as [`Schedule::new`].
    pub fn with_steps(&self, steps: &[Rational]) -> Result<Jacobians> {
        if steps.len() != self.clocks.len() {
            let remedy = format!("this file has {} clocks: give each its step", self.clocks.len());
            return Err(Error::input("steps", format!("{} of them", steps.len()), remedy));
        }
        if self.symmetric.clocks().iter().any(|potential| !potential.phase.is_zero()) {
            return Err(Error::input(
                "phase",
                "given",
                "other steps are for clocks that all begin at time 0",
            ));
        }
        let with = |(clock, step): (&Clock, &Rational)| {
            (Clock { step: step.clone(), ..clock.clone() }, Rational::zero())
        };
        let clocks = self.clocks.iter().zip(steps).map(with).collect();
        let symmetric = System::of_clocks(self.symmetric.size(), steps.iter().cloned())?;
        let Jacobians { rigid, lift, asymmetries, accuracy, body, .. } = self.clone();
        Jacobians::new(clocks, (rigid, lift), asymmetries, (accuracy, body), symmetric)
    }

    /// The step of each clock, increasing.
    pub fn steps(&self) -> Vec<Rational> {
        self.clocks.iter().map(|clock| clock.step.clone()).collect()
    }

    /// |J − Jᵀ|/|J + Jᵀ| of each potential as it was given, Frobenius's norms, rounded.
    pub fn asymmetries(&self) -> &[f64] {
        &self.asymmetries
    }

    /// The masses that move; for rational matrices their masses alone.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// How well the matrices are known, relative to their norms; `None`: exactly.
    pub fn accuracy(&self) -> Option<f64> {
        self.accuracy
    }

    /// The highest frequency of the matrix on the shortest step alone, √Re λ of its eigenvalues λ, rounded;
    /// `None` where none is positive.
    pub fn highest_fast_frequency(&self) -> Option<f64> {
        let found = self.clocks.first()?.matrix.eigenvalues().ok()?;
        let largest = found.iter().map(|z| z.re).fold(0.0, f64::max);
        (largest > 0.0).then(|| largest.sqrt())
    }

    /// The system of the symmetric parts: its size, its clocks, no more.
    pub fn symmetric(&self) -> &System {
        &self.symmetric
    }

    /// The degrees of freedom that are left.
    pub fn size(&self) -> usize {
        self.lift.ncols()
    }

    /// T.
    pub fn period(&self) -> Rational {
        &self.tick * Rational::from_integer(self.schedule.period().into())
    }
}

fn square<T>(k: usize, j: &DMatrix<T>, n: usize) -> Result<()> {
    if j.nrows() == n && j.ncols() == n && n > 0 {
        return Ok(());
    }
    let (found, remedy) = (format!("{} x {}", j.nrows(), j.ncols()), format!("give {n} rows and columns"));
    Err(Error::input(&format!("potentials[{k}].stiffness"), found, remedy))
}

/// One clock for each step and phase, by increasing step.
fn merged<T: nalgebra::Scalar + for<'a> std::ops::AddAssign<&'a T>>(
    given: impl Iterator<Item = Given<T>>,
) -> Vec<Given<T>> {
    let mut clocks: BTreeMap<(Rational, Rational), DMatrix<T>> = BTreeMap::new();
    for (matrix, step, phase) in given {
        match clocks.get_mut(&(step.clone(), phase.clone())) {
            Some(sum) => sum.iter_mut().zip(matrix.iter()).for_each(|(sum, x)| *sum += x),
            None => drop(clocks.insert((step, phase), matrix)),
        }
    }
    clocks.into_iter().map(|((step, phase), matrix)| (matrix, step, phase)).collect()
}

/// |J − Jᵀ|/|J + Jᵀ|, 0 of the matrix 0.
fn asymmetry(j: &DMatrix<f64>) -> f64 {
    let (off, on) = ((j - j.transpose()).norm(), (j + j.transpose()).norm());
    if off == 0.0 { 0.0 } else { off / on }
}

/// The mass of each particle from those of its three coordinates.
fn thirds(masses: &[f64]) -> Vec<f64> {
    masses.iter().step_by(3).copied().collect()
}
