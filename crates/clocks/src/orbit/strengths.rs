//! The constants of many pairs at a time, from the strengths of their kicks in doubles.
//!
//! The coordinates are those of [`super::floquet`]; the base's are made of two doubles each, lane by lane
//! without a branch, so that they cost a pair less than its updates do.

use super::floquet::{LARGEST_MODULUS, LONGEST_QUICK, NEAR_LIMIT, Phase, TINY, shears, within_range};
use super::lanes::{Constants, InLanes};
use number::Twofold;
use number::vector::{each, largest};

/// A pair in doubles: the other clock's kicks strike at the multiples of p/q base steps.
#[derive(Clone, Copy, Debug)]
pub struct Strengths {
    /// The base's own, within 2^-99.
    pub s: Twofold,
    /// The other clock's in the base's unit of time, within 3u.
    pub kick: f64,
    /// Whole numbers.
    pub p: f64,
    pub q: f64,
}

impl Strengths {
    /// Whether doubles serve it: not near the base's Verlet limit or beyond it, where 4 − s has lost digits,
    /// nor far from ordinary numbers.
    #[inline(always)]
    pub fn serves(&self) -> bool {
        let Strengths { s: Twofold { hi: s, .. }, kick, p, q } = *self;
        let strong = (TINY..=NEAR_LIMIT).contains(&s) & within_range(kick);
        // p/q in doubles is at least the whole number ⌊p/q⌋.
        strong
            & (p < LARGEST_MODULUS as f64)
            & (q < LARGEST_MODULUS as f64)
            & (p / q + 1.0 < LONGEST_QUICK as f64)
    }

    /// The first where the condition holds, else the second: by bits, without a branch.
    #[inline(always)]
    pub fn either(condition: bool, first: Strengths, second: Strengths) -> Strengths {
        let of = |part: fn(&Strengths) -> f64| chosen(condition, part(&first), part(&second));
        Strengths {
            s: Twofold { hi: of(|x| x.s.hi), lo: of(|x| x.s.lo) },
            kick: of(|x| x.kick),
            p: of(|x| x.p),
            q: of(|x| x.q),
        }
    }

    /// How many classes there are.
    pub const CLASSES: u32 = 8;

    /// How strong a foreign kick is, in powers of four of β² = (k / sin θ)², 0 (below 2^-9) to 7 (from 2^3
    /// on), as near as doubles get: a group looks at |g| as often as its strongest pair wants.
    #[inline(always)]
    pub fn class(&self) -> u32 {
        let (above, below) = (4.0 * self.kick * self.kick, self.s.hi * (4.0 - self.s.hi));
        // The difference of two doubles' bits is nearly the logarithm of their quotient.
        let logarithm = (above.to_bits() + (1023 << 52)).saturating_sub(below.to_bits());
        ((logarithm >> 53) as u32).saturating_sub(511 - 5).min(Strengths::CLASSES - 1)
    }

    /// ⌊q/2⌋: the updates after the half kick at t = 0.
    #[inline(always)]
    pub fn updates(&self) -> u64 {
        (0.5 * self.q) as u64
    }
}

/// A pair and its place among others.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    pub strengths: Strengths,
    pub place: u32,
}

/// e^{iα} in each lane, its components in two doubles each: re, im. (In loops: closures as long as these are
/// not made part of what is compiled for an instruction set.)
#[derive(Clone, Copy)]
struct Phases<const L: usize>([[[f64; L]; 2]; 2]);

impl<const L: usize> Phases<L> {
    #[inline(always)]
    fn at(&self, i: usize) -> Phase {
        let two = |n: usize| Twofold { hi: self.0[n][0][i], lo: self.0[n][1][i] };
        Phase { re: two(0), im: two(1) }
    }

    #[inline(always)]
    fn set(&mut self, i: usize, phase: Phase) {
        for (n, two) in [phase.re, phase.im].into_iter().enumerate() {
            (self.0[n][0][i], self.0[n][1][i]) = (two.hi, two.lo);
        }
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let mut product = *self;
        for i in 0..L {
            product.set(i, self.at(i).times(other.at(i)));
        }
        product
    }

    #[inline(always)]
    fn square(&self) -> Self {
        let mut square = *self;
        for i in 0..L {
            square.set(i, self.at(i).square());
        }
        square
    }

    /// `other` in the lanes of odd n.
    #[inline(always)]
    fn or(mut self, other: &Self, n: &[f64; L]) -> Self {
        let odd: [f64; L] = each(|i| parity(n[i]));
        for (values, other) in self.0.as_flattened_mut().iter_mut().zip(other.0.as_flattened()) {
            *values = each(|i| chosen(odd[i] > 0.0, other[i], values[i]));
        }
        self
    }

    /// Each to the power n, a whole number in a double: squared for each of the places of the largest n but
    /// its first, and times itself where its own has a one there.
    #[inline(always)]
    fn power(&self, n: &[f64; L]) -> Self {
        let places = 64 - (largest(n) as u64).leading_zeros();
        let upto = |place: u32| -> [f64; L] {
            let unit = 1.0 / (1u64 << place) as f64;
            each(|i| (n[i] * unit).floor())
        };
        let one = Phases([[[1.0; L], [0.0; L]], [[0.0; L]; 2]]);
        let first = places.saturating_sub(1);
        let mut power = one.or(self, &upto(first));
        for place in (0..first).rev() {
            let square = power.square();
            power = square.or(&square.times(self), &upto(place));
        }
        power
    }

    /// tan(α/2) and sin α of e^{iα/2}, α reduced by half turns.
    #[inline(always)]
    fn shears(&self) -> [[f64; L]; 2] {
        let (mut tan, mut sine) = ([0.0; L], [0.0; L]);
        for i in 0..L {
            (tan[i], sine[i]) = shears(self.at(i).rounded());
        }
        [tan, sine]
    }
}

/// One of two numbers, by their bits: compilers would choose between their places and gather them one by one.
#[inline(always)]
fn chosen(first: bool, a: f64, b: f64) -> f64 {
    let mask = u64::from(first).wrapping_neg();
    f64::from_bits((a.to_bits() & mask) | (b.to_bits() & !mask))
}

/// 1 for odd whole numbers, 0 for even ones.
#[inline(always)]
fn parity(n: f64) -> f64 {
    n - 2.0 * (0.5 * n).floor()
}

impl InLanes for Placed {
    #[inline(always)]
    fn constants<const L: usize>(pairs: &[Self]) -> (Constants<L>, [[f64; L]; 2]) {
        let (mut p, mut q, mut kick, mut s) = ([0.0; L], [0.0; L], [0.0; L], [[0.0; L]; 2]);
        for i in 0..L {
            let pair = &pairs[i.min(pairs.len() - 1)].strengths;
            (p[i], q[i], kick[i]) = (pair.p, pair.q, pair.kick);
            (s[0][i], s[1][i]) = (pair.s.hi, pair.s.lo);
        }
        let odd: [[f64; L]; 2] = [each(|i| parity(p[i])), each(|i| parity(q[i]))];
        // Doubles divide whole numbers below 2^50 as integers: if p/q is no integer, its distance to the next
        // integer is at least 1/q.
        let whole: [f64; L] = each(|i| (p[i] / q[i]).floor());
        let rest = each(|i| (-whole[i]).mul_add(q[i], p[i]));
        let (mut half, mut back) = (Phases([[[0.0; L]; 2]; 2]), Phases([[[0.0; L]; 2]; 2]));
        for (i, (&hi, &lo)) in s[0].iter().zip(&s[1]).enumerate() {
            let phase = Phase::half(Twofold { hi, lo });
            half.set(i, phase);
            back.set(i, phase.conjugate());
        }
        let now = half.power(&whole);
        let after = now.times(&half);
        // Asked for by q = 1 alone.
        let before = if q.contains(&1.0) { now.times(&back) } else { now };
        let ([tan, sine], [carried_tan, carried_sine]) = (now.shears(), after.shears());
        let (mut slope, mut sin) = ([0.0; L], [0.0; L]);
        for i in 0..L {
            let half = half.at(i);
            (slope[i], sin[i]) = (half.tan().hi, half.sin_of_twice().hi);
        }
        // The last turn is by nθ/2: of q = 1 with n = ⌊p/q⌋ − 1, else with the integer of p's parity in (p/q,
        // p/q + 2) less one.
        let above: [f64; L] = each(|i| parity(whole[i] + 1.0));
        let component = |n: usize| -> [f64; L] {
            each(|i| {
                let next = if above[i] == odd[0][i] { now.0[n][0][i] } else { after.0[n][0][i] };
                let last = if q[i] == 1.0 { before.0[n][0][i] } else { next };
                if odd[1][i] > 0.0 { last } else { 1.0 - n as f64 }
            })
        };
        let left = [component(0), component(1)];
        let updates = each(|i| (0.5 * q[i]).floor());
        let last_kick = each(|i| if odd[1][i] > 0.0 { 1.0 } else { 0.5 });
        let (tan, sine) = ([tan, carried_tan], [sine, carried_sine]);
        (Constants { kick, slope, sin, modulus: q, rest, tan, sine, updates, last_kick }, left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::floquet::{Base, Pair};
    use number::{Ball, Ratio, U, ratio};
    use proptest::prelude::*;

    proptest! {
        /// Against the constants from multiple precision, each within what both are said to be off.
        #[test]
        fn constants_are_as_near_as_they_say(
            all in prop::collection::vec((1i64..1 << 40, any::<bool>(), 1u64..1 << 20, 1u64..1 << 20, 0u32..20), 1..17),
        ) {
            let pairs: Vec<(Ball, Ratio, Strengths)> = all
                .iter()
                .filter_map(|&(a, close, p, q, short)| {
                    let s = if close { ratio((4 << 60) - (a << 2), 1 << 60) } else { ratio(a, 1 << 38) };
                    let steps = Ratio::new(p, q >> short).ok()?;
                    let (p, q) = (steps.p() as f64, steps.q() as f64);
                    let strengths = Strengths { s: Twofold::from_rational(&s), kick: 1.0, p, q };
                    strengths.serves().then(|| (Ball::from_rational(&s, 300), steps, strengths))
                })
                .collect();
            prop_assume!(!pairs.is_empty());
            let placed = |(_, _, strengths): &(_, _, Strengths)| Placed { strengths: *strengths, place: 0 };
            let (found, left) = Placed::constants::<16>(&pairs.iter().map(placed).collect::<Vec<_>>());
            for (i, (s, steps, _)) in pairs.iter().enumerate() {
                let (p, q) = steps.terms();
                let whole = p / q;
                let base = Base::new(s, whole.saturating_sub(1), whole + 1).unwrap();
                let near = |a: f64, b: f64, units: f64| (a - b).abs() <= units * U;
                prop_assert!(near(found.slope[i], base.slope, 4.0 * base.slope));
                prop_assert!(near(found.sin[i], base.sin, 4.0 * base.sin));
                for carry in [0, 1] {
                    let turn = base.turn(whole + carry as u64);
                    // At |tan| = 1 the octants meet, and either is right.
                    let same = near(found.tan[carry][i], turn.tan, 8.0) && near(found.sine[carry][i], turn.sin, 8.0);
                    prop_assert!(same || turn.tan.abs() > 1.0 - 8.0 * U);
                }
                let pair = Pair {
                    base: &base, kick: 1.0, whole, rest: p % q, modulus: q, p_odd: p % 2 == 1, q_even: q % 2 == 0, updates: q / 2,
                };
                prop_assert_eq!((found.rest[i], found.updates[i]), (pair.rest as f64, pair.updates as f64));
                let [cos, sin] = pair.left().map_or([1.0, 0.0], |n| base.turn(n).half);
                prop_assert!(near(left[0][i], cos, 2.4) && near(left[1][i], sin, 2.4));
            }
        }
    }
}
