//! A document of any kind in typed rows, and its check.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

#[cfg(feature = "advise")]
use super::advise;
use super::again::{Compared, Recheck, compare};
use super::context::{Context, Options, Outcome, REMEDY, See};
#[cfg(feature = "system")]
use super::system;
use super::{
    closings, compare as comparison, curves, map, polynomial, proposition, survey, tongues, verdict,
};
use crate::error::{Error, Result};
use crate::scene::json;

macro_rules! claims {
    ($($(#[$condition:meta])? $name:literal $variant:ident $claim:path;)*) => {
        #[derive(Clone, Debug)]
        enum Rows {
            $($(#[$condition])? $variant(Box<$claim>),)*
        }

        impl Rows {
            fn read(name: &str, document: Map<String, Value>) -> Option<Result<Rows>> {
                match name {
                    $($(#[$condition])? $name => Some(typed(document).map(|own| Rows::$variant(Box::new(own)))),)*
                    _ => None,
                }
            }

            fn recheck(&self, document: &Map<String, Value>, how: How, context: &Context) -> Result<Outcome> {
                match self {
                    $($(#[$condition])? Rows::$variant(rows) => recheck(rows.as_ref(), document, how, context),)*
                }
            }
        }

        impl Claim {
            /// NAME of all documents `kickdrift/NAME/1` that can be rechecked.
            pub const NAMES: &'static [&'static str] = &[$($(#[$condition])? $name),*];

            /// NAME in `kickdrift/NAME/1`.
            pub fn name(&self) -> &'static str {
                match self.rows {
                    $($(#[$condition])? Rows::$variant(_) => $name,)*
                }
            }
        }
    };
}

claims! {
    "tongues" Tongues tongues::Claim;
    "closings" Closings closings::Claim;
    "survey" Survey survey::Claim;
    "verdict" Verdict verdict::Claim;
    "map" Map map::Claim;
    "compare" Compare comparison::Claim;
    "curves" Curves curves::Claim;
    "polynomial" Polynomial polynomial::Claim;
    "proposition" Proposition proposition::Claim;
    #[cfg(feature = "advise")]
    "advise" Advise advise::Claim;
    #[cfg(feature = "advise")]
    "advise-system" AdviseSystem advise::Molecule;
    #[cfg(feature = "system")] "system-verdict" System system::Verdict;
    #[cfg(feature = "system")] "system-map" SystemMap system::Points;
    #[cfg(feature = "system")] "system-intervals" SystemIntervals system::Intervals;
    #[cfg(feature = "system")] "simulate" Simulate system::Simulated;
}

/// A document: as it stands, and in typed rows.
#[derive(Clone, Debug)]
pub struct Claim {
    document: Map<String, Value>,
    rows: Rows,
}

/// Whether the document is computed again and compared, before another route is taken.
#[derive(Clone, Copy, PartialEq)]
enum How {
    Both,
    OtherRouteAlone,
}

impl Claim {
    /// Reads a document: JSON into rows.
    ///
    /// # Errors
    /// A text that is no JSON, a schema that cannot be rechecked, a head that kickdrift does not write, a field that is
    /// missing or not what the schema says; named by its path.
    pub fn read(text: &str) -> Result<Claim> {
        let document: Map<String, Value> = json::from_str(text)
            .map_err(|cause| Error::input("document", "no JSON", format!("{cause}; {REMEDY}")))?;
        let schema = document.get("schema").cloned().unwrap_or_default();
        let name = schema.as_str().and_then(|name| name.strip_prefix("kickdrift/")?.strip_suffix("/1"));
        let mut rows = document.clone();
        rows.retain(|key, _| !["schema", "kickdrift"].contains(&key.as_str()));
        let Some(rows) = name.and_then(|name| Rows::read(name, rows)) else {
            let known = Claim::NAMES.join(", ");
            let remedy = format!("can be rechecked: kickdrift/NAME/1, NAME one of {known}");
            return Err(Error::input("schema", schema, remedy));
        };
        let rows = rows?;
        head(&document)?;
        Ok(Claim { document, rows })
    }

    /// Rechecks every claim: the document is computed again and compared value by value; where nothing differs, another
    /// route is taken. Progress is shown to `see`.
    ///
    /// # Errors
    /// An input that makes no sense, and a recheck that costs more than the options allow; what does not hold is no error
    /// but a [`Failure`](super::Failure).
    pub fn recheck(&self, options: &Options, see: Option<See>) -> Result<Outcome> {
        self.rows.recheck(&self.document, How::Both, &Context { options, see })
    }

    /// Takes the other route alone: it holds what is written against the mathematics, whichever version wrote it.
    ///
    /// # Errors
    /// As [`Claim::recheck`].
    pub fn recheck_apart(&self, options: &Options, see: Option<See>) -> Result<Outcome> {
        self.rows.recheck(&self.document, How::OtherRouteAlone, &Context { options, see })
    }

    /// About how many kicks the slower route composes; 0 where that is not worth telling.
    ///
    /// # Errors
    /// An input of the document that makes no sense.
    pub fn work(&self, options: &Options) -> Result<u64> {
        match &self.rows {
            Rows::Map(claim) => claim.work(options),
            _ => Ok(0),
        }
    }
}

fn recheck<R: Recheck>(
    rows: &R,
    document: &Map<String, Value>,
    how: How,
    context: &Context,
) -> Result<Outcome> {
    let (again, found) = rows.again(context)?;
    if how == How::OtherRouteAlone {
        return rows.check(found, context);
    }
    let Compared { failures, left } = compare(document, again, R::TABLE, R::LEFT);
    if failures.is_empty() {
        let mut outcome = rows.check(found, context)?;
        outcome.not_rechecked.splice(0..0, left);
        outcome.not_rechecked.push(QUESTION.into());
        return Ok(outcome);
    }
    let rows = document.get(R::TABLE).and_then(Value::as_array).map_or(1, |rows| rows.len() as u64);
    Ok(Outcome { rows, route: "computed again", sample: None, failures, not_rechecked: left })
}

/// What no recheck can find.
const QUESTION: &str = "that this was the question, where another one has the same answer";

/// That the head is one that kickdrift writes: which version and which command, and an input without nulls.
fn head(document: &Map<String, Value>) -> Result<()> {
    let own = document.get("kickdrift").and_then(Value::as_object);
    let text = |key: &str| own.and_then(|own| own.get(key)).is_some_and(Value::is_string);
    if !(text("version") && text("command") && own.is_some_and(|own| own.len() == 2)) {
        let given = document.get("kickdrift").cloned().unwrap_or_default();
        return Err(Error::input("kickdrift", given, format!("holds version and command; {REMEDY}")));
    }
    let input = document.get("input").and_then(Value::as_object);
    match input.into_iter().flatten().find(|(_, value)| value.is_null()) {
        Some((key, _)) => Err(Error::input(&format!("input.{key}"), "null", REMEDY)),
        None => Ok(()),
    }
}

/// All fields by their types; one that is wrong is named by its path.
fn typed<T: DeserializeOwned>(document: Map<String, Value>) -> Result<T> {
    serde_path_to_error::deserialize(Value::Object(document)).map_err(|fault| {
        let why = format!("{}; {REMEDY}", fault.inner());
        Error::input(&fault.path().to_string(), "not what the schema says", why)
    })
}
