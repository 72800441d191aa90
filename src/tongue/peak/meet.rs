//! The two entries of a tongue at a point, to twice the digits of a double, with their slopes.
//!
//! Run the recurrence from t = 0 to a node r, short of its mass, and from T/2 back to it (`gap::tunnel` says how):
//! (x, v) and (y, w), each once free and once pinned at its end. Every entry of the half period is, whatever r,
//!
//! ```text
//!     X = x w + v y - k_r x y,
//! ```
//!
//! the start at t = 0 free for A and C, that at T/2 free for C and D. Of a tongue's pair let X be the entry that starts
//! free, Y the other one, ε = 1 for B and C, −1 for A and D: inside, E = ε X Y > 0 and ln of the multiplier is 2 asinh √E.
//!
//! **Thinner than doubles show.** With P and Q the products of the free and the pinned amplitude at r, from the left and
//! from the right, X = x y F and Y = x' y' F', F' − F = Δ = 1/P + ε/Q, so that
//!
//! ```text
//!     ε PQ Δ²/4 = (|P| - |Q|)²/(4 |PQ|) = sinh²(L/2),       L = ln |P/Q|,
//! ```
//!
//! up to the sign (ε PQ < 0 in a tongue). As F' = Δ where F = 0 and F = −Δ where F' = 0, and both are straight but for
//! the tongue's relative width times the number of nodes, E is a parabola between the edges; its height in the
//! middle is |PQ| Δ Δ'/4, with Δ and Δ' at the two edges:
//!
//! ```text
//!     E = sinh(L/2) sinh(L'/2),
//! ```
//!
//! with no difference of the edges in it. Slopes are in ln s throughout.

use crate::number::Twofold;
use crate::tongue::string::lanes::{logarithm, power_of_two, rescaling};
use crate::tongue::string::{HalfString, KINDS, Step};
use crate::vector::instructions::Task;

/// What one operation on two doubles loses, relative to its terms: the kick's own roundings included.
const LOSS: f64 = f64::from_bits((1023 - 101) << 52);

/// Relative accuracy asked of E: twice what ln of the multiplier then has, which is fifteen digits.
const ACCURACY: f64 = 4.0 * f64::EPSILON;

/// A number times 2^exponent, with its slope, to within `uncertainty`, in the same scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value {
    number: f64,
    slope: f64,
    uncertainty: f64,
    exponent: i64,
}

impl Value {
    /// How far in ln s the zero is, where that is near.
    pub fn to_zero(self) -> f64 {
        -self.number / self.slope
    }

    /// The slope of ln |X|.
    fn rise(self) -> f64 {
        self.slope / self.number
    }
}

/// The pair at one s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// X and Y: the entry that starts free, and the other one.
    pub pair: [Value; 2],
    /// ε.
    sign: f64,
    /// L.
    balance: Value,
}

impl Meeting {
    /// At s, for the tongues of odd or of even m.
    pub fn new(string: &HalfString, s: Twofold, odd: bool) -> Meeting {
        string.instructions.perform_alone(Meet { string, s, odd })
    }

    /// The slope of ln E.
    pub fn rise(&self) -> f64 {
        self.pair[0].rise() + self.pair[1].rise()
    }

    /// ln of the multiplier; `None` where E ≤ 0, or is not known to fifteen digits.
    pub fn ln_multiplier(&self) -> Option<f64> {
        let [x, y] = self.pair;
        let off = (x.uncertainty / x.number).abs() + (y.uncertainty / y.number).abs();
        let number = self.sign * x.number * y.number;
        (number > 0.0 && off <= ACCURACY).then(|| ln_multiplier(number, x.exponent + y.exponent))
    }

    /// The same in the middle of a tongue that is far thinner than its distance to others, nearby; and how far in ln s
    /// that is.
    pub fn in_the_middle(&self) -> Option<(f64, f64)> {
        let Value { number, slope, uncertainty, .. } = self.balance;
        let to = self.pair.map(Value::to_zero);
        let [l, m] = to.map(|to| number + slope * to);
        let stray = |value: &Value| (slope * value.uncertainty / value.slope).abs();
        let off = uncertainty + stray(&self.pair[0]) + stray(&self.pair[1]);
        if !(l * m > 0.0 && off <= 0.5 * ACCURACY * l.abs().min(m.abs())) {
            return None;
        }
        // Where sinh is no longer straight, L and L' differ by far less than the root of a rounding.
        let ln = if l.abs() > 1.0 {
            0.5 * (l + m).abs()
        } else {
            2.0 * ((0.5 * l).sinh() * (0.5 * m).sinh()).sqrt().asinh()
        };
        Some((ln, 0.5 * (to[0] + to[1])))
    }
}

/// 2 asinh √(number 2^exponent).
fn ln_multiplier(number: f64, exponent: i64) -> f64 {
    const WITHIN_DOUBLES: i64 = 400;
    let log = number.ln() + exponent as f64 * std::f64::consts::LN_2;
    match () {
        () if exponent.abs() <= WITHIN_DOUBLES => 2.0 * (number * power_of_two(exponent)).sqrt().asinh(),
        () if log > 0.0 => log + 2.0 * std::f64::consts::LN_2,
        () => 2.0 * (0.5 * log).exp(),
    }
}

struct Meet<'a> {
    string: &'a HalfString,
    s: Twofold,
    odd: bool,
}

impl Task for Meet<'_> {
    type Output = Meeting;

    #[inline(always)]
    fn run(self) -> Meeting {
        let Meet { string, s, odd } = self;
        let table = Table::new(string, s);
        let (at, last) = (table.node(string), string.last());
        let left = Orbit::run(&table, &string.forward[..at], [true, false]);
        // In the order of the pair: X ends free for C, pinned for A.
        let right = Orbit::run(&table, &string.backward[..last - at], [!odd, odd]);
        let k = table.kicks[string.nodes[at].kind];
        let pair = [left[0].meet(&right[0], k), left[1].meet(&right[1], k)];
        Meeting { pair, sign: if odd { -1.0 } else { 1.0 }, balance: balance(&left, &right) }
    }
}

/// Kicks by kind of node, in a unit of time that no spring is longer than.
struct Table {
    kicks: [Twofold; KINDS],
    /// Units in a tick: a power of two.
    tick: f64,
}

impl Table {
    #[inline(always)]
    fn new(string: &HalfString, s: Twofold) -> Table {
        let unit = string.unit();
        let kappa = s.over(string.ticks).scaled(unit);
        let mut kicks = [kappa; KINDS];
        for (kick, (&hi, &lo)) in kicks.iter_mut().zip(string.masses.iter().zip(&string.rests)) {
            *kick = kappa.times(Twofold { hi, lo });
        }
        Table { kicks, tick: 1.0 / unit }
    }

    /// r: where |PQ| is largest, in doubles.
    #[inline(always)]
    fn node(&self, string: &HalfString) -> usize {
        let mut heights = vec![0; string.nodes.len()];
        self.climb(&string.forward, &mut heights);
        heights.reverse();
        self.climb(&string.backward, &mut heights);
        heights.reverse();
        (0..heights.len()).max_by_key(|&j| heights[j]).unwrap_or(0)
    }

    /// Adds the logarithm of |x x'| at each node, the end behind being free or pinned.
    #[inline(always)]
    fn climb(&self, steps: &[Step], heights: &mut [i64]) {
        let (mut x, mut v, mut exponent) = ([1.0f64, 0.0], [0.0f64, 1.0], 0);
        heights[0] += logarithm(0.0);
        for (step, height) in steps.iter().zip(&mut heights[1..]) {
            let (k, t) = (self.kicks[step.kind].hi, step.length * self.tick);
            for i in 0..2 {
                v[i] -= k * x[i];
                x[i] += t * v[i];
            }
            *height += logarithm(x[0]) + logarithm(x[1]) + exponent;
            // Both alike: their product's logarithm is what counts.
            for i in 0..2 {
                let (factor, places) = rescaling(x[i].abs() + v[i].abs());
                (x[i], v[i]) = (x[i] * factor, v[i] * factor);
                exponent += places << 32;
            }
        }
    }
}

/// (x, v) 2^exponent with its slope (dx, dv), short of a node's kick.
struct Orbit {
    x: Twofold,
    v: Twofold,
    dx: f64,
    dv: f64,
    exponent: i64,
    length: f64,
    /// Σ |r| |u| and Σ |r|/|u| over the steps' roundings r: across the orbit and along it (`gap::tunnel`).
    across: f64,
    along: f64,
}

impl Orbit {
    /// Two orbits through the same steps, each free or pinned at its start: neither waits for the other. (Closures over arrays would
    /// not be compiled for the task's instructions.)
    #[inline(always)]
    fn run(table: &Table, steps: &[Step], [first, second]: [bool; 2]) -> [Orbit; 2] {
        let (mut first, mut second) = (Orbit::start(first), Orbit::start(second));
        for step in steps {
            let (k, t) = (table.kicks[step.kind], step.length * table.tick);
            first.pass(k, t);
            second.pass(k, t);
        }
        [first, second]
    }

    #[inline(always)]
    fn start(free: bool) -> Orbit {
        let unit = |on: bool| Twofold { hi: if on { 1.0 } else { 0.0 }, lo: 0.0 };
        let (x, v) = (unit(free), unit(!free));
        Orbit { x, v, dx: 0.0, dv: 0.0, exponent: 0, length: 1.0, across: 0.0, along: 0.0 }
    }

    #[inline(always)]
    fn pass(&mut self, k: Twofold, t: f64) {
        self.dv -= k.hi * (self.dx + self.x.hi);
        let pull = k.times(self.x);
        self.v = self.v.minus(pull);
        self.account(pull.hi.abs() + self.v.hi.abs());
        self.dx += t * self.dv;
        let way = self.v.scaled(t);
        self.x = self.x.plus(way);
        self.account(way.hi.abs() + self.x.hi.abs());
        let (factor, places) = rescaling(self.length);
        if places != 0 {
            (self.x, self.v) = (self.x.scaled(factor), self.v.scaled(factor));
            [&mut self.dx, &mut self.dv, &mut self.length].into_iter().for_each(|x| *x *= factor);
            self.across *= factor * factor;
            self.exponent += places;
        }
    }

    /// After an operation with a rounding of [`LOSS`] times `size`.
    #[inline(always)]
    fn account(&mut self, size: f64) {
        self.length = self.x.hi.abs() + self.v.hi.abs();
        self.across += size * self.length;
        self.along += size / self.length;
    }

    /// How far x and v may be off.
    #[inline(always)]
    fn off(&self) -> f64 {
        LOSS * (4.0 * self.across / self.length + (1.0 + self.along) * self.length)
    }

    /// x w + v y − k x y.
    #[inline(always)]
    fn meet(&self, other: &Orbit, k: Twofold) -> Value {
        let (x, v, y, w) = (self.x, self.v, other.x, other.v);
        let kicked = v.minus(k.times(x));
        let number = x.times(w).plus(kicked.times(y)).hi;
        let (x, v, y, w, k) = (x.hi, v.hi, y.hi, w.hi, k.hi);
        let slope = self.dx * w + x * other.dv + self.dv * y + v * other.dx
            - k * (self.dx * y + x * other.dx + x * y);
        // To first order, each amplitude and slope being off by that much; and the roundings of this sum.
        let strays = self.off() * ((w - k * y).abs() + y.abs()) + other.off() * ((v - k * x).abs() + x.abs());
        let terms = (x * w).abs() + (v * y).abs() + 2.0 * (k * x * y).abs();
        let uncertainty = 2.0 * strays + 4.0 * LOSS * terms;
        Value { number, slope, uncertainty, exponent: self.exponent + other.exponent }
    }
}

/// L = ln |P/Q|.
#[inline(always)]
fn balance(left: &[Orbit; 2], right: &[Orbit; 2]) -> Value {
    let product = |[a, b]: &[Orbit; 2]| a.x.times(b.x).magnitude();
    let exponent = |[a, b]: &[Orbit; 2]| a.exponent + b.exponent;
    let (p, q, places) = (product(left), product(right), exponent(left) - exponent(right));
    let excess = p.scaled(power_of_two(places)).minus(q).hi / q.hi;
    let number = if excess.abs() < 0.5 {
        excess.ln_1p()
    } else {
        (p.hi / q.hi).ln() + places as f64 * std::f64::consts::LN_2
    };
    let rise = |[a, b]: &[Orbit; 2]| a.dx / a.x.hi + b.dx / b.x.hi;
    let stray = |[a, b]: &[Orbit; 2]| (a.off() / a.x.hi).abs() + (b.off() / b.x.hi).abs();
    Value { number, slope: rise(left) - rise(right), uncertainty: stray(left) + stray(right), exponent: 0 }
}
