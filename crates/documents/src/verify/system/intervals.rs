//! Intervals: the stretches, held against systems at numbers inside them.
//!
//! Kicks and drifts of measured levels are followed over half a period in doubles, kick by kick, without the
//! cells that made the document, at an outer step or at another value of what is varied. The eigenvalues of
//! S = Bᵀ C say whether anything grows there. Where nothing does, each mode v has a sign of Krein's, that of
//! vᵀ Aᵀ C v, and multipliers leave the circle only where they meet one of the other sign, or ±1. So where
//! the order of the signs differs at two places of a stretch that is said to be stable, what was passed
//! between them is looked for by halving. Other methods have the growth of their dense step alone.

use std::borrow::Cow;

use faer::Mat;
use num_traits::One;

use crate::input::{OUTER, SystemScene};
use crate::question::System;
use crate::verify::context::{ALONE, Checked, Context, Fault, Outcome, failure, holds, too_costly};
use crate::verify::sample::sample;
use number::parallel::try_map;
use number::{Rational, Result, from_f64_exact, to_f64};
use systems::levels::Method;
use systems::stretches::Stretch;
use systems::vary::Intervals;
use systems::{Holds, Limits, Model, Route, eigen, half_period};

/// Stretches that are looked at, unless all are asked for; all of measured levels where it costs no more than
/// is allowed.
const MOST: u64 = 24;

/// Where in a stretch: beside its ends, too.
const INSIDE: [f64; 5] = [1.0 / 64.0, 0.25, 0.5, 0.75, 63.0 / 64.0];

/// ln |λ| of a period below which roundings may have made it: of modes that meet, about the square root of
/// 10^-16 times their condition.
const STILL: f64 = 1e-5;

/// Each stretch begins where the one before it ends; a sample of them by the route that the model has.
pub fn check(
    question: &System,
    scene: &SystemScene,
    found: &Intervals,
    context: &Context,
) -> Result<Outcome> {
    let (count, route) = (found.stretches.len() as u64, "each stretch begins where the one before it ends");
    let mut failures = Vec::new();
    for row in 1..=count {
        failures.extend(failure(row, joined(row as usize, found))?);
    }
    if !failures.is_empty() {
        return Ok(Outcome { failures, ..Outcome::holding(route, count) });
    }
    // Other systems are looked at by their steps alone.
    if scene.model().measured().is_err() || found.is_discrete {
        return Ok(Outcome::holding(ALONE, count));
    }
    let all = (1..).zip(&found.stretches).filter(|(_, stretch)| stretch.verdict != Holds::Undecided);
    let decided = Decided { count, drawn: all.collect(), context };
    let places = Places::of(scene, &found.number, question.width().unwrap_or_default())?;
    Ok(Outcome { rows: count, ..decided.by_half_periods(&places, &scene.source().to_string())? })
}

/// That the n-th stretch, counted from 1, begins where the one before it ends. Of isolated edges the next
/// double begins a stretch.
fn joined(n: usize, found: &Intervals) -> Checked {
    let stretch = &found.stretches[n - 1];
    holds(stretch.lo <= stretch.hi, || "it ends before it begins".into())?;
    let Some(before) = n.checked_sub(2).map(|before| found.stretches[before].hi) else { return Ok(()) };
    let is_joined =
        [before, before.next_up()].contains(&stretch.lo) || found.is_discrete && stretch.lo > before;
    holds(is_joined, || format!("it begins at {}, the one before it ends at {before}", stretch.lo))
}

/// The stretches with a verdict that are looked at, each with its row.
struct Decided<'a> {
    /// Rows in all.
    count: u64,
    drawn: Vec<(u64, &'a Stretch)>,
    context: &'a Context<'a>,
}

impl Decided<'_> {
    /// Some of them, unless all are asked for.
    fn sampled(mut self, seed: &str) -> Self {
        if !self.context.options.all {
            let drawn = sample(seed, self.drawn.len() as u64, MOST);
            self.drawn = drawn.into_iter().map(|n| self.drawn[n as usize]).collect();
        }
        self
    }

    /// `outcome` with what `check` finds of each.
    fn look(&self, outcome: Outcome, check: impl Fn(&Stretch) -> Checked + Sync) -> Result<Outcome> {
        let look = |(row, stretch): &(u64, &Stretch)| failure(*row, check(stretch));
        let failures = try_map(&self.drawn, look)?;
        let sample = Some((failures.len() as u64, self.count));
        Ok(Outcome { sample, failures: failures.into_iter().flatten().collect(), ..outcome })
    }

    /// All, or a sample where that costs too much.
    fn by_half_periods(self, places: &Places, seed: &str) -> Result<Outcome> {
        let limits = self.context.work().products();
        let allow = |decided: &Self| places.allow(decided.drawn.len(), &limits);
        let decided = if allow(&self).is_ok() { self } else { self.sampled(seed) };
        let (route, between) = if places.has_signs() {
            (HALF, BETWEEN)
        } else {
            (STEP, "that nothing grows between these places")
        };
        let mut found = Outcome::whole(route, Ok(()))?;
        if let Err(error) = allow(&decided) {
            found.not_rechecked.push(too_costly("the stretches", &error));
            return Ok(Outcome { route: ALONE, sample: Some((0, decided.count)), ..found });
        }
        found.not_rechecked.push(between.into());
        decided.look(found, |stretch| places.stretch(stretch))
    }
}

/// The routes of measured levels: of kicks and drifts, and of other methods.
const HALF: &str = "the half period in doubles, kick by kick, at five places of each stretch; the order of Krein's signs between them";
const STEP: &str = "the growth of the dense step in doubles, at five places of each stretch";

/// The part of the claim that half periods at five places leave open.
const BETWEEN: &str =
    "that nothing grows between these places where the order of the signs is the same at both";

/// A measured system at all values of what is varied.
struct Places<'a> {
    scene: &'a SystemScene,
    path: &'a str,
    /// The system as it is, of kicks and drifts, and its longest step.
    system: Option<systems::System>,
    outer: Rational,
    /// No interval as wide, relative to its end, hides where the order of signs differs.
    width: f64,
}

/// What doubles see at a place.
#[derive(Debug, PartialEq)]
enum Motion {
    /// ln |λ| of a period, above [`STILL`].
    Grows(f64),
    /// All multipliers turn, and none is near one of the other sign: the signs by increasing angle.
    Turns(Vec<bool>),
    Unclear,
}

impl<'a> Places<'a> {
    fn of(scene: &'a SystemScene, path: &'a str, width: f64) -> Result<Places<'a>> {
        let outer = scene.model().outer_step();
        let is_respa = scene.model().method() == Method::Respa;
        let system = is_respa.then(|| scene.model().moving()).transpose()?.map(Cow::into_owned);
        Ok(Places { scene, path, system, outer, width })
    }

    fn has_signs(&self) -> bool {
        self.system.is_some()
    }

    /// Five half periods of each stretch, about as many halvings: kicks on 2n columns, eigenvalues and
    /// vectors.
    fn allow(&self, stretches: usize, limits: &Limits) -> Result<()> {
        let (n, kicks) = match &self.system {
            Some(system) => (system.size() as u64, system.schedule().strikes() / 2 + 1),
            None => (self.scene.model().size() as u64, 1),
        };
        let each = n.saturating_pow(3).saturating_mul(30 + 2 * kicks);
        let cost = each.saturating_mul(10 * stretches as u64);
        limits.allow(cost, || format!("half periods of {n} degrees of freedom at {} places", 10 * stretches))
    }

    fn motion(&self, place: f64) -> Result<Motion> {
        let Some(place) = from_f64_exact(place) else { return Ok(Motion::Unclear) };
        let at = || self.scene.with("intervals", &[(self.path, &place)]);
        let Some(system) = &self.system else {
            let scene = at()?;
            let outer = scene.model().outer_step();
            let rate = scene.model().growth_of_period(&Limits::default())?;
            let growth = rate.map_or(f64::NAN, |rate| rate * to_f64(&outer));
            return Ok(match growth {
                value if value > STILL => Motion::Grows(value),
                // Less may be growth all the same: the verdict at this place says.
                value if value.is_finite() && is_proven_stable(scene.model())? => Motion::Turns(Vec::new()),
                _ => Motion::Unclear,
            });
        };
        let h = half_period::<f64>(&match self.path {
            OUTER => system.with(&Rational::one(), &(place / &self.outer))?,
            _ => at()?.model().moving()?.into_owned(),
        });
        let n = system.size();
        let block = |i: usize, j: usize| Mat::from_fn(n, n, |k, l| h[(i * n + k, j * n + l)]);
        let (a, c) = (block(0, 0), block(1, 0));
        let s = block(0, 1).transpose() * &c;
        let is_finite = (0..n).all(|j| (0..n).all(|i| s[(i, j)].is_finite()));
        let Some((mu, v)) = is_finite.then(|| eigen(&s)).flatten() else { return Ok(Motion::Unclear) };
        // 1 + 2 μ = cosh ln λ; see `system::spectrum::rate`.
        let excess = mu.iter().map(|mu| (mu.norm() + (mu + 1.0).norm() - 1.0) / 2.0).fold(0.0, f64::max);
        let growth = 2.0 * excess.sqrt().asinh();
        if growth > STILL {
            return Ok(Motion::Grows(growth));
        }
        // A pair that has just left the circle, or that roundings have joined.
        if mu.iter().any(|mu| mu.im != 0.0) {
            return Ok(Motion::Unclear);
        }
        let (av, cv) = (&a * &v, &c * &v);
        let sign = |k: usize| (0..n).map(|i| av[(i, k)] * cv[(i, k)]).sum::<f64>() > 0.0;
        // μ = −sin² θ/2 for λ = e^(iθ).
        let angle = |k: usize| 2.0 * (-mu[k].re).clamp(0.0, 1.0).sqrt().asin();
        let mut modes: Vec<(f64, bool)> = (0..n).map(|k| (angle(k), sign(k))).collect();
        modes.sort_by(|x, y| x.0.total_cmp(&y.0));
        let are_apart = modes.windows(2).all(|two| two[0].1 == two[1].1 || two[1].0 - two[0].0 > STILL);
        let are_off_ends = modes.iter().all(|mode| mode.0 > STILL && mode.0 < std::f64::consts::PI - STILL);
        let turns = are_apart && are_off_ends;
        Ok(if turns {
            Motion::Turns(modes.into_iter().map(|mode| mode.1).collect())
        } else {
            Motion::Unclear
        })
    }

    fn stretch(&self, said: &Stretch) -> Checked {
        let at = |part: f64| said.lo + (said.hi - said.lo) * part;
        let mut before = None;
        for place in INSIDE.map(at) {
            match (self.motion(place)?, said.verdict) {
                (Motion::Grows(growth), Holds::Stable) => return Err(grows(place, growth)),
                (Motion::Turns(_), Holds::Unstable) => {
                    return Err(Fault::Wrong(format!("at {place} nothing grows: not unstable")));
                }
                (Motion::Turns(signs), Holds::Stable) => {
                    let pair = (place, signs);
                    before.iter().try_for_each(|before| self.between(before, &pair))?;
                    before = Some(pair);
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// That nothing grows where the order of signs changes between two places of a stable stretch.
    fn between(&self, low: &(f64, Vec<bool>), high: &(f64, Vec<bool>)) -> Checked {
        if low.1 == high.1 || high.0 - low.0 <= self.width / 4.0 * high.0 {
            return Ok(());
        }
        let middle = low.0 / 2.0 + high.0 / 2.0;
        match self.motion(middle)? {
            Motion::Grows(growth) => Err(grows(middle, growth)),
            Motion::Unclear => Ok(()),
            Motion::Turns(signs) => {
                let pair = (middle, signs);
                self.between(low, &pair).and_then(|()| self.between(&pair, high))
            }
        }
    }
}

fn is_proven_stable(model: &dyn Model) -> Result<bool> {
    let found = model.decide(Route::Cheapest, &Limits::default())?;
    Ok(found.is_proof() && found.is_stable())
}

fn grows(place: f64, growth: f64) -> Fault {
    Fault::Wrong(format!("at {place} a mode grows by exp({growth:.2e}) in a period: not stable"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(file: &str, method: Option<&str>) -> SystemScene {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes"));
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let mut source: serde_json::Value = serde_json::from_str(&text).unwrap();
        source["potentials"][0]["scale"] = "1".into();
        if let Some(method) = method {
            source["method"] = method.into();
        }
        SystemScene::from_json_in(folder, source).unwrap()
    }

    fn found<'a>(
        scene: &'a SystemScene,
        path: &'a str,
        range: &str,
        width: f64,
    ) -> (Places<'a>, Vec<Stretch>) {
        let all = scene.intervals(&format!("{path}={range}").parse().unwrap(), width, &Limits::default());
        (Places::of(scene, path, width).unwrap(), all.unwrap().stretches)
    }

    /// Stretches that hold; an unstable one moved by half of itself into a stable one, and one that is called
    /// stable with all up to the next stable ones.
    #[test]
    fn an_interval_that_was_moved_or_dropped_is_found_without_the_cells() {
        for (file, method, path, range) in [
            ("water4.json", None, OUTER, "1/250..29/5000"),
            ("water4-levels.json", None, OUTER, "1/250..29/5000"),
            ("water4.json", Some("molly-short"), OUTER, "1/250..29/5000"),
            ("water4.json", None, "potentials.0.scale", "4/5..13/10"),
            ("water4.json", Some("impulse"), "potentials.0.scale", "4/5..13/10"),
        ] {
            let scene = scene(file, method);
            let (places, all) = found(&scene, path, range, 1e-3);
            assert!(all.iter().all(|stretch| places.stretch(stretch).is_ok()), "{file}, {method:?}, {path}");
            let is_stable = |stretch: &Stretch| stretch.verdict == Holds::Stable;
            let (mut moved, mut dropped) = (0, 0);
            for (k, stretch) in
                all.iter().enumerate().filter(|(_, stretch)| stretch.verdict == Holds::Unstable)
            {
                let by = (stretch.hi - stretch.lo) / 2.0;
                let after = all[k..].iter().find(|next| is_stable(next));
                let lies_in =
                    after.is_some_and(|next| next.lo < stretch.hi + by / 4.0 && stretch.hi + by < next.hi);
                if lies_in {
                    let right = Stretch { lo: stretch.lo + by, hi: stretch.hi + by, ..*stretch };
                    assert!(matches!(places.stretch(&right), Err(Fault::Wrong(_))), "{file}: {right:?}");
                    moved += 1;
                }
                let before = all[..k].iter().rfind(|last| is_stable(last));
                if let (true, Some(before), Some(after)) = (places.has_signs(), before, after) {
                    let whole = Stretch { lo: before.lo, hi: after.hi, verdict: Holds::Stable };
                    assert!(matches!(places.stretch(&whole), Err(Fault::Wrong(_))), "{file}: {whole:?}");
                    dropped += 1;
                }
            }
            assert!(
                moved > 0 && (dropped > 1 || path != OUTER || !places.has_signs()),
                "{file}, {method:?}, {path}: {moved} moved, {dropped} dropped of {all:?}"
            );
        }
    }

    /// About a narrow interval of a molecule: at the five steps that are looked at nothing grows, and the
    /// order of signs finds it.
    #[test]
    fn a_narrow_interval_is_found_by_the_order_of_signs() {
        let scene = scene("alanine-dipeptide.json", None);
        let (steps, all) = found(&scene, OUTER, "99/20000..203/40000", 1e-4);
        let narrow = all.iter().position(|stretch| stretch.verdict == Holds::Unstable).unwrap();
        let (lo, hi) = (all[0].lo, all[narrow].hi + 1e-5);
        let whole = Stretch { lo, hi, verdict: Holds::Stable };
        let misses = |part: &f64| matches!(steps.motion(lo + (hi - lo) * part), Ok(Motion::Turns(_)));
        assert!(INSIDE.iter().all(misses), "{:?}", all[narrow]);
        assert!(matches!(steps.stretch(&whole), Err(Fault::Wrong(_))));
    }
}
