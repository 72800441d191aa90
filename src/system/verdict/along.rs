//! The verdict along a periodic orbit: every kick with the Hessian at its own position.
//!
//! About an orbit that is its own mirror image in time the Hessians of the kicks form a palindrome, and H, the tangent map
//! of half the period, decides as for one Hessian a clock: λ + 1/λ = 2 + 4 μ, μ the eigenvalues of Bᵀ C.

use faer::Mat;
use nalgebra::DMatrix;

use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::number::{Laurent, Rational, U};
use crate::schedule::Schedule;
use crate::system::half::period::{Drifts, Stiff, Stiffness, follow};
use crate::system::signs;
use crate::system::spectrum::discs::Spectrum;
use crate::system::spectrum::explain::explained;
use crate::system::verdict::analysis::{Analysis, Evidence, Instability, Part};
use crate::system::verdict::limits::{Limits, degrees_of_freedom};

/// The integrator's own orbit beside an equilibrium, and the verdict about it.
#[derive(Clone, Debug)]
pub struct OwnOrbit {
    /// Where the orbit is at t = 0, at rest.
    pub start: Vec<f64>,
    /// The largest |start − equilibrium|.
    pub displacement: f64,
    /// The verdict on small deviations from the orbit.
    pub analysis: Analysis,
}

/// The verdict on small deviations from a periodic orbit, proven for the Hessians given as they stand.
///
/// `hessians[k]` holds those of the clocks that kick in event k of [`Schedule::half_period`], in increasing order of the
/// clocks, n x n, symmetric, in force/length; `masses` the n masses. The steps of the schedule are in the unit of time of both.
///
/// # Errors
/// Names what does not fit: a schedule that is no palindrome, Hessians of another number or size than the kicks, not symmetric or
/// not finite, a mass that is not positive; a budget error before the work.
///
/// ```
/// use kickdrift::number::rational::ratio;
/// use kickdrift::schedule::Schedule;
/// use kickdrift::system::{Limits, decide_along};
/// use nalgebra::DMatrix;
/// let schedule = Schedule::new(&[ratio(1, 2), ratio(1, 1)], &[ratio(0, 1), ratio(0, 1)])?;
/// let [stiff, soft] = [4.0, 0.1].map(|k| DMatrix::from_element(1, 1, k));
/// // Half a period: both clocks at 0, the fast one in the middle of the period.
/// let hessians = [vec![stiff.clone(), soft], vec![stiff * 1.01]];
/// let about = decide_along(&[1.0], &schedule, &hessians, &Limits::default())?;
/// assert!(about.is_stable() && about.is_proof());
/// # Ok::<(), kickdrift::error::Error>(())
/// ```
pub fn decide_along(
    masses: &[f64],
    schedule: &Schedule,
    hessians: &[Vec<DMatrix<f64>>],
    limits: &Limits,
) -> Result<Analysis> {
    check(masses, schedule, hessians)?;
    let n = masses.len();
    let size = n as u64;
    let cost = size.pow(3).saturating_mul(2 * hessians.iter().map(Vec::len).sum::<usize>() as u64 + 60);
    limits.allow(cost, || {
        format!("half a period of dense kicks and the eigenvalues of {}", degrees_of_freedom(n))
    })?;
    let tick = to_f64(schedule.tick());
    let scales = scales(masses, hessians, tick);
    let inverse_mass: Vec<_> = (0..n).map(|i| vec![(i, scales[i] * scales[i] / masses[i])]).collect();
    let kicks: Vec<Vec<(usize, Stiff)>> = schedule
        .half_period()
        .zip(hessians)
        .map(|(event, own)| {
            let stiff = |(clock, k): (usize, &DMatrix<f64>)| {
                (clock, scaled(k, tick * tick * schedule.clocks()[clock].step() as f64, &scales))
            };
            event.clocks().zip(own).map(stiff).collect()
        })
        .collect();
    let find = |k: usize, clock: usize| {
        let own = kicks[k].iter().find(|(other, _)| *other == clock);
        &own.expect("a Hessian for each clock of each event").1
    };
    let drifts = Drifts { inverse_mass: &inverse_mass, decay: &Rational::default(), off: 0.0 };
    let blocks = follow(&drifts, schedule.half_period(), find).blocks(scales);
    let spectrum = Spectrum::new(&blocks);
    let signed = signs::proven(&blocks).map(|kind| (kind, Evidence::Signs));
    let discs = || Some((spectrum.as_ref()?.certified(&blocks)?, Evidence::Discs));
    let open = || spectrum.as_ref().map(|_| (None, Evidence::Estimate));
    let decided = signed.or_else(discs).map(|(kind, evidence)| (Some(kind), evidence));
    let (kind, evidence) = decided.or_else(open).ok_or_else(|| {
        Error::input("hessians", "too long a period for doubles", "choose steps with a simpler ratio")
    })?;
    let period = Laurent::from_rational(schedule.tick() * Rational::from_integer(schedule.period().into()));
    let explained = spectrum.map(|own| {
        let shape = |i| own.shape(i, &blocks.scales);
        explained(own.multipliers(), shape, kind, &period, |_, _, _| None)
    });
    let (multipliers, mut instabilities) = explained.unwrap_or_default();
    instabilities.iter_mut().for_each(Instability::normalize);
    let part = Part::new(n, period, (kind, evidence), (multipliers, instabilities));
    let warnings = if kind.is_some() { Vec::new() } else { vec![NOT_DECIDED.into()] };
    Ok(Analysis::of_part(part, schedule.clocks().len(), warnings))
}

const NOT_DECIDED: &str = "doubles do not decide along the orbit";

/// For each degree of freedom a power of two near √(m ω), ω the mean frequency a tick, so that positions and momenta are of one
/// size.
fn scales(masses: &[f64], hessians: &[Vec<DMatrix<f64>>], tick: f64) -> Vec<f64> {
    let first = hessians.iter().flatten();
    let squares: f64 =
        first.map(|k| (0..masses.len()).map(|i| (k[(i, i)] / masses[i]).abs()).sum::<f64>()).sum();
    let count = (hessians.iter().map(Vec::len).sum::<usize>() * masses.len()).max(1) as f64;
    let omega = (squares / count).sqrt() * tick;
    let scale = |m: &f64| {
        let scale = (m * omega).sqrt();
        if scale.is_normal() { scale.log2().round().clamp(-300.0, 300.0).exp2() } else { 1.0 }
    };
    masses.iter().map(scale).collect()
}

/// From one in so many entries on a product of whole matrices takes less time than one of rows.
const DENSE: usize = 8;

/// factor K_ij/(a_i a_j), K_ij as the mean of itself and K_ji, with the roundings of the factor.
fn scaled(k: &DMatrix<f64>, factor: f64, a: &[f64]) -> Stiff {
    let entry = |i: usize, j: usize| (k[(i, j)] / 2.0 + k[(j, i)] / 2.0) * factor / (a[i] * a[j]);
    let row =
        |i: usize| (0..a.len()).map(|j| (j, entry(i, j))).filter(|(_, x)| *x != 0.0).collect::<Vec<_>>();
    let rows: Vec<_> = (0..a.len()).map(|i| (i, row(i))).filter(|(_, row)| !row.is_empty()).collect();
    let squares: f64 = rows.iter().flat_map(|(_, row)| row).map(|(_, x)| x * x).sum();
    let filled: usize = rows.iter().map(|(_, row)| row.len()).sum();
    let stiffness = if DENSE * filled > a.len() * a.len() {
        Stiffness::Whole(Mat::from_fn(a.len(), a.len(), entry))
    } else {
        Stiffness::Rows(rows)
    };
    Stiff { stiffness, off: 8.0 * U * squares.sqrt() }
}

fn check(masses: &[f64], schedule: &Schedule, hessians: &[Vec<DMatrix<f64>>]) -> Result<()> {
    let n = masses.len();
    if let Some(i) = masses.iter().position(|m| !(m.is_finite() && *m > 0.0)) {
        return Err(Error::input(&format!("masses[{i}]"), masses[i], "a mass must be positive"));
    }
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
    for (k, own) in hessians.iter().enumerate() {
        for (c, matrix) in own.iter().enumerate() {
            let field = format!("hessians[{k}][{c}]");
            if matrix.shape() != (n, n) || matrix.iter().any(|x| !x.is_finite()) {
                let given = format!("{} x {}", matrix.nrows(), matrix.ncols());
                return Err(Error::input(&field, given, format!("give {n} x {n} finite numbers")));
            }
            // Hessians by differences are symmetric to some digits; what is meant is their symmetric part.
            let off = (matrix - matrix.transpose()).amax();
            if off > 1e-3 * matrix.amax() {
                return Err(Error::input(&field, format!("off by {off:.1e}"), "a Hessian is symmetric"));
            }
        }
    }
    Ok(())
}
