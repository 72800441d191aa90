//! The row of a mode at a scheme, checked.

use super::claim::{Claim, Row};
use super::mass::{BITS, Mass, crosses, exact, fastest_growth};
use crate::verify::context::{Checked, holds, same};
use crate::verify::written::Ends;
use clocks::verdict::Kind;
use number::rational::simplest;
use number::{Ball, Rational, Sign};

impl Claim {
    /// Every field of a row.
    pub fn row(&self, row: &Row) -> Checked {
        let scheme = (row.scheme as usize).wrapping_sub(1);
        let mode = self.modes_asked().find(|mode| mode.name == row.mode);
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
            row.growth(&trace, &period, &outer, self.per())?;
        } else {
            let none = row.tenfold_steps.is_none() && (row.growth_rate.lo, row.growth_rate.hi) == (0.0, 0.0);
            holds(none, || "grows though it is not hyperbolic".into())?;
        }
        self.friction(row, &mass)?;
        row.ratios(&mass)?;
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
        for (n, (lower, upper, worst)) in intervals.into_iter().enumerate() {
            let (Some(lower), Some(upper)) = (lower, upper) else {
                // One point, or without an end: the pivots show where the first one begins.
                holds(upper.is_none() && worst.is_none(), || "an interval lacks an end".into())?;
                lower.filter(|_| n > 0).map_or(Ok(()), |lower| crosses(&at, lower, "lower"))?;
                continue;
            };
            crosses(&at, lower, "lower")?;
            crosses(&at, upper, "upper")?;
            fastest_growth(&at, (lower.hi, upper.lo), worst)?;
        }
        let order = |a: Option<Ends>, b: &Rational| a.is_none_or(|a| exact(a.lo) <= *b);
        holds(order(row.below_upper, &outer) && row.above_lower.is_none_or(|a| exact(a.hi) >= outer), || {
            "below and above lie on the wrong sides".into()
        })
    }

    /// Damped by the frictions that are said to mask, some larger ones where all are, and not by the one that
    /// is said not to.
    fn friction(&self, row: &Row, mass: &Mass) -> Checked {
        let per_fs = |per_ps: f64| exact(per_ps) / Rational::from_integer(self.per().into());
        if let Some(masked) = row.masked_above {
            let grows = *row.kind == Kind::Hyperbolic && masked.lo > 0.0;
            let right = grows && mass.is_damped(&per_fs(masked.lo))? != Some(true);
            holds(right, || "masked_above is not the friction that masks it".into())?;
            let (lo, hi) = (masked.hi, row.masked_below);
            let others =
                hi.map_or([2.0, 30.0, 1e3].map(|times| times * lo), |hi| [hi, lo + (hi - lo) / 2.0, lo]);
            for friction in [lo].into_iter().chain(others) {
                let masks = mass.is_damped(&per_fs(friction))? != Some(false);
                holds(masks, || format!("a friction of {friction}/ps does not mask it"))?;
            }
        }
        match (row.damped, &self.input.friction) {
            (Some(said), Some(friction)) => {
                let truth = mass.is_damped(friction)?;
                holds(truth.is_none_or(|truth| truth == said), || format!("damped is not {said}"))
            }
            (said, given) => holds(said.is_none() || given.is_some(), || "damped without a friction".into()),
        }
    }
}

impl Row {
    /// The simplest ratio of each tenth of the range is unstable, and the scheme's own one lies in it.
    fn ratios(&self, mass: &Mass) -> Checked {
        let (Some(lo), Some(hi)) = (&self.ratios_lower, &self.ratios_upper) else {
            return holds(self.ratios_lower.is_none() && self.ratios_upper.is_none(), || {
                "its range of ratios lacks an end".into()
            });
        };
        let tenth = (&hi.0 - &lo.0) / Rational::from_integer(10.into());
        let inner = &mass.steps[0];
        let own = &self.outer.0 / inner;
        holds(mass.steps.len() == 2 && lo.0 <= own && own <= hi.0 && lo.0 < hi.0, || {
            format!("its range of ratios does not hold {own}")
        })?;
        for k in 0..10 {
            let at = |k: i64| &lo.0 + &tenth * Rational::from_integer(k.into());
            let ratio = simplest(&at(k), &at(k + 1));
            let steps = vec![inner.clone(), &ratio * inner];
            let stiffness = mass.stiffness.clone();
            holds(Mass { steps, stiffness }.excess()? != Some(Sign::Negative), || {
                format!("the ratio {ratio} is stable")
            })?;
        }
        Ok(())
    }

    /// acosh(|Tr|/2) by logarithms.
    fn growth(&self, trace: &Ball, period: &Rational, outer: &Rational, per: u32) -> Checked {
        let half = trace.abs().scale2(-1);
        let root = half.square(BITS).sub(&Ball::one(), BITS).sqrt_clipped(BITS).unwrap_or_else(Ball::zero);
        let ln = half.add(&root, BITS).ln(BITS).unwrap_or_else(Ball::zero);
        let rate = ln.div(&Ball::from_rational(period, BITS), BITS).unwrap_or_else(Ball::zero);
        let per_ps = rate.mul(&Ball::from_integer(&per.into()), BITS);
        holds(self.growth_rate.holds(&per_ps), || format!("the growth rate is {}", per_ps.mid_f64()))?;
        let ten = Ball::from_integer(&10.into()).ln(BITS).expect("10 > 0");
        let steps = ten.div(&rate.mul(&Ball::from_rational(outer, BITS), BITS), BITS);
        let right = self.tenfold_steps.zip(steps).is_some_and(|(said, steps)| said.holds(&steps));
        holds(right, || "tenfold_steps is not that of the growth rate".into())
    }
}
