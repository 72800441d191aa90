//! `kickdrift merge`: the parts of a sharded map joined to the bytes of a single run.

use std::path::PathBuf;

use super::args::{Columns, Common};
use super::map::{Drawing, Output, Part, Source};
use documents::format::Format;
use documents::question::Map;
use number::{Error, Result};

/// Flags of `merge`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The directories that map --shard K/N --resume DIR has filled; one of them may hold several parts.
    #[arg(value_name = "PARTS", required = true)]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    drawing: Drawing,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::MAP)?;
        let parts = self.parts.iter().map(|directory| Part::open(directory)).collect::<Result<Vec<_>>>()?;
        let map = Part::common_map(&parts)?;
        self.check(format, &map)?;
        let source = Source::Joined(parts.into_iter().map(Part::into_store).collect());
        let Args { columns, drawing, .. } = self;
        Output { map: &map, grid: &map.grid()?, format, columns, drawing, common }.write(&source)
    }

    /// The parts hold what the colours and the columns show.
    fn check(&self, format: Format, map: &Map) -> Result<()> {
        let asked =
            [("--colour", self.drawing.products(format)?), ("--columns", self.columns.products(format)?)];
        for (asking, needs) in asked {
            let missing = [("--label", needs.label && !map.label), ("--growth", needs.growth && !map.growth)];
            if let Some((flag, _)) = missing.iter().find(|(_, missing)| *missing) {
                let remedy = format!("the parts were computed without {flag}: compute them with it");
                return Err(Error::input(asking, "given", remedy));
            }
        }
        Ok(())
    }
}
