//! The bias of a stable pair: by how much its potential energy is off at the temperature of its velocities.
//!
//! An elliptic period is a rotation in its own ellipse. With Σ = diag(β, 1/β) its covariance where both clocks
//! kick, β² = −BD/(AC) (theorem `palindrome` in proofs/ gives Q's entries 2BD and 2AC). The exact motion has
//! (Λ1 + Λ2) β² = 1. What a thermostat makes of it depends on where it sets the velocities:
//!
//! ```text
//!     at the kicks (constant energy, OBABO):          R = (Λ1 + Λ2) β²
//!     in the drifts (BAOAB, LangevinMiddle):          R = (Λ1 + Λ2) β ⟨Σ11⟩
//! ```
//!
//! ⟨Σ11⟩ is the mean, by time, of Σ11 in the middles of all drifts: a weak friction there draws the action
//! J, Σ being J of unit determinant, to kT ⟨Σ11⟩, for noise of variance w in the velocity adds w Σ11/2 to it. One clock
//! alone has R = 1/(1 − h² Λ/4) at the kicks and 1 in the drifts.

use num_traits::Zero;

use super::TwoClocks;
use super::elementary::{apply_drift, apply_kick};
use crate::schedule::{KickDrift, Kicks, Schedule};
use nalgebra::Matrix2;
use num_integer::Integer;
use number::{Ball, Enclosed, Ratio, Rational, Real, Ring, rational};

/// (Λ1 + Λ2) ⟨x²⟩/kT where both clocks kick: 1 of an unbiased step.
#[derive(Clone, Debug, PartialEq)]
pub struct Bias<T> {
    /// With velocities of this temperature at the kicks.
    pub at_kicks: T,
    /// With a weak thermostat in the middle of each drift.
    pub in_drifts: T,
}

/// The most kicks of a period whose bias is enclosed: each costs its bits.
pub const MAX_BIAS_KICKS: u64 = 1000;

/// Kicks that the smaller of two precisions is enough for.
const FEW_KICKS: u64 = 40;

/// Bits of the result that must be certain.
const ACCURACY_BITS: i64 = 56;

/// The half period with the sums of duration · x² over the middles of its drifts, of the even and of the odd
/// solution; a drift that T/2 halves has its middle there.
struct Spread<S> {
    half: Matrix2<S>,
    squares: [S; 2],
    /// Ticks of the unit of time h1.
    unit: u64,
    /// Ticks that have passed, and those of the half period.
    passed: u64,
    end: u64,
    is_halved: bool,
}

impl<S: Ring> Spread<S> {
    fn new(clocks: &TwoClocks<S>) -> Spread<S> {
        let schedule = Schedule::two_clocks(clocks.ratio()).expect("a period short enough to compose");
        let one_half = S::from_rational(&rational::ratio(1, 2));
        let kicks = Kicks::of_two_clocks(clocks.strengths(), |k| [k.clone(), k * one_half.clone()]);
        let unit = schedule.clocks()[0].step();
        let mut spread = Spread {
            half: Matrix2::new(S::one(), S::zero(), S::zero(), S::one()),
            squares: [S::zero(), S::zero()],
            unit,
            passed: 0,
            // T = p h1.
            end: clocks.p() * unit,
            // No clock kicks at T/2.
            is_halved: clocks.p() % 2 == 1 && clocks.q() % 2 == 1,
        };
        kicks.lead(schedule.half_period(), &mut spread);
        spread
    }

    fn time(&self, ticks: u64, parts: u64) -> S {
        let (ticks, unit) = (ticks, self.unit * parts);
        let divisor = ticks.gcd(&unit);
        S::from_rational(&Rational::new_raw((ticks / divisor).into(), (unit / divisor).into()))
    }
}

impl<S: Ring> KickDrift<S> for Spread<S> {
    fn drift(&mut self, ticks: u64) {
        self.passed += ticks;
        let (duration, half) = (self.time(ticks, 1), self.time(ticks, 2));
        let is_cut = self.is_halved && 2 * self.passed == self.end;
        apply_drift(&mut self.half, &half);
        let middle = if is_cut {
            apply_drift(&mut self.half, &half);
            self.half.clone()
        } else {
            let middle = self.half.clone();
            apply_drift(&mut self.half, &half);
            middle
        };
        for (sum, x) in self.squares.iter_mut().zip([&middle[(0, 0)], &middle[(0, 1)]]) {
            sum.add_product(&duration, &S::product(x, x));
        }
    }

    fn kick(&mut self, strength: &S) {
        apply_kick(&mut self.half, strength);
    }
}

/// (Λ1 + Λ2) h1² and T/2 in the unit h1, of a ratio and both strengths.
fn scales(ratio: Ratio) -> (Rational, Rational) {
    (Rational::from(ratio).recip(), rational::ratio(1, 2) * Rational::from_integer(ratio.p().into()))
}

/// The bias of an elliptic pair, exactly; `None` of any other, and unless Λ1 + Λ2 > 0.
///
/// ```
/// use kickdrift_clocks::number::rational::ratio;
/// use kickdrift_clocks::propagator::{TwoClocks, bias};
/// let verlet = TwoClocks::with_rho("1/1".parse().unwrap(), ratio(1, 1), ratio(0, 1));
/// let bias = bias(&verlet).unwrap();
/// assert_eq!((bias.at_kicks, bias.in_drifts), (ratio(4, 3), ratio(1, 1))); // 1/(1 - s/4)
/// ```
///
/// # Panics
/// As [`half_period`](super::half_period).
pub fn bias(clocks: &TwoClocks<Rational>) -> Option<Bias<Rational>> {
    let Spread { half, squares: [even, odd], .. } = Spread::new(clocks);
    let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|at| &half[at]);
    let zero = Rational::zero();
    let (slow, half_time) = scales(clocks.ratio());
    let stiffness = clocks.fast() + clocks.slow() * slow;
    if b * c >= zero || a * d <= zero || stiffness <= zero {
        return None;
    }
    let square = -(b * d) / (a * c);
    let in_drifts = &stiffness * (&square * even + odd) / half_time;
    Some(Bias { at_kicks: stiffness * square, in_drifts })
}

/// As [`bias`], of a pair that is known to be elliptic, enclosed to 56 bits; `None` also beyond
/// [`MAX_BIAS_KICKS`].
pub fn enclosed_bias<S: Real>(clocks: &TwoClocks<S>) -> Option<Bias<Ball>> {
    let kicks = clocks.ratio().kicks();
    if kicks <= FEW_KICKS {
        enclosed_in::<256, S>(clocks).or_else(|| enclosed_in::<4096, S>(clocks))
    } else if kicks <= MAX_BIAS_KICKS {
        enclosed_in::<4096, S>(clocks)
    } else {
        None
    }
}

fn enclosed_in<const BITS: u32, S: Real>(clocks: &TwoClocks<S>) -> Option<Bias<Ball>> {
    let clocks = clocks.map(|x| Enclosed::<BITS>(x.enclosure(BITS)));
    let Spread { half, squares: [even, odd], .. } = Spread::new(&clocks);
    let (slow, half_time) = scales(clocks.ratio());
    let ball = |x: &Rational| Ball::from_rational(x, BITS);
    let stiffness = clocks.fast().0.add(&clocks.slow().0.mul(&ball(&slow), BITS), BITS);
    let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|at| &half[at].0);
    let square = b.mul(d, BITS).neg().div(&a.mul(c, BITS), BITS)?;
    let sum = square.mul(&even.0, BITS).add(&odd.0, BITS);
    let in_drifts = stiffness.mul(&sum, BITS).div(&ball(&half_time), BITS)?;
    let bias = Bias { at_kicks: stiffness.mul(&square, BITS), in_drifts };
    let is_known = |x: &Ball| x.relative_accuracy_bits() >= ACCURACY_BITS && x.lower() > Rational::zero();
    (is_known(&bias.at_kicks) && is_known(&bias.in_drifts)).then_some(bias)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagator::full_period;
    use crate::schedule::Event;
    use number::rational::ratio;

    fn pairs() -> Vec<TwoClocks<Rational>> {
        let of = |text: &str, s, rho| TwoClocks::with_rho(text.parse().unwrap(), s, rho);
        vec![
            of("1/1", ratio(1, 4), ratio(1, 25)),
            of("3/1", ratio(1, 4), ratio(1, 25)),
            of("3/2", ratio(1, 4), ratio(1, 25)),
            of("5/3", ratio(9, 8), ratio(1, 2)),
            of("3/1", ratio(3, 2), ratio(1, 3)),
            of("2/3", ratio(1, 9), ratio(-1, 8)),
        ]
    }

    #[test]
    fn at_the_kicks_it_is_the_ellipse_of_the_full_period() {
        for clocks in pairs() {
            let full = full_period(&clocks);
            let stiffness = clocks.fast() + clocks.slow() / Rational::from(clocks.ratio());
            let ellipse = -stiffness * &full[(0, 1)] / &full[(1, 0)];
            assert_eq!(bias(&clocks).unwrap().at_kicks, ellipse, "{clocks:?}");
        }
    }

    #[test]
    fn verlet_has_the_known_bias() {
        for s in [ratio(1, 100), ratio(1, 2), ratio(2, 1), ratio(39, 10)] {
            let verlet = TwoClocks::with_rho("1/1".parse().unwrap(), s.clone(), ratio(0, 1));
            let found = bias(&verlet).unwrap();
            assert_eq!(found.at_kicks, (ratio(1, 1) - s / ratio(4, 1)).recip());
            assert_eq!(found.in_drifts, ratio(1, 1));
        }
    }

    /// The stationary covariance of a period with a weak friction in the middle of each drift: the fixed point
    /// of v → (1 − g t) v and noise 2 g t.
    fn stationary(clocks: &TwoClocks<Rational>, friction: f64) -> f64 {
        struct Moments {
            xx: f64,
            xv: f64,
            vv: f64,
            unit: f64,
            friction: f64,
        }
        impl Moments {
            fn move_by(&mut self, t: f64) {
                self.xx += 2.0 * t * self.xv + t * t * self.vv;
                self.xv += t * self.vv;
            }
        }
        impl KickDrift<f64> for Moments {
            fn drift(&mut self, ticks: u64) {
                let t = ticks as f64 / self.unit;
                self.move_by(t / 2.0);
                let damping = 1.0 - self.friction * t;
                self.xv *= damping;
                self.vv = damping * damping * self.vv + 2.0 * self.friction * t;
                self.move_by(t / 2.0);
            }
            fn kick(&mut self, strength: &f64) {
                self.vv += strength * strength * self.xx - 2.0 * strength * self.xv;
                self.xv -= strength * self.xx;
            }
        }
        let schedule = Schedule::two_clocks(clocks.ratio()).unwrap();
        let strengths = clocks.strengths().map(|k| rational::to_f64(&k));
        let kicks = Kicks::of_two_clocks(strengths, |k| [k, k / 2.0]);
        let events: Vec<Event> = schedule.symmetric_period().collect();
        let unit = schedule.clocks()[0].step() as f64;
        let mut moments = Moments { xx: 1.0, xv: 0.0, vv: 1.0, unit, friction };
        // The friction draws the action to its mean within 1/(g T) periods: twenty times as many.
        for _ in 0..(20.0 / friction) as u64 {
            kicks.lead(events.iter().copied(), &mut moments);
        }
        let stiffness = clocks.fast() + clocks.slow() / Rational::from(clocks.ratio());
        moments.xx * rational::to_f64(&stiffness)
    }

    #[test]
    fn in_the_drifts_it_is_what_a_weak_thermostat_there_leaves() {
        for clocks in pairs() {
            let expected = rational::to_f64(&bias(&clocks).unwrap().in_drifts);
            // Half the friction, half the distance: what is left at none.
            let [coarse, fine] = [2e-4, 1e-4].map(|friction| stationary(&clocks, friction));
            let limit = 2.0 * fine - coarse;
            assert!((limit / expected - 1.0).abs() < 1e-6, "{clocks:?}: {limit}, expected {expected}");
        }
    }

    #[test]
    fn enclosures_hold_the_exact_values() {
        for clocks in pairs() {
            let (exact, enclosed) = (bias(&clocks).unwrap(), enclosed_bias(&clocks).unwrap());
            assert!(enclosed.at_kicks.contains(&exact.at_kicks), "{clocks:?}");
            assert!(enclosed.in_drifts.contains(&exact.in_drifts), "{clocks:?}");
        }
        let long = TwoClocks::with_rho("501/499".parse().unwrap(), ratio(1, 5000), ratio(1, 25));
        assert!(enclosed_bias(&long).is_some());
    }

    #[test]
    fn a_pair_that_is_not_elliptic_has_none() {
        for s in [ratio(4, 1), ratio(5, 1)] {
            assert_eq!(bias(&TwoClocks::with_rho("1/1".parse().unwrap(), s, ratio(0, 1))), None);
        }
    }
}
