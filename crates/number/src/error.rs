//! One error for the whole crate: its kind decides what a caller can do about it, its parts say what to do.
//!
//! ```
//! use kickdrift_number::error::{Error, Kind};
//! let error = Error::input("h1", "0", "a step must be positive");
//! assert_eq!((error.kind(), error.field(), error.value()), (Kind::Input, "h1", Some("0")));
//! assert_eq!(error.to_string(), "h1 = 0: a step must be positive");
//!
//! let error = Error::budget("composing 2000 kicks", 2000).or("choose steps with a simpler ratio");
//! assert_eq!((error.kind(), error.needed()), (Kind::Budget, Some(2000)));
//! assert_eq!(error.to_string(), "composing 2000 kicks: allow 2000, or choose steps with a simpler ratio");
//! ```

use std::sync::Arc;
use std::{fmt, io};

/// The kind of an error, as far as it decides what the caller does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// The input is not meaningful: [`Error::field`], [`Error::value`] and [`Error::remedy`] say what to
    /// change.
    Input,
    /// A file or stream could not be read or written.
    Io,
    /// The work exceeds the stated limit; [`Error::needed`] is the limit that allows it, where one does.
    Budget,
    /// The caller stopped the work before its end.
    Stopped,
}

/// An error of any floor: a [`Kind`], what it is about, what was given and what to do instead.
///
/// `Display` is one line, `field = value: remedy`, in which long texts are cut in the middle; the parts are
/// whole.
#[derive(Clone, Debug)]
pub struct Error(Box<Parts>);

#[derive(Clone, Debug)]
struct Parts {
    kind: Kind,
    /// The field, the path or the work.
    field: String,
    value: Option<String>,
    remedy: String,
    needed: Option<u64>,
    source: Option<Source>,
}

type Source = Arc<dyn std::error::Error + Send + Sync>;

/// The crate's result type.
pub type Result<T> = std::result::Result<T, Error>;

/// The longest value that `Display` quotes, in characters.
const LONGEST_VALUE: usize = 60;

/// The longest path, cause or remedy, which may quote the user too, in characters.
const LONGEST_TEXT: usize = 400;

/// The longest list of names in a remedy, the words about it left out.
const LONGEST_LIST: usize = LONGEST_TEXT - 60;

/// A part of a name that stands for it has this many letters at least.
const SHORTEST_PART: usize = 3;

/// The most names of which one may be meant.
pub const MOST_LIKE: usize = 6;

impl Error {
    fn new(kind: Kind, field: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        let (field, remedy) = (field.to_string(), remedy.to_string());
        Error(Box::new(Parts { kind, field, value: None, remedy, needed: None, source: None }))
    }

    /// Bad input: the field, its value as it was given, and what to do instead.
    pub fn input(field: &str, value: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        let mut error = Error::new(Kind::Input, field, remedy);
        error.0.value = Some(value.to_string());
        error
    }

    /// Bad input: a name that is none of these. The remedy is what it may be a slip of the keyboard for, else
    /// all of them, or as many as a line has room for.
    pub fn unknown<'a>(field: &str, given: &str, names: impl IntoIterator<Item = &'a str>) -> Self {
        let names: Vec<&str> = names.into_iter().collect();
        let like = likes(given, &names);
        let remedy = if like.is_empty() || like.len() > MOST_LIKE {
            let fits = |count: &usize| {
                names[..*count].iter().map(|name| name.len() + 2).sum::<usize>() < LONGEST_LIST
            };
            let shown = (1..=names.len()).rev().find(fits).unwrap_or_default();
            let more = match names.len() - shown {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            format!("choose among {}{more}", names[..shown].join(", "))
        } else {
            format!("unknown; did you mean {}?", like.join(" or "))
        };
        Error::input(field, given, remedy)
    }

    /// Bad input: a field that is not there, and how to add it.
    pub fn missing(field: &str, remedy: impl fmt::Display) -> Self {
        Error::new(Kind::Input, field, remedy)
    }

    /// A file or stream that could not be read or written.
    pub fn io(path: impl fmt::Display, cause: impl fmt::Display) -> Self {
        Error::new(Kind::Io, path, cause)
    }

    /// More work than the limit allows: what it would cost, and the limit that allows it.
    pub fn budget(work: impl fmt::Display, needed: u64) -> Self {
        let mut error = Error::new(Kind::Budget, work, "");
        error.0.needed = Some(needed);
        error
    }

    /// More work than any limit allows: what it would cost, and what to ask instead.
    pub fn too_much(work: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Error::new(Kind::Budget, work, remedy)
    }

    /// Work that its caller stopped before its end.
    pub fn stopped(work: impl fmt::Display) -> Self {
        Error::new(Kind::Stopped, work, "stopped before its end")
    }

    /// An error of a stream, for whoever knows where it goes to name the path by [`Error::at`].
    pub fn stream(cause: io::Error) -> Self {
        Error::io("", &cause).caused_by(cause)
    }

    /// This error with another remedy, beside the higher limit of a [budget](Error::budget).
    #[must_use]
    pub fn or(mut self, remedy: impl fmt::Display) -> Self {
        self.0.remedy = remedy.to_string();
        self
    }

    /// This error about another field: an error of a stream becomes one about the path that the stream goes
    /// to.
    #[must_use]
    pub fn at(mut self, field: impl fmt::Display) -> Self {
        self.0.field = field.to_string();
        self
    }

    /// This error with the one that caused it, for [`std::error::Error::source`].
    #[must_use]
    pub fn caused_by(mut self, cause: impl std::error::Error + Send + Sync + 'static) -> Self {
        self.0.source = Some(Arc::new(cause));
        self
    }

    /// The kind, for callers that react.
    pub fn kind(&self) -> Kind {
        self.0.kind
    }

    /// The subject: a field of the input, a path, or the work that would exceed the limit.
    pub fn field(&self) -> &str {
        &self.0.field
    }

    /// The value that was given, where one was.
    pub fn value(&self) -> Option<&str> {
        self.0.value.as_deref()
    }

    /// The remedy; empty where only a higher limit helps.
    pub fn remedy(&self) -> &str {
        &self.0.remedy
    }

    /// The limit that would allow the work, in the limit's own unit.
    pub fn needed(&self) -> Option<u64> {
        self.0.needed
    }

    /// The cause, where it is a stream's and nobody has said yet where the stream goes.
    pub fn lost_stream(&self) -> Option<&io::Error> {
        self.0.source.as_deref().filter(|_| self.0.field.is_empty())?.downcast_ref()
    }

    /// `Display`, with the caller's own words for how to raise the limit to [`needed`](Error::needed).
    pub fn explain(&self, raise: impl FnOnce(u64) -> String) -> String {
        let Parts { kind, field, value, remedy, needed, .. } = &*self.0;
        let (field, remedy) = (one_line(field, LONGEST_TEXT), one_line(remedy, LONGEST_TEXT));
        match (needed, value) {
            // More than a budget can be.
            (Some(u64::MAX), _) if remedy.is_empty() => format!("{field}: no budget allows it"),
            (Some(u64::MAX), _) => format!("{field}: {remedy}"),
            (Some(needed), _) if remedy.is_empty() => format!("{field}: {}", raise(*needed)),
            (Some(needed), _) => format!("{field}: {}, or {remedy}", raise(*needed)),
            (None, Some(value)) => format!("{field} = {}: {remedy}", one_line(value, LONGEST_VALUE)),
            (None, None) if *kind == Kind::Input => format!("{field} missing: {remedy}"),
            (None, None) => format!("{field}: {remedy}"),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.explain(|needed| format!("allow {needed}")))
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source.as_deref().map(|source| source as _)
    }
}

/// So many copies of a value, where memory has room for them: for lengths that the input decides.
///
/// # Errors
/// [`Kind::Budget`] where it has not.
pub fn filled<T: Clone>(value: T, n: u64) -> Result<Vec<T>> {
    let mut all = Vec::new();
    let length = usize::try_from(n).ok().filter(|&n| all.try_reserve_exact(n).is_ok());
    let bytes = u128::from(n) * size_of::<T>() as u128;
    let refused = || {
        Error::too_much(
            format!("{n} results of {bytes} bytes"),
            "there is no memory for them: ask for fewer at once",
        )
    };
    all.resize(length.ok_or_else(refused)?, value);
    Ok(all)
}

/// That memory has room for so many bytes, before work that will take them piece by piece.
///
/// # Errors
/// [`Kind::Budget`] where it has not.
pub fn room(bytes: u128, fewer: &str) -> Result<()> {
    // A compiler may leave out what is reserved and not looked at.
    let fits = |n| std::hint::black_box(&mut Vec::<u8>::new()).try_reserve_exact(n).is_ok();
    if usize::try_from(bytes).is_ok_and(fits) {
        return Ok(());
    }
    let work = format!("work that takes {:.1} GB", bytes as f64 / 1e9);
    Err(Error::too_much(work, format!("there is no memory for it: choose {fewer}")))
}

/// Whether a word may be a slip of the keyboard for another: one letter in three is wrong, missing or too
/// much.
pub fn is_like(given: &str, known: &str) -> bool {
    let [given, known] = [given, known].map(str::to_lowercase);
    3 * strsim::damerau_levenshtein(&given, &known) <= given.len().max(known.len())
}

/// The names that one may be meant for: the same but for capital letters, else those like it, else those that
/// it is a part of.
pub fn likes<'a>(given: &str, names: &[&'a str]) -> Vec<&'a str> {
    let that = |is_meant: &dyn Fn(&str) -> bool| -> Vec<&'a str> {
        names.iter().copied().filter(|name| is_meant(name)).collect()
    };
    let same = that(&|name| name.eq_ignore_ascii_case(given));
    let like = if same.is_empty() { that(&|name| is_like(given, name)) } else { same };
    if !like.is_empty() || given.len() < SHORTEST_PART {
        return like;
    }
    that(&|name| name.contains(&given.to_lowercase()))
}

/// Characters that are not seen or turn the direction of what follows: marks, embeddings, isolates, tags, a
/// byte order mark.
fn is_unseen(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
        | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e01ef}')
}

/// `text` whose lines a terminal shows as they are: names of files and titles may hold what moves the cursor,
/// or hides what follows.
pub fn visible(text: &str) -> String {
    let is_hidden = |c: char| c != '\n' && (c.is_control() || is_unseen(c));
    if !text.contains(is_hidden) {
        return text.into();
    }
    let shown = |c: char| if is_hidden(c) { c.escape_unicode().to_string() } else { c.to_string() };
    text.chars().map(shown).collect()
}

/// `text` on one line, what is not seen escaped, its middle left out where it has more than `most`
/// characters.
fn one_line(text: &str, most: usize) -> String {
    let line: Vec<char> = visible(&text.replace(['\n', '\r', '\t'], " ")).chars().collect();
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
    fn characters_that_are_not_seen_are_escaped() {
        let text = "a\u{202e}b\u{1b}[31m\u{feff}\u{200b}\u{e9}";
        for error in [Error::input(text, text, text), Error::missing(text, text), Error::io(text, text)] {
            let message = error.to_string();
            assert!(message.contains("a\\u{202e}b\\u{1b}[31m\\u{feff}\\u{200b}\u{e9}"), "{message}");
        }
    }

    #[test]
    fn the_parts_are_whole_where_the_message_is_cut() {
        let long = "7".repeat(1000);
        let error = Error::input("h1", &long, "too long").caused_by(std::fmt::Error);
        assert_eq!((error.value(), error.remedy(), error.needed()), (Some(&*long), "too long", None));
        assert!(std::error::Error::source(&error).is_some_and(|source| source.is::<std::fmt::Error>()));
    }

    #[test]
    fn memory_that_is_not_there_is_an_error() {
        assert_eq!(filled(7, 3).unwrap(), [7, 7, 7]);
        for n in [u64::MAX, u64::MAX / 8, 1 << 60] {
            let error = filled(0.0, n).unwrap_err();
            assert_eq!((error.kind(), error.needed()), (Kind::Budget, None), "{error}");
        }
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
