//! One oscillator whose spectral radius is 1 at every friction, as velocity Verlet's at its own limit,
//! exactly.

use num_traits::One;

use crate::ManyClocks;
use clocks::schedule::{KickDrift, Kicks};
use number::{Rational, Real, Sign};

/// The longest period that is looked at, in ticks: each is a place at which a polynomial has to vanish.
const LONGEST: u64 = 200;

/// Whether the period has an eigenvalue 1 or −1 at every friction: one of 1 + c^N ∓ Tr Q(c), polynomials of
/// degree N in the factor c of a tick, is 0. The other one is then positive, so the spectral radius is 1.
pub(super) fn is_tie<S: Real>(clocks: &ManyClocks<S>) -> bool {
    let ticks = clocks.schedule().period();
    if ticks > LONGEST {
        return false;
    }
    let vanishes = |sign: i64| {
        (0..=ticks).all(|k| {
            let c = Rational::from_integer(k.into());
            let [trace, mut sum] = at(clocks, &c);
            sum += S::one();
            sum.add_product(&S::from_rational(&Rational::from_integer(sign.into())), &trace);
            sum.sign() == Sign::Zero
        })
    };
    vanishes(-1) || vanishes(1)
}

/// Tr Q and det Q where velocities are multiplied by c in a tick.
fn at<S: Real>(clocks: &ManyClocks<S>, c: &Rational) -> [S; 2] {
    let schedule = clocks.schedule();
    let half = S::from_rational(&Rational::new(1.into(), 2.into()));
    let kicks = Kicks::of_clocks(clocks.strengths().to_vec(), |k| [k.clone(), S::product(&k, &half)]);
    let (x, v) = ([S::one(), S::zero()], [S::zero(), S::one()]);
    let mut orbit = Orbit { x, v, tick: schedule.tick(), c };
    kicks.lead(schedule.staggered_period(), &mut orbit);
    let ([mut trace, _], [_, v]) = (orbit.x, orbit.v);
    trace += v;
    [trace, S::from_rational(&c.pow(schedule.period() as i32))]
}

/// The rows of the propagator.
struct Orbit<'a, S> {
    x: [S; 2],
    v: [S; 2],
    tick: &'a Rational,
    c: &'a Rational,
}

impl<S: Real> KickDrift<S> for Orbit<'_, S> {
    fn drift(&mut self, ticks: u64) {
        let c = self.c.pow(ticks as i32);
        let mean = self.tick * Rational::new(ticks.into(), 2.into()) * (Rational::one() + &c);
        let [mean, c] = [mean, c].map(|x| S::from_rational(&x));
        for (x, v) in self.x.iter_mut().zip(&mut self.v) {
            x.add_product(&mean, v);
            *v = S::product(v, &c);
        }
    }

    fn kick(&mut self, strength: &S) {
        self.x.iter().zip(&mut self.v).for_each(|(x, v)| v.sub_product(strength, x));
    }
}
