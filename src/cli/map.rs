//! `kickdrift map`: the verdicts of a grid.

use super::args::{Common, Format, Grid, Stiffness, echo_grid};
use super::plane::Verdicts;
use crate::error::Result;
use crate::number::Laurent;
use crate::report::document::Document;
use crate::report::map;
use crate::scene::GridRange;

/// Flags of `map`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    stiffness: Stiffness,
    #[command(flatten)]
    grid: Grid,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let ((lambda1, lambda2), grid) = (self.stiffness.quantities()?, self.grid.range()?);
        let verdicts = Verdicts::compute(&lambda1, &lambda2, &grid, &common.limits())?;
        common.write(&document(&lambda1, &lambda2, &grid, &verdicts), Format::Json)
    }
}

/// The verdicts as a document.
pub fn document(lambda1: &Laurent, lambda2: &Laurent, grid: &GridRange, verdicts: &Verdicts) -> Document {
    let steps = |pair: &map::Marked| [grid.h1(pair.i).to_string(), grid.h2(pair.j).to_string()];
    let document = map::document(&verdicts.counts, &verdicts.marked, steps);
    echo_grid(document.input("lambda1", lambda1).input("lambda2", lambda2), grid)
}
