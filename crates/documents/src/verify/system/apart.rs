//! Motions set apart, held against every potential as the file has it, in exact arithmetic.

use num_traits::Zero;

use crate::input::SystemScene;
use crate::verify::context::{Checked, holds};
use number::Rational;
use systems::{Analysis, System};

/// Ranks are taken of no more degrees of freedom: n⁴ products of rationals.
const MOST: usize = 24;

/// No potential holds a rigid mode, and there are as many of these as potentials leave free: of effective
/// stiffnesses those that they come from.
pub fn exactly(scene: &SystemScene, analysis: &Analysis) -> Checked {
    let Some(plain) = scene.model().plain() else { return Ok(()) };
    let modes = &analysis.rigid_modes;
    for (k, potential) in plain.potentials().iter().enumerate() {
        let is_free = |mode: &Vec<Rational>| potential.stiffness.times(mode).iter().all(Zero::is_zero);
        holds(modes.iter().all(is_free), || format!("potentials[{k}] holds a motion that was set apart"))?;
    }
    if plain.size() > MOST {
        return Ok(());
    }
    let free = plain.size() - rank(plain);
    holds(modes.len() == free, || {
        format!("{} motions were set apart, {free} are held by nothing", modes.len())
    })
}

/// That of all rows of all potentials together.
fn rank(plain: &System) -> usize {
    let n = plain.size();
    let row =
        |symmetric: &systems::Symmetric, i: usize| (0..n).map(|j| symmetric.get(i, j)).collect::<Vec<_>>();
    let mut basis: Vec<(usize, Vec<Rational>)> = Vec::new();
    for potential in plain.potentials() {
        for i in 0..n {
            let mut left = row(&potential.stiffness, i);
            for (at, values) in &basis {
                let factor = left[*at].clone();
                left.iter_mut().zip(values).for_each(|(x, y)| *x -= &factor * y);
            }
            if let Some(at) = left.iter().position(|x| !x.is_zero()) {
                let pivot = left[at].recip();
                left.iter_mut().for_each(|x| *x *= &pivot);
                basis.push((at, left));
            }
        }
    }
    basis.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use systems::{Limits, Route};

    #[test]
    fn a_motion_that_is_held_and_one_that_is_not_counted_are_found() {
        let text = r#"{"schema": "kickdrift/system/1", "scheme": "lts", "masses": [1, 1, 1], "levels": [{"fine": [1], "substeps": 2}],
            "potentials": [{"step": "1/2", "stiffness": [[1, -1, 0], [-1, 1, 0], [0, 0, 16]]}]}"#;
        let scene = SystemScene::read(text).unwrap();
        let found = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        assert!(found.rigid_modes.len() == 1 && exactly(&scene, &found).is_ok());
        let one = Rational::from_integer(1.into());
        let with = |modes: Vec<Vec<Rational>>| Analysis { rigid_modes: modes, ..found.clone() };
        let held = vec![Rational::zero(), Rational::zero(), one];
        assert!(exactly(&scene, &with(Vec::new())).is_err() && exactly(&scene, &with(vec![held])).is_err());
    }
}
