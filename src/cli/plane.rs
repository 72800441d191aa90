//! The verdicts of a grid, computed once for all products that show them.

use rayon::prelude::*;

use crate::error::Result;
use crate::number::Laurent;
use crate::propagator::Oscillator;
use crate::report::map::{Counts, Marked};
use crate::report::plane::Cloud;
use crate::scene::GridRange;
use crate::verdict::{Decision, Kind, Limits, decide};

/// Every pair of a grid decided: the counts, and the pairs that are not plainly stable.
#[derive(Clone, Debug, Default)]
pub struct Verdicts {
    pub counts: Counts,
    /// In the order of h1, then h2.
    pub marked: Vec<Marked>,
}

impl Verdicts {
    /// Decides all pairs, column by column on all threads.
    pub fn compute(
        lambda1: &Laurent,
        lambda2: &Laurent,
        grid: &GridRange,
        limits: &Limits,
    ) -> Result<Verdicts> {
        let columns: Result<Vec<Verdicts>> = (grid.columns().0..=grid.columns().1)
            .into_par_iter()
            .map(|i| column(lambda1, lambda2, grid, limits, i))
            .collect();
        Ok(columns?.into_iter().fold(Verdicts::default(), Verdicts::followed_by))
    }

    fn followed_by(mut self, mut next: Verdicts) -> Self {
        self.counts = self.counts.plus(&next.counts);
        self.marked.append(&mut next.marked);
        self
    }

    /// The unstable pairs for a figure.
    pub fn cloud(&self, grid: &GridRange) -> Cloud {
        let (step1, step2) = grid.steps();
        let unstable = self.marked.iter().filter(|pair| !pair.decision.verdict.is_stable());
        Cloud {
            spacing: [step1.to_f64(), step2.to_f64()],
            pairs: unstable.map(|p| (p.i as u32, p.j as u32)).collect(),
        }
    }
}

fn column(
    lambda1: &Laurent,
    lambda2: &Laurent,
    grid: &GridRange,
    limits: &Limits,
    i: u64,
) -> Result<Verdicts> {
    let mut verdicts = Verdicts::default();
    let h1 = grid.h1(i);
    for j in grid.rows().0..=grid.rows().1 {
        let oscillator = Oscillator::new(lambda1.clone(), lambda2.clone(), h1.clone(), grid.h2(j))?;
        let clocks = oscillator.clocks();
        let decision = decide_pair(&oscillator, limits)?;
        verdicts.counts.add(&decision);
        if decision.verdict.kind() != Kind::Elliptic {
            verdicts.marked.push(Marked { i, j, p: clocks.p(), q: clocks.q(), decision });
        }
    }
    Ok(verdicts)
}

/// Over the rationals where both strengths are rational, which makes every tier cheaper.
pub fn decide_pair(oscillator: &Oscillator, limits: &Limits) -> Result<Decision> {
    let clocks = oscillator.clocks();
    match clocks.as_rational() {
        Some(rational) => decide(&rational, limits),
        None => decide(&clocks, limits),
    }
}
