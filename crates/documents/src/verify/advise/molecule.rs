//! Advice on Hessians: what it proves, and growth, by another route.

use std::borrow::Cow;

use crate::input::SystemScene;
use crate::question::Advised;
use crate::verify::context::{self, Checked, Context, Outcome, ROOM, failure, holds, too_costly};
use crate::verify::system::bias::{agree, most_off};
use molecules::{Finding, Findings, MOST_PRODUCTS, Scheme};
use num_traits::Zero;
use number::{Rational, Result, from_f64_exact, to_f64};
use systems::levels::{Hessians, Near};
use systems::{Holds, Limits, Potential, System, decide_system};

/// Another route to what a row proves.
trait Route {
    /// The products that it costs, about.
    fn cost(&self, finding: &Finding) -> u64;
    fn row(&self, finding: &Finding) -> Checked;
    /// Whether the ends of the region are among what it proves.
    fn has_ends(&self, finding: &Finding) -> bool;
    fn route(&self) -> &'static str;
}

/// The route that does not share a step with how this system is advised on.
fn route<'a>(scene: &'a SystemScene, band: f64, limits: &'a Limits) -> Result<Box<dyn Route + 'a>> {
    let levels = scene.model().measured()?.levels()?;
    Ok(match levels.source.kernel() {
        Some(kernel) => Box::new(Other::new(scene, kernel.norms().map(|norm| levels.accuracy * norm), band)?),
        None => Box::new(Many { system: scene.model().moving()?, scene, band, limits }),
    })
}

/// Steps of this part of a band's edge are short: the scheme is unstable there only where the stiffnesses
/// are.
const SHORT: f64 = 1.0 / 1024.0;

/// Levels of any number as a rational system of the doubles given: half periods kick by kick, each at one
/// step.
struct Many<'a> {
    system: Cow<'a, System>,
    scene: &'a SystemScene,
    band: f64,
    limits: &'a Limits,
}

impl Many<'_> {
    /// The verdict at the steps of a scheme, all times `factor`, with the stiffness of each level times one
    /// of `scales`.
    fn at(&self, scheme: &Scheme, factor: f64, scales: &[f64]) -> Result<Holds> {
        let exact = |x: f64| from_f64_exact(x).unwrap_or_else(Rational::zero);
        let (unit, factor) = (self.scene.femtoseconds()?, exact(factor));
        let potential = |((potential, step), scale): ((&Potential, &Rational), &f64)| Potential {
            stiffness: potential.stiffness.scaled(&exact(*scale)),
            step: step * &factor / &unit,
            ..potential.clone()
        };
        let all = self.system.potentials().iter().zip(scheme.steps()).zip(scales).map(potential);
        let system = System::new(self.system.mass().clone(), all.collect())?;
        Ok(decide_system(&system, self.limits)?.holds())
    }

    fn is(&self, holds: Holds, at: (&Scheme, f64, &[f64]), what: &str) -> Checked {
        let found = self.at(at.0, at.1 / to_f64(at.0.outer()), at.2)?;
        context::holds(found == holds, || {
            format!("at {} fs {what} is {} by half periods", at.1, found.name())
        })
    }
}

impl Route for Many<'_> {
    fn cost(&self, finding: &Finding) -> u64 {
        let kicks = to_f64(&(finding.scheme.outer() / finding.scheme.inner())).ceil() as u64;
        // Some eight verdicts, each of some hundred products of matrices.
        (self.system.size() as u64).saturating_pow(3).saturating_mul(8 * (100 + kicks))
    }

    fn row(&self, finding: &Finding) -> Checked {
        let levels = finding.scheme.steps().len();
        let as_given = vec![1.0; levels];
        if finding.holds != Holds::Undecided {
            self.is(
                finding.holds,
                (&finding.scheme, to_f64(finding.scheme.outer()), &as_given),
                "the scheme",
            )?;
        }
        if let Some((lo, hi)) = finding.first {
            self.is(Holds::Stable, (&finding.scheme, lo * (1.0 - ROOM), &as_given), "the last stable step")?;
            self.is(
                Holds::Unstable,
                (&finding.scheme, hi * (1.0 + ROOM), &as_given),
                "the first unstable step",
            )?;
        }
        if let Some(edge) = finding.band_edge {
            let [most, least] = [1.0 - self.band, 1.0 + self.band].map(|part| part.powi(-2));
            for which in 0..1usize << (levels - 1) {
                let slower = (0..levels - 1).map(|k| if which >> k & 1 == 1 { least } else { most });
                let scales: Vec<f64> = [most].into_iter().chain(slower).collect();
                let corner = self.is(
                    Holds::Stable,
                    (&finding.scheme, edge * (1.0 - ROOM), &scales),
                    "a corner of the band",
                );
                // The band is of stiffnesses whose sum is definite: of others not even short steps are
                // stable.
                let short = SHORT * edge / to_f64(finding.scheme.outer());
                if corner.is_err() && self.at(&finding.scheme, short, &scales)? != Holds::Unstable {
                    return corner;
                }
            }
        }
        Ok(())
    }

    fn has_ends(&self, _: &Finding) -> bool {
        true
    }

    fn route(&self) -> &'static str {
        "the scheme, both sides of the first unstable step and the corners of the band, each at one step, by half periods of a rational system of the doubles given"
    }
}

/// The action and the full period, in the coordinates of the Hessians.
struct Other {
    hessians: Hessians,
    /// Upper bounds of both norms, times the accuracy.
    off: [f64; 2],
    band: f64,
    /// fs in the file's unit of time.
    unit: f64,
}

/// By how much growth per period may differ: a multiplier near a double one moves by the square root of the
/// roundings.
const GROWTH: f64 = 1e-5;

impl Other {
    fn new(scene: &SystemScene, off: [f64; 2], band: f64) -> Result<Other> {
        let unit = to_f64(&scene.femtoseconds()?);
        Ok(Other { hessians: scene.model().measured()?.hessians_of_two()?, off, band, unit })
    }

    fn inner_steps(finding: &Finding) -> u64 {
        to_f64(&(finding.scheme.outer() / finding.scheme.inner())).round() as u64
    }

    fn has_paths(&self, finding: &Finding) -> bool {
        self.hessians.has_paths(Other::inner_steps(finding))
    }
}

impl Route for Other {
    fn cost(&self, finding: &Finding) -> u64 {
        let p = Other::inner_steps(finding);
        let paths = if self.has_paths(finding) { self.hessians.cost_of_paths(p) } else { 0 };
        self.hessians.cost_of_period(p).saturating_add(paths)
    }

    fn row(&self, finding: &Finding) -> Checked {
        let (p, outer) = (Other::inner_steps(finding), to_f64(finding.scheme.outer()));
        let growth = self.hessians.growth_of_period(outer / self.unit, p) * outer / self.unit;
        let right = finding.rate.is_none_or(|rate| (growth - rate * outer).abs() < GROWTH);
        holds(right, || format!("growth is {growth} in a period"))?;
        if !self.has_paths(finding) {
            return Ok(());
        }
        let stable = |step: f64, near: Near| self.hessians.paths_prove_stable(step / self.unit, p, near);
        let unstable = |step: f64| self.hessians.paths_prove_unstable(step / self.unit, p);
        if let Some((lo, hi)) = finding.first {
            holds(stable(lo * (1.0 - ROOM), Near::EXACTLY), || format!("is not proven stable up to {lo}"))?;
            holds(unstable(hi * (1.0 + ROOM)), || format!("is not proven unstable from {hi} on"))?;
        }
        if let Some(upper) = finding.first_upper {
            holds(unstable(upper * (1.0 - ROOM)), || format!("is not proven unstable up to {upper}"))?;
        }
        if let Some(edge) = finding.band_edge {
            let [most, least] = [1.0 - self.band, 1.0 + self.band].map(|part| part.powi(-2));
            for slow in [most, least] {
                let off = [most * self.off[0], slow * self.off[1]];
                let near = Near { factors: [most, slow], off };
                holds(stable(edge * (1.0 - ROOM), near), || {
                    format!("the band is not proven stable up to {edge}")
                })?;
            }
        }
        Ok(())
    }

    fn has_ends(&self, finding: &Finding) -> bool {
        self.has_paths(finding)
    }

    fn route(&self) -> &'static str {
        ROUTE
    }
}

const ROUTE: &str = "the ends of the first region and of the band by the action as one matrix over the paths, growth by the full \
                     period kick by kick";

/// The bias at the outer step and at the safe one by a rational system of the doubles given; false where it
/// would cost too much.
fn bias(scene: &SystemScene, finding: &Finding) -> Checked<bool> {
    let (unit, moving) = (scene.femtoseconds()?, scene.model().moving()?);
    let is_stable = finding.holds == Holds::Stable;
    let scheme = &finding.scheme;
    let asked = is_stable.then(|| scheme.outer()).map(|outer| (outer, &finding.bias));
    let safe = finding.safe.as_ref().map(|safe| (safe, &finding.safe_bias));
    holds(is_stable || finding.bias.is_none(), || "a bias of what is not stable".into())?;
    holds(safe.is_some() || finding.safe_bias.is_none(), || "a bias at no step".into())?;
    let mut is_seen = true;
    for (outer, told) in asked.into_iter().chain(safe) {
        let (_, inner) = scheme.steps().split_last().expect("at least one step");
        let steps = inner.iter().chain([outer]).map(|step| step / &unit);
        let potential =
            |(potential, step): (&Potential, Rational)| Potential::new(potential.stiffness.clone(), step);
        let all = moving.potentials().iter().zip(steps).map(potential);
        let system = System::new(moving.mass().clone(), all.collect())?;
        let Some(truth) = most_off(&system)? else {
            is_seen = false;
            continue;
        };
        let right = told.as_ref().is_some_and(|told| agree(told.bias, truth));
        holds(right, || format!("at {outer} fs the bias that is most off is {truth}"))?;
    }
    Ok(is_seen)
}

pub fn check(
    question: &Advised,
    scene: &SystemScene,
    findings: &Findings,
    context: &Context,
) -> Result<Outcome> {
    let limits = Limits { products: context.options.budget.unwrap_or(MOST_PRODUCTS), ..Limits::default() };
    let other = route(scene, to_f64(&question.band), &limits)?;
    let mut outcome = Outcome::holding(other.route(), findings.schemes.len() as u64);
    let (mut spent, mut is_bias_seen) = (0_u64, true);
    for (row, finding) in (1..).zip(&findings.schemes) {
        let cost = spent.saturating_add(other.cost(finding));
        if let Err(error) = limits.allow(cost, || format!("schemes 1 to {row}")) {
            outcome.not_rechecked.push(too_costly(&format!("row {row}"), &error));
            continue;
        }
        spent = cost;
        outcome.failures.extend(failure(row, other.row(finding))?);
        let seen = bias(scene, finding);
        is_bias_seen &= !matches!(seen, Ok(false));
        outcome.failures.extend(failure(row, seen.map(drop))?);
    }
    if !is_bias_seen {
        outcome.not_rechecked.push("bias, safe_bias by the dense full period: computed again only".into());
    }
    if !findings.schemes.iter().all(|scheme| other.has_ends(scheme)) {
        let why = "first, band_edge by the other route: too many steps for the action's matrix, computed again only";
        outcome.not_rechecked.push(why.into());
    }
    if findings.levers.is_some() {
        outcome.not_rechecked.push("levers: computed again only".into());
    }
    Ok(outcome)
}
