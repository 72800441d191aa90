//! One mass on its clocks: the full period kick by kick, and the pivots of the action.

use num_traits::Zero;

use crate::verify::context::{Checked, holds};
use clocks::schedule::{KickDrift, Kicks, Schedule, Weight};
use number::{Ball, Rational, Sign, from_f64_exact, to_f64};

/// Bits of the full period: some hundred kicks lose as many.
pub const BITS: u32 = 512;

/// The most kicks of a period that are rechecked one by one.
const MOST_KICKS: u64 = 100_000;

/// One mass and its clocks: (step, stiffness), steps in fs.
pub struct Mass {
    pub steps: Vec<Rational>,
    pub stiffness: Vec<Ball>,
}

/// Q, column by column.
struct FullPeriod {
    columns: [[Ball; 2]; 2],
    tick: Ball,
    /// Per unit of time, in the middle of every drift.
    friction: Ball,
}

impl KickDrift<Ball> for FullPeriod {
    fn drift(&mut self, ticks: u64) {
        let time = self.tick.mul(&Ball::from_integer(&ticks.into()), BITS);
        let (half, decay) = (time.scale2(-1), time.mul(&self.friction, BITS).neg().exp(BITS));
        for [x, v] in &mut self.columns {
            *x = x.add(&v.mul(&half, BITS), BITS);
            *v = v.mul(&decay, BITS);
            *x = x.add(&v.mul(&half, BITS), BITS);
        }
    }

    fn kick(&mut self, strength: &Ball) {
        for [x, v] in &mut self.columns {
            *v = v.sub(&strength.mul(x, BITS), BITS);
        }
    }
}

impl Mass {
    fn schedule(&self) -> Checked<Schedule> {
        let schedule = Schedule::new(&self.steps, &vec![Rational::zero(); self.steps.len()])?;
        holds(schedule.strikes() <= MOST_KICKS, || {
            format!("a period of {} kicks is too long to recheck", schedule.strikes())
        })?;
        Ok(schedule)
    }

    fn strengths(&self) -> Vec<Ball> {
        let strength =
            |(step, stiffness): (&Rational, &Ball)| Ball::from_rational(step, BITS).mul(stiffness, BITS);
        self.steps.iter().zip(&self.stiffness).map(strength).collect()
    }

    /// Whether a clock has no stiffness.
    pub fn is_silent(&self, clock: usize) -> bool {
        self.stiffness[clock].sign() == Some(Sign::Zero)
    }

    /// This mass on the clocks that are not silent.
    pub fn heard(&self) -> Mass {
        let heard = || (0..self.steps.len()).filter(|&clock| !self.is_silent(clock));
        Mass {
            steps: heard().map(|clock| self.steps[clock].clone()).collect(),
            stiffness: heard().map(|clock| self.stiffness[clock].clone()).collect(),
        }
    }

    /// That the first region ends within an enclosure of outer steps at this ratio of steps.
    pub fn ends_within(&self, outer: &Rational, (lo, hi): (f64, f64), name: &str) -> Checked {
        let is_inside = |step: f64| self.scaled(&(exact(step) / outer)).in_first_region();
        holds(is_inside(lo)? != Some(false), || format!("{name} ends before {lo}"))?;
        holds(is_inside(hi)? != Some(true), || format!("{name} reaches beyond {hi}"))
    }

    /// This mass with another outermost step, which may be that of the clock before it: then both are one.
    pub fn with_outer(&self, outer: &Rational) -> Mass {
        let (mut steps, mut stiffness) = (self.steps.clone(), self.stiffness.clone());
        let last = steps.len() - 1;
        steps[last] = outer.clone();
        if last > 0 && steps[last] == steps[last - 1] {
            steps.pop();
            let ball = stiffness.pop().expect("two clocks");
            stiffness[last - 1] = stiffness[last - 1].add(&ball, BITS);
        }
        Mass { steps, stiffness }
    }

    /// This mass with all steps times `factor`.
    pub fn scaled(&self, factor: &Rational) -> Mass {
        Mass {
            steps: self.steps.iter().map(|step| step * factor).collect(),
            stiffness: self.stiffness.clone(),
        }
    }

    /// Tr Q and the period.
    pub fn trace(&self) -> Checked<(Ball, Rational)> {
        self.damped_trace(&Ball::zero())
    }

    /// Whether |Tr Q| < 1 + det Q with a friction (Jury).
    pub fn is_damped(&self, friction: &Rational) -> Checked<Option<bool>> {
        let friction = Ball::from_rational(friction, BITS);
        let (trace, period) = self.damped_trace(&friction)?;
        let det = friction.mul(&Ball::from_rational(&period, BITS), BITS).neg().exp(BITS);
        Ok(Ball::one().add(&det, BITS).sub(&trace.abs(), BITS).sign().map(|sign| sign == Sign::Positive))
    }

    fn damped_trace(&self, friction: &Ball) -> Checked<(Ball, Rational)> {
        let ([[a, _], [_, d]], period) = self.full_period(friction)?;
        Ok((a.add(&d, BITS), period))
    }

    /// R = (Λ1 + Λ2 + ...) Q12²/(1 − (Tr Q/2)²): what the invariant ellipse of Q says in the middle of a
    /// kick; half a kick leaves Q12 and Tr Q as they are.
    pub fn bias(&self) -> Checked<Option<Ball>> {
        let ([[a, _], [b, d]], _) = self.full_period(&Ball::zero())?;
        let sum = self.stiffness.iter().fold(Ball::zero(), |sum, stiffness| sum.add(stiffness, BITS));
        let below = Ball::one().sub(&a.add(&d, BITS).scale2(-1).square(BITS), BITS);
        Ok(sum.mul(&b.square(BITS), BITS).div(&below, BITS))
    }

    /// Q, column by column, and the period.
    fn full_period(&self, friction: &Ball) -> Checked<([[Ball; 2]; 2], Rational)> {
        let schedule = self.schedule()?;
        let (zero, one) = (Ball::zero(), Ball::one());
        let columns = [[one.clone(), zero.clone()], [zero, one]];
        let mut orbit = FullPeriod {
            columns,
            tick: Ball::from_rational(schedule.tick(), BITS),
            friction: friction.clone(),
        };
        Kicks::of_clocks(self.strengths(), |k| [k.clone(), k]).lead(schedule.staggered_period(), &mut orbit);
        let period = schedule.tick() * Rational::from_integer(schedule.period().into());
        Ok((orbit.columns, period))
    }

    /// Sign of |Tr| − 2.
    pub fn excess(&self) -> Checked<Option<Sign>> {
        Ok(self.trace()?.0.abs().sub(&Ball::from_integer(&2.into()), BITS).sign())
    }

    /// Whether J is positive with its first end free and its last one held, and the other way round.
    pub fn in_first_region(&self) -> Checked<Option<bool>> {
        let schedule = self.schedule()?;
        let tick = Ball::from_rational(schedule.tick(), BITS);
        let strengths = self.strengths();
        // (1/τ before the node, its kick).
        let mut nodes: Vec<(Option<Ball>, Ball)> = Vec::new();
        for event in schedule.half_period() {
            let time = tick.mul(&Ball::from_integer(&event.drift.into()), BITS);
            let spring = (event.drift > 0).then(|| Ball::one().div(&time, BITS).expect("time passes"));
            let kick = event.clocks().fold(Ball::zero(), |sum, clock| {
                let shift = if event.weight == Weight::Half { -1 } else { 0 };
                sum.add(&strengths[clock].scale2(shift), BITS)
            });
            nodes.push((spring, kick));
        }
        let last = nodes.len() - 1;
        let both = [(0, last - 1), (1, last)].map(|(from, upto)| positive(&nodes, from, upto));
        Ok(if both.contains(&Some(false)) {
            Some(false)
        } else {
            both.iter().all(|flag| *flag == Some(true)).then_some(true)
        })
    }
}

/// Whether all pivots of the form on the nodes `from` ..= `upto` are positive, the others held at 0.
fn positive(nodes: &[(Option<Ball>, Ball)], from: usize, upto: usize) -> Option<bool> {
    let mut pivot: Option<Ball> = None;
    for j in from..=upto {
        let left = nodes[j].0.clone().unwrap_or_else(Ball::zero);
        let right = nodes.get(j + 1).and_then(|next| next.0.clone()).unwrap_or_else(Ball::zero);
        let mut ball = left.add(&right, BITS).sub(&nodes[j].1, BITS);
        if let Some(before) = pivot {
            ball = ball.sub(&left.square(BITS).div(&before, BITS)?, BITS);
        }
        match ball.sign() {
            Some(Sign::Positive) => {}
            Some(_) => return Some(false),
            None => return None,
        }
        pivot = Some(ball);
    }
    Some(true)
}

pub fn exact(x: f64) -> Rational {
    from_f64_exact(x).unwrap_or_default()
}

/// That stable and unstable meet within the ends.
pub fn crosses(at: &impl Fn(f64) -> Mass, (lo, hi): (f64, f64), name: &str) -> Checked {
    let (a, b) = (at(lo).excess()?, at(hi).excess()?);
    let apart = a.zip(b).is_none_or(|(a, b)| a * b != Sign::Positive);
    holds(apart, || format!("no {name} end of an unstable interval lies in {lo}..{hi}"))
}

/// The growth that is told is the fastest inside the interval. It is compared at 16 places, then nearer
/// and nearer to the best of them: growth has one maximum there.
pub fn fastest_growth(at: &impl Fn(f64) -> Mass, (lo, hi): (f64, f64), steps: Option<f64>) -> Checked {
    let growth = |outer: f64| -> Checked<(f64, f64)> {
        let (trace, period) = at(outer).trace()?;
        // acosh by the excess over 2, of which doubles would keep little.
        let excess = trace.abs().sub(&Ball::from_integer(&2.into()), BITS).mid_f64().max(0.0);
        let ln = 2.0 * (excess / 4.0).sqrt().asinh();
        Ok((ln / to_f64(&period), outer))
    };
    let place = |k: f64| lo + (hi - lo) * k / 16.0;
    let mut best = (0.0, place(8.0));
    for k in 1..16 {
        let own = growth(place(f64::from(k)))?;
        best = if own.0 > best.0 { own } else { best };
    }
    let mut width = (hi - lo) / 16.0;
    while width > 1e-5 * (hi - lo) {
        for step in [best.1 - width, best.1 + width].into_iter().filter(|step| lo < *step && *step < hi) {
            let own = growth(step)?;
            best = if own.0 > best.0 { own } else { best };
        }
        width /= 2.0;
    }
    // The steps told are those where the rate is largest; near its maximum an error of the place of 1e-5
    // of the width changes little.
    let truth = std::f64::consts::LN_10 / (best.0 * best.1);
    // Where hardly anything grows the steps may be left out.
    let right = steps.map_or(truth > 1e9, |steps| (truth / steps - 1.0).abs() < 1e-3);
    holds(right, || format!("growth is tenfold in {truth} steps at worst"))
}
