//! Where the first region of two sparse levels ends, and how far a verdict in it stands.

use std::sync::PoisonError;

use faer::Mat;

use super::{First, INVERSE_KRYLOV_DIM, MARGIN_REL_TOL, SparseLevels};
use crate::levels::chord::chord;
use crate::levels::kernel::Outer;
use crate::levels::search::{first_past, largest_below};
use crate::levels::sparse::krylov::top;
use number::{U, bisected};

/// Dimension of the Krylov space of the matrix itself, and the residual of an accepted Ritz vector, relative
/// to its eigenvalue: eigenvalues lie close together, and the quotient errs by the square of the residual.
const KRYLOV_DIM: usize = 240;
const RITZ_REL_TOL: f64 = 1e-4;

/// Iterations: the least stretched vector at a step, then the step at which that vector is stretched no more.
const STEP_ITERATIONS: usize = 4;

/// Parts of the step that a vector tells, from which the first region's end is sought; then parts of the one
/// at which the fastest mode alone takes half a turn.
const BELOW_LIMIT: [f64; 3] = [1.0 - WIDTH / 2.0, 0.999, 0.99];
const FROM: [f64; 8] = [0.9, 0.5, 0.2, 0.1, 0.03, 0.01, 1e-3, 1e-4];

/// The relative width within which the first unstable step is sought.
const WIDTH: f64 = 1e-4;

impl SparseLevels {
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

    pub(super) fn first(&self, inner_steps: u64) -> Option<First> {
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
        let hi = first_past(lo, WIDTH / 16.0, top, unstable)?;
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

    /// Whether (1) and (2) follow at an outer step from what is proven at the end of the first region,
    /// without another factorization.
    ///
    /// There α₁ + a₁F + b₁S > 0 with b₁ < 0, so S < (α₁ + a₁F)/−b₁, and with r = b/b₁ > 0
    /// α + aF + bS > (α − r α₁) + (a − r a₁)F: a line over the spectrum of F, no lower than at its ends.
    pub(super) fn is_below_first(&self, outer: &Outer, epsilon: f64) -> bool {
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
