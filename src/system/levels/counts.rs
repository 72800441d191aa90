//! Verdicts by counting negative eigenvalues, wherever the step lies: no eigenvector, no gap between eigenvalues is asked for.
//!
//! With neg J the number of negative eigenvalues of the action under each pair of ends, and i(s) that of the period whose ends
//! are twisted by e^(iφ), 2 cos φ = 4 s − 2 (`proofs/REGION.md`, section 3):
//!
//! ```text
//!     #{μ < −1} ≥ |neg J_fh − neg J_hf|,        #{μ > 0} ≥ |n + neg J_hh − neg J_ff|,
//!     stable where Σ |i(s_(k+1)) − i(s_k)| = n for some 1 = s_0 > s_1 > ... > s_K = 0.
//! ```
//!
//! Each count grows with the kicks, so those at F ± e₁ I, S ± e₂ I bound those of all stiffnesses between.

use super::half::Half;
use super::interval::Interval;
use super::kernel::{Kernel, Outer};
use super::region::Shifted;
use crate::system::inertia::proven;

/// Twists of an index: more of them cost more than discs about the eigenvalues.
const MOST_TWISTS: usize = 6;

/// What all stiffnesses within ε have in common: neg J_hh and neg J_hf, which fall apart into modes.
struct Counts<'a> {
    kernel: &'a Kernel,
    outer: &'a Outer,
    shifted: Shifted,
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

impl Counts<'_> {
    /// Eigenvalues of diag(twisted) − M that are negative for all stiffnesses.
    fn least(&self, s: f64) -> usize {
        let diagonal: Vec<f64> = self.shifted.less.iter().map(|half| twisted(half, s).hi).collect();
        proven(&self.kernel.with_slow(self.outer, -1.0, &diagonal), self.shifted.slow_slack).negative
    }

    /// Those that are negative or 0 for some.
    fn most(&self, s: f64) -> usize {
        let diagonal: Vec<f64> = self.shifted.more.iter().map(|half| twisted(half, s).lo).collect();
        let form = self.kernel.with_slow(self.outer, -1.0, &diagonal);
        self.kernel.size() - proven(&form, self.shifted.slow_slack).positive
    }

    /// The number of both where it is one.
    fn exact(&self, s: f64) -> Option<usize> {
        let least = self.least(s);
        (self.most(s) == least).then_some(least)
    }

    /// Values of s between modes p θ/2 of which turned back and others; cos²(p θ/2) alone places them.
    fn twists(&self) -> Option<Vec<f64>> {
        let mode = |half: &Half| Some((half.a.mid() * half.d.mid(), half.turns_back()?));
        let mut modes: Vec<(f64, bool)> = self.shifted.less.iter().map(mode).collect::<Option<_>>()?;
        modes.sort_by(|x, y| y.0.total_cmp(&x.0));
        let changes = modes.windows(2).filter(|pair| pair[0].1 != pair[1].1);
        let twists = changes.map(|pair| pair[0].0 / 2.0 + pair[1].0 / 2.0).filter(|s| (0.0..1.0).contains(s));
        let twists: Vec<f64> = [1.0].into_iter().chain(twists).chain([0.0]).collect();
        (twists.len() <= MOST_TWISTS + 2).then_some(twists)
    }
}

impl Kernel {
    fn counts<'a>(&'a self, outer: &'a Outer, epsilon: f64) -> Option<Counts<'a>> {
        let shifted = self.shifted(outer, epsilon);
        let (hh, hf) = held(&shifted.less).filter(|counts| held(&shifted.more) == Some(*counts))?;
        Some(Counts { kernel: self, outer, shifted, hh, hf })
    }

    /// Whether all F + E₁, S + E₂, ‖E₁‖₂ ≤ ε ‖F‖₂, ‖E₂‖₂ ≤ ε ‖S‖₂, are proven by counts to have a real multiplier off the circle.
    pub fn has_real_unstable_mode(&self, outer: &Outer, epsilon: f64) -> bool {
        // J_fh is J_hh and a/b − M, J_ff is J_hf and c/d − M.
        self.counts(outer, epsilon).is_some_and(|own| {
            let (hh, hf, m) = (own.hh, own.hf, self.size());
            hh + own.least(0.0) > hf
                || hh + own.most(0.0) < hf
                || hf + own.least(1.0) > m + hh
                || hf + own.most(1.0) < m + hh
        })
    }

    /// Whether all these are proven stable by the index of the twisted period.
    pub fn is_stable_by_index(&self, outer: &Outer, epsilon: f64) -> bool {
        let index = |own: Counts| {
            let counts: Vec<usize> =
                own.twists()?.into_iter().map(|s| own.exact(s)).collect::<Option<_>>()?;
            Some(counts.windows(2).map(|pair| pair[0].abs_diff(pair[1])).sum::<usize>())
        };
        self.counts(outer, epsilon).and_then(index) == Some(self.size())
    }

    /// Whether all these are proven stable, in the first region or by the index.
    pub fn is_stable(&self, outer: &Outer, epsilon: f64) -> bool {
        self.is_in_first_region(outer, epsilon) || self.is_stable_by_index(outer, epsilon)
    }
}
