//! Maps of a system: its verdict over two parameters.

use rayon::prelude::*;

use super::analysis::{Evidence, decide_system};
use super::exact::Limits;
use super::model::System;
use crate::error::Result;
use crate::number::Rational;
use crate::verdict::Kind;

/// One point of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The two parameters.
    pub at: (Rational, Rational),
    pub kind: Kind,
    /// Whether every part is proven.
    pub is_proof: bool,
    /// The largest growth rate, per unit time; 0 if stable.
    pub growth_rate: f64,
}

/// The verdicts of `build(x, y)` for all pairs of parameters, row by row of y; in parallel, in order.
///
/// # Errors
/// The first error of `build` or of a verdict.
pub fn scan(
    xs: &[Rational],
    ys: &[Rational],
    limits: &Limits,
    build: impl Fn(&Rational, &Rational) -> Result<System> + Sync,
) -> Result<Vec<Point>> {
    let pairs: Vec<_> = ys.iter().flat_map(|y| xs.iter().map(move |x| (x, y))).collect();
    let point = |&(x, y): &(&Rational, &Rational)| {
        let analysis = decide_system(&build(x, y)?, limits)?;
        Ok(Point {
            at: (x.clone(), y.clone()),
            kind: analysis.kind,
            is_proof: analysis.parts.iter().all(|part| part.evidence != Evidence::Estimate),
            growth_rate: analysis.growth_rate(),
        })
    };
    pairs.par_iter().map(point).collect()
}

impl System {
    /// The same system with clock `clock`'s step replaced: for maps over steps.
    ///
    /// # Errors
    /// As [`System::new`].
    ///
    /// # Panics
    /// Where there is no such clock.
    pub fn with_step(&self, clock: usize, step: &Rational) -> Result<System> {
        let mut clocks = self.clocks().to_vec();
        clocks[clock].step = step.clone();
        System::new(self.mass().clone(), clocks)
    }

    /// The same system with clock `clock`'s stiffness times a factor: for maps over a stiffness.
    ///
    /// # Errors
    /// As [`System::new`].
    ///
    /// # Panics
    /// Where there is no such clock.
    pub fn with_stiffness(&self, clock: usize, factor: &Rational) -> Result<System> {
        let mut clocks = self.clocks().to_vec();
        clocks[clock].stiffness = clocks[clock].stiffness.scaled(factor);
        System::new(self.mass().clone(), clocks)
    }
}
