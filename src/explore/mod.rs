//! The page that explores resonances: what it asks, and the answers.
//!
//! A person moves in the (h1, h2) plane and points at it; the page asks by an address below its own, such as
//! `point?lambda1=pi^2&lambda2=pi^2/25&h1=1/100&h2=49/50`, and [`ask`] answers. All quantities in addresses are exact texts; nothing is
//! remembered between two questions, so the same question has the same answer.
//!
//! | file | what is there |
//! |---|---|
//! | `session` | what a page starts on: stiffnesses, window, spacing, unit, a system |
//! | `query` | an address's parameters as typed quantities |
//! | `reply` | bytes and their type; errors as JSON |
//! | `assets` | the page itself |
//! | `start`, `tile`, `point` | one file a question |
//! | `serve` | the same over HTTP, for this machine alone (feature `explore`) |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//! use kickdrift::explore::{Session, ask};
//! let session = Session::figure1();
//! let reply = ask(&session, "point", "h1=1/100&h2=49/50", &AtomicBool::new(false)).unwrap();
//! assert_eq!(reply.status, 200);
//! let answer: serde_json::Value = serde_json::from_slice(&reply.bytes).unwrap();
//! assert_eq!((&answer["kind"], &answer["p"]), (&"hyperbolic".into(), &98.into()));
//! ```

mod assets;
#[cfg(feature = "explore")]
mod listen;
mod point;
mod query;
mod reply;
#[cfg(feature = "explore")]
pub mod serve;
mod session;
mod start;
mod tile;

use std::sync::atomic::AtomicBool;

use crate::error::Result;
pub use assets::asset;
use query::Query;
pub use reply::Reply;
pub use session::Session;

/// A question: its name, which is its address below the page's, whether it is answered at once (and so does not queue behind those
/// that take long), the kicks that it may cost, and who answers.
struct Question {
    name: &'static str,
    at_once: bool,
    limit: u64,
    answer: fn(&Session, &Query, &AtomicBool) -> Result<Reply>,
}

const QUESTIONS: [Question; 3] = [
    Question { name: "start", at_once: true, limit: 0, answer: start::answer },
    Question { name: "tile", at_once: false, limit: tile::MOST_KICKS, answer: tile::answer },
    Question { name: "point", at_once: true, limit: point::MOST_KICKS, answer: point::answer },
];

fn question(name: &str) -> Option<&'static Question> {
    QUESTIONS.iter().find(|question| question.name == name)
}

/// The answer to the question at `path` with the parameters of `query` (`key=value&...`, percent-encoded), an error's too; `None`
/// where there is no such question. Work ends soon after `stop` is set.
pub fn ask(session: &Session, path: &str, query: &str, stop: &AtomicBool) -> Option<Reply> {
    let question = question(path)?;
    let answer = Query::parse(query).and_then(|query| (question.answer)(session, &query, stop));
    Some(answer.unwrap_or_else(|error| Reply::refusal(&error, question.limit)))
}
