//! One oscillator whose mass, stiffnesses or steps involve π: K clocks over ℚ\[π\].

use std::collections::BTreeMap;

use num_traits::Zero;

use super::document::{Document, PotentialDocument, ends};
use crate::error::{Error, Result};
use crate::number::{Ball, ExactSign, Laurent, Rational, Real, Sign};
use crate::system::friction::{Friction, damped_oscillator};
use crate::system::{Limits, ManyClocks, Potential, Symmetric, System};
use crate::verdict::Kind;

/// The clocks in units of h_1, the shortest step.
#[derive(Clone, Debug)]
pub(super) struct Oscillator {
    pub clocks: ManyClocks<Laurent>,
    /// h_1.
    pub unit: Laurent,
    /// The same with every stiffness/mass rounded to a rational of some 60 bits; in the unit of time h_1 where
    /// steps are irrational.
    pub rounded: System,
    pub has_rational_steps: bool,
    mass: Laurent,
    all: Merged,
}

impl Oscillator {
    /// What friction of a rate per unit time does: also a clock without stiffness parts the drifts.
    pub fn friction(&self, rate: &Rational) -> Result<Friction> {
        let (unit, clocks) = on_clocks(&self.mass, &self.all)?;
        damped_oscillator(&clocks, &unit, rate)
    }

    /// The kind by the four signs.
    pub fn exact_kind(&self, limits: &Limits) -> Result<Kind> {
        let kicks = self.clocks.schedule().strikes();
        // Kick by kick over ℚ[π], whose numbers grow by some words with each kick.
        let cost = kicks.saturating_mul(kicks).saturating_mul(kicks);
        if cost > limits.products {
            return Err(Error::budget(format!("exact signs after {kicks} kicks"), cost));
        }
        Ok(self.clocks.half_signs().verdict().kind())
    }
}

impl Document {
    /// `None` unless the file is of one mass and some number of it is irrational.
    pub fn oscillator(&self) -> Result<Option<Oscillator>> {
        let (Some([mass]), Ok(potentials)) = (self.masses.as_deref(), self.potentials()) else {
            return Ok(None);
        };
        if potentials.iter().any(|p| !p.bonds.is_empty()) {
            return Ok(None);
        }
        let mass = mass.read_laurent("masses[0]")?;
        let read = potentials.iter().enumerate().map(|(k, p)| p.clock(k));
        let clocks = read.collect::<Result<Vec<_>>>()?;
        let all = clocks.iter().flat_map(|(step, _, stiffness)| [step, stiffness]).chain([&mass]);
        if all.map(Laurent::as_rational).all(|x| x.is_some()) {
            return Ok(None);
        }
        if mass.sign() != Sign::Positive {
            return Err(Error::input("masses[0]", &mass, "a mass must be positive"));
        }
        assembled(mass, merged(clocks)).map(Some)
    }
}

impl PotentialDocument {
    /// Step, phase and stiffness on one degree of freedom.
    fn clock(&self, k: usize) -> Result<(Laurent, Rational, Laurent)> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let mut stiffness = match self.stiffness.as_deref() {
            None => Laurent::zero(),
            Some([row]) if row.len() == 1 => row[0].read_laurent(&field("stiffness[0][0]"))?,
            Some(rows) => {
                let size = format!("{} rows", rows.len());
                return Err(Error::input(
                    &field("stiffness"),
                    size,
                    "there is 1 degree of freedom: give [[k]]",
                ));
            }
        };
        for (s, (i, j, value)) in self.springs.iter().enumerate() {
            let field = field(&format!("springs[{s}]"));
            ends(&field, i, j.as_ref(), 1)?;
            stiffness += value.read_laurent(&field)?;
        }
        if let Some(scale) = &self.scale {
            stiffness *= scale.read_laurent(&field("scale"))?;
        }
        let step = self.step.read_laurent(&field("step"))?;
        if step.sign() != Sign::Positive {
            return Err(Error::input(&field("step"), step, "a step must be positive"));
        }
        let phase = self.phase.as_ref().map_or(Ok(Rational::zero()), |phase| phase.read(&field("phase")))?;
        if !phase.is_zero() && phase != Rational::new(1.into(), 2.into()) {
            return Err(Error::input(&field("phase"), phase, "must be 0 or 1/2"));
        }
        Ok((step, phase, stiffness))
    }
}

type Merged = BTreeMap<(Laurent, Rational), (usize, Laurent)>;

/// One clock for each (step, phase), with the place where it was first seen.
fn merged(clocks: Vec<(Laurent, Rational, Laurent)>) -> Merged {
    let mut merged = Merged::new();
    for (k, (step, phase, stiffness)) in clocks.into_iter().enumerate() {
        merged.entry((step, phase)).or_insert_with(|| (k, Laurent::zero())).1 += stiffness;
    }
    merged
}

/// Those with a stiffness, or all if none has one.
fn heard(all: &Merged) -> Merged {
    let mut heard = all.clone();
    if heard.values().any(|(_, stiffness)| !stiffness.is_zero()) {
        heard.retain(|_, (_, stiffness)| !stiffness.is_zero());
    }
    heard
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

/// The clocks exactly and rounded.
fn assembled(mass: Laurent, all: Merged) -> Result<Oscillator> {
    let heard = heard(&all);
    let (base, clocks) = on_clocks(&mass, &heard)?;
    let has_rational_steps = base.as_rational().is_some();
    // The unit of time of what is rounded, in units of h_1.
    let square = if has_rational_steps {
        Laurent::from_rational(Rational::from_integer(1.into()))
    } else {
        &base * &base
    };
    let unit = base.as_rational().unwrap_or_else(|| Rational::from_integer(1.into()));
    let potential = |((step, phase), (_, stiffness)): (&(Laurent, Rational), &(usize, Laurent))| {
        let stiffness = Symmetric::diagonal(&[rounded(&(&square * &over_mass(stiffness, &mass)?))]);
        let step = &unit * Laurent::ratio(step, &base).expect("a ratio of clocks");
        Ok(Potential { stiffness, step, phase: phase.clone() })
    };
    let potentials = heard.iter().map(potential).collect::<Result<_>>()?;
    let rounded = System::new(Symmetric::diagonal(&[Rational::from_integer(1.into())]), potentials)?;
    Ok(Oscillator { clocks, unit: base, rounded, has_rational_steps, mass, all })
}
