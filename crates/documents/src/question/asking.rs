//! Questions: fields, an answer, a document.

use serde_json::{Map, Value};

use crate::report::document::Document;
use crate::report::shape::{Keys, Schema};
use crate::report::text::quoted;
use clocks::tongue::Progress;
use clocks::verdict::Limits;
use number::Result;

/// The fields of a `Question`, each declared once: a struct that is read from the `input` of a document and
/// written there, and, as `args struct`, read from arguments too. `as "X"` gives a field the flag of its
/// name, whose value help calls X; `arg`, as clap has it, says what else there is. After `|` stand other
/// names that a field is read from where its own is not given.
macro_rules! question {
    (
        $(#[$meta:meta])*
        args struct $Name:ident {
            $(
                $(#[doc = $help:literal])*
                $(#[arg($($arg:tt)*)])?
                $field:ident $(as $value:literal)?: $type:ty $(| $other:ident)* $(= $default:literal)?,
            )*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, clap::Args)]
        pub struct $Name {
            $(
                $(#[doc = $help])*
                $(#[arg($($arg)*)])?
                $(#[arg(
                    long,
                    value_name = $value,
                    allow_hyphen_values = true,
                    value_parser = $crate::question::flag::<<$type as $crate::question::field::Flag>::Value>,
                )])?
                $(#[arg(default_value = $default)])?
                pub $field: $type,
            )*
        }

        $crate::question::question!(@fields $Name $($(#[doc = $help])* $field: $type $(| $other)* $(= $default)?,)*);
    };
    (
        $(#[$meta:meta])*
        struct $Name:ident { $($(#[doc = $help:literal])* $field:ident: $type:ty $(= $default:literal)?,)* }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $Name {
            $($(#[doc = $help])* pub $field: $type,)*
        }

        $crate::question::question!(@fields $Name $($(#[doc = $help])* $field: $type $(= $default)?,)*);
    };
    (@fields $Name:ident $($(#[doc = $help:literal])* $field:ident: $type:ty $(| $other:ident)* $(= $default:literal)?,)*) => {
        impl $crate::question::Fields for $Name {
            const FIELDS: &'static [&'static str] = &[$(stringify!($field)),*];
            const OTHER_NAMES: &'static [&'static [&'static str]] = &[$(&[$(stringify!($other)),*]),*];

            fn keys() -> $crate::report::shape::Keys {
                $crate::report::shape::Keys::new()$(.with(
                    stringify!($field),
                    <$type as $crate::question::Field>::SHAPE,
                    concat!($($help),*).trim(),
                    <$type as $crate::question::Field>::IS_REQUIRED,
                ))*
            }

            fn defaults() -> Vec<(&'static str, &'static str)> {
                let all: [(&str, Option<&str>); Self::FIELDS.len()] =
                    [$((stringify!($field), None$(.or(Some($default)))?),)*];
                all.into_iter().filter_map(|(name, default)| Some((name, default?))).collect()
            }

            fn required() -> Vec<&'static str> {
                let defaults = Self::defaults();
                let all: [(&str, bool); Self::FIELDS.len()] =
                    [$((stringify!($field), <$type as $crate::question::Field>::of(None, stringify!($field)).is_none()),)*];
                let has_default = |name: &str| defaults.iter().any(|(field, _)| *field == name);
                all.into_iter().filter(|(name, needed)| *needed && !has_default(name)).map(|(name, _)| name).collect()
            }

            fn read(input: &serde_json::Map<String, serde_json::Value>) -> number::error::Result<Self> {
                use $crate::question::field;
                field::known(input, Self::FIELDS, Self::OTHER_NAMES)?;
                Ok($Name {
                    $($field: {
                        let name = field::name(&[stringify!($field) $(, stringify!($other))*], input);
                        field::read(name, input, None$(.or(Some($default)))?)?
                    },)*
                })
            }

            fn input(&self) -> Vec<(&'static str, serde_json::Value)> {
                let given: [(&'static str, Option<serde_json::Value>); Self::FIELDS.len()] =
                    [$((stringify!($field), $crate::question::field::Field::shown(&self.$field)),)*];
                given.into_iter().filter_map(|(name, text)| Some((name, text?))).collect()
            }
        }

        impl<'de> serde::Deserialize<'de> for $Name {
            fn deserialize<D>(deserializer: D) -> std::result::Result<Self, D::Error>
            where
                D: serde::Deserializer<'de>,
            {
                let input = serde_json::Map::deserialize(deserializer)?;
                $crate::question::Fields::read(&input).map_err(serde::de::Error::custom)
            }
        }
    };
}
pub(crate) use question;

/// The fields of a question, as `question!` declares them.
pub trait Fields: Sized {
    /// Their names, as documents have them.
    const FIELDS: &'static [&'static str];
    /// Names that each is read from where its own is not given: one may stand for several fields, as `step`
    /// for the spacings of both steps.
    const OTHER_NAMES: &'static [&'static [&'static str]];

    /// The same as keys of `input`, with what they may be.
    fn keys() -> Keys;

    /// The fields that have a value where none is given, and that value.
    fn defaults() -> Vec<(&'static str, &'static str)>;

    /// The fields that have to be given.
    fn required() -> Vec<&'static str>;

    /// Reads the `input` of a document.
    ///
    /// # Errors
    /// A field that is missing, unknown or not what it should be, by its name.
    fn read(input: &Map<String, Value>) -> Result<Self>;

    /// The fields as documents echo them: exact texts, or what has parts of its own; what is not given is not
    /// there.
    fn input(&self) -> Vec<(&'static str, Value)>;
}

/// A question: its answer is computed, and shown in one document.
pub trait Question: Fields {
    /// NAME in `kickdrift/NAME/1`.
    const NAME: &'static str;
    /// Command lines that ask it.
    const EXAMPLES: &'static [&'static str] = &[];
    /// The flags that are required, where these depend on each other.
    const USAGE: Option<&'static str> = None;
    /// The result that is computed.
    type Answer;

    /// Computes the answer.
    ///
    /// # Errors
    /// A question out of range, one that costs more than `work` allows, and whatever the library refuses.
    fn answer(&self, work: &Work) -> Result<Self::Answer>;

    /// What its documents are, for their schema; `None` where they are of several kinds.
    fn schema() -> Option<Schema> {
        None
    }

    /// The kinds of its documents: NAME, what they are, and the keys of their `input`.
    fn schemas() -> Vec<(&'static str, Schema, Keys)> {
        Self::schema().map(|schema| (Self::NAME, schema, Self::keys())).into_iter().collect()
    }

    /// The answer in a document that lacks its `input`.
    fn show(&self, answer: &Self::Answer) -> Document;

    /// The answer in a document.
    fn document(&self, answer: &Self::Answer) -> Document {
        self.show(answer).inputs(self.input())
    }

    /// The command line that asks it, as a shell reads it, where each field stands behind the flag of its
    /// name.
    fn command(&self) -> String {
        let flag = |(key, value): (&str, Value)| match (key.replace('_', "-"), value.as_str()) {
            (key, Some("true")) => format!(" --{key}"),
            (key, text) => format!(" --{key} {}", quoted(text.unwrap_or_default())),
        };
        format!("kickdrift {}{}", Self::NAME, self.input().into_iter().map(flag).collect::<String>())
    }

    /// The answer drawn; `None` where this is nothing to draw.
    ///
    /// # Errors
    /// Those of what is computed for the figure alone.
    fn figure(&self, _: &Self::Answer, _: &Work) -> Result<Option<plot::Figure>> {
        Ok(None)
    }

    /// Answer and document in one.
    ///
    /// # Errors
    /// As [`Question::answer`].
    fn ask(&self, work: &Work) -> Result<Document> {
        Ok(self.document(&self.answer(work)?))
    }
}

/// The cost allowed to an answer, who hears of long work, and what a question refers to.
#[derive(Clone, Copy, Default)]
pub struct Work<'a> {
    /// The most kicks that one tier composes for one pair, and each question's own measure of what it costs;
    /// its own limit unless given.
    pub budget: Option<u64>,
    /// The sink of progress; `None` is silent.
    pub watch: Option<&'a dyn Watch>,
    /// The threads of a map, which has its own; 0 for one a core.
    pub threads: usize,
    /// Where the arrays are that a system refers to; here unless given.
    pub arrays: Option<&'a crate::input::Arrays>,
}

/// Hears of long work: a bar of progress, as a rule.
pub trait Watch: Sync {
    /// Work is about to begin that takes so many seconds of one core.
    fn announce(&self, work: &str, seconds: f64);
    /// So many `things` are about to be done; returns their counter.
    fn count(&self, length: u64, things: &str) -> Box<dyn Progress + '_>;
}

impl Work<'_> {
    /// The kicks that one verdict may compose.
    pub fn limits(&self) -> Limits {
        self.budget.map_or_else(Limits::default, |kicks| Limits { kicks })
    }

    /// Announces work that is about to begin.
    pub fn announce(&self, work: &str, seconds: f64) {
        self.watch.inspect(|watch| watch.announce(work, seconds));
    }

    /// The counter of so many things.
    pub fn count(&self, length: u64, things: &str) -> Box<dyn Progress + '_> {
        self.watch.map_or_else(|| Box::new(()) as Box<dyn Progress>, |watch| watch.count(length, things))
    }
}
