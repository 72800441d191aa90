//! Kick by kick in doubles, with the same theorem: for pairs that have no Floquet coordinates, because both
//! clocks are beyond their own Verlet limits or pull the wrong way. And in two doubles a number, for growth
//! so weak that doubles cannot distinguish it from none.
//!
//! State (x, y), y = w v with w a power of two that makes kicks and drifts about equally strong: x ← x + a y,
//! y ← y − b x, shears of norm κ(a) = |a|/2 + √(1 + a²/4) ≥ √(1 + a²). With a and b known to 2u and a shear
//! that rounds by u |x'| (fused, u = 2^-53), or by u |(x, y)| κ/10 at most (two doubles, u = 2^-98),
//!
//! ```text
//!     |r| ≤ u |x'| + 2u |a| |y| (1 + u) ≤ 3.1 u κ |(x, y)|,        ε = 3.1 u κ,
//! ```
//!
//! and the theorem of [`super::bound`] applies with |r_k| |û_k| ≤ ε g |û_k|²: b_k = ε g Σ_{j≤k} |û_j|². The
//! sum has n terms and the theorem's condition allows far fewer than 2^40, so a hundredth more covers its
//! roundings. Both solutions run at once, and nothing that the next shear needs waits for the bound. The same
//! doubles on every machine: each operation is rounded as IEEE 754 says.
//!
//! Drifts turn (x, y) clockwise across x = 0 and kicks never cross it, so the sign changes of x are the half
//! turns.

use super::bound::StepBound;
use super::filter::{End, Ends};
use super::floquet::ordinary;
use crate::propagator::TwoClocks;
use crate::schedule::{KickDrift, Kicks, Schedule};
use number::vector::instructions::{Instructions, Task};
use number::{Ball, Real, Sign, Twofold, U, power_of_two};

/// Bits of the strengths.
const BITS: u32 = 128;

/// The squared length is kept between the reciprocal of this and this.
const LONGEST: f64 = 1e180;

/// A power of two whose square brings a length from beyond [`LONGEST`] back.
const SHRINK: i32 = 127;

/// The half period as far as doubles decide it; `None` where the theorem's conditions cannot be met, or a
/// strength is no comfortable double.
pub fn run<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<Ends> {
    run_in::<f64, S>(clocks, schedule)
}

/// Runs in two doubles a number, 2^45 times as sharp at some six times the cost.
pub fn sharp<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<Ends> {
    run_in::<Twofold, S>(clocks, schedule)
}

fn run_in<N: Number, S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<Ends> {
    let steps = Steps::<N>::new(clocks, schedule)?;
    let (even, odd, half_turns) = Instructions::best().perform_alone(Run(&steps, schedule));
    // After N half turns of x's sign the angle is within a quarter of N half turns, beyond it where x and v
    // differ in sign.
    let (x, y) = (even.x.near(), even.y.near());
    let quarters = 2 * half_turns - i64::from(x.is_sign_negative() == y.is_sign_negative());
    Some(Ends { even: even.end(&steps)?, odd: odd.end(&steps)?, quarters })
}

/// A number in which shears are computed.
trait Number: Copy {
    /// u: strengths and drifts are within 2u, a shear rounds as the head of this file says.
    const ROUNDING: f64;
    /// The relative error of the nearest double.
    const NEAREST_ERROR: f64;
    const ZERO: Self;
    const ONE: Self;
    /// A strength; `None` where it has too few bits or is no comfortable double.
    fn of(k: &Ball) -> Option<Self>;
    /// The quotient of whole numbers below 2^53.
    fn quotient(ticks: u64, unit: u64) -> Self;
    /// self + a y.
    fn sheared(self, a: Self, y: Self) -> Self;
    /// Exactly, by a power of two.
    fn scaled(self, by: f64) -> Self;
    fn near(self) -> f64;
}

impl Number for f64 {
    const ROUNDING: f64 = U;
    const NEAREST_ERROR: f64 = 0.0;
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;

    fn of(k: &Ball) -> Option<f64> {
        ordinary(k)
    }

    #[inline(always)]
    fn quotient(ticks: u64, unit: u64) -> f64 {
        ticks as f64 / unit as f64
    }

    #[inline(always)]
    fn sheared(self, a: f64, y: f64) -> f64 {
        a.mul_add(y, self)
    }

    #[inline(always)]
    fn scaled(self, by: f64) -> f64 {
        self * by
    }

    #[inline(always)]
    fn near(self) -> f64 {
        self
    }
}

impl Number for Twofold {
    /// A product is within 2^-101, a sum within 2^-104 (|x| + |a y|), a strength within 2^-100.
    const ROUNDING: f64 = 1.0 / (1u128 << 98) as f64;
    const NEAREST_ERROR: f64 = U;
    const ZERO: Twofold = Twofold { hi: 0.0, lo: 0.0 };
    const ONE: Twofold = Twofold { hi: 1.0, lo: 0.0 };

    fn of(k: &Ball) -> Option<Twofold> {
        let size = Twofold::from_ball(&k.abs())?;
        Some(if k.sign() == Some(Sign::Negative) { size.scaled(-1.0) } else { size })
    }

    #[inline(always)]
    fn quotient(ticks: u64, unit: u64) -> Twofold {
        Twofold::of_whole(ticks as f64, unit as f64)
    }

    #[inline(always)]
    fn sheared(self, a: Twofold, y: Twofold) -> Twofold {
        self.plus(a.times(y))
    }

    #[inline(always)]
    fn scaled(self, by: f64) -> Twofold {
        Twofold { hi: self.hi * by, lo: self.lo * by }
    }

    #[inline(always)]
    fn near(self) -> f64 {
        self.hi
    }
}

/// The work that is compiled for each instruction set.
struct Run<'a, N>(&'a Steps<N>, &'a Schedule);

impl<N: Number> Task for Run<'_, N> {
    type Output = (Orbit<N>, Orbit<N>, i64);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Run(steps, schedule) = self;
        let (even, odd) = (Orbit::new(N::ONE, N::ZERO), Orbit::new(N::ZERO, N::ONE));
        let mut both = Both { ticks: steps.ticks, per_unit: steps.per_unit, even, odd, half_turns: 0 };
        steps.kicks.lead(schedule.half_period(), &mut both);
        (both.even, both.odd, both.half_turns)
    }
}

/// The shears of all events, and the constants of the bound.
struct Steps<N> {
    /// The −b of all kicks; half of one is exact.
    kicks: Kicks<N>,
    /// Ticks in h1, and 1/w: a = drift/`ticks` · `per_unit`.
    ticks: u64,
    per_unit: f64,
    bound: StepBound,
    /// How many shears there are at most.
    shears: u64,
    /// 2b_k/Σ|û|².
    local: f64,
    /// The largest angle that the theorem allows.
    tau: f64,
}

impl<N: Number> Steps<N> {
    fn new<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<Self> {
        let [fast, slow, both] = clocks.enclosures(BITS).each_ref().map(strength::<N>);
        let strengths = [fast?, slow?, both?];
        let strongest = strengths.iter().fold(0.0, |most: f64, k| most.max(k.near().abs()));
        // w = 2^-k with 4^k next to the strongest kick: drifts are at most 1, kicks at most `strongest`.
        let w = power_of_two(-((strongest.max(1.0).log2() / 2.0).round() as i32));
        let largest = (1.0 / w).max(strongest * w);
        let kappa = 1.01 * (largest / 2.0 + (1.0 + largest * largest / 4.0).sqrt());
        let bound = StepBound { kappa, epsilon: 3.1 * N::ROUNDING * kappa };
        // A drift and a kick at each event, and the end.
        let shears = 2 * (schedule.strikes() + 2);
        let tau = bound.tau(shears)?;
        // Whole numbers below 2^53 are doubles; drifts are no longer than a step.
        let exact = schedule.clocks().iter().all(|clock| clock.step() < 1 << 53);
        let local = 2.02 * bound.epsilon * bound.growth();
        let kicks = Kicks::of_two_clocks(strengths, |k| [k.scaled(-w), k.scaled(-0.5 * w)]);
        let ticks = schedule.clocks()[0].step();
        exact.then_some(Steps { kicks, ticks, per_unit: 1.0 / w, bound, shears, local, tau })
    }
}

/// The strength within 2u, or exactly 0.
fn strength<N: Number>(k: &Ball) -> Option<N> {
    if k.sign() == Some(Sign::Zero) { Some(N::ZERO) } else { N::of(k) }
}

/// One solution on its way: 2^exponent (x, y).
struct Orbit<N> {
    x: N,
    y: N,
    /// |û|², its sum over all shears so far, and the largest quotient of the sum by it.
    square: f64,
    squares: f64,
    worst: f64,
    exponent: i64,
}

impl<N: Number> Orbit<N> {
    fn new(x: N, y: N) -> Self {
        Orbit { x, y, square: 1.0, squares: 0.0, worst: 0.0, exponent: 0 }
    }

    #[inline(always)]
    fn account(&mut self) {
        let (x, y) = (self.x.near(), self.y.near());
        self.square = x.mul_add(x, y * y);
        self.squares += self.square;
        let ratio = self.squares / self.square;
        // NaN is taken; the state stays NaN then, and so does this.
        self.worst = if ratio <= self.worst { self.worst } else { ratio };
    }

    /// Keeps the squared length in range.
    #[inline(always)]
    fn rescale(&mut self) {
        if !(1.0 / LONGEST..=LONGEST).contains(&self.square) {
            // Powers of two: exact. A sum that overflows has long been refused by its quotient.
            let by = if self.square > 1.0 { -SHRINK } else { SHRINK };
            let (once, twice) = (power_of_two(by), power_of_two(2 * by));
            (self.x, self.y) = (self.x.scaled(once), self.y.scaled(once));
            (self.square, self.squares) = (self.square * twice, self.squares * twice);
            self.exponent -= i64::from(by);
        }
    }

    /// `None` where a condition failed. (NaN fails.)
    fn end(mut self, steps: &Steps<N>) -> Option<End> {
        // The last event may be a drift alone.
        self.rescale();
        let (angle, across) = (steps.local * self.worst, steps.local * self.squares);
        let stretch = steps.bound.length_uncertainty(steps.shears, angle);
        let held = angle <= steps.tau && self.square.is_finite();
        held.then(|| {
            End::new([self.x.near(), self.y.near()], N::NEAREST_ERROR, self.exponent, across, stretch)
        })
    }
}

/// Both solutions on their way, and how often the even one's x has changed its sign.
struct Both<N> {
    ticks: u64,
    per_unit: f64,
    even: Orbit<N>,
    odd: Orbit<N>,
    half_turns: i64,
}

impl<N: Number> KickDrift<N> for Both<N> {
    #[inline(always)]
    fn drift(&mut self, ticks: u64) {
        let (a, before) = (N::quotient(ticks, self.ticks).scaled(self.per_unit), self.even.x.near());
        for orbit in [&mut self.even, &mut self.odd] {
            orbit.x = orbit.x.sheared(a, orbit.y);
            orbit.account();
        }
        self.half_turns += i64::from(before.is_sign_negative() != self.even.x.near().is_sign_negative());
    }

    #[inline(always)]
    fn kick(&mut self, b: &N) {
        for orbit in [&mut self.even, &mut self.odd] {
            orbit.y = orbit.y.sheared(*b, orbit.x);
            orbit.account();
            orbit.rescale();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::refine;
    use crate::propagator::{PartialSigns, half_period};
    use num_integer::Integer;
    use num_traits::Signed;
    use number::{Ratio, Rational, ratio};
    use proptest::prelude::*;

    fn run_of(clocks: &TwoClocks<Rational>) -> Option<Ends> {
        run(clocks, &Schedule::two_clocks(clocks.ratio()).unwrap())
    }

    fn signs_of(clocks: &TwoClocks<Rational>) -> Option<PartialSigns> {
        Some(run_of(clocks)?.signs())
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

        /// In doubles and in two: A, B, C, D lie where the bounds say, B and C up to the scale that BC does
        /// not have.
        #[test]
        fn the_exact_end_lies_within_the_bound(
            p in 1u64..40, q in 1u64..40, s in -9000i64..9000, k in -9000i64..9000,
        ) {
            let (p, q) = (p / p.gcd(&q), q / p.gcd(&q));
            let clocks = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 1000), ratio(k, 1000));
            let (schedule, half) = (Schedule::two_clocks(clocks.ratio()).unwrap(), half_period(&clocks));
            let (ours, sharp) = (run(&clocks, &schedule), sharp(&clocks, &schedule));
            prop_assert!(sharp.is_some_and(|sharp| ours.is_none_or(|ours| sharp.even.across < ours.even.across)));
            for ends in [ours, sharp].into_iter().flatten() {
                let (even, odd) = (&ends.even, &ends.odd);
                let slack = |z: f64, end: &End| {
                    (end.across / end.x.hypot(end.v)) / z.abs() + end.rounding + 1.4 * end.stretch
                };
                for (exact, (x, one), (v, other)) in
                    [(half.a() * half.d(), (even.x, even), (odd.v, odd)), (half.b() * half.c(), (odd.x, odd), (even.v, even))]
                {
                    let error = 1.01 * (slack(x, one) + slack(v, other));
                    prop_assume!(error < 0.01);
                    let product = Rational::from_float(x).unwrap() * Rational::from_float(v).unwrap();
                    let two = |n: i64| Rational::from_integer(2.into()).pow(n as i32);
                    let off = (product * two(one.exponent + other.exponent) / exact) - Rational::from_integer(1.into());
                    prop_assert!(off.abs() <= Rational::from_float(error).unwrap());
                }
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

    #[test]
    fn kicks_that_cancel_leave_their_rest_as_sharp_as_a_number_of_its_own() {
        let sharp = |rest: &Rational| {
            let clocks = TwoClocks::new(Ratio::ONE, ratio(5403, 1000), rest - ratio(5403, 1000));
            (
                half_period(&clocks).signs().verdict(),
                sharp(&clocks, &Schedule::two_clocks(clocks.ratio()).unwrap()),
            )
        };
        assert!(sharp(&ratio(0, 1)).1.is_some());
        let (exact, ends) = sharp(&ratio(1, 10i64.pow(17)));
        assert_eq!(ends.and_then(|ends| ends.signs().verdict()), Some(exact));
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
