//! Tongues as rows: streamed where they may be many.

use std::io::Write;

use crate::parallel::map;

use super::Question;
use crate::cli::args::{Common, TO_SEE_ROWS};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::report::csv;
use crate::report::document::{Document, Layout};
use crate::report::file::write_with;
use crate::report::stream::JsonRows;
use crate::report::table::Choice;
use crate::report::tongues::{CAPTION, CAPTION_LATEX, Tally, record};
use crate::tongue::Tongue;

/// Rows that a LaTeX table holds at most; text shows them up to a number that fits a terminal.
const MOST_ROWS: u64 = 100_000;
const ROWS_FOR_PEOPLE: u64 = 60;

/// Computes the tongues and writes them as the flags say.
///
/// # Errors
/// As [`put`] and [`Question::allow`], and an unwritable place.
pub fn write(question: &Question, common: &Common, format: Format) -> Result<()> {
    question.allow(common)?;
    write_with(common.output.as_deref(), |sink| put(question, common, format, sink).map(drop))?;
    common.wrote_output();
    Ok(())
}

/// Computes the tongues and writes them to a sink, row by row where they may be many: what stands out in them.
///
/// # Errors
/// As [`Question::each`], those of the sink, and too many rows for LaTeX.
pub fn put(question: &Question, common: &Common, format: Format, sink: &mut dyn Write) -> Result<Tally> {
    match format {
        Format::Json => json(question, common, sink),
        Format::Csv => rows(question, common, sink),
        Format::Text => text(question, common, sink),
        Format::Latex => latex(question, common, sink),
        Format::Svg | Format::Pdf | Format::Png | Format::Npz => {
            unreachable!("neither a figure nor arrays are rows")
        }
    }
}

/// The document `kickdrift/tongues/1`; the counts stand behind the rows.
fn json(question: &Question, common: &Common, sink: &mut dyn Write) -> Result<Tally> {
    let head = question.echo(Document::new("tongues"));
    let mut out = JsonRows::begin(sink, &head, "tongues")?;
    let record = record(&question.asked.request, false);
    let row = |tongue: &Tongue| record.entries(tongue).to_string();
    let tally = each_row(question, common, row, |row| out.row(row))?;
    out.end(&tally.entries())?;
    Ok(tally)
}

/// All columns as CSV.
fn rows(question: &Question, common: &Common, sink: &mut dyn Write) -> Result<Tally> {
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
    question: &Question,
    common: &Common,
    render: impl Fn(&Tongue) -> T + Sync,
    mut put: impl FnMut(&T) -> Result<()>,
) -> Result<Tally> {
    let mut tally = Tally::default();
    question.each(common, |part| {
        part.iter().for_each(|tongue| tally.add(tongue));
        let rendered: Vec<T> = map(part, &render);
        rendered.iter().try_for_each(&mut put)
    })?;
    Ok(tally)
}

/// A summary, and the rows where they fit a terminal.
fn text(question: &Question, common: &Common, sink: &mut dyn Write) -> Result<Tally> {
    let (tally, document) = summed_up(question, common, ROWS_FOR_PEOPLE)?;
    let mut text = document.render(Format::Text)?;
    if tally.count > ROWS_FOR_PEOPLE {
        text += &format!("\n{} rows: {TO_SEE_ROWS}\n", tally.count);
    }
    sink.write_all(text.as_bytes()).map_err(Error::stream)?;
    Ok(tally)
}

/// A table for papers.
fn latex(question: &Question, common: &Common, sink: &mut dyn Write) -> Result<Tally> {
    let (tally, document) = summed_up(question, common, MOST_ROWS)?;
    if tally.count > MOST_ROWS {
        let cost = format!("{} rows are too many for a LaTeX table", tally.count);
        return Err(Error::too_much(cost, "write csv or json"));
    }
    sink.write_all(document.render(Format::Latex)?.as_bytes()).map_err(Error::stream)?;
    Ok(tally)
}

/// The summary, and the rows up to a number.
fn summed_up(question: &Question, common: &Common, most: u64) -> Result<(Tally, Document)> {
    // What is asked for by name is shown in full.
    let record = record(&question.asked.request, question.columns.is_none());
    let (mut tally, mut table) =
        (Tally::default(), record.table("tongues", CAPTION, []).captioned(CAPTION_LATEX));
    question.each(common, |part| {
        for tongue in part {
            tally.add(tongue);
            if tally.count <= most {
                table.push(record.row(tongue));
            }
        }
        Ok(())
    })?;
    let mut document = question.echo(Document::new("tongues")).summary(&tally.lines(&question.words()));
    if tally.count <= most {
        document = document.long_rows(table);
    }
    // Places come with their digits already; what is left are widths and rounded numbers, which doubles hold.
    let digits = question.asked.request.digits;
    Ok((
        tally,
        document.laid_out(&Layout { columns: question.columns.clone(), digits })?.floated(common.float),
    ))
}
