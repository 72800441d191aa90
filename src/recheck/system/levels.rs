//! Two sparse levels run kick by kick: the growing modes of a document.

use num_complex::Complex64;

use crate::recheck::context::{Checked, Outcome, holds};
use crate::system::levels::Outer;
use crate::system::levels::sparse::SparseLevels;
use crate::system::{Analysis, Holds};

/// The other route, in words.
pub const ROUTE: &str = "each growing mode run kick by kick over a period from rest";

/// Residuals of modes are at most 10^-6 of their length by V, whose eigenvalues are p at most and where modes grow some hundredths or more.
const OFF: f64 = 1e-4;

/// A period from rest in the middle of a slow kick takes the positions y of a mode to (1 + 2 μ) y.
pub fn modes(own: &SparseLevels, outer: &Outer, analysis: &Analysis) -> Checked {
    analysis.parts.iter().flat_map(|part| &part.instabilities).try_for_each(|mode| {
        let both = [&mode.shape, &mode.quadrature].map(|own_part| own.weighted(own_part));
        let after = both.each_ref().map(|y| period(own, outer, y));
        let complex = |[re, im]: &[Vec<f64>; 2], i: usize| Complex64::new(re[i], im[i]);
        let factor = 1.0 + 2.0 * mode.multiplier.mu;
        let length =
            |of: &dyn Fn(usize) -> Complex64| (0..own.size()).map(|i| of(i).norm_sqr()).sum::<f64>().sqrt();
        let off = length(&|i| complex(&after, i) - factor * complex(&both, i));
        let right = off <= OFF * length(&|i| complex(&both, i));
        holds(right, || {
            format!("a mode said to be multiplied by {factor} in a period is not: it is off by {off}")
        })
    })
}

/// Positions after an outer step from rest, mass-weighted: half a slow kick, then p steps of velocity Verlet.
fn period(own: &SparseLevels, outer: &Outer, y: &[f64]) -> Vec<f64> {
    let h = outer.step() / outer.inner_steps() as f64;
    let kick =
        |p: &mut [f64], pull: &[f64], by: f64| p.iter_mut().zip(pull).for_each(|(p, pull)| *p -= by * pull);
    let (mut x, mut p) = (y.to_vec(), vec![0.0; y.len()]);
    let [mut fast, slow] = own.pulls(&x);
    kick(&mut p, &slow, outer.step() / 2.0);
    for _ in 0..outer.inner_steps() {
        kick(&mut p, &fast, h / 2.0);
        x.iter_mut().zip(&p).for_each(|(x, p)| *x += h * p);
        [fast, _] = own.pulls(&x);
        kick(&mut p, &fast, h / 2.0);
    }
    x
}

/// Names the claims that no run can check.
pub fn unseen(analysis: &Analysis, mut outcome: Outcome) -> Outcome {
    if analysis.holds() != Holds::Unstable {
        outcome
            .not_rechecked
            .push("that nothing grows, and how far that stands: by factorizations alone".into());
    }
    outcome
}
