//! Floquet coordinates: one step from kick to kick of the rarer clock, the frequent clock in closed form.
//!
//! Take the clock with more kicks as the base, its step as the unit of time, s its kick's strength, and
//! cos θ = 1 − s/2. Alone it moves x along U(t) = P(σ) e^{inθ}, t = n + σ, with P(σ) = 1 − σ + σ e^{iθ}:
//! straight between kicks. Write x(t) = Re(g P(σ)), g a complex number that turns by e^{iθ} with each base
//! step. A kick of strength k of the other clock adds i β x P̄ to g, β = k / sin θ
//! (theorem `foreign_ticks` in proofs/). So the half period costs min(p, q)/2 updates
//!
//! ```text
//!     g ← g e^{i Δn θ},   x = Re(g P),   g ← g + i β x P̄        Δn = ⌊p/q⌋ or ⌊p/q⌋ + 1,
//! ```
//!
//! and at T/2, where the base has turned by φ = p θ/2 in all, Re(g e^{iψ}) and −Im(g e^{iψ}) have the signs of
//! A and C for the even start, of B and D for the odd one; their products are BC and AD themselves.

use crate::number::{Ball, Real, Sign};
use crate::propagator::TwoClocks;

/// Working precision of the constants; they end as doubles with an error of one unit in the last place.
const BITS: u32 = 192;

/// The constants of one pair's half period, rounded to doubles.
///
/// Each has a relative error of at most 2u, u = 2^-53 (components of complex numbers of modulus 1: an
/// absolute error of at most u).
#[derive(Clone, Debug)]
pub(super) struct Floquet {
    /// The other clock's kicks strike at multiples of p/q base steps; p ≥ q unless the base had to be the
    /// rarer clock.
    pub p_mod_q: u64,
    pub q: u64,
    /// β = k / sin θ.
    pub beta: f64,
    /// P(σ) = 1 − σ s/2 + i σ sin θ.
    pub half_s: f64,
    pub sin: f64,
    /// e^{i ⌊p/q⌋ θ} and e^{i (⌊p/q⌋ + 1) θ}.
    pub turns: [[f64; 2]; 2],
    /// e^{iψ}: the turn left between the last base kick before the last update and T/2.
    pub last_turn: [f64; 2],
    /// φ = p θ/2, the base's turn over the half period, as near as doubles get: for counting turns only.
    pub phi: f64,
}

/// One update: turn g by `turn`, then kick it with strength `beta` where P(σ) = `p`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub turn: [f64; 2],
    pub beta: f64,
    pub p: [f64; 2],
}

impl Floquet {
    /// The constants, with the clock of more kicks as the base, or the other one where that is beyond its
    /// own Verlet limit; `None` where both are, or where a constant leaves the range of doubles.
    pub fn new<S: Real>(clocks: &TwoClocks<S>) -> Option<Floquet> {
        let swapped = clocks.swapped();
        let (first, second) = if clocks.p() >= clocks.q() { (clocks, &swapped) } else { (&swapped, clocks) };
        Floquet::on_base(first).or_else(|| Floquet::on_base(second))
    }

    /// The number of updates: the half kick at t = 0 and ⌊q/2⌋ more.
    pub fn updates(&self) -> u64 {
        self.q / 2 + 1
    }

    /// The updates of the half period in order: half a kick at t = 0, and half a one at T/2 if q is even.
    pub fn steps(&self) -> impl Iterator<Item = Step> + '_ {
        let start = Step { turn: [1.0, 0.0], beta: self.beta / 2.0, p: [1.0, 0.0] };
        let inverse_q = 1.0 / self.q as f64;
        let mut r = 0;
        let step = move |k: u64| {
            r += self.p_mod_q;
            let carry = r >= self.q;
            r -= if carry { self.q } else { 0 };
            let sigma = r as f64 * inverse_q;
            let beta = if 2 * k == self.q { self.beta / 2.0 } else { self.beta };
            Step { turn: self.turns[carry as usize], beta, p: [1.0 - sigma * self.half_s, sigma * self.sin] }
        };
        std::iter::once(start).chain((1..=self.q / 2).map(step))
    }

    /// With the first clock as the base.
    fn on_base<S: Real>(clocks: &TwoClocks<S>) -> Option<Floquet> {
        let (p, q) = (clocks.p(), clocks.q());
        let s = clocks.fast().enclosure(BITS);
        let rest = Ball::from_integer(&4.into()).sub(&s, BITS);
        if s.sign() != Some(Sign::Positive) || rest.sign() != Some(Sign::Positive) {
            return None;
        }
        let (sin_half, cos_half) = (s.sqrt(BITS)?.scale2(-1), rest.sqrt(BITS)?.scale2(-1));
        let sin = sin_half.mul(&cos_half, BITS).scale2(1);
        let phi = p as f64 * sin_half.mid_f64().atan2(cos_half.mid_f64());
        let half_turn = Turn { re: cos_half, im: sin_half };
        let turn = half_turn.power(2);
        let step = turn.power(p / q);
        let last_base_kick = ((q / 2) as u128 * p as u128 / q as u128) as u64;
        Some(Floquet {
            p_mod_q: p % q,
            q,
            beta: ordinary(&clocks.slow().enclosure(BITS).div(&sin, BITS)?)?,
            half_s: ordinary(&s.scale2(-1))?,
            sin: ordinary(&sin)?,
            turns: [step.to_f64()?, step.times(&turn).to_f64()?],
            last_turn: half_turn.power(p - 2 * last_base_kick).to_f64()?,
            phi,
        })
    }
}

/// e^{iα} in multiple precision.
struct Turn {
    re: Ball,
    im: Ball,
}

impl Turn {
    fn times(&self, other: &Turn) -> Turn {
        let product = |x: &Ball, y: &Ball| x.mul(y, BITS);
        Turn {
            re: product(&self.re, &other.re).sub(&product(&self.im, &other.im), BITS),
            im: product(&self.re, &other.im).add(&product(&self.im, &other.re), BITS),
        }
    }

    fn power(&self, mut n: u64) -> Turn {
        let mut result = Turn { re: Ball::one(), im: Ball::zero() };
        let mut square = Turn { re: self.re.clone(), im: self.im.clone() };
        while n > 0 {
            if n & 1 == 1 {
                result = result.times(&square);
            }
            square = square.times(&square);
            n >>= 1;
        }
        result
    }

    /// Both components to within 2^-53.
    fn to_f64(&self) -> Option<[f64; 2]> {
        let component = |x: &Ball| (x.radius_log2().is_none_or(|log2| log2 < -60)).then(|| x.mid_f64());
        Some([component(&self.re)?, component(&self.im)?])
    }
}

/// The nearest double of the midpoint, where that has a relative error of at most 2u: the ball is tight and
/// the number is 0 or far from the ends of the double's range.
fn ordinary(x: &Ball) -> Option<f64> {
    const TINY: f64 = 1e-140;
    let value = x.mid_f64();
    let in_range = value.abs() > TINY && value.abs() < 1.0 / TINY;
    (x.sign() == Some(Sign::Zero) || (in_range && x.relative_accuracy_bits() >= 60)).then_some(value)
}
