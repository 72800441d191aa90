//! The half period in the logarithm of the period: a matrix product over a rotation of the circle, renormalized by Euclid's
//! algorithm (proofs/RETURNS.md).
//!
//! The base's step is the unit of time, s its strength, σ = sin θ = √(s − s²/4), k that of the other clock. Right in the middle
//! of a base's kick, in the coordinates (x, v/σ), the base turns clockwise by θ a step. A kick of the other clock at the offset
//! x behind it, pulled back to it, is with u = 1 − s x/2
//!
//! ```text
//!     K(x) = 1 + k [[u x, σ x²], [−u²/σ, −u x]],
//! ```
//!
//! a polynomial in x. (Beyond the base's own limit, s ≤ 0 and s ≥ 4, the velocity has another unit κ in place of σ, and the base's
//! step is [[c, κ], [−σ²/κ, c]], c = 1 − s/2.) From kick to kick the offset moves by p/q mod 1, and the state by K(x') R(nθ), n = ⌊x + p/q⌋. So the half
//! period is a product of such maps along the orbit of x, half a kick before it, and what is left up to T/2 after it. Winding
//! comes out of the same run: each product has its [`Turn`], so the sign changes of x are known without following them.

mod branch;
mod euclid;
mod map;
mod number;
mod run;
mod series;
mod slow;
mod turn;

use num_traits::ToPrimitive;

use super::ends::{End, Ends};
use super::leap::{Matrix, product};
use crate::number::{Ball, Ratio, Rational, Real, Sign, Twofold};
use crate::propagator::TwoClocks;
use branch::{Branch, Budget};
use map::Map;
use number::{Coefficient, Long, exact};
use std::f64::consts::PI;
use turn::{Turn, direction, principal};

/// The precisions, in bits.
pub const PRECISIONS: [u32; 3] = [53, 106, 256];

/// From so many kicks of each clock on, return maps in doubles are cheaper than the filter's kicks (tests/bench/README.md).
const LONG: u64 = 1 << 16;

/// From so many on, return maps in two doubles are cheaper than kicks in 128 bits.
const LONG_FOR_BITS: u64 = 1 << 9;

/// From so many on, doubles have no digits left.
const TOO_LONG_FOR_DOUBLES: u64 = 1 << 44;

/// Bits of an angle that is multiplied by up to 2^62.
const WHOLE: u32 = 112;

/// |σ²| below which a base beyond its own limit keeps the unit of the velocity.
const LEAST_UNIT: f64 = 1e-3;

/// Whether the period is so long that its return maps are to be tried before its kicks, in doubles or in more bits.
pub fn is_worth(ratio: Ratio, bits: u32) -> bool {
    ratio.p().min(ratio.q()) >= if bits > 53 { LONG_FOR_BITS } else { LONG }
}

/// The half period in numbers of so many bits, or more; `None` where the bound loses all digits, where a partial
/// quotient asks for too many products, and where the work was stopped.
///
/// The base is the clock by which the other one's kicks distort less, or the other where that fails.
pub fn run<S: Real>(clocks: &TwoClocks<S>, bits: u32) -> Option<Ends> {
    let fast = distortion(clocks) <= distortion(&clocks.swapped());
    over(clocks, fast, bits).or_else(|| over(clocks, !fast, bits))
}

/// As [`run`], over the clock that distorts more alone: another route to the same numbers.
pub fn run_over_other<S: Real>(clocks: &TwoClocks<S>, bits: u32) -> Option<Ends> {
    over(clocks, distortion(clocks) > distortion(&clocks.swapped()), bits)
}

/// With the fast or the slow clock as the base.
fn over<S: Real>(clocks: &TwoClocks<S>, fast: bool, bits: u32) -> Option<Ends> {
    match bits {
        0..=53 if clocks.p().min(clocks.q()) > TOO_LONG_FOR_DOUBLES => None,
        0..=53 => over_in::<S, f64>(clocks, fast),
        54..=106 => over_in::<S, Twofold>(clocks, fast),
        107..=256 => over_in::<S, Long<256>>(clocks, fast),
        _ => None,
    }
}

fn over_in<S: Real, T: Coefficient>(clocks: &TwoClocks<S>, fast: bool) -> Option<Ends> {
    if fast {
        return Frame::new::<S, T>(clocks)?.ends::<T>();
    }
    let ends = Frame::new::<S, T>(&clocks.swapped())?.ends::<T>()?;
    Some(in_first_unit(ends, clocks.ratio(), T::BITS))
}

/// The norm of the other clock's kick in the base's coordinates, about; far more where the base is beyond its own limit.
fn distortion<S: Real>(clocks: &TwoClocks<S>) -> f64 {
    let [s, k] = [clocks.fast(), clocks.slow()].map(|x| x.enclosure(53).mid_f64());
    let square = s * (1.0 - 0.25 * s);
    if square > 0.0 { k.abs() / square.sqrt() } else { 1e6 + k.abs() }
}

/// From the unit of time h2 to h1.
fn in_first_unit(mut ends: Ends, ratio: Ratio, bits: u32) -> Ends {
    let of = |ratio: Ratio| Ball::from_rational(&ratio.into(), bits);
    ends.even.v = ends.even.v.mul(&of(ratio.inverse()), bits);
    ends.odd.x = ends.odd.x.mul(&of(ratio), bits);
    ends
}

/// The constants of a pair.
struct Frame {
    p: u64,
    q: u64,
    s: Ball,
    k: Ball,
    /// The unit of the velocity: σ, and beyond the base's own limit √|σ²|, or 1 beside it.
    unit: Ball,
    turning: Option<Turning>,
    bits: u32,
}

/// How a step of the base turns directions.
enum Turning {
    /// 0 < s < 4: by θ/2π, known to so many bits that of n < 2^62 steps' turns the whole ones are.
    By(Ball),
    /// s ≥ 4: a half turn, and (1, 0) stays on its side.
    Half,
    /// s ≤ 0: (1, 0) stays on its side.
    Not,
}

/// A power of the base's step: cos nθ, sin nθ, and the lift.
struct Rotation {
    matrix: Matrix,
    turn: Option<Turn>,
}

impl Frame {
    /// `None` where the bits do not tell on which side of its own limit the base is.
    fn new<S: Real, T: Coefficient>(clocks: &TwoClocks<S>) -> Option<Frame> {
        // Powers of a step lose as many bits as their exponent has.
        let bits = T::BITS + 96;
        let (s, k) = (clocks.fast().enclosure(bits), clocks.slow().enclosure(bits));
        let square = s.sub(&s.square(bits).scale2(-2), bits);
        let elliptic = square.sign()? == Sign::Positive;
        let unit = if elliptic || square.mid_f64().abs() > LEAST_UNIT {
            square.abs().sqrt(bits)?
        } else {
            Ball::one()
        };
        let turning = if elliptic {
            let cosine = Ball::one().sub(&s.scale2(-1), bits).round(WHOLE);
            let theta = cosine.acos(WHOLE);
            theta.and_then(|theta| theta.div(&Ball::pi(WHOLE).scale2(1), WHOLE)).map(Turning::By)
        } else {
            Some(if s.mid_f64() > 2.0 { Turning::Half } else { Turning::Not })
        };
        Some(Frame { p: clocks.p(), q: clocks.q(), s, k, unit, turning, bits })
    }

    /// One step of the base from the middle of a kick to that of the next, [[c, κ], [−σ²/κ, c]], c = 1 − s/2.
    fn step(&self) -> Option<Matrix> {
        let bits = self.bits;
        let cosine = Ball::one().sub(&self.s.scale2(-1), bits);
        let square = self.s.sub(&self.s.square(bits).scale2(-2), bits);
        Some([cosine.clone(), self.unit.clone(), square.div(&self.unit, bits)?.neg(), cosine])
    }

    fn ball(&self, n: i64, d: u64) -> Ball {
        Ball::from_rational(&Rational::new(n.into(), d.into()), self.bits)
    }

    /// n steps of the base.
    fn rotation(&self, n: u64) -> Option<Rotation> {
        let (bits, step) = (self.bits, self.step()?);
        let mut matrix = [Ball::one(), Ball::zero(), Ball::zero(), Ball::one()];
        for bit in (0..64 - n.leading_zeros()).rev() {
            matrix = product(&matrix, &matrix, bits);
            if n >> bit & 1 == 1 {
                matrix = product(&matrix, &step, bits);
            }
        }
        let turn = towards(&matrix[0], &matrix[2]).and_then(|angle| self.turned(n, angle));
        Some(Rotation { matrix, turn })
    }

    /// The turn of n steps of the base that lead (1, 0) into this direction.
    fn turned(&self, n: u64, angle: f64) -> Option<Turn> {
        match self.turning.as_ref()? {
            Turning::By(theta) => {
                // Full turns: −nθ = 2π whole + angle.
                let turns = theta.mul(&Ball::from_integer(&n.into()), WHOLE).neg();
                let fraction = exact(angle).div(&Ball::pi(64).scale2(1), 64)?;
                let whole = turns.sub(&fraction, WHOLE);
                let (lower, upper) = (whole.lower().round(), whole.upper().round());
                (lower == upper).then_some(Turn { whole: lower.to_integer().to_i128()?, angle })
            }
            Turning::Half => {
                // By −nπ, and then by less than a right angle.
                let half = if n.is_multiple_of(2) { 0.0 } else { -PI };
                let beside = principal(angle - half);
                Some(Turn { whole: -i128::from(n / 2), ..Turn::NONE }.on(half + beside, angle))
            }
            Turning::Not => Some(Turn { whole: 0, angle }),
        }
    }

    /// The terms of N(m + w t), K = 1 + k N.
    fn nilpotent(&self, m: &Ball, w: &Ball) -> [Matrix; 3] {
        let (bits, zero, one) = (self.bits, Ball::zero(), Ball::one());
        let half = self.s.scale2(-1).neg();
        let quarter = self.s.square(bits).scale2(-2);
        // Polynomials in x.
        let u_x = [zero.clone(), one.clone(), half];
        let square = [zero.clone(), zero, self.unit.clone()];
        let over = |x: Ball| x.div(&self.unit, bits).expect("a positive unit").neg();
        let slope = [over(one), over(self.s.neg()), over(quarter)];
        let at = |[c, b, a]: &[Ball; 3]| {
            let a_m = a.mul(m, bits);
            let value = a_m.add(b, bits).mul(m, bits).add(c, bits);
            let first = a_m.scale2(1).add(b, bits).mul(w, bits);
            [value, first, a.mul(&w.square(bits), bits)]
        };
        let (u_x, square, slope) = (at(&u_x), at(&square), at(&slope));
        std::array::from_fn(|j| [u_x[j].clone(), square[j].clone(), slope[j].clone(), u_x[j].neg()])
    }

    /// K(x) R(nθ), x from middle − half to middle + half, both in units of 1/2q.
    fn branch<T: Coefficient>(&self, middle: u64, half: u64, steps: u64) -> Option<Map<T>> {
        let bits = self.bits;
        let unit = |n: u64| self.ball(n as i64, self.q).scale2(-1);
        let rotation = self.rotation(steps)?;
        let mut terms = self.nilpotent(&unit(middle), &unit(half));
        terms.iter_mut().flatten().for_each(|x| *x = x.mul(&self.k, bits));
        for diagonal in [0, 3] {
            terms[0][diagonal] = terms[0][diagonal].add(&Ball::one(), bits);
        }
        let terms = terms.map(|term| product(&term, &rotation.matrix, bits));
        let turn = rotation.turn.zip(towards(&terms[0][0], &terms[0][2]));
        Some(Map::new(&terms, turn.map(|(turn, angle)| turn.sheared(self.is_clockwise(), angle))))
    }

    /// A positive kick turns clockwise, between a drift and its inverse, too.
    fn is_clockwise(&self) -> bool {
        self.k.sign() != Some(Sign::Negative)
    }

    fn branches<T: Coefficient>(&self) -> Option<[Branch<T>; 2]> {
        let (whole, b) = (self.p / self.q, self.p % self.q);
        let a = self.q - b;
        let left = self.branch(2 * b + a, a, whole)?;
        let right = self.branch(b, b, whole + 1)?;
        let [a, b] = [a as i64, b as i64];
        Some([
            Branch { map: left, start: 0, length: a, stride: b, height: 1 },
            Branch { map: right, start: a, length: b, stride: -a, height: 1 },
        ])
    }

    /// The even and the odd solution at T/2.
    fn ends<T: Coefficient>(&self) -> Option<Ends> {
        let n = self.q / 2;
        let mut budget = Budget(T::PRODUCTS);
        let middle = if n == 0 {
            Map::identity()
        } else {
            let [left, right] = self.branches::<T>()?;
            euclid::walk(left, right, n, &mut budget)?.0
        };
        if middle.exponent.unsigned_abs() > 1 << 54 {
            return None;
        }
        let (bits, unit) = (self.bits, &self.unit);
        // Half a kick of the other clock at t = 0.
        let start = self.k.div(unit, bits)?.scale2(-1).neg();
        let mut journey = Journey {
            product: [Ball::one(), Ball::zero(), start.clone(), Ball::one()],
            turn: towards(&Ball::one(), &start).map(|angle| Turn { whole: 0, angle }),
            bits,
        };
        journey.go(&middle.balls(), |turn, angle| turn.then(middle.turn?, angle));
        self.close(&mut journey)?;
        let [a, b, c, d] = journey.product.each_ref().map(|x| x.scale2(middle.exponent));
        let nodes = journey.turn.and_then(|turn| nodes(turn, a.sign()?));
        let (c, b) = (c.mul(unit, bits), b.div(unit, bits)?);
        let end = |x: Ball, v: Ball, nodes| End { signs: (certain(&x), certain(&v)), x, v, nodes };
        Some(Ends { even: end(a, c, nodes), odd: end(b, d, None) })
    }

    /// What is left from the last kick of the other clock up to T/2, or half a kick less.
    fn close(&self, journey: &mut Journey) -> Option<()> {
        let (p, q, bits) = (self.p, self.q, self.bits);
        if q.is_multiple_of(2) {
            let half = Ball::one().scale2(-1);
            let [undo, ..] = self.nilpotent(&half, &Ball::zero());
            let mut undo = undo.map(|x| x.mul(&self.k, bits).scale2(-1).neg());
            undo[0] = undo[0].add(&Ball::one(), bits);
            undo[3] = undo[3].add(&Ball::one(), bits);
            journey.go(&undo, |turn, angle| Some(turn.sheared(!self.is_clockwise(), angle)));
        } else {
            let passed = (u128::from(q / 2) * u128::from(p) / u128::from(q)) as u64;
            let rotation = self.rotation(p / 2 - passed)?;
            journey.go(&rotation.matrix, |turn, angle| {
                let by = rotation.turn?;
                let turned = turn.on(by.angle, angle);
                Some(Turn { whole: turned.whole + by.whole, ..turned })
            });
        }
        if p % 2 == 1 {
            // T/2 is half way between two strikes of the base: its kick's second half and half a drift.
            let is_attracting = self.s.sign() != Some(Sign::Negative);
            let kick = self.s.div(&self.unit, bits)?.scale2(-1).neg();
            journey.go(&[Ball::one(), Ball::zero(), kick, Ball::one()], |turn, angle| {
                Some(turn.sheared(is_attracting, angle))
            });
            let drift = self.unit.scale2(-1);
            journey.go(&[Ball::one(), drift, Ball::zero(), Ball::one()], |turn, angle| {
                Some(turn.sheared(true, angle))
            });
        }
        Some(())
    }
}

/// A product that grows, with its lift.
struct Journey {
    product: Matrix,
    turn: Option<Turn>,
    bits: u32,
}

impl Journey {
    fn go(&mut self, step: &Matrix, turned: impl Fn(Turn, f64) -> Option<Turn>) {
        self.product = product(step, &self.product, self.bits);
        let angle = towards(&self.product[0], &self.product[2]);
        self.turn = self.turn.zip(angle).and_then(|(turn, angle)| turned(turn, angle));
    }
}

/// The direction of (x, y).
fn towards(x: &Ball, y: &Ball) -> Option<f64> {
    let [(a, b), (c, d)] = [x, y].map(Ball::to_f64_enclosure);
    direction([0.5 * (a + b), 0.5 * (c + d)], (b - a) + (d - c))
}

/// How often x changed its sign: at the odd quarters of the clockwise turn, which each of the steps passes in one sense.
fn nodes(turn: Turn, sign: Sign) -> Option<u64> {
    let beside = if sign == Sign::Positive {
        0
    } else if turn.angle > 0.0 {
        -1
    } else {
        1
    };
    u64::try_from(beside - 2 * turn.whole).ok()
}

/// A sign; enclosures of zero have none.
fn certain(x: &Ball) -> Option<Sign> {
    x.sign().filter(|&sign| sign != Sign::Zero)
}

#[cfg(test)]
mod tests;
