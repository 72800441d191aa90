//! The row of a scheme of steps, checked.

use num_traits::One;

use super::claim::{Claim, SchemeRow};
use super::mass::{BITS, Mass, exact};
use crate::verify::context::{Checked, holds, same};
use crate::verify::written::Ends;
use number::{Ball, Rational, Sign};

impl Claim {
    /// Every field of a scheme but `within_run`; `needs` is checked to a millionth.
    pub fn scheme(&self, n: usize, row: &SchemeRow) -> Checked {
        let corner = self.corner(n)?;
        let outer = corner.steps.last().cloned().unwrap_or_default();
        holds(row.outer.0 == outer, || format!("the outer step of scheme {} is {outer}", n + 1))?;
        let in_band = corner.in_first_region()? == Some(true);
        // The lowest first edge, times 1 − band.
        let edges: Vec<Ends> = self.of(n).filter_map(|row| row.first_lower).collect();
        let least = |pick: fn(&Ends) -> f64| edges.iter().map(pick).fold(f64::INFINITY, f64::min);
        let shrink = |x: f64| Ball::from_rational(&(exact(x) * (Rational::one() - &self.input.band)), BITS);
        let (lo, hi) = (shrink(least(|e| e.lo)), shrink(least(|e| e.hi)));
        holds(exact(row.band_edge.lo) <= lo.upper() && hi.lower() <= exact(row.band_edge.hi), || {
            "band_edge is not that of the rows".into()
        })?;
        let given = self.mass(n, None)?;
        let stable = self.of(n).all(|row| row.kind.is_stable());
        let before = self.of(n).all(|row| row.first_lower.is_some_and(|edge| outer < exact(edge.lo)));
        let status = match () {
            () if self.lacks_fast() => "not told",
            () if !stable => "unstable",
            () if in_band && self.input.beads.is_some() => "not told",
            () if in_band && self.is_published(&given, &outer)? => "safe",
            () if in_band => "caution",
            () if before => "near",
            () => "island",
        };
        same("status", row.status.as_str(), status)?;
        self.largest(&corner, &given, row)?;
        let silent: Vec<usize> =
            (1..corner.steps.len()).filter(|&k| corner.stiffness[k].sign() == Some(Sign::Zero)).collect();
        let asked = !silent.is_empty() && in_band && !self.lacks_fast();
        holds(row.needs.is_some() == asked, || "needs is given for a silent clock".into())?;
        let Some(needs) = row.needs else { return Ok(()) };
        let with = |period: f64| -> Checked<Option<bool>> {
            let turn = Ball::pi(BITS).scale2(1);
            let shorter = exact(period) * (Rational::one() - &self.input.band);
            let frequency = turn.div(&Ball::from_rational(&shorter, BITS), BITS).unwrap_or_else(Ball::zero);
            let mut stiffness = corner.stiffness.clone();
            silent.iter().for_each(|&k| stiffness[k] = frequency.square(BITS));
            Mass { steps: corner.steps.clone(), stiffness }.in_first_region()
        };
        let right = needs > 0.0
            && needs.is_finite()
            && with(needs)? == Some(true)
            && with(0.999_99 * needs)? == Some(false);
        holds(right, || "needs is not the shortest slow period".into())
    }

    /// Whether all steps are below what is published, with this outermost one.
    fn is_published(&self, given: &Mass, outer: &Rational) -> Checked<bool> {
        let last = given.steps.len() - 1;
        let flag = (0..last).all(|k| self.is_below_turn(given, k, &given.steps[k]));
        Ok(flag
            && self.is_below_turn(given, last, outer)
            && (last == 0 || *outer < exact(self.fastest()?.third.lo)))
    }

    /// That the band's corner is in the first region at `largest`, and not at the next multiple; and `safe`
    /// below what is published.
    fn largest(&self, corner: &Mass, given: &Mass, row: &SchemeRow) -> Checked {
        let count = corner.steps.len();
        let with = |outer: &Rational| -> Checked<bool> {
            Ok(corner.with_outer(outer).in_first_region()? == Some(true))
        };
        let silent = corner.stiffness.iter().any(|ball| ball.sign() == Some(Sign::Zero)) || self.lacks_fast();
        let Some(largest) = &row.largest else {
            return holds(
                row.safe.is_none() && (silent || count == 1 || !with(&corner.steps[count - 2])?),
                || "largest is missing".into(),
            );
        };
        holds(!silent && with(&largest.0)?, || {
            format!("an outer step of {} is not proven for the band", largest.0)
        })?;
        let unit = if count > 1 { corner.steps[count - 2].clone() } else { Rational::one() };
        let whole = |step: &Rational| count == 1 || (step / &unit).is_integer();
        if count > 1 {
            let next = &largest.0 + &unit;
            holds(whole(&largest.0) && !with(&next)?, || {
                format!("{} is not the largest multiple", largest.0)
            })?;
        }
        // Of one step the bound itself is told, of several the longest multiple below it.
        let beside = |step: &Rational, by: i64| {
            step * Rational::new((1_000_000_000_000 + by).into(), 1_000_000_000_000_i64.into())
        };
        let Some(safe) = &row.safe else {
            let none = self.input.beads.is_some() || !self.is_published(given, &unit)?;
            return holds(none && row.bound.is_none(), || "safe is missing".into());
        };
        let next = if count == 1 { beside(&safe.0, 1) } else { &safe.0 + &unit };
        let value = if count == 1 { beside(&safe.0, -1) } else { safe.0.clone() };
        let bounded = whole(&safe.0) && safe.0 <= largest.0 && self.is_published(given, &value)?;
        let longest = safe.0 == largest.0 || !self.is_published(given, &next)?;
        holds(bounded && longest && self.input.beads.is_none(), || {
            format!("{} is not the longest outer step below what is published", safe.0)
        })?;
        let band = row.bound.as_deref() == Some("band");
        holds(row.bound.is_some() && band == (safe.0 == largest.0), || "bound is not what bounds safe".into())
    }
}
