//! The row of a scheme of steps, checked.

use num_traits::One;

use super::claim::{Claim, SchemeRow};
use super::mass::{BITS, Mass, exact};
use crate::number::{Ball, Rational, Sign};
use crate::recheck::context::{Checked, holds, same};
use crate::recheck::written::Ends;

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
        let third = exact(self.fastest()?.third.lo);
        let stable = self.of(n).all(|row| row.kind.is_stable());
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
        let silent = corner.steps.len() > 1
            && corner.stiffness.last().is_some_and(|last| last.sign() == Some(Sign::Zero));
        holds(row.needs.is_some() == (silent && in_band), || "needs is given for a silent clock".into())?;
        let Some(needs) = row.needs else { return Ok(()) };
        let with = |period: f64| -> Checked<Option<bool>> {
            let turn = Ball::pi(BITS).scale2(1);
            let shorter = exact(period) * (Rational::one() - &self.input.band);
            let frequency = turn.div(&Ball::from_rational(&shorter, BITS), BITS).unwrap_or_else(Ball::zero);
            let mut stiffness = corner.stiffness.clone();
            *stiffness.last_mut().expect("a clock") = frequency.square(BITS);
            Mass { steps: corner.steps.clone(), stiffness }.in_first_region()
        };
        let right = needs > 0.0
            && needs.is_finite()
            && with(needs)? == Some(true)
            && with(0.999_99 * needs)? == Some(false);
        holds(right, || "needs is not the shortest slow period".into())
    }

    /// That the band's corner is in the first region at `largest`, and not at the next multiple; and `safe` below T/3.
    fn largest(&self, corner: &Mass, row: &SchemeRow) -> Checked {
        let count = corner.steps.len();
        let third = exact(self.fastest()?.third.lo);
        let with = |outer: &Rational| -> Checked<bool> {
            Ok(corner.with_outer(outer).in_first_region()? == Some(true))
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
        let whole = count == 1 || (&safe.0 / &corner.steps[count - 2]).is_integer();
        let bounded = whole && safe.0 <= largest.0 && (safe.0 < third || (count == 1 && safe.0 == third));
        let longest = count == 1 || safe.0 == largest.0 || &safe.0 + &corner.steps[count - 2] >= third;
        holds(bounded && longest, || format!("{} is not the longest outer step below T/3", safe.0))
    }
}
