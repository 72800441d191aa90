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
//! a polynomial in x. From kick to kick the offset moves by p/q mod 1, and the state by K(x') R(nθ), n = ⌊x + p/q⌋. So the half
//! period is a product of such maps along the orbit of x, half a kick before it, and what is left up to T/2 after it. Winding
//! comes out of the same run: each product has its [`Turn`], so the sign changes of x are known without following them.

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
use map::Map;
use number::{Coefficient, Long, exact};
use run::{Branch, Budget};
use turn::{Turn, direction};

/// The precisions, in bits.
pub const PRECISIONS: [u32; 3] = [53, 106, 256];

/// From so many kicks of each clock on, return maps are cheaper than kicks, whatever the partial quotients.
const LONG: u64 = 1 << 22;

/// Whether the period is so long that its return maps are to be tried before its kicks.
pub fn is_worth(ratio: Ratio) -> bool {
    ratio.p().min(ratio.q()) >= LONG
}

/// The half period in numbers of so many bits, or more; `None` outside 0 < s < 4 of both clocks, where the bound loses all
/// digits, where a partial quotient asks for too many products, and where the work was stopped.
pub fn run<S: Real>(clocks: &TwoClocks<S>, bits: u32) -> Option<Ends> {
    match bits {
        0..=53 => run_in::<S, f64>(clocks),
        54..=106 => run_in::<S, Twofold>(clocks),
        107..=256 => run_in::<S, Long<256>>(clocks),
        _ => None,
    }
}

/// With the clock of more kicks as the base, or the other one where that is beyond its own limit.
fn run_in<S: Real, T: Coefficient>(clocks: &TwoClocks<S>) -> Option<Ends> {
    let own = || Frame::new::<S, T>(clocks)?.ends::<T>();
    let swapped =
        || Some(in_first_unit(Frame::new::<S, T>(&clocks.swapped())?.ends::<T>()?, clocks.ratio(), T::BITS));
    if clocks.p() >= clocks.q() { own().or_else(swapped) } else { swapped().or_else(own) }
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
    sigma: Ball,
    bits: u32,
}

/// A power of the base's step: cos nθ, sin nθ, and the lift.
struct Rotation {
    matrix: Matrix,
    turn: Option<Turn>,
}

impl Frame {
    /// `None` unless 0 < s < 4.
    fn new<S: Real, T: Coefficient>(clocks: &TwoClocks<S>) -> Option<Frame> {
        let bits = T::BITS + 160;
        let (s, k) = (clocks.fast().enclosure(bits), clocks.slow().enclosure(bits));
        let square = s.sub(&s.square(bits).scale2(-2), bits);
        if s.sign() != Some(Sign::Positive) || square.sign() != Some(Sign::Positive) {
            return None;
        }
        let sigma = square.sqrt(bits)?;
        Some(Frame { p: clocks.p(), q: clocks.q(), s, k, sigma, bits })
    }

    fn ball(&self, n: i64, d: u64) -> Ball {
        Ball::from_rational(&Rational::new(n.into(), d.into()), self.bits)
    }

    /// n steps of the base.
    fn rotation(&self, n: u64) -> Rotation {
        let (bits, cosine) = (self.bits, Ball::one().sub(&self.s.scale2(-1), self.bits));
        let step = [cosine.clone(), self.sigma.clone(), self.sigma.neg(), cosine.clone()];
        let mut matrix = [Ball::one(), Ball::zero(), Ball::zero(), Ball::one()];
        for bit in (0..64 - n.leading_zeros()).rev() {
            matrix = product(&matrix, &matrix, bits);
            if n >> bit & 1 == 1 {
                matrix = product(&matrix, &step, bits);
            }
        }
        let turn = towards(&matrix[0], &matrix[2]).and_then(|angle| {
            // Full turns: −nθ = 2π whole + angle.
            let theta = cosine.acos(bits)?.div(&Ball::pi(bits).scale2(1), bits)?;
            let turns = theta.mul(&Ball::from_integer(&n.into()), bits).neg();
            let fraction = exact(angle).div(&Ball::pi(64).scale2(1), 64)?;
            let whole = turns.sub(&fraction, bits);
            let (lower, upper) = (whole.lower().round(), whole.upper().round());
            (lower == upper).then_some(Turn { whole: lower.to_integer().to_i128()?, angle })
        });
        Rotation { matrix, turn }
    }

    /// The terms of N(m + w t), K = 1 + k N.
    fn nilpotent(&self, m: &Ball, w: &Ball) -> [Matrix; 3] {
        let (bits, zero, one) = (self.bits, Ball::zero(), Ball::one());
        let half = self.s.scale2(-1).neg();
        let quarter = self.s.square(bits).scale2(-2);
        // Polynomials in x.
        let u_x = [zero.clone(), one.clone(), half];
        let square = [zero.clone(), zero, self.sigma.clone()];
        let over = |x: Ball| x.div(&self.sigma, bits).expect("sigma > 0").neg();
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
    fn branch<T: Coefficient>(&self, middle: u64, half: u64, steps: u64) -> Map<T> {
        let bits = self.bits;
        let unit = |n: u64| self.ball(n as i64, self.q).scale2(-1);
        let rotation = self.rotation(steps);
        let mut terms = self.nilpotent(&unit(middle), &unit(half));
        terms.iter_mut().flatten().for_each(|x| *x = x.mul(&self.k, bits));
        for diagonal in [0, 3] {
            terms[0][diagonal] = terms[0][diagonal].add(&Ball::one(), bits);
        }
        let terms = terms.map(|term| product(&term, &rotation.matrix, bits));
        let turn = rotation.turn.zip(towards(&terms[0][0], &terms[0][2]));
        Map::new(&terms, turn.map(|(turn, angle)| turn.sheared(self.is_clockwise(), angle)))
    }

    /// A positive kick turns clockwise, between a drift and its inverse, too.
    fn is_clockwise(&self) -> bool {
        self.k.sign() != Some(Sign::Negative)
    }

    fn branches<T: Coefficient>(&self) -> [Branch<T>; 2] {
        let (whole, b) = (self.p / self.q, self.p % self.q);
        let a = self.q - b;
        let left = self.branch(2 * b + a, a, whole);
        let right = self.branch(b, b, whole + 1);
        let [a, b] = [a as i64, b as i64];
        [
            Branch { map: left, start: 0, length: a, stride: b, height: 1 },
            Branch { map: right, start: a, length: b, stride: -a, height: 1 },
        ]
    }

    /// The even and the odd solution at T/2.
    fn ends<T: Coefficient>(&self) -> Option<Ends> {
        let n = self.q / 2;
        let mut budget = Budget(T::PRODUCTS);
        let middle = if n == 0 {
            Map::identity()
        } else {
            let [left, right] = self.branches::<T>();
            euclid::walk(left, right, n, &mut budget)?.0
        };
        if middle.exponent.unsigned_abs() > 1 << 54 {
            return None;
        }
        let (bits, sigma) = (self.bits, &self.sigma);
        // Half a kick of the other clock at t = 0.
        let start = self.k.div(sigma, bits)?.scale2(-1).neg();
        let mut journey = Journey {
            product: [Ball::one(), Ball::zero(), start.clone(), Ball::one()],
            turn: towards(&Ball::one(), &start).map(|angle| Turn { whole: 0, angle }),
            bits,
        };
        journey.go(&middle.balls(), |turn, angle| turn.then(middle.turn?, angle));
        self.close(&mut journey)?;
        let [a, b, c, d] = journey.product.each_ref().map(|x| x.scale2(middle.exponent));
        let nodes = journey.turn.and_then(|turn| nodes(turn, a.sign()?));
        let (c, b) = (c.mul(sigma, bits), b.div(sigma, bits)?);
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
            let rotation = self.rotation(p / 2 - passed);
            journey.go(&rotation.matrix, |turn, angle| {
                let by = rotation.turn?;
                let turned = turn.on(by.angle, angle);
                Some(Turn { whole: turned.whole + by.whole, ..turned })
            });
        }
        if p % 2 == 1 {
            // T/2 is half way between two strikes of the base: its kick's second half and half a drift.
            let kick = self.s.div(&self.sigma, bits)?.scale2(-1).neg();
            journey.go(&[Ball::one(), Ball::zero(), kick, Ball::one()], |turn, angle| {
                Some(turn.sheared(true, angle))
            });
            let drift = self.sigma.scale2(-1);
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
