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
//! `foreign_ticks` in proofs/). With g = re + i·im and B = β cos²(θ/2) = k / (2 tan(θ/2)) that is three
//! shears,
//!
//! ```text
//!     re ← re - T im,      im ← im + B re,      re ← re + T im,
//! ```
//!
//! and so is a turn by α: re ← re − tan(α/2) im, im ← im + sin(α) re, re ← re − tan(α/2) im. A shear of re
//! follows a shear of re, so from kick to kick four remain: the base between two kicks acts as one kick
//! between two drifts. Turns by nθ are reduced by half turns to |α| ≤ π/2; the signs lost are those of a
//! whole orbit, and no product of signs depends on them.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use crate::propagator::TwoClocks;
use number::{Ball, Real, Sign, Twofold};

/// Bits of the strengths; the constants are made of two doubles each and end as one.
const BITS: u32 = 192;

/// The constants of the updates that depend on the base clock alone. Every double has a relative error of at
/// most 2u, u = 2^-53, unless its comment says otherwise.
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
    /// `first..=last`; `None` outside 0 < s < 4, its Verlet limit, and where a constant leaves the
    /// comfortable range of doubles.
    pub fn new(s: &Ball, first: u64, last: u64) -> Option<Base> {
        let rest = below_four(s);
        if s.sign() != Some(Sign::Positive) || rest.sign() != Some(Sign::Positive) {
            return None;
        }
        let half = Phase { re: root_of_quarter(&rest)?, im: root_of_quarter(s)? };
        let start =
            if last < LONGEST { half.power(first) } else { Phase::of(&Sharp::half(s, &rest)?.power(first))? };
        Base::of(half, start, first..=last)
    }

    /// Computes the base many times faster, from s in two doubles, within 2^-99. Also `None` so near 4 that 4
    /// − s has lost digits, and for long turns.
    ///
    /// 4 − s is within 2^-97 and at least 2^-20, so its root is within 2^-88, a half of that and e^{iθ/2}
    /// within 2^-88, and e^{inθ/2} within n 2^-87: for n below 2^28 less than 2^-59.
    fn quick((hi, lo): (f64, f64), first: u64, last: u64) -> Option<Base> {
        if !(TINY..=NEAR_LIMIT).contains(&hi) || last >= LONGEST_QUICK {
            return None;
        }
        let half = Phase::half(Twofold { hi, lo });
        Base::of(half, half.power(first), first..=last)
    }

    /// From e^{iθ/2} and e^{inθ/2} for the first n.
    fn of(half: Phase, start: Phase, steps: RangeInclusive<u64>) -> Option<Base> {
        let theta = 2.0 * half.im.hi.atan2(half.re.hi);
        Some(Base {
            slope: comfortable(half.tan())?,
            sin: comfortable(half.sin_of_twice())?,
            theta,
            first: *steps.start(),
            turns: turns(half, start, theta, steps),
        })
    }

    /// The turn by nθ.
    pub fn turn(&self, n: u64) -> &Turn {
        &self.turns[(n - self.first) as usize]
    }

    /// Those by nθ and (n + 1)θ.
    #[inline(always)]
    pub fn turns_from(&self, n: u64) -> &[Turn; 2] {
        self.turns[(n - self.first) as usize..]
            .first_chunk()
            .expect("a table reaches beyond its pairs' turns")
    }
}

/// e^{iα} in two doubles a component.
#[derive(Clone, Copy)]
pub(super) struct Phase {
    pub re: Twofold,
    pub im: Twofold,
}

impl Phase {
    pub const ONE: Phase = Phase { re: Twofold { hi: 1.0, lo: 0.0 }, im: Twofold::ZERO };

    /// To within 2^-97 absolutely.
    fn of(sharp: &Sharp) -> Option<Phase> {
        let component = |x: &Ball| Twofold::from_fixed(x, 100, 4);
        Some(Phase { re: component(&sharp.re)?, im: component(&sharp.im)? })
    }

    /// e^{iθ/2} = (√(4 − s) + i √s)/2 of the strength s.
    #[inline(always)]
    pub fn half(s: Twofold) -> Phase {
        let rest = Twofold { hi: 4.0, lo: 0.0 }.accurate_difference(s);
        Phase { re: rest.root().half(), im: s.root().half() }
    }

    /// tan α.
    #[inline(always)]
    pub fn tan(self) -> Twofold {
        self.im.divided_by(self.re)
    }

    /// sin 2α.
    #[inline(always)]
    pub fn sin_of_twice(self) -> Twofold {
        self.im.times(self.re).scaled(2.0)
    }

    /// e^{-iα}, exactly.
    #[inline(always)]
    pub fn conjugate(self) -> Phase {
        Phase { re: self.re, im: Twofold { hi: -self.im.hi, lo: -self.im.lo } }
    }

    /// Each component in one double.
    #[inline(always)]
    pub fn rounded(self) -> [f64; 2] {
        [self.re.hi, self.im.hi]
    }

    /// To within 2^-100 absolutely, beside what the factors are off.
    #[inline(always)]
    pub fn times(self, other: Phase) -> Phase {
        let (re, im) = (other.re, other.im);
        Phase {
            re: sum_of_products([self.re, re], [self.im.negative(), im]),
            im: sum_of_products([self.re, im], [self.im, re]),
        }
    }

    /// The real and imaginary part of its square: the two parts of im are one.
    #[inline(always)]
    pub fn square(self) -> Phase {
        let Phase { re, im } = self;
        let twice = Twofold { hi: 2.0 * re.hi, lo: 2.0 * re.lo };
        Phase { re: sum_of_products([re, re], [im.negative(), im]), im: twice.times(im) }
    }

    fn power(self, n: u64) -> Phase {
        (0..64 - n.leading_zeros()).rev().fold(Phase::ONE, |power, bit| {
            let square = power.square();
            if n >> bit & 1 == 1 { square.times(self) } else { square }
        })
    }
}

/// a b + c d to within 22 u² < 2^-101, for |a b| + |c d| ≤ 1 + u: the leading products' sum is known exactly,
/// and what is added to it, within 4 u, is rounded eight times and leaves out two products of u² at most.
#[inline(always)]
fn sum_of_products([a, b]: [Twofold; 2], [c, d]: [Twofold; 2]) -> Twofold {
    let (first, second) = (a.hi * b.hi, c.hi * d.hi);
    let lost = a.hi.mul_add(b.hi, -first) + c.hi.mul_add(d.hi, -second);
    let mixed = a.hi.mul_add(b.lo, a.lo * b.hi);
    let mixed = c.hi.mul_add(d.lo, c.lo.mul_add(d.hi, mixed));
    let sum = Twofold::sum(first, second);
    sum.and(lost + mixed)
}

/// √x/2 to within 2^-100 relatively.
fn root_of_quarter(x: &Ball) -> Option<Twofold> {
    Some(Twofold::from_ball(x)?.root().half())
}

/// [`Pair::modulus`] is below this.
pub(super) const LARGEST_MODULUS: u64 = 1 << 50;

/// [`Base::quick`] takes s up to this, and so many steps.
pub(super) const NEAR_LIMIT: f64 = 4.0 - 2.0 / (1 << 20) as f64;
pub(super) const LONGEST_QUICK: u64 = 1 << 28;

/// Turns by more steps come from multiple precision.
const LONGEST: u64 = 1 << 40;

/// The turns by nθ for n in the range, from the first one on.
///
/// e^{iθ/2} is within 2^-99, and a product costs 2^-100: e^{inθ/2} is within n 2^-98, or within 2^-97 and
/// 2^-98 for each entry after the first. A table has far fewer than 2^40 entries, so this is below 2^-57,
/// less than 0.18u.
fn turns(half: Phase, start: Phase, theta: f64, range: RangeInclusive<u64>) -> Vec<Turn> {
    let mut now = start;
    let turn = |n: u64| {
        let turn = Turn::new(now.rounded(), n as f64 * theta);
        now = now.times(half);
        turn
    };
    range.map(turn).collect()
}

impl Turn {
    /// From e^{inθ/2} = cos + i sin, whose components are within 0.18u and one rounding.
    fn new([cos, sin]: [f64; 2], angle: f64) -> Turn {
        // The nearest h of the parity that the octant gives.
        let odd = sin.abs() > cos.abs();
        let shift = f64::from(u8::from(odd));
        let half_turns = 2 * ((angle / (2.0 * FRAC_PI_2) - shift) / 2.0).round() as i64 + i64::from(odd);
        let (tan, sine) = shears([cos, sin]);
        Turn { tan, sin: sine, half: [cos, sin], half_turns }
    }
}

/// tan(α/2) and sin α from e^{iα/2}, α reduced by half turns.
///
/// Components within 0.18u and one rounding: sin α = 2 sin cos is within 2u · |2 sin cos| + 2 · 0.18u · √2 +
/// u ≤ 3.6u. tan(α/2) is sin/cos where that is at most 1: then cos ≥ 0.7, each of both is within 1.26u
/// relatively beside 0.26u: 3.6u in all.
#[inline(always)]
pub(super) fn shears([cos, sin]: [f64; 2]) -> (f64, f64) {
    let odd = sin.abs() > cos.abs();
    let (over, under, sign) = if odd { (-cos, sin, -2.0) } else { (sin, cos, 2.0) };
    (over / under, sign * sin * cos)
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
    /// The n of the turn by nθ/2 that is left after the last update, if any: at T/2 the base has turned by
    /// pθ/2, of which θ/2 is in P and ⌊⌊q/2⌋ p/q⌋ θ is in the updates.
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
        let (own, other) = (|| Floquet::on_base(clocks), || Floquet::on_base(&clocks.swapped()));
        if clocks.p() >= clocks.q() { own().or_else(other) } else { other().or_else(own) }
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
        let (fast, slow, first, last) = (clocks.fast(), clocks.slow(), whole.saturating_sub(1), whole + 1);
        let quick = fast.two_doubles().and_then(|s| Base::quick(s, first, last));
        let base = quick.or_else(|| Base::new(&fast.enclosure(BITS), first, last))?;
        let near = slow.two_doubles().map(|(kick, _)| kick).filter(|kick| within_range(*kick));
        let kick = near.or_else(|| ordinary(&slow.enclosure(BITS)))?;
        (q < LARGEST_MODULUS).then_some(Floquet { base, p, q, kick })
    }
}

/// The signs of cos(nθ/2) and sin(nθ/2), as far as they are certain; `None` outside 0 < s < 4.
pub fn turn_signs(s: &Ball, n: u64) -> Option<[Option<Sign>; 2]> {
    let turned = Sharp::half(s, &below_four(s))?.power(n);
    Some([turned.re.sign(), turned.im.sign()])
}

/// 4 − s.
fn below_four(s: &Ball) -> Ball {
    Ball::from_integer(&4.into()).sub(s, BITS)
}

/// e^{iα} in multiple precision.
struct Sharp {
    re: Ball,
    im: Ball,
}

impl Sharp {
    /// e^{iθ/2} = (√(4 − s) + i √s)/2, `rest` being 4 − s; `None` where 4 − s or s is negative.
    fn half(s: &Ball, rest: &Ball) -> Option<Sharp> {
        Some(Sharp { re: rest.sqrt(BITS)?.scale2(-1), im: s.sqrt(BITS)?.scale2(-1) })
    }

    fn one() -> Sharp {
        Sharp { re: Ball::one(), im: Ball::zero() }
    }

    fn times(&self, other: &Sharp) -> Sharp {
        let product = |x: &Ball, y: &Ball| x.mul(y, BITS);
        Sharp {
            re: product(&self.re, &other.re).sub(&product(&self.im, &other.im), BITS),
            im: product(&self.re, &other.im).add(&product(&self.im, &other.re), BITS),
        }
    }

    fn power(&self, mut n: u64) -> Sharp {
        let mut result = Sharp::one();
        let mut square = Sharp { re: self.re.clone(), im: self.im.clone() };
        while n > 0 {
            if n & 1 == 1 {
                result = result.times(&square);
            }
            square = square.times(&square);
            n >>= 1;
        }
        result
    }
}

/// The comfortable range of doubles: nothing in it or made of it comes near an end.
pub(super) const TINY: f64 = 1e-30;

fn comfortable(x: Twofold) -> Option<f64> {
    (TINY..1.0 / TINY).contains(&x.hi).then_some(x.hi)
}

/// A double next to the midpoint, where that has a relative error of at most 2u: the ball is tight and the
/// number is not 0 and far from the ends of the double's range.
pub fn ordinary(x: &Ball) -> Option<f64> {
    let value = x.mid_f64();
    (within_range(value) && x.relative_accuracy_bits() >= 60).then_some(value)
}

pub(super) fn within_range(x: f64) -> bool {
    x.abs() > TINY && x.abs() < 1.0 / TINY
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::{Rational, U, ratio};
    use proptest::prelude::*;

    fn ball(x: f64) -> Ball {
        Ball::from_rational(&Rational::from_float(x).unwrap(), 200)
    }

    proptest! {
        /// The error that each constant is said to have at most, in units of u.
        #[test]
        fn constants_are_as_near_as_they_say(
            a in 1i64..1 << 40, first in 0u64..1 << 41, small in any::<bool>(), quick in any::<bool>(), close in any::<bool>(),
        ) {
            let exact = if close { ratio((4 << 60) - (a << 2), 1 << 60) } else { ratio(a, 1 << 38) };
            let s = Ball::from_rational(&exact, 300);
            let first = if small { first % 100 } else { first };
            let base = match quick {
                true => exact.two_doubles().and_then(|s| Base::quick(s, first, first + 70)),
                false => Base::new(&s, first, first + 70),
            };
            let Some(base) = base else { return Ok(()) };
            let half = Sharp::half(&s, &below_four(&s)).unwrap();
            let near = |x: f64, exact: &Ball, most: f64| {
                ball(x).sub(exact, 200).abs().to_f64_enclosure().1 <= most * U
            };
            let slope = half.im.div(&half.re, 200).unwrap();
            prop_assert!(near(base.slope, &slope, 2.0 * base.slope));
            prop_assert!(near(base.sin, &half.re.mul(&half.im, 200).scale2(1), 2.0 * base.sin));
            for n in [first, first + 33, first + 70] {
                let (turn, exact) = (base.turn(n), half.power(n));
                prop_assert!(near(turn.half[0], &exact.re, 1.2) && near(turn.half[1], &exact.im, 1.2));
                // sin nθ and tan(nθ/2) up to half turns.
                let (odd, two) = (turn.half[1].abs() > turn.half[0].abs(), exact.re.mul(&exact.im, 200).scale2(1));
                let sin = if odd { two.neg() } else { two };
                let (over, under) = if odd { (exact.re.neg(), &exact.im) } else { (exact.im.clone(), &exact.re) };
                prop_assert!(near(turn.sin, &sin, 4.0) && near(turn.tan, &over.div(under, 200).unwrap(), 4.0));
            }
        }
    }
}
