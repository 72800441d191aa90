//! The second tier: kicks and drifts one by one, in as many bits as it takes.
//!
//! Position and velocity are integers with a common scale, at least `bits` bits long, so one unit is at most
//! 2^-bits |û|. A drift x += v n/d rounds once. A kick v −= k x rounds once and knows k to within
//! κ 2^-bits. Rescaling rounds once a component. So with κ ≥ 1 + max(|k|, t) every step has
//! ε ≤ (κ + 4) 2^-bits, and the theorem of [`super::bound`] applies. The route shares nothing with the first
//! tier: no angle, no square root, any stiffness.

use num_bigint::BigInt;
use num_traits::{FromPrimitive, Signed, ToPrimitive};

use super::balls::BallOrbit;
use super::bound::StepBound;
use super::ends::Nodes;
pub use super::ends::{End, Ends};
use super::leap;
use crate::propagator::TwoClocks;
use crate::schedule::{KickDrift, Kicks, Schedule};
use number::parallel::go_on;
use number::{Ball, Ratio, Real, Sign, power_of_two};

/// A state longer than `bits + HEADROOM` bits is scaled down.
const HEADROOM: u64 = 32;

/// Runs the half period with `bits` bits; `None` where the bound's conditions fail at that precision, and
/// where the work was stopped.
pub fn run<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule, bits: u32) -> Option<Ends> {
    let steps = Steps::new(clocks, schedule, bits)?;
    let end = |even| {
        go_on().ok()?;
        steps.end(schedule, Orbit { hears: true, ..Orbit::of(&steps, even) })
    };
    Some(Ends { even: end(true)?, odd: end(false)? })
}

/// The constants of the bound are doubles, so a precision beyond this one counts as this one.
const BOUNDED: u32 = 1000;

/// The kicks of the half period, or as many as leaping over them costs.
pub fn kicks(ratio: Ratio) -> u64 {
    if leap::is_worth(ratio) { leap::kicks(ratio) } else { ratio.kicks() / 2 }
}

/// As [`run`]; long runs of one clock's kicks by [`leap`]. Beyond 1000 bits, where its bound may leave
/// strengths of 10^90 and more no room however many bits there are, as [`run_balls`] where it must.
pub fn run_at_any<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule, bits: u32) -> Option<Ends> {
    if leap::is_worth(clocks.ratio()) {
        return Some(leap::run(clocks, schedule, bits));
    }
    run(clocks, schedule, bits).or_else(|| (bits > BOUNDED).then(|| run_balls(clocks, schedule, bits)))
}

/// The even or the odd solution alone.
pub fn run_one<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule, bits: u32, even: bool) -> Option<End> {
    let steps = Steps::new(clocks, schedule, bits)?;
    steps.end(schedule, Orbit::of(&steps, even))
}

/// Runs the half period in balls of `bits` bits: no condition, and enclosures that widen with every step.
pub fn run_balls<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule, bits: u32) -> Ends {
    let kicks = Kicks::of_two_clocks(clocks.enclosures(bits), |k| [k.clone(), k.scale2(-1)]);
    let end = |x: u8, v: u8| {
        let mut orbit = BallOrbit::new([x, v], schedule, bits);
        kicks.lead(schedule.half_period(), &mut orbit);
        orbit.end()
    };
    Ends { even: end(1, 0), odd: end(0, 1) }
}

/// The lengths and strengths of the events, and the constants of the bound.
struct Steps {
    bits: u32,
    /// Ticks in the unit of time h1.
    ticks: u64,
    /// Strengths times 2^places.
    kicks: Kicks<BigInt>,
    places: u64,
    bound: StepBound,
    count: u64,
    tau: f64,
}

impl Steps {
    fn new<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule, bits: u32) -> Option<Self> {
        let precision = bits + 16;
        let strengths = clocks.enclosures(precision);
        let strongest = strengths.iter().map(|k| k.mid_f64().abs()).fold(1.0, f64::max);
        let kappa = 1.01 * (1.0 + strongest);
        // 2^-1000 stands for anything smaller: the bound stays a bound.
        let bound = StepBound { kappa, epsilon: (kappa + 4.0) * power_of_two(-(bits.min(BOUNDED) as i32)) };
        // Each strike is at most a drift, a kick and a rescaling; the ends add two events.
        let count = 3 * (schedule.strikes() + 2);
        // A strength is cut off at 2^-places <= 2^-bits/16, its ball at 2^-bits/2^14 of the larger one.
        let places = u64::from(bits) + 4;
        let fixed = |k: &Ball| k.mid_scaled(places as i64).0;
        Some(Steps {
            bits,
            ticks: schedule.clocks()[0].step(),
            kicks: Kicks::of_two_clocks(strengths, |k| [fixed(&k), fixed(&k.scale2(-1))]),
            places,
            bound,
            count,
            tau: bound.tau(count)?,
        })
    }

    /// The solution at T/2.
    fn end(&self, schedule: &Schedule, mut orbit: Orbit) -> Option<End> {
        self.kicks.lead(schedule.half_period(), &mut orbit);
        if orbit.stopped { None } else { orbit.finish() }
    }

    /// 2|r_k|/|û_k| in units of 2^-bits.
    fn local(&self) -> f64 {
        2.0 * (self.bound.kappa + 4.0) * self.bound.growth()
    }
}

/// A solution on its way: (x, v) 2^exponent.
struct Orbit<'a> {
    steps: &'a Steps,
    x: BigInt,
    v: BigInt,
    exponent: i64,
    /// 2b/|û|², the bound on the angle to the exact orbit, in units of 2^-bits; and its largest value so far.
    angle: f64,
    worst: f64,
    nodes: Nodes,
    /// Whether it hears that the work was stopped, its kick times so far, and whether it was at one of them:
    /// then nothing is done any more.
    hears: bool,
    arrivals: u32,
    stopped: bool,
}

/// Kick times between two looks at whether the work goes on: some milliseconds.
const LOOK: u32 = 1 << 12;

impl<'a> Orbit<'a> {
    /// The even solution at t = 0, or the odd one.
    fn of(steps: &'a Steps, even: bool) -> Self {
        let (x, v) = (u8::from(even), u8::from(!even));
        let shift = u64::from(steps.bits) + HEADROOM / 2;
        let start = |n: u8| BigInt::from(n) << shift;
        let (x, v, exponent) = (start(x), start(v), -(shift as i64));
        Orbit {
            steps,
            x,
            v,
            exponent,
            angle: 0.0,
            worst: 0.0,
            nodes: Nodes::default(),
            hears: false,
            arrivals: 0,
            stopped: false,
        }
    }

    /// |û| in units of 2^bits of its own scale: between 1 and 2^34, to within 2^-50.
    fn length(&self) -> f64 {
        let bits = u64::from(self.steps.bits);
        let shift = bits.saturating_sub(64);
        let part = |n: &BigInt| (n >> shift).to_f64().unwrap_or(f64::INFINITY);
        part(&self.x).hypot(part(&self.v)) * power_of_two(-(bits.min(64) as i32))
    }

    /// After a step: what it added across the orbit, and the orbit's growth.
    fn account(&mut self, before: f64) {
        let ratio = before / self.length();
        // 1 + 2^-40 covers the rounding of the lengths and of this line.
        self.angle = (self.angle * ratio * ratio) * (1.0 + 2f64.powi(-40)) + self.steps.local();
        self.worst = self.worst.max(self.angle);
    }

    /// Keeps between `bits` and `bits + HEADROOM` bits; scaling up is exact.
    fn rescale(&mut self) {
        let (size, least) = (self.x.bits().max(self.v.bits()), u64::from(self.steps.bits) + 1);
        let goal = least + HEADROOM / 2;
        if size > least + HEADROOM {
            let before = self.length();
            self.x >>= size - goal;
            self.v >>= size - goal;
            self.account(before / power_of_two((size - goal) as i32));
        } else if size < least && size > 0 {
            self.x <<= goal - size;
            self.v <<= goal - size;
        } else {
            return;
        }
        self.exponent += size as i64 - goal as i64;
    }

    /// The uncertainty of a component in units of its own scale: τ |û|.
    fn uncertainty(&self) -> f64 {
        1.001 * self.angle * self.length()
    }

    /// The sign of a component of the exact orbit, where the angle proves it.
    fn certain_sign(&self, component: &BigInt) -> Option<Sign> {
        let beyond = component.abs().to_f64().unwrap_or(f64::INFINITY) > self.uncertainty();
        beyond.then(|| if component.is_negative() { Sign::Negative } else { Sign::Positive })
    }

    fn finish(mut self) -> Option<End> {
        // The last event may be a drift alone.
        self.rescale();
        let steps = self.steps;
        let within = self.worst <= steps.tau * power_of_two(steps.bits.min(BOUNDED) as i32);
        if !within {
            return None;
        }
        let signs = (self.certain_sign(&self.x), self.certain_sign(&self.v));
        let radius = BigInt::from_f64(self.uncertainty().ceil())?;
        // |a - 1| <= nω/(1 - nω) <= 4nω/3, nω in units of 2^-bits.
        let stretch =
            1.4 * steps.count as f64 * steps.bound.growth() * steps.bound.kappa * (5.0 + self.worst);
        let stretch = BigInt::from_f64(stretch.ceil())?;
        let unit = BigInt::from(1) << steps.bits;
        let length = between(&(&unit - &stretch), &(&unit + &stretch)).scale2(-i64::from(steps.bits));
        let precision = steps.bits + HEADROOM as u32;
        let component = |n: &BigInt| {
            between(&(n - &radius), &(n + &radius)).scale2(self.exponent).mul(&length, precision)
        };
        Some(End { x: component(&self.x), v: component(&self.v), signs, nodes: self.nodes.count() })
    }
}

impl KickDrift<BigInt> for Orbit<'_> {
    fn drift(&mut self, ticks: u64) {
        if self.stopped {
            return;
        }
        let before = self.length();
        self.x += &self.v * ticks / self.steps.ticks;
        self.account(before);
    }

    fn arrive(&mut self) {
        self.arrivals = self.arrivals.wrapping_add(1);
        self.stopped |= self.hears && self.arrivals.is_multiple_of(LOOK) && go_on().is_err();
        if self.stopped {
            return;
        }
        self.nodes.see(self.certain_sign(&self.x));
    }

    fn kick(&mut self, strength: &BigInt) {
        if self.stopped {
            return;
        }
        let before = self.length();
        self.v -= (strength * &self.x) >> self.steps.places;
        self.account(before);
        self.rescale();
    }
}

/// The ball of all numbers between two integers.
fn between(lo: &BigInt, hi: &BigInt) -> Ball {
    let precision = lo.bits().max(hi.bits()).max(64) as u32;
    Ball::from_integer(lo).union(&Ball::from_integer(hi), precision)
}
