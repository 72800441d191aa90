//! The action as one matrix, and what its signs and counts prove.

use super::levels::{ROUNDINGS, Steps};
use crate::signs::envelope::{Envelope, Sign};
use number::parallel::both;

/// Stiffnesses that bound others: factor (K + shift I) of each level.
pub(super) type Bounds = Vec<[f64; 2]>;

impl Steps<'_> {
    /// The action of half a period, its positions held at 0 at these ends.
    fn action(&self, step: f64, bounds: &Bounds, [at_start, at_end]: [bool; 2]) -> Envelope {
        let free = usize::from(at_start)..self.events.len() - usize::from(at_end);
        self.chain(step, bounds, &free.map(|node| (node, 1.0)).collect::<Vec<_>>())
    }

    /// The action of a whole period between ends with x(T) = e^(iφ) x(0), s = cos² φ/2, as a real chain
    /// (`proofs/REGION.md`, section 10): from t = 0 to T/2, what meets there times √s, and back to where 0 is
    /// held, what meets times √(1 − s).
    fn twisted(&self, step: f64, bounds: &Bounds, s: f64) -> Envelope {
        let last = self.events.len() - 1;
        let there = (0..=last).map(|node| (node, if node == last { s.sqrt() } else { 1.0 }));
        let back = (1..last).rev().map(|node| (node, if node + 1 == last { (1.0 - s).sqrt() } else { 1.0 }));
        self.chain(step, bounds, &there.chain(back).collect::<Vec<_>>())
    }

    /// Nodes in a row, each with the factor of what it has to do with the one before.
    fn chain(&self, step: f64, bounds: &Bounds, path: &[(usize, f64)]) -> Envelope {
        let (n, square) = (self.nested.size(), self.square(step));
        let row = |place: usize, i: usize| place * n + i;
        // A block reaches back to the same degree of freedom at the node before.
        let rows = (0..path.len()).flat_map(|place| (0..n).map(move |i| (place, i)));
        let first = rows.map(|(place, i)| if place == 0 { 0 } else { row(place - 1, i) }).collect();
        let mut matrix = Envelope::new(first);
        for (place, &(node, factor)) in path.iter().enumerate() {
            let event = &self.events[node];
            let before = (node > 0).then(|| 1.0 / event.drift as f64);
            let after = self.events.get(node + 1).map(|next| 1.0 / next.drift as f64);
            let link = place.checked_sub(1).map(|k| if path[k].0 < node { before } else { after });
            for i in 0..n {
                before.iter().chain(&after).for_each(|x| matrix.add(row(place, i), row(place, i), *x));
                if let Some(x) = link.flatten() {
                    matrix.add(row(place, i), row(place - 1, i), -factor * x);
                }
            }
            let weight = event.weight.share();
            for k in event.clocks() {
                let [factor, shift] = bounds[k];
                let factor = -(weight * (square * self.kicks[k])) * factor;
                let stiffness = &self.nested.levels[k].stiffness;
                for j in 0..n {
                    for i in j..n {
                        let value = stiffness[(i, j)] + if i == j { shift } else { 0.0 };
                        matrix.add(row(place, i), row(place, j), factor * value);
                    }
                }
            }
        }
        matrix
    }

    /// K_k + sign e_k, all stiffnesses within ε of their sizes.
    pub(super) fn within(&self, epsilon: f64, sign: f64) -> Bounds {
        (0..self.kicks.len()).map(|k| [1.0, sign * self.nested.error_within(k, epsilon)]).collect()
    }

    pub(super) fn is_positive(&self, step: f64, bounds: &Bounds) -> bool {
        let is = |held: [bool; 2]| self.is_positive_held(step, bounds, held);
        let (start, end) = both(true, || is([true, false]), || is([false, true]));
        start && end
    }

    fn is_positive_held(&self, step: f64, bounds: &Bounds, held: [bool; 2]) -> bool {
        self.action(step, bounds, held).is_positive_in_blocks(self.nested.size(), self.terms(), ROUNDINGS)
    }

    /// Whether the signs prove all stiffnesses within ε unstable at all outer steps between.
    pub(super) fn is_unstable_between(&self, [lo, hi]: [f64; 2], epsilon: f64) -> bool {
        let [softer, stiffer] = self.softer_and_stiffer(epsilon);
        let ends = [[true, false], [false, true]];
        let Some(k) = (0..2).find(|&k| self.is_positive_held(hi, &stiffer, ends[k])) else { return false };
        let other = self.action(lo, &softer, ends[1 - k]);
        other.sign(self.terms(), ROUNDINGS) == Some(Sign::Negative)
    }

    /// Whether counts of negative eigenvalues, least at the smaller step and most at the larger one, prove a
    /// real multiplier off the circle at all outer steps between: neg J_fh and neg J_hf differ, or n + neg
    /// J_hh and neg J_ff (`proofs/REGION.md`, section 3).
    pub(super) fn has_real_unstable_mode(&self, [lo, hi]: [f64; 2], epsilon: f64) -> bool {
        let [softer, stiffer] = self.softer_and_stiffer(epsilon);
        let exceeds = |low: [bool; 2], high: [bool; 2], [more, other]: [usize; 2]| {
            let least = || self.negatives(&self.action(lo, &softer, low), true);
            let (least, most) = both(true, least, || self.negatives(&self.action(hi, &stiffer, high), false));
            least.zip(most).is_some_and(|(least, most)| least + more > most + other)
        };
        let (start, end, n) = ([true, false], [false, true], self.nested.size());
        let (neither, all) = ([false; 2], [true; 2]);
        exceeds(end, start, [0, 0])
            || exceeds(start, end, [0, 0])
            || self.nested.is_definite_within(epsilon)
                && (exceeds(neither, all, [0, n]) || exceeds(all, neither, [n, 0]))
    }

    fn softer_and_stiffer(&self, epsilon: f64) -> [Bounds; 2] {
        [-1.0, 1.0].map(|sign| self.within(epsilon, sign))
    }

    fn negatives(&self, action: &Envelope, is_least: bool) -> Option<usize> {
        action.negatives(self.terms(), ROUNDINGS, is_least)
    }

    /// Whether the index proves all stiffnesses within ε stable at all outer steps between: the counts are
    /// one for all of them, held at both ends, at one, and twisted by each of 1 = s_0 > s_1 > ... > s_K = 0,
    /// and the last ones change by n in all.
    pub(super) fn is_stable_by_index(&self, [lo, hi]: [f64; 2], epsilon: f64) -> bool {
        let Some(twists) = self.twists(lo / 2.0 + hi / 2.0) else { return false };
        let [softer, stiffer] = self.softer_and_stiffer(epsilon);
        let one = |of: &(dyn Fn(f64, &Bounds) -> Envelope + Sync)| {
            let least = || self.negatives(&of(lo, &softer), true);
            let (least, most) = both(true, least, || self.negatives(&of(hi, &stiffer), false));
            least.filter(|least| Some(*least) == most)
        };
        let held =
            |held: [bool; 2]| one(&move |step, bounds: &Bounds| self.action(step, bounds, held)).is_some();
        if !held([true, true]) || !held([true, false]) {
            return false;
        }
        let at = [1.0].into_iter().chain(twists).chain([0.0]);
        let counts: Option<Vec<usize>> =
            at.map(|s| one(&move |step, bounds: &Bounds| self.twisted(step, bounds, s))).collect();
        let change =
            |indexes: Vec<usize>| indexes.windows(2).map(|pair| pair[0].abs_diff(pair[1])).sum::<usize>();
        counts.map(change) == Some(self.nested.size())
    }
}
