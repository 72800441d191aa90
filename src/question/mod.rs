//! What kickdrift is asked, typed: arguments, scenes, Python's keywords and the `input` of a document all become the same questions.
//!
//! A question cannot be wrong in its types; it is written as the `input` of its document, and read from there again.
//! [`Question::answer`] computes, [`Question::document`] shows what came out.
//!
//! ```
//! use kickdrift::question::{Fields, Proposition, Question, Work};
//! let question = Proposition { max: 5 };
//! let document = question.ask(&Work::default()).unwrap();
//! assert_eq!(document.value()["holds"], true);
//! // The document says what it answers.
//! let input = document.value()["input"].clone();
//! assert_eq!(Proposition::read(input.as_object().unwrap()).unwrap(), question);
//! ```
//!
//! A new question is a file of its own here, with its fields declared once by `question!`, and a line in each list of those who ask:
//! [`ask`] for Python and the page, the program's commands, the documents that `verify` reads.

mod asking;
mod field;

mod bands;
mod closings;
mod compare;
mod curves;
mod half;
mod polynomial;
mod proposition;
mod ratios;
mod survey;
mod tongues;
mod verdict;

pub(crate) use asking::question;
pub use asking::{Fields, Question, Watch, Work};
pub use bands::Bands;
pub use closings::Closings;
pub use compare::{Compare, Over};
pub use curves::Curves;
pub use field::{Notation, flag};
pub use half::Half;
pub use polynomial::Polynomial;
pub use proposition::Proposition;
pub use ratios::{MOST_SUM, Ratios};
pub use survey::{Survey, THINNEST};
pub use tongues::Tongues;
pub use verdict::Verdict;

use serde_json::{Map, Value};

use crate::error::{Error, Result};
use crate::report::document::Document;

/// The document that answers the question of this name, NAME in `kickdrift/NAME/1`, whose fields are those of the document's `input`.
///
/// ```
/// use kickdrift::question::{ask, Work};
/// let input = serde_json::json!({"ratio": "5/3"});
/// let document = ask("polynomial", input.as_object().unwrap(), &Work::default()).unwrap();
/// assert_eq!(document.value()["p"], 5);
/// ```
///
/// # Errors
/// An unknown name, and those of [`Fields::read`] and [`Question::answer`].
pub fn ask(name: &str, input: &Map<String, Value>, work: &Work) -> Result<Document> {
    fn one<Q: Question>(input: &Map<String, Value>, work: &Work) -> Result<Document> {
        Q::read(input)?.ask(work)
    }
    type Ask = fn(&Map<String, Value>, &Work) -> Result<Document>;
    const ALL: [(&str, Ask); 9] = [
        (Verdict::NAME, one::<Verdict>),
        (Curves::NAME, one::<Curves>),
        (Compare::NAME, one::<Compare>),
        (Proposition::NAME, one::<Proposition>),
        (Polynomial::NAME, one::<Polynomial>),
        (Half::NAME, one::<Half>),
        (Closings::NAME, one::<Closings>),
        (Survey::NAME, one::<Survey>),
        (Bands::NAME, one::<Bands>),
    ];
    match ALL.iter().find(|(known, _)| *known == name) {
        Some((_, answer)) => answer(input, work),
        None => {
            let names = ALL.map(|(name, _)| name).join(", ");
            Err(Error::input("question", name, format!("there are {names}")))
        }
    }
}
