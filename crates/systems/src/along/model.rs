//! The Hessians of the kicks of half a period, how well they are known, and what moves freely.

use faer::Mat;
use nalgebra::DMatrix;
use num_traits::Zero;

use crate::levels::{rigid_motions, translations};
use crate::linear::system::System;
use crate::verdict::measured::{check_accuracy, check_masses};
use clocks::schedule::{Clock, Schedule};
use number::{Error, Rational, Result};

/// Hessians along half a period of an orbit that is at rest at both its ends.
///
/// ```
/// use kickdrift_systems::number::rational::ratio;
/// use kickdrift_systems::{Along, Limits, Route};
/// use nalgebra::DMatrix;
/// let [stiff, soft] = [4.0, 0.1].map(|k| DMatrix::from_element(1, 1, k));
/// // Steps of 1/2 and 1. Half a period: both clocks at 0, the fast one in the middle of the period.
/// let kicks = [vec![stiff.clone(), stiff * 1.01], vec![soft]];
/// let own = Along::new(&[1.0], &[ratio(1, 2), ratio(1, 1)], &kicks)?.at_accuracy(1e-6)?;
/// let found = own.decide(Route::Cheapest, &Limits::default())?;
/// // For all Hessians within 10^-6 of their norms, and for others, too.
/// let within = found.measured.expect("they are measured");
/// assert!(within.holds.is_stable() == Some(true) && within.margin > Some(1e-2));
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Along {
    pub(super) masses: Vec<f64>,
    pub(super) schedule: Schedule,
    /// Of each event of half a period those of the clocks that kick in it.
    pub(super) hessians: Vec<Vec<DMatrix<f64>>>,
    /// Each Hessian is known to this times the largest norm of its clock's; `None`: as they stand.
    pub(super) accuracy: Option<f64>,
    pub(super) rigid: Rigid,
    /// Its size and its clocks.
    pub(super) clocks: System,
}

/// What moves freely.
#[derive(Clone, Debug)]
pub(super) enum Rigid {
    Nothing,
    /// The translations of a periodic box.
    Translations(Mat<f64>),
    /// Translations and rotations where the orbit starts and where it turns, mass-weighted, orthonormal.
    Turning([Mat<f64>; 2]),
}

impl Along {
    /// From the n masses, the steps of the clocks, increasing, and for each clock the Hessian at each of its
    /// kicks from t = 0 to half the period, n x n, in force/length; the unit of time is that of the steps.
    ///
    /// # Errors
    /// Names what does not fit: another number of Hessians than of kicks, one that is not n x n, finite and
    /// symmetric, a mass that is not positive, a step that is not positive or that two clocks share.
    pub fn new(masses: &[f64], steps: &[Rational], kicks: &[Vec<DMatrix<f64>>]) -> Result<Along> {
        if steps.len() != kicks.len() || !steps.is_sorted_by(|a, b| a < b) {
            let remedy = "give each clock its own step, shortest first, with its Hessians";
            return Err(Error::input("potentials", format!("{} of them", kicks.len()), remedy));
        }
        let schedule = Schedule::new(steps, &vec![Rational::zero(); steps.len()])?;
        let mut left: Vec<_> = kicks.iter().map(|kick| kick.iter()).collect();
        let mut hessians = Vec::new();
        for event in schedule.half_period() {
            hessians.push(event.clocks().filter_map(|clock| left[clock].next().cloned()).collect::<Vec<_>>());
        }
        for (k, matrixes) in kicks.iter().enumerate() {
            let struck =
                schedule.half_period().filter(|event| event.clocks().any(|clock| clock == k)).count();
            if matrixes.len() != struck {
                let found = format!("{} Hessians", matrixes.len());
                let remedy = format!(
                    "this clock kicks {struck} times in half a period, both its ends counted: give as many"
                );
                return Err(Error::input(&format!("potentials[{k}].stiffness"), found, remedy));
            }
        }
        Along::of_events(masses, schedule, hessians)
    }

    /// From the Hessians of each event, those of its clocks in increasing order.
    pub(super) fn of_events(
        masses: &[f64],
        schedule: Schedule,
        hessians: Vec<Vec<DMatrix<f64>>>,
    ) -> Result<Along> {
        check(masses, &schedule, &hessians)?;
        let step = |clock: &Clock| schedule.tick() * Rational::from_integer(clock.step().into());
        let clocks = System::of_clocks(masses.len(), schedule.clocks().iter().map(step))?;
        let (accuracy, rigid) = (None, Rigid::Nothing);
        Ok(Along { masses: masses.to_vec(), schedule, hessians, accuracy, rigid, clocks })
    }

    /// With every Hessian known to this times the largest norm of those of its clock.
    ///
    /// # Errors
    /// An accuracy that is not in (0, 1/10).
    pub fn at_accuracy(self, accuracy: f64) -> Result<Along> {
        check_accuracy(accuracy)?;
        Ok(Along { accuracy: Some(accuracy), ..self })
    }

    /// Without the rigid motions of a free molecule, whose atoms are at these positions where the orbit
    /// starts and where it turns: for forces that turn with the atoms.
    ///
    /// # Errors
    /// Positions of another number of atoms.
    pub fn turning(self, [start, turned]: [&[[f64; 3]]; 2]) -> Result<Along> {
        let masses = self.of_atoms()?;
        for (field, own) in [("positions", start), ("turned", turned)] {
            if own.len() != masses.len() {
                let remedy = format!("there are {} atoms: give three coordinates of each", masses.len());
                return Err(Error::input(field, format!("{} triples", own.len()), remedy));
            }
        }
        let motions = [start, turned].map(|own| rigid_motions(own, &masses));
        if motions[0].ncols() != motions[1].ncols() {
            let remedy = "the atoms are on a line at one end of the half period and not at the other: keep the rigid motions in";
            return Err(Error::input("turned", "another number of rigid motions", remedy));
        }
        Ok(Along { rigid: Rigid::Turning(motions), ..self })
    }

    /// These Hessians without rigid motions that are given as columns, mass-weighted, at t = 0 and at T/2.
    /// Coordinates other than those of atoms need this, as of a molecule with held bonds.
    ///
    /// # Errors
    /// Columns of another length than n, of another number at the two ends, that depend on each other or are
    /// all there is.
    pub fn free_of(self, ends: &[DMatrix<f64>]) -> Result<Along> {
        let n = self.size();
        let orthonormal = |matrix: &DMatrix<f64>| {
            let columns = Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)]);
            let split = columns.qr();
            let lengths = || (0..matrix.ncols()).map(|k| split.R()[(k, k)].abs());
            let (least, most) = (lengths().fold(f64::INFINITY, f64::min), lengths().fold(0.0, f64::max));
            // Far above the roundings of the columns.
            (least > 1e-8 * most).then(|| split.compute_thin_Q())
        };
        let fits = |matrix: &DMatrix<f64>| {
            matrix.nrows() == n && (1..n).contains(&matrix.ncols()) && matrix.ncols() == ends[0].ncols()
        };
        if let [start, turned] = ends
            && ends.iter().all(fits)
            && let (Some(start), Some(turned)) = (orthonormal(start), orthonormal(turned))
        {
            return Ok(Along { rigid: Rigid::Turning([start, turned]), ..self });
        }
        let given: Vec<_> = ends.iter().map(DMatrix::shape).collect();
        let remedy = format!("give independent columns of {n} numbers, fewer than {n}, as many at both ends");
        Err(Error::input("rigid", format!("{given:?}"), remedy))
    }

    /// Without the translations of a periodic box.
    ///
    /// # Errors
    /// Masses that are not those of atoms of three coordinates.
    pub fn in_box(self) -> Result<Along> {
        let motions = translations(&self.of_atoms()?);
        Ok(Along { rigid: Rigid::Translations(motions), ..self })
    }

    /// The mass of each atom.
    fn of_atoms(&self) -> Result<Vec<f64>> {
        let atoms = self.masses.chunks(3);
        if atoms.clone().all(|atoms| atoms.len() == 3 && atoms.iter().all(|m| *m == atoms[0])) {
            return Ok(atoms.map(|atoms| atoms[0]).collect());
        }
        let remedy = "rigid motions need atoms of three coordinates each: say \"keep_rigid\": true";
        Err(Error::input("masses", "not of atoms", remedy))
    }

    /// Its size and its clocks, without stiffness.
    pub fn clocks(&self) -> &System {
        &self.clocks
    }

    /// The degrees of freedom given.
    pub fn size(&self) -> usize {
        self.masses.len()
    }

    /// The columns of the rigid motions where the orbit starts.
    pub(super) fn motions(&self) -> Option<&Mat<f64>> {
        match &self.rigid {
            Rigid::Nothing => None,
            Rigid::Translations(matrix) => Some(matrix),
            Rigid::Turning([start, _]) => Some(start),
        }
    }
}

/// Orthonormal columns beside these.
pub(super) fn beside(motions: &Mat<f64>) -> Mat<f64> {
    let (n, r) = (motions.nrows(), motions.ncols());
    motions.qr().compute_Q().subcols(r, n - r).to_owned()
}

fn check(masses: &[f64], schedule: &Schedule, hessians: &[Vec<DMatrix<f64>>]) -> Result<()> {
    let n = masses.len();
    check_masses(masses)?;
    if n == 0 {
        return Err(Error::input("masses", "none", "give at least one mass"));
    }
    if !schedule.is_palindrome() {
        return Err(Error::input("phase", "not 0 or 1/2", "other phases have no time reversal"));
    }
    let events: Vec<usize> = schedule.half_period().map(|event| event.clocks().count()).collect();
    let given: Vec<usize> = hessians.iter().map(Vec::len).collect();
    if events != given {
        let remedy = format!("give one a kick of the half period, event by event: {events:?}");
        return Err(Error::input("hessians", format!("{given:?}"), remedy));
    }
    for (k, matrixes) in hessians.iter().enumerate() {
        for (c, matrix) in matrixes.iter().enumerate() {
            let field = format!("hessians[{k}][{c}]");
            if matrix.shape() != (n, n) || matrix.iter().any(|x| !x.is_finite()) {
                let given = format!("{} x {}", matrix.nrows(), matrix.ncols());
                return Err(Error::input(&field, given, format!("give {n} x {n} finite numbers")));
            }
            // Hessians by differences are symmetric to some digits; what is meant is their symmetric part.
            let off = (matrix - matrix.transpose()).amax();
            if off > 1e-3 * matrix.amax() {
                let remedy = "a Hessian is symmetric: give one, or measure it by smaller differences";
                return Err(Error::input(&field, format!("off its transpose by {off:.1e}"), remedy));
            }
        }
    }
    Ok(())
}
