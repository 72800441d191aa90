//! Text for a terminal: no line is wider than it, and the verdict has its colour.
//!
//! Lines are wrapped at words, under their own beginning; a table folds itself to [`width_of_output`]. Where
//! standard output is a file or a pipe, text stays as it is.

use std::io::IsTerminal;

use clap::ValueEnum;
use console::Term;

/// Whether verdicts are coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Colour {
    /// At a terminal, unless NO_COLOR is set.
    #[default]
    Auto,
    Always,
    Never,
}

impl Colour {
    fn is_on(self) -> bool {
        let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        match self {
            Colour::Auto => std::io::stdout().is_terminal() && !is_set("NO_COLOR") && !is_dumb,
            Colour::Always => true,
            Colour::Never => false,
        }
    }
}

/// A text as standard output shows it to a person.
pub fn shown(text: &str, colour: Colour) -> String {
    let text = if colour.is_on() { coloured(text) } else { text.into() };
    width_of_output().map_or_else(|| text.clone(), |most| fitted(&text, most))
}

/// A message as standard error shows it to a person.
pub fn message(text: &str) -> String {
    columns(&Term::stderr()).map_or_else(|| text.into(), |most| fitted(text, most))
}

/// The columns of standard output, where it is a terminal.
pub fn width_of_output() -> Option<usize> {
    columns(&Term::stdout())
}

/// The columns of a terminal; nothing of a file, a pipe, or a terminal that does not say.
fn columns(term: &Term) -> Option<usize> {
    let is_wide = |&most: &usize| most > 0;
    if !term.is_term() {
        return None;
    }
    term.size_checked().map(|(_, most)| usize::from(most)).filter(is_wide)
}

/// Characters that take a place: none of those that colour.
fn width(text: &str) -> usize {
    let (mut all, mut is_code) = (0, false);
    for c in text.chars() {
        match (is_code, c) {
            (false, '\x1b') => is_code = true,
            (false, _) => all += 1,
            (true, 'm') => is_code = false,
            (true, _) => {}
        }
    }
    all
}

/// The text in lines of at most so many columns, longer only by a word that is itself.
fn fitted(text: &str, most: usize) -> String {
    let lines: Vec<String> = text.lines().flat_map(|line| wrapped(line, most)).collect();
    lines.join("\n") + if text.ends_with('\n') { "\n" } else { "" }
}

/// A line at its words, the later ones under what follows its label.
fn wrapped(line: &str, most: usize) -> Vec<String> {
    if width(line) <= most {
        return vec![line.into()];
    }
    let (indent, label) = hang(line);
    let start = indent.min(most / 3);
    // The label's own spaces stay.
    let (label, rest) = line.split_at(label);
    let (mut lines, mut current) = (Vec::new(), label.to_string());
    let mut is_empty = true;
    for word in rest.split(' ') {
        if !is_empty && width(&current) + 1 + width(word) > most {
            lines.push(std::mem::replace(&mut current, " ".repeat(start)));
            is_empty = true;
        }
        if !is_empty {
            current.push(' ');
        }
        current.push_str(word);
        is_empty = false;
    }
    lines.push(current);
    lines.iter().map(|line| line.trim_end().to_string()).collect()
}

/// Labels are no longer.
const LABEL: usize = 16;

/// Where the words of a line begin, in columns, and how many bytes stand before its first one: behind
/// "  proven     ", "4 fs    " and "advice: ", else behind its spaces.
fn hang(line: &str) -> (usize, usize) {
    let spaces = line.len() - line.trim_start().len();
    let rest = &line[spaces..];
    let gap = rest.find("  ").map(|at| at + rest[at..].len() - rest[at..].trim_start().len());
    let colon = rest.find(": ").filter(|at| !rest[..*at].contains(' ')).map(|at| at + 2);
    match gap.or(colon).filter(|at| width(&rest[..*at]) <= LABEL) {
        Some(at) => (spaces + width(&rest[..at]), spaces + at),
        None if spaces == 0 => (2, 0),
        None => (spaces, spaces),
    }
}

const GREEN: &str = "\x1b[1;32m";
const YELLOW: &str = "\x1b[1;33m";
const RED: &str = "\x1b[1;31m";
const PLAIN: &str = "\x1b[0m";

/// Verdicts, the longer words first.
const VERDICTS: [(&str, &str); 5] =
    [("unstable", RED), ("not told", YELLOW), ("undecided", YELLOW), ("stable", GREEN), ("safe", GREEN)];

/// The words before the first empty line, verdicts in colour: those that begin a line, or follow its label.
fn coloured(text: &str) -> String {
    let mut is_first_part = true;
    let line = |line: &str| {
        is_first_part &= !line.is_empty();
        if is_first_part { with_verdict(line) } else { line.into() }
    };
    let lines: Vec<String> = text.lines().map(line).collect();
    lines.join("\n") + if text.ends_with('\n') { "\n" } else { "" }
}

fn with_verdict(line: &str) -> String {
    let label = line.find("  ").filter(|at| *at > 0 && *at < LABEL);
    let at = label.map_or(0, |at| at + line[at..].len() - line[at..].trim_start().len());
    let verdict = |rest: &str| VERDICTS.into_iter().find(|(word, _)| rest.starts_with(word));
    // A line whose verdict stands behind no label begins with it.
    let found = [0, at].into_iter().find_map(|at| Some((at, verdict(&line[at..])?)));
    let Some((at, (word, colour))) = found else { return line.into() };
    let is_limited = ["caution:", "do not use", "but above"].iter().any(|word| line.contains(word));
    let colour = if is_limited && colour == GREEN { YELLOW } else { colour };
    format!("{}{colour}{word}{PLAIN}{}", &line[..at], &line[at + word.len()..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_words_and_hang_under_their_label() {
        let line = "  proven     every outer step below 4.44 fs at the ratio 8 is stable";
        let lines = wrapped(line, 40);
        assert_eq!(
            lines,
            ["  proven     every outer step below 4.44", "             fs at the ratio 8 is stable"]
        );
        assert_eq!(
            wrapped("4 fs    stable; next 4.6-4.9 fs", 20),
            ["4 fs    stable; next", "      4.6-4.9 fs"]
        );
        assert_eq!(wrapped("short", 5), ["short"]);
        assert_eq!(wrapped("a word_that_is_longer b", 8), ["a", "  word_that_is_longer", "  b"]);
    }

    #[test]
    fn a_verdict_alone_has_a_colour_and_takes_no_place() {
        assert_eq!(coloured("stable: elliptic\n"), "\x1b[1;32mstable\x1b[0m: elliptic\n");
        assert_eq!(
            with_verdict("5 fs    stable, but above it: do not use"),
            "5 fs    \x1b[1;33mstable\x1b[0m, but above it: do not use"
        );
        assert_eq!(with_verdict("unstable: hyperbolic"), "\x1b[1;31munstable\x1b[0m: hyperbolic");
        assert_eq!(coloured("advice: none\n\nstable\n"), "advice: none\n\nstable\n");
        assert_eq!(width("\x1b[1;32mstable\x1b[0m"), 6);
    }
}
