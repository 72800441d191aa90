//! Tongues as rows, streamed where they may be many.

use std::io::Write;

use super::{FoundTongues, Tongues};
use crate::format::Format;
use crate::question::{Fields, Question, Work};
use crate::report::csv;
use crate::report::document::Document;
use crate::report::latex::Float;
use crate::report::stream::JsonRows;
use crate::report::table::Choice;
use crate::report::tongues::{TongueTally, record};
use clocks::tongue::{Listing, Tongue};
use number::parallel::map;
use number::{Error, Result};

/// How tongues are written.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    pub format: Format,
    /// The environment of a LaTeX table.
    pub float: Option<Float>,
    /// How rows that are left out of a text are to be seen.
    pub to_see: &'static str,
    /// Characters a line of a text, where a terminal bounds them.
    pub width: Option<usize>,
}

/// Rows that a LaTeX table holds at most; text shows them up to a number that fits a terminal.
const MOST_ROWS: u64 = 100_000;
const ROWS_FOR_PEOPLE: u64 = 60;

fn most_rows(format: Format) -> u64 {
    if format == Format::Text { ROWS_FOR_PEOPLE } else { MOST_ROWS }
}

/// Where the tongues come from that are written.
#[derive(Clone, Copy)]
enum Source<'a> {
    Sought(&'a Work<'a>),
    Found(&'a FoundTongues),
}

/// Tongues that were found are rendered in parallel, so many at a time.
const TOGETHER: usize = 4096;

impl Tongues {
    /// Finds the tongues and writes the document of [`Question::ask`], row by row where they may be many:
    /// what stands out in them.
    ///
    /// # Errors
    /// As [`Question::answer`], and those of the sink.
    pub fn write(&self, work: &Work, form: Form, sink: &mut dyn Write) -> Result<TongueTally> {
        match form.format {
            Format::Json => self.write_json(Source::Sought(work), sink),
            Format::Csv => self.write_csv(Source::Sought(work), sink),
            format => {
                let found = self.first(most_rows(format), work)?;
                self.write_for_people(&found, form, sink)?;
                Ok(found.tally)
            }
        }
    }

    /// The same bytes, of tongues that were found.
    ///
    /// # Errors
    /// As [`Tongues::write`].
    pub fn written(&self, found: &FoundTongues, form: Form) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match form.format {
            Format::Json => self.write_json(Source::Found(found), &mut bytes).map(drop),
            Format::Csv => self.write_csv(Source::Found(found), &mut bytes).map(drop),
            _ => self.write_for_people(found, form, &mut bytes),
        }?;
        Ok(bytes)
    }

    /// The document `kickdrift/tongues/1`; the counts stand behind the rows.
    fn write_json(&self, source: Source, sink: &mut dyn Write) -> Result<TongueTally> {
        let (listing, head) = (self.listing()?, Document::new(Self::NAME).inputs(self.whole()?.input()));
        let mut out = JsonRows::begin(sink, &head, "tongues")?;
        let record = record(&listing.request, false);
        let row = |tongue: &Tongue| record.entries(tongue).to_string();
        let tally = self.each_row(&listing, source, row, |row| out.row(row))?;
        out.end(&TongueTally::record().object(&tally))?;
        Ok(tally)
    }

    /// All columns as CSV, or those named.
    fn write_csv(&self, source: Source, sink: &mut dyn Write) -> Result<TongueTally> {
        let listing = self.listing()?;
        let record = record(&listing.request, false);
        let columns = record.columns();
        let choice = self.named().map(|names| Choice::new(&columns, &names)).transpose()?;
        let columns = choice.as_ref().map_or(&columns[..], Choice::columns);
        csv::write_header(sink, columns)?;
        let row = |tongue: &Tongue| {
            let (mut line, all) = (Vec::new(), record.row(tongue));
            let row = choice.as_ref().map_or_else(|| all.clone(), |choice| choice.row(&all));
            csv::write_rows(&mut line, columns, [row]).expect("memory takes all");
            line
        };
        self.each_row(&listing, source, row, |line| sink.write_all(line).map_err(Error::stream))
    }

    /// Renders the tongues in parallel and hands them on in order.
    fn each_row<T: Send>(
        &self,
        listing: &Listing,
        source: Source,
        render: impl Fn(&Tongue) -> T + Sync,
        mut put: impl FnMut(&T) -> Result<()>,
    ) -> Result<TongueTally> {
        let mut tally = TongueTally::default();
        let mut see = |part: &[Tongue]| {
            part.iter().for_each(|tongue| tally.add(tongue));
            let rendered: Vec<T> = map(part, &render);
            rendered.iter().try_for_each(&mut put)
        };
        match source {
            Source::Sought(work) => self.each(listing, work, see)?,
            Source::Found(found) => found.tongues.chunks(TOGETHER).try_for_each(&mut see)?,
        }
        Ok(tally)
    }

    /// A summary, and the rows where a terminal or a table holds them.
    fn write_for_people(&self, found: &FoundTongues, form: Form, sink: &mut dyn Write) -> Result<()> {
        let Form { format, float, to_see, width } = form;
        let count = found.tally.count;
        let too_many = count > most_rows(format);
        if too_many && format == Format::Latex {
            let cost = format!("{count} rows are too many for a LaTeX table");
            return Err(Error::too_much(cost, "write csv or json"));
        }
        let rows = if too_many { &[] } else { &found.tongues[..] };
        let document =
            self.tables(found, rows, &found.request).inputs(found.asked.input()).floated(float).within(width);
        let mut text = document.render(format)?;
        if too_many {
            text += &format!("\n{count} rows: {to_see}\n");
        }
        sink.write_all(text.as_bytes()).map_err(Error::stream)
    }
}
