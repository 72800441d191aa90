//! One oscillator whose mass, stiffnesses or steps involve π: K clocks over ℚ\[π\].

use std::collections::BTreeMap;
use std::sync::Arc;

use num_traits::Zero;

use super::Model;
use crate::bias::{self, BiasedMode, NoBias};
use crate::friction::{Friction, damped_oscillator};
use crate::levels::Method;
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::single::clocks::ManyClocks;
use crate::single::decide::{allow_signs, decide_oscillator, with_pi};
use crate::verdict::analysis::Analysis;
use crate::verdict::limits::{Limits, Route};
use clocks::propagator;
use clocks::verdict::Kind;
use number::{Ball, Error, ExactSign, Laurent, Rational, Real, Result, Sign};

/// The clocks in units of h_1, the shortest step.
#[derive(Clone, Debug)]
pub struct Oscillator {
    /// The clocks that have a stiffness, or all if none has one.
    pub clocks: ManyClocks<Laurent>,
    /// h_1.
    pub unit: Laurent,
    /// The oscillator with every stiffness/mass rounded to a rational of some 60 bits; in the unit of time
    /// h_1 where steps are irrational.
    pub rounded: System,
    pub has_rational_steps: bool,
    mass: Laurent,
    /// All clocks: one without stiffness parts the drifts, too, in which friction acts.
    all: Merged,
}

/// Stiffnesses by step and phase, each with the index of the potential that first had these.
type Merged = BTreeMap<(Laurent, Rational), (usize, Laurent)>;

impl Oscillator {
    /// A mass and potentials: the step, the phase and the stiffness of each.
    ///
    /// # Errors
    /// A mass that is not positive or no rational times a power of π; steps without a rational ratio.
    pub fn new(mass: Laurent, potentials: Vec<(Laurent, Rational, Laurent)>) -> Result<Oscillator> {
        if mass.sign() != Sign::Positive {
            return Err(Error::input("masses[0]", &mass, "a mass must be positive"));
        }
        let mut all = Merged::new();
        for (k, (step, phase, stiffness)) in potentials.into_iter().enumerate() {
            all.entry((step, phase)).or_insert_with(|| (k, Laurent::zero())).1 += stiffness;
        }
        let mut heard = all.clone();
        if heard.values().any(|(_, stiffness)| !stiffness.is_zero()) {
            heard.retain(|_, (_, stiffness)| !stiffness.is_zero());
        }
        let (base, clocks) = on_clocks(&mass, &heard)?;
        let has_rational_steps = base.as_rational().is_some();
        // The unit of time of what is rounded, in units of h_1.
        let one = || Rational::from_integer(1.into());
        let square = if has_rational_steps { Laurent::from_rational(one()) } else { &base * &base };
        let unit = base.as_rational().unwrap_or_else(one);
        let potential = |((step, phase), (_, stiffness)): (&(Laurent, Rational), &(usize, Laurent))| {
            let stiffness = Symmetric::diagonal(&[rounded(&(&square * &over_mass(stiffness, &mass)?))]);
            let step = &unit * Laurent::ratio(step, &base).expect("a ratio of clocks");
            Ok(Potential { stiffness, step, phase: phase.clone() })
        };
        let potentials = heard.iter().map(potential).collect::<Result<_>>()?;
        let rounded = System::new(Symmetric::diagonal(&[one()]), potentials)?;
        Ok(Oscillator { clocks, unit: base, rounded, has_rational_steps, mass, all })
    }
}

/// One oscillator over ℚ\[π, 1/π\].
impl Model for Oscillator {
    fn system(&self) -> &System {
        &self.rounded
    }

    fn no_intervals(&self) -> Option<(&'static str, &'static str)> {
        Some(("of this file", "are for linear systems of rational numbers"))
    }

    /// By the ladder, doubles, balls or exact signs.
    fn decide(&self, _: Route, limits: &Limits) -> Result<Analysis> {
        decide_oscillator(&self.clocks, &self.rounded, &self.unit, limits)
    }

    /// By the four signs.
    fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        allow_signs(&self.clocks, with_pi, limits)?;
        Ok(self.clocks.half_signs().verdict().kind())
    }

    fn biased_modes(&self) -> Result<std::result::Result<Vec<BiasedMode>, NoBias>> {
        let mut found = bias::of_system(&self.rounded);
        let unit = if self.has_rational_steps { 1.0 } else { self.unit.to_f64() };
        found.iter_mut().flatten().for_each(|mode| mode.period *= unit);
        Ok(found)
    }

    fn friction(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        limits.allow(self.clocks.schedule().strikes().saturating_mul(1000), || {
            "friction on one oscillator".into()
        })?;
        let (unit, clocks) = on_clocks(&self.mass, &self.all)?;
        damped_oscillator(&clocks, &unit, rate)
    }

    fn to_run(&self) -> Result<&System> {
        let remedy = "a run needs rational steps: choose a unit of time in which they are";
        let is_rational = self.has_rational_steps.then_some(&self.rounded);
        is_rational.ok_or_else(|| Error::input("step", &self.unit, remedy))
    }

    fn with_method(self: Arc<Self>, method: Method) -> Result<Arc<dyn Model>> {
        let remedy =
            "is for rational numbers: of one mass with pi ask kickdrift word --method, or compare --methods";
        Err(Error::input("method", method, remedy))
    }

    fn two_clocks(&self) -> Option<propagator::Oscillator> {
        let (two, h1) = (self.clocks.as_two_clocks()?, &self.unit);
        let h2 = h1 * &Laurent::from_rational(two.ratio().into());
        let lambda = |strength: &Laurent, step: &Laurent| strength.checked_div(&(h1 * step));
        let (fast, slow) = (lambda(two.fast(), h1)?, lambda(two.slow(), &h2)?);
        propagator::Oscillator::new(fast, slow, h1.clone(), h2).ok()
    }
}

/// A rational within 2^-60 |x| of x, and 0 for 0 alone: unlike doubles it neither vanishes nor overflows.
fn rounded(x: &Laurent) -> Rational {
    if x.is_zero() {
        return Rational::zero();
    }
    let balls = (7..).map(|log2| x.enclosure(1 << log2));
    let close = |ball: &Ball| ball.relative_accuracy_bits() > 60;
    // Powers of π are independent over ℚ: x is not 0, so some precision gives its leading bits.
    balls.into_iter().find(close).expect("precisions without end").lower()
}

/// The shortest step and the clocks by increasing step, in units of it.
fn on_clocks(mass: &Laurent, merged: &Merged) -> Result<(Laurent, ManyClocks<Laurent>)> {
    let base = merged.first_key_value().expect("at least one clock").0.0.clone();
    let (mut steps, mut phases, mut strengths) = (vec![], vec![], vec![]);
    for ((step, phase), (k, stiffness)) in merged {
        steps.push(Laurent::ratio(step, &base).ok_or_else(|| {
            let remedy = format!("its ratio to the step {base} is irrational: these clocks never meet again");
            Error::input(&format!("potentials[{k}].step"), step, remedy)
        })?);
        phases.push(phase.clone());
        strengths.push(&(&base * step) * &over_mass(stiffness, mass)?);
    }
    let clocks = ManyClocks::new(&steps, &phases, strengths)?;
    Ok((base, clocks))
}

fn over_mass(stiffness: &Laurent, mass: &Laurent) -> Result<Laurent> {
    stiffness.checked_div(mass).ok_or_else(|| {
        Error::input("masses[0]", mass, "must be a rational times a power of pi, so that K/m is exact")
    })
}
