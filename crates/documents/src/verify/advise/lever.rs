//! Levers that would let the step grow: kicks and drifts by the pivots of their action, other methods by
//! their traces.

use super::mass::{BITS, Mass, exact};
use super::periods::{Periods, stiffest};
use crate::verify::context::{Checked, Fault, holds};
use molecules::{Lever, Mode, Way};
use number::parse::parse_rational;
use number::{Ball, Laurent, Rational, Ring, Sign};
use words::Trigonometric;

impl Periods<'_> {
    /// The ends, the step below them, the filters' traces.
    pub fn lever(&self, lever: &Lever) -> Checked {
        match lever.way {
            Way::Friction => self.masked(lever),
            Way::Molly(_) | Way::Equilibrium | Way::ImplicitExplicit => self.other_method(lever),
            _ => self.kicks(lever),
        }?;
        let is_below =
            lever.step.as_ref().zip(lever.band_edge).is_none_or(|((step, _), edge)| *step < exact(edge.1));
        holds(is_below, || "its step is beyond its edge".into())
    }

    fn steps(&self) -> &[Rational] {
        self.advice.schemes[0].scheme.steps()
    }

    /// The modes that a lever leaves or changes: a bond's k is its stiffness times the reduced mass.
    fn modes_of(&self, lever: &Lever) -> Checked<Vec<Mode>> {
        let heavy = lever.name.strip_prefix("hydrogens of ").and_then(|rest| rest.strip_suffix(" amu"));
        let heavy = heavy.map(|mass| parse_rational("lever", mass)).transpose()?;
        let light = |mass: &Rational| *mass <= Rational::new(11.into(), 10.into());
        let mut modes = Vec::new();
        for mode in &self.advice.modes {
            let mut mode = mode.clone();
            let Some(bond) = mode.bond.clone().filter(|bond| bond.masses.iter().any(light)) else {
                modes.push(mode);
                continue;
            };
            if lever.way == Way::Held {
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

    fn kicks(&self, lever: &Lever) -> Checked {
        let (mut steps, count) = (self.steps().to_vec(), self.steps().len());
        let ratio = lever.name.strip_prefix("ratio ");
        if let Some(p) = ratio {
            holds(count > 1, || "one clock has no ratio".into())?;
            steps[count - 1] = &steps[count - 2] * parse_rational("lever", p)?;
        }
        // The inner steps are those of the scheme, and all columns belong to the ratio of the step that is
        // taken.
        let outer = match &lever.step {
            Some((step, _)) if ratio.is_none() && count > 1 => step.clone(),
            _ => steps.last().cloned().unwrap_or_default(),
        };
        let mass = stiffest(&self.modes_of(lever)?, &steps, None);
        let mass = if count > 1 { mass.with_outer(&outer) } else { mass };
        let (Some(first), Some(edge)) = (lever.first, lever.band_edge) else {
            return holds(false, || "it lacks its edges".into());
        };
        // Periods that are all shorter by the band are steps that are all longer.
        let longer = self.shorter().recip();
        mass.ends_within(&outer, first, "its first region")?;
        mass.scaled(&longer).ends_within(&outer, edge, "its band")?;
        let Some((step, _)) = &lever.step else { return Ok(()) };
        let is_proven = mass.scaled(&(step / &outer * longer)).in_first_region()? == Some(true);
        holds(is_proven, || "its step is not proven for the band".into())
    }

    /// The step is damped.
    fn masked(&self, lever: &Lever) -> Checked {
        let Some(((step, _), rate)) = lever.step.as_ref().zip(self.advice.friction.as_ref()) else {
            return holds(false, || "a friction masks no step".into());
        };
        let mut mass = self.mass(&self.advice.schemes[0].scheme, None);
        mass.steps.pop();
        mass.steps.push(step.clone());
        holds(mass.is_damped(rate)? != Some(false), || "the friction does not mask that step".into())
    }

    /// Two clocks: the stiffest mode on each, and the same with the band's shortest periods.
    fn other_method(&self, lever: &Lever) -> Checked {
        let scheme = &self.advice.schemes[0].scheme;
        let (given, corner) = (self.mass(scheme, None), self.corner(scheme));
        let edge = lever.band_edge.filter(|_| given.stiffness.len() == 2);
        let edge = edge.ok_or_else(|| Fault::Wrong("it is of two clocks".into()))?;
        if let Some(first) = lever.first {
            holds(ends_at(lever.way, first, &given), || {
                format!("it is not unstable in {}..{}", first.0, first.1)
            })?;
        }
        holds(ends_at(lever.way, edge, &corner), || format!("it does not end in {}..{}", edge.0, edge.1))?;
        let slow = self.advice.modes.iter().filter(|mode| mode.clock == Some(1));
        let is_exact =
            lever.exact.as_ref().zip(slow.map(|mode| &mode.stiffness).max()).is_none_or(|(h, slow)| {
                Laurent::product(&Laurent::product(h, h), slow) == Laurent::from_integer(4)
            });
        holds(is_exact, || "it is not unstable at exactly that step".into())
    }
}

/// Whether one of the conditions fails between both ends, or there: h² S < 4, h w < π, |Tr| < 2.
fn ends_at(way: Way, ends: (f64, f64), mass: &Mass) -> bool {
    let at = |x: f64| Ball::from_rational(&exact(x), BITS);
    let [lo, hi] = [at(ends.0), at(ends.1)];
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
        let filter = match way {
            Way::Molly(Trigonometric::Short) => sinc(&x.scale2(-1)),
            _ => sinc(&x.scale2(-1)).square(BITS),
        };
        let kicked = slow(h).mul(&filter.square(BITS), BITS).mul(&sinc(&x), BITS);
        x.cos(BITS).scale2(1).sub(&kicked, BITS).abs().sub(&Ball::from_integer(&2.into()), BITS)
    };
    match way {
        Way::Molly(Trigonometric::Short | Trigonometric::Linear) => rigid || passes(&excess),
        Way::Molly(Trigonometric::Long) => rigid || passes(&|h| angle(h).sub(&Ball::pi(BITS), BITS)),
        _ => rigid,
    }
}
