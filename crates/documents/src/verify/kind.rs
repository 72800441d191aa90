//! A kind of documents: how its question is read and answered again, and the other route to the answer.

use serde_json::{Map, Value};

use super::again::Excluded;
use super::context::{Context, Outcome, REMEDY};
use crate::question::{Fields, Question};
use number::{Error, Result};

/// A question whose answers are held against another route.
pub trait Verify: Question {
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
pub fn asked<Q: Fields>(document: &Map<String, Value>) -> Result<Q> {
    Q::read(input(document)?).map_err(|error| not_as_written("input", &error.to_string()))
}

/// The `input` of a document.
fn input(document: &Map<String, Value>) -> Result<&Map<String, Value>> {
    match document.get("input") {
        None => Err(not_as_written("document", "missing field `input`")),
        Some(Value::Object(input)) => Ok(input),
        Some(Value::Array(_)) => Err(not_as_written("input", "found a list where an object belongs")),
        Some(other) => {
            let name = match other {
                Value::String(_) => "the text ",
                Value::Number(_) => "the number ",
                _ => "",
            };
            Err(Error::input(
                "input",
                other,
                format!("found {name}{other} where an object belongs; {REMEDY}"),
            ))
        }
    }
}

fn not_as_written(field: &str, why: &str) -> Error {
    Error::input(field, "not as kickdrift writes it", format!("{why}; {REMEDY}"))
}
