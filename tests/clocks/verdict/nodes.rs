//! Another program for long periods, to compare with: states right after slow kicks, functions as values at
//! nodes, integers of 400 bits for numbers, no bounds. Nothing of it is shared with the library.

use kickdrift::number::rational::to_f64;
use kickdrift::number::{Laurent, Rational, Real};
use kickdrift::propagator::Oscillator;
use kickdrift::verdict::{Kind, decide_long, long_growth};
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive};

const BITS: u32 = 400;
const NODES: usize = 36;

/// x 2^400, rounded.
type Fixed = BigInt;
type Matrix = [Fixed; 4];

fn one() -> Fixed {
    BigInt::from(1) << BITS
}

fn fixed(x: &Rational) -> Fixed {
    (x.numer() << BITS) / x.denom()
}

fn times(a: &Fixed, b: &Fixed) -> Fixed {
    (a * b) >> BITS
}

fn over(a: &Fixed, b: &Fixed) -> Fixed {
    (a << BITS) / b
}

fn product([a, b, c, d]: &Matrix, [e, f, g, h]: &Matrix) -> Matrix {
    let of = |a, e, b, g| times(a, e) + times(b, g);
    [of(a, e, b, g), of(a, f, b, h), of(c, e, d, g), of(c, f, d, h)]
}

fn kick(strength: &Fixed) -> Matrix {
    [one(), BigInt::from(0), -strength, one()]
}

fn drift(time: &Fixed) -> Matrix {
    [one(), time.clone(), BigInt::from(0), one()]
}

/// Nodes in 0..1 and their barycentric weights.
struct Nodes {
    at: Vec<Fixed>,
    weights: Vec<Fixed>,
}

impl Nodes {
    fn new() -> Nodes {
        let near = |i: usize| 0.5 - 0.5 * ((i as f64 + 0.5) * std::f64::consts::PI / NODES as f64).cos();
        let at: Vec<Fixed> = (0..NODES).map(|i| fixed(&Rational::from_float(near(i)).unwrap())).collect();
        // Times 4 for each other node, so that they are of ordinary size.
        let weight = |i: usize| {
            (0..NODES).filter(|&j| j != i).fold(one(), |own, j| over(&(own >> 2u32), &(&at[i] - &at[j])))
        };
        let weights = (0..NODES).map(weight).collect();
        Nodes { at, weights }
    }
}

/// 2^exponent times the values at the nodes of start..start + length, in units of 1/q.
struct Branch {
    values: Vec<Matrix>,
    exponent: i64,
    start: i128,
    length: i128,
    stride: i128,
    height: i128,
}

/// Values of one size, and the power of two taken out.
fn balanced(values: &mut [Matrix]) -> i64 {
    let bits = values.iter().flatten().map(BigInt::bits).max().unwrap_or(0) as i64 - i64::from(BITS);
    values.iter_mut().flatten().for_each(|x| if bits > 0 { *x >>= bits } else { *x <<= -bits });
    bits
}

impl Branch {
    /// At a place, a whole number and a part, in units of 1/q.
    fn value(&self, nodes: &Nodes, place: &Fixed) -> Matrix {
        let t = (place - (BigInt::from(self.start) << BITS)) / BigInt::from(self.length);
        if let Some(i) = nodes.at.iter().position(|own| *own == t) {
            return self.values[i].clone();
        }
        let mut below = BigInt::from(0);
        let mut above = [const { BigInt::ZERO }; 4];
        for ((at, weight), value) in nodes.at.iter().zip(&nodes.weights).zip(&self.values) {
            let share = over(weight, &(&t - at));
            above.iter_mut().zip(value).for_each(|(sum, x)| *sum += times(&share, x));
            below += share;
        }
        above.map(|x| over(&x, &below))
    }

    /// k steps of this branch after or before one of another one, on length units from start.
    fn joined(
        &self,
        k: i128,
        other: &Branch,
        first: bool,
        nodes: &Nodes,
        [start, length, stride]: [i128; 3],
    ) -> Branch {
        let mut values = Vec::new();
        for t in &nodes.at {
            let mut place = (BigInt::from(start) << BITS) + t * BigInt::from(length);
            let mut all = [one(), BigInt::from(0), BigInt::from(0), one()];
            let mut go = |branch: &Branch, steps: i128| {
                for _ in 0..steps {
                    all = product(&branch.value(nodes, &place), &all);
                    place += BigInt::from(branch.stride) << BITS;
                }
            };
            if first {
                go(self, k);
                go(other, 1);
            } else {
                go(other, 1);
                go(self, k);
            }
            values.push(all);
        }
        let exponent = balanced(&mut values) + self.exponent * k as i64 + other.exponent;
        Branch { values, exponent, start, length, stride, height: self.height * k + other.height }
    }

    fn restricted(&self, nodes: &Nodes, start: i128, length: i128) -> Branch {
        let place = |t: &Fixed| (BigInt::from(start) << BITS) + t * BigInt::from(length);
        let values = nodes.at.iter().map(|t| self.value(nodes, &place(t))).collect();
        Branch { values, start, length, ..*self }
    }
}

/// ln |Tr Q| and the sign of Tr Q where |Tr Q| > 2, else `None` and Tr Q.
fn trace(oscillator: &Oscillator, nodes: &Nodes) -> (Option<f64>, f64) {
    let clocks = oscillator.long_clocks();
    let [p, q] = [clocks.ratio().numer(), clocks.ratio().denom()].map(|n| n.to_i128().unwrap());
    let [s, k] = [clocks.fast(), clocks.slow()].map(|x| fixed(&x.enclosure(BITS).lower()));
    let (whole, rest) = (p / q, p % q);
    let part = |n: i128| over(&BigInt::from(n), &BigInt::from(q));
    // From right after a slow kick, x behind a fast one, through m fast ones to right after the next, y
    // behind one.
    let step = |x: &Fixed, m: i128, y: &Fixed| {
        let mut all = drift(&(one() - x));
        for n in 0..m {
            if n > 0 {
                all = product(&drift(&one()), &all);
            }
            all = product(&kick(&s), &all);
        }
        product(&kick(&k), &product(&drift(y), &all))
    };
    let branch = |start: i128, length: i128, stride: i128, m: i128| {
        let place = |t: &Fixed| (BigInt::from(start) << BITS) + t * BigInt::from(length);
        let value = |t: &Fixed| {
            let x = place(t);
            let y = &x + (BigInt::from(stride) << BITS);
            step(&(x / BigInt::from(q)), m, &(y / BigInt::from(q)))
        };
        Branch { values: nodes.at.iter().map(value).collect(), exponent: 0, start, length, stride, height: 1 }
    };
    assert!(whole > 0, "the fast clock strikes between two slow kicks");
    let mut levels = vec![(branch(0, q - rest, rest, whole), branch(q - rest, rest, rest - q, whole + 1))];
    let n = q / 2;
    loop {
        let (left, right) = levels.last().unwrap();
        let (a, b) = (left.length, right.length);
        let next = if a >= b {
            let steps = a / b;
            let new = left.joined(steps, right, true, nodes, [a % b, b, -(a % b)]);
            (new.height <= n && a % b > 0).then(|| (left.restricted(nodes, 0, a % b), new))
        } else {
            let steps = (b - 1) / a;
            let new = right.joined(steps, left, false, nodes, [0, a, b - steps * a]);
            (new.height <= n).then(|| (new, right.restricted(nodes, a, b - steps * a)))
        };
        let Some(next) = next else { break };
        levels.push(next);
    }
    // From the middle of both kicks at t = 0 on.
    let mut all = kick(&((&s + &k) >> 1u32));
    let (mut exponent, mut x, mut left) = (0, 0, n);
    for (one, other) in levels.iter().rev() {
        loop {
            let branch = if x < one.length { one } else { other };
            if branch.height > left {
                break;
            }
            all = product(&branch.value(nodes, &(BigInt::from(x) << BITS)), &all);
            exponent += branch.exponent + balanced(std::slice::from_mut(&mut all));
            (x, left) = (x + branch.stride, left - branch.height);
        }
    }
    assert_eq!(left, 0);
    if q % 2 == 0 {
        all = product(&kick(&-(&k >> 1u32)), &all);
    } else {
        // Up to T/2, half a slow step later: fast kicks there, the last one half where it is at T/2.
        let mut now = part(x);
        let mut rest = over(&BigInt::from(p), &BigInt::from(2 * q));
        while rest > one() - &now - (one() >> 300u32) {
            let first = one() - &now;
            let is_last = (&rest - &first).abs() < one() >> 300u32;
            all =
                product(&kick(&if is_last { &s >> 1u32 } else { s.clone() }), &product(&drift(&first), &all));
            rest -= first;
            now = BigInt::from(0);
        }
        all = product(&drift(&rest), &all);
    }
    let [a, b, c, d] = &all;
    let half = |x: Fixed| {
        let bits = x.bits() as i64;
        let mantissa = if bits > 60 {
            (x >> (bits - 60)).to_f64().unwrap()
        } else {
            x.to_f64().unwrap() * 2f64.powi(60 - bits as i32)
        };
        (mantissa, bits - 60 - i64::from(BITS))
    };
    let (mantissa, power) = half(times(a, d) + times(b, c));
    let power = power + 2 * exponent + 1;
    let ln = mantissa.abs().ln() + power as f64 * std::f64::consts::LN_2;
    if ln > 2f64.ln() { (Some(ln), mantissa.signum()) } else { (None, mantissa * 2f64.powi(power as i32)) }
}

/// Pairs of doubles with p and q near 2^53.
#[test]
fn doubles_are_decided_as_by_values_at_nodes() {
    let nodes = Nodes::new();
    let mut state = 5u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let exact = |x: f64| Laurent::from_rational(Rational::from_float(x).unwrap());
    // What this program loses itself: 2^53 passes of what 36 nodes leave out, some 10^-30 each, and the
    // rounding to a double.
    const OWN: f64 = 1e-12;
    let (mut stable, mut unstable) = (0, 0);
    while stable + unstable < 12 || unstable < 3 {
        let (h1, h2) = (0.3 + 0.3 * random(), 0.6 + 2.4 * random());
        let oscillator = Oscillator::new(exact(9.9), exact(1.1), exact(h1), exact(h2)).unwrap();
        let decision = decide_long(&oscillator.long_clocks()).unwrap();
        if decision.verdict.is_stable() && stable >= 9 {
            continue;
        }
        let growth = long_growth(&oscillator.long_clocks(), decision.verdict).unwrap();
        let (ln, trace) = trace(&oscillator, &nodes);
        let name = format!("h1 = {h1}, h2 = {h2}, h2/h1 = {}", to_f64(oscillator.ratio()));
        match (decision.verdict.kind(), ln) {
            (Kind::Elliptic, None) => {
                stable += 1;
                let (lo, hi) = growth.trace.to_f64_enclosure();
                assert!(lo - OWN < trace && trace < hi + OWN, "{name}: {trace} is not in {lo}..{hi}");
            }
            (Kind::Hyperbolic, Some(ln)) => {
                unstable += 1;
                assert_eq!(f64::from(decision.verdict.side()), trace, "{name}");
                // ln |Tr| is ln μ up to ln(1 + μ^-2).
                let (lo, hi) = growth.ln_multiplier.unwrap().to_f64_enclosure();
                let beside = (-2.0 * lo).exp() + OWN * ln.abs();
                assert!(lo - beside < ln && ln < hi + beside, "{name}: {ln} is not in {lo}..{hi}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}
