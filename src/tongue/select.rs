//! Which tongues: by label, by family, by a window of s. Only these are computed.
//!
//! ```
//! use kickdrift::number::rational::ratio;
//! use kickdrift::tongue::{Selection, Tongues};
//! let mut tongues = Tongues::new("70/31".parse().unwrap(), &ratio(1, 25)).unwrap();
//! let window = Selection { s: Some((2.30, 2.32)), ..Selection::default() };
//! let found: Vec<u64> = tongues.select(&window).unwrap().iter().map(|gap| gap.m).collect();
//! assert_eq!(found, [39]);
//! assert!(tongues.effort().doubles < 20); // of 99 tongues
//! ```

use super::gaps::Tongues;
use super::lanes::LANES;
use super::order::Gap;
use super::row::ExactEdge;
use crate::error::{Error, Result};
use crate::number::{Ratio, Rational, rational};
use crate::resonance::dominant_family;

/// Conditions that all must hold; what is `None` is no condition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Closed ranges of the label.
    pub m: Option<Vec<(u64, u64)>>,
    /// Closed ranges of the dominant family's a and b.
    pub a: Option<(i64, i64)>,
    pub b: Option<(i64, i64)>,
    /// A closed window of s, its ends rounded outward: tongues whose enclosure meets it.
    pub s: Option<(f64, f64)>,
}

/// Where at least one in so many tongues of a range is wanted, all of it is computed side by side.
const DENSE: u64 = 3;

/// The window is widened by this for the counts, whose own uncertainty is below 1e-8 for all strings that are laid out.
const SLACK: f64 = 1e-6;

impl Tongues {
    /// The tongues selected, in order of m.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn select(&mut self, selection: &Selection) -> Result<Vec<Gap>> {
        let labels = self.labels(selection);
        let mut gaps = Vec::with_capacity(labels.len());
        for (from, upto) in runs(&labels) {
            let run = self.gaps(from, upto)?;
            gaps.extend(run.into_iter().filter(|gap| labels.binary_search(&gap.m).is_ok()));
        }
        if let Some((lo, hi)) = selection.s {
            gaps.retain(|gap| gap.lower.lo <= hi && gap.upper.is_none_or(|upper| lo <= upper.hi));
        }
        Ok(gaps)
    }

    /// That the labels asked for exist.
    ///
    /// # Errors
    /// A label beyond the last tongue.
    pub fn check_labels(&self, selection: &Selection) -> Result<()> {
        let ranges = selection.m.iter().flatten();
        match ranges.flat_map(|&(from, upto)| [from, upto]).find(|m| !(1..=self.last()).contains(m)) {
            None => Ok(()),
            Some(m) => {
                let remedy = format!("{} has the tongues 1 to {}", self.ratio(), self.last());
                Err(Error::input("m", m, remedy))
            }
        }
    }

    /// The labels selected, as far as they are known before the edges, in order.
    fn labels(&self, selection: &Selection) -> Vec<u64> {
        let (first, last) = selection.s.map_or((1, self.last()), |window| self.labels_within(window));
        let within = |range: Option<(i64, i64)>, x: i64| range.is_none_or(|(lo, hi)| lo <= x && x <= hi);
        let wanted = |m: u64| {
            let listed = selection.m.as_ref().is_none_or(|list| list.iter().any(|&(a, b)| a <= m && m <= b));
            let any = selection.a.is_none() && selection.b.is_none();
            listed
                && (any || {
                    let (a, b) = dominant_family(self.ratio(), m);
                    within(selection.a, a) && within(selection.b, b)
                })
        };
        (first..=last).filter(|&m| wanted(m)).collect()
    }

    /// A range of labels that holds all tongues which meet the window: an edge with an index not above the count at
    /// its lower end lies below it, one with an index above the count at its upper end lies beyond.
    fn labels_within(&self, (lo, hi): (f64, f64)) -> (u64, u64) {
        if hi < lo || hi <= 0.0 {
            return (1, 0);
        }
        let string = self.string();
        let counts = |s: f64| {
            // The counts neither underflow nor overflow within these.
            let kappa = (s / string.ticks).min(4.0 * string.upper_bound);
            string.counts(&[kappa; LANES]).map(|counts| if kappa < 1e-100 { 0 } else { counts[0] as u64 })
        };
        let ([a, b, c, d], [e, f, g, h]) = (counts(lo * (1.0 - SLACK)), counts(hi * (1.0 + SLACK)));
        let first = (2 * b.min(c) + 2).min(2 * a.min(d) + 1);
        let last = (2 * f.max(g)).max((2 * e.max(h)).saturating_sub(1));
        (first, last.min(self.last()))
    }
}

/// Ranges that hold all labels and not many others.
fn runs(labels: &[u64]) -> Vec<(u64, u64)> {
    let mut runs: Vec<(u64, u64)> = Vec::new();
    for &m in labels {
        match runs.last_mut().filter(|run| m - run.1 <= DENSE) {
            Some(run) => run.1 = m,
            None => runs.push((m, m)),
        }
    }
    runs
}

/// A clock whose own resonance an edge sits on exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Resonance {
    /// p θ = m π: the paper's eq. (9), q h2 = m T½.
    Fast,
    /// q θ' = m π, θ' the slow clock's angle: the same with the clocks exchanged.
    Slow,
}

impl Resonance {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Resonance::Fast => "p theta = m pi",
            Resonance::Slow => "q theta' = m pi",
        }
    }

    /// The resonance on which an edge in closed form sits, if any; a rational edge does where its angle is
    /// π/3, π/2 or 2π/3.
    pub fn of(ratio: Ratio, m: u64, rho: &Rational, edge: &ExactEdge) -> Option<Resonance> {
        match edge {
            ExactEdge::Resonance => Some(Resonance::Fast),
            ExactEdge::SlowResonance => Some(Resonance::Slow),
            ExactEdge::Rational(s) => {
                let steps = Rational::from(ratio);
                let slow = s * rho * &steps * &steps;
                if turns(s, m, ratio.p()) {
                    Some(Resonance::Fast)
                } else {
                    turns(&slow, m, ratio.q()).then_some(Resonance::Slow)
                }
            }
        }
    }
}

/// Whether s = 4 sin²(m π/(2p)), m < p, for a rational s: by Niven's theorem only 1, 2 and 3 can be.
fn turns(s: &Rational, m: u64, p: u64) -> bool {
    [(1, 3, 1), (2, 2, 1), (3, 3, 2)]
        .into_iter()
        .any(|(value, whole, part)| *s == rational::ratio(value, 1) && whole * m == part * p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::rational::ratio;

    #[test]
    fn runs_hold_every_label() {
        assert_eq!(runs(&[2, 3, 6, 7, 20]), [(2, 7), (20, 20)]);
        assert_eq!(runs(&[]), []);
    }

    #[test]
    fn windows_hold_what_all_tongues_show() {
        for (p, q, rho) in
            [(7, 3, ratio(1, 25)), (3, 11, ratio(2, 1)), (40, 1, ratio(1, 2)), (9, 4, ratio(0, 1))]
        {
            let all = Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap().all().unwrap();
            for (lo, hi) in [(0.0, 1e300), (1.0, 1.5), (2.4, 2.4), (3.9, 400.0), (-1.0, 1e-9), (2.0, 1.0)] {
                let meets = |gap: &&Gap| gap.lower.lo <= hi && gap.upper.is_none_or(|upper| lo <= upper.hi);
                let expected: Vec<u64> =
                    all.iter().filter(meets).map(|gap| gap.m).filter(|_| lo <= hi).collect();
                let selection = Selection { s: Some((lo, hi)), ..Selection::default() };
                let found =
                    Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap().select(&selection).unwrap();
                assert_eq!(
                    found.iter().map(|gap| gap.m).collect::<Vec<_>>(),
                    expected,
                    "{p}/{q}: {lo}..{hi}"
                );
            }
        }
    }

    #[test]
    fn a_family_is_that_of_the_labels() {
        let mut tongues = Tongues::new("31/12".parse().unwrap(), &ratio(1, 25)).unwrap();
        let selection = Selection { a: Some((1, 2)), b: Some((-9, -1)), ..Selection::default() };
        let found = tongues.select(&selection).unwrap();
        let expected: Vec<u64> = (1..=tongues.last())
            .filter(|&m| matches!(dominant_family("31/12".parse().unwrap(), m), (1..=2, -9..=-1)))
            .collect();
        assert!(!expected.is_empty());
        assert_eq!(found.iter().map(|gap| gap.m).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn rational_angles_are_resonances() {
        let on = |p, q, m, s| {
            Resonance::of(Ratio::new(p, q).unwrap(), m, &ratio(1, 4), &ExactEdge::Rational(ratio(s, 1)))
        };
        assert_eq!([on(3, 1, 1, 1), on(4, 1, 2, 2), on(9, 2, 6, 3)], [Some(Resonance::Fast); 3]);
        assert_eq!(on(3, 1, 2, 1), None);
        // s rho (p/q)² = 36/4/9 = 1 and q = 3, m = 1: the slow clock's own.
        assert_eq!(on(1, 3, 1, 36), Some(Resonance::Slow));
    }
}
