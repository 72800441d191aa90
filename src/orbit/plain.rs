//! Kick by kick in doubles, with the same theorem: for pairs that have no Floquet coordinates, because both clocks
//! are beyond their own Verlet limits or pull the wrong way.
//!
//! State (x, y), y = w v with w a power of two that makes kicks and drifts about equally strong: x ← x + a y,
//! y ← y − b x, shears of norm κ(a) = |a|/2 + √(1 + a²/4) ≥ √(1 + a²). a and b are known to 2u (a quotient rounded once;
//! a strength next to the middle of a tight ball), u = 2^-53, and a fused shear rounds once, so
//!
//! ```text
//!     |r| ≤ u |x'| + 2u |a| |y| (1 + u) ≤ 3.1 u κ |(x, y)|,        ε = 3.1 u κ,
//! ```
//!
//! and the theorem of [`super::bound`] applies with the angle 2b/|û|² kept along the way as in [`super::refine`]. The
//! same doubles on every machine: each operation is rounded as IEEE 754 says.

use super::bound::StepBound;
use super::floquet::ordinary;
use crate::number::{Ball, Real, Sign, U};
use crate::propagator::{PartialSigns, TwoClocks};
use crate::schedule::{KickDrift, Kicks, Schedule};

/// Bits of the strengths.
const BITS: u32 = 128;

/// The squared length is kept between the reciprocal of this and this.
const LONGEST: f64 = 1e180;

/// A power of two whose square brings a length from beyond [`LONGEST`] back.
const SHRINK: f64 = 1.0 / (1u128 << 127) as f64;

/// The signs of A, B, C, D as far as doubles decide them; `None` where the theorem's conditions cannot be met, or a strength
/// is no comfortable double.
pub fn signs<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<PartialSigns> {
    let steps = Steps::new(clocks, schedule)?;
    let end = |x: f64, y: f64| {
        let mut orbit = Orbit { steps: &steps, x, y, square: x * x + y * y, angle: 0.0, worst: 0.0 };
        steps.kicks.lead(schedule.half_period(), &mut orbit);
        orbit.signs()
    };
    let ((a, c), (b, d)) = (end(1.0, 0.0)?, end(0.0, 1.0)?);
    Some(PartialSigns { a, b, c, d })
}

/// The shears of all events, and the constants of the bound.
struct Steps {
    /// The b of all kicks; half of one is exact.
    kicks: Kicks<f64>,
    /// Ticks in h1 times w: a = drift/`ticks`.
    ticks: f64,
    /// 2|r_k|/|û_k|.
    local: f64,
    /// The largest angle that the theorem allows.
    tau: f64,
}

impl Steps {
    fn new<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<Self> {
        let [fast, slow, both] = clocks.enclosures(BITS).each_ref().map(strength);
        let strengths = [fast?, slow?, both?];
        let strongest = strengths.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
        // w = 2^-k with 4^k next to the strongest kick: drifts are at most 1, kicks at most `strongest`.
        let w = 2f64.powi(-((strongest.max(1.0).log2() / 2.0).round() as i32));
        let largest = (1.0 / w).max(strongest * w);
        let kappa = 1.01 * (largest / 2.0 + (1.0 + largest * largest / 4.0).sqrt());
        let bound = StepBound { kappa, epsilon: 3.1 * U * kappa };
        // A drift and a kick at each event, and the end.
        let tau = bound.tau(2 * (schedule.strikes() + 2))?;
        // Whole numbers below 2^53 are doubles; drifts are no longer than a step.
        let exact = schedule.clocks().iter().all(|clock| clock.step() < 1 << 53);
        let ticks = schedule.clocks()[0].step() as f64 * w;
        let local = 2.02 * bound.epsilon * bound.growth();
        let kicks = Kicks::of_two_clocks(strengths, |k| [k * w, 0.5 * (k * w)]);
        exact.then_some(Steps { kicks, ticks, local, tau })
    }
}

/// The strength as a double within 2u, or exactly 0.
fn strength(k: &Ball) -> Option<f64> {
    if k.sign() == Some(Sign::Zero) { Some(0.0) } else { ordinary(k) }
}

/// One solution on its way.
struct Orbit<'a> {
    steps: &'a Steps,
    x: f64,
    y: f64,
    /// |û|².
    square: f64,
    /// 2b/|û|², and its largest value so far.
    angle: f64,
    worst: f64,
}

impl Orbit<'_> {
    /// After a shear: what it added across the orbit, and the orbit's growth.
    fn account(&mut self) {
        let before = std::mem::replace(&mut self.square, self.x * self.x + self.y * self.y);
        // 1 + 2^-40 covers the roundings of this line and of the squares.
        self.angle = self.angle * (before / self.square) * (1.0 + 2f64.powi(-40)) + self.steps.local;
        self.worst = self.worst.max(self.angle);
    }

    /// Keeps the squared length in range.
    fn rescale(&mut self) {
        if !(1.0 / LONGEST..=LONGEST).contains(&self.square) {
            // Powers of two: exact.
            let by = if self.square > 1.0 { SHRINK } else { 1.0 / SHRINK };
            (self.x, self.y) = (self.x * by, self.y * by);
            self.square = self.x * self.x + self.y * self.y;
        }
    }

    /// The signs of x and y where the angle leaves them certain; `None` where a condition failed. (NaN fails.)
    fn signs(mut self) -> Option<(Option<Sign>, Option<Sign>)> {
        // The last event may be a drift alone.
        self.rescale();
        let slack = 1.001 * self.angle * self.square.sqrt();
        let certain = |z: f64| (z.abs() > slack).then(|| Sign::from_ordering(z.total_cmp(&0.0)));
        (self.worst <= self.steps.tau && self.square.is_finite()).then(|| (certain(self.x), certain(self.y)))
    }
}

impl KickDrift<f64> for Orbit<'_> {
    fn drift(&mut self, ticks: u64) {
        self.x = (ticks as f64 / self.steps.ticks).mul_add(self.y, self.x);
        self.account();
    }

    fn kick(&mut self, b: &f64) {
        self.y = (-b).mul_add(self.x, self.y);
        self.account();
        self.rescale();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Ratio;
    use crate::number::Rational;
    use crate::number::rational::ratio;
    use crate::orbit::refine;
    use crate::propagator::half_period;
    use num_integer::Integer;
    use proptest::prelude::*;

    fn signs_of(clocks: &TwoClocks<Rational>) -> Option<PartialSigns> {
        signs(clocks, &Schedule::two_clocks(clocks.ratio()).unwrap())
    }

    proptest! {
        #[test]
        fn certain_signs_are_the_exact_ones(
            p in 1u64..50, q in 1u64..50, s in -9000i64..9000, k in -9000i64..9000,
        ) {
            let (p, q) = (p / p.gcd(&q), q / p.gcd(&q));
            let clocks = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 1000), ratio(k, 1000));
            if let Some(verdict) = signs_of(&clocks).and_then(|signs| signs.verdict()) {
                prop_assert_eq!(verdict, half_period(&clocks).signs().verdict());
            }
        }

        #[test]
        fn two_clocks_beyond_their_limits_are_told(p in 1u64..50, q in 1u64..50, s in 4100i64..20000, k in 4100i64..20000) {
            let (p, q) = (p / p.gcd(&q), q / p.gcd(&q));
            // Beyond both limits: s > 4, and the slow clock's own strength k p/q > 4.
            let clocks = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 1000), ratio(k, 1000) * ratio(q as i64, p as i64));
            prop_assert!(signs_of(&clocks).is_some_and(|signs| signs.verdict().is_some()));
        }
    }

    /// Growth far beyond the range of doubles, and decay of the other solution's share.
    #[test]
    fn long_orbits_stay_in_range() {
        for (p, q) in [(101, 100), (4001, 4000), (1, 3000)] {
            let clocks = TwoClocks::new(
                Ratio::new(p, q).unwrap(),
                ratio(9, 1),
                ratio(9, 1) * ratio(q as i64, p as i64),
            );
            let verdict = signs_of(&clocks).and_then(|signs| signs.verdict());
            let schedule = Schedule::two_clocks(clocks.ratio()).unwrap();
            let certain = refine::run(&clocks, &schedule, 256).and_then(|ends| ends.signs().verdict());
            assert!(verdict.is_some());
            assert_eq!(verdict, certain, "{p}/{q}");
        }
    }
}
