//! Commands whose arguments are a question and whose answer is its document.

use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::args::{Columns, Common};
use super::help::below;
use super::progress::{Shown, announce, progress};
use clocks::tongue::Progress;
use documents::format::Format;
use documents::question::{Question, Watch, Work};
use number::error::Error;

/// The flags of a question, and of its table.
#[derive(Debug)]
pub struct Asked<Q> {
    question: Q,
    columns: Columns,
}

impl<Q: Question + Args> Args for Asked<Q> {
    fn augment_args(command: Command) -> Command {
        Columns::augment_args(Q::augment_args(command)).after_help(below(Q::NAME, Q::EXAMPLES))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Columns::augment_args_for_update(Q::augment_args_for_update(command))
    }
}

impl<Q: FromArgMatches> FromArgMatches for Asked<Q> {
    fn from_arg_matches(given: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Asked { question: Q::from_arg_matches(given)?, columns: Columns::from_arg_matches(given)? })
    }

    fn update_from_arg_matches(&mut self, given: &ArgMatches) -> Result<(), clap::Error> {
        self.question.update_from_arg_matches(given)?;
        self.columns.update_from_arg_matches(given)
    }
}

impl<Q: Question> Asked<Q> {
    /// Writes the document, in `default` form unless another one is asked for.
    pub fn run(&self, common: &Common, default: Default) -> Result<(), Error> {
        let format = match default {
            Default::Text => Format::Text,
            Default::Table => common.format_of_table(&Format::DOCUMENT)?,
        };
        common.write(&self.columns.of(self.question.ask(&common.work())?)?, format)
    }
}

/// The form of an answer unless another one is asked for.
#[derive(Clone, Copy, Debug)]
pub enum Default {
    Text,
    /// Text at a terminal, JSON elsewhere.
    Table,
}

impl Common {
    /// The cost allowed to an answer; its progress is shown on a terminal.
    pub fn work(&self) -> Work<'_> {
        Work {
            budget: self.budget,
            watch: (!self.quiet).then_some(self),
            threads: self.threads(),
            ..Work::default()
        }
    }
}

impl Watch for Common {
    fn announce(&self, work: &str, seconds: f64) {
        announce(self.quiet, work, seconds);
    }

    fn count(&self, length: u64, things: &str) -> Box<dyn Progress + '_> {
        Box::new(Shown(progress(self.quiet, length, things)))
    }
}
