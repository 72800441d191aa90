//! `kickdrift map`: the verdicts of a grid, and what else is asked for of its unstable pairs.

mod drawing;
mod output;
mod part;
mod source;

use std::path::PathBuf;

use super::args::{self, Columns, Common, Stiffness};
use clocks::map::{Products, Shard};
use documents::format::Format;
use documents::question::{Map, flag};
pub use drawing::Drawing;
use number::error::{Error, Result};
pub use output::Output;
pub use part::Part;
pub use source::Source;

/// Flags of `map`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    stiffness: Stiffness,
    #[command(flatten)]
    grid: args::Grid,
    /// Give the tongue's label m of each growing pair, and its dominant family (a, b).
    #[arg(long)]
    label: bool,
    /// Give the growth rate of each growing pair, and the slow steps until its amplitude is tenfold.
    #[arg(long)]
    growth: bool,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    drawing: Drawing,
    /// Keep finished bands in this directory and take from it those it already holds.
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,
    /// Compute the K-th of N parts only, into the directory of --resume; `kickdrift merge` joins the parts.
    #[arg(long, value_name = "K/N", allow_hyphen_values = true, value_parser = flag::<Shard>)]
    shard: Option<Shard>,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::MAP)?;
        let shard = self.shard(format)?;
        let coloured = self.drawing.products(format)?;
        let shown = self.columns.products(format)?;
        let any = |of: fn(&Products) -> bool| of(&coloured) || of(&shown);
        let products = Products {
            label: self.label || any(|products| products.label),
            growth: self.growth || any(|products| products.growth),
        };
        let Stiffness { lambda1, lambda2 } = &self.stiffness;
        let (label, growth) = (products.label, products.growth);
        let map = Map { label, growth, ..self.grid.map(lambda1, lambda2)? };
        let grid = map.grid()?;
        let store = self.resume.as_ref().map(|directory| Part::create(directory, &map)).transpose()?;
        let source = Source::compute(common, shard, store.map(Part::into_store));
        let Args { columns, drawing, shard, .. } = self;
        let map = Map { shard: *shard, ..map };
        Output { map: &map, grid: &grid, format, columns, drawing, common }.write(&source)
    }

    /// The part of the map to compute.
    fn shard(&self, format: Format) -> Result<Shard> {
        let Some(shard) = self.shard else { return Ok(Shard::WHOLE) };
        if self.resume.is_none() {
            let remedy = "needs --resume DIR, where the part is kept for kickdrift merge";
            return Err(Error::input("--shard", shard, remedy));
        }
        if !matches!(format, Format::Json | Format::Text) {
            let remedy =
                "a part has only a summary (json, text): kickdrift merge makes the rest of all parts";
            return Err(Error::input("--shard", shard, remedy));
        }
        Ok(shard)
    }
}
