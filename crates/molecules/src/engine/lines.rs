//! Inputs that are lines of keys and values: their words with their places.

use std::collections::BTreeMap;
use std::ops::Range;

use super::reading::{Interval, MOST_COUNT, Place};
use number::{Error, Result};

/// How an engine writes lines.
pub(super) struct Notation {
    pub comment: char,
    /// Whether `=` counts as white space.
    pub equals: bool,
    /// What ends a command beside the line's end.
    pub ends: Option<char>,
    /// A line that ends in it goes on in the next one.
    pub goes_on: Option<char>,
    /// Whether { and } hold commands that are done by conditions, in loops or in procedures.
    pub braces: bool,
}

pub(super) const PLAIN: Notation =
    Notation { comment: '#', equals: false, ends: None, goes_on: None, braces: false };

/// A word and its place.
pub(super) type Word<'a> = (&'a str, Range<usize>);

/// A line: its words with their places, comments left out.
pub(super) struct Line<'a> {
    pub words: Vec<Word<'a>>,
    /// Braces that are open where it begins.
    pub depth: usize,
}

impl<'a> Line<'a> {
    pub fn key(&self) -> &'a str {
        self.words.first().map_or("", |word| word.0)
    }

    pub fn value(&self, field: &str) -> Result<&Word<'a>> {
        self.words.get(1).ok_or_else(|| Error::missing(field, "its line has no value"))
    }

    pub fn shown(&self) -> String {
        self.words.iter().map(|word| word.0).collect::<Vec<_>>().join(" ")
    }
}

/// All lines with words.
pub(super) fn lines<'a>(text: &'a str, notation: &Notation) -> Vec<Line<'a>> {
    let mut all: Vec<Line<'a>> = Vec::new();
    let (mut goes_on, mut depth) = (false, 0_usize);
    for (from, line) in commands(text, notation) {
        let text = line.split(notation.comment).next().unwrap_or_default();
        let (text, more) = match notation.goes_on.and_then(|sign| text.trim_end().strip_suffix(sign)) {
            Some(text) => (text, true),
            None => (text, false),
        };
        let words = words(text, from, notation.equals);
        match all.last_mut().filter(|_| goes_on) {
            Some(last) => last.words.extend(words),
            None if !words.is_empty() => all.push(Line { words, depth }),
            None => {}
        }
        if notation.braces {
            depth = (depth + text.matches('{').count()).saturating_sub(text.matches('}').count());
        }
        goes_on = more;
    }
    all
}

/// Lines, or parts of them, with their places.
fn commands<'a>(text: &'a str, notation: &Notation) -> impl Iterator<Item = (usize, &'a str)> {
    let (comment, ends) = (notation.comment, notation.ends);
    text.split_inclusive('\n')
        .scan(0, |from, line| {
            *from += line.len();
            Some((*from - line.len(), line))
        })
        .flat_map(move |(from, line)| {
            let code = line.find(comment).unwrap_or(line.len());
            // What stands behind the sign of a comment ends nothing.
            let cuts = ends.into_iter().flat_map(move |sign| line[..code].match_indices(sign));
            let cuts: Vec<usize> = cuts.map(|(at, sign)| at + sign.len()).chain([line.len()]).collect();
            let begins = std::iter::once(0).chain(cuts.clone());
            begins.zip(cuts).map(move |(begin, end)| {
                (from + begin, ends.map_or(&line[begin..end], |sign| line[begin..end].trim_end_matches(sign)))
            })
        })
}

fn words(line: &str, from: usize, equals: bool) -> Vec<Word<'_>> {
    let gap = |c: char| c.is_whitespace() || (equals && c == '=');
    let (mut found, mut start) = (Vec::new(), None);
    for (i, c) in line.char_indices().chain([(line.len(), ' ')]) {
        match (gap(c), start) {
            (false, None) => start = Some(i),
            (true, Some(begin)) => {
                found.push((&line[begin..i], from + begin..from + i));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// The last line of a key, upper and lower case alike, - as _.
pub(super) fn last<'b, 'a>(lines: &'b [Line<'a>], key: &str) -> Option<&'b Line<'a>> {
    lines.iter().rev().find(|line| is_key(line.key(), key))
}

pub(super) fn is_key(word: &str, key: &str) -> bool {
    let plain = |c: u8| if c == b'_' { b'-' } else { c.to_ascii_lowercase() };
    word.len() == key.len() && word.bytes().zip(key.bytes()).all(|(a, b)| plain(a) == plain(b))
}

/// Names that a text sets once, to a number, with the number and its place.
#[derive(Default)]
pub(super) struct Names<'a>(BTreeMap<&'a str, Option<Word<'a>>>);

impl<'a> Names<'a> {
    /// A name that is set again, or not to a number (`None`), has no value any more.
    pub fn set(&mut self, name: &'a str, value: Option<Word<'a>>) {
        let value = value.filter(|word| word.0.parse::<f64>().is_ok());
        let known = self.0.contains_key(name);
        self.0.insert(name, if known { None } else { value });
    }

    /// The word itself, or what it names as `$dt`, `${dt}` or `v_dt` do.
    pub fn follow(&self, word: &Word<'a>) -> Word<'a> {
        let name = word
            .0
            .strip_prefix('$')
            .map(|name| name.strip_prefix('{').and_then(|name| name.strip_suffix('}')).unwrap_or(name));
        name.and_then(|name| self.0.get(name)?.clone()).unwrap_or_else(|| word.clone())
    }
}

/// An interval where it stands in a text; one to be added where its default may not do; none where it is 0 or
/// a name.
pub(super) fn interval(
    lines: &[Line],
    end: usize,
    key: &'static str,
    default: u64,
) -> Option<(Range<usize>, Interval)> {
    let given = last(lines, key).and_then(|line| line.words.get(1));
    // Below 0 is the default, too.
    let count = given
        .map_or(Some(default), |word| Some(u64::try_from(word.0.parse::<i64>().ok()?).unwrap_or(default)));
    let steps = count.filter(|n| (1..=MOST_COUNT * MOST_COUNT).contains(n))?;
    let range = given.map_or(end..end, |word| word.1.clone());
    Some((range, Interval { name: key, key: given.is_none().then_some(key), steps, of: 1, or_part: false }))
}

/// Intervals of which all but the first stay multiples of the first, where they are so.
pub(super) fn intervals(
    lines: &[Line],
    end: usize,
    keys: &[(&'static str, u64)],
) -> Vec<(Range<usize>, Place)> {
    let mut places = Vec::new();
    let mut first = 1;
    for (k, &(key, default)) in keys.iter().enumerate() {
        let Some((range, mut interval)) = interval(lines, end, key, default) else { continue };
        first = if k == 0 { interval.steps } else { first };
        interval.of = if interval.steps % first == 0 { first } else { 1 };
        interval.of = if k == 0 { 1 } else { interval.of };
        places.push((range, Place::Interval(interval)));
    }
    places
}
