//! `kickdrift map`: the verdicts of a grid.

use super::args::{self, Common, Format, Stiffness, echo_grid};
use super::plane::Verdicts;
use crate::error::Result;
use crate::map::Grid;
use crate::report::document::Document;
use crate::report::map as report;
use crate::scene::GridRange;

/// Flags of `map`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    stiffness: Stiffness,
    #[command(flatten)]
    grid: args::Grid,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let ((lambda1, lambda2), range) = (self.stiffness.quantities()?, self.grid.range()?);
        let grid = range.of(lambda1, lambda2)?;
        let verdicts = Verdicts::compute(&grid, common.threads(), &common.limits())?;
        common.write(&document(&grid, &range, &verdicts), Format::Json)
    }
}

/// The verdicts as a document.
pub fn document(grid: &Grid, range: &GridRange, verdicts: &Verdicts) -> Document {
    let (lambda1, lambda2) = grid.lambdas();
    let steps = |pair: &report::Marked| [grid.h1(pair.i).to_string(), grid.h2(pair.j).to_string()];
    let document = report::document(&verdicts.counts, &verdicts.marked, steps);
    echo_grid(document.input("lambda1", lambda1).input("lambda2", lambda2), range)
}
