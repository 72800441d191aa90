//! The command that made a figure, as the figure carries it: the same text wherever and however often it is
//! given.

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, ValueHint};

use documents::report::text::quoted;

/// Flags that change no byte of a figure: where it goes, how it is computed.
const ELSEWHERE: [&str; 9] =
    ["output", "threads", "quiet", "budget", "resume", "certificate", "format", "color", "details"];

/// Flags that choose the pairs of a map.
const OF_MAPS: [&str; 11] = [
    "lambda1", "lambda2", "step", "step1", "step2", "h1_range", "h2_range", "label", "growth", "shard",
    "parts",
];

/// `kickdrift NAME` with the flags that were given, in the order of the help; paths by the name of their file
/// alone.
///
/// For a map only the flags of its drawing, whether it is computed or joined: its document holds the rest.
pub fn text(program: &Command, matches: &ArgMatches) -> String {
    let Some((name, given)) = matches.subcommand() else { return program.get_name().into() };
    let arguments = program.find_subcommand(name).into_iter().flat_map(Command::get_arguments);
    let is_map = ["map", "merge"].contains(&name);
    let asked = arguments.filter(|arguments| !is_map || !OF_MAPS.contains(&arguments.get_id().as_str()));
    let shown = asked.filter(|asked| is_shown(asked, given)).flat_map(|asked| words(asked, given));
    let name = if is_map { "map" } else { name };
    [program.get_name().to_string(), name.to_string()].into_iter().chain(shown).collect::<Vec<_>>().join(" ")
}

fn is_shown(arg: &Arg, given: &ArgMatches) -> bool {
    let id = arg.get_id().as_str();
    let is_file = arg.get_value_hint() == ValueHint::AnyPath && id == "figure";
    given.value_source(id) == Some(ValueSource::CommandLine) && !ELSEWHERE.contains(&id) && !is_file
}

/// The flag and its values as a shell reads them; a flag that is given again comes again.
fn words(arg: &Arg, given: &ArgMatches) -> Vec<String> {
    let is_path = arg.get_value_hint() == ValueHint::AnyPath;
    let shown = |value: &std::ffi::OsStr| {
        let path = std::path::Path::new(value);
        let name = path.file_name().filter(|_| is_path).unwrap_or(value);
        quoted(&name.to_string_lossy())
    };
    let values = given.get_raw_occurrences(arg.get_id().as_str()).into_iter().flatten();
    let separator = arg.get_value_delimiter().map_or(" ".into(), String::from);
    let one = |values: Vec<String>| {
        let joined = values.join(&separator);
        match arg.get_long() {
            Some(flag) if joined.is_empty() || !arg.get_action().takes_values() => format!("--{flag}"),
            Some(flag) => format!("--{flag} {joined}"),
            None => joined,
        }
    };
    values.map(|values| one(values.map(shown).collect())).collect()
}
