//! The dense full period of a system in doubles: its traces, its powers.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::input::SystemScene;
use crate::question::Displacement;
use crate::verify::context::{Checked, Fault, ROOM, holds};
use number::{Laurent, Rational, Result, from_f64_exact, to_f64};
use systems::avi::Run;
use systems::levels::{Hessians, Near};
use systems::{Analysis, Holds, Limits, Measured, full_period};

/// Multipliers are rounded eigenvalues: those of nearly defective propagators are right to half their digits
/// only, but not the sums of them.
const ROUNDED: f64 = 1e-9;

/// Tr Q = Σ (λ + 1/λ) and Tr Q² = Σ (λ² + 1/λ²), a rigid mode counting as λ = 1.
pub fn traces(scene: &SystemScene, analysis: &Analysis) -> Checked {
    if !analysis.has_all_multipliers() {
        // There is no sum to compare.
        return Ok(());
    }
    // The period of Jacobians is one without rigid motions.
    let rigid = if scene.model().jacobians().is_some() { 0 } else { analysis.rigid_modes.len() };
    let mut turns = vec![Complex64::new(2.0, 0.0); rigid];
    for part in &analysis.parts {
        let times = Laurent::ratio(&analysis.period, &part.period).filter(Rational::is_integer);
        let times = times.and_then(|times| i32::try_from(times.to_integer()).ok());
        let times =
            times.ok_or_else(|| Fault::Wrong("the period of a part does not divide the whole".into()))?;
        turns.extend(part.multipliers.iter().map(|multiplier| {
            let power = multiplier.lambda.powi(times);
            power + power.inv()
        }));
    }
    let q = scene.model().full_period()?;
    let (norm, n) = (q.norm(), q.nrows() as f64 / 2.0);
    let sums = [
        (q.trace(), turns.iter().sum::<Complex64>(), norm),
        ((&q * &q).trace(), turns.iter().map(|turn| turn * turn - 2.0).sum(), norm * norm),
    ];
    let largest: f64 = turns.iter().map(|turn| turn.norm_sqr().max(1.0)).sum();
    sums.into_iter().try_for_each(|(trace, sum, size)| {
        // Roundings of the product, and those of the multipliers.
        let off = 1e-12 * n * size + ROUNDED * largest;
        let right = !size.is_finite() || (sum - trace).norm() <= off;
        holds(right, || format!("the multipliers add up to {sum}, the trace of the full period to {trace}"))
    })
}

/// ln |λ| of a period below which roundings may have made it: a double eigenvalue moves by the square root of
/// 10^-16 times its condition.
const STILL: f64 = 1e-5;

/// The largest growth rate of measured stiffnesses holds the one of the dense full period, kick by kick and
/// without any basis of modes.
pub fn growth(scene: &SystemScene, analysis: &Analysis, limits: &Limits) -> Checked {
    let Some((found, (lo, hi))) = scene.model().growth_of_period(limits)?.zip(analysis.growth_rate()) else {
        return Ok(());
    };
    let off = STILL / analysis.period.to_f64() + ROUNDED * found;
    // Beyond the range of doubles the dense period decides nothing.
    let right = !found.is_finite() || (lo - off <= found && found <= hi + off);
    holds(right, || format!("the growth rate is {lo} to {hi}, the dense full period has {found}"))
}

/// The claims on levels of any number that no other route sees.
pub const SAME_ROUTE: &str = "that the verdict holds for all stiffnesses within their accuracy, the margin: computed again by the same route alone";

/// Both sides of the first unstable step of levels of any number, by half periods of a rational system of the
/// doubles given.
pub fn first_unstable(scene: &SystemScene, measured: &Measured, limits: &Limits) -> Checked {
    let Some((lo, hi)) = measured.first_unstable else { return Ok(()) };
    [(lo * (1.0 - ROOM), Holds::Stable), (hi * (1.0 + ROOM), Holds::Unstable)].into_iter().try_for_each(
        |(step, said)| {
            let Some(outer) = from_f64_exact(step) else { return Ok(()) };
            let found = scene.model().decide_at(&outer, limits)?.holds();
            holds(found == said, || format!("at a step of {step} it is {} by half periods", found.name()))
        },
    )
}

/// How far a verdict on measured stiffnesses stands, by the action of paths, which shares no step with the
/// forms and counts that found it: it is definite for all stiffnesses near those given where all are stable
/// at this step and at every smaller one.
pub struct Stands<'a> {
    measured: &'a Measured,
    /// Two levels of kicks and drifts, small enough: the matrices, their norms, the outer step and its inner
    /// ones.
    levels: Option<(Hessians, [f64; 2], f64, u64)>,
}

impl<'a> Stands<'a> {
    pub fn of(scene: &SystemScene, measured: &'a Measured) -> Result<Stands<'a>> {
        let model = scene.model();
        let source = model.measured().and_then(|levels| Ok(levels.levels()?.source)).ok();
        let levels = source.as_ref().and_then(|source| source.kernel()).map(|kernel| -> Result<_> {
            let (hessians, p) = (model.measured()?.hessians_of_two()?, model.inner_steps().unwrap_or(1));
            Ok((hessians, kernel.norms(), to_f64(&model.outer_step()), p))
        });
        let levels = levels.transpose()?.filter(|(hessians, _, _, p)| hessians.has_paths(*p));
        Ok(Stands { measured, levels })
    }

    /// That the first unstable step is.
    pub fn check(&self, limits: &Limits) -> Checked {
        let Some((hessians, _, _, p)) = &self.levels else { return Ok(()) };
        limits.allow(hessians.cost_of_paths(*p), || "the action of paths".into())?;
        let Some((lo, hi)) = self.measured.first_unstable else { return Ok(()) };
        let is_stable = hessians.paths_prove_stable(lo * (1.0 - ROOM), *p, Near::EXACTLY);
        holds(is_stable, || format!("steps up to {lo} are not proven stable"))?;
        let is_unstable = hessians.paths_prove_unstable(hi * (1.0 + ROOM), *p);
        holds(is_unstable, || format!("the step {hi} is not proven unstable"))
    }

    pub fn name(&self) -> &'static str {
        match self.levels {
            Some(_) => {
                "the growth rate by the eigenvalues of the dense full period, the first unstable step by the action of paths"
            }
            None => "the growth rate by the eigenvalues of the dense full period",
        }
    }

    /// What paths do not prove, and no other route sees.
    pub fn unseen(&self) -> Option<String> {
        let Measured { accuracy, holds, margin, .. } = self.measured;
        let within = |part: f64| {
            self.levels.as_ref().is_some_and(|(hessians, norms, step, p)| {
                let near = Near { factors: [1.0; 2], off: norms.map(|norm| part * norm) };
                *holds == Holds::Stable && hessians.paths_prove_stable(*step, *p, near)
            })
        };
        let first = self.levels.is_none().then_some("the first unstable step");
        let all = (!within(*accuracy))
            .then_some("that the verdict holds for all stiffnesses within their accuracy");
        let far = margin.is_some_and(|margin| !within(margin)).then_some("the margin");
        let named: Vec<&str> = [all, far, first].into_iter().flatten().collect();
        (!named.is_empty()).then(|| format!("{}: computed again by the same route alone", named.join(", ")))
    }
}

/// The series of a linear run by powers of the full period: z after k periods is Qᵏ z₀.
pub fn linear_run(scene: &SystemScene, displace: &Displacement, run: &Run) -> Checked {
    let (system, centre) = (scene.model().system(), scene.equilibrium());
    let n = system.size();
    let q: DMatrix<f64> = full_period(system);
    let shift = displace.of(n)?;
    let mut state = DVector::from_fn(2 * n, |i, _| shift.get(i).copied().unwrap_or(0.0));
    // The amplitude of what moves about an equilibrium far from 0 has its roundoff.
    let far = centre.map_or(0.0, |x| x.iter().fold(0.0, |a: f64, x| a.max(x.abs())));
    let mut largest: f64 = 0.0;
    for (k, sample) in run.series.iter().enumerate() {
        let amplitude = state.rows(0, n).amax();
        largest = largest.max(state.amax());
        // A kick and a drift round by some units, whose errors move like the state itself.
        let off = 1e-12 * (1 + k) as f64 * q.norm() * (largest + far);
        let right = !off.is_finite() || (sample.amplitude - amplitude).abs() <= off;
        holds(right, || format!("the amplitude after {k} periods is {amplitude}, not {}", sample.amplitude))?;
        state = &q * state;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use systems::Route;

    #[test]
    fn the_dense_period_finds_a_growth_rate_that_is_wrong_from_the_start() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes"));
        let text = std::fs::read_to_string(folder.join("alanine-dipeptide.json")).unwrap();
        for (step, unstable) in [("1/200", false), ("1/100", true)] {
            let text = text.replace("\"1/200\"", &format!("\"{step}\""));
            let scene = SystemScene::from_json_in(folder, serde_json::from_str(&text).unwrap()).unwrap();
            let mut analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
            assert_eq!((analysis.is_proof(), analysis.is_unstable()), (true, unstable));
            assert!(growth(&scene, &analysis, &Limits::default()).is_ok());
            // A hundredth more, or any where there is none.
            analysis.parts[0].kind = Some(clocks::verdict::Kind::Hyperbolic);
            for multiplier in &mut analysis.parts[0].multipliers {
                multiplier.growth =
                    multiplier.growth.map(|(lo, hi)| (1.01 * lo.max(0.01), 1.01 * hi.max(0.01)));
            }
            assert!(matches!(growth(&scene, &analysis, &Limits::default()), Err(Fault::Wrong(_))), "{step}");
        }
    }

    #[test]
    fn half_periods_find_a_first_unstable_step_of_three_clocks_that_is_wrong_from_the_start() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes"));
        let text = std::fs::read_to_string(folder.join("water4-levels.json")).unwrap();
        let scene = SystemScene::from_json_in(folder, serde_json::from_str(&text).unwrap()).unwrap();
        let limits = Limits::default();
        let found = scene.model().decide(Route::Cheapest, &limits).unwrap().measured.unwrap();
        assert!(first_unstable(&scene, &found, &limits).is_ok(), "{found:?}");
        let (lo, hi) = found.first_unstable.unwrap();
        // The unstable interval above it is two thousandths wide.
        for wrong in [(lo * 1.001, hi * 1.001), (lo, hi * 0.999)] {
            let moved = Measured { first_unstable: Some(wrong), ..found.clone() };
            assert!(matches!(first_unstable(&scene, &moved, &limits), Err(Fault::Wrong(_))), "{wrong:?}");
        }
    }

    #[test]
    fn paths_find_a_first_unstable_step_that_is_wrong_from_the_start_and_what_they_do_not_prove_is_named() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes"));
        let text = std::fs::read_to_string(folder.join("water4.json")).unwrap();
        let scene = SystemScene::from_json_in(folder, serde_json::from_str(&text).unwrap()).unwrap();
        let limits = Limits::default();
        let found = scene.model().decide(Route::Cheapest, &limits).unwrap().measured.unwrap();
        let is_right = |measured: &Measured| Stands::of(&scene, measured).unwrap().check(&limits).is_ok();
        assert!(is_right(&found), "{found:?}");
        let (lo, hi) = found.first_unstable.unwrap();
        assert!(!is_right(&Measured { first_unstable: Some((lo * (1.0 + 1e-4), hi)), ..found.clone() }));
        assert!(!is_right(&Measured { first_unstable: Some((lo, hi * (1.0 - 1e-4))), ..found.clone() }));
        let unseen = |measured: &Measured| Stands::of(&scene, measured).unwrap().unseen().unwrap_or_default();
        // The action must prove the accuracy and the margin, and must not prove twice the margin.
        assert_eq!(unseen(&Measured { margin: Some(found.accuracy), ..found.clone() }), "");
        let twice = 2.0 * found.margin.unwrap();
        assert!(unseen(&Measured { margin: Some(twice), ..found.clone() }).starts_with("the margin: "));
        assert!(unseen(&Measured { accuracy: twice, ..found }).starts_with("that the verdict holds for all"));
    }
}
