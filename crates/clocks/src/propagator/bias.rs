//! The bias of a stable pair: by how much its potential energy is off at the temperature of its velocities.
//!
//! An elliptic period is a rotation in its own ellipse. With Σ = diag(β, 1/β) its covariance where both
//! clocks kick, β² = −BD/(AC) (theorem `palindrome` in proofs/ gives Q's entries 2BD and 2AC). The exact
//! motion has (Λ1 + Λ2) β² = 1. What a thermostat makes of it depends on where it sets the velocities:
//!
//! ```text
//!     at the kicks (constant energy, OBABO):          R = (Λ1 + Λ2) β²
//!     in the drifts (BAOAB, LangevinMiddle):          R = (Λ1 + Λ2) β ⟨Σ11⟩
//! ```
//!
//! ⟨Σ11⟩ is the mean, by time, of Σ11 in the middles of all drifts: a weak friction there draws the action
//! J, Σ being J of unit determinant, to kT ⟨Σ11⟩, for noise of variance w in the velocity adds w Σ11/2 to it.
//! One clock alone has R = 1/(1 − h² Λ/4) at the kicks and 1 in the drifts.

use num_traits::Zero;

use super::TwoClocks;
use super::half::{Product, schedule, with_half};
use crate::schedule::{KickDrift, Kicks, Schedule};
use number::{Ball, Enclosed, Rational, Real, Ring, rational};

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

/// Bits of the result that must be certain.
const ACCURACY_BITS: i64 = 56;

/// The half period, with Σ duration · x² over the middles of its drifts for the even and for the odd
/// solution.
struct Spread<S> {
    product: Product<S>,
    squares: [S; 2],
    /// Of the last drift, where no kick has followed it: how long it is, and x of both solutions before it.
    drift: Option<(S, [S; 2])>,
}

impl<S: Ring> Spread<S> {
    fn new(schedule: &Schedule, kicks: &Kicks<S>) -> Spread<S> {
        let squares = [S::zero(), S::zero()];
        let mut spread = Spread { product: Product::over(schedule), squares, drift: None };
        kicks.lead(schedule.half_period(), &mut spread);
        // T/2 is in the middle of a drift that no kick has followed.
        if let Some((duration, _)) = spread.drift.take() {
            let middle = spread.positions();
            spread.add(&duration, &middle);
        }
        spread
    }

    fn positions(&self) -> [S; 2] {
        [0, 1].map(|solution| self.product.matrix[(0, solution)].clone())
    }

    fn add(&mut self, duration: &S, middle: &[S; 2]) {
        for (sum, x) in self.squares.iter_mut().zip(middle) {
            sum.add_product(duration, &S::product(x, x));
        }
    }
}

impl<S: Ring> KickDrift<S> for Spread<S> {
    fn drift(&mut self, ticks: u64) {
        self.drift = Some((self.product.time(ticks), self.positions()));
        self.product.drift(ticks);
    }

    fn kick(&mut self, strength: &S) {
        if let Some((duration, before)) = self.drift.take() {
            let half = S::from_rational(&rational::ratio(1, 2));
            let ([even, odd], [even_before, odd_before]) = (self.positions(), before);
            self.add(&duration, &[(even_before + even) * half.clone(), (odd_before + odd) * half]);
        }
        self.product.kick(strength);
    }
}

/// Both biases as fractions over `below` = AC, which no elliptic pair has 0.
struct Fractions<S> {
    /// (Λ1 + Λ2 + ...) h1².
    stiffness: S,
    above: Bias<S>,
    below: S,
}

impl<S: Ring> Fractions<S> {
    /// Of a pair.
    fn new(clocks: &TwoClocks<S>) -> Fractions<S> {
        let ratio = S::from_rational(&Rational::from(clocks.ratio()).recip());
        let stiffness = clocks.fast().clone() + S::product(clocks.slow(), &ratio);
        Fractions::of(&schedule(clocks), &Kicks::of_two_clocks(clocks.strengths(), with_half), stiffness)
    }

    /// Of any clocks, in the unit of time of the first one's step.
    fn of(schedule: &Schedule, kicks: &Kicks<S>, stiffness: S) -> Fractions<S> {
        let Spread { product, squares: [even, odd], .. } = Spread::new(schedule, kicks);
        let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|at| &product.matrix[at]);
        let below = S::product(a, c);
        // β² below, and ⟨Σ11⟩/β below.
        let square = -S::product(b, d);
        let mean = S::product(&square, &even) + S::product(&below, &odd);
        let half = rational::ratio(1, 2) * Rational::from_integer(schedule.period().into());
        let half = half / Rational::from_integer(schedule.clocks()[0].step().into());
        let mean = S::product(&mean, &S::from_rational(&half.recip()));
        let above =
            Bias { at_kicks: S::product(&stiffness, &square), in_drifts: S::product(&stiffness, &mean) };
        Fractions { stiffness, above, below }
    }
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
    let Fractions { stiffness, above, below } = Fractions::new(clocks);
    // −BD/(AC) > 0 iff AD and BC = AD − 1 have two signs, that is iff the pair is elliptic.
    let is_elliptic = stiffness > Rational::zero() && &above.at_kicks * &below > Rational::zero();
    is_elliptic.then(|| Bias { at_kicks: above.at_kicks / &below, in_drifts: above.in_drifts / &below })
}

/// As [`bias`], of a pair that is known to be elliptic, enclosed to 56 bits; `None` also beyond
/// [`MAX_BIAS_KICKS`].
pub fn enclosed_bias<S: Real>(clocks: &TwoClocks<S>) -> Option<Bias<Ball>> {
    if clocks.ratio().kicks() > MAX_BIAS_KICKS {
        return None;
    }
    // A kick costs a bit or two.
    enclosed_in::<256, S>(clocks)
        .or_else(|| enclosed_in::<1024, S>(clocks))
        .or_else(|| enclosed_in::<4096, S>(clocks))
}

/// R at the kicks as doubles have it, for pictures: no bound is known of its rounding. `None` where it is no
/// positive number, as of a pair that is not elliptic.
pub fn rounded_bias(clocks: &TwoClocks<f64>) -> Option<f64> {
    let Fractions { above, below, .. } = Fractions::new(clocks);
    Some(above.at_kicks / below).filter(|bias| bias.is_finite() && *bias > 0.0)
}

/// As [`enclosed_bias`], of one mass under any clocks that all kick at the start; `None` also where it is not
/// known to be elliptic. The unit of time is the step of the first clock, and each strength is a step times
/// its stiffness over mass; `stiffness` is the sum of these.
pub fn enclosed_bias_of<S: Real>(schedule: &Schedule, strengths: &[S], stiffness: &S) -> Option<Bias<Ball>> {
    fn within<const BITS: u32, S: Real>(
        schedule: &Schedule,
        strengths: &[S],
        stiffness: &S,
    ) -> Option<Bias<Ball>> {
        let enclosed = |x: &S| Enclosed::<BITS>(x.enclosure(BITS));
        let kicks = Kicks::of_clocks(strengths.iter().map(enclosed), with_half);
        known(Fractions::of(schedule, &kicks, enclosed(stiffness)))
    }
    within::<256, S>(schedule, strengths, stiffness)
        .or_else(|| within::<1024, S>(schedule, strengths, stiffness))
}

fn enclosed_in<const BITS: u32, S: Real>(clocks: &TwoClocks<S>) -> Option<Bias<Ball>> {
    known(Fractions::new(&clocks.map(|x| Enclosed::<BITS>(x.enclosure(BITS)))))
}

/// Where both are known well enough, and above 0.
fn known<const BITS: u32>(fractions: Fractions<Enclosed<BITS>>) -> Option<Bias<Ball>> {
    let Fractions { above, below, .. } = fractions;
    let over = |above: Enclosed<BITS>| above.0.div(&below.0, BITS);
    let bias = Bias { at_kicks: over(above.at_kicks)?, in_drifts: over(above.in_drifts)? };
    let is_known = |x: &Ball| x.relative_accuracy_bits() >= ACCURACY_BITS && x.lower() > Rational::zero();
    (is_known(&bias.at_kicks) && is_known(&bias.in_drifts)).then_some(bias)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagator::full_period;
    use crate::schedule::{Event, Kicks};
    use number::ratio;

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

    /// The stationary covariance of a period with a weak friction in the middle of each drift: the fixed
    /// point of v → (1 − g t) v and noise 2 g t.
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
            // Some ten kicks of numbers of size 1, each with a rounding or two.
            let rounded = rounded_bias(&clocks.map(rational::to_f64)).unwrap();
            assert!((rounded / rational::to_f64(&exact.at_kicks) - 1.0).abs() < 1e-13, "{clocks:?}");
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
