//! Which tongues are asked for, and what of them.

use indicatif::ProgressBar;

use crate::cli::args::Common;
use crate::cli::progress::progress;
use crate::error::{Error, Result};
use crate::question::{Fields, Ratios, Tongues};
use crate::report::document::Document;
use crate::tongue::{self, Progress, Selection, Tongue, Wanted, Window};

/// All that `tongues` asks.
#[derive(Clone, Debug)]
pub struct Question {
    tongues: Tongues,
    pub ratios: Ratios,
    pub asked: tongue::Question,
    /// The columns of tables, by the names that CSV has; those that fit the form where none are given.
    pub columns: Option<Vec<String>>,
}

/// Rows unless a budget says otherwise: some gigabytes of text, minutes of work.
const MOST_ROWS: u64 = 30_000_000;

impl Progress for ProgressBar {
    fn expect(&self, total: u64) {
        self.set_length(total);
    }

    fn advance(&self, more: u64) {
        self.inc(more);
    }
}

impl Question {
    /// The question, if it makes sense, with what is `wanted` of each tongue.
    ///
    /// # Errors
    /// As [`Tongues::asked`].
    pub fn new(tongues: Tongues, wanted: Wanted) -> Result<Self> {
        let (ratios, asked) = (tongues.ratios()?, tongues.asked(wanted)?);
        Ok(Question { tongues, ratios, asked, columns: None })
    }

    /// The same, its tables in these columns.
    #[must_use]
    pub fn in_columns(self, columns: Option<Vec<String>>) -> Self {
        Question { columns, ..self }
    }

    /// That so many rows may be computed and written, where no window and no label says that they are fewer: p + q - 1 of p/q.
    ///
    /// # Errors
    /// A budget error with their number.
    pub fn allow(&self, common: &Common) -> Result<()> {
        let asked = &self.asked;
        if asked.window != Window::default() || asked.selection != Selection::default() {
            return Ok(());
        }
        let rows = asked.ratios.iter().map(|ratio| ratio.kicks() - 1).sum::<u64>();
        let most = common.budget.unwrap_or(MOST_ROWS);
        if rows <= most {
            return Ok(());
        }
        let work = format!("the tongues of {} are {rows} rows, the budget is {most}", self.ratios.words());
        Err(Error::budget(work, rows).or("choose a smaller --max-sum, a window, or --survey"))
    }

    /// Hands on the tongues in the order of p + q, p, m.
    ///
    /// # Errors
    /// As [`tongue::Question::each`].
    pub fn each(&self, common: &Common, see: impl FnMut(&[Tongue]) -> Result<()>) -> Result<()> {
        let count = self.asked.ratios.len() as u64;
        let bar = progress(common.quiet, count, if count == 1 { "tongues" } else { "ratios" });
        self.asked.each(&bar, see)?;
        bar.finish_and_clear();
        Ok(())
    }

    /// Echoes the question, exactly.
    pub fn echo(&self, document: Document) -> Document {
        document.inputs(self.tongues.input())
    }

    /// The question in words.
    pub fn words(&self) -> String {
        self.tongues.words().unwrap_or_default()
    }
}
