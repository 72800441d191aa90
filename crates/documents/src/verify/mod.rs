//! Documents verified: computed again from their inputs, then held against the mathematics by another route
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
//! | curves | arcsines | arctangents; pieces in the window by their branches' heights in doubles |
//! | polynomial | products of polynomials | the full period at rational points |
//! | system-verdict, system-map, simulate | signs, discs, simulation | exact arithmetic; the dense full period |
//! | system-intervals | cells of signs, counts and discs | half periods at steps in the stretches, and the order of Krein's signs between; large schemes run |
//! | bands | a common cone of return maps, in doubles with bounds | pairs in the boxes, worst placed, by the ladder |
//! | compare-methods | polynomials in s, balls over y = h w/2 | the trace at each point letter by letter in doubles; those of trigonometric integrators by their formula |
//! | word, methods, word-check | polynomials in s, Sturm chains | letter by letter, in numbers of the field, at a step of each interval; halved steps |
//! | half | the half period, kick by kick | its determinant; the trace of the full period |
//! | run | the names of the products | none |
//! | proposition | Bézout's identity | eqs. (9) and (10) in integers |
//! | aperture | lanes of phases, a series for the exponential | letter by letter, phase by phase, with the platform's exponential |
//! | advise-direct | half periods in doubles, discs of eigenvalues | the dense full period in doubles |
//! | advise-system | definite forms, counts | the action over its paths; the full period kick by kick |
//! | advise | strings, orbits in balls | the full period in balls of 512 bits, pivots of the action |
//!
//! ```
//! use kickdrift_documents::verify::{CheckedDocument, Options};
//! let text = r#"{"schema": "kickdrift/proposition/1", "kickdrift": {"version": "0.1.0", "command": "proposition"},
//!     "input": {"max": "2"}, "holds": true, "resonant_points": 1, "curves": 5, "failures": [], "witnesses": [{"p": 2, "q": 1, "m": 1, "a": 0, "b": 1}]}"#;
//! let outcome = CheckedDocument::read(text).unwrap().verify(&Options::default(), None).unwrap();
//! assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
//! // Another b, and the first row fails.
//! let forged = CheckedDocument::read(&text.replace("\"b\": 1", "\"b\": 0")).unwrap();
//! assert_eq!(forged.verify(&Options::default(), None).unwrap().failures[0].row, 1);
//! ```

mod advise;
mod again;
mod aperture;
mod bands;
mod bias;
mod closings;
mod compare;
mod context;
mod curves;
mod exact;
#[cfg(test)]
mod forged;
mod half;
mod kind;
mod map;
mod polynomial;
mod proposition;
mod run;
mod sample;
mod side;
mod survey;
mod system;
mod told;
mod tongues;
mod verdict;
mod word;

use serde_json::{Map, Value};

use self::again::{Compared, compare, place};
use self::context::{Context, REMEDY};
use self::kind::{Kind, asked};
use crate::input::json;
use crate::input::kind::{is_asked, of_another_kind};
use crate::question::{
    Advised, Aperture, Bands, Closings, Compare, CompareMethods, Curves, Family, Half, Methods, Polynomial,
    Proposition, Simulate, Survey, System, Tongues, Verdict, Word, WordCheck,
};
use number::{Error, Result};

pub use context::{Failure, Options, Outcome, Progress};
pub use told::schema;

/// All documents that can be verified.
const KINDS: &[Kind] = &[
    Kind::of::<Tongues>("tongues", "tongues"),
    Kind::of::<Closings>("closings", "closings"),
    Kind::of::<Survey>("survey", "thinnest"),
    Kind::of::<Verdict>("verdict", ""),
    map::KIND,
    Kind::of::<Compare>("compare", "offenders"),
    Kind::of::<CompareMethods>("compare-methods", "methods"),
    Kind::of::<Curves>("curves", "curves"),
    Kind::of::<Polynomial>("polynomial", "terms"),
    Kind::of::<Proposition>("proposition", "witnesses"),
    run::KIND,
    Kind::of::<Half>("half", "entries"),
    Kind::of::<Bands>("bands", "sectors"),
    Kind::of::<Word>("word", "intervals"),
    Kind::of::<Methods>("methods", "methods"),
    Kind::of::<WordCheck>("word-check", "checks"),
    Kind::of::<Family>("family", "members"),
    Kind::of::<Advised>("advise", "rows"),
    Kind::of::<Advised>("advise-system", "rows"),
    Kind::of::<Advised>("advise-direct", "rows"),
    Kind::of::<System>("system-verdict", "rows"),
    Kind::of::<System>("system-map", "rows"),
    Kind::of::<System>("system-intervals", "stretches"),
    Kind::of::<Simulate>("simulate", "series"),
    Kind::of::<Aperture>("aperture", "steps"),
];

/// A document that is to be verified.
#[derive(Clone, Debug)]
pub struct CheckedDocument {
    document: Map<String, Value>,
    kind: &'static Kind,
}

/// A document computed again from its input, against which others of the same input can be held.
#[derive(Clone, Debug)]
pub struct Recomputed {
    document: Value,
    /// The schema and the input of the document that it was computed from.
    head: [Option<Value>; 2],
}

impl CheckedDocument {
    /// Reads a document and its question.
    ///
    /// # Errors
    /// A text that is no JSON, a schema that cannot be verified, a head that kickdrift does not write, a
    /// field of the input that is missing or wrong; named by its path.
    pub fn read(text: &str) -> Result<CheckedDocument> {
        let document: Map<String, Value> =
            json::from_str(text).map_err(|cause| Error::input("document", "no JSON", not_json(&cause)))?;
        let schema = document.get("schema").cloned().unwrap_or_default();
        let name = schema.as_str().and_then(|name| name.strip_prefix("kickdrift/")?.strip_suffix("/1"));
        let Some(kind) = name.and_then(|name| KINDS.iter().find(|kind| kind.name == name)) else {
            if let Some(schema) = schema.as_str().filter(|schema| is_asked(schema)) {
                return Err(of_another_kind(schema, "answers"));
            }
            let known = KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>().join(", ");
            let remedy = format!("can be rechecked: kickdrift/NAME/1, NAME one of {known}");
            return Err(Error::input("schema", schema, remedy));
        };
        (kind.read)(&document)?;
        head(&document)?;
        Ok(CheckedDocument { document, kind })
    }

    /// NAME in `kickdrift/NAME/1`.
    pub fn name(&self) -> &'static str {
        self.kind.name
    }

    /// Computes the document again and compares it value by value; where nothing differs, another route is
    /// taken to the answer. Progress is shown to `progress`.
    ///
    /// # Errors
    /// An input that makes no sense, and a check that costs more than the options allow; what does not hold
    /// is no error but a [`Failure`].
    pub fn verify(&self, options: &Options, progress: Option<Progress>) -> Result<Outcome> {
        let context = Context::new(options, progress);
        let (again, check) = (self.kind.again)(&self.document, &context)?;
        let Compared { failures, excluded } = self.compare(again);
        if !failures.is_empty() {
            let (rows, route) = (self.rows().map_or(1, |rows| rows.len() as u64), "computed again");
            return Ok(Outcome { failures, not_rechecked: excluded, ..Outcome::holding(route, rows) });
        }
        let mut outcome = check()?;
        for failure in outcome.failures.iter_mut().filter(|failure| failure.place.is_empty()) {
            failure.place = self.row(failure.row).map(place).unwrap_or_default();
        }
        outcome.not_rechecked.splice(0..0, excluded);
        outcome.not_rechecked.push(QUESTION.into());
        Ok(outcome)
    }

    /// The document computed again from its input, for [`CheckedDocument::differences`]; `None` of a kind
    /// whose rows say what was asked, too.
    ///
    /// # Errors
    /// As [`CheckedDocument::verify`].
    pub fn recompute(&self, options: &Options) -> Result<Option<Recomputed>> {
        let context = Context::new(options, None);
        let again = || (self.kind.again)(&self.document, &context);
        let by_input = self.kind.by_input.then(again).transpose()?;
        Ok(by_input.map(|(document, _)| Recomputed { document, head: asked_in(&self.document) }))
    }

    /// The first part of [`CheckedDocument::verify`] against a document that was computed again before: the
    /// values that differ. `None` where that one has another schema or another input.
    pub fn differences(&self, again: &Recomputed) -> Option<Vec<Failure>> {
        let alike = again.head == asked_in(&self.document);
        alike.then(|| self.compare(again.document.clone()).failures)
    }

    /// About how many kicks the slower route composes; 0 where these are few.
    ///
    /// # Errors
    /// An input of the document that makes no sense.
    pub fn work(&self, options: &Options) -> Result<u64> {
        if self.kind.name == map::KIND.name { map::work(&asked(&self.document)?, options) } else { Ok(0) }
    }

    fn compare(&self, again: Value) -> Compared {
        compare(&self.document, again, self.kind.table, self.kind.excluded)
    }

    fn rows(&self) -> Option<&Vec<Value>> {
        self.document.get(self.kind.table)?.as_array()
    }

    /// A row by its number from 1; of a document without rows that is the document itself.
    fn row(&self, number: u64) -> Option<&Map<String, Value>> {
        let place = usize::try_from(number).ok()?.checked_sub(1)?;
        if self.kind.table.is_empty() { Some(&self.document) } else { self.rows()?.get(place)?.as_object() }
    }
}

fn asked_in(document: &Map<String, Value>) -> [Option<Value>; 2] {
    ["schema", "input"].map(|key| document.get(key).cloned())
}

/// The limit of every check.
const QUESTION: &str = "which question was asked, where another one has the same answer";

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

fn not_json(cause: &serde_json::Error) -> String {
    format!("line {}, column {}: {}; {REMEDY}", cause.line(), cause.column(), json::plain(cause))
}
