//! Which engine a text of lines speaks of: words that this engine alone has, and hardly one that it does not
//! know.

use std::collections::HashSet;

use super::lines::{Line, Notation, lines};
use super::reading::Engine;

/// The words that begin an engine's lines.
pub(super) struct Vocabulary {
    pub engine: Engine,
    pub notation: Notation,
    /// Those that no other engine has, an empty line, those that others have, too; as `plain` writes them.
    pub words: &'static str,
    /// A word as it is compared.
    pub plain: fn(&str) -> String,
    /// Words that are known by how they begin.
    pub prefixes: &'static [&'static str],
    /// A line that says by its value whose it is.
    pub is_own: fn(&Line) -> bool,
    /// Whether every word of the engine is listed, so that another one is worth telling.
    pub is_whole: bool,
}

/// A vocabulary with its words looked up at once.
pub(super) struct Known(Vocabulary, [HashSet<&'static str>; 2]);

impl Known {
    pub fn new(vocabulary: Vocabulary) -> Known {
        let set = |part: usize| vocabulary.words.split("\n\n").nth(part).unwrap_or_default();
        let sets = [0, 1].map(|part| set(part).split_whitespace().collect());
        Known(vocabulary, sets)
    }
}

/// What speaks for an engine, and against it.
#[derive(Debug)]
pub(super) struct Evidence {
    pub engine: Engine,
    pub own: usize,
    known: usize,
    /// Words that the engine does not know, each once, where all that it knows are listed.
    pub unknown: Vec<String>,
    strange: usize,
}

impl Evidence {
    fn of(Known(vocabulary, [texts, shared]): &Known, text: &str) -> Evidence {
        let mut found = Evidence { engine: vocabulary.engine, own: 0, known: 0, unknown: vec![], strange: 0 };
        let mut seen = HashSet::new();
        for line in lines(text, &vocabulary.notation) {
            let word = (vocabulary.plain)(line.key());
            let begins = vocabulary.prefixes.iter().any(|prefix| word.starts_with(prefix));
            if texts.contains(word.as_str()) || (vocabulary.is_own)(&line) {
                found.own += 1;
            } else if shared.contains(word.as_str()) || begins {
                found.known += 1;
            } else {
                found.strange += 1;
                if vocabulary.is_whole && seen.insert(word) {
                    found.unknown.push(line.key().into());
                }
            }
        }
        found
    }

    fn speaks(&self) -> bool {
        self.own > 0 && self.strange <= self.own + self.known
    }
}

/// The engine of these that most words speak of.
pub(super) fn evidence(text: &str, all: &[Known]) -> Option<Evidence> {
    let speaking = all.iter().map(|known| Evidence::of(known, text)).filter(Evidence::speaks);
    speaking.max_by_key(|speaking| (speaking.own, std::cmp::Reverse(speaking.strange)))
}
