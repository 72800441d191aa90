//! Levers that would let the step grow: kicks and drifts by the pivots of their action, other methods by
//! their traces.

use num_traits::One;

use super::claim::{Claim, LeverRow};
use super::mass::{BITS, Mass, exact};
use crate::verify::context::{Checked, holds};
use crate::verify::written::Ends;
use molecules::Mode;
use number::parse::parse_rational;
use number::{Ball, Laurent, Rational, Real, Ring, Sign};

impl Claim {
    /// The ends, the step below them, the filters' traces.
    pub fn lever(&self, lever_row: &LeverRow) -> Checked {
        match lever_row.method.as_str() {
            "kicks and drifts" => self.kicks(lever_row),
            "kicks and drifts with friction" => self.masked(lever_row),
            _ => self.other_method(lever_row),
        }?;
        let below = lever_row
            .step
            .as_ref()
            .zip(lever_row.band_edge)
            .is_none_or(|(step, edge)| step.0 < exact(edge.hi));
        holds(below, || format!("the step of {} is beyond its edge", lever_row.lever))
    }

    /// The modes that a lever leaves or changes: a bond's k is its stiffness times the reduced mass.
    fn modes_of(&self, lever_row: &LeverRow) -> Checked<Vec<Mode>> {
        let heavy = lever_row.lever.strip_prefix("hydrogens of ").and_then(|rest| rest.strip_suffix(" amu"));
        let heavy = heavy.map(|mass| parse_rational("lever", mass)).transpose()?;
        let light = |mass: &Rational| *mass <= Rational::new(11.into(), 10.into());
        let mut modes = Vec::new();
        for mode in self.modes_asked() {
            let mut mode = mode.clone();
            let Some(bond) = mode.bond.clone().filter(|bond| bond.masses.iter().any(light)) else {
                modes.push(mode);
                continue;
            };
            if lever_row.lever == "h-bonds held" {
                continue;
            }
            let [a, b] = &bond.masses;
            if let Some(mass) = heavy.as_ref().filter(|_| light(a) != light(b)) {
                let (h, atom) = if light(a) { (a, b) } else { (b, a) };
                let atom_after = atom - (mass - h) * Rational::from_integer(bond.hydrogens.into());
                let reduced = |a: &Rational, b: &Rational| a * b / (a + b);
                let change = reduced(a, b) / reduced(mass, &atom_after);
                mode.stiffness = Laurent::product(&mode.stiffness, &Laurent::from_rational(change));
            }
            modes.push(mode);
        }
        Ok(modes)
    }

    fn kicks(&self, lever_row: &LeverRow) -> Checked {
        let modes = self.modes_of(lever_row)?;
        let mut steps = self.input.schemes.first().map_or_else(Vec::new, |scheme| scheme.steps().to_vec());
        if let Some(p) = lever_row.lever.strip_prefix("ratio ") {
            let count = steps.len();
            holds(count > 1, || "one clock has no ratio".into())?;
            steps[count - 1] = &steps[count - 2] * parse_rational("lever", p)?;
        }
        // The inner steps are those of the scheme, and all columns belong to the ratio of the step that is
        // taken.
        let is_at_ratio = lever_row.lever.starts_with("ratio ");
        let outer = match &lever_row.step {
            Some(step) if !is_at_ratio && steps.len() > 1 => step.0.clone(),
            _ => steps.last().cloned().unwrap_or_default(),
        };
        let stiffest = |clock: usize| {
            let on = modes.iter().filter(move |mode| mode.clock == Some(clock));
            on.max_by(|a, b| a.stiffness.cmp(&b.stiffness))
                .map_or_else(Ball::zero, |mode| mode.stiffness.enclosure(BITS))
        };
        let mass = Mass { stiffness: (0..steps.len()).map(stiffest).collect(), steps };
        let mass = if mass.steps.len() > 1 { mass.with_outer(&outer) } else { mass };
        let (Some(first), Some(edge)) = (lever_row.first, lever_row.band_edge) else {
            return holds(false, || format!("{} lacks its edges", lever_row.lever));
        };
        let inside = |step: &Rational| mass.scaled(&(step / &outer)).in_first_region();
        let shorter = Rational::one() - &self.input.band;
        for (ends, factor) in [(first, Rational::one()), (edge, shorter.recip())] {
            // Periods that are all shorter by the band are steps that are all longer.
            let right = inside(&(exact(ends.lo) * &factor))? != Some(false)
                && inside(&(exact(ends.hi) * &factor))? != Some(true);
            holds(right, || {
                format!("the first region of {} does not end in {}..{}", lever_row.lever, ends.lo, ends.hi)
            })?;
        }
        let Some(step) = &lever_row.step else { return Ok(()) };
        let taken = mass.scaled(&(&step.0 / &outer));
        holds(taken.scaled(&shorter.recip()).in_first_region()? == Some(true), || {
            format!("the step of {} is not proven for the band", lever_row.lever)
        })
    }

    /// The step is damped; the next one is not, or is not proven to be.
    fn masked(&self, lever_row: &LeverRow) -> Checked {
        let (Some(step), Some(rate)) = (&lever_row.step, &self.input.friction) else {
            return holds(false, || "a friction masks no step".into());
        };
        let mass = self.mass(0, None)?;
        let count = mass.steps.len();
        holds(count > 1, || "one clock has no outer step".into())?;
        let with = |outer: Rational| {
            let mut steps = mass.steps.clone();
            steps[count - 1] = outer;
            Mass { steps, stiffness: mass.stiffness.clone() }
        };
        holds(with(step.0.clone()).is_damped(rate)? != Some(false), || {
            "the friction does not mask that step".into()
        })
    }

    /// Two clocks: the stiffest mode on each, and the same with the band's shortest periods.
    fn other_method(&self, lever_row: &LeverRow) -> Checked {
        let (given, corner) = (self.mass(0, None)?, self.corner(0)?);
        let (true, Some(edge)) = (given.stiffness.len() == 2, lever_row.band_edge) else {
            return holds(false, || format!("{} is of two clocks", lever_row.lever));
        };
        if let Some(first) = lever_row.first {
            holds(ends_at(&lever_row.method, first, &given), || {
                format!("{} is not unstable in {}..{}", lever_row.lever, first.lo, first.hi)
            })?;
        }
        holds(ends_at(&lever_row.method, edge, &corner), || {
            format!("{} does not end in {}..{}", lever_row.lever, edge.lo, edge.hi)
        })?;
        let slow = self
            .input
            .modes
            .iter()
            .flatten()
            .filter(|mode| mode.clock == Some(1))
            .map(|mode| &mode.stiffness)
            .max();
        let exact = lever_row.first_exact.as_ref().zip(slow).is_none_or(|(h, slow)| {
            Laurent::product(&Laurent::product(&h.0, &h.0), slow) == Laurent::from_integer(4)
        });
        holds(exact, || format!("{} is not unstable at exactly that step", lever_row.lever))
    }
}

/// Whether one of the conditions fails between both ends, or there: h² S < 4, h w < π, |Tr| < 2.
fn ends_at(method: &str, ends: Ends, mass: &Mass) -> bool {
    let at = |x: f64| Ball::from_rational(&exact(x), BITS);
    let [lo, hi] = [at(ends.lo), at(ends.hi)];
    let passes = |f: &dyn Fn(&Ball) -> Ball| match (f(&lo).sign(), f(&hi).sign()) {
        (Some(a), Some(b)) => a * b != Sign::Positive,
        _ => true,
    };
    let slow = |h: &Ball| h.square(BITS).mul(&mass.stiffness[1], BITS);
    let rigid = passes(&|h| slow(h).sub(&Ball::from_integer(&4.into()), BITS));
    let angle = |h: &Ball| h.mul(&mass.stiffness[0].sqrt(BITS).unwrap_or_else(Ball::zero), BITS);
    let sinc = |x: &Ball| x.sin(BITS).div(x, BITS).unwrap_or_else(Ball::one);
    let excess = |h: &Ball| {
        let x = angle(h);
        let filter = match method {
            "molly-short" => sinc(&x.scale2(-1)),
            "molly-linear" => sinc(&x.scale2(-1)).square(BITS),
            _ => sinc(&x),
        };
        let kicked = slow(h).mul(&filter.square(BITS), BITS).mul(&sinc(&x), BITS);
        x.cos(BITS).scale2(1).sub(&kicked, BITS).abs().sub(&Ball::from_integer(&2.into()), BITS)
    };
    match method {
        "molly-short" | "molly-linear" => rigid || passes(&excess),
        "molly-long" => rigid || passes(&|h| angle(h).sub(&Ball::pi(BITS), BITS)),
        _ => rigid,
    }
}
