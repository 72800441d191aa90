//! The constants of a pair, the two branches made of them, and what lies between their product and T/2.

use std::f64::consts::{PI, TAU};
use std::marker::PhantomData;

use num_bigint::BigUint;
use num_integer::Integer;
use num_traits::ToPrimitive;

use super::branch::{Branch, Budget};
use super::coefficient::{Coefficient, exact};
use super::enclosure::{Enclosure, Matrix, balanced, power, product};
use super::euclid::{self, Reached, Walked};
use super::map::Map;
use super::turn::{Turn, direction, principal};
use super::wanted::Wanted;
use crate::orbit::ends::{End, Ends};
use crate::propagator::{LongClocks, PartialSigns};
use number::{Ball, Rational, Real, Sign};

/// Bits of a base's angle beside those of the number of its steps.
const ANGLE: u32 = 50;

/// Doubles know the turn of a number of steps that has at most so many binary digits.
const FEW: u32 = 17;

/// |σ²| below which a base beyond its own limit keeps the unit of the velocity.
const LEAST_UNIT: f64 = 1e-3;

/// p/q of the base and the other clock: `whole` + `rest`/q steps of the base from one kick of the other to
/// the next.
#[derive(Clone, Debug)]
pub struct Beat {
    pub whole: BigUint,
    pub rest: u128,
    pub q: u128,
}

/// Lengths in units of 1/q, doubled, are numbers of 128 bits.
const LONGEST: u64 = 124;

impl Beat {
    /// `None` where the other clock's kicks are too many for a number.
    pub fn of(ratio: &Rational) -> Option<Beat> {
        let [p, q] = [ratio.numer(), ratio.denom()].map(|n| n.magnitude());
        if q.bits() > LONGEST {
            return None;
        }
        let (whole, rest) = p.div_rem(q);
        Some(Beat { whole, rest: rest.to_u128()?, q: q.to_u128()? })
    }

    fn p(&self) -> BigUint {
        &self.whole * self.q + self.rest
    }
}

/// The constants of a pair, enclosed by E; functions made of them have the numbers T.
pub struct Frame<T, E> {
    beat: Beat,
    s: E,
    k: E,
    /// The unit of the velocity: σ, and beyond the base's own limit √|σ²|, or 1 beside it.
    unit: E,
    /// `None` where nobody asks for turns.
    turning: Option<Turning>,
    wanted: Wanted,
    bits: u32,
    numbers: PhantomData<T>,
}

/// How a step of the base turns directions.
enum Turning {
    /// 0 < s < 4: by θ/2π, known so well that of as many steps' turns the whole ones are.
    By(Ball),
    /// The turn within 2^-25, for few steps.
    Near(f64),
    /// s ≥ 4: a half turn, and (1, 0) stays on its side.
    Half,
    /// s ≤ 0: (1, 0) stays on its side.
    Not,
}

/// The result of a run.
pub struct Found {
    pub signs: PartialSigns,
    /// The sign of Tr Q, which is beyond ±2, where that is known without the ends.
    pub grows: Option<Sign>,
    /// `None` where their logarithms are too large for the exponents of balls.
    pub ends: Option<Ends>,
}

impl Found {
    /// Whether a verdict follows.
    pub fn decides(&self) -> bool {
        self.grows.is_some() || self.signs.verdict().is_some()
    }
}

/// A, B, C, D without their common power of two, and the sign changes of the even solution.
struct Half<E> {
    entries: Matrix<E>,
    exponent: i128,
    nodes: Option<u64>,
}

/// A power of the base's step: cos nθ, sin nθ, and the lift.
struct Rotation<E> {
    matrix: Matrix<E>,
    /// Of the power of two that the matrix is to be multiplied by.
    exponent: i128,
    turn: Option<Turn>,
}

impl<T: Coefficient, E: Enclosure> Frame<T, E> {
    /// `None` where these numbers cannot decide on which side of its own limit the base is.
    pub fn new<S: Real>(clocks: &LongClocks<S>, wanted: Wanted) -> Option<Self> {
        let beat = Beat::of(clocks.ratio())?;
        // Each squaring doubles the radius, and adds four of them: it loses a bit and a half.
        let lost = beat.whole.bits() as u32;
        let bits = T::BITS + 34 + 2 * lost;
        let [s, k] = [E::of(clocks.fast(), bits)?, E::of(clocks.slow(), bits)?];
        let square = s.minus(&s.times(&s).scale2(-2));
        let elliptic = square.sign()? == Sign::Positive;
        let unit = if elliptic {
            square.root()?
        } else if square.ends().1.abs() > LEAST_UNIT {
            square.negative().root()?
        } else {
            E::quotient(1, 1, bits)
        };
        let turning = if wanted != Wanted::Nodes {
            None
        } else if elliptic && lost <= FEW {
            // An error δ of s changes θ by less than 1.1 √δ, at the worst next to 0 and to 4.
            let (s, _) = s.ends();
            Some(Turning::Near(2.0 * s.max(0.0).sqrt().atan2((4.0 - s).max(0.0).sqrt()) / TAU))
        } else if elliptic {
            let bits = ANGLE + lost + 62;
            let cosine = Ball::one().sub(&clocks.fast().enclosure(bits).scale2(-1), bits);
            let theta = cosine.acos(bits);
            theta.and_then(|theta| theta.div(&Ball::pi(bits).scale2(1), bits)).map(Turning::By)
        } else {
            Some(if s.ends().0 > 2.0 { Turning::Half } else { Turning::Not })
        };
        Some(Frame { beat, s, k, unit, turning, wanted, bits, numbers: PhantomData })
    }

    fn quotient(&self, n: i128, d: u128) -> E {
        E::quotient(n, d, self.bits)
    }

    fn one(&self) -> E {
        self.quotient(1, 1)
    }

    fn zero(&self) -> E {
        self.quotient(0, 1)
    }

    fn identity(&self) -> Matrix<E> {
        [self.one(), self.zero(), self.zero(), self.one()]
    }

    /// One step of the base from the middle of a kick to that of the next, [[c, κ], [−σ²/κ, c]], c = 1 − s/2.
    fn step(&self) -> Option<Matrix<E>> {
        let cosine = self.one().minus(&self.s.scale2(-1));
        let square = self.s.minus(&self.s.times(&self.s).scale2(-2));
        Some([cosine.clone(), self.unit.clone(), square.over(&self.unit)?.negative(), cosine])
    }

    /// n steps of the base.
    fn rotation(&self, n: &BigUint) -> Option<Rotation<E>> {
        let (matrix, exponent) = power(&self.step()?, &self.identity(), n);
        let turn = self.towards(&matrix[0], &matrix[2]).and_then(|angle| self.turned(n, angle));
        Some(Rotation { matrix, exponent, turn })
    }

    /// The direction of (x, y); `None` where nobody asks for turns.
    fn towards(&self, x: &E, y: &E) -> Option<f64> {
        self.turning.as_ref()?;
        let [(a, b), (c, d)] = [x.ends(), y.ends()];
        direction([0.5 * (a + b), 0.5 * (c + d)], (b - a) + (d - c))
    }

    /// The turn of n steps of the base that lead (1, 0) into this direction.
    fn turned(&self, n: &BigUint, angle: f64) -> Option<Turn> {
        match self.turning.as_ref()? {
            Turning::Near(theta) => {
                // Within 2^-8 of a whole number.
                let whole = -theta * n.to_f64()? - angle / TAU;
                Some(Turn { whole: whole.round() as i128, angle })
            }
            Turning::By(theta) => {
                // Full turns: −nθ = 2π whole + angle.
                let bits = ANGLE + 62 + n.bits() as u32;
                let turns = theta.mul(&Ball::from_integer(&n.clone().into()), bits).neg();
                let fraction = exact(angle).div(&Ball::pi(64).scale2(1), 64)?;
                let whole = turns.sub(&fraction, bits);
                let (lower, upper) = (whole.lower().round(), whole.upper().round());
                (lower == upper).then_some(Turn { whole: lower.to_integer().to_i128()?, angle })
            }
            Turning::Half => {
                // By −nπ, and then by less than a right angle.
                let half = if n.bit(0) { -PI } else { 0.0 };
                let beside = principal(angle - half);
                let whole = -(n >> 1u32).to_i128()?;
                Some(Turn { whole, ..Turn::NONE }.on(half + beside, angle))
            }
            Turning::Not => Some(Turn { whole: 0, angle }),
        }
    }

    /// The terms of N(m + w t), K = 1 + k N.
    fn nilpotent(&self, m: &E, w: &E) -> [Matrix<E>; 3] {
        let half = self.s.scale2(-1).negative();
        let quarter = self.s.times(&self.s).scale2(-2);
        let over = |x: &E| x.over(&self.unit).expect("a positive unit").negative();
        // Polynomials in x, from the constant term on.
        let u_x = [self.zero(), self.one(), half];
        let square = [self.zero(), self.zero(), self.unit.clone()];
        let slope = [over(&self.one()), over(&self.s.negative()), over(&quarter)];
        let at = |[c, b, a]: [E; 3]| {
            let a_m = a.times(m);
            let value = a_m.plus(&b).times(m).plus(&c);
            let first = a_m.scale2(1).plus(&b).times(w);
            [value, first, a.times(&w.times(w))]
        };
        let (u_x, square, slope) = (at(u_x), at(square), at(slope));
        std::array::from_fn(|j| [u_x[j].clone(), square[j].clone(), slope[j].clone(), u_x[j].negative()])
    }

    /// 1 + `by` N, N constant or a function.
    fn shear<const N: usize>(&self, nilpotent: &[Matrix<E>; N], by: &E) -> [Matrix<E>; N] {
        let mut terms = nilpotent.each_ref().map(|term| term.each_ref().map(|x| x.times(by)));
        for diagonal in [0, 3] {
            terms[0][diagonal] = terms[0][diagonal].plus(&self.one());
        }
        terms
    }

    /// K(x) after a power of the base's step, x from middle − half to middle + half, both in units of 1/2q.
    fn branch(&self, middle: u128, half: u128, steps: &Rotation<E>) -> Map<T> {
        let unit = |n: u128| self.quotient(n as i128, self.beat.q).scale2(-1);
        let terms = self.shear(&self.nilpotent(&unit(middle), &unit(half)), &self.k);
        let (terms, exponent) = balanced(terms.map(|term| product(&term, &steps.matrix)));
        let turn = steps.turn.zip(self.towards(&terms[0][0], &terms[0][2]));
        let mut map = Map::new(&terms, turn.map(|(turn, angle)| turn.sheared(self.is_clockwise(), angle)));
        map.exponent = map.exponent.saturating_add(steps.exponent).saturating_add(exponent.into());
        map
    }

    /// A positive kick turns clockwise, between a drift and its inverse, too.
    fn is_clockwise(&self) -> bool {
        self.k.sign() != Some(Sign::Negative)
    }

    fn branches(&self) -> Option<[Branch<T>; 2]> {
        let Beat { whole, rest: b, q } = &self.beat;
        let (a, b) = (q - b, *b);
        let left = self.branch(2 * b + a, a, &self.rotation(whole)?);
        let right = self.branch(b, b, &self.rotation(&(whole + 1u32))?);
        let [a, b] = [a as i128, b as i128];
        Some([
            Branch { map: left, start: 0, length: a, stride: b, height: 1 },
            Branch { map: right, start: a, length: b, stride: -a, height: 1 },
        ])
    }

    /// The even and the odd solution at T/2.
    pub fn found<P: Coefficient>(&self) -> Option<Found> {
        let middle = match self.walked::<P>(self.beat.q / 2)? {
            Walked::Reached(reached) => reached.product,
            Walked::Grows(sign) => {
                return Some(Found { signs: PartialSigns::default(), grows: Some(sign), ends: None });
            }
        };
        let Half { entries: [a, b, c, d], exponent, nodes } = self.half(&middle)?;
        let signs = PartialSigns { a: certain(&a), b: certain(&b), c: certain(&c), d: certain(&d) };
        let exponent = exponent_of_balls(exponent);
        let ends = exponent.map(|exponent| {
            let end = |x: &E, v: &E, signs, nodes| {
                let of = |x: &E| x.ball().scale2(exponent);
                End { signs, x: of(x), v: of(v), nodes }
            };
            let odd_nodes = nodes.zip(signs.b).and_then(|(nodes, b)| odd_nodes(nodes, b));
            Ends {
                even: end(&a, &c, (signs.a, signs.c), nodes),
                odd: end(&b, &d, (signs.b, signs.d), odd_nodes),
            }
        });
        Some(Found { signs, grows: None, ends })
    }

    /// The first n kicks of the other clock in the coordinates of the base.
    fn walked<P: Coefficient>(&self, n: u128) -> Option<Walked<P>> {
        let identity = Map::identity();
        if n == 0 {
            return Some(Walked::Reached(Reached { product: identity, x: 0, left: 0 }));
        }
        let [left, right] = self.branches()?;
        let left_out = euclid::left_out::<T, P>(self.beat.q);
        euclid::walk(left, right, n, identity, left_out, self.wanted, &mut Budget::of::<T>())
    }

    /// All of the half period, `middle` between both ends.
    fn half<P: Coefficient>(&self, middle: &Map<P>) -> Option<Half<E>> {
        let mut journey = self.kicked(middle)?;
        self.close(&mut journey)?;
        let (exponent, turn) = (journey.exponent, journey.turn);
        let entries = journey.entries()?;
        let nodes = turn.and_then(|turn| nodes(turn, entries[0].sign()?));
        Some(Half { entries, exponent, nodes })
    }

    /// From t = 0 through the first kicks of the other clock, the last one whole.
    fn kicked<P: Coefficient>(&self, middle: &Map<P>) -> Option<Journey<'_, T, E>> {
        let (zero, one) = (self.zero(), self.one());
        // Half a kick of the other clock at t = 0.
        let start = self.k.over(&self.unit)?.scale2(-1).negative();
        let mut journey = Journey {
            frame: self,
            turn: self.towards(&one, &start).map(|angle| Turn { whole: 0, angle }),
            product: [one.clone(), zero, start, one],
            exponent: middle.exponent,
        };
        journey.go(&middle.enclosures(self.bits), |turn, angle| turn.then(middle.turn?, angle));
        Some(journey)
    }

    /// The rest from the last kick of the other clock up to T/2, or half a kick less.
    fn close(&self, journey: &mut Journey<T, E>) -> Option<()> {
        let Beat { whole, rest, q } = &self.beat;
        let p = self.beat.p();
        if q % 2 == 0 {
            self.take_back_half(journey);
        } else {
            let passed = whole * (q / 2) + BigUint::from(q / 2) * *rest / *q;
            let rotation = self.rotation(&((&p >> 1u32) - passed))?;
            journey.exponent = journey.exponent.saturating_add(rotation.exponent);
            journey.go(&rotation.matrix, |turn, angle| {
                let by = rotation.turn?;
                let turned = turn.on(by.angle, angle);
                Some(Turn { whole: turned.whole + by.whole, ..turned })
            });
        }
        if p.bit(0) {
            // T/2 is half way between two strikes of the base.
            self.drift_half(journey)?;
        }
        Some(())
    }

    /// Half of the other clock's last kick, half way between two of the base's, taken back.
    fn take_back_half(&self, journey: &mut Journey<T, E>) {
        let [undo, ..] = self.nilpotent(&self.one().scale2(-1), &self.zero());
        let [undo] = self.shear(&[undo], &self.k.scale2(-1).negative());
        journey.go(&undo, |turn, angle| Some(turn.sheared(!self.is_clockwise(), angle)));
    }

    /// From the middle of a kick of the base through its second half and half a drift.
    fn drift_half(&self, journey: &mut Journey<T, E>) -> Option<()> {
        let (zero, one, drift) = (self.zero(), self.one(), self.unit.scale2(-1));
        let is_attracting = self.s.sign() != Some(Sign::Negative);
        let kick = self.s.over(&self.unit)?.scale2(-1).negative();
        journey.go(&[one.clone(), zero.clone(), kick, one.clone()], |turn, angle| {
            Some(turn.sheared(is_attracting, angle))
        });
        journey.go(&[one.clone(), drift, zero, one], |turn, angle| Some(turn.sheared(true, angle)));
        Some(())
    }
}

/// A product that grows, with its lift.
struct Journey<'a, T, E> {
    frame: &'a Frame<T, E>,
    product: Matrix<E>,
    exponent: i128,
    turn: Option<Turn>,
}

impl<T: Coefficient, E: Enclosure> Journey<'_, T, E> {
    fn go(&mut self, step: &Matrix<E>, turned: impl Fn(Turn, f64) -> Option<Turn>) {
        self.product = product(step, &self.product);
        let angle = self.frame.towards(&self.product[0], &self.product[2]);
        self.turn = self.turn.zip(angle).and_then(|(turn, angle)| turned(turn, angle));
    }

    /// In the base's step as the unit of time.
    fn entries(self) -> Option<Matrix<E>> {
        let [a, b, c, d] = self.product;
        Some([a, b.over(&self.frame.unit)?, c.times(&self.frame.unit), d])
    }
}

/// How often x changed its sign: at the odd quarters of the clockwise turn, which each of the steps passes in
/// one sense.
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

/// The sign changes of the odd solution, which ends with this sign: between two of its zeros, the one at t =
/// 0 included, lies one of the even solution's (Sturm; their Wronskian is 1), so it has as many or one less.
fn odd_nodes(even_nodes: u64, sign: Sign) -> Option<u64> {
    let is_as_many = (sign == Sign::Negative) == (even_nodes % 2 == 1);
    even_nodes.checked_sub(u64::from(!is_as_many))
}

/// Where balls with this exponent, and their products, stay within what balls hold.
pub fn exponent_of_balls(exponent: i128) -> Option<i64> {
    i64::try_from(exponent).ok().filter(|e| e.unsigned_abs() <= 1 << 58)
}

/// A sign; enclosures of zero have none.
fn certain<E: Enclosure>(x: &E) -> Option<Sign> {
    x.sign().filter(|&sign| sign != Sign::Zero)
}
