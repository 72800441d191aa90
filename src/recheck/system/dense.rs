//! The dense full period of a system in doubles: its traces, its powers.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::local;
use crate::avi::Run;
use crate::number::{Laurent, Rational};
use crate::question::Displacement;
use crate::recheck::context::{Checked, Fault, holds};
use crate::scene::SystemScene;
use crate::system::{Analysis, Limits, Model, full_period};

/// Multipliers are rounded eigenvalues: those of nearly defective propagators are right to half their digits only, but not
/// the sums of them.
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
        turns.extend(part.multipliers.iter().map(|own| {
            let power = own.lambda.powi(times);
            power + power.inv()
        }));
    }
    let q: DMatrix<f64> = match scene.model() {
        Model::NoGradient(own) => own.full_period(),
        Model::Subcycled(_, own) => local::period(own),
        other => full_period(other.moving()?.as_ref()),
    };
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

/// ln |λ| of a period below which roundings may have made it: a double eigenvalue moves by the square root of 10^-16 times its condition.
const STILL: f64 = 1e-5;

/// The largest growth rate of measured stiffnesses holds the one of the dense full period, kick by kick and without any basis of modes.
pub fn growth(scene: &SystemScene, analysis: &Analysis, limits: &Limits) -> Checked {
    let Some((found, (lo, hi))) = scene.model().growth_of_period(limits)?.zip(analysis.growth_rate()) else {
        return Ok(());
    };
    let off = STILL / analysis.period.to_f64() + ROUNDED * found;
    // Beyond the range of doubles the dense period decides nothing.
    let right = !found.is_finite() || (lo - off <= found && found <= hi + off);
    holds(right, || format!("the growth rate is {lo} to {hi}, that of the dense full period {found}"))
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
    use crate::system::Route;

    #[test]
    fn the_dense_period_finds_a_growth_rate_that_is_wrong_from_the_start() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"));
        let text = std::fs::read_to_string(folder.join("alanine-dipeptide.json")).unwrap();
        for (step, unstable) in [("1/200", false), ("1/100", true)] {
            let text = text.replace("\"1/200\"", &format!("\"{step}\""));
            let scene = SystemScene::from_json_in(folder, serde_json::from_str(&text).unwrap()).unwrap();
            let mut analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
            assert_eq!((analysis.is_proof(), analysis.is_unstable()), (true, unstable));
            assert!(growth(&scene, &analysis, &Limits::default()).is_ok());
            // A hundredth more, or any where there is none.
            analysis.parts[0].kind = Some(crate::verdict::Kind::Hyperbolic);
            for own in &mut analysis.parts[0].multipliers {
                own.growth = own.growth.map(|(lo, hi)| (1.01 * lo.max(0.01), 1.01 * hi.max(0.01)));
            }
            assert!(matches!(growth(&scene, &analysis, &Limits::default()), Err(Fault::Wrong(_))), "{step}");
        }
    }
}
