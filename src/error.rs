//! One error for the whole crate, with a kind that decides what a caller can do about it.
//!
//! ```
//! use kickdrift::error::{Error, Kind};
//! let error = Error::input("h1", "0", "a step must be positive");
//! assert_eq!(error.kind(), Kind::Input);
//! assert_eq!(error.to_string(), "h1 = 0: a step must be positive");
//! ```

use std::fmt;

/// What went wrong, as far as the caller's next move is concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The input is not meaningful; the message names field, value and remedy.
    Input,
    /// A file or stream could not be read or written.
    Io,
    /// The work exceeds the stated budget; the message tells the cost and the flag that allows it.
    Budget,
}

/// An error of any floor: a [`Kind`] and one line for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    kind: Kind,
    message: String,
}

/// The crate's result type.
pub type Result<T> = std::result::Result<T, Error>;

/// The longest value that a message quotes; longer ones are cut in the middle.
const QUOTED: usize = 60;

/// The longest path, cause or remedy, which may quote the user too.
const TOLD: usize = 400;

impl Error {
    /// Bad input: the field, its value as it was given, and what to do instead.
    pub fn input(field: &str, value: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        let value = one_line(&value.to_string(), QUOTED);
        let message = format!("{field} = {value}: {}", one_line(&remedy.to_string(), TOLD));
        Error { kind: Kind::Input, message }
    }

    /// Bad input: a field that is not there, and how to add it.
    pub fn missing(field: &str, remedy: impl fmt::Display) -> Self {
        let message = format!("{field} missing: {}", one_line(&remedy.to_string(), TOLD));
        Error { kind: Kind::Input, message }
    }

    /// A file or stream that could not be read or written.
    pub fn io(path: impl fmt::Display, cause: impl fmt::Display) -> Self {
        let [path, cause] = [path.to_string(), cause.to_string()].map(|text| one_line(&text, TOLD));
        Error { kind: Kind::Io, message: format!("{path}: {cause}") }
    }

    /// More work than the budget allows: what it would cost, and how to allow it.
    pub fn budget(message: impl fmt::Display) -> Self {
        Error { kind: Kind::Budget, message: message.to_string() }
    }

    /// The kind, for callers that react.
    pub fn kind(&self) -> Kind {
        self.kind
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// `text` on one line, its middle left out where it has more than `most` characters.
fn one_line(text: &str, most: usize) -> String {
    let line: Vec<char> = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if line.len() <= most {
        return line.into_iter().collect();
    }
    let (head, tail) = (&line[..most / 2], &line[line.len() - most / 4..]);
    let text = |part: &[char]| part.iter().collect::<String>();
    format!("{}...{} ({} characters)", text(head), text(tail), line.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_and_multiline_values_stay_on_one_short_line() {
        let message = Error::input("h1", format!("1\n{}", "0".repeat(100_000)), "too long").to_string();
        assert!(message.len() < 200 && !message.contains('\n'), "{message}");
        assert!(message.contains("100002 characters"), "{message}");
    }

    #[test]
    fn paths_and_remedies_cannot_break_the_line_either() {
        let long = "a\r\n\u{1b}".repeat(10_000);
        for error in [Error::input("h1", 0, &long), Error::missing("h1", &long), Error::io(&long, &long)] {
            let message = error.to_string();
            assert!(message.len() < 1000 && !message.contains(char::is_control), "{message}");
        }
    }
}
