//! One mass under several potentials, each on its own clock: a verdict, and the first stable region.
//!
//! **The first region covers every molecule.** The action J of a path over the half period (proofs/REGION.md)
//! decreases where a stiffness increases, in Loewner's order. So let one mass with the stiffnesses λ_1, ...,
//! λ_K on its clocks satisfy conditions (1) and (2) of the theorem there. Then *any number* of coupled modes
//! whose stiffness matrices are 0 ≤ K_k ≤ λ_k I with a definite sum is stable, at these steps and at all
//! smaller ones of the same ratios: longer periods, other couplings, and sums of two modes included. One mass
//! of the stiffest potentials is therefore all that has to be looked at.
//!
//! For one mass the conditions are positivity of two orbits. Eliminating the nodes of J from t = 0 on, its
//! pivots are quotients of consecutive positions, so
//!
//! ```text
//!     (1)  J free at 0, held at T/2 > 0:   the even orbit (x, v) = (1, 0) has x > 0 at every kick time and at T/2;
//!     (2)  J held at 0, free at T/2 > 0:   the odd orbit (0, 1) has x > 0 at every kick time, and v > 0 at the end.
//! ```

use num_traits::{One, ToPrimitive, Zero};

use super::unit::decimal;
use clocks::propagator::enclosed_bias_of;
use clocks::schedule::{KickDrift, Kicks, Schedule};
use clocks::verdict::Kind;
use number::rational::enclose_f64;
use number::{Ball, Error, ExactSign, Laurent, Rational, Real, Result, Sign, bisected, from_f64_exact};
use systems::friction::{Damping, Mask, Masked, damped_oscillator, damping_of_oscillator};
use systems::{Limits, ManyClocks, Potential, Symmetric, System, decide_oscillator};

/// Bits of the orbits' balls: in the first region these widen by e^(π/2) roundings.
const BITS: u32 = 128;

/// The steps of one integrator in fs, increasing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scheme {
    steps: Vec<Rational>,
}

impl Scheme {
    /// From the innermost step to the outermost one.
    ///
    /// # Errors
    /// No step, one that is not positive, one that is not longer than the one before.
    pub fn new(steps: Vec<Rational>) -> Result<Scheme> {
        if steps.is_empty() {
            return Err(Error::missing(
                "steps",
                "give the steps from the innermost to the outermost one, as 0.5fs,4fs",
            ));
        }
        let shown = || steps.iter().map(|step| format!("{step}fs")).collect::<Vec<_>>().join(",");
        if steps.iter().any(|step| step.sign() != Sign::Positive) {
            return Err(Error::input("steps", shown(), "a step must be positive"));
        }
        if steps.windows(2).any(|pair| pair[0] == pair[1]) {
            let mut once = steps.clone();
            once.dedup();
            let once = once.iter().map(|step| format!("{}fs", decimal(step))).collect::<Vec<_>>().join(",");
            let remedy = format!(
                "equal steps are one clock: write {once}, and put the modes of both on it, as --on OH=1,angle=1"
            );
            return Err(Error::input("steps", shown(), remedy));
        }
        if steps.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(Error::input(
                "steps",
                shown(),
                "write the shortest step first, each longer than the one before",
            ));
        }
        // That the clocks meet again within what can be counted.
        Schedule::new(&steps, &vec![Rational::zero(); steps.len()])?;
        Ok(Scheme { steps })
    }

    /// The steps, the innermost first.
    pub fn steps(&self) -> &[Rational] {
        &self.steps
    }

    /// The innermost step.
    pub fn inner(&self) -> &Rational {
        &self.steps[0]
    }

    /// The outermost step.
    pub fn outer(&self) -> &Rational {
        self.steps.last().expect("at least one step")
    }

    /// The step whose multiple the outermost one is, for as many levels as there are; the step itself where
    /// it is alone.
    pub fn last_but_one(&self) -> &Rational {
        &self.steps[self.steps.len().saturating_sub(2)]
    }

    /// This scheme without its outermost step.
    pub fn merged(&self) -> Result<Scheme> {
        Scheme::new(self.steps[..self.steps.len() - 1].to_vec())
    }

    /// This scheme with another outermost step.
    pub fn with_outer(&self, outer: Rational) -> Result<Scheme> {
        let mut steps = self.steps.clone();
        *steps.last_mut().expect("at least one step") = outer;
        Scheme::new(steps)
    }
}

/// The longest multiple of the step before the outermost one that is at most `largest` and below `limit`.
pub(super) fn longest_below(scheme: &Scheme, largest: &Rational, limit: &Rational) -> Option<Rational> {
    if scheme.steps().len() == 1 {
        return Some(largest.min(limit).clone());
    }
    let step = scheme.last_but_one();
    let mut count = (largest.min(limit) / step).floor();
    if &count * step == *limit {
        count -= Rational::one();
    }
    (count.to_f64()? >= 1.0).then(|| count * step)
}

/// One mass, and the stiffness over mass (1/fs²) on each clock of a scheme.
#[derive(Clone, Debug)]
pub struct Levels<'a> {
    pub scheme: &'a Scheme,
    /// One a step, 0 where nothing is known to be on that clock.
    pub stiffness: Vec<Laurent>,
}

/// The verdict of one mass at one scheme, proven.
#[derive(Clone, Debug)]
pub struct Found {
    pub kind: Kind,
    /// Tr Q over the synchronization period.
    pub trace: (f64, f64),
    /// m, the half turns of the growing solution in a period.
    pub label: Option<u64>,
    /// The growth rate per fs; zero unless it grows exponentially.
    pub rate: (f64, f64),
}

impl Levels<'_> {
    /// The verdict, by the certified ladder.
    ///
    /// # Errors
    /// A budget error where the decision would exceed the limits.
    pub fn decide(&self, limits: &Limits) -> Result<Found> {
        let heard = self.heard();
        let Some(&first) = heard.first() else {
            return Err(Error::missing("period", "give the period of at least one force"));
        };
        let unit = Laurent::from_rational(self.scheme.steps[first].clone());
        let clocks = self.clocks(&heard)?;
        let potential = |&k: &usize| {
            let stiffness = Symmetric::diagonal(&[self.stiffness[k].enclosure(BITS).lower()]);
            Potential::new(stiffness, self.scheme.steps[k].clone())
        };
        let mass = Symmetric::diagonal(&[Rational::from_integer(1.into())]);
        let rounded = System::new(mass, heard.iter().map(potential).collect())?;
        let analysis = decide_oscillator(&clocks, &rounded, &unit, limits)?;
        let clocked = analysis.parts[0].oscillator.as_ref().expect("one oscillator");
        let kind = analysis.kind.expect("one oscillator is decided");
        let rate = analysis.growth_rate().expect("and its multiplier enclosed");
        Ok(Found { kind, trace: clocked.trace.to_f64_enclosure(), label: clocked.label, rate })
    }

    /// Clocks that kick with strength 0 are silent, and a system has none such.
    fn heard(&self) -> Vec<usize> {
        (0..self.stiffness.len()).filter(|&k| !self.stiffness[k].is_zero()).collect()
    }

    /// With friction a kick of strength 0 parts a drift in two.
    fn all(&self) -> Vec<usize> {
        (0..self.stiffness.len()).collect()
    }

    /// The frictions per fs that mask a resonance; `None` where nothing grows or none was found.
    pub fn masking(&self) -> Option<Masked> {
        // Any friction: the answer on those that mask is the same.
        let rate = self.scheme.inner().recip();
        match damped_oscillator(&self.clocks(&self.all()).ok()?, &self.first(), &rate).ok()?.masking {
            Mask::At(masked) => Some(masked),
            _ => None,
        }
    }

    /// Whether this friction per fs keeps all bounded; `None` where that is not proven either way.
    pub fn is_damped_by(&self, rate: &Rational) -> Option<bool> {
        let found = damping_of_oscillator(&self.clocks(&self.all()).ok()?, &self.first(), rate);
        Some(found.ok()?? == Damping::Damped)
    }

    /// The step of the first clock in fs: the unit of time of all.
    fn first(&self) -> Laurent {
        Laurent::from_rational(self.scheme.inner().clone())
    }

    fn clocks(&self, heard: &[usize]) -> Result<ManyClocks<Laurent>> {
        let first = &self.scheme.steps[heard[0]];
        let steps: Vec<Rational> = heard.iter().map(|&k| &self.scheme.steps[k] / first).collect();
        let strength = |&k: &usize| {
            let square = first * &self.scheme.steps[k];
            &Laurent::from_rational(square) * &self.stiffness[k]
        };
        ManyClocks::new(&steps, &vec![Rational::zero(); steps.len()], heard.iter().map(strength).collect())
    }

    /// The bias R of a mode that is stable: its potential energy where it is kicked, over the half kT that
    /// its velocity has there. `None` where it is not stable, or the balls do not tell it.
    ///
    /// That of [`enclosed_bias_of`]; for velocity Verlet 1/(1 − h² Λ/4).
    ///
    /// ```
    /// use kickdrift_molecules::{Levels, Mode, Scheme, number::Rational};
    /// let bias = |step: i64| {
    ///     let scheme = Scheme::new(vec![Rational::from_integer(step.into())]).unwrap();
    ///     let stiffness = vec![Mode::from_period("OH=10fs").unwrap().stiffness];
    ///     Levels { scheme: &scheme, stiffness }.bias()
    /// };
    /// let (lo, hi) = bias(2).unwrap();
    /// let exact = 1.0 / (1.0 - (0.2 * std::f64::consts::PI).powi(2));
    /// // The formula in doubles is off by some roundings.
    /// assert!((lo - exact).abs() < 1e-14 && (hi - exact).abs() < 1e-14);
    /// // Beyond T/π.
    /// assert_eq!(bias(4), None);
    /// ```
    pub fn bias(&self) -> Option<(f64, f64)> {
        // Without the silent clocks, with which a period can be several that together turn by a whole.
        let heard = self.heard();
        let first = &self.scheme.steps[*heard.first()?];
        let clocks = self.clocks(&heard).ok()?;
        let sum = heard.iter().fold(Laurent::zero(), |sum, &k| sum + self.stiffness[k].clone());
        let stiffness = &Laurent::from_rational(first * first) * &sum;
        let bias = enclosed_bias_of(clocks.schedule(), clocks.strengths(), &stiffness)?;
        Some(bias.at_kicks.to_f64_enclosure())
    }

    /// Whether conditions (1) and (2) hold for the stiffnesses times `factor`: `None` where the balls cannot
    /// decide.
    pub fn in_first_region(&self, factor: &Ball) -> Option<bool> {
        let mut orbits = self.half_period(factor, |orbits| orbits.left)?;
        if !orbits.left {
            orbits.see_end();
        }
        if orbits.left { Some(false) } else { (!orbits.doubtful).then_some(true) }
    }

    /// The orbits over half a period, up to the kick after which they are to `end`.
    fn half_period(&self, factor: &Ball, end: impl Fn(&Orbits) -> bool) -> Option<Orbits> {
        let steps = &self.scheme.steps;
        let schedule = Schedule::new(steps, &vec![Rational::zero(); steps.len()]).ok()?;
        let tick = Ball::from_rational(schedule.tick(), BITS);
        let strengths = steps.iter().zip(&self.stiffness).map(|(step, stiffness)| {
            let ball = Ball::from_rational(step, BITS).mul(&stiffness.enclosure(BITS), BITS);
            ball.mul(factor, BITS)
        });
        let kicks = Kicks::of_clocks(strengths, |k| [k.clone(), k.scale2(-1)]);
        let (zero, one) = (Ball::zero(), Ball::one());
        let mut orbits = Orbits {
            even: [one.clone(), zero.clone()],
            odd: [zero, one],
            tick,
            started: false,
            left: false,
            doubtful: false,
        };
        for event in schedule.half_period() {
            kicks.lead([event], &mut orbits);
            if end(&orbits) {
                break;
            }
        }
        Some(orbits)
    }

    /// The factors of all steps, at fixed ratios, up to which the first region provably reaches and beyond
    /// which it provably has ended: neighbours, or as close as balls can decide. The conditions hold at every
    /// smaller step (proofs/REGION.md), so a bisection finds them.
    ///
    /// # Errors
    /// Where no factor from 2^-60 to 2^60 ends it: there is no stiffness, or the steps are far from its
    /// period.
    pub fn first_region_ends(&self) -> Result<(f64, f64)> {
        let square = |t: f64| {
            let t = from_f64_exact(t).expect("a finite factor");
            Ball::from_rational(&(&t * &t), BITS)
        };
        let at = |t: f64| self.in_first_region(&square(t));
        let none = || {
            let remedy = "is far from all steps that these periods allow: choose steps nearer to the periods";
            Error::input("steps", format!("{} fs", self.scheme.outer()), remedy)
        };
        let hi = (-60..60).map(|k| 2f64.powi(k)).find(|&t| at(t) == Some(false)).ok_or_else(none)?;
        let mut lo = hi / 2.0;
        // The factor before this one was not proven to lie outside: it is inside, or on the edge itself.
        while at(lo) != Some(true) {
            lo *= 0.999;
            if lo < hi / 4.0 {
                return Err(none());
            }
        }
        Ok(bisected((lo, hi), 0.0, at))
    }
}

/// Factors of a step as steps, rounded outward.
pub(super) fn scaled((lo, hi): (f64, f64), step: &Rational) -> (f64, f64) {
    let times = |t: f64| enclose_f64(&(from_f64_exact(t).expect("a finite factor") * step));
    (times(lo).0, times(hi).1)
}

/// The even and the odd orbit, (x, v) each.
struct Orbits {
    even: [Ball; 2],
    odd: [Ball; 2],
    tick: Ball,
    /// Whether time has passed: the odd orbit begins at 0.
    started: bool,
    /// Whether a condition has failed for sure.
    left: bool,
    doubtful: bool,
}

impl Orbits {
    fn must_be_positive(&mut self, sign: Option<Sign>) {
        match sign {
            Some(Sign::Positive) => {}
            Some(_) => self.left = true,
            None => self.doubtful = true,
        }
    }

    fn see_end(&mut self) {
        self.must_be_positive(self.odd[1].sign());
    }
}

impl KickDrift<Ball> for Orbits {
    fn drift(&mut self, ticks: u64) {
        let time = self.tick.mul(&Ball::from_integer(&ticks.into()), BITS);
        for [x, v] in [&mut self.even, &mut self.odd] {
            *x = x.add(&v.mul(&time, BITS), BITS);
        }
        self.started = true;
    }

    fn arrive(&mut self) {
        if self.started {
            self.must_be_positive(self.even[0].sign());
            self.must_be_positive(self.odd[0].sign());
        }
    }

    fn kick(&mut self, strength: &Ball) {
        for [x, v] in [&mut self.even, &mut self.odd] {
            *v = v.sub(&strength.mul(x, BITS), BITS);
        }
    }
}
