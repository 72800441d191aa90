//! Tongues as rows: streamed where they may be many.

use std::io::Write;

use crate::cli::args::{Common, TO_SEE_ROWS};
use crate::cli::progress::{Shown, progress};
use clocks::tongue::{self, Selection, StepWindow, Tongue, Wanted};
use documents::format::Format;
use documents::question::{Fields, Ratios, Tongues};
use documents::report::csv;
use documents::report::document::{Document, Layout};
use documents::report::file::write_with;
use documents::report::stream::JsonRows;
use documents::report::table::Choice;
use documents::report::tongues::{CAPTION, CAPTION_LATEX, TongueTally, record};
use number::error::{Error, Result};
use number::parallel::map;

/// All that `tongues` asks.
#[derive(Clone, Debug)]
pub struct Stream {
    tongues: Tongues,
    pub ratios: Ratios,
    pub asked: tongue::Listing,
    /// The columns of tables, by the names that CSV has; those that fit the form where none are given.
    pub columns: Option<Vec<String>>,
}

/// Rows unless a budget says otherwise: some gigabytes of text, minutes of work.
const MOST: u64 = 30_000_000;
/// Rows that a LaTeX table holds at most; text shows them up to a number that fits a terminal.
const MOST_ROWS: u64 = 100_000;
const ROWS_FOR_PEOPLE: u64 = 60;

impl Stream {
    /// The question, if it makes sense, with what is `wanted` of each tongue.
    pub fn new(tongues: Tongues, wanted: Wanted) -> Result<Self> {
        let (ratios, asked) = (tongues.ratios()?, tongues.asked(wanted)?);
        Ok(Stream { tongues, ratios, asked, columns: None })
    }

    /// That so many rows may be computed and written, where no window and no label says that they are fewer:
    /// p + q - 1 of p/q.
    pub fn allow(&self, common: &Common) -> Result<()> {
        let asked = &self.asked;
        if asked.window != StepWindow::default() || asked.selection != Selection::default() {
            return Ok(());
        }
        let rows = asked.ratios.iter().map(|ratio| ratio.kicks() - 1).sum::<u64>();
        let most = common.budget.unwrap_or(MOST);
        if rows <= most {
            return Ok(());
        }
        let work = format!("the tongues of {} are {rows} rows, the budget is {most}", self.ratios.words());
        Err(Error::budget(work, rows).or(match self.ratios {
            Ratios::One(_) => "choose labels by --m, or a window",
            Ratios::UpTo(_) => "choose a smaller --max-sum, a window, or --survey",
        }))
    }

    /// Hands on the tongues in the order of p + q, p, m.
    pub fn each(&self, common: &Common, see: impl FnMut(&[Tongue]) -> Result<()>) -> Result<()> {
        let count = self.asked.ratios.len() as u64;
        let bar = progress(common.quiet, count, if count == 1 { "tongues" } else { "ratios" });
        self.asked.each(&Shown(bar.clone()), see)?;
        bar.finish_and_clear();
        Ok(())
    }

    /// Its document without rows.
    fn document(&self) -> Document {
        Document::new("tongues").inputs(self.tongues.input())
    }
}

/// Computes the tongues and writes them as the flags say.
pub fn write(question: &Stream, common: &Common, format: Format) -> Result<()> {
    question.allow(common)?;
    write_with(common.output.as_deref(), |sink| put(question, common, format, sink).map(drop))?;
    common.wrote_output();
    Ok(())
}

/// Computes the tongues and writes them to a sink, row by row where they may be many: what stands out in
/// them.
pub fn put(question: &Stream, common: &Common, format: Format, sink: &mut dyn Write) -> Result<TongueTally> {
    match format {
        Format::Json => json(question, common, sink),
        Format::Csv => rows(question, common, sink),
        Format::Text | Format::Latex => document(question, common, format, sink),
        Format::Svg | Format::Pdf | Format::Png | Format::Npz | Format::Xyz | Format::Vtu => {
            unreachable!("neither a figure nor arrays are rows")
        }
    }
}

/// The document `kickdrift/tongues/1`; the counts stand behind the rows.
fn json(question: &Stream, common: &Common, sink: &mut dyn Write) -> Result<TongueTally> {
    let mut out = JsonRows::begin(sink, &question.document(), "tongues")?;
    let record = record(&question.asked.request, false);
    let row = |tongue: &Tongue| record.entries(tongue).to_string();
    let tally = each_row(question, common, row, |row| out.row(row))?;
    out.end(&tally.entries())?;
    Ok(tally)
}

/// All columns as CSV.
fn rows(question: &Stream, common: &Common, sink: &mut dyn Write) -> Result<TongueTally> {
    let record = record(&question.asked.request, false);
    let columns = record.columns();
    let choice = question.columns.as_ref().map(|names| Choice::new(&columns, names)).transpose()?;
    let columns = choice.as_ref().map_or(&columns[..], Choice::columns);
    csv::write_header(sink, columns)?;
    let row = |tongue: &Tongue| {
        let (mut line, all) = (Vec::new(), record.row(tongue));
        let row = choice.as_ref().map_or_else(|| all.clone(), |choice| choice.row(&all));
        csv::write_rows(&mut line, columns, [row]).expect("memory takes all");
        line
    };
    each_row(question, common, row, |line| sink.write_all(line).map_err(Error::stream))
}

/// Renders the tongues in parallel and hands them on in order.
fn each_row<T: Send>(
    question: &Stream,
    common: &Common,
    render: impl Fn(&Tongue) -> T + Sync,
    mut put: impl FnMut(&T) -> Result<()>,
) -> Result<TongueTally> {
    let mut tally = TongueTally::default();
    question.each(common, |part| {
        part.iter().for_each(|tongue| tally.add(tongue));
        let rendered: Vec<T> = map(part, &render);
        rendered.iter().try_for_each(&mut put)
    })?;
    Ok(tally)
}

/// A summary, and the rows where a terminal or a table holds them.
fn document(question: &Stream, common: &Common, format: Format, sink: &mut dyn Write) -> Result<TongueTally> {
    let most = if format == Format::Text { ROWS_FOR_PEOPLE } else { MOST_ROWS };
    // Columns asked for by name are shown in full.
    let record = record(&question.asked.request, question.columns.is_none());
    let mut table = record.table("tongues", CAPTION, []).captioned(CAPTION_LATEX);
    let mut tally = TongueTally::default();
    question.each(common, |part| {
        for tongue in part {
            tally.add(tongue);
            if tally.count <= most {
                table.push(record.row(tongue));
            }
        }
        Ok(())
    })?;
    let too_many = tally.count > most;
    if too_many && format == Format::Latex {
        let cost = format!("{} rows are too many for a LaTeX table", tally.count);
        return Err(Error::too_much(cost, "write csv or json"));
    }
    let document = question.document().summary(&tally.lines(&question.tongues.words()?));
    let document = if too_many { document } else { document.long_rows(table) };
    // Places come with their digits already; what is left are widths and rounded numbers, which doubles hold.
    let layout = Layout { columns: question.columns.clone(), digits: question.asked.request.digits };
    let mut text = document.laid_out(&layout)?.floated(common.float).render(format)?;
    if too_many {
        text += &format!("\n{} rows: {TO_SEE_ROWS}\n", tally.count);
    }
    sink.write_all(text.as_bytes()).map_err(Error::stream)?;
    Ok(tally)
}
