//! The first stable region of two sparse levels: what proves it at a step, for all stiffnesses within an
//! accuracy. File `edge` searches for its end and for margins; file `total` has the sum of both stiffnesses.

mod edge;
mod total;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

use faer::Mat;

use super::matrix::{Factors, Pattern, Triplets, symmetric};
use crate::half::norm;
use crate::levels::chord::{chord, ends};
use crate::levels::half::Half;
use crate::levels::kernel::{Outer, STEP_ERROR};
use crate::verdict::large::start;
use crate::verdict::measured::{Holds, check_masses};
use number::{Error, Result, U};

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

/// A stiffness's part of its norm up to which a rotation is set apart: of molecules at their minima forces
/// that turn with the atoms hold some hundredths.
const TURNED: f64 = 0.25;

/// The margin is bracketed within 6 %.
const MARGIN_REL_TOL: f64 = 0.06;

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
        check_masses(masses)?;
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

    /// F y and S y without what they do along rigid motions, mass-weighted and rounded.
    pub fn apply_stiffnesses(&self, y: &[f64]) -> [Vec<f64>; 2] {
        let free = |y: Mat<f64>| &y - &self.rigid * (self.rigid.transpose() * &y);
        let y = free(Mat::from_fn(y.len(), 1, |i, _| y[i]));
        [&self.fast, &self.slow].map(|values| free(self.both.times(values, &y)).col_as_slice(0).to_vec())
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
