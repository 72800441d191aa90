//! Subcycling with held velocities of many thousands of degrees of freedom, on nested levels: its first stable region, by factorizations of a plain leapfrog's
//! matrices (proofs/SUBCYCLING.md).
//!
//! The velocity of a degree of freedom stands still between its own kicks, N_l = p_1 ... p_l of them in a step at level l. A step is the half period there and
//! back, and with the actions of velocities that change their sign from step to step, even about the middle of a step or odd,
//!
//! ```text
//!     even > 0 and K > 0:  stable;      odd > 0, and even is not:  unstable;      even > 0 implies odd > 0.
//! ```
//!
//! In waves of the angles ω = (2 j − 1) π, j = 1 ... ⌈N_l/2⌉, even > 0 is the condition of leapfrog in which no part has substeps, of a body whose level l
//! lies in ⌈N_l/2⌉ layers. Layers ω at level l and ω' at a level above belong together where ω = ±ω' to multiples of 2 π N_l':
//!
//! ```text
//!     Σ_j w_j K(x_0, z_1, z_2, ...) < (4/dt²) (M on x_0, m_j M on each layer),     w_j = m_j/(N sin(ω/(2 N)))²  of the finest level,
//! ```
//!
//! m_j = 2, of ω = N_l π 1; Σ w_j = 1. With two substeps: K below 4/dt² times masses of which the fine ones count twice. Odd > 0 is the same without the layers of
//! m_j = 1; with one level it ends where the fastest fine motion takes half a turn in a step. Beyond it no verdict is proven.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use super::scheme::{Level, Scheme, SchemeSummary};
use super::sparse::SparseSteps;
use crate::error::{Error, Result, room};
use crate::number::U;
use crate::system::levels::sparse::Triplets;
use crate::system::spectrum::rate::Multiplier;
use crate::system::vary::stretches::{Stretch, merged};
use crate::system::verdict::analysis::Instability;
use crate::system::verdict::large::{dominant, growing};
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
    levels: Vec<Level>,
    /// Leapfrog without substeps, and that of the body in layers.
    plain: SparseSteps,
    layered: SparseSteps,
    /// The step at which the odd action is singular: no less than the first, no more than the second; `None` where that is not known.
    end: Option<(f64, f64)>,
}

/// The error of w_j times an entry, relative to it: of the angle, its sine twice, its square, three products and two quotients.
const ROUNDED: f64 = 16.0 * U;

impl SparseSubcycles {
    /// From K, each pair of entries once or both alike, and the mass of each degree of freedom.
    ///
    /// # Errors
    /// As [`SparseSteps::new`].
    pub fn new(masses: &[f64], stiffness: &Triplets, levels: Vec<Level>) -> Result<SparseSubcycles> {
        SparseSubcycles::within(masses, stiffness, levels, 0.0)
    }

    /// As [`SparseSubcycles::new`], for entries that are each off by so much, relative to their size.
    pub(super) fn within(
        masses: &[f64],
        stiffness: &Triplets,
        levels: Vec<Level>,
        off: f64,
    ) -> Result<SparseSubcycles> {
        Level::check(&levels, masses.len())?;
        // Without substeps: so its fine block is the part of A that has any.
        let fine = levels.iter().find(|own| own.substeps > 1).map(|own| own.fine.clone()).unwrap_or_default();
        let plain = SparseSteps::within(masses, stiffness, vec![Level { fine, substeps: 1 }], off)?;
        room(
            layered_bytes(masses.len(), stiffness, &levels),
            "fewer substeps, or fewer degrees of freedom that take them",
        )?;
        let Layered { masses, stiffness, odd } = layers(masses, stiffness, &levels);
        // And here that of the odd action.
        let odd = Level { fine: odd, substeps: 1 };
        let layered = SparseSteps::within(&masses, &stiffness, vec![odd], ROUNDED + off)?;
        let end = match &layered.fine {
            None => Some((f64::INFINITY, f64::INFINITY)),
            Some(odd) => odd.limit(SHARP),
        };
        Ok(SparseSubcycles { levels, plain, layered, end })
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.plain.size()
    }

    /// The products of one factorization.
    pub fn products(&self) -> f64 {
        self.layered.products()
    }

    /// Which degrees of freedom subcycle, and how often: the coarsest level first.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// Leapfrog of the same body, all with the step of the whole.
    pub fn plain(&self) -> &SparseSteps {
        &self.plain
    }

    /// The verdict at a step, the nearest double of it: two factorizations, or a vector that proves growth; [`Holds::NotTold`] from where the odd action
    /// is not positive, with one level where the fastest fine motion takes half a turn in a step.
    pub fn verdict(&self, dt: f64) -> Holds {
        // Where it is K that has a negative value, the fine part must be positive.
        let grows = |end: f64| {
            let is_definite = || self.plain.fine.as_ref().is_none_or(|fine| fine.is_definite());
            dt < end && (self.layered.is_below_four(dt) == Holds::Unstable || is_definite())
        };
        match self.layered.verdict(dt) {
            Holds::Unstable if !self.end.is_some_and(|(end, _)| grows(end)) => Holds::NotTold,
            own => own,
        }
    }

    /// \[lo, hi\]: every step in (0, lo] is proven stable, some step up to hi is unstable or has the multiplier −1; `None` where nothing is proven.
    ///
    /// Where the odd action is singular (with one level, where the fastest fine motion takes half a turn) the step has the multiplier −1, however weakly
    /// that motion is coupled to what is coarse: where the coupling is too weak for doubles to see what grows before, hi is the upper end of that step's
    /// enclosure. If the coarse part feels that motion at all, something grows a little before it. If not, the step with the multiplier −1 is stable;
    /// steps beyond it are not looked at.
    pub fn first_unstable(&self) -> Option<(f64, f64)> {
        self.first().map(|own| own.0)
    }

    /// The first unstable step, and whether all that is proven at its upper end is the multiplier −1.
    pub(super) fn first(&self) -> Option<((f64, f64), bool)> {
        let ((lo, hi), (_, singular)) = (self.edge()?, self.end?);
        Some(((lo, hi.unwrap_or(singular)), hi.is_none())).filter(|own| own.0.1.is_finite())
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

    /// The multiplier farthest outside the unit circle by more than `least`, with the mode that grows, both rounded; `None` where an iteration finds none.
    ///
    /// # Errors
    /// Where the work was stopped.
    pub(in crate::system) fn growing(
        &self,
        dt: f64,
        least: f64,
    ) -> Result<Option<(Vec<Multiplier>, Vec<Instability>)>> {
        let n = self.size();
        let substeps: Vec<u32> = (0..n).map(|i| Level::substeps_of(&self.levels, i)).collect();
        let (rows, most) = (self.plain.rows(), substeps.iter().copied().max().unwrap_or(1));
        // The finest first, so that those which kick at one time come before all others.
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&i| Reverse(substeps[i]));
        // Steps and velocities in units of dt.
        let step = |z: &[f64]| {
            let (mut y, mut v) = (z[..n].to_vec(), z[n..].to_vec());
            for tick in 0..=most {
                let weight = if tick % most == 0 { 0.5 } else { 1.0 };
                for &i in order.iter().take_while(|&&i| tick % (most / substeps[i]) == 0) {
                    let pull: f64 = rows[i].iter().map(|&(j, a)| a * y[j]).sum();
                    v[i] -= weight * dt * dt / f64::from(substeps[i]) * pull;
                }
                if tick < most {
                    y.iter_mut().zip(&v).for_each(|(y, v)| *y += v / f64::from(most));
                }
            }
            y.extend(v);
            y
        };
        let found = dominant(2 * n, step, least)?;
        Ok(found.map(|mode| growing(mode, |i| 1.0 / self.plain.root(i))))
    }

    /// The verdicts on all steps from `lo` to `hi`, as stretches that cover them: they are open from where the odd action is not
    /// positive.
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
        let first = self.first();
        SchemeSummary {
            scheme: Scheme::Newmark,
            size: self.size(),
            levels: self.levels.iter().map(|own| (own.fine.len(), own.substeps)).collect(),
            plain_limit: self.plain.plain_limit(),
            first_unstable: first.map(|own| own.0),
            is_minus_one: first.is_some_and(|own| own.1),
        }
    }
}

/// How sharp the step at which the odd action is singular is, and the first unstable one: the coupling between them may be weak.
const SHARP: f64 = 1e-12;

/// How far beside its enclosure the first unstable step may be proven, relative to it.
const BESIDE: [f64; 7] = [1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6];

/// The body in layers, coarsest level first and layer by layer.
struct Layered {
    masses: Vec<f64>,
    stiffness: Vec<(usize, usize, f64)>,
    /// Its degrees of freedom that odd velocities have.
    odd: BTreeSet<usize>,
}

/// Bytes an entry of one triangle in layers, as measured of a string of 20,000 masses in 256 and 512 layers, its factors included: 397 to 427.
const BYTES: u128 = 400;

/// Bytes of the body in layers, roughly: what its matrices take before any is factorized.
fn layered_bytes(n: usize, stiffness: &Triplets, levels: &[Level]) -> u128 {
    let layers = |substeps: u32| u128::from(substeps.div_ceil(2));
    let mut substeps = vec![1; n];
    let mut taken = 1u32;
    for own in levels {
        taken *= own.substeps;
        own.fine.iter().for_each(|&i| substeps[i] = taken);
    }
    let lower = stiffness.iter().filter(|(i, j, _)| i >= j);
    BYTES * lower.map(|&(i, j, _)| layers(substeps[i].max(substeps[j]))).sum::<u128>()
}

fn layers(masses: &[f64], stiffness: &Triplets, levels: &[Level]) -> Layered {
    // Of each level the substeps in a step, its degrees of freedom, and where its first layer begins.
    let mut of: Vec<(u32, Vec<usize>, usize)> = vec![(1, Vec::new(), 0)];
    of.extend(levels.iter().scan(1, |all, own| {
        *all *= own.substeps;
        Some((*all, Vec::new(), 0))
    }));
    let place: Vec<(usize, usize)> = (0..masses.len())
        .map(|i| {
            let level = levels.iter().filter(|own| own.fine.contains(&i)).count();
            of[level].1.push(i);
            (level, of[level].1.len() - 1)
        })
        .collect();
    let (mut weighed, mut odd) = (Vec::new(), BTreeSet::new());
    for (substeps, own, begin) in &mut of {
        *begin = weighed.len();
        for turns in turns(*substeps) {
            let mass = layer_mass(*substeps, turns);
            if mass > 1.0 {
                odd.extend(weighed.len()..weighed.len() + own.len());
            }
            weighed.extend(own.iter().map(|&i| mass * masses[i]));
        }
    }
    let mut entries = Vec::new();
    for &(i, j, x) in stiffness.iter().filter(|(i, j, _)| i >= j) {
        let finest = of[place[i].0.max(place[j].0)].0;
        for turns in turns(finest) {
            let sine = (f64::from(turns) * std::f64::consts::PI / (2.0 * f64::from(finest))).sin();
            let weight = layer_mass(finest, turns) / (f64::from(finest) * sine).powi(2);
            let at = |(level, index): (usize, usize)| {
                let (substeps, own, begin) = &of[level];
                let rest = turns % (2 * substeps);
                begin + own.len() * (rest.min(2 * substeps - rest) / 2) as usize + index
            };
            let (a, b) = (at(place[i]), at(place[j]));
            entries.push((a.max(b), a.min(b), weight * x));
        }
    }
    Layered { masses: weighed, stiffness: entries, odd }
}

/// ω/π of the layers of a level with so many substeps in a step.
fn turns(substeps: u32) -> impl Iterator<Item = u32> {
    (1..=substeps).step_by(2)
}

/// 2 for ±ω, 1 where these are the same.
fn layer_mass(substeps: u32, turns: u32) -> f64 {
    if turns == substeps { 1.0 } else { 2.0 }
}
