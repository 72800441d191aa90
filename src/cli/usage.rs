//! Usage errors in one line: what is wrong, with which value, and what to do.

use std::ffi::OsString;
use std::path::Path;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use number::Error;
use number::error::is_like;

/// An error that the argument parser found in these arguments, as one of ours.
pub fn explained(error: &clap::Error, program: &clap::Command, arguments: &[OsString]) -> Error {
    let given = Given::new(program, arguments);
    let invalid = || shown(error, ContextKind::InvalidArg);
    let known = match error.kind() {
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => {
            Some(Error::missing("command", format!("choose {}", commands(program))))
        }
        ErrorKind::MissingRequiredArgument => {
            invalid().map(|flags| Error::missing(&names(&flags), format!("add {flags}{}", given.example())))
        }
        ErrorKind::InvalidSubcommand => shown(error, ContextKind::InvalidSubcommand).map(|name| {
            Error::unknown("command", &name, program.get_subcommands().map(clap::Command::get_name))
        }),
        ErrorKind::InvalidValue | ErrorKind::ValueValidation => bad_value(error, &given),
        ErrorKind::ArgumentConflict => invalid().map(|flag| match shown(error, ContextKind::PriorArg) {
            Some(other) if other != flag => {
                let [field, other] = [names(&flag), names(&other)];
                if given.command() == "advise" && [&field, &other].into_iter().any(|name| name == "file") {
                    let text = given.bare().unwrap_or(field);
                    return if Path::new(&text).exists() {
                        Error::input("file", text, NO_HESSIANS)
                    } else {
                        Error::input("argument", &text, given.place_of(&text))
                    };
                }
                let remedy = format!("cannot be used with {other}: give one of them");
                Error::input("argument", field, remedy)
            }
            _ => Error::input("flag", names(&flag), given.once(&names(&flag))),
        }),
        ErrorKind::TooManyValues => invalid().map(|flag| {
            let value = shown(error, ContextKind::InvalidValue).unwrap_or_default();
            Error::input(&names(&flag), value, "takes no value: write the flag alone")
        }),
        ErrorKind::UnknownArgument => invalid().map(|text| {
            if text.starts_with('-') && text[1..].starts_with(|c: char| c.is_ascii_digit()) {
                return Error::input("argument", &text, "write a negative value as --flag=-1/ps");
            }
            if text.starts_with('-') {
                return Error::input("flag", &text, suggestion(error));
            }
            Error::input("argument", &text, given.place_of(&text))
        }),
        _ => None,
    };
    known.unwrap_or_else(|| plain(error))
}

/// A file beside periods is mostly an engine's input.
const NO_HESSIANS: &str =
    "stands for Hessians in place of periods and bonds: give an engine's input as --engine FILE";

/// What was typed, and the command that it is for.
struct Given<'a> {
    program: &'a clap::Command,
    command: Option<&'a clap::Command>,
    /// Behind the command's name.
    words: Vec<String>,
}

impl<'a> Given<'a> {
    fn new(program: &'a clap::Command, arguments: &[OsString]) -> Given<'a> {
        let words: Vec<String> = arguments.iter().map(|word| word.to_string_lossy().into()).collect();
        let found = words.iter().enumerate().find_map(|(n, word)| Some((n, program.find_subcommand(word)?)));
        let behind = found.map_or(words.len(), |(n, _)| n + 1);
        let command = found.map(|(_, command)| command);
        Given { program, command, words: words[behind..].to_vec() }
    }

    fn command(&self) -> &str {
        self.command.map_or("", clap::Command::get_name)
    }

    /// The flag of a word that takes a value.
    fn flag(&self, word: &str) -> Option<&'a clap::Arg> {
        let name = word.strip_prefix("--")?;
        let mut all = self.command?.get_arguments().chain(self.program.get_arguments());
        all.find(|flag| flag.get_long() == Some(name) && flag.get_action().takes_values())
    }

    /// The first word that is no flag and no flag's value.
    fn bare(&self) -> Option<String> {
        let is_bare =
            |n: usize| !self.words[n].starts_with('-') && (n == 0 || self.flag(&self.words[n - 1]).is_none());
        (0..self.words.len()).find(|&n| is_bare(n)).map(|n| self.words[n].clone())
    }

    /// ", as in kickdrift verify FILE.json": the command's first example.
    fn example(&self) -> String {
        let example = super::help::examples(self.command()).first();
        example.map_or_else(String::new, |example| format!("; for example kickdrift {example}"))
    }

    /// How to give a flag once: some take several values.
    fn once(&self, name: &str) -> &'static str {
        if name == "parameter" {
            return "is given twice; give it once, further names behind commas, as b=0.1..0.2:1/100,c=1/3";
        }
        match self.flag(&format!("--{name}")) {
            Some(flag) if is_list(flag) => "is given twice; give it once, with commas between values",
            _ => "is given twice; give it once",
        }
    }

    /// Where a word belongs that follows no flag: with the value before it, where there is one.
    fn place_of(&self, text: &str) -> String {
        let at = self.words.iter().position(|word| word == text);
        let before = at.and_then(|at| at.checked_sub(2)).map(|at| (&self.words[at], &self.words[at + 1]));
        let flag = before.and_then(|(flag, value)| Some((self.flag(flag)?, flag, value)));
        match flag {
            Some((flag, name, value)) if is_list(flag) => {
                format!("join the values of a list by commas, as {name} {value},{text}")
            }
            Some((flag, name, value)) if matches!(flag.get_action(), clap::ArgAction::Append) => {
                format!("write the flag again before it, as {name} {value} {name} {text}")
            }
            _ => format!(
                "follows no flag: --help lists all{}; a text with spaces stands in quotes",
                self.example()
            ),
        }
    }
}

/// Whether a flag's one value has parts of one kind, by the name that help has for it.
fn is_list(flag: &clap::Arg) -> bool {
    flag.get_value_names().into_iter().flatten().any(|name| {
        ["LIST", "WHICH"].contains(&name.as_str())
            || name.ends_with(",...")
            || name.contains(',') && !name.contains('=')
    })
}

fn bad_value(error: &clap::Error, given: &Given) -> Option<Error> {
    let flag = names(&shown(error, ContextKind::InvalidArg)?);
    let value = shown(error, ContextKind::InvalidValue).unwrap_or_default();
    let choices = shown(error, ContextKind::ValidValue).filter(|choices| !choices.is_empty());
    let form = || format!("write a value, as {}", shown(error, ContextKind::InvalidArg).unwrap_or_default());
    let remedy = match (choices, std::error::Error::source(error)) {
        (Some(choices), _) => {
            let paints = given.flag("--colour").is_some() && flag == "color";
            let more = if paints { "; --colour says what the colours of the figure show" } else { "" };
            format!("choose one of {}{more}", choices.replace(' ', ", "))
        }
        (None, Some(cause)) => cause.to_string(),
        (None, None) => form(),
    };
    // An empty value that a parser has seen is bad; else there was none.
    let absent = value.is_empty() && std::error::Error::source(error).is_none();
    Some(if absent { Error::missing(&flag, remedy) } else { Error::input(&flag, value, remedy) })
}

fn suggestion(error: &clap::Error) -> String {
    fn letters(flag: &str) -> &str {
        flag.trim_start_matches('-')
    }
    let [given, known] = [ContextKind::InvalidArg, ContextKind::SuggestedArg].map(|kind| shown(error, kind));
    match (given.clone().zip(known), given) {
        (Some((given, known)), _) if is_like(letters(&given), letters(&known)) => {
            format!("unknown; did you mean {known}?")
        }
        (Some((given, _)), _) | (None, Some(given)) => {
            let known = SHORT.iter().find(|(short, _)| *short == given);
            known.map_or("unknown; --help lists all flags".into(), |(_, known)| {
                format!("unknown; did you mean {known}?")
            })
        }
        _ => "unknown; --help lists all flags".into(),
    }
}

/// Flags in the short form that other programs have; here all are written out.
const SHORT: [(&str, &str); 4] =
    [("-o", "--output"), ("-f", "--format"), ("-t", "--threads"), ("-q", "--quiet")];

/// Anything else, in the parser's own words.
fn plain(error: &clap::Error) -> Error {
    let text = error.to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    Error::input("command line", first.strip_prefix("error: ").unwrap_or(first), "see kickdrift --help")
}

/// The parser's words on one aspect, its parts side by side.
fn shown(error: &clap::Error, kind: ContextKind) -> Option<String> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text.clone()),
        ContextValue::Strings(parts) => Some(parts.join(" ")),
        _ => None,
    }
}

/// `--h1 <A> --h2 <B>` as the fields it names: `h1, h2`.
fn names(flags: &str) -> String {
    let words = flags.split_whitespace();
    let flags: Vec<&str> = words.clone().filter_map(|word| word.strip_prefix("--")).collect();
    // An argument without a flag, `[WORD]` or `<WORD>`, is the field of its name.
    let argument = |word: &str| word.trim_matches(['[', ']', '<', '>']).to_lowercase();
    if flags.is_empty() { words.map(argument).collect::<Vec<_>>().join(" ") } else { flags.join(", ") }
}

fn commands(program: &clap::Command) -> String {
    let names: Vec<&str> = program.get_subcommands().map(clap::Command::get_name).collect();
    format!("{}; each has a --help", names.join(", "))
}
