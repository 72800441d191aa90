//! Verdicts by counting negative eigenvalues, wherever the step lies: no eigenvector, no gap between
//! eigenvalues is asked for.
//!
//! With neg J the number of negative eigenvalues of the action under each pair of ends, and i(s) that of the
//! period whose ends are twisted by e^(iφ), 2 cos φ = 4 s − 2 (`proofs/REGION.md`, section 3):
//!
//! ```text
//!     #{μ < −1} ≥ |neg J_fh − neg J_hf|,        #{μ > 0} ≥ |n + neg J_hh − neg J_ff|,
//!     stable where Σ |i(s_(k+1)) − i(s_k)| = n for some 1 = s_0 > s_1 > ... > s_K = 0.
//! ```
//!
//! Each count grows with the kicks, so those at F ± e₁ I, S ± e₂ I bound those of all stiffnesses between.

use faer::Mat;

use super::half::Half;
use super::kernel::{Kernel, Outer};
use crate::signs::inertia::negative_bounds;
use number::Interval;

/// Twists of an index: more of them cost more than discs about the eigenvalues.
const MOST_TWISTS: usize = 6;

/// The counts that all kicks between two have in common: neg J_hh and neg J_hf, which fall apart into modes.
pub(super) struct Counts {
    /// The modes at the lower and the upper bound of the fast kicks.
    less: Vec<Half>,
    more: Vec<Half>,
    /// M at the lower and the upper bound of the slow stiffness.
    slow: [Mat<f64>; 2],
    /// The 2-norm of their errors, at most.
    slack: f64,
    hh: usize,
    hf: usize,
}

/// neg J_hh and neg J_hf; `None` where a sign is not certain.
fn held(halves: &[Half]) -> Option<(usize, usize)> {
    halves.iter().try_fold((0, 0), |(held, free), half| {
        let changes = half.changes?;
        Some((held + changes, free + changes + usize::from(half.turns_back()?)))
    })
}

/// (a d − s)/(b d), the diagonal of X − s/W: a/b for s = 0, c/d for s = 1.
fn twisted(half: &Half, s: f64) -> Interval {
    match s {
        0.0 => half.stretch(),
        1.0 => -half.restoring(),
        _ => (half.a * half.d - Interval::point(s)) / (half.b * half.d),
    }
}

impl Counts {
    /// `None` where neg J_hh or neg J_hf is not one for all.
    pub fn new([less, more]: [Vec<Half>; 2], slow: [Mat<f64>; 2], slack: f64) -> Option<Counts> {
        let (hh, hf) = held(&less).filter(|counts| held(&more) == Some(*counts))?;
        Some(Counts { less, more, slow, slack, hh, hf })
    }

    /// Bounds for diag(twisted) − M: for all kicks at least the first number of its eigenvalues are negative,
    /// at most the second are negative or 0.
    fn bounds(&self, s: f64) -> (usize, usize) {
        let form = |slow: &Mat<f64>, diagonal: &dyn Fn(usize) -> f64| {
            let m = self.less.len();
            Mat::from_fn(m, m, |i, j| (if i == j { diagonal(i) } else { 0.0 }) - slow[(i, j)])
        };
        let high = form(&self.slow[0], &|i| twisted(&self.less[i], s).hi);
        let low = form(&self.slow[1], &|i| twisted(&self.more[i], s).lo);
        negative_bounds(&low, &high, self.slack)
    }

    /// Whether the counts at the ends prove a real multiplier off the circle.
    pub fn prove_instability(&self) -> bool {
        let (hh, hf, m) = (self.hh, self.hf, self.less.len());
        // J_fh is J_hh and a/b − M, J_ff is J_hf and c/d − M.
        let differ = |s: f64, more: usize, other: usize| {
            let (least, most) = self.bounds(s);
            more + least > other || more + most < other
        };
        differ(0.0, hh, hf) || differ(1.0, hf, m + hh)
    }

    /// Whether Σ |i(s_(k+1)) − i(s_k)| = n over the twists between 1 and 0.
    pub fn prove_stability(&self, twists: &[f64]) -> bool {
        let at = [1.0].into_iter().chain(twists.iter().copied()).chain([0.0]);
        let one = |s: f64| Some(self.bounds(s)).filter(|(least, most)| least == most).map(|(count, _)| count);
        let counts: Option<Vec<usize>> = at.map(one).collect();
        let change =
            |indexes: Vec<usize>| indexes.windows(2).map(|pair| pair[0].abs_diff(pair[1])).sum::<usize>();
        counts.map(change) == Some(self.less.len())
    }

    /// Values of s between modes p θ/2 of which turned back and others; cos²(p θ/2) alone places them.
    pub fn twists(&self) -> Option<Vec<f64>> {
        let mode = |half: &Half| Some((half.a.middle() * half.d.middle(), half.turns_back()?));
        let mut twists = between_signs(self.less.iter().map(mode).collect::<Option<_>>()?)?;
        twists.retain(|s| (0.0..1.0).contains(s));
        (twists.len() <= MOST_TWISTS).then_some(twists)
    }
}

/// Twists between modes of both of Krein's signs, as the values s of modes place them: these alternate more
/// often in no molecule seen.
const MOST_BETWEEN: usize = 64;

/// Values of s between modes of one of Krein's signs and of the other, decreasing; `None` where signs change
/// too often.
pub(super) fn between_signs(mut modes: Vec<(f64, bool)>) -> Option<Vec<f64>> {
    modes.sort_by(|x, y| y.0.total_cmp(&x.0));
    let changes = modes.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    let twists: Vec<f64> = changes.map(|pair| pair[0].0 / 2.0 + pair[1].0 / 2.0).collect();
    (twists.len() <= MOST_BETWEEN).then_some(twists)
}

impl Kernel {
    fn counts(&self, outer: &Outer, epsilon: f64) -> Option<Counts> {
        let shifted = self.shifted(outer, epsilon);
        let slow = shifted.slow.as_ref() * faer::Scale(outer.half_kick());
        Counts::new([shifted.less, shifted.more], [slow.clone(), slow], shifted.slow_slack)
    }

    /// Whether all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, are proven by counts to have a real
    /// multiplier off the circle.
    pub fn has_real_unstable_mode(&self, outer: &Outer, epsilon: f64) -> bool {
        self.counts(outer, epsilon).is_some_and(|counts| counts.prove_instability())
    }

    /// Whether all these are proven stable by the index of the twisted period.
    pub fn is_stable_by_index(&self, outer: &Outer, epsilon: f64) -> bool {
        let counts = self.counts(outer, epsilon);
        counts.is_some_and(|counts| counts.twists().is_some_and(|twists| counts.prove_stability(&twists)))
    }

    /// Whether all these are proven stable, in the first region or by the index.
    pub fn is_stable(&self, outer: &Outer, epsilon: f64) -> bool {
        self.is_in_first_region(outer, epsilon) || self.is_stable_by_index(outer, epsilon)
    }
}
