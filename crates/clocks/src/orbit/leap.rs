//! Long runs of one clock's steps: a power of one step's matrix, by squaring, in balls.
//!
//! Between two kicks of the slower clock the faster one, the *base*, strikes n times, and its step (drift,
//! then kick) is one matrix M of determinant 1. So n steps cost some 2 log₂ n products of matrices instead of
//! n kicks. Each squaring widens the balls by a few units, which a few more bits make good.
//!
//! The sign changes of x over m steps, from x₀ to x_m, follow from the two signs: with s the base's strength
//! in its own unit of time and cos θ = 1 − s/2,
//!
//! * 0 < s < 4: x_j = R cos(φ + jθ), which crosses 0 ⌊mθ/π⌋ times or once more; its parity is that of the two
//!   signs;
//! * s ≥ 4: (−1)^j x_j is a sum of two exponentials of one base, or linear, and changes its sign once at
//!   most: m changes or m − 1, by the same parity.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::ToPrimitive;

use super::balls::BallOrbit;
use super::ends::{End, Ends};
use crate::propagator::TwoClocks;
use crate::schedule::{KickDrift, Schedule};
use number::{Ball, Ratio, Rational, Real, Sign};

/// From so many base steps between two kicks of the other clock on, powers are cheaper than kicks whatever
/// the bits.
const LONG_RUN: u64 = 1000;

/// x is near 0 at one strike, hardly at two in a row, never at three.
const NEAR_ZERO: u64 = 3;

/// Whether the base strikes so often between two kicks of the other clock that leaping pays.
pub fn is_worth(ratio: Ratio) -> bool {
    let (p, q) = ratio.terms();
    p.max(q) / p.min(q) >= LONG_RUN
}

/// The cost of a run in kicks: products of matrices, between two kicks of the other clock.
pub fn kicks(ratio: Ratio) -> u64 {
    const MATRICES: u64 = 8 * 2 * 64;
    MATRICES.saturating_add(ratio.p().min(ratio.q()).saturating_mul(16))
}

/// The even and the odd solution at T/2; no condition, enclosures as wide as `bits` bits make them.
pub fn run<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule, bits: u32) -> Ends {
    let mut leaps = Leaps::new(clocks, schedule, bits);
    Ends { even: leaps.end([1, 0]), odd: leaps.end([0, 1]) }
}

/// [[a, b], [c, d]]
pub(super) type Matrix = [Ball; 4];

/// How the base alone moves.
enum Turn {
    /// θ/π, for 0 < s < 4.
    By(Ball),
    /// s ≥ 4: no rotation.
    None,
}

struct Leaps<'a> {
    schedule: &'a Schedule,
    bits: u32,
    /// The steps of the base and of the other clock, in ticks.
    base: u64,
    other: u64,
    /// The strengths of the base, of the other clock and of both.
    strengths: [Ball; 3],
    /// `None` where these bits cannot decide it.
    turn: Option<Turn>,
    /// A step's matrix, and powers of it that were made already.
    step: Matrix,
    powers: Vec<(u64, Matrix)>,
}

impl<'a> Leaps<'a> {
    fn new<S: Real>(clocks: &TwoClocks<S>, schedule: &'a Schedule, bits: u32) -> Self {
        let [first, second] = [0, 1].map(|k| schedule.clocks()[k].step());
        let [fast, slow, both] = clocks.enclosures(bits);
        let (base, other, strengths) = if first <= second {
            (first, second, [fast, slow, both])
        } else {
            (second, first, [slow, fast, both])
        };
        let time = BallOrbit::new([0, 0], schedule, bits).time(base);
        let s = strengths[0].mul(&time, bits);
        // x ← x + t v, then v ← v − k x.
        let step = [Ball::one(), time, strengths[0].neg(), Ball::one().sub(&s, bits)];
        Leaps { schedule, bits, base, other, turn: turn(&s, bits), strengths, step, powers: Vec::new() }
    }

    fn end(&mut self, start: [u8; 2]) -> End {
        let mut orbit = BallOrbit::new(start, self.schedule, self.bits);
        let [base, other, both] = self.strengths.clone();
        let (mut now, end) = (0, self.schedule.period() / 2);
        orbit.arrive();
        orbit.kick(&both.scale2(-1));
        while now < end {
            let next = ((now / self.other + 1) * self.other).min(end);
            // The base's strikes strictly between.
            let (first, last) = (now / self.base + 1, next.div_ceil(self.base) - 1);
            if first <= last {
                orbit.drift(first * self.base - now);
                orbit.arrive();
                orbit.kick(&base);
                self.leap(&mut orbit, last - first);
                now = last * self.base;
            }
            orbit.drift(next - now);
            orbit.arrive();
            now = next;
            let strength = match (now.is_multiple_of(self.base), now.is_multiple_of(self.other)) {
                (true, true) => &both,
                (true, false) => &base,
                (false, true) => &other,
                (false, false) => break,
            };
            orbit.kick(&if now == end { strength.scale2(-1) } else { strength.clone() });
        }
        orbit.end()
    }

    /// `steps` steps: a few one by one until x has a certain sign, then all at once but for the last few,
    /// before which x is near 0 again.
    fn leap(&mut self, orbit: &mut BallOrbit, steps: u64) {
        let mut left = steps;
        for _ in 0..NEAR_ZERO.min(steps) {
            if orbit.nodes.last_certain().is_some() {
                break;
            }
            self.step(orbit);
            left -= 1;
        }
        for rest in 0..NEAR_ZERO.min(left) {
            let mut next = self.moved(orbit, left - rest);
            let signs = orbit.nodes.last_certain().zip(next.sign());
            if signs.is_none() && rest + 1 < NEAR_ZERO.min(left) {
                continue;
            }
            let changes = signs.and_then(|(before, after)| self.changes(left - rest, before != after));
            next.nodes.pass(changes, next.sign());
            (*orbit, left) = (next, rest);
            break;
        }
        (0..left).for_each(|_| self.step(orbit));
    }

    fn step(&self, orbit: &mut BallOrbit) {
        orbit.drift(self.base);
        orbit.arrive();
        orbit.kick(&self.strengths[0]);
    }

    /// The orbit after n steps, its sign changes not counted yet.
    fn moved(&mut self, orbit: &BallOrbit, n: u64) -> BallOrbit {
        let ([a, b, c, d], bits) = (self.power(n), self.bits);
        let row = |m: &Ball, n: &Ball| m.mul(&orbit.x, bits).add(&n.mul(&orbit.v, bits), bits);
        orbit.at(row(&a, &b), row(&c, &d))
    }

    /// The sign changes of x over so many steps, odd or even in number; `None` where it is not known.
    fn changes(&self, steps: u64, is_odd: bool) -> Option<u64> {
        let fits = |n: &u64| n.is_odd() == is_odd;
        let turn = match self.turn.as_ref()? {
            Turn::By(turn) => turn,
            Turn::None => return [steps, steps.checked_sub(1)?].into_iter().find(fits),
        };
        let turns = turn.mul(&Ball::from_integer(&BigInt::from(steps)), self.bits);
        let whole = |x: Rational| x.floor().to_integer().to_u64();
        let (least, most) = (whole(turns.lower())?, whole(turns.upper())? + 1);
        let mut possible = (least..=most.min(least + 2)).filter(fits);
        possible.next().filter(|_| possible.next().is_none() && most <= least + 2)
    }

    /// Mⁿ by squaring.
    fn power(&mut self, n: u64) -> Matrix {
        if let Some((_, known)) = self.powers.iter().find(|(m, _)| *m == n) {
            return known.clone();
        }
        let mut result = [Ball::one(), Ball::zero(), Ball::zero(), Ball::one()];
        for bit in (0..64 - n.leading_zeros()).rev() {
            result = product(&result, &result, self.bits);
            if n >> bit & 1 == 1 {
                result = product(&self.step, &result, self.bits);
            }
        }
        // Two lengths of runs alternate, and each may be cut twice.
        self.powers.truncate(5);
        self.powers.insert(0, (n, result.clone()));
        result
    }
}

/// How a base of strength s in its own unit of time turns; `None` where the ball cannot decide it.
fn turn(s: &Ball, bits: u32) -> Option<Turn> {
    let beyond = s.sub(&Ball::from_integer(&4.into()), bits);
    match (s.sign()?, beyond.sign()?) {
        (Sign::Positive, Sign::Negative) => {
            let cosine = Ball::one().sub(&s.scale2(-1), bits);
            Some(Turn::By(cosine.acos(bits)?.div(&Ball::pi(bits), bits)?))
        }
        (Sign::Positive, _) => Some(Turn::None),
        _ => None,
    }
}

pub(super) fn product(m: &Matrix, n: &Matrix, bits: u32) -> Matrix {
    let [a, b, c, d] = m;
    let row = |x: &Ball, y: &Ball, i: usize| x.mul(&n[i], bits).add(&y.mul(&n[i + 2], bits), bits);
    [row(a, b, 0), row(a, b, 1), row(c, d, 0), row(c, d, 1)]
}

#[cfg(test)]
mod tests {
    use super::super::refine;
    use super::*;
    use number::ratio;

    /// Both routes at these bits: signs, label and enclosures agree.
    fn agree(p: u64, q: u64, s: Rational, rho: Rational) {
        let own = Ratio::new(p, q).unwrap();
        let clocks = TwoClocks::with_rho(own, s.clone(), rho.clone());
        let schedule = Schedule::two_clocks(own).unwrap();
        let (leapt, stepped) = (run(&clocks, &schedule, 400), refine::run(&clocks, &schedule, 400).unwrap());
        for (one, other) in [(&leapt.even, &stepped.even), (&leapt.odd, &stepped.odd)] {
            let name = format!("p/q = {own}, s = {s}, rho = {rho}");
            assert!(one.x.compare(&other.x).is_none() || one.x.sign() == Some(Sign::Zero), "{name}");
            assert!(one.v.compare(&other.v).is_none() || one.v.sign() == Some(Sign::Zero), "{name}");
            if one.signs.0.is_some_and(|sign| sign != Sign::Zero) {
                assert_eq!(one.signs.0, other.signs.0, "{name}");
            }
            if let (Some(count), Some(known)) = (one.nodes, other.nodes) {
                assert_eq!(count, known, "sign changes, {name}");
            }
        }
        let base = if p > q { s } else { s * rho * ratio((p * p) as i64, (q * q) as i64) };
        let counted = leapt.even.nodes.is_some() || leapt.odd.nodes.is_some();
        assert!(counted || base == ratio(4, 1), "{own}, {base}: no count");
    }

    #[test]
    fn leaps_and_kicks_agree_in_values_signs_and_sign_changes() {
        for (p, q) in [(1000, 1), (1, 1001), (2003, 2), (3001, 3), (3, 4001), (5003, 4)] {
            for s in
                [ratio(1, 1), ratio(2, 1), ratio(31, 10), ratio(1, 1_000_000), ratio(4, 1), ratio(41, 10)]
            {
                // The strength of the base in its own unit is s for p > q; else ρ sets it.
                for rho in [ratio(1, 25), ratio(3, 7), ratio(1, 1_000_000)] {
                    let s = if p > q { s.clone() } else { &s * ratio((q * q) as i64, (p * p) as i64) / &rho };
                    agree(p, q, s, rho);
                }
            }
        }
    }
}
