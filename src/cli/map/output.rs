//! What becomes of a map: a summary, rows, arrays or a figure, each from one band at a time.

use std::path::Path;

use super::{Drawing, Map, Source};
use crate::cli::args::{Columns, Common};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::map::{Band, Grid, Products, Shard};
use crate::report::csv;
use crate::report::document::{Document, Layout};
use crate::report::file::{write_output, write_with};
use crate::report::map::{self as report, Counts, MapArrays, Marked, Rows, Tally, marked};
use crate::report::plane::{Chart, parameters};
use crate::report::table::Table;
use crate::scene::GridRange;

/// A result on its way out.
pub struct Output<'a> {
    pub map: &'a Map,
    pub format: Format,
    pub columns: &'a Columns,
    pub drawing: &'a Drawing,
    /// K/N where the map is not whole.
    pub part: Option<Shard>,
    pub common: &'a Common,
}

/// Rows that a document holds in memory at most; text shows them up to a number that fits a terminal.
const MOST_ROWS: u64 = 1_000_000;
const ROWS_FOR_PEOPLE: u64 = 60;

impl Output<'_> {
    /// Computes the map and writes the result to `--output`, or to standard output.
    pub fn write(&self, source: &Source) -> Result<()> {
        let path = self.common.output.as_deref();
        match (self.format, path) {
            (Format::Json | Format::Text | Format::Latex, _) => self.document(source, path)?,
            (Format::Csv, _) => self.csv(source, path)?,
            (Format::Npz, Some(path)) => self.npz(source, path)?,
            (Format::Svg | Format::Pdf | Format::Png, _) => return self.figure(source, path),
            (Format::Npz, None) => unreachable!("an extension is that of a path"),
        }
        self.common.wrote_output();
        Ok(())
    }

    /// The rows, in the columns asked for.
    fn rows(&self) -> Result<Rows<'_>> {
        let rows = Rows::new(&self.map.grid, self.map.products);
        self.columns
            .names()
            .map_or(Ok(rows), |names| Rows::new(&self.map.grid, self.map.products).choosing(names))
    }

    fn document(&self, source: &Source, path: Option<&Path>) -> Result<()> {
        let most = match self.format {
            Format::Json => 0,
            Format::Text => ROWS_FOR_PEOPLE,
            _ => MOST_ROWS,
        };
        let rows = self.rows()?;
        let (mut tally, mut pairs) = (Tally::default(), Vec::<Marked>::new());
        source.each(self.map, &mut |band| {
            tally.add(&self.map.grid, band);
            if tally.counts.marked() <= most {
                pairs.extend(marked(&self.map.grid, band));
            }
            Ok(())
        })?;
        let count = tally.counts.marked();
        if self.format == Format::Latex && count > most {
            let cost = format!("{count} rows are too many for a LaTeX table");
            return Err(Error::too_much(cost, "write csv or npz"));
        }
        let rows = (count <= most).then(|| rows.table(&pairs));
        // The columns are chosen already.
        let layout = Layout { columns: None, ..self.columns.layout() };
        let document = self.echo(report::document(&tally, rows)).laid_out(&layout)?;
        let mut text = document.floated(self.common.float).render(self.format)?;
        if self.format == Format::Text && count > most {
            text += &format!("\n{count} rows: use --format csv or latex to see them\n");
        }
        write_output(path, text.as_bytes())
    }

    fn echo(&self, document: Document) -> Document {
        let document = echo(document, &self.map.grid, &self.map.range);
        let Products { label, growth } = self.map.products;
        let flag = |given: bool| given.then(|| "true".to_string());
        let part = self.part.map(|shard| shard.to_string());
        let flags = [("label", flag(label)), ("growth", flag(growth)), ("shard", part)];
        document.inputs(flags.into_iter().filter_map(|(key, value)| Some((key, value?))))
    }

    fn csv(&self, source: &Source, path: Option<&Path>) -> Result<()> {
        let mut rows = self.rows()?;
        let columns = rows.columns();
        write_with(path, |sink| {
            csv::write_header(sink, &columns)?;
            source.each(self.map, &mut |band| {
                let cells = marked(&self.map.grid, band).map(|pair| rows.cells(&pair));
                csv::write_rows(sink, &columns, cells)
            })
        })
    }

    fn npz(&self, source: &Source, path: &Path) -> Result<()> {
        let grid = &self.map.grid;
        let mut arrays = MapArrays::new(path, grid, self.map.products)?;
        source.each(self.map, &mut |band: &Band| arrays.add(grid, band))?;
        arrays.finish()
    }

    fn figure(&self, source: &Source, path: Option<&Path>) -> Result<()> {
        let curves = self.drawing.sampled(self.map)?;
        let grid = &self.map.grid;
        let (mut chart, mut counts) = (Chart::new(grid, self.drawing.colouring()), Counts::default());
        source.each(self.map, &mut |band| {
            chart.add(grid, band);
            counts.add(band);
            Ok(())
        })?;
        let range = &self.map.range;
        let foot = parameters(grid.lambdas(), range.ranges(), range.steps());
        let figure = chart.figure(grid, &counts, &curves).footed(&foot);
        let command = self.common.command.replacen("kickdrift map", &self.map.command(), 1);
        self.drawing.paper.write_as(figure, self.format, path, (&command, self.common))
    }
}

/// The verdicts of a scene as a document.
pub fn document(grid: &Grid, range: &GridRange, tally: &Tally, pairs: &[Marked]) -> Document {
    let rows: Table = Rows::new(grid, Products::default()).table(pairs);
    echo(report::document(tally, Some(rows)), grid, range)
}

fn echo(document: Document, grid: &Grid, range: &GridRange) -> Document {
    let (lambda1, lambda2) = grid.lambdas();
    document.input("lambda1", lambda1).input("lambda2", lambda2).inputs(range.given())
}
