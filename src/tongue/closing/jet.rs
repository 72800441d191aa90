//! The half period's entries with their derivatives in s and ρ, enclosed over a box.

use crate::error::Result;
use crate::number::{Ball, Ratio, Rational};
use crate::schedule::{Schedule, Weight};
use crate::tongue::string::Entry;

/// A function's value, its derivative in s and in ρ.
#[derive(Clone, Debug)]
pub(crate) struct Jet(pub [Ball; 3]);

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

/// The entries' jets over s × ρ, by plain ball arithmetic: for short periods and small boxes, whose growth over the
/// period the bits outlast.
pub(crate) fn jets(ratio: Ratio, s: &Ball, rho: &Ball, pair: [Entry; 2], bits: u32) -> Result<[Jet; 2]> {
    let schedule = Schedule::two_clocks(ratio)?;
    let exact = |n: u64, d: u64| Ball::from_rational(&Rational::new(n.into(), d.into()), bits);
    let s = Jet([s.clone(), Ball::one(), Ball::zero()]);
    let rho = Jet([rho.clone(), Ball::zero(), Ball::one()]);
    let slow = s.times(&rho, bits).scaled(&exact(ratio.p(), ratio.q()), bits);
    let kicks = [Jet::constant(Ball::zero()), s.clone(), slow.clone(), s.plus(&slow, bits)];
    let ticks = schedule.clocks()[0].step();
    let orbit = |even: bool| {
        let unit = |on: bool| Jet::constant(if on { Ball::one() } else { Ball::zero() });
        let (mut x, mut v) = (unit(even), unit(!even));
        for event in schedule.half_period() {
            x = x.plus(&v.scaled(&exact(event.drift, ticks), bits), bits);
            let kick = kicks[event.kicks as usize].times(&x, bits);
            let part = if event.weight == Weight::Half { exact(1, 2) } else { Ball::one() };
            v = v.minus(&kick.scaled(&part, bits), bits);
        }
        (x, v)
    };
    let ((a, c), (b, d)) = (orbit(true), orbit(false));
    let all = [a, b, c, d];
    Ok(pair.map(|entry| all[entry as usize].clone()))
}
