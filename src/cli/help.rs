//! The help below the flags of each command: examples that run as they stand, exit codes, and required flags.

use clap::Command;

use documents::question::{Aperture, Bands, Question, Word};

const EXIT_CODES: &str = "Exit codes:
  0  done
  2  error: one line on standard error names the field, its value and a remedy; nothing is half-written";

/// The usage of commands whose required flags depend on each other.
const USAGES: [(&str, &str); 8] = [
    ("map", "--lambda1 <X> --lambda2 <Y> --step <D> --h1-range <LO..HI> --h2-range <LO..HI>"),
    (
        "compare",
        "(--lambda1 X --lambda2 Y --step D --h1-range A..B --h2-range A..B | --max-sum N --rho R | --methods LIST)",
    ),
    ("tongues", "(--ratio <P/Q> | --max-sum <N>) (--rho <R> | --lambda1 <X> --lambda2 <Y>)"),
    ("closings", "(--ratio <P/Q> | --max-sum <N>)"),
    ("advise", "(FILE | --period <NAME=T>... | --bond <NAME:K=..>... | --engine <FILE>) [--steps <A,B>]..."),
    ("aperture", "--bond <NAME:SHAPE,M1,M2> [--temperature <T>] (--steps <TIME,...> | --h-range <LO..HI>)"),
    ("proposition", "[--max <N>]"),
    ("word", "(WORD | --method <NAME> | --list) [--lambda1 <X>] [--lambda2 <Y>] [--h <H>]"),
];

/// Examples of commands that are no question of their own.
const EXAMPLES: [(&str, &[&str]); 17] = [
    (
        "verdict",
        &[
            "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98",
            "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3 --exit-code --quiet",
            "verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499 --format latex --digits 6",
        ],
    ),
    (
        "compare",
        &[
            "compare --max-sum 9 --rho 1/25",
            "compare --lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
            "compare --methods impulse,molly-short,respa-4 --h-range 0..8 --h-step 1/8 --rho-range 0..1 --rho-step 1/16 --output side.svg",
        ],
    ),
    (
        "map",
        &[
            "map --lambda1 pi^2 --lambda2 1/3 --step 1/20 --h1-range 1/20..2/pi --h2-range 1/20..7/2",
            "map --lambda1 1 --lambda2 1/9 --step 1/9 --h1-range 1..2 --h2-range 1..9 --output map.pdf",
        ],
    ),
    ("merge", &[]),
    (
        "tongues",
        &[
            "tongues --ratio 7/3 --rho 1/25 --m 3..5 --digits 30",
            "tongues --ratio 5/3,7/2 --rho 5/2 --figure diagram --output tongues.svg",
            "tongues --ratio 5/3 --rho 1/25 --m 3 --figure trace --output trace.pdf --width 174mm",
            "tongues --survey --max-sum 12 --rho 1/25 --format latex",
        ],
    ),
    ("bands", Bands::EXAMPLES),
    ("aperture", Aperture::EXAMPLES),
    ("word", Word::EXAMPLES),
    ("closings", &["closings --max-sum 8", "closings --ratio 5/3 --format latex --digits 8"]),
    (
        "system",
        &["system data/scenes/three-clocks.json", "system data/scenes/bar-resonant.json --output modes.pdf"],
    ),
    (
        "advise",
        &[
            "advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs",
            "advise --bond CH:K=340kcal/mol/A^2,12.011,1.008,3 --period 60fs --hmr 3.024 --steps 1fs,6fs --length 10ns",
            "advise data/scenes/flexible-water.json --steps 0.5fs,4.5fs",
        ],
    ),
    ("simulate", &["simulate data/scenes/fpu.json --periods 30 --figure run.pdf"]),
    (
        "explore",
        &[
            "explore",
            "explore --lambda1 10 --lambda2 2/5",
            "explore data/scenes/figure1.json",
            "explore --period 10 --period 40 --units fs --no-open --port 8765",
        ],
    ),
    ("run", &["run data/scenes/small.json --output small"]),
    ("verify", &["verify data/published/map-100.json"]),
    ("cite", &["cite", "cite cff --output CITATION.cff"]),
    ("generate", &["generate man --output man", "generate completions --output completions"]),
];

/// The program with all of this, its commands in their order. A negative number is a value, for the flag
/// before it to refuse.
pub fn explained(program: Command) -> Command {
    let program = negative_numbers(program);
    let names: Vec<String> =
        program.get_subcommands().map(|get_subcommand| get_subcommand.get_name().to_string()).collect();
    names.iter().fold(program, |program, name| {
        program.mut_subcommand(name, |command| {
            let command = negative_numbers(command);
            let of = |known: &&str| **known == **name;
            let command = match EXAMPLES.iter().find(|(known, _)| of(known)) {
                Some((_, examples)) => command.after_help(below(name, examples)),
                None => command,
            };
            match USAGES.iter().find(|(known, _)| of(known)) {
                Some((_, required)) => {
                    command.override_usage(format!("kickdrift {name} [OPTIONS] {required}"))
                }
                None => command,
            }
        })
    })
}

fn negative_numbers(command: Command) -> Command {
    command
        .mut_args(|own| if own.get_action().takes_values() { own.allow_negative_numbers(true) } else { own })
}

/// Examples, and what the exit codes mean.
pub fn below(name: &str, examples: &[&str]) -> String {
    let lines = examples.iter().map(|example| format!("\n  kickdrift {example}"));
    let examples: String = std::iter::once("Examples:".to_string()).chain(lines).collect();
    let examples = match name {
        "merge" => format!("{examples}\n  kickdrift merge part-1 part-2 --output map.png"),
        _ => examples,
    };
    let codes = match name {
        "verdict" | "system" => {
            EXIT_CODES.replace("done\n", "done; with --exit-code: stable\n  1  with --exit-code: unstable\n")
        }
        "verify" => EXIT_CODES
            .replace("done\n", "every claim that is rechecked holds\n")
            .replace("error:", "error, or a claim that does not hold:"),
        _ => EXIT_CODES.into(),
    };
    format!("{examples}\n\n{codes}")
}
