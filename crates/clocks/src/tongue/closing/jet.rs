//! The half period's entries with their derivatives in s and ρ, enclosed over a box.

use crate::schedule::{KickDrift, Kicks, Schedule};
use crate::tongue::string::Entry;
use number::{Ball, Ratio, Rational, Result};

/// A function's value, its derivative in s and in ρ.
#[derive(Clone, Debug)]
pub struct Jet(pub [Ball; 3]);

impl Jet {
    fn constant(value: Ball) -> Jet {
        Jet([value, Ball::zero(), Ball::zero()])
    }

    fn plus(&self, other: &Jet, bits: u32) -> Jet {
        Jet(std::array::from_fn(|i| self.0[i].add(&other.0[i], bits)))
    }

    fn minus(&self, other: &Jet, bits: u32) -> Jet {
        Jet(std::array::from_fn(|i| self.0[i].sub(&other.0[i], bits)))
    }

    fn times(&self, other: &Jet, bits: u32) -> Jet {
        let (a, b) = (&self.0, &other.0);
        let leibniz = |i: usize| a[i].mul(&b[0], bits).add(&a[0].mul(&b[i], bits), bits);
        Jet([a[0].mul(&b[0], bits), leibniz(1), leibniz(2)])
    }

    fn scaled(&self, c: &Ball, bits: u32) -> Jet {
        Jet(self.0.each_ref().map(|x| x.mul(c, bits)))
    }
}

/// The entries' jets over s × ρ, by plain ball arithmetic: for short periods and small boxes, whose growth
/// over the period the bits outlast.
pub(crate) fn jets(ratio: Ratio, s: &Ball, rho: &Ball, pair: [Entry; 2], bits: u32) -> Result<[Jet; 2]> {
    let schedule = Schedule::two_clocks(ratio)?;
    let exact = |n: u64, d: u64| Ball::from_rational(&Rational::new(n.into(), d.into()), bits);
    let s = Jet([s.clone(), Ball::one(), Ball::zero()]);
    let rho = Jet([rho.clone(), Ball::zero(), Ball::one()]);
    let slow = s.times(&rho, bits).scaled(&exact(ratio.p(), ratio.q()), bits);
    let strengths = [s.clone(), slow.clone(), s.plus(&slow, bits)];
    let kicks = Kicks::of_two_clocks(strengths, |k| [k.clone(), k.scaled(&exact(1, 2), bits)]);
    let ticks = schedule.clocks()[0].step();
    let orbit = |even: bool| {
        let unit = |on: bool| Jet::constant(if on { Ball::one() } else { Ball::zero() });
        let mut orbit = Orbit { x: unit(even), v: unit(!even), ticks, bits };
        kicks.lead(schedule.half_period(), &mut orbit);
        (orbit.x, orbit.v)
    };
    let ((a, c), (b, d)) = (orbit(true), orbit(false));
    let all = [a, b, c, d];
    Ok(pair.map(|entry| all[entry as usize].clone()))
}

/// A solution on its way.
struct Orbit {
    x: Jet,
    v: Jet,
    /// Ticks in the unit of time h1.
    ticks: u64,
    bits: u32,
}

impl KickDrift<Jet> for Orbit {
    fn drift(&mut self, ticks: u64) {
        let time = Ball::from_rational(&Rational::new(ticks.into(), self.ticks.into()), self.bits);
        self.x = self.x.plus(&self.v.scaled(&time, self.bits), self.bits);
    }

    fn kick(&mut self, strength: &Jet) {
        self.v = self.v.minus(&strength.times(&self.x, self.bits), self.bits);
    }
}
