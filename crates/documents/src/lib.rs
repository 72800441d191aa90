//! What is asked and what is answered, as documents: questions, inputs, tables and figures, and documents
//! verified.
//!
//! | type | what it is |
//! |---|---|
//! | [`Question`](question::Question) | a type whose fields are declared once: arguments, keywords and a document's `input` are read into it |
//! | [`Work`](question::Work) | what an answer may cost, who is told how far it is, where arrays are |
//! | [`Record`](report::record::Record) | what is written about one thing: keys in JSON, columns in tables |
//! | [`Document`](report::document::Document) | input, entries and rows, rendered as JSON, CSV, LaTeX or text |
//! | [`verify`] | a document's question answered again, every value compared, and a second route |
//!
//! ```
//! use kickdrift_documents::number::rational::ratio;
//! use kickdrift_documents::question::{Half, Question, Work};
//! let half = Half { ratio: "5/3".parse()?, s: ratio(11, 4), rho: ratio(1, 25) };
//! let document = half.ask(&Work::default())?;
//! assert_eq!(document.value()["entries"][0]["entry"], "A");
//! # Ok::<(), kickdrift_documents::number::error::Error>(())
//! ```

pub mod format;
pub mod input;
pub mod question;
pub mod report;
pub mod verify;

pub use clocks;
pub use molecules;
pub use number;
pub use plot;
pub use systems;
pub use words;
