//! The first stable region of two sparse levels.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use faer::Mat;

use super::krylov::top;
use super::matrix::{Factors, Pattern, Triplets, symmetric};
use crate::half::norm;
use crate::levels::chord::{chord, ends, lowest};
use crate::levels::half::Half;
use crate::levels::kernel::{Outer, STEP_ERROR};
use crate::verdict::large::start;
use crate::verdict::measured::Holds;
use number::error::{Error, Result};
use number::parallel::both;
use number::{U, bisected};

/// The fast and the slow stiffness, mass-weighted (1/time²), sparse, and the rigid motions that are set
/// apart.
///
/// ```
/// use faer::Mat;
/// use kickdrift_systems::Holds;
/// use kickdrift_systems::levels::Outer;
/// use kickdrift_systems::levels::sparse::SparseLevels;
/// // A thousand oscillators, each on a stiff spring, soft springs between neighbours and to walls.
/// let n = 1000;
/// let fast: Vec<_> = (0..n).map(|i| (i, i, 1.0)).collect();
/// let slow: Vec<_> = (0..n).map(|i| (i, i, 0.02)).chain((1..n).map(|i| (i, i - 1, -0.01))).collect();
/// let levels = SparseLevels::new(&vec![1.0; n], [&fast, &slow], Mat::zeros(n, 0))?;
/// // Outer steps of eight inner ones: half the fast period is π.
/// let (lo, hi) = levels.first_unstable(8).expect("proven");
/// assert!(2.9 < lo && lo < hi && hi < 3.15);
/// assert_eq!(levels.verdict(&Outer::new(2.0, 8)?, 1e-6), Holds::Stable);
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SparseLevels {
    /// Both in the pattern of their sum.
    both: Pattern,
    fast: Vec<f64>,
    slow: Vec<f64>,
    /// The fast one in its own.
    alone: Pattern,
    fast_alone: Vec<f64>,
    /// How far these are from the matrices that are meant (2-norm), by what weighing with masses rounds; and
    /// how far F + S is from itself without what it does along rigid motions.
    errors: [f64; 2],
    leak: f64,
    /// No less than their norms.
    sizes: [f64; 2],
    /// Orthonormal, mass-weighted.
    rigid: Mat<f64>,
    /// Bounds of the eigenvalues of F, from below and from above.
    ends: OnceLock<Option<[f64; 2]>>,
    held: OnceLock<Held>,
    /// By the number of inner steps.
    first: Arc<Mutex<BTreeMap<u64, Option<First>>>>,
}

/// Where the first region ends, and the vector that proves it.
#[derive(Clone, Debug)]
struct First {
    step: (f64, f64),
    quotients: [f64; 2],
}

/// Positive definiteness of F + S on the complement of the rigid motions.
#[derive(Clone, Copy, Debug)]
struct Held {
    /// The directions along which it is not proven positive; `None` where they are not counted.
    not_proven: Option<usize>,
    /// Where there are none, the least xᵀ(F + S)x that a Krylov space finds, rounded; `None` where it finds
    /// none.
    least: Option<f64>,
    /// F + S + E is proven positive definite for all E of a 2-norm up to this; 0 where that was not sought.
    above: f64,
}

/// Steps of Lanczos's recursion for the largest eigenvalue of F.
const STEPS: usize = 60;

/// Rooms that are tried above what it finds, relative to it.
const ROOMS: [f64; 5] = [1e-9, 1e-7, 1e-5, 1e-3, 3e-2];

/// Eigenvalues of F may lie so far below 0 by rounding and differences, relative to its largest one.
const NEGATIVE_TOL: f64 = 1e-6;

/// Beyond the tolerance they may lie so far below 0, which the answer then says.
const NEGATIVE_LIMIT: f64 = 1e-2;

/// Dimension of the Krylov space of an inverse, from which the least stretched vector comes.
const INVERSE_KRYLOV_DIM: usize = 16;

/// Dimension of the Krylov space of the matrix itself, and the residual of an accepted Ritz vector, relative
/// to its eigenvalue: eigenvalues lie close together, and the quotient errs by the square of the residual.
const KRYLOV_DIM: usize = 240;
const RITZ_REL_TOL: f64 = 1e-4;

/// Iterations: the least stretched vector at a step, then the step at which that vector is stretched no more.
const STEP_ITERATIONS: usize = 4;

/// Products of a factorization from which on two are made side by side, as long as they are not large.
const SIDE_BY_SIDE: f64 = 1e8;

/// Parts of the step that a vector tells, from which the first region's end is sought; then parts of the one
/// at which the fastest mode alone takes half a turn.
const BELOW_LIMIT: [f64; 3] = [1.0 - WIDTH / 2.0, 0.999, 0.99];
const FROM: [f64; 8] = [0.9, 0.5, 0.2, 0.1, 0.03, 0.01, 1e-3, 1e-4];

/// A stiffness's part of its norm up to which a rotation is set apart: of molecules at their minima forces
/// that turn with the atoms hold some hundredths.
const TURNED: f64 = 0.25;

/// Shifts, relative to the norms, by which F + S is positive definite in doubles.
const SHIFTED: [f64; 3] = [1e-9, 1e-7, 1e-5];

/// Steps of Lanczos's recursion for the least eigenvalue of F + S.
const LANCZOS_STEPS: usize = 1200;

/// Products of a factorization, an entry of the matrix, from which on these steps cost less than to factor
/// twice, and to keep the factors once: some hundred products with each entry, at the speed of the memory.
const WORTH_A_RECURSION: f64 = 2e4;

/// The margin is bracketed within 6 %.
const MARGIN_REL_TOL: f64 = 0.06;

/// The relative width within which the first unstable step is sought.
const WIDTH: f64 = 1e-4;

impl SparseLevels {
    /// From K of both levels and the mass of each degree of freedom; the columns of `rigid` are orthonormal
    /// and mass-weighted, and what the stiffnesses do along them is projected out: forms that are definite on
    /// all vectors are so on those that are not rigid.
    ///
    /// # Errors
    /// Masses that are not positive or as many as rows; numbers that are not finite; indices beyond the rows;
    /// pairs of entries that differ.
    pub fn new(masses: &[f64], [fast, slow]: [&Triplets; 2], rigid: Mat<f64>) -> Result<SparseLevels> {
        let n = masses.len();
        if let Some((i, mass)) = masses.iter().enumerate().find(|(_, m)| !(m.is_finite() && **m > 0.0)) {
            return Err(Error::input(&format!("masses[{i}]"), mass, "a mass must be positive"));
        }
        let weighted = |triples: &Triplets| -> Result<Vec<_>> {
            let weight = |i: usize, j: usize| masses[i].sqrt() * masses[j].sqrt();
            Ok(symmetric("stiffness", n, triples, false)?
                .into_iter()
                .map(|(i, j, x)| (i, j, x / weight(i, j)))
                .collect())
        };
        let (fast_terms, slow_terms) = (weighted(fast)?, weighted(slow)?);
        let (both, [fast, slow]) = Pattern::of(n, [&fast_terms, &slow_terms])?;
        let (alone, [fast_alone]) = Pattern::of(n, [&fast_terms])?;
        let sizes = [&fast, &slow].map(|values| both.size_of(values));
        // Two roots, their product, the quotient.
        let errors = sizes.map(|(size, _)| 4.1 * U * size);
        let total: Vec<f64> = fast.iter().zip(&slow).map(|(f, s)| f + s).collect();
        // P T P − T for the projection P on what is not rigid: ‖T V‖ twice and Vᵀ T V once.
        let ((size, terms), image) = (both.size_of(&total), both.times(&total, &rigid));
        let rounding = 2.0 * (terms as f64 + 2.0) * U * size * norm::frobenius(&rigid);
        let leak = 3.1 * (norm::frobenius(&image) + rounding);
        let (ends, held, first) = Default::default();
        let sizes = sizes.map(|(size, _)| size);
        Ok(SparseLevels {
            both,
            fast,
            slow,
            alone,
            fast_alone,
            errors,
            leak,
            sizes,
            rigid,
            ends,
            held,
            first,
        })
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.both.size()
    }

    /// ‖F r‖/‖F‖ for the rigid motions r, rounded, and the same of S.
    pub fn removed(&self) -> [f64; 2] {
        self.removed_along(self.rigid.ncols())
    }

    /// The same for the first ones alone.
    fn removed_along(&self, count: usize) -> [f64; 2] {
        let rigid = self.rigid.subcols(0, count.min(self.rigid.ncols())).to_owned();
        [(&self.fast, self.sizes[0]), (&self.slow, self.sizes[1])].map(|(values, size)| {
            let along = norm::frobenius(&self.both.times(values, &rigid));
            if along == 0.0 { 0.0 } else { along / size }
        })
    }

    /// That no stiffness holds what is set apart, three translations and rotations of particles: the former
    /// by no more than its accuracy, the latter by no more than forces that turn with the atoms do. A sum
    /// that vanishes where both hold is no reason: their kicks fall at different times.
    ///
    /// # Errors
    /// Where one does.
    pub(crate) fn check_rigid(&self, accuracy: f64) -> Result<()> {
        let rounding = 16.0 * (self.size() as f64 + 4.0) * U;
        let checks = [(3, "translations", accuracy + rounding), (usize::MAX, "rigid motions", TURNED)];
        for (count, name, most) in checks {
            let parts = ["fast", "slow"].into_iter().zip(self.removed_along(count));
            if let Some((level, part)) = parts.into_iter().find(|part| part.1 > most) {
                let value =
                    format!("the {level} stiffness holds {part:.1e} of its norm along {name} of all atoms");
                let remedy = if part > TURNED {
                    "a field or tethers hold the atoms: say \"keep_rigid\": true".to_string()
                } else {
                    format!(
                        "within its accuracy of {accuracy:.1e} they are neither rigid nor clearly held: say \"keep_rigid\": true where a field holds the \
                         atoms, or \"accuracy\": {:.1e} where the stiffnesses are known no better",
                        1.1 * part
                    )
                };
                return Err(Error::input("rigid motions", value, remedy));
            }
        }
        Ok(())
    }

    /// The products of one factorization.
    pub fn products(&self) -> f64 {
        self.both.products()
    }

    /// The verdict at an outer step, for all stiffnesses within `epsilon` times their norms.
    pub fn verdict(&self, outer: &Outer, epsilon: f64) -> Holds {
        match self.is_proven(outer, epsilon) {
            true => Holds::Stable,
            false if self.is_unstable(outer, epsilon) => Holds::Unstable,
            false => Holds::Undecided,
        }
    }

    /// Whether the mode that is unstable first is proven to grow at an outer step, for all stiffnesses within
    /// `epsilon` times their norms.
    pub fn is_unstable(&self, outer: &Outer, epsilon: f64) -> bool {
        self.first(outer.inner_steps)
            .is_some_and(|first| self.resonates_along(first.quotients, outer, epsilon))
    }

    /// The largest ε, rounded down within six percent, for which the verdict is stable for all stiffnesses
    /// within ε times their norms; `None` where it is not for 0.
    ///
    /// Two conditions each hold up to some ε, and the smaller one is asked for. A vector shows what the first
    /// is at most; most often what is known of the first region's end proves nearly as much, and elsewhere
    /// one factorization a little below does.
    pub fn margin(&self, outer: &Outer) -> Option<f64> {
        let quotients = self.quotients(&self.stretched_least(outer, self.start_vector())?);
        let is_open = |epsilon: f64| self.form_along(quotients, outer, epsilon) > 0.0;
        if !is_open(0.0) || self.unproven_directions() != Some(0) {
            return None;
        }
        let most = bisected((0.0, 1.0), 1e-6, |epsilon| Some(is_open(epsilon))).1;
        let total = self.total_margin(most);
        let known = bisected((0.0, most), 1e-3, |epsilon| Some(self.is_below_first(outer, epsilon))).0;
        let line = if known >= total.min(most / (1.0 + MARGIN_REL_TOL)) {
            known
        } else if total < most && self.is_above(outer, total) {
            total
        } else {
            largest_below(most.min(total), 0.01, |epsilon| self.is_above(outer, epsilon))
        };
        let margin = line.min(total);
        (margin > 0.0 || self.is_above(outer, 0.0)).then_some(margin)
    }

    /// The largest ε up to `most`, rounded down, for which F + S is definite by as much.
    fn total_margin(&self, most: f64) -> f64 {
        let off = |epsilon: f64| (0..2).map(|k| self.errors[k] + epsilon * self.sizes[k]).sum::<f64>();
        let Held { least, above, .. } = *self.held();
        if above >= off(most) {
            return most;
        }
        if above > off(0.0) {
            return (1.0 - 8.0 * U) * (above - off(0.0)) / (self.sizes[0] + self.sizes[1]);
        }
        let is_definite = |epsilon: f64| self.is_total_definite(off(epsilon));
        // Its least eigenvalue is at most this quotient; what counts eigenvalues proves it by a shift that is
        // larger.
        let room = if self.rigid.ncols() == 0 { 1.0 } else { 1.1 };
        let least = least.map_or(f64::INFINITY, |least| least / room - off(0.0));
        let value = least.max(0.0) / (self.sizes[0] + self.sizes[1]);
        if value > most && is_definite(most) {
            return most;
        }
        largest_below(most.min(value), MARGIN_REL_TOL, is_definite)
    }

    /// \[lo, hi\]: every outer step of so many inner ones in (0, lo] is proven stable, hi is proven unstable;
    /// `None` where nothing is proven.
    pub fn first_unstable(&self, inner_steps: u64) -> Option<(f64, f64)> {
        self.first_resonance(inner_steps).filter(|_| self.unproven_directions() == Some(0))
    }

    /// \[lo, hi\]: at every outer step of so many inner ones in (0, lo] all multipliers are on the circle or
    /// real and positive, so that what grows falls without swinging, as where forces hold no minimum; at hi
    /// one is proven below −1. `None` where nothing is proven.
    ///
    /// With a, b, d of the inner steps' half, μ + 1 are the eigenvalues of b d(h² F) (a/b(h² F) − (p/2) h² S)
    /// (proofs/REGION.md): b d > 0 by (2), so they are real, and have the signs of (1).
    pub fn first_resonance(&self, inner_steps: u64) -> Option<(f64, f64)> {
        self.first(inner_steps).map(|first| first.step)
    }

    /// F y and S y without what they do along rigid motions, mass-weighted and rounded.
    pub fn apply_stiffnesses(&self, y: &[f64]) -> [Vec<f64>; 2] {
        let free = |y: Mat<f64>| &y - &self.rigid * (self.rigid.transpose() * &y);
        let y = free(Mat::from_fn(y.len(), 1, |i, _| y[i]));
        [&self.fast, &self.slow].map(|values| free(self.both.times(values, &y)).col_as_slice(0).to_vec())
    }

    fn first(&self, inner_steps: u64) -> Option<First> {
        let mut known = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        known.entry(inner_steps).or_insert_with(|| self.find_first(inner_steps)).clone()
    }

    fn find_first(&self, inner_steps: u64) -> Option<First> {
        let [_, high] = self.ends(0.0)?;
        let at = |step: f64| Outer::new(step, inner_steps).ok();
        let is_proven = |step: f64| at(step).is_some_and(|outer| self.is_above(&outer, 0.0));
        // At the latest where the fastest mode alone has p θ = π.
        let angle = std::f64::consts::PI / (2.0 * inner_steps as f64);
        let top = inner_steps as f64 * 2.0 * angle.sin() / high.sqrt();
        // The vector that is stretched least tells how far the line may prove anything; the nearer the step,
        // the sharper.
        let limit = |along: &Mat<f64>, range: (f64, f64)| {
            let quotients = self.quotients(along);
            let is_open =
                |step: f64| at(step).is_some_and(|outer| self.form_along(quotients, &outer, 0.0) > 0.0);
            bisected(range, WIDTH / 8.0, |step| Some(is_open(step))).1
        };
        let (mut hi, mut along) = (top, self.start_vector());
        for _ in 0..STEP_ITERATIONS {
            let last = hi;
            along = self.stretched_least(&at(hi * (1.0 - WIDTH))?, along)?;
            hi = hi.min(limit(&along, (0.0, hi)));
            if hi > last * (1.0 - WIDTH) {
                break;
            }
        }
        let begin = BELOW_LIMIT.iter().map(|part| part * hi).chain(FROM.iter().map(|part| part * top));
        let mut lo = begin.into_iter().find(|&step| step < hi && is_proven(step))?;
        while hi > lo * (1.0 + WIDTH) {
            let Some(next) = self
                .above(&at(lo)?)
                .and_then(|above| above.least(along.clone(), &self.rigid, INVERSE_KRYLOV_DIM))
            else {
                break;
            };
            along = next;
            hi = hi.min(limit(&along, (lo, hi)));
            let Some(found) = nearer(lo, &mut hi, is_proven) else { break };
            lo = found;
        }
        let quotients = self.quotients(&along);
        let unstable = |step: f64| at(step).is_some_and(|outer| self.resonates_along(quotients, &outer, 0.0));
        let first =
            (0..40).map(|k| lo * (1.0 + WIDTH / 16.0 * 1.5f64.powi(k))).take_while(|&step| step < top);
        let hi = first.into_iter().find(|&step| unstable(step))?;
        let (_, hi) = bisected((lo, hi), WIDTH / 64.0, |step| Some(!unstable(step)));
        Some(First { step: (lo, hi), quotients })
    }

    /// About the vector of length 1 that α − β h² F − M stretches least at an outer step.
    fn stretched_least(&self, outer: &Outer, from: Mat<f64>) -> Option<Mat<f64>> {
        let [low, high] = self.ends(0.0)?;
        let ([fast, slow], _) = self.form(outer, chord(outer, low, high)?, 0.0);
        let taken: Vec<f64> = self.fast.iter().zip(&self.slow).map(|(f, s)| -fast * f - slow * s).collect();
        top(from, &self.rigid, KRYLOV_DIM, RITZ_REL_TOL, |x| Some(self.both.times(&taken, x)))
    }

    /// Whether the first region is proven, rigid motions apart.
    fn is_proven(&self, outer: &Outer, epsilon: f64) -> bool {
        // (3) of proofs/REGION.md follows where F + S > 0.
        let off: f64 = (0..2).map(|k| self.errors[k] + epsilon * self.sizes[k]).sum();
        // What proves a step proves those below it, and nothing proves where the region ends.
        let is_near = || self.first_resonance(outer.inner_steps).is_none_or(|(_, hi)| outer.step() < hi);
        self.is_total_definite(off)
            && (self.is_below_first(outer, epsilon) || is_near() && self.is_above(outer, epsilon))
    }

    /// Whether (1) and (2) of proofs/REGION.md are proven.
    fn is_above(&self, outer: &Outer, epsilon: f64) -> bool {
        let line = self.ends(epsilon).and_then(|[low, high]| chord(outer, low, high));
        line.is_some_and(|line| {
            let ([fast, slow], slack) = self.form(outer, line, epsilon);
            self.both.is_definite(line[0], &[(fast, &self.fast), (slow, &self.slow)], slack)
        })
    }

    /// The factors that prove it.
    fn above(&self, outer: &Outer) -> Option<Factors> {
        let [low, high] = self.ends(0.0)?;
        let line = chord(outer, low, high)?;
        let ([fast, slow], slack) = self.form(outer, line, 0.0);
        self.both.factored(line[0], &[(fast, &self.fast), (slow, &self.slow)], slack)
    }

    /// Whether (1) and (2) follow at an outer step from what is proven at the end of the first region,
    /// without another factorization.
    ///
    /// There α₁ + a₁F + b₁S > 0 with b₁ < 0, so S < (α₁ + a₁F)/−b₁, and with r = b/b₁ > 0
    /// α + aF + bS > (α − r α₁) + (a − r a₁)F: a line over the spectrum of F, no lower than at its ends.
    fn is_below_first(&self, outer: &Outer, epsilon: f64) -> bool {
        let found = || {
            let first = Outer::new(self.first(outer.inner_steps)?.step.0, outer.inner_steps).ok()?;
            let ends = self.ends(0.0)?;
            let [low, high] = self.ends(epsilon)?;
            let (line, known) = (chord(outer, low, high)?, chord(&first, ends[0], ends[1])?);
            let (([a, b], slack), ([a_1, b_1], _)) =
                (self.form(outer, line, epsilon), self.form(&first, known, 0.0));
            let r = b / b_1;
            Some(ends.into_iter().all(|s| {
                let terms = [line[0], a * s, -r * known[0], -r * a_1 * s];
                let rounding = 8.0 * U * terms.iter().map(|x| x.abs()).sum::<f64>();
                terms.iter().sum::<f64>() > slack + rounding
            }))
        };
        found().unwrap_or(false)
    }

    /// α − β h² F − M of a line α − β s: its factors of F and S, and how far the sum may be from it for
    /// stiffnesses within ε times their norms.
    fn form(&self, outer: &Outer, [offset, slope]: [f64; 2], epsilon: f64) -> ([f64; 2], f64) {
        let off = [0, 1].map(|k| self.errors[k] + epsilon * self.sizes[k]);
        let [fast, slow] = [-slope * outer.inner_square, -outer.half_kick()];
        let rounding = 4.0 * U * offset.abs()
            + 4.0 * STEP_ERROR * (fast.abs() * self.sizes[0] + slow.abs() * self.sizes[1]);
        ([fast, slow], 1.01 * (rounding + fast.abs() * off[0] + slow.abs() * off[1]))
    }

    /// Bounds on the spectrum of all F within ε times their norm.
    fn ends(&self, epsilon: f64) -> Option<[f64; 2]> {
        let found = self.ends.get_or_init(|| {
            let [_, top] = ends(self.size(), STEPS, |x| self.alone.times(&self.fast_alone, x));
            let slack = self.errors[0] + 4.0 * U * self.sizes[0];
            let is_above = |high: f64| self.alone.is_definite(high, &[(-1.0, &self.fast_alone)], slack);
            let is_below = |low: f64| self.alone.is_definite(low, &[(1.0, &self.fast_alone)], slack);
            let high = ROOMS.iter().map(|room| top * (1.0 + room)).find(|&high| is_above(high))?;
            let below = [NEGATIVE_TOL, NEGATIVE_LIMIT]
                .iter()
                .map(|room| room * high)
                .find(|&below| is_below(below))?;
            Some([-below, high])
        });
        let off = epsilon * self.sizes[0];
        found.map(|[low, high]| [low - off, high + off])
    }

    /// The number of directions, rigid motions aside, along which F + S is not proven positive: it is
    /// negative there, or too small for doubles to tell. `None` where the factorization does not count them.
    pub fn unproven_directions(&self) -> Option<usize> {
        self.held().not_proven
    }

    fn held(&self) -> &Held {
        self.held.get_or_init(|| {
            if let Some(held) = self.held_by_as_much() {
                return held;
            }
            let (not_proven, factors) = self.not_above_zero(self.errors[0] + self.errors[1]);
            let least = if not_proven == Some(0) { self.least_total(factors) } else { None };
            Held { not_proven, least, above: 0.0 }
        })
    }

    /// Whether a factorization costs so much that one is saved by a recursion, and that two at once take too
    /// much memory.
    fn is_large(&self) -> bool {
        self.products() > WORTH_A_RECURSION * self.both.entries() as f64
    }

    /// What one factorization proves of F + S where Lanczos's recursion finds its least eigenvalue: that it
    /// is above nearly as much.
    fn held_by_as_much(&self) -> Option<Held> {
        if self.rigid.ncols() > 0 || !self.is_large() {
            return None;
        }
        let least = {
            let total: Vec<f64> = self.fast.iter().zip(&self.slow).map(|(f, s)| f + s).collect();
            lowest(self.size(), LANCZOS_STEPS, MARGIN_REL_TOL / 3.0, |x| self.both.times(&total, x))?
        };
        let off = self.errors[0] + self.errors[1];
        let above = off + (least - off) / (1.0 + 0.9 * MARGIN_REL_TOL);
        let slack = self.total_slack(above);
        let is_held = least > off && self.both.is_definite(0.0, &self.total(), slack);
        is_held.then_some(Held { not_proven: Some(0), least: Some(least), above })
    }

    /// How far F + S with up to `off` added to it is from the sum of doubles.
    fn total_slack(&self, off: f64) -> f64 {
        1.01 * (off + self.leak + 4.0 * U * (self.sizes[0] + self.sizes[1]))
    }

    /// The least xᵀ(F + S)x by the factors of F + S, or of a sum a little above it.
    fn least_total(&self, factors: Option<Factors>) -> Option<f64> {
        let size = self.sizes[0] + self.sizes[1];
        let shifted = || SHIFTED.iter().find_map(|part| self.both.factored(part * size, &self.total(), 0.0));
        let along = factors.or_else(shifted)?.least(self.start_vector(), &self.rigid, INVERSE_KRYLOV_DIM)?;
        Some(self.quotients(&along).iter().sum())
    }

    fn total(&self) -> [(f64, &[f64]); 2] {
        [(1.0, &self.fast), (1.0, &self.slow)]
    }

    /// What most answers ask for first: where the first region ends, and whether F + S is positive. Side by
    /// side, or one after the other where each takes much memory.
    pub fn look(&self, inner_steps: u64) {
        both(self.products() > SIDE_BY_SIDE && !self.is_large(), || self.first(inner_steps), || self.held());
    }

    /// Whether F + S + E > 0 off the rigid motions for all E no larger than `off`.
    fn is_total_definite(&self, off: f64) -> bool {
        let is_known = off <= self.held().above.max(self.errors[0] + self.errors[1]);
        let found = if is_known { self.unproven_directions() } else { self.not_above_zero(off).0 };
        found == Some(0)
    }

    /// The eigenvalues of F + S that are not proven above `off` and the roundings: F + S − τ has as many
    /// negative ones, and of these there are as many as rigid motions in any case, along which F + S
    /// vanishes. The factors that prove it, where there are any.
    fn not_above_zero(&self, off: f64) -> (Option<usize>, Option<Factors>) {
        let slack = self.total_slack(off);
        let factors =
            (self.rigid.ncols() == 0).then(|| self.both.factored(0.0, &self.total(), slack)).flatten();
        if factors.is_some() {
            return (Some(0), factors);
        }
        let negative = self.both.at_most_negative(0.0, &self.total(), slack);
        (negative.map(|count| count.saturating_sub(self.rigid.ncols())), None)
    }

    /// Where a recursion for a vector begins.
    fn start_vector(&self) -> Mat<f64> {
        let begin = start(self.size());
        Mat::from_fn(self.size(), 1, |i, _| begin[i])
    }

    /// xᵀ(α − β h² F − M)x of a vector with these quotients, less what stiffnesses within ε times their norms
    /// and roundings take; rounded. −∞ where there is no line.
    fn form_along(&self, [fast, slow]: [f64; 2], outer: &Outer, epsilon: f64) -> f64 {
        let line = self.ends(epsilon).and_then(|[low, high]| chord(outer, low, high));
        line.map_or(f64::NEG_INFINITY, |line| {
            let ([a, b], slack) = self.form(outer, line, epsilon);
            line[0] + a * fast + b * slow - slack
        })
    }

    /// What xᵀFx and xᵀSx are at least over xᵀx, off the rigid motions.
    fn quotients(&self, x: &Mat<f64>) -> [f64; 2] {
        let n = self.size() as f64;
        // Sums of n products each, of |x|ᵀ|A||x| ≤ ‖A‖; what is left of the length and along rigid motions.
        let along = norm::frobenius(&(self.rigid.transpose() * x)) + n * U;
        let length = 1.0 - 1.01 * (n + 4.0) * U;
        let of = |k: usize, values: &[f64]| {
            let off = self.errors[k] + (2.1 * along + 4.04 * (n + 4.0) * U) * self.sizes[k];
            let form = (x.transpose() * self.both.times(values, x))[(0, 0)] - off;
            (form * length).min(form / length)
        };
        [of(0, &self.fast), of(1, &self.slow)]
    }

    /// Whether E(h² xᵀFx) < xᵀMx for sure for a vector with these quotients, all eigenvalues of h² F being
    /// where E is concave: a multiplier is below −1, for all stiffnesses within `epsilon` times their norms.
    fn resonates_along(&self, quotients: [f64; 2], outer: &Outer, epsilon: f64) -> bool {
        let Some([low, high]) = self.ends(epsilon) else { return false };
        // Of one rounding each.
        let [fast, slow] = [0, 1].map(|k| quotients[k] - 1.01 * epsilon * self.sizes[k]);
        if chord(outer, low, high).is_none() {
            return false;
        }
        // E falls: what the quotient is at least.
        let is_inside = fast > low && fast < high && slow > 0.0;
        is_inside && {
            let stretch = Half::new(outer.scaled_down(fast), outer.inner_steps).stretch();
            stretch.hi < (1.0 - 4.0 * STEP_ERROR) * outer.half_kick() * slow
        }
    }
}

/// A step that is proven between lo and hi, near hi; `None` where these are as near to each other as they are
/// to be. `hi` falls to what is not proven.
fn nearer(lo: f64, hi: &mut f64, is_proven: impl Fn(f64) -> bool) -> Option<f64> {
    let mut is_first = true;
    while *hi > lo * (1.0 + WIDTH) {
        let left = *hi / lo - 1.0;
        // The error of what the vector tells falls as the square of its own.
        let below = (left / 10.0).min(left * left).max(WIDTH / 2.0);
        let step = if is_first { *hi * (1.0 - below) } else { lo + (*hi - lo) / 2.0 };
        if step > lo && is_proven(step) {
            return Some(step);
        }
        (*hi, is_first) = (step, false);
    }
    None
}

/// The largest number that holds, rounded down within `width`, where none above `most` does: 0 where it is
/// below 10^-15.
fn largest_below(most: f64, width: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut hi, mut part) = (most, 1.0 / (1.0 + 0.9 * width));
    while hi > LEAST_MARGIN {
        let lo = part * hi;
        if holds(lo) {
            return bisected((lo, hi), width, |x| Some(holds(x))).0;
        }
        (hi, part) = (lo, part * part);
    }
    0.0
}

/// A margin below it is rounding.
const LEAST_MARGIN: f64 = 1e-15;
