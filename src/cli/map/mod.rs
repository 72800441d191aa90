//! `kickdrift map`: the verdicts of a grid, and what else is asked for of its unstable pairs.

mod drawing;
mod output;
mod part;

use std::path::PathBuf;

use super::args::{Columns, Common, Spacing};
use super::asked::Flags;
use clocks::map::{Products, Shard};
use documents::format::Format;
use documents::question::Map;
pub use drawing::Drawing;
use number::{Error, Result};
pub use output::{Output, Source};
pub use part::Part;

/// Flags of `map`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    asked: Flags<Map>,
    #[command(flatten)]
    spacing: Spacing,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    drawing: Drawing,
    /// Keep finished bands in this directory and take from it those it already holds.
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::MAP)?;
        let asked = self.asked.question()?;
        self.check(asked.shard, format)?;
        let coloured = self.drawing.products(format)?;
        let shown = self.columns.products(format)?;
        let any = |of: fn(&Products) -> bool| of(&coloured) || of(&shown);
        let products = Products {
            label: asked.label || any(|products| products.label),
            growth: asked.growth || any(|products| products.growth),
        };
        let map = Map { label: products.label, growth: products.growth, ..asked };
        let (grid, whole) = (map.grid()?, Map { shard: None, ..map.clone() });
        let store = self.resume.as_ref().map(|directory| Part::create(directory, &whole)).transpose()?;
        let source = Source::Computed(store.map(Part::into_store));
        let Args { columns, drawing, .. } = self;
        Output { map: &map, grid: &grid, format, columns, drawing, common }.write(&source)
    }

    /// That a part of the map can be kept, and has this form.
    fn check(&self, shard: Option<Shard>, format: Format) -> Result<()> {
        let Some(shard) = shard else { return Ok(()) };
        if self.resume.is_none() {
            let remedy = "needs --resume DIR, where the part is kept for kickdrift merge";
            return Err(Error::input("--shard", shard, remedy));
        }
        if !matches!(format, Format::Json | Format::Text) {
            let remedy =
                "a part has only a summary (json, text): kickdrift merge makes the rest of all parts";
            return Err(Error::input("--shard", shard, remedy));
        }
        Ok(())
    }
}
