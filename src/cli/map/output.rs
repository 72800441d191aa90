//! A map written as a summary, rows, arrays or a figure, each from one band at a time.

use std::path::Path;

use super::Drawing;
use crate::cli::args::{Columns, Common};
use clocks::map::{Band, Grid, Store, merge};
use documents::format::Format;
use documents::question::{Fields, Map, Question};
use documents::report::csv;
use documents::report::document::Layout;
use documents::report::file::{write_output, write_with};
use documents::report::map::{self as report, Counts, MapArrays, MapTally, Marked, Rows, marked};
use documents::report::plane::Chart;
use number::{Error, Result};

/// Where the bands of a map come from.
pub enum Source {
    /// Those in the store, where there is one, are not computed again.
    Computed(Option<Store>),
    /// From parts.
    Joined(Vec<Store>),
}

/// A result on its way out.
pub struct Output<'a> {
    pub map: &'a Map,
    pub grid: &'a Grid,
    pub format: Format,
    pub columns: &'a Columns,
    pub drawing: &'a Drawing,
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
            (Format::Npz | Format::Xyz | Format::Vtu, _) => unreachable!("no form of a map without a path"),
        }
        self.common.wrote_output();
        Ok(())
    }

    /// Hands on the bands.
    fn each(&self, source: &Source, see: &mut dyn FnMut(&Band) -> Result<()>) -> Result<()> {
        match source {
            Source::Computed(store) => {
                self.map.each(self.grid, store.as_ref(), &self.common.work(), |band| see(&band))
            }
            Source::Joined(stores) => merge(self.grid, stores, |_, band| see(&band)).map(drop),
        }
    }

    /// The rows, in the columns asked for.
    fn rows(&self) -> Result<Rows<'_>> {
        let rows = Rows::new(self.grid, self.map.products());
        match self.columns.names() {
            Some(names) => rows.choosing(names),
            None => Ok(rows),
        }
    }

    fn document(&self, source: &Source, path: Option<&Path>) -> Result<()> {
        let most = match self.format {
            Format::Json => 0,
            Format::Text => ROWS_FOR_PEOPLE,
            _ => MOST_ROWS,
        };
        let rows = self.rows()?;
        let (mut tally, mut pairs) = (MapTally::default(), Vec::<Marked>::new());
        self.each(source, &mut |band| {
            tally.add(self.grid, band);
            if tally.counts.marked() <= most {
                pairs.extend(marked(self.grid, band));
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
        let document = report::document(&tally, rows).inputs(self.map.input()).laid_out(&layout)?;
        let mut text = document.floated(self.common.float).within(self.common.width()).render(self.format)?;
        if self.format == Format::Text && count > most {
            text += &format!("\n{count} rows: use --format csv or latex to see them\n");
        }
        match path {
            None if self.format == Format::Text => self.common.write_to_person(&text),
            _ => write_output(path, text.as_bytes()),
        }
    }

    fn csv(&self, source: &Source, path: Option<&Path>) -> Result<()> {
        let mut rows = self.rows()?;
        let columns = rows.columns();
        write_with(path, |sink| {
            csv::write_header(sink, &columns)?;
            self.each(source, &mut |band| {
                let cells = marked(self.grid, band).map(|pair| rows.cells(&pair));
                csv::write_rows(sink, &columns, cells)
            })
        })
    }

    fn npz(&self, source: &Source, path: &Path) -> Result<()> {
        let mut arrays = MapArrays::new(path, self.grid, self.map.products())?;
        self.each(source, &mut |band| arrays.add(self.grid, band))?;
        arrays.finish()
    }

    fn figure(&self, source: &Source, path: Option<&Path>) -> Result<()> {
        let curves = self.drawing.sampled(self.grid)?;
        let (mut chart, mut counts) = (Chart::new(self.grid, self.drawing.colouring()), Counts::default());
        self.each(source, &mut |band| {
            chart.add(self.grid, band);
            counts.add(band);
            Ok(())
        })?;
        let figure = chart.figure(self.grid, &counts, &curves).footed(&self.map.foot());
        let command = self.common.command.replacen("kickdrift map", &self.map.bare().command(), 1);
        self.drawing.paper.write_as(figure, self.format, path, (&command, self.common))
    }
}
