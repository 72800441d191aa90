//! The ways to compute a trace that are compared, each as anyone would write it.

use kickdrift::number::rational::{from_f64_exact, to_f64};
use kickdrift::number::{Ball, Rational};
use kickdrift::propagator::TwoClocks;
use kickdrift::schedule::{Event, Schedule, Weight};
use kickdrift::verdict::{Limits, decide, exact_trace, filter_trace, growth};

/// A way to compute Tr Q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    SingleFull,
    DoubleFull,
    DoubleHalf,
    DoubleDouble,
    Filter,
    Balls(u32),
    Refine,
    Exact,
}

impl Method {
    pub const ALL: [Method; 10] = [
        Method::SingleFull,
        Method::DoubleFull,
        Method::DoubleHalf,
        Method::DoubleDouble,
        Method::Filter,
        Method::Balls(64),
        Method::Balls(128),
        Method::Balls(256),
        Method::Refine,
        Method::Exact,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Method::SingleFull => "f32, full period",
            Method::DoubleFull => "f64, full period",
            Method::DoubleHalf => "f64, half period",
            Method::DoubleDouble => "double-double, half",
            Method::Filter => "filter, certified",
            Method::Balls(64) => "balls, 64 bits",
            Method::Balls(128) => "balls, 128 bits",
            Method::Balls(_) => "balls, 256 bits",
            Method::Refine => "refine, certified",
            Method::Exact => "exact",
        }
    }

    /// The most kicks in a period for which it is worth waiting.
    pub fn patience(self) -> u64 {
        match self {
            Method::Exact => 20_000,
            Method::Balls(_) => 100_000,
            _ => u64::MAX,
        }
    }

    /// The trace, as the method has it; `None` where it has no number to show (overflow, or no certificate).
    pub fn trace(self, clocks: &TwoClocks<Rational>) -> Option<Rational> {
        let middle = |ball: Ball| Some((ball.lower() + ball.upper()) / Rational::from_integer(2.into()));
        match self {
            Method::SingleFull => from_f64_exact(f64::from(full::<f32>(clocks))),
            Method::DoubleFull => from_f64_exact(full::<f64>(clocks)),
            Method::DoubleHalf => from_f64_exact(half::<f64>(clocks)),
            Method::DoubleDouble => {
                let Double { hi, lo } = half::<Double>(clocks);
                Some(from_f64_exact(hi)? + from_f64_exact(lo)?)
            }
            Method::Filter => middle(filter_trace(clocks)?),
            Method::Balls(bits) => middle(balls(clocks, bits)),
            Method::Refine => {
                // The verdict decides how close to ±2 the trace has to be known.
                let limits = Limits { kicks: u64::MAX };
                let verdict = decide(clocks, &limits).ok()?.verdict;
                middle(growth(clocks, verdict, &limits).ok()?.trace)
            }
            Method::Exact => Some(exact_trace(clocks)),
        }
    }
}

/// What the loops need of a number.
pub trait Float: Copy {
    fn of(x: &Rational) -> Self;
    /// a/b.
    fn quotient(a: u64, b: u64) -> Self;
    fn plus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn minus(self) -> Self;
}

macro_rules! float {
    ($float:ty) => {
        impl Float for $float {
            fn of(x: &Rational) -> Self {
                to_f64(x) as $float
            }
            fn quotient(a: u64, b: u64) -> Self {
                a as $float / b as $float
            }
            fn plus(self, other: Self) -> Self {
                self + other
            }
            fn times(self, other: Self) -> Self {
                self * other
            }
            fn minus(self) -> Self {
                -self
            }
        }
    };
}
float!(f32);
float!(f64);

/// hi + lo, |lo| at most half a unit in the last place of hi: Dekker's double-double.
#[derive(Clone, Copy, Debug)]
pub struct Double {
    pub hi: f64,
    pub lo: f64,
}

fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let part = hi - a;
    Double { hi, lo: (a - (hi - part)) + (b - part) }
}

impl Float for Double {
    fn of(x: &Rational) -> Self {
        let hi = to_f64(x);
        let rest = from_f64_exact(hi).map_or(0.0, |hi| to_f64(&(x - hi)));
        Double { hi, lo: rest }
    }
    fn quotient(a: u64, b: u64) -> Self {
        let (a, b) = (a as f64, b as f64);
        let hi = a / b;
        Double { hi, lo: hi.mul_add(-b, a) / b }
    }
    fn plus(self, other: Self) -> Self {
        let (sum, low) = (two_sum(self.hi, other.hi), two_sum(self.lo, other.lo));
        let first = two_sum(sum.hi, sum.lo + low.hi);
        two_sum(first.hi, first.lo + low.lo)
    }
    fn times(self, other: Self) -> Self {
        let hi = self.hi * other.hi;
        let lo = self.hi.mul_add(other.hi, -hi) + (self.hi * other.lo + self.lo * other.hi);
        two_sum(hi, lo)
    }
    fn minus(self) -> Self {
        Double { hi: -self.hi, lo: -self.lo }
    }
}

/// Strengths of each set of clocks, whole and halved; ticks in h1.
struct Constants<T> {
    kicks: [[T; 4]; 2],
    ticks: u64,
}

impl<T: Float> Constants<T> {
    fn new(clocks: &TwoClocks<Rational>, schedule: &Schedule) -> Self {
        let (fast, slow) = (clocks.fast(), clocks.slow());
        let zero = Rational::from_integer(0.into());
        let half = T::quotient(1, 2);
        let whole = [&zero, fast, slow, &(fast + slow)].map(T::of);
        Constants { kicks: [whole, whole.map(|k| k.times(half))], ticks: schedule.clocks()[0].step() }
    }

    /// (x, v) after the events.
    fn compose(&self, events: impl Iterator<Item = Event>, mut states: [[T; 2]; 2]) -> [[T; 2]; 2] {
        for event in events {
            let drift = T::quotient(event.drift, self.ticks);
            let kick = self.kicks[usize::from(event.weight == Weight::Half)][event.kicks as usize];
            for [x, v] in &mut states {
                *x = x.plus(v.times(drift));
                *v = v.plus(x.times(kick).minus());
            }
        }
        states
    }
}

fn start<T: Float>() -> [[T; 2]; 2] {
    let [zero, one] = [0, 1].map(|n| T::of(&Rational::from_integer(n.into())));
    [[one, zero], [zero, one]]
}

fn schedule(clocks: &TwoClocks<Rational>) -> Schedule {
    Schedule::two_clocks(clocks.ratio()).expect("a short period")
}

fn full<T: Float>(clocks: &TwoClocks<Rational>) -> T {
    let schedule = schedule(clocks);
    let states: [[T; 2]; 2] = start();
    let [even, odd] = Constants::new(clocks, &schedule).compose(schedule.symmetric_period(), states);
    even[0].plus(odd[1])
}

fn half<T: Float>(clocks: &TwoClocks<Rational>) -> T {
    let schedule = schedule(clocks);
    let [even, odd] = Constants::<T>::new(clocks, &schedule).compose(schedule.half_period(), start());
    // Tr = 2 (AD + BC).
    let sum: T = even[0].times(odd[1]).plus(odd[0].times(even[1]));
    sum.plus(sum)
}

fn balls(clocks: &TwoClocks<Rational>, bits: u32) -> Ball {
    let schedule = schedule(clocks);
    let of = |x: &Rational| Ball::from_rational(x, bits);
    let (fast, slow) = (of(clocks.fast()), of(clocks.slow()));
    let kicks = [Ball::zero(), fast.clone(), slow.clone(), fast.add(&slow, bits)];
    let ticks = schedule.clocks()[0].step();
    let end = |mut x: Ball, mut v: Ball| {
        for event in schedule.half_period() {
            x = x.add(&v.mul(&of(&Rational::new(event.drift.into(), ticks.into())), bits), bits);
            let halvings = i64::from(event.weight == Weight::Half);
            v = v.sub(&kicks[event.kicks as usize].scale2(-halvings).mul(&x, bits), bits);
        }
        (x, v)
    };
    let ((a, c), (b, d)) = (end(Ball::one(), Ball::zero()), end(Ball::zero(), Ball::one()));
    a.mul(&d, bits).add(&b.mul(&c, bits), bits).scale2(1)
}
