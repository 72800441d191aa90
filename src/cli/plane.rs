//! The verdicts of a grid, computed once for all products that show them.

use crate::error::Result;
use crate::map::{Band, Grid, Products, Shard, for_each_band};
use crate::report::map::{Counts, Marked};
use crate::report::plane::Cloud;
use crate::verdict::{Kind, Limits};

/// Every pair of a grid decided: the counts, and the pairs that are not plainly stable.
#[derive(Clone, Debug, Default)]
pub struct Verdicts {
    pub counts: Counts,
    /// In the order of h1, then h2.
    pub marked: Vec<Marked>,
}

impl Verdicts {
    /// Decides all pairs, band by band; `threads` 0 means one a core.
    pub fn compute(grid: &Grid, threads: usize, limits: &Limits) -> Result<Verdicts> {
        let mut verdicts = Verdicts::default();
        for_each_band(grid, Products::default(), Shard::WHOLE, threads, limits, |_, band| {
            verdicts.add(grid, &band);
            Ok(())
        })?;
        Ok(verdicts)
    }

    fn add(&mut self, grid: &Grid, band: &Band) {
        for n in 0..band.verdicts.len() {
            let decision = band.decision(n);
            self.counts.add(&decision);
            if decision.verdict.kind() != Kind::Elliptic {
                let (i, j) = band.multipliers(grid, n);
                let (p, q) = grid.terms(i, j);
                self.marked.push(Marked { i, j, p, q, decision });
            }
        }
    }

    /// The unstable pairs for a figure.
    pub fn cloud(&self, grid: &Grid) -> Cloud {
        let (step1, step2) = grid.steps();
        let unstable = self.marked.iter().filter(|pair| !pair.decision.verdict.is_stable());
        let pairs = unstable.map(|pair| (pair.i as u32, pair.j as u32)).collect();
        Cloud { spacing: [step1.to_f64(), step2.to_f64()], pairs }
    }
}
