//! How a map is drawn.

use crate::cli::args::unused;
use crate::cli::paper::Paper;
use clocks::map::{Grid, Products};
use clocks::resonance::{Curve, Families};
use documents::format::Format;
use documents::question::{FAMILIES, flag};
use documents::report::plane::{Colouring, window};
use number::Result;

/// Flags of figures.
#[derive(Debug, clap::Args)]
pub struct Drawing {
    /// What the colours of a figure stand for [default: verdict].
    #[arg(long, value_name = "WHAT")]
    colour: Option<Colouring>,
    /// Draw the curves (a, b) over a figure.
    #[arg(long)]
    curves: bool,
    /// The range of a for --curves [default: 0..3].
    #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(i64, i64)>)]
    a: Option<(i64, i64)>,
    /// The range of b for --curves [default: -12..12].
    #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(i64, i64)>)]
    b: Option<(i64, i64)>,
    #[command(flatten)]
    pub paper: Paper,
}

impl Drawing {
    /// The meaning of the colours.
    pub fn colouring(&self) -> Colouring {
        self.colour.unwrap_or_default()
    }

    /// The products that the drawing needs: none where nothing is drawn.
    pub fn products(&self, format: Format) -> Result<Products> {
        let given = [
            ("--colour", self.colour.is_some()),
            ("--curves", self.curves),
            ("--a", self.a.is_some()),
            ("--b", self.b.is_some()),
        ];
        self.paper.check(format.is_figure())?;
        if !format.is_figure() {
            unused(&given, "is for figures: write one with --output FILE.svg, FILE.pdf or FILE.png")?;
            return Ok(Products::default());
        }
        if !self.curves {
            unused(&given[2..], "is for curves: add --curves")?;
        }
        Ok(self.colouring().needs())
    }

    /// The curves wanted.
    pub fn sampled(&self, grid: &Grid) -> Result<Vec<Curve>> {
        if !self.curves {
            return Ok(Vec::new());
        }
        let families =
            Families { a: self.a.unwrap_or(FAMILIES.a), b: self.b.unwrap_or(FAMILIES.b), ..FAMILIES };
        families.curves(grid.lambdas().0, &window(grid))
    }
}
