//! The command line: arguments → a scene → the library → a report.
//!
//! Exit codes: 0 done, 1 unstable (only with `--exit-code`) or a claim that does not hold (`word --check`), 2
//! error, with one line on standard error.

mod advise;
mod args;
mod asked;
mod cite;
mod command;
mod compare;
mod explore;
mod generate;
mod help;
mod map;
mod mcp;
mod merge;
mod paper;
mod progress;
mod run;
mod screen;
mod simulate;
mod system;
mod tongues;
mod usage;
mod verdict;
mod verify;
mod word;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Command as Program, CommandFactory, FromArgMatches, Parser, Subcommand};

use args::Common;
use asked::{Asked, Default, Drawn};
use documents::format::Format;
use documents::question::{Aperture, Bands, Closings, Curves, Half, Polynomial, Proposition, Question};
#[cfg(unix)]
use documents::report::file::abandon;
use documents::report::file::{stdout_is_closed, writable, write_output};
use number::{Error, Result};
use progress::Patience;

/// Exact, certified linear stability of multiple-time-step integrators.
///
/// Every number is exact: 0.3 is 3/10; 7/2, pi^2/25 and 2/pi mean what they say.
#[derive(Debug, Parser)]
#[command(name = "kickdrift", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Is this pair of steps stable?
    Verdict(verdict::Args),
    /// The (a, b) families of resonance curves, as tables or a figure.
    Curves(Drawn<Curves>),
    /// The trace verdict against the tan criterion and against resonance, with the disagreements listed.
    Compare(Box<compare::Args>),
    /// Checks the Proposition of Fong, Darve and Lew for all p and q up to a number, exactly, with witnesses.
    Proposition(Asked<Proposition>),
    /// The half period's entries A, B, C, D and the trace as polynomials in s = h1^2 lambda1, rho =
    /// lambda2/lambda1.
    Polynomial(Asked<Polynomial>),
    /// The half period of one ratio in numbers: its four entries, exact and enclosed.
    Half(Asked<Half>),
    /// The verdicts of a grid of step pairs: counts, and the unstable pairs as a table.
    Map(map::Args),
    /// Joins the parts of a map that map --shard K/N --resume DIR has computed.
    Merge(merge::Args),
    /// Every unstable interval (tongue) of one ratio of steps, or of all ratios p + q <= N, with certified
    /// edges.
    Tongues(tongues::Args),
    /// Boxes of steps in which every ratio, rational or not, is proven unstable.
    Bands(Drawn<Bands>),
    /// Where tongues close: the pairs (s, rho) at which a resonance does not destabilize.
    Closings(Closings),
    /// An integrator as its author writes it: consistency, order, stable steps, cost; its verdict at one
    /// step.
    Word(word::Args),
    /// Many clocks, many degrees of freedom: is the system stable, and what grows?
    System(Box<system::Args>),
    /// Which steps are safe for these periods or bonds, for how long, and why.
    Advise(advise::Args),
    /// How hot may a bond be before the method throws it out? Measured over steps, no proof.
    Aperture(Box<Drawn<Aperture>>),
    /// Runs a system as Algorithm 1 of Fong, Darve and Lew does: its energy and growth beside the prediction.
    Simulate(simulate::Args),
    /// A page on this machine to move in the plane of steps: maps, tongues and verdicts, at any depth.
    Explore(explore::Args),
    /// Computes what a scene file asks for: tables, figures, documents.
    Run(run::Args),
    /// Checks a JSON document of kickdrift: every value computed again, and every claim by another route.
    Verify(verify::Args),
    /// Answers assistants: the questions as tools of the Model Context Protocol, on standard input and
    /// output.
    Mcp(mcp::Args),
    /// How to cite kickdrift and the paper that posed its question: BibTeX, or CITATION.cff.
    Cite(cite::Args),
    /// Manual pages and completions for shells: what packagers need.
    Generate(generate::Args),
}

impl Command {
    /// Whether its output may be more than a document: a figure, arrays, files of its own.
    fn draws(&self) -> bool {
        use Command::{
            Advise, Aperture, Bands, Cite, Compare, Curves, Generate, Map, Merge, Run, System, Tongues, Word,
        };
        matches!(
            self,
            Advise(_)
                | Aperture(_)
                | Bands(_)
                | Compare(_)
                | Curves(_)
                | Cite(_)
                | Map(_)
                | Merge(_)
                | Tongues(_)
                | System(_)
                | Word(_)
                | Run(_)
                | Generate(_)
        )
    }

    /// Whether what it writes is a folder of files.
    fn makes_a_folder(&self) -> bool {
        matches!(self, Command::Run(_) | Command::Generate(_))
    }
}

/// All commands, with their examples.
fn whole() -> Program {
    help::explained(Cli::command())
}

fn parsed(arguments: impl IntoIterator<Item = OsString>) -> clap::error::Result<Cli> {
    let mut program = whole();
    let matches = program.try_get_matches_from_mut(arguments)?;
    let mut cli = Cli::from_arg_matches(&matches)?;
    cli.common.command = command::text(&program, &matches);
    Ok(cli)
}

/// Runs the program with the process's arguments. Whether standard output was closed is told by who could see
/// it before the runtime opened another file in its place.
pub fn main(is_stdout_closed: bool) -> ExitCode {
    if is_stdout_closed {
        stdout_is_closed();
    }
    ExitCode::from(program(std::env::args_os()))
}

/// Runs the program with these arguments, its own name first, for hosts that bring their own process; its
/// exit code.
pub fn program(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    // Without it the next run in the same folder tidies up.
    let _ = tidy_up_when_stopped();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = match parsed(arguments.iter().cloned()) {
        Ok(cli) => cli,
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            let text = format!("{}\n", error.to_string().trim_end());
            return write_output(None, screen::shown(&text, screen::Colour::Never).as_bytes())
                .map_or_else(|error| failure(&error.to_string()), |()| 0);
        }
        Err(error) => return failure(&usage::explained(&error, &whole(), &arguments).to_string()),
    };
    match run(&cli) {
        Ok(code) => code,
        Err(error) => failure(
            &by_its_flag(error, &cli.common.command)
                .explain(|needed| format!("allow it with --budget {needed}")),
        ),
    }
}

/// The error of a field by the name of its flag, `rho-range` for `rho_range`, where the command has one; keys
/// of files keep their names.
fn by_its_flag(error: Error, command: &str) -> Error {
    let flag = error.field().replace('_', "-");
    let has_it = |command: &clap::Command| command.get_arguments().any(|arg| arg.get_long() == Some(&flag));
    let is_flag =
        || command.split(' ').nth(1).is_some_and(|name| whole().find_subcommand(name).is_some_and(has_it));
    if flag != error.field() && is_flag() { error.at(&flag) } else { error }
}

/// A process that a signal ends leaves no unfinished file behind, and ends as one without this would; a file
/// that grows too large is an error of the stream.
#[cfg(unix)]
fn tidy_up_when_stopped() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ};
    use signal_hook::low_level::emulate_default_handler;
    signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default())?;
    // Signals that are ignored, as under nohup and in background jobs, stay ignored.
    let heard = [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU].into_iter().filter(|&signal| !is_ignored(signal));
    let mut signals = signal_hook::iterator::Signals::new(heard)?;
    std::thread::spawn(move || {
        for signal in signals.forever() {
            abandon(|| drop(emulate_default_handler(signal)));
        }
    });
    Ok(())
}

/// Whether this process was started with the signal ignored; where the system does not say (there is no
/// /proc), only that a hangup may be.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask =
        status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.map_or(signal == signal_hook::consts::SIGHUP, |mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
fn tidy_up_when_stopped() -> std::io::Result<()> {
    Ok(())
}

fn run(cli: &Cli) -> Result<u8> {
    let common = &cli.common;
    common.set_threads()?;
    // Refused before the work, not after it.
    if !cli.command.makes_a_folder() {
        common.output.as_deref().map_or(Ok(()), writable)?;
    }
    if !cli.command.draws() {
        common.format(&Format::DOCUMENT, Format::Text)?;
    }
    let _patience =
        Patience::new(common.quiet || matches!(cli.command, Command::Explore(_) | Command::Mcp(_)));
    match &cli.command {
        Command::Verdict(args) => return args.run(common),
        Command::Curves(args) => args.run(common, Default::Table)?,
        Command::Compare(args) => args.run(common)?,
        Command::Proposition(args) => args.run(common, Default::Text)?,
        Command::Half(args) => args.run(common, Default::Text)?,
        Command::Polynomial(args) => args.run(common, Default::Text)?,
        Command::Map(args) => args.run(common)?,
        Command::Merge(args) => args.run(common)?,
        Command::Run(args) => args.run(common)?,
        Command::Tongues(args) => args.run(common)?,
        Command::Bands(args) => args.run(common, Default::Table)?,
        Command::Closings(args) => {
            let format = common.format_of_table(&Format::DOCUMENT)?;
            common.write(&args.ask(&common.work())?, format)?;
        }
        Command::Word(args) => return args.run(common),
        Command::Verify(args) => args.run(common)?,
        Command::System(args) => return args.run(common),
        Command::Advise(args) => return args.run(common),
        Command::Aperture(args) => args.run(common, Default::Text)?,
        Command::Simulate(args) => args.run(common)?,
        Command::Explore(args) => args.run(common)?,
        Command::Mcp(args) => args.run(&whole(), common)?,
        Command::Cite(args) => args.run(common)?,
        Command::Generate(args) => args.run(whole(), common)?,
    }
    Ok(0)
}

fn failure(message: &str) -> u8 {
    // Where standard error is closed too, the exit code alone has to say it.
    let _ = writeln!(std::io::stderr(), "{}", screen::message(&format!("kickdrift: {message}")));
    2
}
