//! Advice: the full period kick by kick in balls of many bits, and the first region by the pivots of its action.
//!
//! The action of a path over the half period, J = Σ |x_j − x_(j−1)|²/τ_j − Σ k_j x_j², is a tridiagonal form; it is positive iff all pivots of
//! its elimination are (Sylvester). That is another route than the strings of the tongues and than the orbits of many clocks.

use serde_json::Value;

use super::context::{Checked, Context, Outcome, Place, holds, same};
use super::written::{Ends, Written, nullable};
use crate::error::Result;
use crate::number::rational::from_f64_exact;
use crate::number::{Ball, Laurent, Rational, Real, Sign};
use crate::schedule::{KickDrift, Kicks, Schedule, Weight};
use crate::verdict::Kind;
use num_traits::{One, Zero};

const ROUTE: &str =
    "the full period, kick by kick, in balls of 512 bits; the first region by the pivots of its action";

/// Bits of the full period: some hundred kicks lose as many.
const BITS: u32 = 512;

/// The most kicks of a period that are rechecked one by one.
const MOST_KICKS: u64 = 100_000;

rows! {
    /// `kickdrift/advise/1`.
    pub struct Claim {
        input: Input,
        modes: Vec<ModeRow>,
        schemes: Vec<SchemeRow>,
        rows: Vec<Row>,
        pairs: Vec<Pair>,
        published: Vec<Value>,
        engine: Option<Value>,
        unknown: Vec<String>,
    }

    struct Input {
        band: Written<Rational>,
        modes: Vec<Mode>,
        schemes: Vec<Vec<Written<Rational>>>,
        length: Option<Written<Rational>>,
    }

    struct Mode {
        name: String,
        from: String,
        clock: u64,
        stiffness: Written<Laurent>,
    }

    struct ModeRow {
        name: String,
        from: String,
        clock: u64,
        stiffness: Written<Laurent>,
        period: Ends,
        verlet: Ends,
        half: Ends,
        third: Ends,
        quarter: Ends,
        fifth: Ends,
        tenth: Ends,
        #[serde(deserialize_with = "nullable")]
        before: Option<f64>,
    }

    struct SchemeRow {
        outer: Written<Rational>,
        status: String,
        band_edge: Ends,
        #[serde(deserialize_with = "nullable")]
        largest: Option<Written<Rational>>,
        #[serde(deserialize_with = "nullable")]
        safe: Option<Written<Rational>>,
        #[serde(deserialize_with = "nullable")]
        needs: Option<f64>,
        #[serde(deserialize_with = "nullable")]
        within_run: Option<bool>,
    }

    struct Row {
        scheme: u64,
        outer: Written<Rational>,
        mode: String,
        kind: Written<Kind>,
        trace: Ends,
        growth_rate: Ends,
        #[serde(deserialize_with = "nullable")]
        tenfold_steps: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        first_lower: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        first_upper: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        first_tenfold_steps: Option<f64>,
        #[serde(deserialize_with = "nullable")]
        inside_lower: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        inside_upper: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        inside_tenfold_steps: Option<f64>,
        #[serde(deserialize_with = "nullable")]
        below_lower: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        below_upper: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        below_tenfold_steps: Option<f64>,
        #[serde(deserialize_with = "nullable")]
        above_lower: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        above_upper: Option<Ends>,
        #[serde(deserialize_with = "nullable")]
        above_tenfold_steps: Option<f64>,
    }

    struct Pair {
        scheme: u64,
        first: String,
        second: String,
        near: f64,
    }
}

impl Place for Row {
    fn place(&self) -> String {
        format!("scheme {}, mode {}", self.scheme, self.mode)
    }
}

/// One mass and its clocks: (step, stiffness), steps in fs.
struct Mass {
    steps: Vec<Rational>,
    stiffness: Vec<Ball>,
}

/// Q, column by column.
struct FullPeriod {
    columns: [[Ball; 2]; 2],
    tick: Ball,
}

impl KickDrift<Ball> for FullPeriod {
    fn drift(&mut self, ticks: u64) {
        let time = self.tick.mul(&Ball::from_integer(&ticks.into()), BITS);
        for [x, v] in &mut self.columns {
            *x = x.add(&v.mul(&time, BITS), BITS);
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

    /// The same with all steps times `factor`.
    fn scaled(&self, factor: &Rational) -> Mass {
        Mass {
            steps: self.steps.iter().map(|step| step * factor).collect(),
            stiffness: self.stiffness.clone(),
        }
    }

    /// Tr Q and the period.
    fn trace(&self) -> Checked<(Ball, Rational)> {
        let schedule = self.schedule()?;
        let (zero, one) = (Ball::zero(), Ball::one());
        let columns = [[one.clone(), zero.clone()], [zero, one]];
        let mut orbit = FullPeriod { columns, tick: Ball::from_rational(schedule.tick(), BITS) };
        Kicks::of_clocks(self.strengths(), |k| [k.clone(), k]).lead(schedule.staggered_period(), &mut orbit);
        let [[a, _], [_, d]] = &orbit.columns;
        Ok((a.add(d, BITS), schedule.tick() * Rational::from_integer(schedule.period().into())))
    }

    /// Sign of |Tr| − 2.
    fn excess(&self) -> Checked<Option<Sign>> {
        Ok(self.trace()?.0.abs().sub(&Ball::from_integer(&2.into()), BITS).sign())
    }

    /// Whether J is positive with its first end free and its last one held, and the other way round.
    fn in_first_region(&self) -> Checked<Option<bool>> {
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
            both.iter().all(|own| *own == Some(true)).then_some(true)
        })
    }
}

/// Whether all pivots of the form on the nodes `from` ..= `upto` are positive, the others held at 0.
fn positive(nodes: &[(Option<Ball>, Ball)], from: usize, upto: usize) -> Option<bool> {
    let mut pivot: Option<Ball> = None;
    for j in from..=upto {
        let left = nodes[j].0.clone().unwrap_or_else(Ball::zero);
        let right = nodes.get(j + 1).and_then(|next| next.0.clone()).unwrap_or_else(Ball::zero);
        let mut own = left.add(&right, BITS).sub(&nodes[j].1, BITS);
        if let Some(before) = pivot {
            own = own.sub(&left.square(BITS).div(&before, BITS)?, BITS);
        }
        match own.sign() {
            Some(Sign::Positive) => {}
            Some(_) => return Some(false),
            None => return None,
        }
        pivot = Some(own);
    }
    Some(true)
}

impl Claim {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let mut outcome =
            context.outcome(ROUTE, ("the schemes", self.whole()), &self.rows, |row| self.row(row))?;
        outcome.not_rechecked.extend([
            "that no other unstable interval lies nearer to a scheme than those of below and above",
            "tenfold_steps of intervals: held against 64 places inside, to a hundredth",
            "statement and source of published, unknown: words",
            "before: the masses are not part of the document; held to be shorter",
        ]);
        if self.engine.is_some() {
            outcome.not_rechecked.push("engine: its text is not part of the document");
        }
        Ok(outcome)
    }

    /// The stiffest mode on each clock, or this one on its own.
    fn mass(&self, scheme: usize, mode: Option<&Mode>) -> Checked<Mass> {
        let steps: Vec<Rational> = match self.input.schemes.get(scheme) {
            Some(steps) => steps.iter().map(|step| step.0.clone()).collect(),
            None => {
                return holds(false, || format!("there is no scheme {}", scheme + 1))
                    .map(|()| unreachable!());
            }
        };
        let of = |clock: usize| {
            let own = mode.filter(|mode| mode.clock == clock as u64 + 1);
            let on = self.input.modes.iter().filter(move |mode| mode.clock == clock as u64 + 1);
            let stiffest = own.or_else(|| on.max_by(|a, b| a.stiffness.cmp(&b.stiffness)));
            stiffest.map_or_else(Ball::zero, |mode| mode.stiffness.enclosure(BITS))
        };
        let stiffness = (0..steps.len()).map(of).collect();
        Ok(Mass { steps, stiffness })
    }

    /// The stiffest modes with the shortest periods of the band.
    fn corner(&self, scheme: usize) -> Checked<Mass> {
        let mut mass = self.mass(scheme, None)?;
        let shorter = Ball::from_rational(&(Rational::one() - &self.input.band.0), BITS);
        let square = shorter.square(BITS);
        for stiffness in &mut mass.stiffness {
            *stiffness = stiffness.div(&square, BITS).unwrap_or_else(|| stiffness.clone());
        }
        Ok(mass)
    }

    fn whole(&self) -> Checked {
        let Input { band, modes, schemes, length } = &self.input;
        holds(band.0 >= Rational::zero() && band.0 < Rational::one(), || {
            format!("the band {} is none", band.0)
        })?;
        holds(!self.unknown.is_empty(), || "something is always unknown".into())?;
        same("the number of modes", self.modes.len(), modes.len())?;
        same("the number of schemes", self.schemes.len(), schemes.len())?;
        for (row, mode) in self.modes.iter().zip(modes) {
            let told = (&row.name, &row.from, row.clock, &row.stiffness.0);
            holds(told == (&mode.name, &mode.from, mode.clock, &mode.stiffness.0), || {
                format!("mode {} is not the input's", row.name)
            })?;
            row.holds()?;
        }
        for (n, scheme) in self.schemes.iter().enumerate() {
            self.scheme(n, scheme)?;
            let grows = self.of(n).any(|row| row.tenfold_steps.is_some());
            holds(scheme.within_run.is_some() == (grows && length.is_some()), || {
                "within_run is told of what grows in a run".into()
            })?;
        }
        for pair in &self.pairs {
            self.pair(pair)?;
        }
        self.published()
    }

    fn of(&self, scheme: usize) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.scheme == scheme as u64 + 1)
    }

    fn named(&self, name: &str) -> Checked<&ModeRow> {
        let found = self.modes.iter().find(|mode| mode.name == name);
        holds(found.is_some(), || format!("there is no mode {name}"))?;
        Ok(found.expect("just seen"))
    }

    /// The shortest period on any clock but the outermost.
    fn fastest(&self) -> Checked<&ModeRow> {
        let last = self.input.schemes.first().map_or(0, Vec::len) as u64;
        let inner = self.modes.iter().filter(|mode| last == 1 || mode.clock < last);
        let by = |a: &&ModeRow, b: &&ModeRow| a.stiffness.cmp(&b.stiffness);
        let found = inner.max_by(by).or_else(|| self.modes.iter().max_by(by));
        holds(found.is_some(), || "there is no mode".into())?;
        Ok(found.expect("just seen"))
    }

    fn scheme(&self, n: usize, row: &SchemeRow) -> Checked {
        let corner = self.corner(n)?;
        let outer = corner.steps.last().cloned().unwrap_or_default();
        holds(row.outer.0 == outer, || format!("the outer step of scheme {} is {outer}", n + 1))?;
        let in_band = corner.in_first_region()? == Some(true);
        // The lowest first edge, times 1 − band.
        let edges: Vec<Ends> = self.of(n).filter_map(|row| row.first_lower).collect();
        let least = |pick: fn(&Ends) -> f64| edges.iter().map(pick).fold(f64::INFINITY, f64::min);
        let shrink = |x: f64| Ball::from_rational(&(exact(x) * (Rational::one() - &self.input.band.0)), BITS);
        let (lo, hi) = (shrink(least(|e| e.lo)), shrink(least(|e| e.hi)));
        holds(exact(row.band_edge.lo) <= lo.upper() && hi.lower() <= exact(row.band_edge.hi), || {
            "band_edge is not that of the rows".into()
        })?;
        let third = exact(self.fastest()?.third.lo);
        let stable = self.of(n).all(|row| matches!(*row.kind, Kind::Elliptic | Kind::Coexistence));
        let before = self.of(n).all(|row| row.first_lower.is_some_and(|edge| outer < exact(edge.lo)));
        let status = match () {
            () if !stable => "unstable",
            () if in_band && outer < third => "safe",
            () if in_band => "caution",
            () if before => "near",
            () => "island",
        };
        same("status", row.status.as_str(), status)?;
        self.largest(&corner, row)?;
        let Some(needs) = row.needs else { return Ok(()) };
        let with = |period: f64| -> Checked<Option<bool>> {
            let turn = Ball::pi(BITS).scale2(1);
            let shorter = exact(period) * (Rational::one() - &self.input.band.0);
            let frequency = turn.div(&Ball::from_rational(&shorter, BITS), BITS).unwrap_or_else(Ball::zero);
            let mut stiffness = corner.stiffness.clone();
            *stiffness.last_mut().expect("a clock") = frequency.square(BITS);
            Mass { steps: corner.steps.clone(), stiffness }.in_first_region()
        };
        let right = needs > 0.0
            && needs.is_finite()
            && with(needs)? == Some(true)
            && with(0.99 * needs)? == Some(false);
        holds(right, || "needs is not the shortest slow period".into())
    }

    /// That the band's corner is in the first region at `largest`, and not at the next multiple; and `safe` below T/3.
    fn largest(&self, corner: &Mass, row: &SchemeRow) -> Checked {
        let count = corner.steps.len();
        let third = exact(self.fastest()?.third.lo);
        let with = |outer: &Rational| -> Checked<bool> {
            let mut steps = corner.steps.clone();
            steps[count - 1] = outer.clone();
            let mut stiffness = corner.stiffness.clone();
            if count > 1 && steps[count - 1] == steps[count - 2] {
                steps.pop();
                let last = stiffness.pop().expect("two clocks");
                let sum = stiffness[count - 2].add(&last, BITS);
                stiffness[count - 2] = sum;
            }
            Ok(Mass { steps, stiffness }.in_first_region()? == Some(true))
        };
        let Some(largest) = &row.largest else {
            return holds(row.safe.is_none() && (count == 1 || !with(&corner.steps[count - 2])?), || {
                "largest is missing".into()
            });
        };
        holds(with(&largest.0)?, || format!("an outer step of {} is not proven for the band", largest.0))?;
        if count > 1 {
            let next = &largest.0 + &corner.steps[count - 2];
            let whole = (&largest.0 / &corner.steps[count - 2]).is_integer();
            holds(whole && !with(&next)?, || format!("{} is not the largest multiple", largest.0))?;
        }
        let Some(safe) = &row.safe else {
            return holds(count > 1 && corner.steps[count - 2] >= third, || "safe is missing".into());
        };
        let bounded = safe.0 <= largest.0 && (safe.0 < third || (count == 1 && safe.0 == third));
        let longest = count == 1 || safe.0 == largest.0 || &safe.0 + &corner.steps[count - 2] >= third;
        holds(bounded && longest, || format!("{} is not the longest outer step below T/3", safe.0))
    }

    fn row(&self, row: &Row) -> Checked {
        let scheme = (row.scheme as usize).wrapping_sub(1);
        let mode = self.input.modes.iter().find(|mode| mode.name == row.mode);
        holds(mode.is_some(), || format!("there is no mode {}", row.mode))?;
        let mass = self.mass(scheme, mode)?;
        let outer = mass.steps.last().cloned().unwrap_or_default();
        same("outer", row.outer.0.to_string(), outer.to_string())?;
        // A clock without stiffness is silent: the period is that of the others.
        let heard: Vec<usize> =
            (0..mass.steps.len()).filter(|&k| mass.stiffness[k].sign() != Some(Sign::Zero)).collect();
        let own = Mass {
            steps: heard.iter().map(|&k| mass.steps[k].clone()).collect(),
            stiffness: heard.iter().map(|&k| mass.stiffness[k].clone()).collect(),
        };
        let (trace, period) = own.trace()?;
        holds(row.trace.holds(&trace), || format!("the trace is {}", trace.mid_f64()))?;
        let sign = own.excess()?;
        let edge = matches!(*row.kind, Kind::Parabolic | Kind::Coexistence);
        let right = match sign {
            Some(Sign::Positive) => *row.kind == Kind::Hyperbolic,
            Some(Sign::Negative) => *row.kind == Kind::Elliptic,
            _ => edge,
        };
        holds(right, || format!("is not {}", row.kind.name()))?;
        if *row.kind == Kind::Hyperbolic {
            row.growth(&trace, &period, &outer)?;
        } else {
            let none = row.tenfold_steps.is_none() && (row.growth_rate.lo, row.growth_rate.hi) == (0.0, 0.0);
            holds(none, || "grows though it is not hyperbolic".into())?;
        }
        let at = |step: f64| mass.scaled(&(exact(step) / &outer));
        let Some(first) = row.first_lower else { return holds(false, || "first_lower is missing".into()) };
        let inside = at(first.lo).in_first_region()?;
        holds(inside != Some(false), || format!("the first region ends before {}", first.lo))?;
        holds(at(first.hi).in_first_region()? != Some(true), || {
            format!("the first region reaches beyond {}", first.hi)
        })?;
        let intervals = [
            (row.first_lower, row.first_upper, row.first_tenfold_steps),
            (row.inside_lower, row.inside_upper, row.inside_tenfold_steps),
            (row.below_lower, row.below_upper, row.below_tenfold_steps),
            (row.above_lower, row.above_upper, row.above_tenfold_steps),
        ];
        for (lower, upper, worst) in intervals {
            // An interval without an upper end is one point or has no end: the pivots tell where the first one begins.
            let Some((lower, upper)) = lower.zip(upper) else { continue };
            crosses(&at, lower, "lower")?;
            crosses(&at, upper, "upper")?;
            if let Some(worst) = worst {
                fastest_growth(&at, (lower.hi, upper.lo), worst)?;
            }
        }
        let order = |a: Option<Ends>, b: &Rational| a.is_none_or(|a| exact(a.lo) <= *b);
        holds(order(row.below_upper, &outer) && row.above_lower.is_none_or(|a| exact(a.hi) >= outer), || {
            "below and above lie on the wrong sides".into()
        })
    }

    fn pair(&self, pair: &Pair) -> Checked {
        let steps = self.input.schemes.get((pair.scheme as usize).wrapping_sub(1));
        let Some((inner, outer)) = steps.and_then(|steps| steps.first().zip(steps.last())) else {
            return holds(false, || format!("there is no scheme {}", pair.scheme));
        };
        let parts = crate::number::rational::to_f64(&(&outer.0 / &inner.0));
        let turns = |mode: &ModeRow| {
            // s = 2 − 2 cos θ, so the angle by its cosine and not by the sine of its half.
            let s = (2.0 * std::f64::consts::PI * pair.near / (parts * mode.period.lo)).powi(2);
            parts * (1.0 - s / 2.0).max(-1.0).acos()
        };
        let sum = turns(self.named(&pair.first)?) + turns(self.named(&pair.second)?);
        // near has four digits.
        holds((sum / (2.0 * std::f64::consts::PI) - 1.0).abs() < 2e-3, || {
            format!("{} and {} do not meet there", pair.first, pair.second)
        })
    }

    fn published(&self) -> Checked {
        let fastest = self.fastest()?;
        for row in &self.published {
            let limit = |end: &str| row["limit"][end].as_f64();
            let known = match row["parts"].as_u64() {
                Some(3) => Some(fastest.third),
                Some(4) => Some(fastest.quarter),
                Some(5) => Some(fastest.fifth),
                Some(10) => Some(fastest.tenth),
                _ => None,
            };
            let right =
                known.is_some_and(|ends| (limit("lo"), limit("hi")) == (Some(ends.lo), Some(ends.hi)));
            holds(right && row["mode"] == fastest.name.as_str(), || {
                "a published limit is not that part of the fastest period".into()
            })?;
        }
        Ok(())
    }
}

impl ModeRow {
    /// Each x with n x = T: (n x)² stiffness = 4 π².
    fn holds(&self) -> Checked {
        let stiffness = self.stiffness.enclosure(BITS);
        let turn = Ball::pi(BITS).scale2(1);
        let parts = [
            (1, self.period),
            (2, self.half),
            (3, self.third),
            (4, self.quarter),
            (5, self.fifth),
            (10, self.tenth),
        ];
        let whole = |n: u64, ends: Ends, square: Ball, name: &str| {
            let of = |x: f64| {
                Ball::from_rational(&(exact(x) * Rational::from_integer(n.into())), BITS)
                    .square(BITS)
                    .mul(&stiffness, BITS)
            };
            let right = ends.lo > 0.0
                && of(ends.lo).lower() <= square.upper()
                && square.lower() <= of(ends.hi).upper();
            holds(right, || format!("{name} of {} is not the period over {n}", self.name))
        };
        for (n, ends) in parts {
            whole(n, ends, turn.square(BITS), "a part")?;
        }
        let shorter = self.before.is_none_or(|before| before > 0.0 && before < self.period.hi);
        holds(shorter, || format!("heavy hydrogens do not shorten the period of {}", self.name))?;
        whole(1, self.verlet, Ball::from_integer(&4.into()), "verlet")
    }
}

impl Row {
    /// acosh(|Tr|/2) by logarithms.
    fn growth(&self, trace: &Ball, period: &Rational, outer: &Rational) -> Checked {
        let half = trace.abs().scale2(-1);
        let root = half.square(BITS).sub(&Ball::one(), BITS).sqrt_clipped(BITS).unwrap_or_else(Ball::zero);
        let ln = half.add(&root, BITS).ln(BITS).unwrap_or_else(Ball::zero);
        let rate = ln.div(&Ball::from_rational(period, BITS), BITS).unwrap_or_else(Ball::zero);
        let per_ps = rate.mul(&Ball::from_integer(&1000.into()), BITS);
        holds(self.growth_rate.holds(&per_ps), || format!("the growth rate is {}", per_ps.mid_f64()))?;
        let ten = Ball::from_integer(&10.into()).ln(BITS).expect("10 > 0");
        let steps = ten.div(&rate.mul(&Ball::from_rational(outer, BITS), BITS), BITS);
        let right = self.tenfold_steps.zip(steps).is_some_and(|(told, steps)| told.holds(&steps));
        holds(right, || "tenfold_steps is not that of the growth rate".into())
    }
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).unwrap_or_default()
}

/// That stable and unstable meet within the ends.
fn crosses(at: &impl Fn(f64) -> Mass, ends: Ends, name: &str) -> Checked {
    let (a, b) = (at(ends.lo).excess()?, at(ends.hi).excess()?);
    let apart = a.zip(b).is_none_or(|(a, b)| a * b != Sign::Positive);
    holds(apart, || format!("no {name} end of an unstable interval lies in {}..{}", ends.lo, ends.hi))
}

/// That growth inside is nowhere faster than told, and somewhere about as fast.
fn fastest_growth(at: &impl Fn(f64) -> Mass, (lo, hi): (f64, f64), steps: f64) -> Checked {
    let mut fastest: f64 = 0.0;
    for k in 1..64 {
        let outer = lo + (hi - lo) * f64::from(k) / 64.0;
        let (trace, period) = at(outer).trace()?;
        let rate = (trace.mid_f64().abs() / 2.0).max(1.0).acosh() / crate::number::rational::to_f64(&period);
        // The steps told are those at the place where the rate is largest.
        fastest = fastest.max(rate * outer);
    }
    let told = std::f64::consts::LN_10 / steps;
    holds((fastest / told - 1.0).abs() < 1e-2, || {
        format!("growth is tenfold in {} steps at worst", std::f64::consts::LN_10 / fastest)
    })
}
