//! Whether the sum of two sparse levels is positive definite off the rigid motions, and by how much.

use super::{Held, INVERSE_KRYLOV_DIM, MARGIN_REL_TOL, SparseLevels};
use crate::levels::chord::lowest;
use crate::levels::search::largest_below;
use crate::levels::sparse::matrix::Factors;
use number::U;
use number::parallel::both;

/// Products of a factorization from which on two are made side by side, as long as they are not large.
const SIDE_BY_SIDE: f64 = 1e8;

/// Shifts, relative to the norms, by which F + S is positive definite in doubles.
const SHIFTED: [f64; 3] = [1e-9, 1e-7, 1e-5];

/// Steps of Lanczos's recursion for the least eigenvalue of F + S.
const LANCZOS_STEPS: usize = 1200;

/// Products of a factorization, an entry of the matrix, from which on these steps cost less than to factor
/// twice, and to keep the factors once: some hundred products with each entry, at the speed of the memory.
const WORTH_A_RECURSION: f64 = 2e4;

impl SparseLevels {
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

    /// The largest ε up to `most`, rounded down, for which F + S is definite by as much.
    pub(super) fn total_margin(&self, most: f64) -> f64 {
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

    /// Whether F + S + E > 0 off the rigid motions for all E no larger than `off`.
    pub(super) fn is_total_definite(&self, off: f64) -> bool {
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

    /// What most answers ask for first: where the first region ends, and whether F + S is positive. Side by
    /// side, or one after the other where each takes much memory.
    pub fn look(&self, inner_steps: u64) {
        both(self.products() > SIDE_BY_SIDE && !self.is_large(), || self.first(inner_steps), || self.held());
    }
}
