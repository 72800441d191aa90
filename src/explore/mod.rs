//! The page that explores resonances: what it asks, and the answers.
//!
//! A person moves in the (h1, h2) plane and points at it; the page asks by an address below its own, such as
//! `point?lambda1=pi^2&lambda2=pi^2/25&h1=1/100&h2=49/50`, and [`ask`] answers. All quantities in addresses
//! are exact texts; nothing is remembered between two questions, so the same question has the same answer.
//!
//! | file | what is there |
//! |---|---|
//! | `session` | what a page starts on: stiffnesses, window, spacing, unit, a system |
//! | `query` | an address's parameters as typed quantities |
//! | `reply` | bytes and their type; errors as JSON |
//! | `assets` | the page itself |
//! | `frame` | a window: places in it as fractions, at any depth |
//! | `rays`, `ray` | the ratios that a window shows; the tongues of one about a point |
//! | `start`, `tile`, `tongues`, `curves`, `point`, `cut`, `strip`, `outer`, `shown` | one file a question, or a few that are alike |
//! | `serve` | the same over HTTP, for this machine alone |
//!
//! ```
//! use std::sync::Arc;
//! use kickdrift::explore::{Session, ask};
//! let session = Session::figure1();
//! let reply = ask(&session, "point", "h1=1/100&h2=49/50", &Arc::default()).unwrap();
//! assert_eq!(reply.status, 200);
//! let answer: serde_json::Value = serde_json::from_slice(&reply.bytes).unwrap();
//! assert_eq!((&answer["kind"], &answer["p"]), (&"hyperbolic".into(), &98.into()));
//! ```

mod assets;
mod curves;
mod cut;
mod frame;
mod listen;
mod outer;
mod point;
mod query;
mod ray;
mod rays;
mod reply;
pub mod serve;
mod session;
mod shown;
mod start;
mod strip;
mod tile;
mod tongues;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

pub use assets::asset;
use number::Result;
use number::parallel::stoppable;
use query::Query;
pub use reply::Reply;
pub use session::Session;

/// A question: its name, which is its address below the page's, whether it is answered at once (and so does
/// not queue behind those that take long), the kicks that it may cost, and who answers.
struct Question {
    name: &'static str,
    at_once: bool,
    limit: u64,
    answer: Answer,
}

const QUESTIONS: [Question; 14] = [
    question("start", true, 0, start::answer),
    question("tile", false, tile::MOST_KICKS, tile::answer),
    question("tongues", false, tongues::MOST_KICKS, tongues::answer),
    question("curves", true, 0, curves::answer),
    question("point", true, point::MOST_KICKS, point::answer),
    question("document", true, point::MOST_KICKS, point::document),
    question("certificate", true, point::MOST_CERTIFIED, point::certificate),
    question("cut", false, point::MOST_KICKS, cut::answer),
    question("strip", false, strip::MOST_KICKS, strip::answer),
    question("system", false, outer::MOST_PRODUCTS, outer::answer),
    question("stretches", false, outer::MOST_PRODUCTS, outer::stretches),
    question("modes", false, outer::MOST_PRODUCTS, outer::modes),
    question("scene", true, 0, shown::scene),
    question("picture", false, shown::MOST_KICKS, shown::picture),
];

/// Who answers a question.
type Answer = fn(&Session, &Query) -> Result<Reply>;

const fn question(name: &'static str, at_once: bool, limit: u64, answer: Answer) -> Question {
    Question { name, at_once, limit, answer }
}

fn named(name: &str) -> Option<&'static Question> {
    QUESTIONS.iter().find(|question| question.name == name)
}

/// No question is to be worked on for longer: what it costs is bounded before, but far beyond the Verlet
/// limit, where doubles overflow, pairs take the slower tiers. Who asks sets the flag then, and has
/// [`overdue`] for an answer.
pub const LONGEST: Duration = Duration::from_secs(30);

/// The answer to a question at `path` that took longer than [`LONGEST`].
pub fn overdue(path: &str) -> Reply {
    let limit = named(path).map_or(0, |question| question.limit);
    Reply::too_costly(None, limit, "this takes longer than half a minute")
}

/// The answer to the question at `path` with the parameters of `query` (`key=value&...`, percent-encoded), an
/// error's too; `None` where there is no such question. Work ends soon after `stop` is set.
pub fn ask(session: &Session, path: &str, query: &str, stop: &Arc<AtomicBool>) -> Option<Reply> {
    let question = named(path)?;
    let answer = || (question.answer)(session, &Query::parse(query)?);
    Some(stoppable(stop, answer).unwrap_or_else(|error| Reply::refusal(&error, question.limit)))
}
