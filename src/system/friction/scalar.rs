//! K clocks on one oscillator, with friction.

use std::collections::BTreeMap;

use super::damping::Damping;
use crate::error::{Error, Result};
use crate::number::{Ball, Real, Sign};
use crate::schedule::{KickDrift, Kicks};
use crate::system::ManyClocks;

/// The effect of a rate of friction on one oscillator.
#[derive(Clone, Debug)]
pub struct Damped {
    /// Where ρ(Q) lies, proven.
    pub damping: Damping,
    /// ρ(Q), enclosed.
    pub radius: Ball,
}

/// Balls of 2^7 to 2^16 bits are tried.
const PRECISIONS: std::ops::RangeInclusive<u32> = 7..=16;

/// The most products of 64-bit words of one attempt: some seconds.
const WORK: u64 = 1 << 32;

/// The precisions worth trying for so many steps.
pub(super) fn precisions(steps: u64) -> impl Iterator<Item = u32> {
    PRECISIONS.map(|log2| 1u32 << log2).take_while(move |&bits| steps.saturating_mul(bits.into()) < WORK)
}

/// Where the spectral radius lies at the friction `rate` = γ h_1 > 0, proven; strengths and rate are enclosed to as many bits
/// as that takes.
///
/// # Errors
/// A rate that is not positive; a budget error where the radius is too near to 1 to be decided by 2^16 bits or in some seconds.
pub fn damped<S: Real>(clocks: &ManyClocks<S>, rate: &impl Real) -> Result<Damped> {
    if rate.sign() != Sign::Positive {
        return Err(Error::input("friction", format!("{rate:?}"), "a rate of friction must be positive"));
    }
    if clocks.strengths().iter().all(|k| k.sign() == Sign::Zero) {
        return Ok(Damped { damping: Damping::Marginal, radius: Ball::one() });
    }
    let found = precisions(clocks.schedule().strikes()).find_map(|bits| {
        let (trace, det) = enclosed(clocks, &rate.enclosure(bits), bits);
        let damping = jury(&Ball::one().add(&det, bits), &trace, bits)?;
        Some(Damped { damping, radius: radius(&trace, &det, bits) })
    });
    let untold = || Error::budget("a spectral radius this near to 1", WORK).or("choose a friction beside it");
    found.ok_or_else(untold)
}

/// |Tr| against 1 + det, det < 1, where the balls decide.
fn jury(sum: &Ball, trace: &Ball, bits: u32) -> Option<Damping> {
    match (sum.sub(trace, bits).sign(), sum.add(trace, bits).sign()) {
        (Some(Sign::Negative), _) | (_, Some(Sign::Negative)) => Some(Damping::Growing),
        (Some(Sign::Positive), Some(Sign::Positive)) => Some(Damping::Damped),
        _ => None,
    }
}

/// The larger |λ| of λ² − Tr λ + det: √det for a complex pair, else (|Tr| + √(Tr² − 4 det))/2.
fn radius(trace: &Ball, det: &Ball, bits: u32) -> Ball {
    let discriminant = trace.square(bits).sub(&det.scale2(2), bits);
    let root = || det.sqrt_clipped(bits).expect("a determinant >= 0");
    if discriminant.sign() == Some(Sign::Negative) {
        return root();
    }
    let real = trace.abs().add(&discriminant.sqrt_clipped(bits).unwrap_or_else(Ball::zero), bits).scale2(-1);
    if discriminant.sign().is_some() { real } else { real.union(&root(), bits) }
}

/// Tr Q and det Q at the rate γ h_1.
fn enclosed<S: Real>(clocks: &ManyClocks<S>, rate: &Ball, bits: u32) -> (Ball, Ball) {
    let tick = Ball::from_rational(clocks.schedule().tick(), bits);
    let decay = |ticks: u64| {
        let time = tick.mul(&Ball::from_integer(&ticks.into()), bits);
        (rate.mul(&time, bits).neg().exp(bits), time)
    };
    let strengths = clocks.strengths().iter().map(|k| k.enclosure(bits));
    let kicks = Kicks::of_clocks(strengths, |k| [k.clone(), k.scale2(-1)]);
    let [a, b, c, d] = [1, 0, 0, 1].map(|n: i32| Ball::from_integer(&n.into()));
    let mut orbit = Orbit { x: [a, b], v: [c, d], decay: &decay, known: BTreeMap::new(), bits };
    kicks.lead(clocks.schedule().staggered_period(), &mut orbit);
    let det = decay(clocks.schedule().period()).0;
    (orbit.x[0].add(&orbit.v[1], bits), det)
}

/// The rows of the propagator in balls.
struct Orbit<'a> {
    x: [Ball; 2],
    v: [Ball; 2],
    /// c = exp(−γ t), and t.
    decay: &'a dyn Fn(u64) -> (Ball, Ball),
    /// c and t (1 + c)/2 by ticks.
    known: BTreeMap<u64, (Ball, Ball)>,
    bits: u32,
}

impl KickDrift<Ball> for Orbit<'_> {
    fn drift(&mut self, ticks: u64) {
        let (bits, decay) = (self.bits, self.decay);
        let (c, mean) = self.known.entry(ticks).or_insert_with(|| {
            let (c, time) = decay(ticks);
            let mean = time.mul(&Ball::one().add(&c, bits), bits).scale2(-1);
            (c, mean)
        });
        for (x, v) in self.x.iter_mut().zip(&mut self.v) {
            *x = x.add(&mean.mul(v, bits), bits);
            *v = v.mul(c, bits);
        }
    }

    fn kick(&mut self, strength: &Ball) {
        for (x, v) in self.x.iter().zip(&mut self.v) {
            *v = v.sub(&strength.mul(x, self.bits), self.bits);
        }
    }
}
