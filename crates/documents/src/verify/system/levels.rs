//! Two sparse levels run kick by kick.

use crate::verify::context::{Checked, holds};
use systems::levels::Outer;
use systems::levels::sparse::SparseLevels;
use systems::{Analysis, Holds};

/// The other route, in words.
pub const ROUTE: &str = "outer steps kick by kick, each from rest where the last one ended";

/// Outer steps that are run, and how many times longer positions become over their second half where
/// something grows. In the first region a step from rest is self-adjoint in a scalar product, so that nothing
/// becomes longer there but by what that product differs from the usual one.
const STEPS: usize = 400;
const GROWN: f64 = 1e3;

/// Holds a verdict against the run; beside it the claims that no run can check.
pub fn run(sparse_levels: &SparseLevels, outer: &Outer, analysis: &Analysis) -> (Checked, Vec<String>) {
    let told = analysis.holds();
    if told == Holds::Undecided {
        return (Ok(()), vec!["where the first region ends: by factorizations alone".into()]);
    }
    let has_grown = growth(sparse_levels, outer) > GROWN.ln();
    let checked = holds(told == Holds::Unstable || !has_grown, || {
        format!("it is said to be stable, and positions grow {GROWN} times within {STEPS} outer steps")
    });
    let unseen = match told {
        Holds::Unstable if has_grown => "where the first region ends: by factorizations alone".into(),
        Holds::Unstable => format!("that it grows: too slowly to be seen in {STEPS} outer steps"),
        _ => "that nothing grows, and how far that stands: by factorizations alone".into(),
    };
    (checked, vec![unseen])
}

/// The logarithm of how many times longer positions become over the second half of the run.
fn growth(sparse_levels: &SparseLevels, outer: &Outer) -> f64 {
    // Numbers without a pattern, some part of every mode.
    let mut y: Vec<f64> =
        (1..=sparse_levels.size()).map(|i| (i as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
    let mut grown = 0.0;
    for step in 0..STEPS {
        y = period(sparse_levels, outer, &y);
        let length = y.iter().map(|x| x * x).sum::<f64>().sqrt();
        if step >= STEPS / 2 {
            grown += length.ln();
        }
        y.iter_mut().for_each(|x| *x /= length);
    }
    grown
}

/// Positions after an outer step from rest, mass-weighted: half a slow kick, then p steps of velocity Verlet.
fn period(sparse_levels: &SparseLevels, outer: &Outer, y: &[f64]) -> Vec<f64> {
    let h = outer.step() / outer.inner_steps() as f64;
    let kick =
        |p: &mut [f64], pull: &[f64], by: f64| p.iter_mut().zip(pull).for_each(|(p, pull)| *p -= by * pull);
    let (mut x, mut p) = (y.to_vec(), vec![0.0; y.len()]);
    let [mut fast, slow] = sparse_levels.apply_stiffnesses(&x);
    kick(&mut p, &slow, outer.step() / 2.0);
    for _ in 0..outer.inner_steps() {
        kick(&mut p, &fast, h / 2.0);
        x.iter_mut().zip(&p).for_each(|(x, p)| *x += h * p);
        [fast, _] = sparse_levels.apply_stiffnesses(&x);
        kick(&mut p, &fast, h / 2.0);
    }
    x
}
