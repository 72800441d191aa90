//! Subcycling with held velocities of many thousands of degrees of freedom, one level of p substeps: its first stable region, by factorizations of a plain
//! leapfrog's matrices (proofs/SUBCYCLING.md).
//!
//! With C and F the coarse and the fine part of K, B their coupling, and θ the angle of the substep, 4 sin²(θ/2) = (dt/p)² F, the step from rest in the positions has
//!
//! ```text
//!     1 − Q11 = (dt²/2) N,     N H = G symmetric,     H = diag((C − B F⁻¹ Bᵀ)⁻¹, F⁻¹ V),     V = sin(p θ)/(p sin θ).
//! ```
//!
//! While all p θ < π, V > 0: both G and H are positive where K is, **the step is similar to a symmetric one, and stable iff (4/dt²) H > G**. By partial
//! fractions of tan(p θ/2) that is the condition of leapfrog in which no part has substeps, of a body whose fine part lies in ⌈p/2⌉ layers:
//!
//! ```text
//!     Σ_j w_j K(x, z_j) < (4/dt²) (M on x, 2 M on each z_j, M on the last one of odd p),     w_j = m_j/(p sin((2 j − 1) π/(2 p)))²,
//! ```
//!
//! m_j = 2, of the last one of odd p 1; Σ w_j = 1. With two substeps: K below 4/dt² times masses of which the fine ones count twice. Beyond p θ = π
//! H is indefinite, and no verdict is proven.

use super::scheme::{Level, Scheme, SchemeSummary};
use super::sparse::SparseSteps;
use crate::error::{Error, Result};
use crate::number::U;
use crate::system::levels::sparse::Triplets;
use crate::system::vary::stretches::{Stretch, merged};
use crate::system::verdict::measured::Holds;

/// A diagonal mass, a sparse stiffness, and the degrees of freedom that subcycle.
///
/// ```
/// use kickdrift::system::{Holds, Level, SparseSubcycles};
/// // A string of a thousand masses whose first hundred springs are four times as stiff.
/// let spring = |i: usize| if i < 100 { 4.0 } else { 1.0 };
/// let diagonal = (0..1000).map(|i| (i, i, spring(i) + spring(i + 1)));
/// let stiffness: Vec<_> = diagonal.chain((1..1000).map(|i| (i, i - 1, -spring(i)))).collect();
/// let level = Level { fine: (0..101).collect(), substeps: 2 };
/// let steps = SparseSubcycles::new(&[1.0; 1000], &stiffness, vec![level])?;
/// // Plain leapfrog ends at 1/2; with fine masses that count twice near √½.
/// let (lo, hi) = steps.first_unstable().expect("proven");
/// assert!(0.70 < lo && hi < 0.7075);
/// assert_eq!((steps.verdict(0.70), steps.verdict(0.9)), (Holds::Stable, Holds::NotTold));
/// # Ok::<(), kickdrift::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SparseSubcycles {
    level: Level,
    /// Leapfrog without substeps, and that of the body in layers.
    plain: SparseSteps,
    layered: SparseSteps,
    /// The step at which the fastest fine motion has p θ = π: no less than the first, no more than the second; `None` where F > 0 is not proven.
    end: Option<(f64, f64)>,
}

/// The error of w_j times an entry, relative to it: of the angle, its sine twice, its square, three products and two quotients.
const ROUNDED: f64 = 16.0 * U;

impl SparseSubcycles {
    /// From K, each pair of entries once or both alike, and the mass of each degree of freedom.
    ///
    /// # Errors
    /// As [`SparseSteps::new`]; several levels.
    pub fn new(masses: &[f64], stiffness: &Triplets, levels: Vec<Level>) -> Result<SparseSubcycles> {
        Level::check(&levels, masses.len())?;
        let [level] = &levels[..] else {
            let remedy = "so large a scheme has one level of subcycles: give one, or choose lts";
            return Err(Error::input("levels", format!("{} of them", levels.len()), remedy));
        };
        let single = |own: &Level| vec![Level { fine: own.fine.clone(), substeps: 1 }];
        let plain = SparseSteps::new(masses, stiffness, single(level))?;
        let (masses, stiffness) = layers(masses, stiffness, level);
        let none = Level { fine: Default::default(), substeps: 1 };
        let layered = SparseSteps::within(&masses, &stiffness, vec![none], ROUNDED)?;
        let end = match &plain.fine {
            None => Some((f64::INFINITY, f64::INFINITY)),
            Some(fine) => fine.is_definite().then(|| fine.largest(SHARP)).flatten().map(|(lo, hi)| {
                let p = f64::from(level.substeps);
                let half_turn = 2.0 * p * (std::f64::consts::PI / (2.0 * p)).sin();
                (half_turn / hi.sqrt() * (1.0 - 8.0 * U), half_turn / lo.sqrt() * (1.0 + 8.0 * U))
            }),
        };
        Ok(SparseSubcycles { level: level.clone(), plain, layered, end })
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.plain.size()
    }

    /// The products of one factorization.
    pub fn products(&self) -> f64 {
        self.layered.products()
    }

    /// Which degrees of freedom subcycle, and how often.
    pub fn level(&self) -> &Level {
        &self.level
    }

    /// Leapfrog of the same body, all with the step of the whole.
    pub fn plain(&self) -> &SparseSteps {
        &self.plain
    }

    /// The verdict at a step, the nearest double of it: two factorizations, or a vector that proves growth; [`Holds::NotTold`] where the fastest fine
    /// motion takes half a turn in a step.
    pub fn verdict(&self, dt: f64) -> Holds {
        match (self.end, self.layered.verdict(dt)) {
            (Some(_), Holds::Stable) => Holds::Stable,
            (Some((end, _)), Holds::Unstable) if dt < end => Holds::Unstable,
            _ => Holds::NotTold,
        }
    }

    /// \[lo, hi\]: every step in (0, lo] is proven stable, some step up to hi is unstable or has the multiplier −1; `None` where nothing is proven.
    ///
    /// Where the fastest fine motion takes half a turn the step has the multiplier −1, however weakly that motion is coupled: where the coupling is too
    /// weak for doubles to see what grows before, hi is the upper end of the half turn's enclosure. If the coarse part feels that motion at all, something
    /// grows a little before it. If not, the step with the multiplier −1 is stable; steps beyond it are not looked at.
    pub fn first_unstable(&self) -> Option<(f64, f64)> {
        let ((lo, hi), (_, half_turn)) = (self.edge()?, self.end?);
        Some((lo, hi.unwrap_or(half_turn))).filter(|own| own.1.is_finite())
    }

    /// All steps up to the first are proven stable, and the second is proven unstable.
    fn edge(&self) -> Option<(f64, Option<f64>)> {
        let ((end, _), (lo, hi)) = (self.end?, self.layered.plain_limit_within(SHARP)?);
        // The enclosure of an eigenvalue ends where doubles do; the verdict is proven a little beside it.
        let beside = |at: f64, sign: f64, told: Holds| {
            let steps = BESIDE.into_iter().map(move |by| at * (1.0 + sign * by));
            steps.take_while(move |&dt| dt < end).find(|&dt| self.verdict(dt) == told)
        };
        Some((beside(lo.min(end.next_down()), -1.0, Holds::Stable)?, beside(hi, 1.0, Holds::Unstable)))
    }

    /// The verdicts on all steps from `lo` to `hi`, as stretches that cover them: they are open from where the fastest fine motion takes half a turn.
    ///
    /// # Errors
    /// An empty range.
    pub fn stretches(&self, (lo, hi): (f64, f64)) -> Result<Vec<Stretch>> {
        if !(lo > 0.0 && lo < hi && hi.is_finite()) {
            let remedy = "write the smaller step first, both positive";
            return Err(Error::input("range", format!("{lo}..{hi}"), remedy));
        }
        // 4/dt² falls: what is below it is so at all smaller steps, what grows does at all larger ones up to the end.
        let told = match (self.edge(), self.end) {
            (Some((stable, None)), _) => vec![(0.0, stable, Holds::Stable)],
            (Some((stable, Some(unstable))), Some((end, _))) => {
                vec![
                    (0.0, stable, Holds::Stable),
                    (stable, unstable, Holds::NotTold),
                    (unstable, end, Holds::Unstable),
                ]
            }
            _ => Vec::new(),
        };
        let last = told.last().map_or(0.0, |own| own.1);
        let all = told.into_iter().chain([(last, f64::INFINITY, Holds::NotTold)]);
        let within = all.map(|(a, b, verdict)| Stretch { lo: a.max(lo), hi: b.min(hi), verdict });
        Ok(merged(within.filter(|own| own.lo < own.hi)))
    }

    /// The summary of the scheme in answers.
    pub fn summary(&self) -> SchemeSummary {
        SchemeSummary {
            scheme: Scheme::Newmark,
            size: self.size(),
            levels: vec![(self.level.fine.len(), self.level.substeps)],
            plain_limit: self.plain.plain_limit(),
            first_unstable: self.first_unstable(),
        }
    }
}

/// How sharp the step at which the fastest fine motion takes half a turn is, and the first unstable one: the coupling between them may be weak.
const SHARP: f64 = 1e-12;

/// How far beside its enclosure the first unstable step may be proven, relative to it.
const BESIDE: [f64; 7] = [1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6];

/// Masses and stiffness of the body in layers: the coarse degrees of freedom first, then layer by layer.
fn layers(masses: &[f64], stiffness: &Triplets, level: &Level) -> (Vec<f64>, Vec<(usize, usize, f64)>) {
    let p = level.substeps;
    let count = p.div_ceil(2);
    let of = |j: u32| {
        let mass = if 2 * j + 1 == p { 1.0 } else { 2.0 };
        let sine = (f64::from(2 * j + 1) * std::f64::consts::PI / (2.0 * f64::from(p))).sin();
        (mass, mass / (f64::from(p) * sine).powi(2))
    };
    let all: Vec<(f64, f64)> = (0..count).map(of).collect();
    let is_fine = |i: &usize| level.fine.contains(i);
    let coarse = (0..masses.len()).filter(|i| !is_fine(i));
    let order: Vec<usize> = coarse.chain(level.fine.iter().copied()).collect();
    let (fine, first) = (level.fine.len(), masses.len() - level.fine.len());
    let mut place = vec![0; masses.len()];
    order.iter().enumerate().for_each(|(at, &i)| place[i] = at);
    let mut weighed: Vec<f64> = order[..first].iter().map(|&i| masses[i]).collect();
    for (mass, _) in &all {
        weighed.extend(order[first..].iter().map(|&i| mass * masses[i]));
    }
    let mut entries = Vec::new();
    for &(i, j, x) in stiffness.iter().filter(|(i, j, _)| i >= j) {
        let (low, high) = (place[i].min(place[j]), place[i].max(place[j]));
        if high < first {
            entries.push((high, low, x));
            continue;
        }
        for (layer, (_, weight)) in all.iter().enumerate() {
            let of = |at: usize| if at < first { at } else { at + layer * fine };
            entries.push((of(high), of(low), weight * x));
        }
    }
    (weighed, entries)
}
