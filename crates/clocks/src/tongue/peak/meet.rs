//! The two entries of a tongue at a point, to twice the digits of a double, with their slopes.
//!
//! Run the recurrence from t = 0 to a node r, short of its mass, and from T/2 back to it (`gap::tunnel` says
//! how): (x, v) and (y, w), each once free and once pinned at its end. Every entry of the half period is,
//! whatever r,
//!
//! ```text
//!     X = x w + v y - k_r x y,
//! ```
//!
//! the start at t = 0 free for A and C, that at T/2 free for C and D. Of a tongue's pair let X be the entry
//! that starts free, Y the other one, ε = 1 for B and C, −1 for A and D: inside, E = ε X Y > 0 and ln of the
//! multiplier is 2 asinh √E.
//!
//! **Thinner than doubles show.** With P and Q the products of the free and the pinned amplitude at r, from
//! the left and from the right, X = x y F and Y = x' y' F', F' − F = Δ = 1/P + ε/Q, so that
//!
//! ```text
//!     ε PQ Δ²/4 = (|P| - |Q|)²/(4 |PQ|) = sinh²(L/2),       L = ln |P/Q|,
//! ```
//!
//! up to the sign (ε PQ < 0 in a tongue). As F' = Δ where F = 0 and F = −Δ where F' = 0, and both are
//! straight but for the tongue's relative width times the number of nodes, E is a parabola between the edges;
//! its height in the middle is |PQ| Δ Δ'/4, with Δ and Δ' at the two edges:
//!
//! ```text
//!     E = sinh(L/2) sinh(L'/2),
//! ```
//!
//! with no difference of the edges in it. Slopes are in ln s throughout.

use crate::tongue::string::lanes::{LONGEST, power_of_two};
use crate::tongue::string::{HalfString, KINDS, Step};
use number::Twofold;
use number::vector::instructions::Kernel;
use number::vector::{LANES, Vector};

/// The error of one operation on two doubles, relative to its terms: the roundings of the kick itself
/// included.
const LOSS: f64 = f64::from_bits((1023 - 101) << 52);

/// Relative accuracy asked of E: twice what ln of the multiplier then has, which is fifteen digits.
const ACCURACY: f64 = 4.0 * f64::EPSILON;

/// A number times 2^exponent, with its slope, to within `uncertainty`, in the same scale.
#[derive(Clone, Copy, Debug)]
pub struct Value {
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

/// Where to look: at s, for the tongues of odd or of even m.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub s: Twofold,
    pub odd: bool,
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
    /// At each point: several side by side, for one alone waits for its own sums.
    pub fn all(string: &HalfString, points: &[Point]) -> Vec<Meeting> {
        string.instructions.compute_by_register(Meet { string, points })
    }

    /// Of the two orbits from the left and the two from the right, at a node of kick k.
    #[inline(always)]
    fn of([left, right]: [[&Orbit; 2]; 2], k: Twofold, odd: bool) -> Meeting {
        let pair = [left[0].meet(right[0], k), left[1].meet(right[1], k)];
        Meeting { pair, sign: if odd { -1.0 } else { 1.0 }, balance: balance(left, right) }
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

    /// The rate in the middle of a tongue that is far thinner than its distance to others, nearby; and how
    /// far in ln s that is.
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
    points: &'a [Point],
}

impl Kernel for Meet<'_> {
    type Output = Vec<Meeting>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Vec<Meeting> {
        let Meet { string, points } = self;
        let last = V::splat(string.last() as f64);
        let mut meetings = Vec::with_capacity(points.len());
        for points in points.chunks(V::WIDTH) {
            let table = Table::<V>::new(string, points);
            let at = table.nodes(string);
            // In the order of the pair: X ends free for C, pinned for A.
            let mut ends_free = [0.0; LANES];
            for (lane, point) in points.iter().enumerate() {
                ends_free[lane] = if point.odd { 0.0 } else { 1.0 };
            }
            let (one, ends_free) = (V::splat(1.0), V::load(&ends_free));
            let left = Walk::run(&table, &string.forward, at, [one, V::splat(0.0)]);
            let right = Walk::run(&table, &string.backward, last.sub(at), [ends_free, one.sub(ends_free)]);
            let (left, right) = (left.map(Walk::orbits), right.map(Walk::orbits));
            let mut nodes = [0.0; LANES];
            at.store(&mut nodes);
            for (lane, point) in points.iter().enumerate() {
                let k = table.kick(string.nodes[nodes[lane] as usize].kind, lane);
                let ends = [[&left[0][lane], &left[1][lane]], [&right[0][lane], &right[1][lane]]];
                meetings.push(Meeting::of(ends, k, point.odd));
            }
        }
        meetings
    }
}

/// Kicks by kind of node, in a unit of time that no spring is longer than.
struct Table<V> {
    kicks: [Twofold<V>; KINDS],
    /// Units in a tick: a power of two.
    tick: f64,
}

impl<V: Vector> Table<V> {
    /// Lanes without a point have the last one's.
    #[inline(always)]
    fn new(string: &HalfString, points: &[Point]) -> Self {
        let (unit, none) = (string.unit(), [0.0; LANES]);
        let mut kicks = [[none, none]; KINDS];
        for lane in 0..V::WIDTH {
            let kappa = points[lane.min(points.len() - 1)].s.over(string.ticks).scaled(unit);
            for (kick, (&hi, &lo)) in kicks.iter_mut().zip(string.masses.iter().zip(&string.rests)) {
                let Twofold { hi, lo } = kappa.times(Twofold { hi, lo });
                (kick[0][lane], kick[1][lane]) = (hi, lo);
            }
        }
        let mut table =
            Table { kicks: [Twofold { hi: V::splat(0.0), lo: V::splat(0.0) }; KINDS], tick: 1.0 / unit };
        for (kick, [hi, lo]) in table.kicks.iter_mut().zip(&kicks) {
            *kick = Twofold { hi: V::load(hi), lo: V::load(lo) };
        }
        table
    }

    #[inline(always)]
    fn kick(&self, kind: usize, lane: usize) -> Twofold {
        let mut parts = [[0.0; LANES]; 2];
        self.kicks[kind].hi.store(&mut parts[0]);
        self.kicks[kind].lo.store(&mut parts[1]);
        Twofold { hi: parts[0][lane], lo: parts[1][lane] }
    }

    /// r: where |PQ| is largest, in doubles.
    #[inline(always)]
    fn nodes(&self, string: &HalfString) -> V {
        let last = string.last();
        let mut heights = vec![0.0; (last + 1) * V::WIDTH];
        let mut height = Heights::new();
        for (step, to) in string.forward.iter().zip(heights[V::WIDTH..].chunks_exact_mut(V::WIDTH)) {
            height.pass(self.kicks[step.kind].hi, step.length * self.tick).store(to);
        }
        let (mut best, mut at) = (V::load(&heights[last * V::WIDTH..]), V::splat(last as f64));
        let mut height = Heights::new();
        for (i, step) in string.backward.iter().enumerate() {
            let j = last - 1 - i;
            let behind = height.pass(self.kicks[step.kind].hi, step.length * self.tick);
            let both = V::load(&heights[j * V::WIDTH..]).add(behind);
            at = both.if_above(best, V::splat(j as f64), at);
            best = both.larger(best);
        }
        at
    }
}

/// The amplitudes of the two orbits from an end, free and pinned, in doubles.
struct Heights<V> {
    x: [V; 2],
    v: [V; 2],
    exponent: V,
}

impl<V: Vector> Heights<V> {
    #[inline(always)]
    fn new() -> Self {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        Heights { x: [one, zero], v: [zero, one], exponent: zero }
    }

    /// The logarithm of |x x'| at the next node, as [`Vector::logarithm`] has it.
    #[inline(always)]
    fn pass(&mut self, k: V, t: f64) -> V {
        let t = V::splat(t);
        for i in 0..2 {
            self.v[i] = self.v[i].sub(k.mul(self.x[i]));
            self.x[i] = self.x[i].add(t.mul(self.v[i]));
        }
        let height = self.x[0].logarithm().add(self.x[1].logarithm()).add(self.exponent);
        for i in 0..2 {
            // Both alike: their product's logarithm is what counts.
            if let Some((factor, places)) = rescalings(self.x[i].abs().add(self.v[i].abs())) {
                (self.x[i], self.v[i]) = (self.x[i].mul(factor), self.v[i].mul(factor));
                self.exponent = places.mul_add(V::splat((1u64 << 32) as f64), self.exponent);
            }
        }
        height
    }
}

/// The powers of two that bring lengths back into range, and by how many places; `None` where all are.
#[inline(always)]
fn rescalings<V: Vector>(length: V) -> Option<(V, V)> {
    let (longest, shortest) = (V::splat(LONGEST), V::splat(1.0 / LONGEST));
    if !length.any_above(longest) && !shortest.any_above(length) {
        return None;
    }
    let choose = |down: f64, up: f64, none: f64| {
        let short = shortest.if_above(length, V::splat(up), V::splat(none));
        length.if_above(longest, V::splat(down), short)
    };
    Some((choose(1.0 / LONGEST, LONGEST, 1.0), choose(200.0, -200.0, 0.0)))
}

/// (x, v) 2^exponent with its slope (dx, dv), short of a node's kick: in each lane.
struct Walk<V> {
    x: Twofold<V>,
    v: Twofold<V>,
    dx: V,
    dv: V,
    exponent: V,
    length: V,
    across: V,
    along: V,
}

impl<V: Vector> Walk<V> {
    /// Two orbits through the same steps, so many in each lane, free (1) or pinned (0) at their start.
    #[inline(always)]
    fn run(table: &Table<V>, steps: &[Step], upto: V, free: [V; 2]) -> [Self; 2] {
        let (mut first, mut second) = (Walk::new(free[0]), Walk::new(free[1]));
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        for (j, step) in steps.iter().enumerate() {
            let j = V::splat(j as f64);
            if !upto.any_above(j) {
                break;
            }
            // A lane that has arrived has no kick and no drift any more, and nothing to round.
            let moves = upto.if_above(j, one, zero);
            let k = table.kicks[step.kind];
            let k = Twofold { hi: k.hi.mul(moves), lo: k.lo.mul(moves) };
            let t = V::splat(step.length * table.tick).mul(moves);
            first.pass(k, t, moves);
            second.pass(k, t, moves);
        }
        [first, second]
    }

    #[inline(always)]
    fn new(free: V) -> Self {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let (x, v) = (Twofold { hi: free, lo: zero }, Twofold { hi: one.sub(free), lo: zero });
        Walk { x, v, dx: zero, dv: zero, exponent: zero, length: one, across: zero, along: zero }
    }

    #[inline(always)]
    fn pass(&mut self, k: Twofold<V>, t: V, moves: V) {
        self.dv = self.dv.sub(k.hi.mul(self.dx.add(self.x.hi)));
        let pull = k.times(self.x);
        self.v = self.v.minus(pull);
        self.account(pull.hi.abs().add(self.v.hi.abs()).mul(moves));
        self.dx = self.dx.add(t.mul(self.dv));
        let way = self.v.scaled(t);
        self.x = self.x.plus(way);
        self.account(way.hi.abs().add(self.x.hi.abs()).mul(moves));
        if let Some((factor, places)) = rescalings(self.length) {
            (self.x, self.v) = (self.x.scaled(factor), self.v.scaled(factor));
            (self.dx, self.dv) = (self.dx.mul(factor), self.dv.mul(factor));
            self.length = self.length.mul(factor);
            self.across = self.across.mul(factor.mul(factor));
            self.exponent = self.exponent.add(places);
        }
    }

    /// After an operation with a rounding of [`LOSS`] times `size`.
    #[inline(always)]
    fn account(&mut self, size: V) {
        self.length = self.x.hi.abs().add(self.v.hi.abs());
        self.across = self.across.add(size.mul(self.length));
        self.along = self.along.add(size.div(self.length));
    }

    /// Lane by lane.
    #[inline(always)]
    fn orbits(self) -> [Orbit; LANES] {
        let all = [
            self.x.hi,
            self.x.lo,
            self.v.hi,
            self.v.lo,
            self.dx,
            self.dv,
            self.exponent,
            self.length,
            self.across,
            self.along,
        ];
        let mut lanes = [[0.0; LANES]; 10];
        for (lanes, all) in lanes.iter_mut().zip(all) {
            all.store(lanes);
        }
        std::array::from_fn(|i| {
            let [x, x_lo, v, v_lo, dx, dv, exponent, length, across, along] = lanes.map(|lanes| lanes[i]);
            let (x, v) = (Twofold { hi: x, lo: x_lo }, Twofold { hi: v, lo: v_lo });
            Orbit { x, v, dx, dv, exponent: exponent as i64, length, across, along }
        })
    }
}

/// An orbit where it has arrived.
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
fn balance(left: [&Orbit; 2], right: [&Orbit; 2]) -> Value {
    let product = |[a, b]: [&Orbit; 2]| a.x.times(b.x).magnitude();
    let exponent = |[a, b]: [&Orbit; 2]| a.exponent + b.exponent;
    let (p, q, places) = (product(left), product(right), exponent(left) - exponent(right));
    let excess = p.scaled(power_of_two(places)).minus(q).hi / q.hi;
    let number = if excess.abs() < 0.5 {
        excess.ln_1p()
    } else {
        (p.hi / q.hi).ln() + places as f64 * std::f64::consts::LN_2
    };
    let rise = |[a, b]: [&Orbit; 2]| a.dx / a.x.hi + b.dx / b.x.hi;
    let stray = |[a, b]: [&Orbit; 2]| (a.off() / a.x.hi).abs() + (b.off() / b.x.hi).abs();
    Value { number, slope: rise(left) - rise(right), uncertainty: stray(left) + stray(right), exponent: 0 }
}
