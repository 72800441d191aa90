//! Usage errors in one line: what is wrong, with which value, and what to do.

use clap::error::{ContextKind, ContextValue, ErrorKind};

use number::error::{Error, is_like};

/// An error that the argument parser found, as one of ours.
pub fn explained(error: &clap::Error, program: &clap::Command) -> Error {
    let invalid = || shown(error, ContextKind::InvalidArg);
    let known = match error.kind() {
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => {
            Some(Error::missing("command", format!("choose {}", commands(program))))
        }
        ErrorKind::MissingRequiredArgument => {
            invalid().map(|flags| Error::missing(&names(&flags), format!("add {flags}")))
        }
        ErrorKind::InvalidSubcommand => shown(error, ContextKind::InvalidSubcommand).map(|name| {
            Error::unknown("command", &name, program.get_subcommands().map(clap::Command::get_name))
        }),
        ErrorKind::InvalidValue | ErrorKind::ValueValidation => bad_value(error),
        ErrorKind::ArgumentConflict => invalid().map(|flag| match shown(error, ContextKind::PriorArg) {
            Some(other) if other != flag => {
                let remedy = format!("cannot be used with {}: give one of them", names(&other));
                Error::input("argument", names(&flag), remedy)
            }
            _ => Error::input("flag", names(&flag), once(&flag)),
        }),
        ErrorKind::TooManyValues => invalid().map(|flag| {
            let value = shown(error, ContextKind::InvalidValue).unwrap_or_default();
            Error::input(&names(&flag), value, "takes no value: write the flag alone")
        }),
        ErrorKind::UnknownArgument => invalid().map(|given| {
            if given.starts_with('-') && given[1..].starts_with(|c: char| c.is_ascii_digit()) {
                return Error::input("argument", &given, "write a negative value as --flag=-1/ps");
            }
            if given.starts_with('-') {
                return Error::input("flag", &given, suggestion(error));
            }
            Error::input("argument", &given, "belongs to no flag: several values of one stand behind commas without spaces, a text with spaces in quotes; --help lists all flags")
        }),
        _ => None,
    };
    known.unwrap_or_else(|| plain(error))
}

/// How to give a flag once: some take several values.
fn once(flag: &str) -> &'static str {
    match names(flag).as_str() {
        "parameter" => "is given twice; give it once, further names behind commas, as b=0.1..0.2:1/100,c=1/3",
        "methods" | "columns" | "constraints" | "on" => {
            "is given twice; give it once, with commas between values"
        }
        _ => "is given twice; give it once",
    }
}

fn bad_value(error: &clap::Error) -> Option<Error> {
    let flag = names(&shown(error, ContextKind::InvalidArg)?);
    let value = shown(error, ContextKind::InvalidValue).unwrap_or_default();
    let choices = shown(error, ContextKind::ValidValue).filter(|choices| !choices.is_empty());
    let form = || format!("write a value, as {}", shown(error, ContextKind::InvalidArg).unwrap_or_default());
    let remedy = match (choices, std::error::Error::source(error)) {
        (Some(choices), _) => format!("choose one of {}", choices.replace(' ', ", ")),
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
    match given.zip(known) {
        Some((given, known)) if is_like(letters(&given), letters(&known)) => {
            format!("unknown; did you mean {known}?")
        }
        _ => "unknown; --help lists all flags".into(),
    }
}

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
    // An argument without a flag, `[WORD]`, is the field of its name.
    let argument = |word: &str| match word.strip_prefix('[').and_then(|word| word.strip_suffix(']')) {
        Some(name) => name.to_lowercase(),
        None => word.into(),
    };
    if flags.is_empty() { words.map(argument).collect::<Vec<_>>().join(" ") } else { flags.join(", ") }
}

fn commands(program: &clap::Command) -> String {
    let names: Vec<&str> = program.get_subcommands().map(clap::Command::get_name).collect();
    format!("{}; each has a --help", names.join(", "))
}
