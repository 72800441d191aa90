//! The verdicts of a grid, computed once for all products of a scene that show them.

use crate::error::Result;
use crate::map::{Band, Grid, Map, Resources};
use crate::report::map::{MapArrays, Marked, Tally, marked};
use crate::report::plane::Cloud;
use crate::verdict::Limits;

/// Every pair of a grid decided: the counts, and the pairs that are not plainly stable.
#[derive(Clone, Debug, Default)]
pub struct Verdicts {
    pub tally: Tally,
    /// In the order of h1, then h2.
    pub marked: Vec<Marked>,
}

impl Verdicts {
    /// Decides all pairs, band by band; `threads` 0 means one a core. The arrays take what they want on the way.
    pub fn compute(
        grid: &Grid,
        threads: usize,
        limits: &Limits,
        mut arrays: Option<&mut MapArrays>,
    ) -> Result<Verdicts> {
        let mut verdicts = Verdicts::default();
        let resources = Resources { threads, limits: *limits, stopped: None };
        Map::of(grid).within(resources).for_each_band(|_, band| {
            verdicts.add(grid, &band);
            arrays.as_mut().map_or(Ok(()), |arrays| arrays.add(grid, &band))
        })?;
        Ok(verdicts)
    }

    fn add(&mut self, grid: &Grid, band: &Band) {
        self.tally.add(grid, band);
        self.marked.extend(marked(grid, band));
    }

    /// The unstable pairs for a figure.
    pub fn cloud(&self, grid: &Grid) -> Cloud {
        let (step1, step2) = grid.steps();
        let unstable = self.marked.iter().filter(|pair| !pair.decision.verdict.is_stable());
        let pairs = unstable.map(|pair| (pair.i as u32, pair.j as u32)).collect();
        Cloud { spacing: [step1.to_f64(), step2.to_f64()], pairs }
    }
}
