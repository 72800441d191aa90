//! Documents rechecked: what each one claims, found again by another route than the one that made it.
//!
//! A document is read once, into the typed rows of a [`Claim`]; its check holds every field against the mathematics, the
//! list's completeness included, and names the fields that it does not recheck.
//!
//! | document | made by | rechecked by |
//! |---|---|---|
//! | tongues | Rayleigh quotients of a string in doubles | exact signs of the half period at the ends of each enclosure |
//! | survey | the same | exact signs about the thin tongues and a sample of the others; the counts by the same route again |
//! | closings | Newton's method and Krawczyk's test | exact signs at both ends of the range of ρ; the resultant of the mirror ratio |
//! | verdict | the filter, as a rule | the full period, kick by kick, in exact arithmetic |
//! | map | the filter, as a rule | a sample of pairs kick by kick; the counts by the same route again |
//! | compare | the half period kick by kick, and the tan criterion | the filter for every pair, the full period for every offender |
//! | curves | arcsines | arctangents; the samples again in doubles |
//! | polynomial | products of polynomials | the full period at rational points |
//! | proposition | Bézout's identity | eqs. (9) and (10) in integers |
//!
//! ```
//! use kickdrift::recheck::{Claim, Options};
//! let text = r#"{"schema": "kickdrift/proposition/1", "input": {"max": "2"}, "holds": true, "resonant_points": 1,
//!     "curves": 4, "failures": [], "witnesses": [{"p": 2, "q": 1, "m": 1, "a": 0, "b": 1}]}"#;
//! let outcome = Claim::read(text).unwrap().recheck(&Options::default(), None).unwrap();
//! assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
//! assert!(Claim::read(&text.replace("\"b\": 1", "\"b\": 0")).unwrap().recheck(&Options::default(), None).unwrap().failures[0].row == 1);
//! ```

mod closings;
mod compare;
mod curves;
mod exact;
mod map;
mod polynomial;
mod proposition;
mod sample;
mod survey;
mod tongues;
mod verdict;
mod written;

use std::sync::atomic::{AtomicU64, Ordering};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::error::{Error, Result};
use crate::parallel::*;
use crate::verdict::Limits;

/// How much is rechecked, and what one row may cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// The kicks that one verdict may compose.
    pub limits: Limits,
    /// Whether the slower route takes every pair or tongue of a map or a survey, and not a sample of them.
    pub all: bool,
}

/// What is shown of the progress: rows done, rows in all.
pub type See<'a> = &'a (dyn Fn(u64, u64) + Sync);

/// What a recheck found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The rows of the document; one where it has none.
    pub rows: u64,
    /// In words, how they were rechecked.
    pub route: &'static str,
    /// Where the slower route took a sample: so many, of so many.
    pub sample: Option<(u64, u64)>,
    /// What does not hold, in the order of the rows; last what concerns the whole document.
    pub failures: Vec<Failure>,
    /// The fields that were not rechecked, each with the reason.
    pub not_rechecked: Vec<&'static str>,
}

/// A row that does not hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Counted from 1; 0 for the document as a whole.
    pub row: u64,
    /// The row's name, as `p = 7, q = 3, m = 4`.
    pub place: String,
    /// What is wrong.
    pub why: String,
}

macro_rules! claims {
    ($($name:literal $variant:ident $module:ident;)*) => {
        /// A document in typed rows.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum Claim {
            $(#[doc = concat!("`kickdrift/", $name, "/1`.")] $variant(Box<$module::Claim>),)*
        }

        impl Claim {
            /// NAME of all documents `kickdrift/NAME/1` that can be rechecked.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// Reads a document: JSON into rows, each field once.
            ///
            /// # Errors
            /// A text that is no JSON, a schema that cannot be rechecked, a field that is missing, unknown or not
            /// what the schema says; named by its path.
            pub fn read(text: &str) -> Result<Claim> {
                let Head { schema } = typed(text)?;
                match schema.strip_prefix("kickdrift/").and_then(|rest| rest.strip_suffix("/1")) {
                    $(Some($name) => Ok(Claim::$variant(Box::new(typed(text)?))),)*
                    _ => {
                        let known = Claim::NAMES.join(", ");
                        let remedy = format!("can be rechecked: kickdrift/NAME/1, NAME one of {known}");
                        Err(Error::input("schema", schema, remedy))
                    }
                }
            }

            /// NAME in `kickdrift/NAME/1`.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Claim::$variant(_) => $name,)*
                }
            }

            fn check(&self, context: &Context) -> Result<Outcome> {
                match self {
                    $(Claim::$variant(claim) => claim.check(context),)*
                }
            }
        }
    };
}

claims! {
    "tongues" Tongues tongues;
    "closings" Closings closings;
    "survey" Survey survey;
    "verdict" Verdict verdict;
    "map" Map map;
    "compare" Compare compare;
    "curves" Curves curves;
    "polynomial" Polynomial polynomial;
    "proposition" Proposition proposition;
}

impl Claim {
    /// Rechecks every claim; progress is shown to `see`.
    ///
    /// # Errors
    /// Where a recheck costs more than the options allow; what does not hold is no error but a [`Failure`].
    pub fn recheck(&self, options: &Options, see: Option<See>) -> Result<Outcome> {
        self.check(&Context { options, see })
    }

    /// About how many kicks the slower route composes; 0 where that is not worth telling.
    ///
    /// # Errors
    /// An input of the document that makes no sense.
    pub fn work(&self, options: &Options) -> Result<u64> {
        match self {
            Claim::Map(claim) => claim.work(options),
            _ => Ok(0),
        }
    }
}

/// The only field that all documents have.
#[derive(Deserialize)]
struct Head {
    schema: String,
}

fn typed<T: DeserializeOwned>(text: &str) -> Result<T> {
    let read = serde_path_to_error::deserialize(&mut serde_json::Deserializer::from_str(text));
    read.map_err(|fault| {
        let (path, cause) = (fault.path().to_string(), fault.inner());
        let remedy = "whole documents, as kickdrift wrote them, can be rechecked";
        if cause.is_data() {
            Error::input(&path, "not what the schema says", format!("{cause}; {remedy}"))
        } else {
            Error::input("document", "no JSON", format!("{cause}; {remedy}"))
        }
    })
}

/// Why a row does not hold, or why that cannot be told.
enum Fault {
    Wrong(String),
    Error(Error),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Fault::Error(error)
    }
}

type Checked<T = ()> = std::result::Result<T, Fault>;

/// That something holds, or what is wrong.
fn holds(truth: bool, wrong: impl FnOnce() -> String) -> Checked {
    if truth { Ok(()) } else { Err(Fault::Wrong(wrong())) }
}

/// What holds all along, or what it is instead.
fn same<T: PartialEq + std::fmt::Display>(name: &str, told: T, truth: T) -> Checked {
    holds(told == truth, || format!("{name} is {truth}, not {told}"))
}

/// A row that can be named.
trait Place: Sync {
    fn place(&self) -> String;
}

/// A check at work.
struct Context<'a> {
    options: &'a Options,
    see: Option<See<'a>>,
}

impl Context<'_> {
    fn limits(&self) -> &Limits {
        &self.options.limits
    }

    /// Checks all rows, side by side: what does not hold, in their order.
    fn rows<T: Place>(&self, rows: &[T], check: impl Fn(&T) -> Checked + Sync) -> Result<Vec<Failure>> {
        let (done, of) = (AtomicU64::new(0), rows.len() as u64);
        let one = |(i, row): (usize, &T)| {
            let failure = self.failure(i as u64 + 1, || row.place(), check(row));
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            self.see.inspect(|see| see(done, of));
            failure
        };
        let found: Vec<_> = rows.par_iter().enumerate().map(one).collect::<Result<_>>()?;
        Ok(found.into_iter().flatten().collect())
    }

    fn failure(&self, row: u64, place: impl FnOnce() -> String, checked: Checked) -> Result<Option<Failure>> {
        match checked {
            Ok(()) => Ok(None),
            Err(Fault::Wrong(why)) => Ok(Some(Failure { row, place: place(), why })),
            Err(Fault::Error(error)) => Err(error),
        }
    }

    /// The outcome of a whole document (`whole`, named in words) and of its rows.
    fn outcome<T: Place>(
        &self,
        route: &'static str,
        (place, whole): (&str, Checked),
        rows: &[T],
        check: impl Fn(&T) -> Checked + Sync,
    ) -> Result<Outcome> {
        let whole = self.failure(0, || place.into(), whole)?;
        let mut failures = self.rows(rows, check)?;
        failures.extend(whole);
        let rows = rows.len() as u64;
        Ok(Outcome { rows, route, sample: None, failures, not_rechecked: Vec::new() })
    }
}
