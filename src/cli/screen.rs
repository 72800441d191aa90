//! Text for a terminal: no line is wider than it, and the verdict has its colour.
//!
//! Lines are wrapped at words, under their own beginning. Tables fold their headings and words; columns that do
//! not fit are left out and named. Where standard output is a file or a pipe, text stays as it is.

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
    columns(&Term::stdout()).map_or_else(|| text.clone(), |most| fitted(&text, most))
}

/// A message as standard error shows it to a person.
pub fn message(text: &str) -> String {
    columns(&Term::stderr()).map_or_else(|| text.into(), |most| fitted(text, most))
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
    let lines: Vec<&str> = text.lines().collect();
    let (mut out, mut at) = (Vec::new(), 0);
    while at < lines.len() {
        match lines.get(at + 1).filter(|rule| is_rule(rule)) {
            Some(rule) => {
                let rows = lines[at + 2..].iter().take_while(|line| !line.is_empty()).count();
                let body = &lines[at + 2..at + 2 + rows];
                out.extend(Grid::new(rule, lines[at], body).lines(most));
                at += 2 + rows;
            }
            None => {
                out.extend(wrapped(lines[at], most));
                at += 1;
            }
        }
    }
    let end = if text.ends_with('\n') { "\n" } else { "" };
    out.join("\n") + end
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

fn is_rule(line: &str) -> bool {
    !line.is_empty() && line.split("  ").all(|part| !part.is_empty() && part.bytes().all(|c| c == b'-'))
}

/// A table as its text has it.
struct Grid {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
    is_left: Vec<bool>,
    whole: Vec<String>,
}

/// Words of a column are folded down to so many columns.
const FOLDED: usize = 16;

impl Grid {
    fn new(rule: &str, head: &str, body: &[&str]) -> Grid {
        let mut ends: Vec<(usize, usize)> = Vec::new();
        for part in rule.split("  ") {
            let from = ends.last().map_or(0, |(_, end)| end + 2);
            ends.push((from, from + part.len()));
        }
        let parts = |line: &str| -> Vec<String> {
            let all: Vec<char> = line.chars().collect();
            let last = ends.len() - 1;
            let part = |(n, &(from, to)): (usize, &(usize, usize))| {
                let to = if n == last { all.len() } else { to.min(all.len()) };
                all[from.min(to)..to].iter().collect()
            };
            ends.iter().enumerate().map(part).collect()
        };
        let raw: Vec<Vec<String>> = std::iter::once(&head).chain(body).map(|line| parts(line)).collect();
        let is_left = (0..ends.len()).map(|n| !raw.iter().any(|row| row[n].starts_with(' '))).collect();
        let mut rows: Vec<Vec<String>> =
            raw.iter().map(|row| row.iter().map(|cell| cell.trim().to_string()).collect()).collect();
        let whole = [head, rule].iter().chain(body).map(ToString::to_string).collect();
        Grid { head: rows.remove(0), rows, is_left, whole }
    }

    fn longest_word<'a>(cells: impl Iterator<Item = &'a String>) -> usize {
        cells.flat_map(|cell| cell.split(' ')).map(width).max().unwrap_or(0)
    }

    /// The widths of all columns with their headings and words folded as far as `most` asks.
    fn widths(&self, most: usize) -> Vec<usize> {
        let column = |n: usize| self.rows.iter().map(move |row| &row[n]);
        let head = |n: usize| Self::longest_word(std::iter::once(&self.head[n]));
        let body = |n: usize| column(n).map(|cell| width(cell)).max().unwrap_or(0);
        let mut widths: Vec<usize> = (0..self.head.len()).map(|n| body(n).max(head(n))).collect();
        let least: Vec<usize> = (0..self.head.len())
            .map(|n| {
                if self.is_left[n] {
                    Self::longest_word(column(n)).max(head(n)).max(FOLDED)
                } else {
                    widths[n]
                }
            })
            .collect();
        while total(&widths) > most {
            let widest = (0..widths.len()).filter(|&n| widths[n] > least[n]).max_by_key(|&n| widths[n]);
            let Some(widest) = widest else { break };
            let excess = total(&widths) - most;
            widths[widest] = widths[widest].saturating_sub(excess).max(least[widest]);
        }
        widths
    }

    fn lines(&self, most: usize) -> Vec<String> {
        if self.whole.iter().all(|line| width(line) <= most) {
            return self.whole.clone();
        }
        let mut widths = self.widths(most);
        while widths.len() > 1 && total(&widths) > most {
            widths.pop();
        }
        let left_out = &self.head[widths.len()..];
        let mut lines = self.folded(&self.head, &widths, true);
        lines.push(widths.iter().map(|&wide| "-".repeat(wide)).collect::<Vec<_>>().join("  "));
        lines.extend(self.rows.iter().flat_map(|row| self.folded(row, &widths, false)));
        if !left_out.is_empty() {
            lines.push(String::new());
            let note =
                format!("left out here: {}; a wider terminal or --format json has them", left_out.join(", "));
            lines.extend(wrapped(&note, most));
        }
        lines
    }

    /// A row in as many lines as its longest cell takes; headings stand on the rule.
    fn folded(&self, cells: &[String], widths: &[usize], is_head: bool) -> Vec<String> {
        let cells: Vec<Vec<String>> =
            cells.iter().zip(widths).map(|(cell, &wide)| in_words(cell, wide)).collect();
        let tall = cells.iter().map(Vec::len).max().unwrap_or(1);
        let line = |n: usize| {
            let mut line = String::new();
            for (k, (cell, &wide)) in cells.iter().zip(widths).enumerate() {
                let above = if is_head { tall - cell.len() } else { 0 };
                let text = n.checked_sub(above).and_then(|at| cell.get(at)).map_or("", String::as_str);
                let space = " ".repeat(wide.saturating_sub(width(text)));
                let (before, behind) = if self.is_left[k] { ("", &*space) } else { (&*space, "") };
                line.extend([before, text, behind, "  "]);
            }
            line.trim_end().to_string()
        };
        (0..tall).map(line).collect()
    }
}

fn total(widths: &[usize]) -> usize {
    widths.iter().sum::<usize>() + 2 * widths.len().saturating_sub(1)
}

/// A cell at its words.
fn in_words(cell: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in cell.split(' ') {
        let last = lines.last_mut().expect("there is one");
        if last.is_empty() {
            last.push_str(word);
        } else if width(last) + 1 + width(word) <= most {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(word.into());
        }
    }
    lines
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
    fn tables_fold_headings_and_name_the_columns_left_out() {
        let text = "mode  first unstable from (fs)  moving\n----  ------------------------  --------\nOH                      4.6768  atom one\n";
        assert_eq!(fitted(text, 60), text);
        let folded = "         first\n      unstable\n          from\nmode      (fs)  moving\n----  --------  --------\nOH      4.6768  atom one\n";
        assert_eq!(fitted(text, 25), folded);
        let narrow = fitted(text, 16);
        assert!(narrow.lines().all(|line| width(line) <= 16), "{narrow}");
        assert!(narrow.contains("left out here:") && narrow.contains("moving"), "{narrow}");
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
