//! Bounds on steps beside linear theory: where published resonances of anharmonic motion begin.
//!
//! A clock's own step is kept below T/6.28 of the fastest motion on it, h w ≤ 1 ([`OF_ONE`](super::OF_ONE));
//! of the innermost ones that is lifted where their bonds are said to be harmonic. The force of the outermost
//! of several clocks is followed by Verlet's rule whatever moves the others, so its step has that bound for
//! every method. The outermost of several steps of kicks and drifts also stays below T/3 of the fastest other
//! motion.

use num_traits::One;

use super::caution::{HEEDED, Place};
use super::levels::{Scheme, longest_below};
use number::{Rational, from_f64_exact, named};

named! {
    /// The kind of bound on a step.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Bound {
        /// All periods of the band are proven stable below it.
        Band = "band",
        /// A third of the fastest period: published of kicks and drifts.
        Third = "T/3",
        /// h w ≤ 1 of the fastest motion on an inner clock, or on the only one: beyond it bonds that are not
        /// harmonic are lost.
        Turn = "T/6.28",
        /// The same of the slow force, which every method here follows by Verlet's rule.
        SlowTurn = "slow T/6.28",
        /// The step at which a bond of a known shape is too hot, with all periods of the band: measured.
        Aperture = "aperture",
        /// The friction given masks what grows for the periods given; nothing is proven of the band.
        Friction = "friction, no band",
    }
}

/// The bounds for one number of clocks, in fs, each rounded down.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Caps {
    /// T/3 of the fastest motion on any clock but the outermost; of several clocks.
    third: Option<Rational>,
    /// T/6.28 of the fastest motion on each clock; `None` where none is known, or where it is lifted.
    turns: Vec<Option<Rational>>,
    /// Which of these were measured of bonds of a known shape.
    measured: Vec<bool>,
}

impl Caps {
    /// From the shortest period on each clock in fs, rounded down, `None` where none is known; bonds harmonic
    /// or not.
    pub fn new(periods: &[Option<f64>], harmonic: bool) -> Caps {
        let last = periods.len().saturating_sub(1);
        let finite = |x: f64| from_f64_exact(x).filter(|_| x > 0.0);
        // The quotient, rounded down.
        let part = |period: f64, place: Place| finite((period / place.parts()).next_down().next_down());
        let turn = |(k, period): (usize, &Option<f64>)| {
            let is_slow = last > 0 && k == last;
            period.filter(|_| is_slow || !harmonic).and_then(|period| part(period, Place::Turn(HEEDED)))
        };
        let fastest = periods[..last].iter().flatten().copied().reduce(f64::min);
        // Where nothing is known of the others, of the outermost one.
        let fastest = fastest.or(periods.last().copied().flatten().filter(|_| last > 0));
        Caps {
            third: fastest.and_then(|period| part(period, Place::Part(3))),
            turns: periods.iter().enumerate().map(turn).collect(),
            measured: vec![false; periods.len()],
        }
    }

    /// In place of T/6.28 of bonds whose shape is known the steps that were measured, in fs; `others` are the
    /// bounds of the other motions. The step of the slow force stays as it is.
    #[must_use]
    pub(super) fn with_measured(mut self, others: &Caps, cold: &[Option<f64>]) -> Caps {
        let last = self.turns.len().saturating_sub(1);
        for (k, cold) in cold.iter().enumerate().filter(|(k, _)| last == 0 || *k < last) {
            let (turn, cold) =
                (others.turns[k].clone(), cold.and_then(|cold| from_f64_exact(cold.next_down())));
            self.measured[k] = cold.as_ref().is_some_and(|cold| turn.as_ref().is_none_or(|turn| cold < turn));
            self.turns[k] = cold.into_iter().chain(turn).min();
        }
        self
    }

    /// The kind of bound on a clock's own step.
    pub fn bound(&self, clock: usize) -> Bound {
        let is_slow = clock > 0 && clock + 1 == self.turns.len();
        match self.measured.get(clock) {
            Some(true) => Bound::Aperture,
            _ if is_slow => Bound::SlowTurn,
            _ => Bound::Turn,
        }
    }

    /// The bound on the outermost step; `None` where there is none.
    pub fn outer(&self) -> Option<(&Rational, Bound)> {
        let last = self.turns.len().checked_sub(1)?;
        let turn = self.turns[last].as_ref().map(|turn| (turn, self.bound(last)));
        let third = self.third.as_ref().map(|third| (third, Bound::Third));
        third.into_iter().chain(turn).min_by(|a, b| a.0.cmp(b.0))
    }

    /// The bound on the step of the slowest force alone.
    pub fn slow(&self) -> Option<&Rational> {
        self.turns.last()?.as_ref()
    }

    /// The bound on the innermost step.
    pub fn inner(&self) -> Option<&Rational> {
        self.turns.first()?.as_ref()
    }

    /// A clock but the outermost whose step is not below its bound, and that bound.
    pub fn too_long(&self, scheme: &Scheme) -> Option<(usize, &Rational)> {
        let last = self.turns.len().saturating_sub(1);
        let inner = self.turns[..last].iter().zip(scheme.steps()).enumerate();
        inner
            .filter_map(|(k, (cap, step))| Some((k, cap.as_ref()?, step)))
            .find_map(|(k, cap, step)| (step >= cap).then_some((k, cap)))
    }

    /// Whether all steps of a scheme are below their bounds.
    pub fn hold(&self, scheme: &Scheme) -> bool {
        self.too_long(scheme).is_none() && self.outer().is_none_or(|(cap, _)| scheme.outer() < cap)
    }

    /// The longest multiple of the step before the outermost one up to `largest` and below the bounds; of one
    /// step their least.
    pub fn safe(&self, scheme: &Scheme, largest: Option<&Rational>) -> Option<(Rational, Bound)> {
        let largest = largest.filter(|_| self.too_long(scheme).is_none())?;
        let Some((cap, bound)) = self.outer() else { return Some((largest.clone(), Bound::Band)) };
        let step = longest_below(scheme, largest, cap)?;
        Some(if step == *largest { (step, Bound::Band) } else { (step, bound) })
    }

    /// The bound on the outermost step where all steps keep the ratios of a scheme.
    pub fn at_ratio(&self, scheme: &Scheme) -> Option<(Rational, Bound)> {
        let last = self.turns.len().saturating_sub(1);
        let scaled = |(k, (cap, step)): (usize, (&Option<Rational>, &Rational))| {
            Some((cap.as_ref()? * scheme.outer() / step, self.bound(k)))
        };
        let inner = self.turns[..last].iter().zip(scheme.steps()).enumerate().filter_map(scaled);
        inner.chain(self.outer().map(|(cap, bound)| (cap.clone(), bound))).min_by(|a, b| a.0.cmp(&b.0))
    }

    /// The longest step up to `inner`, and below the bound on the innermost one, of which `step` is a
    /// multiple.
    pub fn part_of(&self, step: &Option<(Rational, Bound)>, inner: &Rational) -> Option<Rational> {
        let (step, _) = step.as_ref()?;
        let count = (step / inner).ceil();
        let below = self.inner().map(|cap| (step / cap).floor() + Rational::one());
        Some(step / below.map_or(count.clone(), |below| below.max(count)))
    }
}

/// 2 π steps: the shortest period whose own step that may be.
pub fn shortest_of(step: f64) -> f64 {
    step * Place::Turn(HEEDED).parts()
}
