//! Questions, typed: arguments, scenes, Python's keywords and the `input` of a document all become the same
//! ones.
//!
//! A question cannot be wrong in its types; it is written as the `input` of its document, and read from there
//! again. [`Question::answer`] computes, [`Question::document`] shows what came out.
//!
//! ```
//! use kickdrift_documents::question::{Fields, Proposition, Question, Work};
//! let question = Proposition { max: 5 };
//! let document = question.ask(&Work::default()).unwrap();
//! assert_eq!(document.value()["holds"], true);
//! // The document says what it answers.
//! let input = document.value()["input"].clone();
//! assert_eq!(Proposition::read(input.as_object().unwrap()).unwrap(), question);
//! ```
//!
//! A new question is a file of its own here, with its fields declared once by `question!`, and a line in each
//! list of those who ask: [`ask`] for Python and the page, the program's commands, the documents that
//! `verify` reads.

mod advise;
mod advised;
mod asking;
mod field;

mod aperture;
mod bands;
mod claims;
mod closings;
mod compare;
mod curves;
mod half;
mod map;
mod polynomial;
mod proposition;
mod ratios;
mod scene;
mod side;
mod simulate;
mod survey;
mod system;
mod tongues;
mod verdict;
mod want;
mod word;

pub use advise::Advise;
pub use advised::{Advised, Safe};
pub use aperture::Aperture;
pub(crate) use asking::question;
pub use asking::{Fields, Question, Watch, Work};
pub use bands::Bands;
pub use claims::{Checked, Claimed, Claims, Held, WordCheck};
pub use closings::{Closings, DIGITS};
pub use compare::{Compare, Over};
pub use curves::Curves;
pub use field::{Field, NEEDED, Notation, StepRange, flag, shown_range};
pub use half::Half;
pub use map::Map;
pub use polynomial::{Polynomial, Polynomials};
pub use proposition::Proposition;
pub use ratios::{MOST_SUM, RatioList, Ratios};
pub use scene::{FAMILIES, LONGEST_SCENE, Made, Products, Scene};
pub use side::{CompareMethods, Side};
pub use simulate::{Displacement, Simulate, Simulated};
pub use survey::{Survey, THINNEST};
pub use system::{System, SystemAnswer, SystemFound, SystemVerdict};
pub use tongues::{Colour, Columns, Form, FoundTongues, Tongues};
pub use verdict::{Decided, Verdict};
pub use want::{Product, Want};
pub use word::{Best, Family, Goal, Linted, Member, Members, Methods, Parameter, Parameters, Word};
pub(crate) use word::{Listed, Span};

use serde_json::{Map as Input, Value};

use crate::report::document::Document;
use crate::report::shape::{Keys, Schema};
use number::{Error, Result};

/// The document that answers the question of this name, NAME in `kickdrift/NAME/1`, whose fields are those of
/// the document's `input`.
///
/// ```
/// use kickdrift_documents::question::{ask, Work};
/// let input = serde_json::json!({"ratio": "5/3"});
/// let document = ask("polynomial", input.as_object().unwrap(), &Work::default()).unwrap();
/// assert_eq!(document.value()["p"], 5);
/// ```
///
/// # Errors
/// An unknown name, and those of [`Fields::read`] and [`Question::answer`].
pub fn ask(name: &str, input: &Input<String, Value>, work: &Work) -> Result<Document> {
    (named(name)?.ask)(input, work)
}

/// The figure of the same answer; `None` where this is nothing to draw.
///
/// # Errors
/// As [`ask`], and those of [`Question::figure`].
pub fn draw(name: &str, input: &Input<String, Value>, work: &Work) -> Result<Option<plot::Figure>> {
    (named(name)?.draw)(input, work)
}

/// The schemas of the documents that say what they hold, by their names.
pub fn schemas() -> Vec<(&'static str, Value)> {
    ALL.iter()
        .flat_map(|known| (known.schemas)())
        .map(|(name, schema, input)| (name, schema.value(name, &input)))
        .collect()
}

/// The questions by their names, each with the schema of its fields as a person may type them.
pub fn fields() -> Vec<(&'static str, Value)> {
    ALL.iter().map(|known| (known.name, (known.fields)())).collect()
}

fn fields_of<Q: Fields>() -> Value {
    let mut schema = Schema::new("", Keys::new()).value("", &Q::keys());
    let (defs, mut input) = (schema["$defs"].take(), schema["properties"]["input"].take());
    for (name, default) in Q::defaults() {
        input["properties"][name]["default"] = default.into();
    }
    input["required"] = Q::required().into();
    if !defs.is_null() {
        input["$defs"] = defs;
    }
    without_patterns(&mut input);
    input
}

/// Patterns are of exact numbers as documents echo them; 0.98 and 1e-3 are read as well.
fn without_patterns(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            map.retain(|key, value| key != "pattern" || !value.is_string());
            map.values_mut().for_each(without_patterns);
        }
        Value::Array(all) => all.iter_mut().for_each(without_patterns),
        _ => {}
    }
}

/// A question that is read from its fields.
struct Named {
    name: &'static str,
    ask: fn(&Input<String, Value>, &Work) -> Result<Document>,
    draw: fn(&Input<String, Value>, &Work) -> Result<Option<plot::Figure>>,
    schemas: fn() -> Vec<(&'static str, Schema, Keys)>,
    fields: fn() -> Value,
}

impl Named {
    const fn of<Q: Question>() -> Named {
        Named {
            name: Q::NAME,
            ask: |input, work| Q::read(input)?.ask(work),
            draw: |input, work| {
                let question = Q::read(input)?;
                question.figure(&question.answer(work)?, work)
            },
            schemas: Q::schemas,
            fields: fields_of::<Q>,
        }
    }
}

const ALL: &[Named] = &[
    Named::of::<Verdict>(),
    Named::of::<Map>(),
    Named::of::<Tongues>(),
    Named::of::<Curves>(),
    Named::of::<Compare>(),
    Named::of::<CompareMethods>(),
    Named::of::<Proposition>(),
    Named::of::<Polynomial>(),
    Named::of::<Half>(),
    Named::of::<Closings>(),
    Named::of::<Survey>(),
    Named::of::<Bands>(),
    Named::of::<Word>(),
    Named::of::<Methods>(),
    Named::of::<WordCheck>(),
    Named::of::<Family>(),
    Named::of::<System>(),
    Named::of::<Simulate>(),
    Named::of::<Advise>(),
    Named::of::<Aperture>(),
    Named::of::<Scene>(),
];

fn named(name: &str) -> Result<&'static Named> {
    ALL.iter().find(|known| known.name == name).ok_or_else(|| {
        let names: Vec<&str> = ALL.iter().map(|known| known.name).collect();
        Error::input("question", name, format!("there are {}", names.join(", ")))
    })
}
