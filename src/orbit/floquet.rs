//! Floquet coordinates: from kick to kick of one clock, with the other clock, the *base*, in closed form.
//!
//! The base's step is the unit of time, s its kick's strength, cos θ = 1 − s/2. Alone it moves x along
//! Re(g P(σ)) at the time n + σ, g a complex number that turns by e^{iθ} with each base step and
//!
//! ```text
//!     P(σ) = cos(θ/2) + i (2σ - 1) sin(θ/2) = cos(θ/2) (1 + iT),       T = (2σ - 1) tan(θ/2),
//! ```
//!
//! straight between kicks. A kick of strength k of the other clock adds i β x P̄ to g, β = k / sin θ (theorem
//! `foreign_ticks` in proofs/). With g = re + i·im and B = β cos²(θ/2) = k / (2 tan(θ/2)) that is three shears,
//!
//! ```text
//!     re ← re - T im,      im ← im + B re,      re ← re + T im,
//! ```
//!
//! and so is a turn by α: re ← re − tan(α/2) im, im ← im + sin(α) re, re ← re − tan(α/2) im. A shear of re
//! follows a shear of re, so from kick to kick four remain: the base between two kicks acts as one kick between
//! two drifts. Turns by nθ are reduced by half turns to |α| ≤ π/2; the signs lost are those of a whole
//! orbit, and no product of signs depends on them.

use std::f64::consts::FRAC_PI_2;

use num_traits::ToPrimitive;

use crate::number::{Ball, Real, Sign};
use crate::propagator::TwoClocks;

/// Working precision of the constants; they end as doubles.
const BITS: u32 = 192;

/// What the updates need to know of the base clock alone. Every double has a relative error of at most 2u,
/// u = 2^-53, unless its comment says otherwise.
#[derive(Clone, Debug)]
pub struct Base {
    /// tan(θ/2).
    pub slope: f64,
    /// sin θ.
    pub sin: f64,
    /// θ as near as doubles get: for counting turns only.
    pub theta: f64,
    /// The turns by nθ for n = first, first + 1, ...
    turns: Vec<Turn>,
    first: u64,
}

/// The turn by nθ = α + h π with |α| ≤ π/2, up to rounding.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// tan(α/2), within 4u; at most 1.
    pub tan: f64,
    /// sin α, within 4u.
    pub sin: f64,
    /// e^{inθ/2}, each component within 2u.
    pub half: [f64; 2],
    /// h.
    pub half_turns: i64,
}

impl Base {
    /// The base whose kick has the strength s in its own unit of time, with the turns by nθ for n in
    /// `first..=last`; `None` outside 0 < s < 4, its Verlet limit, and where a constant leaves the comfortable
    /// range of doubles.
    pub fn new(s: &Ball, first: u64, last: u64) -> Option<Base> {
        let rest = below_four(s);
        if s.sign() != Some(Sign::Positive) || rest.sign() != Some(Sign::Positive) {
            return None;
        }
        let half = Phase::half(s, &rest)?;
        let Phase { re: cos_half, im: sin_half } = &half;
        let theta = 2.0 * sin_half.mid_f64().atan2(cos_half.mid_f64());
        Some(Base {
            slope: ordinary(&sin_half.div(cos_half, BITS)?)?,
            sin: ordinary(&sin_half.mul(cos_half, BITS).scale2(1))?,
            theta,
            turns: turns(&half, theta, first, last)?,
            first,
        })
    }

    /// The turn by nθ.
    pub fn turn(&self, n: u64) -> &Turn {
        &self.turns[(n - self.first) as usize]
    }
}

/// Entries of the table of turns between two that come from multiple precision.
const ANCHOR: u64 = 32;

/// Entries between two anchors that are powers of their own.
const POWER: u64 = 64 * ANCHOR;

/// The turns by nθ for n in `first..=last`.
///
/// e^{inθ/2} in units of 2^-62: from one anchor to the next by multiplication with e^{iθ/2}. Cutting off costs
/// √2 units a product and the factor's own error as much, so within 32 steps the error is below 91 units,
/// 0.18u; rounding to a double adds u. Anchors follow from one another by products of balls, whose radii may grow by
/// √2 each time: every 64th is a power made anew.
fn turns(half: &Phase, theta: f64, first: u64, last: u64) -> Option<Vec<Turn>> {
    let (step, mut anchor) = (half.fixed()?, Phase::one());
    let leap = if last - first >= ANCHOR { half.power(ANCHOR) } else { Phase::one() };
    let mut table = Vec::with_capacity((last - first) as usize + 1);
    let mut now = [0, 0];
    for n in first..=last {
        if (n - first).is_multiple_of(ANCHOR) {
            anchor = if (n - first).is_multiple_of(POWER) { half.power(n) } else { anchor.times(&leap) };
            now = anchor.fixed()?;
        }
        table.push(Turn::new(now.map(|x| x as f64 * UNIT), n as f64 * theta));
        now = times(now, step);
    }
    Some(table)
}

/// 2^-62.
const UNIT: f64 = 1.0 / (1u64 << 62) as f64;

fn times([a, b]: [i64; 2], [c, d]: [i64; 2]) -> [i64; 2] {
    let product = |x: i64, y: i64| i128::from(x) * i128::from(y);
    [((product(a, c) - product(b, d)) >> 62) as i64, ((product(a, d) + product(b, c)) >> 62) as i64]
}

impl Turn {
    /// From e^{inθ/2} = cos + i sin, whose components are within 0.18u and one rounding.
    ///
    /// sin α = 2 sin cos: 2u · |2 sin cos| + 2 · 0.18u · √2 + u ≤ 3.6u. tan(α/2) = sin/cos where that is at most
    /// 1: then cos ≥ 0.7, each of both is within 1.26u relatively beside 0.26u: 3.6u in all.
    fn new([cos, sin]: [f64; 2], angle: f64) -> Turn {
        // The nearest h of the parity that the octant tells.
        let odd = sin.abs() > cos.abs();
        let shift = f64::from(u8::from(odd));
        let half_turns = 2 * ((angle / (2.0 * FRAC_PI_2) - shift) / 2.0).round() as i64 + i64::from(odd);
        let (tan, sign) = if odd { (-cos / sin, -2.0) } else { (sin / cos, 2.0) };
        Turn { tan, sin: sign * sin * cos, half: [cos, sin], half_turns }
    }
}

/// One pair's half period on its base: the other clock's kicks strike at the multiples of p/q base steps.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    pub base: &'a Base,
    /// Their strength k in the base's unit of time, relative error at most 3u.
    pub kick: f64,
    /// ⌊p/q⌋.
    pub whole: u64,
    /// p mod q and q, or the same multiple of both; below 2^50.
    pub rest: u64,
    pub modulus: u64,
    /// p and q themselves, modulo 2.
    pub p_odd: bool,
    pub q_even: bool,
    /// ⌊q/2⌋: the updates after the half kick at t = 0; the last is half a kick if q is even.
    pub updates: u64,
}

impl Pair<'_> {
    /// The n of the turn by nθ/2 that is left after the last update, if any: at T/2 the base has turned by pθ/2, of
    /// which θ/2 is in P and ⌊⌊q/2⌋ p/q⌋ θ is in the updates.
    #[inline]
    pub fn left(&self) -> Option<u64> {
        match (self.q_even, self.updates) {
            (true, _) => None,
            (false, 0) => Some(self.whole - 1),
            // The integer of p's parity in (p/q, p/q + 2), less one.
            (false, _) => Some(self.whole + u64::from((self.whole + 1).is_multiple_of(2) == self.p_odd)),
        }
    }
}

/// One pair with a base of its own.
#[derive(Clone, Debug)]
pub struct Floquet {
    base: Base,
    p: u64,
    q: u64,
    kick: f64,
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

    /// The pair.
    pub fn pair(&self) -> Pair<'_> {
        Pair {
            base: &self.base,
            kick: self.kick,
            whole: self.p / self.q,
            rest: self.p % self.q,
            modulus: self.q,
            p_odd: self.p % 2 == 1,
            q_even: self.q.is_multiple_of(2),
            updates: self.q / 2,
        }
    }

    /// With the first clock as the base.
    fn on_base<S: Real>(clocks: &TwoClocks<S>) -> Option<Floquet> {
        let (p, q, whole) = (clocks.p(), clocks.q(), clocks.p() / clocks.q());
        let base = Base::new(&clocks.fast().enclosure(BITS), whole.saturating_sub(1), whole + 1)?;
        let kick = ordinary(&clocks.slow().enclosure(BITS))?;
        (q < 1 << 50).then_some(Floquet { base, p, q, kick })
    }
}

/// The signs of cos(nθ/2) and sin(nθ/2), as far as they are certain; `None` outside 0 < s < 4.
pub fn turn_signs(s: &Ball, n: u64) -> Option<[Option<Sign>; 2]> {
    let turned = Phase::half(s, &below_four(s))?.power(n);
    Some([turned.re.sign(), turned.im.sign()])
}

/// 4 − s.
fn below_four(s: &Ball) -> Ball {
    Ball::from_integer(&4.into()).sub(s, BITS)
}

/// e^{iα} in multiple precision.
struct Phase {
    re: Ball,
    im: Ball,
}

impl Phase {
    /// e^{iθ/2} = (√(4 − s) + i √s)/2, `rest` being 4 − s; `None` where a root is none.
    fn half(s: &Ball, rest: &Ball) -> Option<Phase> {
        Some(Phase { re: rest.sqrt(BITS)?.scale2(-1), im: s.sqrt(BITS)?.scale2(-1) })
    }

    fn one() -> Phase {
        Phase { re: Ball::one(), im: Ball::zero() }
    }

    fn times(&self, other: &Phase) -> Phase {
        let product = |x: &Ball, y: &Ball| x.mul(y, BITS);
        Phase {
            re: product(&self.re, &other.re).sub(&product(&self.im, &other.im), BITS),
            im: product(&self.re, &other.im).add(&product(&self.im, &other.re), BITS),
        }
    }

    fn power(&self, mut n: u64) -> Phase {
        let mut result = Phase::one();
        let mut square = Phase { re: self.re.clone(), im: self.im.clone() };
        while n > 0 {
            if n & 1 == 1 {
                result = result.times(&square);
            }
            square = square.times(&square);
            n >>= 1;
        }
        result
    }

    /// Both components in units of 2^-62, cut off; `None` where they are not known that well.
    fn fixed(&self) -> Option<[i64; 2]> {
        let component = |x: &Ball| {
            let sharp = x.radius_log2().is_none_or(|log2| log2 < -80);
            sharp.then(|| x.mid_scaled(62).0.to_i64()).flatten()
        };
        Some([component(&self.re)?, component(&self.im)?])
    }
}

/// A double next to the midpoint, where that has a relative error of at most 2u: the ball is tight and the
/// number is not 0 and far from the ends of the double's range.
pub fn ordinary(x: &Ball) -> Option<f64> {
    const TINY: f64 = 1e-30;
    let value = x.mid_f64();
    let in_range = value.abs() > TINY && value.abs() < 1.0 / TINY;
    (in_range && x.relative_accuracy_bits() >= 60).then_some(value)
}
