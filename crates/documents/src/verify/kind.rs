//! A kind of documents: how its question is read and answered again, and the other route to the answer.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use serde_path_to_error::{Path, Segment};

use super::again::Excluded;
use super::context::{Context, Outcome, REMEDY};
use crate::input::json;
use crate::question::Question;
use number::error::{Error, Result};

/// A question whose answers are held against another route.
pub trait Verify: Question + DeserializeOwned {
    /// Values of its documents that the input does not determine.
    const EXCLUDED: &'static [Excluded] = &[];

    /// The outcome of the other route. The answer is typed: its document is equal to the one that is checked.
    fn check(&self, answer: &Self::Answer, context: &Context) -> Result<Outcome>;
}

/// The other route, once nothing differs from the document computed again.
pub type Check<'a> = Box<dyn FnOnce() -> Result<Outcome> + 'a>;

/// The document computed again, and the other route.
pub type Again<'a> = (Value, Check<'a>);

/// Documents of one kind.
#[derive(Debug)]
pub struct Kind {
    /// NAME in `kickdrift/NAME/1`.
    pub name: &'static str,
    /// The key of the rows; empty where the document is one row itself.
    pub table: &'static str,
    pub excluded: &'static [Excluded],
    /// Whether the input alone says what was asked.
    pub by_input: bool,
    /// That the question can be read.
    pub read: fn(&Map<String, Value>) -> Result<()>,
    pub again: for<'a> fn(&Map<String, Value>, &'a Context<'a>) -> Result<Again<'a>>,
}

impl Kind {
    pub const fn of<Q: Verify + 'static>(name: &'static str, table: &'static str) -> Kind {
        Kind {
            name,
            table,
            excluded: Q::EXCLUDED,
            by_input: true,
            read: |document| asked::<Q>(document).map(drop),
            again: |document, context| {
                let question: Q = asked(document)?;
                let answer = question.answer(&context.work())?;
                let document = question.document(&answer).value();
                Ok((document, Box::new(move || question.check(&answer, context))))
            },
        }
    }
}

/// The question in a document.
pub fn asked<Q: DeserializeOwned>(document: &Map<String, Value>) -> Result<Q> {
    #[derive(Deserialize)]
    struct Input<Q> {
        input: Q,
    }
    let input = document.iter().filter(|(key, _)| *key == "input");
    typed(input.map(|(key, value)| (key.clone(), value.clone())).collect()).map(|Input { input }| input)
}

/// All fields by their types; one that is wrong is named by its path.
pub fn typed<T: DeserializeOwned>(document: Map<String, Value>) -> Result<T> {
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
