//! A scheme of local time steps run as codes run it, substep by substep, against the stiffness that stands for it.

use num_traits::Zero;

use crate::number::Rational;
use crate::recheck::context::{Checked, holds};
use crate::system::LocalSteps;

/// Degrees of freedom of which one is displaced, at most.
const MOST: usize = 16;

/// x₊ + x₋ − 2 x = −dt² M⁻¹ K' x, for displacements of one degree of freedom each, exactly.
pub fn steps(own: &LocalSteps) -> Checked {
    let (n, mass, square) = (own.plain().size(), own.plain().mass(), own.step() * own.step());
    let effective = &own.system().clocks()[0].stiffness;
    (0..n).step_by(n.div_ceil(MOST)).try_for_each(|k| {
        let mut x = vec![Rational::zero(); n];
        x[k] = Rational::from_integer(1.into());
        let half = half_turn(own, 0, own.step().clone(), &x, &vec![Rational::zero(); n]);
        let right = effective.times(&x).into_iter().enumerate().all(|(i, force)| {
            let two = Rational::from_integer(2.into());
            two * (&half[i] - &x[i]) == -&square * force / mass.get(i, i)
        });
        holds(right, || {
            format!("a step of the scheme from a displacement of {k} is not that of its stiffness")
        })
    })
}

/// (x(d) + x(−d))/2 from x(0) = `x` at level l with the step d, forces of coarser levels standing still at −`still` an inertia.
fn half_turn(own: &LocalSteps, l: usize, d: Rational, x: &[Rational], still: &[Rational]) -> Vec<Rational> {
    let (mass, stiffness) = (own.plain().mass(), &own.plain().clocks()[0].stiffness);
    let is_at = |level: usize, i: &usize| level == 0 || own.levels()[level - 1].fine.contains(i);
    let forced = |moves: &dyn Fn(&usize) -> bool| -> Vec<Rational> {
        let part = |(i, x): (usize, &Rational)| if moves(&i) { x.clone() } else { Rational::zero() };
        let force = stiffness.times(&x.iter().enumerate().map(part).collect::<Vec<_>>());
        let both = force.into_iter().zip(still).enumerate();
        both.map(|(i, (force, still))| force / mass.get(i, i) + still).collect()
    };
    let Some(level) = own.levels().get(l) else {
        let kicked = forced(&|i| is_at(l, i));
        let half = &d * &d / Rational::from_integer(2.into());
        return x.iter().zip(kicked).map(|(x, a)| x - &half * a).collect();
    };
    let still = forced(&|i| is_at(l, i) && !is_at(l + 1, i));
    let d = d / Rational::from_integer(level.substeps.into());
    let mut before = x.to_vec();
    let mut now = half_turn(own, l + 1, d.clone(), x, &still);
    for _ in 1..level.substeps {
        let turned = half_turn(own, l + 1, d.clone(), &now, &still);
        let next = turned.into_iter().zip(&before).map(|(x, before)| &x + &x - before).collect();
        (before, now) = (now, next);
    }
    now
}
