//! Questions whose fields are flags.

use std::marker::PhantomData;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use serde_json::{Map, Value};

use super::args::{Columns, Common};
use super::paper::Paper;
use super::progress::{Shown, announce, progress};
use clocks::tongue::Progress;
use documents::format::Format;
use documents::question::{Fields, NEEDED, Question, Watch, Work};
use number::{Error, Result};

/// The flags of a question, and of its table.
#[derive(Debug, clap::Args)]
pub struct Asked<Q: Question + Args> {
    #[command(flatten)]
    question: Q,
    #[command(flatten)]
    columns: Columns,
}

impl<Q: Question + Args> Asked<Q> {
    /// Writes the document, in `default` form unless another one is asked for.
    pub fn run(&self, common: &Common, default: Default) -> Result<()> {
        let format = default.of(&Format::DOCUMENT, common)?;
        common.write(&self.columns.of(self.question.ask(&common.work())?)?, format)
    }
}

/// The flags of a question, of its table and of its figure.
#[derive(Debug, clap::Args)]
pub struct Drawn<Q: Question + Args> {
    #[command(flatten)]
    question: Q,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

impl<Q: Question + Args> Drawn<Q> {
    /// Writes the document or the figure, in `default` form unless another one is asked for.
    pub fn run(&self, common: &Common, default: Default) -> Result<()> {
        let format = default.of(&Format::DOCUMENT_OR_FIGURE, common)?;
        self.paper.check(format.is_figure())?;
        let work = common.work();
        let answer = self.question.answer(&work)?;
        let drawn = if format.is_figure() { self.question.figure(&answer, &work)? } else { None };
        match drawn {
            Some(figure) => self.paper.write(figure, format, common.output.as_deref(), common),
            None => common.write(&self.columns.of(self.question.document(&answer))?, format),
        }
    }
}

/// The flags of a question whose fields may be given by other names too, or by those of another question: a
/// document's `input`, read as such.
#[derive(Clone, Debug)]
pub struct Flags<Q> {
    given: Map<String, Value>,
    question: PhantomData<Q>,
}

/// The flags of a question.
fn flags<Q: Args>() -> Command {
    Q::augment_args(Command::new(""))
}

impl<Q: Fields + Args> Flags<Q> {
    /// Whether a field is given.
    pub fn has(&self, field: &str) -> bool {
        self.given.contains_key(field)
    }

    /// The same with another value of a field.
    pub fn with(&self, field: &str, value: &str) -> Self {
        let mut given = self.given.clone();
        given.insert(field.into(), value.into());
        Flags { given, question: PhantomData }
    }

    /// The question that is asked by them.
    pub fn question(&self) -> Result<Q> {
        Q::read(&self.given).map_err(|error| {
            let flag = error.field().replace('_', "-");
            let is_it = |arg: &&Arg| arg.get_long() == Some(&flag);
            match flags::<Q>().get_arguments().find(is_it) {
                Some(arg) if error.remedy() == NEEDED => {
                    let values = arg.get_value_names().into_iter().flatten();
                    let values: String = values.map(|value| format!(" <{value}>")).collect();
                    Error::missing(&flag, format!("add --{flag}{values}"))
                }
                _ => error.at(&flag),
            }
        })
    }
}

impl<Q: Fields + Args> Args for Flags<Q> {
    /// Those that the command does not have yet.
    fn augment_args(command: Command) -> Command {
        let is_new = |flag: &&Arg| command.get_arguments().all(|known| known.get_id() != flag.get_id());
        let new: Vec<Arg> = flags::<Q>().get_arguments().filter(is_new).cloned().collect();
        command.args(new)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<Q: Fields> FromArgMatches for Flags<Q> {
    fn from_arg_matches(matches: &ArgMatches) -> clap::error::Result<Self> {
        let names = Q::FIELDS.iter().chain(Q::OTHER_NAMES.iter().copied().flatten());
        let names: Vec<&str> = names.copied().collect();
        let is_given =
            |id: &&str| names.contains(id) && matches.value_source(id) == Some(ValueSource::CommandLine);
        let text = |id: &str| {
            let mut texts = matches.get_raw(id).into_iter().flatten();
            (id.to_string(), texts.next().unwrap_or_default().to_string_lossy().into())
        };
        let given = matches.ids().map(clap::Id::as_str).filter(is_given).map(text).collect();
        Ok(Flags { given, question: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> clap::error::Result<()> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The form of an answer unless another one is asked for.
#[derive(Clone, Copy, Debug)]
pub enum Default {
    Text,
    /// Text at a terminal, JSON elsewhere.
    Table,
}

impl Default {
    /// The form that is asked for, one of these, or this one.
    fn of(self, forms: &[Format], common: &Common) -> Result<Format> {
        match self {
            Default::Text => common.format(forms, Format::Text),
            Default::Table => common.format_of_table(forms),
        }
    }
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
