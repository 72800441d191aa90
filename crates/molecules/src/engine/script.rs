//! A Python script, as far as it can be read without running it: calls, their arguments, and names that are
//! set once.

use std::collections::BTreeMap;
use std::ops::Range;

/// A script; `code` is its text with comments and strings blanked, at the same places.
pub(super) struct Script {
    code: String,
    /// Each opening bracket with the one that closes it.
    closes: BTreeMap<usize, usize>,
    /// What each name is set to; `None` for one that is set in more than one way.
    values: BTreeMap<String, Option<Range<usize>>>,
}

/// In which words bind the names that follow.
#[derive(Clone, Copy)]
enum Scope {
    None,
    Loop,
    Line,
    Lambda,
    /// Until this bracket.
    Parameters(usize),
}

/// A call: its name, and what is in its parentheses.
#[derive(Clone, Debug)]
pub(super) struct Call<'a> {
    pub name: &'a str,
    pub inside: Range<usize>,
}

/// An argument: its keyword, if any, and its value.
pub(super) type Argument<'a> = (Option<&'a str>, Range<usize>);

impl Script {
    pub fn new(text: &str) -> Script {
        let code = blanked(text);
        let closes = brackets(&code);
        let mut script = Script { code, closes, values: BTreeMap::new() };
        script.values = script.bindings();
        script
    }

    pub fn code(&self) -> &str {
        &self.code
    }

    /// All names with their places.
    pub fn words(&self) -> impl Iterator<Item = (&str, usize)> {
        words(&self.code, 0..self.code.len())
    }

    /// The calls of functions whose name passes; neither definitions nor classes.
    pub fn calls<'a>(&'a self, is_wanted: impl Fn(&str) -> bool + 'a) -> impl Iterator<Item = Call<'a>> {
        let mut before = "";
        self.words().filter_map(move |(name, at)| {
            let defines = ["def", "class"].contains(&std::mem::replace(&mut before, name));
            let end = at + name.len();
            let open = end + gap(&self.code[end..]);
            let close = *self.closes.get(&open).filter(|_| self.code[open..].starts_with('('))?;
            (!defines && is_wanted(name)).then_some(Call { name, inside: open + 1..close })
        })
    }

    /// Ranges of the parts between commas that stand in no inner brackets, without white space around.
    pub fn split(&self, range: Range<usize>) -> Vec<Range<usize>> {
        let (mut parts, mut from, mut at) = (Vec::new(), range.start, range.start);
        let bytes = self.code.as_bytes();
        while at < range.end {
            match self.closes.get(&at) {
                Some(close) => at = *close,
                None if bytes[at] == b',' => {
                    parts.push(self.trimmed(from..at));
                    from = at + 1;
                }
                None => {}
            }
            at += 1;
        }
        parts.push(self.trimmed(from..range.end));
        parts.retain(|part| !part.is_empty());
        parts
    }

    pub fn arguments(&self, call: &Call) -> Vec<Argument<'_>> {
        let own = |part: Range<usize>| match self.equals(part.clone()) {
            Some(at) if is_name(self.code[part.start..at].trim()) => {
                (Some(self.code[part.start..at].trim()), self.trimmed(at + 1..part.end))
            }
            _ => (None, part),
        };
        self.split(call.inside.clone()).into_iter().map(own).collect()
    }

    /// Whether one pair of brackets holds all of it.
    pub fn is_bracketed(&self, range: &Range<usize>) -> bool {
        range.end > 0 && self.closes.get(&range.start) == Some(&(range.end - 1))
    }

    /// Without white space and brackets around it; a name that is set once stands for what it is set to.
    pub fn followed(&self, range: Range<usize>) -> Range<usize> {
        let mut range = self.trimmed(range);
        // A chain of names longer than this is none that a person wrote.
        for _ in 0..8 {
            let text = &self.code[range.clone()];
            let wrapped = text.starts_with('(') && self.is_bracketed(&range);
            let inner = (range.start + 1)..range.end.saturating_sub(1);
            // A pair in brackets is a value of its own.
            if wrapped
                && self.split(inner.clone()).len() == 1
                && !self.code[inner.clone()].trim_end().ends_with(',')
            {
                range = self.trimmed(inner);
            } else if let Some(Some(value)) = self.values.get(text) {
                range = value.clone();
            } else {
                break;
            }
        }
        range
    }

    /// Factors outside of brackets, and whether each divides; nothing for a power.
    pub fn factors(&self, range: Range<usize>) -> Vec<(bool, Range<usize>)> {
        let bytes = self.code.as_bytes();
        let (mut found, mut divides, mut from, mut at) = (Vec::new(), false, range.start, range.start);
        while at < range.end {
            match self.closes.get(&at) {
                Some(close) => at = *close,
                None if b"*/".contains(&bytes[at]) => {
                    found.push((divides, self.trimmed(from..at)));
                    (divides, from) = (bytes[at] == b'/', at + 1);
                }
                None => {}
            }
            at += 1;
        }
        found.push((divides, self.trimmed(from..range.end)));
        found
    }

    /// What is in the parentheses of a call of this function, or of a module's, where the range is one.
    pub fn call_of(&self, range: Range<usize>, name: &str) -> Option<Range<usize>> {
        let open = range.start + self.code[range.clone()].find('(')?;
        let called = self.code[range.start..open].trim().rsplit('.').next()?;
        (called == name && self.closes.get(&open) == Some(&(range.end - 1)))
            .then_some(open + 1..range.end - 1)
    }

    fn trimmed(&self, range: Range<usize>) -> Range<usize> {
        let text = &self.code[range.clone()];
        let start = range.start + (text.len() - text.trim_start().len());
        start..start + text.trim().len()
    }

    /// The place of the `=` that parts a target or a keyword from its value; `None` where there is none or
    /// more than one.
    fn equals(&self, range: Range<usize>) -> Option<usize> {
        let signs = self.signs(range);
        <[usize; 1]>::try_from(signs).ok().map(|[at]| at)
    }

    /// Single `=` outside of brackets.
    fn signs(&self, range: Range<usize>) -> Vec<usize> {
        let (bytes, mut at, mut found) = (self.code.as_bytes(), range.start, Vec::new());
        while at < range.end {
            match self.closes.get(&at) {
                Some(close) => at = *close,
                None if bytes[at] == b'=' => {
                    let compares =
                        at > 0 && b"=<>!".contains(&bytes[at - 1]) || bytes.get(at + 1) == Some(&b'=');
                    if !compares {
                        found.push(at);
                    }
                }
                None => {}
            }
            at += 1;
        }
        found
    }

    /// Statements: lines, joined while a bracket is open, parted at `;`.
    fn statements(&self) -> Vec<Range<usize>> {
        let (bytes, mut at, mut from, mut found) = (self.code.as_bytes(), 0, 0, Vec::new());
        while at < bytes.len() {
            match self.closes.get(&at) {
                Some(close) => at = *close,
                None if bytes[at] == b'\n' && (at == 0 || bytes[at - 1] != b'\\') || bytes[at] == b';' => {
                    found.push(self.trimmed(from..at));
                    from = at + 1;
                }
                None => {}
            }
            at += 1;
        }
        found.push(self.trimmed(from..bytes.len()));
        found
    }

    /// What each name is set to: once by a statement `name = value`, or in another way.
    fn bindings(&self) -> BTreeMap<String, Option<Range<usize>>> {
        let mut values: BTreeMap<String, Option<Range<usize>>> = BTreeMap::new();
        let mut bind = |name: &str, value: Option<Range<usize>>| {
            let known = values.contains_key(name);
            values.insert(name.into(), value.filter(|_| !known));
        };
        for statement in self.statements() {
            let signs = self.signs(statement.clone());
            let Some(&last) = signs.last() else { continue };
            let target = self.code[statement.start..signs[0]].trim();
            if signs.len() == 1 && is_name(target) {
                bind(target, Some(self.trimmed(last + 1..statement.end)));
            } else {
                words(&self.code, statement.start..last).for_each(|(name, _)| bind(name, None));
            }
        }
        // Loops, imports, parameters of functions.
        let (mut before, mut scope, mut seen) = ("", Scope::None, 0);
        for (name, at) in self.words() {
            let between = &self.code[seen..at];
            let ends = match scope {
                Scope::None => true,
                Scope::Loop => name == "in",
                Scope::Line => name == "as" || between.contains('\n'),
                Scope::Lambda => between.contains(':'),
                Scope::Parameters(close) => at > close,
            };
            if ends {
                scope = Scope::None;
            } else {
                bind(name, None);
            }
            seen = at + name.len();
            let open = seen + gap(&self.code[seen..]);
            match name {
                "for" => scope = Scope::Loop,
                "import" => scope = Scope::Line,
                "lambda" => scope = Scope::Lambda,
                _ if before == "def" => {
                    scope = self.closes.get(&open).map_or(Scope::None, |close| Scope::Parameters(*close));
                }
                _ if before == "as" || self.code[open..].starts_with(":=") => bind(name, None),
                _ => {}
            }
            before = name;
        }
        values
    }
}

fn gap(text: &str) -> usize {
    text.len() - text.trim_start_matches([' ', '\t']).len()
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_') && text.chars().all(is_part)
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The names in a part of a script, with their places; of attributes each part is one.
fn words(code: &str, range: Range<usize>) -> impl Iterator<Item = (&str, usize)> {
    let mut at = range.start;
    code[range].split_inclusive(|c: char| !is_part(c)).filter_map(move |piece| {
        let start = at;
        at += piece.len();
        let word = piece.trim_end_matches(|c: char| !is_part(c));
        is_name(word).then_some((word, start))
    })
}

/// The text with comments and what is between quotes blanked, byte by byte.
fn blanked(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = bytes.to_vec();
    let mut at = 0;
    while at < bytes.len() {
        let (inside, next) = match bytes[at] {
            b'#' => {
                let end = bytes[at..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |n| at + n);
                (at..end, end)
            }
            quote @ (b'"' | b'\'') => string(bytes, at, quote),
            _ => (at..at, at + 1),
        };
        code[inside].fill(b' ');
        at = next;
    }
    String::from_utf8(code).unwrap_or_default()
}

/// What is between the quotes of the string that begins here, and what follows; one of a single line ends
/// with it.
fn string(bytes: &[u8], at: usize, quote: u8) -> (Range<usize>, usize) {
    let width = if bytes[at..].starts_with(&[quote; 3]) { 3 } else { 1 };
    let from = at + width;
    let mut i = from;
    while i < bytes.len() {
        match bytes[i] {
            b'\\' => i += 1,
            b'\n' if width == 1 => return (from..i, i),
            byte if byte == quote && bytes[i..].starts_with(&[quote; 3][..width]) => {
                return (from..i, i + width);
            }
            _ => {}
        }
        i += 1;
    }
    (from..bytes.len(), bytes.len())
}

/// Each opening bracket with the one that closes it.
fn brackets(code: &str) -> BTreeMap<usize, usize> {
    let (mut open, mut closes) = (Vec::new(), BTreeMap::new());
    for (i, byte) in code.bytes().enumerate() {
        match byte {
            b'(' | b'[' | b'{' => open.push(i),
            b')' | b']' | b'}' => {
                if let Some(begin) = open.pop() {
                    closes.insert(begin, i);
                }
            }
            _ => {}
        }
    }
    closes
}
