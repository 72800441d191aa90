//! The half period along an orbit in doubles with its bound, the verdict, and how far it stands.

use std::borrow::Cow;

use faer::Mat;
use nalgebra::DMatrix;

use super::model::{Along, Rigid, beside};
use super::scaled::{Scaled, frequency, power, scaled, scales};
use crate::columns::combined;
use crate::exact::decide::{MuCount, allow_blocks, judged_blocks, led};
use crate::half::float::FloatBlocks;
use crate::half::norm;
use crate::half::period::{Drifts, Propagated, Stiff, Stiffness, follow};
use crate::levels::apart::Given;
use crate::levels::{Method, projected};
use crate::signs;
use crate::signs::inertia::orthogonality;
use crate::spectrum::discs::Spectrum;
use crate::spectrum::explain::explained;
use crate::verdict::analysis::{Analysis, Evidence, Part};
use crate::verdict::limits::{Limits, Route, degrees_of_freedom};
use crate::verdict::measured::Measured;
use clocks::schedule::{Event, Schedule};
use clocks::verdict::Kind;
use number::{Error, Laurent, Rational, Result, U, from_f64_exact, to_f64};

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
/// `hessians[k]` holds those of the clocks that kick in event k of [`Schedule::half_period`], in increasing
/// order of the clocks, n x n, symmetric, in force/length; `masses` the n masses. The steps of the schedule
/// are in the unit of time of both.
///
/// # Errors
/// Names what does not fit: a schedule that is no palindrome, Hessians of another number or size than the
/// kicks, not symmetric or not finite, a mass that is not positive; a budget error before the work.
///
/// ```
/// use kickdrift_systems::number::rational::ratio;
/// use kickdrift_systems::clocks::schedule::Schedule;
/// use kickdrift_systems::{Limits, decide_along};
/// use nalgebra::DMatrix;
/// let schedule = Schedule::new(&[ratio(1, 2), ratio(1, 1)], &[ratio(0, 1), ratio(0, 1)])?;
/// let [stiff, soft] = [4.0, 0.1].map(|k| DMatrix::from_element(1, 1, k));
/// // Half a period: both clocks at 0, the fast one in the middle of the period.
/// let hessians = [vec![stiff.clone(), soft], vec![stiff * 1.01]];
/// let about = decide_along(&[1.0], &schedule, &hessians, &Limits::default())?;
/// assert!(about.is_stable() && about.is_proof());
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
pub fn decide_along(
    masses: &[f64],
    schedule: &Schedule,
    hessians: &[Vec<DMatrix<f64>>],
    limits: &Limits,
) -> Result<Analysis> {
    Along::of_events(masses, schedule.clone(), hessians.to_vec())?.decide(Route::Cheapest, limits)
}

const NOT_DECIDED: &str = "doubles do not decide along the orbit";

/// The margin is searched for by doubling the accuracy.
const MARGIN_GROWTH: f64 = 2.0;

/// Margins beyond so many times the accuracy, or below its inverse, are not looked for.
const MARGINS: i32 = 40;

impl Along {
    /// The verdict on the Hessians given, enclosures of growth for all within their accuracy, and in
    /// `measured` what holds for all of these.
    ///
    /// # Errors
    /// A budget error before the work; exact arithmetic beside rigid motions; rigid motions that no Hessians
    /// within the accuracy leave free.
    pub fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        let n = self.size();
        limits.allow_dense(self.cost(), || {
            format!("half a period of dense kicks and the eigenvalues of {}", degrees_of_freedom(n))
        })?;
        let asked = (route == Route::Exact).then(|| self.exact(limits)).transpose()?;
        let half = self.half();
        let given = half.blocks(0.0);
        half.check_rigid()?;
        let spectrum = Spectrum::new(&given);
        let by_doubles = || half.proven(spectrum.as_ref(), 0.0);
        let open = || spectrum.as_ref().map(|_| (None, Evidence::Estimate));
        let (kind, evidence) = match &asked {
            Some((kind, _)) => (Some(*kind), Evidence::Exact),
            None => {
                let decided = by_doubles().map(|(kind, evidence)| (Some(kind), evidence));
                decided.or_else(open).ok_or_else(|| {
                    Error::input(
                        "hessians",
                        "too long a period for doubles",
                        "choose steps with a simpler ratio",
                    )
                })?
            }
        };
        let within = spectrum
            .as_ref()
            .filter(|_| self.accuracy.is_some())
            .map(|spectrum| spectrum.known_to(&half.blocks(1.0)));
        let period = Laurent::from_rational(self.clocks.period());
        let explained = within.as_ref().or(spectrum.as_ref()).map(|spectrum| {
            let shape = |i| spectrum.shape(i, &given.scales);
            explained(spectrum.multipliers(), shape, kind, &period, |_, _, _| None)
        });
        let (multipliers, mut instabilities) = explained.unwrap_or_default();
        instabilities.iter_mut().for_each(|instability| instability.lift(|y| half.lifted(y)));
        let mut part = Part::new(given.size(), period, (kind, evidence), (multipliers, instabilities));
        (part.dofs, part.roots) = ((0..n).collect(), asked.map(|(_, roots)| roots));
        let warnings = if kind.is_some() { Vec::new() } else { vec![NOT_DECIDED.into()] };
        let measured = self.accuracy.map(|accuracy| {
            let proven = |times: f64| half.proven(spectrum.as_ref(), times).map(|(kind, _)| kind);
            Measured {
                method: Method::Respa.name(),
                accuracy,
                holds: proven(1.0).into(),
                margin: margin(proven).map(|times| times * accuracy),
                first_unstable: None,
                is_above_unstable: false,
                removed: None,
            }
        });
        let rigid_modes = self.rigid_modes();
        let clocks = self.schedule.clocks().len();
        Ok(Analysis { rigid_modes, measured, ..Analysis::of_part(part, clocks, warnings) })
    }

    /// Products of doubles, roughly: the kicks with the norms of what they meet, eigenvalues with vectors and
    /// their proof, that proof for some accuracies more.
    pub fn cost(&self) -> u64 {
        let (n, kicks) = (self.size() as u64, self.hessians.iter().map(Vec::len).sum::<usize>() as u64);
        let measured = if self.accuracy.is_some() { 300 + 8 * kicks } else { 0 };
        n.saturating_pow(3).saturating_mul(2 * kicks + 60 + measured)
    }

    /// The kind in exact arithmetic, of the doubles as the numbers that they are, and where the μ lie.
    ///
    /// # Errors
    /// Where rigid motions are set apart, whose columns are no rational numbers; a budget error.
    pub fn exact(&self, limits: &Limits) -> Result<(Kind, MuCount)> {
        if !matches!(self.rigid, Rigid::Nothing) {
            let remedy = "is for Hessians along an orbit without rigid motions: leave it out";
            return Err(Error::input("exact", "given", remedy));
        }
        /// A double's digits over a power of two, and those of a step.
        const BITS: f64 = 192.0;
        let kicks = self.hessians.iter().map(Vec::len).sum::<usize>() as f64;
        allow_blocks(self.size(), (kicks, BITS), limits)?;
        let exact = |x: f64| from_f64_exact(x).expect("finite, as it was read");
        let (n, half) = (self.size(), Rational::new(1.into(), 2.into()));
        let inverse_mass: Vec<Rational> = self.masses.iter().map(|m| exact(*m).recip()).collect();
        let kick = |event: &Event, matrixes: &[DMatrix<f64>]| {
            event.clocks().zip(matrixes).fold(DMatrix::zeros(n, n), |sum, (clock, k)| {
                let factor = event.weight.of(&self.step(clock)) * &half;
                sum + DMatrix::from_fn(n, n, |i, j| (exact(k[(i, j)]) + exact(k[(j, i)])) * &factor)
            })
        };
        let events = || {
            let own = self.schedule.half_period().zip(&self.hessians);
            own.map(|(event, matrixes)| {
                let drift = self.schedule.tick() * Rational::from_integer(event.drift.into());
                (drift, kick(&event, matrixes))
            })
        };
        let (one, zero) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
        let [a, c] = led([one.clone(), zero.clone()], &inverse_mass, events());
        let [b, d] = led([zero, one], &inverse_mass, events());
        Ok(judged_blocks(&(b.transpose() * &c), [&a, &b, &c, &d]))
    }

    fn step(&self, clock: usize) -> Rational {
        self.schedule.tick() * Rational::from_integer(self.schedule.clocks()[clock].step().into())
    }

    /// One whole period in doubles, rounded, kick by kick: mass-weighted positions and velocities that are
    /// orthogonal to rigid motions, 2m x 2m.
    pub fn full_period(&self) -> DMatrix<f64> {
        let n = self.size();
        let root: Vec<f64> = self.masses.iter().map(|m| m.sqrt()).collect();
        let weighted = |k: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| k[(i, j)] / (root[i] * root[j]));
        let (mut x, mut v) = (DMatrix::zeros(n, 2 * n), DMatrix::zeros(n, 2 * n));
        (0..n).for_each(|i| (x[(i, i)], v[(i, n + i)]) = (1.0, 1.0));
        let tick = to_f64(self.schedule.tick());
        let kick = |x: &DMatrix<f64>, event: &Event, matrixes: &[DMatrix<f64>], v: &mut DMatrix<f64>| {
            for (clock, k) in event.clocks().zip(matrixes) {
                *v -= weighted(k) * x * (event.weight.share() * to_f64(&self.step(clock)));
            }
        };
        let events: Vec<Event> = self.schedule.half_period().collect();
        for (event, matrixes) in events.iter().zip(&self.hessians) {
            x += &v * (tick * event.drift as f64);
            kick(&x, event, matrixes, &mut v);
        }
        for (event, matrixes) in events.iter().zip(&self.hessians).rev() {
            kick(&x, event, matrixes, &mut v);
            x -= &v * (-tick * event.drift as f64);
        }
        let basis = self.motions().map_or_else(|| Mat::identity(n, n), beside);
        let basis = DMatrix::from_fn(n, basis.ncols(), |i, j| basis[(i, j)]);
        let m = basis.ncols();
        let mut period = DMatrix::zeros(2 * m, 2 * m);
        for (k, rows) in [x, v].iter().enumerate() {
            for l in 0..2 {
                period
                    .view_mut((k * m, l * m), (m, m))
                    .copy_from(&(basis.transpose() * rows.columns(l * n, n) * &basis));
            }
        }
        period
    }

    /// The largest ln |λ|/T of a whole period, rounded.
    pub fn growth_of_period(&self) -> f64 {
        let multipliers = self.full_period().complex_eigenvalues();
        multipliers.iter().fold(0.0, |a: f64, z| a.max(z.norm().ln())) / to_f64(&self.clocks.period())
    }

    /// That no kick holds the translations of a box.
    fn check_translations(&self, motions: &Mat<f64>) -> Result<()> {
        let n = self.size();
        let root: Vec<f64> = self.masses.iter().map(|m| m.sqrt()).collect();
        let events = self.schedule.half_period().zip(&self.hessians);
        let kicks: Vec<(usize, Given)> = events
            .flat_map(|(event, matrixes)| event.clocks().zip(matrixes))
            .map(|(clock, k)| {
                let weighted = DMatrix::from_fn(n, n, |i, j| k[(i, j)] / (root[i] * root[j]));
                (clock, Given::new(self.step(clock), &weighted))
            })
            .collect();
        kicks.iter().try_for_each(|(clock, given)| {
            let alike = kicks.iter().filter(|(other, _)| other == clock).map(|(_, given)| given.size());
            given.leaves_free(motions, alike.fold(0.0, f64::max), self.accuracy.unwrap_or(0.0))
        })
    }

    fn rigid_modes(&self) -> Vec<Vec<Rational>> {
        let exact = |x: f64| from_f64_exact(x).unwrap_or_default();
        let columns = |matrix: &Mat<f64>| {
            (0..matrix.ncols()).map(|k| matrix.col_as_slice(k).iter().map(|x| exact(*x)).collect()).collect()
        };
        self.motions().map(columns).unwrap_or_default()
    }

    /// The half period. Positions are times a_i, momenta divided by it: a power of two near √(m ω) where the
    /// Hessians are taken as they stand, else √m times a power of two, so that mass-weighted orthonormal
    /// columns stay orthonormal.
    fn half(&self) -> Half<'_> {
        let n = self.size();
        let tick = to_f64(self.schedule.tick());
        let (scales, inverse, roundings) = match self.accuracy {
            None if matches!(self.rigid, Rigid::Nothing) => {
                let scales = scales(&self.masses, &self.hessians, tick);
                let inverse: Vec<f64> = (0..n).map(|i| scales[i] * scales[i] / self.masses[i]).collect();
                (scales, inverse, 8.0)
            }
            _ => {
                let whole = power(frequency(&self.masses, &self.hessians) * tick);
                let scales: Vec<f64> = self.masses.iter().map(|m| m.sqrt() * whole).collect();
                // Two roots more.
                (scales, vec![whole * whole; n], 10.0)
            }
        };
        let basis = match &self.rigid {
            Rigid::Translations(matrix) => Some(beside(matrix)),
            _ => None,
        };
        let defect = basis.as_ref().map_or(0.0, |matrix| orthogonality(matrix).unwrap_or(f64::INFINITY));
        let kept = basis.as_ref().map_or(n, Mat::ncols);
        let shown = if roundings > 8.0 { vec![1.0; kept] } else { scales.clone() };
        let inverse_mass: Vec<_> = (0..kept).map(|i| vec![(i, inverse[i])]).collect();
        let own = |(clock, k): (usize, &DMatrix<f64>)| {
            let factor = tick * tick * self.schedule.clocks()[clock].step() as f64;
            let scaled = scaled(k, factor, &scales);
            let size = self.accuracy.map_or(0.0, |_| scaled.size(n));
            (clock, size, scaled)
        };
        let events = self.schedule.half_period().zip(&self.hessians);
        let all: Vec<Vec<_>> = events.map(|(event, k)| event.clocks().zip(k).map(own).collect()).collect();
        let mut largest = vec![0.0_f64; self.schedule.clocks().len()];
        for (clock, size, _) in all.iter().flatten() {
            largest[*clock] = largest[*clock].max(*size);
        }
        let stiff = |(clock, _, scaled): (usize, f64, Scaled)| {
            let known = self.accuracy.map_or(0.0, |accuracy| accuracy * largest[clock]);
            let stiff = match &basis {
                None => {
                    Stiff { off: roundings * U * scaled.frobenius(), stiffness: scaled.stiffness(), known }
                }
                Some(basis) => {
                    let (image, error) = projected(&scaled.0, basis, defect);
                    let off = roundings * U * scaled.frobenius() + error;
                    Stiff { stiffness: Stiffness::Whole(image), off, known }
                }
            };
            (clock, stiff)
        };
        let kicks: Vec<Vec<(usize, Stiff)>> =
            all.into_iter().map(|triples| triples.into_iter().map(stiff).collect()).collect();
        let find = |k: usize, clock: usize| {
            let pair = kicks[k].iter().find(|(other, _)| *other == clock);
            &pair.expect("a Hessian for each clock of each event").1
        };
        let drifts = Drifts { inverse_mass: &inverse_mass, decay: &Rational::default(), off: 0.0 };
        let propagated = follow(&drifts, self.schedule.half_period(), find);
        let frames = match &self.rigid {
            Rigid::Turning(motions) => Some(Frames::new(motions.each_ref().map(beside))),
            _ => None,
        };
        Half { along: self, propagated, scales: shown, basis, frames }
    }
}

/// Orthonormal columns beside the rigid motions where the orbit starts and where it turns.
struct Frames {
    start: Mat<f64>,
    turned: Mat<f64>,
    /// How far (2-norm) both together may be from exactly orthonormal ones, exactly beside the motions.
    off: f64,
}

impl Frames {
    fn new([start, turned]: [Mat<f64>; 2]) -> Frames {
        let defect = |matrix: &Mat<f64>| orthogonality(matrix).unwrap_or(f64::INFINITY);
        // Of Householder's factorization of r orthonormal columns: their space turns by some n r roundings
        // (Higham, Theorem 19.4).
        let (n, r) = (start.nrows() as f64, (start.nrows() - start.ncols()) as f64);
        let off = defect(&start) + defect(&turned) + 20.0 * (n + 8.0) * r * U;
        Frames { start, turned, off }
    }
}

/// A half period, and what its columns and rows are.
struct Half<'a> {
    along: &'a Along,
    propagated: Propagated,
    /// Positions are these times those of shapes, which are mass-weighted where these are 1.
    scales: Vec<f64>,
    /// Orthonormal columns beside the translations of a box, in which all of it is.
    basis: Option<Mat<f64>>,
    /// In which the blocks are to be taken.
    frames: Option<Frames>,
}

impl Half<'_> {
    /// The blocks with a bound for all Hessians within so many times their accuracy.
    fn blocks(&self, times: f64) -> FloatBlocks {
        let whole = self.propagated.blocks(self.scales.clone());
        let whole = FloatBlocks { error: self.propagated.error_within(times), ..whole };
        let Some(frames) = &self.frames else { return whole };
        let matrices =
            whole.matrices.each_ref().map(|block| frames.turned.transpose() * block * &frames.start);
        let squares = whole.matrices.iter().map(|block| norm::frobenius(block).powi(2)).sum::<f64>();
        let size = norm::frobenius(&frames.start) * norm::frobenius(&frames.turned);
        let rounding = 2.2 * (whole.size() as f64 + 4.0) * U * size * 1.01 * squares.sqrt();
        let error = whole.error.map(|e| 1.01 * (e + rounding + 1.01 * frames.off * (whole.norm + e)));
        let norm = whole.norm + error.unwrap_or(0.0);
        FloatBlocks { matrices, error, norm, scales: vec![1.0; frames.start.ncols()] }
    }

    /// That some Hessians within the accuracy leave the rigid motions free, C J₀ = 0 and J₁ᵀ C = 0: else what
    /// is proven would be so of none. (A J₀ is in the span of J₁ then, as Cᵀ A = Aᵀ C, and J₁ᵀ D in that of
    /// J₀ᵀ.)
    fn check_rigid(&self) -> Result<()> {
        if let Rigid::Translations(motions) = &self.along.rigid {
            return self.along.check_translations(motions);
        }
        let Rigid::Turning([start, turned]) = &self.along.rigid else { return Ok(()) };
        let n = self.along.size();
        let Some(error) = self.propagated.error_within(if self.along.accuracy.is_some() { 1.0 } else { 0.0 })
        else {
            return Ok(());
        };
        let whole = self.propagated.matrix();
        let c = whole.submatrix(n, 0, n, n);
        let pulled = [c * start, c.transpose() * turned];
        let longest =
            |matrix: &Mat<f64>| (0..matrix.ncols()).map(|k| matrix.col(k).norm_l2()).fold(0.0, f64::max);
        let longest = pulled.iter().map(longest).fold(0.0, f64::max);
        // The positions are known about as well as the Hessians.
        let known = self.along.accuracy.unwrap_or(0.0).max(n as f64 * U) * norm::frobenius(&whole);
        if longest <= 1.01 * (error + known) {
            return Ok(());
        }
        let remedy = "rigid motions are not free along this orbit: an outer force holds the atoms, or the Hessians are known less well; \
                      say \"keep_rigid\": true, or give another accuracy";
        Err(Error::input("positions", format!("a pull of {longest:.1e} at rigid motions"), remedy))
    }

    /// What is proven of all Hessians within so many times their accuracy.
    fn proven(&self, spectrum: Option<&Spectrum>, times: f64) -> Option<(Kind, Evidence)> {
        let blocks = self.blocks(times);
        blocks.error?;
        let signed = signs::proven(&blocks).map(|kind| (kind, Evidence::Signs));
        signed.or_else(|| {
            let own = spectrum?;
            let spectrum = if times > 0.0 { Cow::Owned(own.known_to(&blocks)) } else { Cow::Borrowed(own) };
            Some((spectrum.certified(&blocks)?, Evidence::Discs))
        })
    }

    /// A shape in the coordinates given.
    fn lifted(&self, y: &[f64]) -> Vec<f64> {
        let columns = self.frames.as_ref().map(|frames| &frames.start).or(self.basis.as_ref());
        let whole = columns.map_or_else(|| y.to_vec(), |columns| combined(columns, y));
        let is_scaled = columns.is_some() || self.along.accuracy.is_some();
        if is_scaled {
            whole.iter().zip(&self.along.masses).map(|(x, m)| x / m.sqrt()).collect()
        } else {
            whole
        }
    }
}

/// The largest number of times the accuracy at which a verdict is proven, but for a factor 2.
fn margin(proven: impl Fn(f64) -> Option<Kind>) -> Option<f64> {
    let powers = |sign: i32| (0..MARGINS).map(move |k| MARGIN_GROWTH.powi(sign * k));
    if proven(1.0).is_some() {
        return powers(1).take_while(|times| proven(*times).is_some()).last();
    }
    powers(-1).skip(1).find(|times| proven(*times).is_some())
}
