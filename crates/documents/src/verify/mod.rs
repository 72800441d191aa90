//! Documents rechecked: computed again from their inputs, then held against the mathematics by another route
//! than the one that made them.
//!
//! One input gives one document, so whatever was changed afterwards differs from the document computed again:
//! every value is compared, and those that the input does not determine are named. What would be wrong from
//! the start is looked for by the other route.
//!
//! | document | made by | the other route |
//! |---|---|---|
//! | tongues | Rayleigh quotients of a string in doubles | exact signs of the half period at the ends of each enclosure |
//! | survey | the same | exact signs about the thin tongues and a sample of the others |
//! | closings | Newton's method and Krawczyk's test | exact signs at both ends of the range of ρ; the resultant of the mirror ratio |
//! | verdict | the filter, as a rule | the full period, kick by kick, in exact arithmetic |
//! | map | the filter, as a rule | a sample of pairs kick by kick |
//! | compare | the half period kick by kick, and the tan criterion | the filter for every pair, the full period for every offender |
//! | curves | arcsines | arctangents; the samples again in doubles |
//! | polynomial | products of polynomials | the full period at rational points |
//! | system-verdict, system-map, simulate | signs, discs, simulation | exact arithmetic; the dense full period |
//! | system-intervals | cells of signs, counts and discs | half periods at steps in the stretches, and the order of Krein's signs between; large schemes run |
//! | bands | a common cone of return maps, in doubles with bounds | pairs in the boxes, worst placed, by the ladder |
//! | compare-methods | polynomials in s, balls over y = h w/2 | traces letter by letter in doubles; those of trigonometric integrators by their formula |
//! | word, methods | polynomials in s, Sturm chains | letter by letter, in numbers of the field, at a step of each interval; halved steps |
//! | half | the half period, kick by kick | its determinant; the trace of the full period |
//! | run | the names of the products | none |
//! | proposition | Bézout's identity | eqs. (9) and (10) in integers |
//! | aperture | lanes of phases, a series for the exponential | letter by letter, phase by phase, with the platform's exponential |
//! | advise-direct | half periods in doubles, discs of eigenvalues | the dense full period in doubles |
//! | advise-system | definite forms, counts | the action over its paths; the full period kick by kick |
//! | advise | strings, orbits in balls | the full period in balls of 512 bits, pivots of the action |
//!
//! ```
//! use kickdrift_documents::verify::{Claim, Options};
//! let text = r#"{"schema": "kickdrift/proposition/1", "kickdrift": {"version": "0.1.0", "command": "proposition"},
//!     "input": {"max": "2"}, "holds": true, "resonant_points": 1, "curves": 5, "failures": [], "witnesses": [{"p": 2, "q": 1, "m": 1, "a": 0, "b": 1}]}"#;
//! let outcome = Claim::read(text).unwrap().recheck(&Options::default(), None).unwrap();
//! assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
//! // Another b, and the first row fails.
//! let outcome = Claim::read(&text.replace("\"b\": 1", "\"b\": 0")).unwrap().recheck(&Options::default(), None).unwrap();
//! assert_eq!(outcome.failures[0].row, 1);
//! ```

/// Rows of documents: what the other route needs of them. A field `T | null` must be there and may be null,
/// one of type `Option` may be missing. An input knows all of its fields. A row is named by the fields in
/// brackets.
macro_rules! rows {
    ($(
        $(#[$row:meta])*
        $visible:vis struct $name:ident $([$($by:ident),*])? {
            $($(#[$attribute:meta])* $seen:vis $field:ident: $type:ty $(| $null:ident)?,)*
        }
    )*) => {
        $(
            #[derive(Clone, Debug, serde::Deserialize)]
            $(#[$row])*
            $visible struct $name {
                $(
                    $(#[$attribute])*
                    $(#[doc = stringify!($null)] #[serde(deserialize_with = "crate::verify::written::nullable")])?
                    $seen $field: rows!(@type $type $(, $null)?),
                )*
            }

            $(impl $crate::verify::context::Place for $name {
                fn place(&self) -> String {
                    [$(format!(concat!(stringify!($by), " = {}"), self.$by)),*].join(", ")
                }
            })?
        )*
    };
    (@type $type:ty) => { $type };
    (@type $type:ty, $null:ident) => { Option<$type> };
}

mod advise;
mod again;
mod aperture;
mod bands;
mod closings;
mod compare;
mod context;
mod curves;
mod exact;
mod half;
mod map;
mod polynomial;
mod proposition;
mod run;
mod sample;
mod side;
mod survey;
mod system;
mod tongues;
mod verdict;
mod word;
mod written;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use serde_path_to_error::{Path, Segment};

use self::again::{Compared, Recheck, compare};
use self::context::{Context, REMEDY};
use crate::input::json;
use crate::input::kind::{is_asked, of_another_kind};
use number::error::{Error, Result};

pub use context::{Failure, Options, Outcome, See};

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

            fn again(&self, document: &Map<String, Value>, context: &Context) -> Result<Option<Again>> {
                match self {
                    $($(#[$condition])? Rows::$variant(rows) => again(rows.as_ref(), document, context),)*
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
    "compare" Compare compare::Claim;
    "compare-methods" CompareMethods side::Claim;
    "curves" Curves curves::Claim;
    "polynomial" Polynomial polynomial::Claim;
    "proposition" Proposition proposition::Claim;
    "run" Run run::Claim;
    "half" Half half::Claim;
    "bands" Bands bands::Claim;
    "word" Word word::Claim;
    "methods" Methods word::Listed;
    "advise" Advise advise::Claim;
    "advise-system" AdviseSystem advise::Molecule;
    "advise-direct" AdviseDirect advise::Direct;
    "system-verdict" System system::Claim;
    "system-map" SystemMap system::Claim;
    "system-intervals" SystemIntervals system::intervals::Claim;
    "simulate" Simulate system::Simulated;
    "aperture" Aperture aperture::Claim;
}

/// A document: as it stands, and in typed rows.
#[derive(Clone, Debug)]
pub struct Claim {
    document: Map<String, Value>,
    rows: Rows,
}

/// A document computed again from its input, against which others of the same input can be held.
#[derive(Clone, Debug)]
pub struct Again {
    document: Value,
    /// The schema and the input of the document that it was computed from.
    head: [Option<Value>; 2],
    compare: fn(&Map<String, Value>, Value) -> Compared,
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
    /// A text that is no JSON, a schema that cannot be rechecked, a head that kickdrift does not write, a
    /// field that is missing or not what the schema says; named by its path.
    pub fn read(text: &str) -> Result<Claim> {
        let document: Map<String, Value> =
            json::from_str(text).map_err(|cause| Error::input("document", "no JSON", not_json(&cause)))?;
        let schema = document.get("schema").cloned().unwrap_or_default();
        let name = schema.as_str().and_then(|name| name.strip_prefix("kickdrift/")?.strip_suffix("/1"));
        let mut rows = document.clone();
        rows.retain(|key, _| !["schema", "kickdrift"].contains(&key.as_str()));
        let Some(rows) = name.and_then(|name| Rows::read(name, rows)) else {
            if let Some(schema) = schema.as_str().filter(|schema| is_asked(schema)) {
                return Err(of_another_kind(schema, "answers"));
            }
            let known = Claim::NAMES.join(", ");
            let remedy = format!("can be rechecked: kickdrift/NAME/1, NAME one of {known}");
            return Err(Error::input("schema", schema, remedy));
        };
        let rows = rows?;
        head(&document)?;
        Ok(Claim { document, rows })
    }

    /// Rechecks every claim: the document is computed again and compared value by value; where nothing
    /// differs, another route is taken. Progress is shown to `see`.
    ///
    /// # Errors
    /// An input that makes no sense, and a recheck that costs more than the options allow; what does not hold
    /// is no error but a [`Failure`].
    pub fn recheck(&self, options: &Options, see: Option<See>) -> Result<Outcome> {
        self.rows.recheck(&self.document, How::Both, &Context::new(options, see))
    }

    /// Takes the other route alone: it holds what is written against the mathematics, whichever version wrote
    /// it.
    ///
    /// # Errors
    /// As [`Claim::recheck`].
    pub fn recheck_apart(&self, options: &Options, see: Option<See>) -> Result<Outcome> {
        self.rows.recheck(&self.document, How::OtherRouteAlone, &Context::new(options, see))
    }

    /// The document computed again from its input, for [`Claim::apart`]; `None` of a kind whose rows say what
    /// was asked, too.
    ///
    /// # Errors
    /// As [`Claim::recheck`].
    pub fn again(&self, options: &Options) -> Result<Option<Again>> {
        self.rows.again(&self.document, &Context::new(options, None))
    }

    /// The first part of [`Claim::recheck`] against a document that was computed again before: the values
    /// that differ. `None` where that one has another schema or another input.
    pub fn apart(&self, again: &Again) -> Option<Vec<Failure>> {
        let alike = again.head == asked_in(&self.document);
        alike.then(|| (again.compare)(&self.document, again.document.clone()).failures)
    }

    /// About how many kicks the slower route composes; 0 where these are few.
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
    let Compared { failures, left } = compared::<R>(document, again);
    if failures.is_empty() {
        let mut outcome = rows.check(found, context)?;
        outcome.not_rechecked.splice(0..0, left);
        outcome.not_rechecked.push(QUESTION.into());
        return Ok(outcome);
    }
    let rows = document.get(R::TABLE).and_then(Value::as_array).map_or(1, |rows| rows.len() as u64);
    Ok(Outcome { rows, route: "computed again", sample: None, failures, not_rechecked: left })
}

fn again<R: Recheck>(rows: &R, object: &Map<String, Value>, context: &Context) -> Result<Option<Again>> {
    let by_input = (!R::READS_ROWS).then(|| rows.again(context)).transpose()?;
    Ok(by_input.map(|(document, _)| Again { document, head: asked_in(object), compare: compared::<R> }))
}

fn asked_in(document: &Map<String, Value>) -> [Option<Value>; 2] {
    ["schema", "input"].map(|key| document.get(key).cloned())
}

fn compared<R: Recheck>(document: &Map<String, Value>, again: Value) -> Compared {
    compare(document, again, R::TABLE, R::LEFT)
}

/// The limit of every recheck.
const QUESTION: &str = "that this was the question, where another one has the same answer";

/// That the head is one that kickdrift writes: which version and which command, and an input without nulls.
fn head(document: &Map<String, Value>) -> Result<()> {
    let object = document.get("kickdrift").and_then(Value::as_object);
    let text = |key: &str| object.and_then(|object| object.get(key)).is_some_and(Value::is_string);
    if !(text("version") && text("command") && object.is_some_and(|object| object.len() == 2)) {
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
    let whole = Value::Object(document);
    serde_path_to_error::deserialize(&whole).map_err(|fault| {
        let path = fault.path().to_string();
        let why = format!("{}; {REMEDY}", json::plain(fault.inner()));
        match at(&whole, fault.path()) {
            Some(value) if !value.is_object() && !value.is_array() => Error::input(&path, value, why),
            _ => {
                let field = if path == "." { "document" } else { &path };
                Error::input(field, "not as kickdrift writes it", why)
            }
        }
    })
}

/// The value at a path.
fn at<'a>(whole: &'a Value, path: &Path) -> Option<&'a Value> {
    path.iter().try_fold(whole, |value, step| match step {
        Segment::Map { key } => value.get(key),
        Segment::Seq { index } => value.get(index),
        _ => None,
    })
}

fn not_json(cause: &serde_json::Error) -> String {
    format!("line {}, column {}: {}; {REMEDY}", cause.line(), cause.column(), json::plain(cause))
}
