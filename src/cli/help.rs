//! The help below the flags of each command: examples that run as they stand, exit codes, and required flags.

use clap::Command;

use documents::question::{
    Advise, Aperture, Bands, Closings, Compare, Curves, Half, Map, Polynomial, Proposition, Question, Scene,
    Simulate, System, Tongues, Verdict, Word,
};

const EXIT_CODES: &str = "Exit codes:
  0  done
  2  error: one line on standard error names the field, its value and a remedy; nothing is half-written";

/// What a question says of its command: its name, examples, and the flags that are required.
type Page = (&'static str, &'static [&'static str], Option<&'static str>);

const fn of<Q: Question>() -> Page {
    (Q::NAME, Q::EXAMPLES, Q::USAGE)
}

const PAGES: [Page; 22] = [
    of::<Verdict>(),
    of::<Curves>(),
    of::<Compare>(),
    of::<Proposition>(),
    of::<Polynomial>(),
    of::<Half>(),
    of::<Map>(),
    of::<Tongues>(),
    of::<Bands>(),
    of::<Closings>(),
    of::<Word>(),
    of::<System>(),
    of::<Advise>(),
    of::<Aperture>(),
    of::<Simulate>(),
    of::<Scene>(),
    ("merge", &["merge part-1 part-2 --output map.png"], None),
    (
        "explore",
        &[
            "explore",
            "explore --lambda1 10 --lambda2 2/5",
            "explore data/scenes/figure1.json",
            "explore --period 10 --period 40 --units fs --no-open --port 8765",
        ],
        None,
    ),
    ("verify", &["verify data/published/map-100.json"], None),
    ("mcp", &["mcp"], None),
    ("cite", &["cite", "cite cff --output CITATION.cff"], None),
    ("generate", &["generate man --output man", "generate completions --output completions"], None),
];

/// The program with all of this, its commands in their order. A negative number is a value, for the flag
/// before it to refuse.
pub fn explained(program: Command) -> Command {
    PAGES.iter().fold(negative_numbers(program), |program, (name, examples, required)| {
        program.mut_subcommand(name, |command| {
            let command = negative_numbers(command).after_help(below(name, examples));
            match required {
                Some(required) => command.override_usage(format!("kickdrift {name} [OPTIONS] {required}")),
                None => command,
            }
        })
    })
}

/// The examples of a command.
pub fn examples(name: &str) -> &'static [&'static str] {
    PAGES.iter().find(|(known, ..)| *known == name).map_or(&[], |(_, examples, _)| examples)
}

fn negative_numbers(command: Command) -> Command {
    command
        .mut_args(|own| if own.get_action().takes_values() { own.allow_negative_numbers(true) } else { own })
}

/// Examples, and what the exit codes mean.
fn below(name: &str, examples: &[&str]) -> String {
    let examples: String = examples.iter().map(|example| format!("\n  kickdrift {example}")).collect();
    let codes = match name {
        "verdict" | "system" => {
            EXIT_CODES.replace("done\n", "done; with --exit-code: stable\n  1  with --exit-code: unstable\n")
        }
        "advise" => EXIT_CODES.replace(
            "done\n",
            "done; with --exit-code: all steps are proven stable\n  1  with --exit-code: one is not, or is advised against\n",
        ),
        "word" => EXIT_CODES.replace(
            "done\n",
            "done; with --check: every claim holds\n  1  with --check: a claim does not hold\n",
        ),
        "verify" => EXIT_CODES
            .replace("done\n", "every claim that is rechecked holds\n")
            .replace("error:", "error, or a claim that does not hold:"),
        _ => EXIT_CODES.into(),
    };
    format!("Examples:{examples}\n\n{codes}")
}
